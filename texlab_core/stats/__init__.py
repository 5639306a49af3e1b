"""Statistics of images and subbands."""
