"""Parameters as widgets, made from their declarations."""
