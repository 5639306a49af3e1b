"""Freed memory goes back to the system once the program has come to rest."""

from __future__ import annotations

import ctypes
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

from texlab.app import memory
from texlab.app.malloc import HEAPS
from texlab.app.memory import STEP_BYTES, Thrift, give_back, memory_bytes
from texlab_core.work import kept
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
        look(False, True, True)
        assert not thrift._worker.busy
        used[0] += 1
        with qtbot.waitSignal(thrift.changed):
            look(True)
        assert len(given) == 2
        qtbot.waitUntil(lambda: not thrift._worker.busy)
        # Once for every rest, also where less is used than after the one before: it was freed, not given back.
        look(True, True)
        assert not thrift._worker.busy
        used[0] -= 1
        look(False, True)
        assert not thrift._worker.busy
        used[0] += 1
        with qtbot.waitSignal(thrift.changed):
            look(True)
        assert len(given) == 3
    finally:
        thrift.close()


def test_what_is_closed_without_any_work_goes_back_too(
    qtbot: Any, explorer: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    explorer._memory.stop()
    given: list[int] = []
    monkeypatch.setattr(memory, "memory_bytes", lambda: 100 * 2**20)
    monkeypatch.setattr(memory, "give_back", lambda: given.append(1))
    thrift = explorer._thrift
    thrift._least = 0

    def rest() -> None:
        for _ in range(3):
            thrift.look(memory.memory_bytes(), idle=True)
            qtbot.waitUntil(lambda: not thrift._worker.busy)
        thrift._least = 0

    thrift.look(0, idle=False)
    rest()
    rest()
    assert len(given) == 1
    explorer.session.remove_column(explorer.session.state.columns[-1].id)
    rest()
    rest()
    assert len(given) == 2


def test_where_the_size_is_not_known_nothing_is_done(qapp: Any) -> None:
    thrift = Thrift()
    for _ in range(3):
        thrift.look(None, idle=True)
    assert thrift._worker.generation == 0


def test_large_filters_are_let_go_of_the_oldest_first(monkeypatch: pytest.MonkeyPatch) -> None:
    cache = kept.ArrayCache(10**9)
    monkeypatch.setattr(kept, "ARRAYS", cache)
    monkeypatch.setattr(memory, "FILTERS_BYTES", 1000)

    def make(count: int) -> Any:
        yield 1
        return np.zeros(count, np.uint8)

    for count in (900, 300, 200):
        finish(cache.get((count,), lambda count=count: make(count)))
    give_back()
    assert list(cache._arrays) == [(300,), (200,)]
    assert cache._bytes == 500


@pytest.mark.skipif(sys.platform != "linux", reason="only this C library has these heaps")
@pytest.mark.parametrize("told", [True, False])
def test_large_pieces_stay_the_systems_own_and_heaps_are_few(told: bool) -> None:
    if not hasattr(ctypes.CDLL(None), "mallopt"):
        pytest.skip("another C library")
    script = HEAPS_OF_THREADS if told else HEAPS_OF_THREADS.replace("assert keep_little()", "")
    said = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True).stdout
    own, heaps = (int(each) for each in said.split())
    # Once a piece of 20 MB was freed, malloc by itself takes the next ones from its heaps, and keeps them.
    assert own == (8 if told else 0)
    assert (heaps <= HEAPS) is told


HEAPS_OF_THREADS = """
import ctypes, threading
from tests.soak.census import malloc_info_2
from texlab.app.malloc import OWN_BYTES, keep_little
assert keep_little()
library = ctypes.CDLL(None)
library.malloc.restype = ctypes.c_void_p
library.free.argtypes = [ctypes.c_void_p]
library.free(library.malloc(20 * 2**20))
before = malloc_info_2().hblks
held = [library.malloc(OWN_BYTES + 1) for _ in range(8)]
own = malloc_info_2().hblks - before
ready = threading.Barrier(12)
def work():
    library.malloc(1000)
    ready.wait()
threads = [threading.Thread(target=work) for _ in range(12)]
for each in threads:
    each.start()
for each in threads:
    each.join()
library.open_memstream.restype = ctypes.c_void_p
library.fclose.argtypes = [ctypes.c_void_p]
text, size = ctypes.c_char_p(), ctypes.c_size_t()
stream = library.open_memstream(ctypes.byref(text), ctypes.byref(size))
library.malloc_info(0, ctypes.c_void_p(stream))
library.fclose(stream)
print(own, text.value.count(b"<heap nr"))
"""
