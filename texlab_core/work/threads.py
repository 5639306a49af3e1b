"""How many threads a computation may use: set by whoever runs it, read where it matters."""

from __future__ import annotations

import os
import sys
import threading
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

    from threadpoolctl import ThreadpoolController

# Read by libraries for linear algebra when they are loaded.
SUM_VARIABLES = (
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "BLIS_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
    "OMP_NUM_THREADS",
)
_WORKERS: ContextVar[int] = ContextVar("texlab_workers", default=1)


def workers() -> int:
    """Return the number of threads for one transform; results never depend on it."""
    return _WORKERS.get()


@contextmanager
def use_workers(count: int | None) -> Iterator[None]:
    """Set the number of threads within the block; None means two, or one on a single core."""
    token = _WORKERS.set(max(1, min(2, os.cpu_count() or 1) if count is None else count))
    try:
        yield
    finally:
        _WORKERS.reset(token)


class _Sums:
    """Libraries for linear algebra kept to one thread as long as any thread of the program is inside."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._inside = 0
        self._limits: list[Any] = []
        self._controller: ThreadpoolController | None = None
        self._modules = 0

    def enter(self) -> None:
        with self._lock:
            # NumPy, SciPy and OpenCV bring a library each; methods import the last two late.
            import cv2  # noqa: F401
            import scipy.linalg  # noqa: F401

            known = self._controller
            # Whatever was imported since may have brought one more.
            if self._controller is None or self._modules != len(sys.modules):
                from threadpoolctl import ThreadpoolController

                self._controller = ThreadpoolController()
                self._modules = len(sys.modules)
            if self._controller is not known or not self._inside:
                self._limits.append(self._controller.limit(limits=1, user_api="blas"))
            self._inside += 1

    def leave(self) -> None:
        with self._lock:
            self._inside -= 1
            while self._limits and not self._inside:
                self._limits.pop().restore_original_limits()


_sums = _Sums()


@contextmanager
def sums_in_one_thread() -> Iterator[None]:
    """Let libraries for linear algebra add up in one thread within the block, whoever else enters or leaves it.

    Sums over several threads may be taken in another order, and a sum in another order has other bits.
    """
    _sums.enter()
    try:
        yield
    finally:
        _sums.leave()
