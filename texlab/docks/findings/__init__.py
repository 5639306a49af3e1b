"""Findings: what is wrong with the chosen column's result, where, why, and what to try."""
