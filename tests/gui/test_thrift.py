"""Freed memory goes back to the system once the program has come to rest."""

from __future__ import annotations

import ctypes
import sys
from typing import Any

import numpy as np
import pytest

from texlab.app import memory
from texlab.app.memory import STEP_BYTES, Thrift, give_back, memory_bytes
from texlab_core.transforms import filters
from texlab_core.work.tasks import finish


@pytest.mark.skipif(sys.platform != "linux", reason="only this C library keeps what was freed")
def test_what_was_freed_between_what_is_in_use_goes_back() -> None:
    library = ctypes.CDLL(None)
    if not hasattr(library, "malloc_trim"):
        pytest.skip("another C library")
    library.malloc.restype = ctypes.c_void_p
    library.free.argtypes = [ctypes.c_void_p]
    size, count = 64 * 1024, 1500
    blocks = [library.malloc(size) for _ in range(count)]
    for each in blocks:
        ctypes.memset(each, 1, size)
    full = memory_bytes() or 0
    for each in blocks[:-1]:
        # All but the last: the heap cannot shrink from its end.
        library.free(each)
    give_back()
    left = memory_bytes() or 0
    library.free(blocks[-1])
    assert full - left > 0.9 * size * count


def test_it_is_done_at_rest_and_only_when_there_is_more_than_before(
    qtbot: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    used, given = [100 * 2**20], []
    monkeypatch.setattr(memory, "memory_bytes", lambda: used[0])
    monkeypatch.setattr(memory, "give_back", lambda: given.append(used[0]))
    thrift = Thrift()

    def look(*idle: bool) -> None:
        for each in idle:
            thrift.look(used[0], idle=each)

    try:
        look(True, False, True, False, True)
        assert thrift._worker.generation == 0
        with qtbot.waitSignal(thrift.changed):
            look(True)
        assert given == [used[0]]
        qtbot.waitUntil(lambda: not thrift._worker.busy)
        used[0] += STEP_BYTES - 1
        look(True, True)
        assert not thrift._worker.busy
        used[0] += 1
        with qtbot.waitSignal(thrift.changed):
            look(True)
        assert len(given) == 2
    finally:
        thrift.close()


def test_where_the_size_is_not_known_nothing_is_done(qapp: Any) -> None:
    thrift = Thrift()
    for _ in range(3):
        thrift.look(None, idle=True)
    assert thrift._worker.generation == 0


def test_large_filters_are_let_go_of_the_oldest_first(monkeypatch: pytest.MonkeyPatch) -> None:
    cache = filters.ArrayCache(10**9)
    monkeypatch.setattr(filters, "_CACHE", cache)
    monkeypatch.setattr(memory, "FILTERS_BYTES", 1000)

    def make(count: int) -> Any:
        yield 1
        return np.zeros(count, np.uint8)

    for count in (900, 300, 200):
        finish(cache.get((count,), lambda count=count: make(count)))
    give_back()
    assert list(cache._arrays) == [(300,), (200,)]
    assert cache._bytes == 500
