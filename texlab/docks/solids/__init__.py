"""Solids: three slices linked by cross-hairs, the shaded object, and the exemplar wrapped around it."""
