"""De Bonet's multiresolution sampling: analysis, thresholds, candidate sets, collapse, explanation."""
