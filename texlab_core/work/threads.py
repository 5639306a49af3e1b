"""How many threads a computation may use: set by whoever runs it, read where it matters."""

from __future__ import annotations

import os
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

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
