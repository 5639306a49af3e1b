"""The last few values, and keys by identity."""

import gc
import threading

import numpy as np

from texlab.docks import recent as recent_module
from texlab.docks.recent import Recent, Same


def test_values_are_made_once_and_the_oldest_go():
    made = []
    recent = Recent(3)

    def get(key):
        return recent.get(key, lambda: made.append(key) or key * 10)

    assert [get(key) for key in (1, 2, 3, 1, 4, 1, 2)] == [10, 20, 30, 10, 40, 10, 20]
    assert made == [1, 2, 3, 4, 2]


def test_bounded_by_weight_but_two_always_stay():
    recent = Recent(10, weigh=float)
    made = []
    for key, weight in ((1, 4), (2, 4), (3, 4), (4, 90), (4, 0), (3, 0)):
        recent.get(key, lambda key=key, weight=weight: made.append(key) or weight)
    assert made == [1, 2, 3, 4]


def test_what_is_counted_is_weighed_as_well(monkeypatch):
    monkeypatch.setattr(recent_module, "MOST_BYTES", 1000)
    recent = Recent(6)
    shared = np.zeros(300, np.uint8)
    values = {1: np.zeros(400, np.uint8), 2: (shared, shared[:10], "words"), 3: {"a": shared}, 4: 5, 5: shared[1:]}
    for key, value in values.items():
        recent.get(key, lambda value=value: value)
        assert len(recent) == min(key, 4)
    # 400 + 300 + 300 + 0 are no more than 1000.
    assert [recent.get(key, lambda: "again") is values[key] for key in (2, 3, 4, 5)] == [True] * 4
    assert recent.get(1, lambda: "again") == "again"


def test_same_is_identity():
    first, second = [1], [1]
    assert Same(first) == Same(first)
    assert Same(first) != Same(second)
    assert Same(first) != first
    assert len({Same(first), Same(first), Same(second)}) == 2


def test_same_as_nothing_once_it_has_gone():
    pixels = np.zeros(3)
    key, other = Same(pixels), Same(pixels)
    table = {key: "made"}
    assert (key.value is pixels, key.gone, key == other) == (True, False, True)
    del pixels
    assert (key.value, key.gone, key == other) == (None, True, False)
    assert Same(np.zeros(3)) != key
    # It can still be taken out of a table.
    assert table.pop(key) == "made"
    assert Same(None) == Same(None)
    assert not Same(None).gone


def test_what_was_made_of_what_has_gone_goes():
    recent = Recent(3)
    kept, lost = np.zeros(3), np.zeros(3)
    for key in ((Same(kept), 1), ("a", (Same(lost), Same(kept))), (Same(lost), 2)):
        recent.get(key, lambda key=key: key)
    assert len(recent) == 3
    del lost, key
    assert len(recent) == 1
    assert recent.get((Same(kept), 1), lambda: "again") == (Same(kept), 1)


def test_what_goes_while_it_is_used_is_not_kept():
    recent = Recent(3)
    held = [np.zeros(3)]
    key = Same(held[0])
    assert recent.get(key, lambda: held.clear() or "made") == "made"
    assert len(recent) == 0


def test_what_goes_while_a_value_is_kept_goes_after_it():
    recent = Recent(2, weigh=lambda value: value() or 1)
    held = [np.zeros(3)]

    def weigh():
        # In the middle of keeping another value.
        held.clear()

    recent.get(Same(held[0]), lambda: weigh)
    recent.get("other", lambda: lambda: 1)
    assert len(recent) == 1
    assert recent.get("other", lambda: "again") != "again"


def test_several_threads_keep_and_lose_at_once():
    recent = Recent(4)

    def work():
        for _ in range(300):
            pixels = np.zeros(2)
            key = Same(pixels)
            assert recent.get(key, lambda: 1) == 1

    threads = [threading.Thread(target=work) for _ in range(4)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    gc.collect()
    recent.get("last", lambda: 0)
    assert len(recent) == 1
