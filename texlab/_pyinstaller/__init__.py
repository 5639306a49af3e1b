"""Tells PyInstaller what TexLab finds while it runs: methods, commands, resources."""

from __future__ import annotations

from pathlib import Path


def hook_dirs() -> list[str]:
    """Return the folder with the hooks: entry point ``pyinstaller40``."""
    return [str(Path(__file__).parent)]
