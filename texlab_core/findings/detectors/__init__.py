"""The detectors: every file registers its own."""
