"""Solids to look at: drawn as objects, cut into slices, turned and walked through."""
