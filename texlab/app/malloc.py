"""How glibc's malloc keeps what was freed; other C libraries do without."""

from __future__ import annotations

import ctypes
import sys

# Left to itself malloc keeps up to 64 MB at the end of each of eight heaps for every core, for good.
HEAPS = 4
KEPT_BYTES = 8 * 2**20
# Larger pieces are the system's own, and go back to it when they are freed.
OWN_BYTES = 4 * 2**20

_TRIM_THRESHOLD, _MMAP_THRESHOLD, _ARENA_MAX = -1, -3, -8


def keep_little() -> bool:
    """Let little be kept of what is freed from now on; return whether malloc knows how.

    Heaps are made with the first threads: it is to be called before there are any.
    """
    if sys.platform != "linux":
        return False
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (AttributeError, OSError):
        return False
    wanted = ((_ARENA_MAX, HEAPS), (_TRIM_THRESHOLD, KEPT_BYTES), (_MMAP_THRESHOLD, OWN_BYTES))
    taken = [mallopt(name, value) == 1 for name, value in wanted]
    return all(taken)


def trim() -> None:
    """Give the system what lies free between what is in use."""
    if sys.platform == "linux":
        try:
            ctypes.CDLL(None).malloc_trim(0)
        except (AttributeError, OSError):
            return
