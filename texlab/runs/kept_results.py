"""Finished results by their job, so that a step back is free: the same job has the same bits."""

from __future__ import annotations

import threading
from collections import OrderedDict
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from collections.abc import Hashable

    from texlab.runs.column_run import Finished, Measured
    from texlab_core.engine.job import Job

MAX_BYTES = 256 * 2**20
MOST = 64
# What is larger is not held beside the column that shows it, once it lies on the disk.
LARGE = 32 * 2**20
# What takes less time is made again as quickly as it is read.
WORTH_S = 0.25


class Disk(Protocol):
    """Where results are kept beyond the memory; used in threads of workers only."""

    def get(self, job: Job) -> tuple[Finished, Measured] | None:
        """Return what is known of a job."""
        ...

    def put(self, end: Finished, measured: Measured) -> bool:
        """Keep a result; return whether it is kept."""
        ...

    def clear(self) -> tuple[int, int]:
        """Remove everything; return how many results there were, and their bytes."""
        ...


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
        self.disk: Disk | None = None
        """Where what has been measured lies as well; None keeps nothing there."""
        self._unwritten: OrderedDict[Hashable, tuple[Finished, Measured]] = OrderedDict()
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
        size = end.nbytes
        with self._lock:
            self._kept[key] = end, size
            self._kept.move_to_end(key)
            while len(self._kept) > self._most or (len(self._kept) > 1 and self._sum() > self._max_bytes):
                self._measured.pop(self._kept.popitem(last=False)[0], None)

    def note(self, key: Hashable, found: Measured) -> None:
        """Keep numbers and findings with the result of a job, as long as that is kept."""
        with self._lock:
            if key not in self._kept:
                return
            self._measured[key] = found
            end, size = self._kept[key]
            if self.disk is not None and not end.stored and (size > LARGE or end.result.elapsed_s >= WORTH_S):
                self._unwritten[key] = end, found

    def read(self, job: Job) -> Finished | None:
        """Return what the disk holds of a job, and keep it here as well; runs in a worker's thread."""
        found = None if self.disk is None else self.disk.get(job)
        if found is None:
            return None
        end, measured = found
        self.put(job.key, end)
        self.note(job.key, measured)
        return end

    @property
    def unwritten(self) -> bool:
        """Whether there is something to write."""
        with self._lock:
            return bool(self._unwritten)

    def write(self) -> None:
        """Write what is not on the disk yet, the oldest first; runs in a worker's thread."""
        while self.disk is not None:
            with self._lock:
                if not self._unwritten:
                    return
                key, (end, measured) = next(iter(self._unwritten.items()))
            written = self.disk.put(end, measured)
            with self._lock:
                if self._unwritten.get(key, (None,))[0] is end:
                    del self._unwritten[key]
                kept = self._kept.get(key)
                # What takes long enough to be asked for first is looked for here.
                solid = end.result.volume is not None
                if written and not solid and kept is not None and kept[0] is end and kept[1] > LARGE:
                    del self._kept[key]
                    self._measured.pop(key, None)

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
            self._unwritten.clear()

    def forget(self) -> tuple[int, int]:
        """Forget everything, also on the disk; return how many results lay there, and their bytes.

        Runs in a worker's thread.
        """
        self.clear()
        return (0, 0) if self.disk is None else self.disk.clear()

    def _sum(self) -> int:
        return sum(size for _, size in self._kept.values())
