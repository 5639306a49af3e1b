"""The main window, its commands, and what it does with files."""
