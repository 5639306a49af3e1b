"""Which order is next for which process: the jobs of one exemplar stay where it is known."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from texlab_core.batch.places import Loaded

# So many orders of exemplars that others work on are passed over in search of another exemplar.
AHEAD = 16


class Supply:
    """Hands orders out to several takers.

    What is computed of an exemplar (its analysis, what measures prepare of it) is computed once where one process
    has all its jobs. A taker that finds no other exemplar near shares the work on one.

    Parameters
    ----------
    orders
        Taken one by one, as they are needed.
    takers
        How many there are.
    """

    def __init__(self, orders: Iterator[Loaded], takers: int) -> None:
        self._orders = orders
        self._aside: list[Loaded] = []
        self._subjects: list[str | None] = [None] * takers

    def next(self, taker: int) -> Loaded | None:
        """Return the next order for a taker, from 0; None when nobody will get any more."""
        found = self._take(taker)
        if found is not None:
            self._subjects[taker] = found[0].subject
        return found

    def _take(self, taker: int) -> Loaded | None:
        mine = self._subjects[taker]
        others = {each for number, each in enumerate(self._subjects) if number != taker}
        known = [loaded[0].subject for loaded in self._aside]
        for place, subject in enumerate(known):
            if subject == mine:
                return self._aside.pop(place)
        for place, subject in enumerate(known):
            if subject not in others:
                return self._aside.pop(place)
        while len(self._aside) < AHEAD and (loaded := next(self._orders, None)) is not None:
            if loaded[0].subject == mine or loaded[0].subject not in others:
                return loaded
            self._aside.append(loaded)
        # From the end: the front is what its own taker comes to next.
        return self._aside.pop() if self._aside else None
