"""Recipes: what a saved result was made from and how; made, embedded and read."""
