"""Widgets that know nothing of textures."""
