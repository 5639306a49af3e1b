"""Texture models made of the marginal distributions of subbands (Heeger and Bergen)."""
