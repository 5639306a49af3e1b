"""Mixtures of textures after Heeger and Bergen: between two or more exemplars."""
