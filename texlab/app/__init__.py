"""Puts the window together: start, explorer, crash handler, screenshots."""
