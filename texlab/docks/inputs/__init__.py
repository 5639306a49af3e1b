"""Further images of a method: chosen, scaled and cropped like the exemplar."""
