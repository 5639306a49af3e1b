"""Presets in the window: bar, dialog, manager."""
