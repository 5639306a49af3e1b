"""Folders for settings, presets and logs; ``TEXLAB_HOME`` replaces them all."""

from __future__ import annotations

import os
from pathlib import Path


def _folder(kind: str) -> Path:
    home = os.environ.get("TEXLAB_HOME")
    if home:
        folder = Path(home) / kind
    else:
        import platformdirs

        where = {
            "config": platformdirs.user_config_path,
            "log": platformdirs.user_log_path,
            "cache": platformdirs.user_cache_path,
        }
        folder = where[kind]("texlab", appauthor=False)
    return folder


def config_dir() -> Path:
    """Return the folder of settings, presets and the last session (it may not exist yet)."""
    return _folder("config")


def log_file() -> Path:
    """Return the log file (it may not exist yet)."""
    return _folder("log") / "texlab.log"
