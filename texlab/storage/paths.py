"""Folders for settings, presets, results and logs; ``TEXLAB_HOME`` replaces them all."""

from __future__ import annotations

import os
from pathlib import Path


def _folder(kind: str) -> Path:
    home = os.environ.get("TEXLAB_HOME")
    if home:
        folder = Path(home) / kind
    else:
        import platformdirs

        dirs = platformdirs.PlatformDirs("texlab", appauthor=False)
        folders = {"log": dirs.user_log_path, "cache": dirs.user_cache_path}
        folder = folders.get(kind, dirs.user_config_path)
    return folder


def config_dir() -> Path:
    """Return the folder of settings, presets and the last session (it may not exist yet)."""
    return _folder("config")


def lessons_dir() -> Path:
    """Return the folder of the lessons that the user has written (it may not exist yet)."""
    return config_dir() / "lessons"


def results_dir() -> Path:
    """Return the folder of finished results, which may be removed at any time (it may not exist yet)."""
    return _folder("cache") / "results"


def log_file() -> Path:
    """Return the log file (it may not exist yet)."""
    return _folder("log") / "texlab.log"
