"""What the docks show of spectra: planes of frequencies, peaks, Gabor channels, the code of 69 numbers."""
