"""The one protocol for long work in pieces."""
