"""Images: the one door in, the gallery, the formats."""
