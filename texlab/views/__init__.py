"""Widgets that show frozen data and emit intentions; none writes the session, none computes."""
