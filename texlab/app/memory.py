"""How much memory the program uses, where the system says so without further libraries."""

from __future__ import annotations

import os
from pathlib import Path


def memory_bytes() -> int | None:
    """Return the resident size in bytes, or None where it is not known."""
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, IndexError, AttributeError):
        return None


def memory_text() -> str:
    """Return the resident size for the status bar."""
    size = memory_bytes()
    return "" if size is None else f"{size / 2**20:.0f} MB"
