"""How long the rest of a batch will take."""

from __future__ import annotations

import time


class Forecast:
    """Remaining time from the pace so far: exemplars come one after the other, and each has all methods and sizes.

    Parameters
    ----------
    total
        How many jobs there are.
    """

    def __init__(self, total: int) -> None:
        self._left = total
        self._over = 0
        self._start = time.monotonic()

    def add(self) -> None:
        """Count a job that ran."""
        self._left -= 1
        self._over += 1

    def drop(self) -> None:
        """Count a job that need not run."""
        self._left -= 1

    @property
    def remaining_s(self) -> float | None:
        """Seconds until the end; None before the first job is over."""
        if not self._over:
            return None
        return self._left * (time.monotonic() - self._start) / self._over
