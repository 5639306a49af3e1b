"""Several jobs on one sheet: sweeps of parameters and comparisons of methods."""
