"""Solid textures after Heeger and Bergen: a block that can be cut anywhere."""
