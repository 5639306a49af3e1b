"""Linear transforms of images: pyramids, filters, Fourier."""
