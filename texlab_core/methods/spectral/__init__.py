"""Textures from their second-order statistics: the MSG code, uncoded spectra, CAR and AC-H models."""
