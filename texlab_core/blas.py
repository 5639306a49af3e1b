"""BLAS with one thread: its own threads stall small products and compete with the columns of the window."""

from __future__ import annotations

import functools
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

_LOCK = threading.Lock()
_USERS: list[Any] = []


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Limit BLAS to one thread within the block; blocks may overlap between threads."""
    with _LOCK:
        # BLAS has one setting per process: the first to enter sets it, the last to leave restores it.
        if not _USERS:
            _USERS.append(_controller().limit(limits=1, user_api="blas"))
        _USERS.append(None)
    try:
        yield
    finally:
        with _LOCK:
            _USERS.pop()
            if len(_USERS) == 1:
                _USERS.pop().restore_original_limits()


@functools.cache
def _controller() -> Any:
    from threadpoolctl import ThreadpoolController  # type: ignore[import-untyped]

    return ThreadpoolController()
