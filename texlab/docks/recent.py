"""The last few values that were computed, shared between threads, and keys by identity."""

from __future__ import annotations

import threading
import weakref
from collections import OrderedDict, deque
from typing import TYPE_CHECKING, Any, TypeVar

from texlab_core.engine.cache import array_bytes

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterator

ValueT = TypeVar("ValueT")

# Enough for going back and forth between what is compared.
MOST = 12
# What is counted is weighed too: of a picture of 16 megapixels a few are too many.
MOST_BYTES = 96 * 2**20


class Same:
    """Makes any object a part of a key: equal only to itself, and to nothing once the object has gone.

    It does not keep the object alive, where the object's type allows that: a key that waits for another question
    would hold a whole result.
    """

    __slots__ = ("_hash", "_held", "_reference")

    def __init__(self, value: object) -> None:
        self._hash = id(value)
        self._held: object = None
        self._reference: weakref.ref[Any] | None = None
        try:
            self._reference = weakref.ref(value)
        except TypeError:
            # Tuples, numbers and None.
            self._held = value

    @property
    def value(self) -> Any:
        """The object; None when it has gone."""
        return self._held if self._reference is None else self._reference()

    @property
    def gone(self) -> bool:
        """Whether the object has gone."""
        return self._reference is not None and self._reference() is None

    def __eq__(self, other: object) -> bool:
        if self is other:
            return True
        return isinstance(other, Same) and not self.gone and not other.gone and other.value is self.value

    def __hash__(self) -> int:
        return self._hash

    def watch(self, gone: Callable[[weakref.ref[Any]], None]) -> weakref.ref[Any] | None:
        """Return what calls ``gone`` when the object goes, as long as it is held; None when the object stays."""
        value = self.value
        return None if self._reference is None or value is None else weakref.ref(value, gone)


class Recent:
    """Values by key, the most recently used ones, as many as weigh no more than ``capacity`` together.

    Without ``weigh`` at most ``capacity`` values, whose arrays take no more than 96 MB together.

    What was made of something that has gone goes too: a value whose key holds a :class:`Same` of it.

    Parameters
    ----------
    capacity
        What they may weigh together.
    weigh
        What one weighs; asked once, when it is made.
    most
        How many there may be, whatever they weigh.
    """

    def __init__(self, capacity: float, weigh: Callable[[Any], float] | None = None, most: int = MOST) -> None:
        self._capacity: float = MOST_BYTES if weigh is None else capacity
        self._most = most if weigh is not None else min(most, int(capacity))
        self._weigh = weigh or _bytes_of
        self._values: OrderedDict[Hashable, Any] = OrderedDict()
        self._weights: dict[Hashable, float] = {}
        self._watched: dict[Hashable, tuple[weakref.ref[Any], ...]] = {}
        # Keys of what has gone; objects go at any moment, also while the lock is held.
        self._gone: deque[Hashable] = deque()
        self._lock = threading.Lock()

    def get(self, key: Hashable, make: Callable[[], ValueT]) -> ValueT:
        """Return the value of this key, making it (outside the lock) when it is not there.

        The newest two values stay, whatever they weigh, as long as what they were made of is there.
        """
        known = self._find(key)
        if known is not None:
            found: ValueT = known[0]
            return found
        made = make()
        watched, weight = self._watch(key), self._weigh(made)
        with self._lock:
            kept: ValueT = self._values.setdefault(key, made)
            self._watched.setdefault(key, watched)
            self._weights.setdefault(key, weight)
            while len(self._values) > 2 and (
                len(self._values) > self._most or sum(self._weights.values()) > self._capacity
            ):
                self._drop(next(iter(self._values)))
        if any(each.gone for each in _parts(key)):
            # It went before it was kept.
            self._gone.append(key)
        self._drop_gone()
        return kept

    def _find(self, key: Hashable) -> tuple[Any] | None:
        try:
            with self._lock:
                if key not in self._values:
                    return None
                self._values.move_to_end(key)
                return (self._values[key],)
        finally:
            self._drop_gone()

    def __len__(self) -> int:
        return len(self._values)

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._values.clear()
            self._watched.clear()
            self._weights.clear()

    def _watch(self, key: Hashable) -> tuple[weakref.ref[Any], ...]:
        """Notice when a part of a key goes."""
        # A thread may still hold the reference when nobody holds this any more.
        mine = weakref.ref(self)

        def gone(_: weakref.ref[Any]) -> None:
            recent = mine()
            if recent is not None:
                recent._gone.append(key)
                recent._drop_gone()

        return tuple(found for each in _parts(key) if (found := each.watch(gone)) is not None)

    def _drop_gone(self) -> None:
        # Whoever holds the lock does this when it has let go of it.
        while self._gone and self._lock.acquire(blocking=False):
            try:
                if self._gone:
                    self._drop(self._gone.popleft())
            finally:
                self._lock.release()

    def _drop(self, key: Hashable) -> None:
        self._values.pop(key, None)
        self._watched.pop(key, None)
        self._weights.pop(key, None)


def _parts(key: Hashable) -> Iterator[Same]:
    """Yield what in a key stands for an object."""
    if isinstance(key, Same):
        yield key
    elif isinstance(key, tuple):
        for each in key:
            yield from _parts(each)


def _bytes_of(value: object) -> int:
    return array_bytes(value, set())
