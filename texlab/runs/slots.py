"""Places on the cores: how many things run at the same time, and who goes first."""

from __future__ import annotations

import contextlib
import threading
import time
from enum import IntEnum
from typing import TYPE_CHECKING

from texlab_core.errors import Cancelled

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


class Rank(IntEnum):
    """Who goes first: what is under the user's finger, what they have just changed, the rest, what comes later."""

    DRAFT = 0
    CHANGED = 1
    REST = 2
    AHEAD = 3


class Slots:
    """As many places as there are cores; work beyond that waits for its turn.

    A lower rank goes first, and within a rank who came first. What runs can let a lower rank have its place for a
    while: nothing quick waits for the end of something long.
    """

    def __init__(self, count: int) -> None:
        self._free = count
        self._waiting: list[tuple[Rank, object]] = []
        self._changed = threading.Condition()

    @contextlib.contextmanager
    def place(self, should_stop: Callable[[], bool], rank: Rank = Rank.REST) -> Iterator[None]:
        """Hold a place within the block; raises ``Cancelled`` when ``should_stop`` says so before there is one."""
        if not self.acquire(should_stop, rank):
            raise Cancelled
        try:
            yield
        finally:
            self.release()

    def acquire(self, should_stop: Callable[[], bool], rank: Rank = Rank.REST) -> bool:
        """Wait for a place; False when ``should_stop`` says so first."""
        with self._changed:
            behind = sum(each <= rank for each, _ in self._waiting)
            return self._wait(should_stop, rank, behind)

    def give_way(self, should_stop: Callable[[], bool], rank: Rank = Rank.REST) -> float:
        """Let a lower rank that waits for a place have the caller's; return the seconds until it was back.

        Raises
        ------
        Cancelled
            When ``should_stop`` says so first. The caller holds a place all the same, until it releases it.
        """
        # Asked at every step: without the lock, at worst a step late.
        first = next(iter(self._waiting), None)
        if first is None or first[0] >= rank:
            return 0.0
        begin = time.perf_counter()
        with self._changed:
            self._free += 1
            self._changed.notify_all()
            # Before those of its own rank: it was there already.
            before = sum(each < rank for each, _ in self._waiting)
            if not self._wait(should_stop, rank, before):
                self._free -= 1
                raise Cancelled
        return time.perf_counter() - begin

    def _wait(self, should_stop: Callable[[], bool], rank: Rank, position: int) -> bool:
        ticket = (rank, object())
        self._waiting.insert(position, ticket)
        try:
            while not should_stop():
                if self._free > 0 and self._waiting[0] is ticket:
                    self._free -= 1
                    return True
                self._changed.wait()
            return False
        finally:
            self._waiting.remove(ticket)
            self._changed.notify_all()

    def release(self) -> None:
        """Give the place back."""
        with self._changed:
            self._free += 1
            self._changed.notify_all()

    def wake(self) -> None:
        """Make everyone who waits ask ``should_stop`` again."""
        with self._changed:
            self._changed.notify_all()
