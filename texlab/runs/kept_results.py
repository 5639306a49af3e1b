"""Finished results by their job, so that a step back is free: the same job has the same bits."""

from __future__ import annotations

import threading
from collections import OrderedDict
from typing import TYPE_CHECKING

from texlab_core.engine.cache import array_bytes

if TYPE_CHECKING:
    from collections.abc import Hashable

    from texlab.runs.column_run import Finished, Measured

MAX_BYTES = 256 * 2**20
MOST = 64


class KeptResults:
    """Keeps what columns have finished, the most recently used; safe to share between threads.

    Parameters
    ----------
    max_bytes
        How much pictures, frames, maps and models may take together. The newest one is kept whatever it takes.
    most
        How many there may be.
    """

    def __init__(self, max_bytes: int = MAX_BYTES, most: int = MOST) -> None:
        self._max_bytes = max_bytes
        self._most = most
        self._kept: OrderedDict[Hashable, tuple[Finished, int]] = OrderedDict()
        self._measured: dict[Hashable, Measured] = {}
        self._lock = threading.Lock()

    def get(self, key: Hashable) -> Finished | None:
        """Return what the job with this key came to, or None."""
        with self._lock:
            if key not in self._kept:
                return None
            self._kept.move_to_end(key)
            return self._kept[key][0]

    def put(self, key: Hashable, end: Finished) -> None:
        """Keep the end of a job's run, dropping those that were not used for longest."""
        size = _bytes(end)
        with self._lock:
            self._kept[key] = end, size
            self._kept.move_to_end(key)
            while len(self._kept) > self._most or (len(self._kept) > 1 and self._sum() > self._max_bytes):
                self._measured.pop(self._kept.popitem(last=False)[0], None)

    def note(self, key: Hashable, found: Measured) -> None:
        """Keep numbers and findings with the result of a job, as long as that is kept."""
        with self._lock:
            if key in self._kept:
                self._measured[key] = found

    def measured(self, key: Hashable) -> Measured | None:
        """Return what is known of a job's result, or None when it has to be measured."""
        with self._lock:
            return self._measured.get(key)

    @property
    def nbytes(self) -> int:
        """Bytes of everything that is kept."""
        with self._lock:
            return self._sum()

    def __len__(self) -> int:
        return len(self._kept)

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._kept.clear()
            self._measured.clear()

    def _sum(self) -> int:
        return sum(size for _, size in self._kept.values())


def _bytes(end: Finished) -> int:
    """Return what a result takes; maps that nobody has looked at yet are not computed for that."""
    result = end.result
    frames = [each.picture for each in end.frames]
    seen: set[int] = set()
    parts = (result.image, result.model, result.details, end.picture, frames)
    return sum(array_bytes(each, seen) for each in parts)
