"""A method for TexLab: stripes with the colours of the exemplar."""
