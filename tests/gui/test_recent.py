"""The last few values, and keys by identity."""

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


def test_same_is_identity():
    first, second = [1], [1]
    assert Same(first) == Same(first)
    assert Same(first) != Same(second)
    assert Same(first) != first
    assert len({Same(first), Same(first), Same(second)}) == 2
