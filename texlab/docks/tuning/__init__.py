"""D against V: every run a point, and thresholds suggested."""
