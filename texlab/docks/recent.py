"""The last few values that were computed, shared between threads, and keys by identity."""

from __future__ import annotations

import threading
from collections import OrderedDict
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable

ValueT = TypeVar("ValueT")

# Enough for going back and forth between what is compared.
MOST = 12


class Same:
    """Makes any object a part of a key: equal only to itself, and alive as long as the key."""

    __slots__ = ("value",)

    def __init__(self, value: object) -> None:
        self.value = value

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Same) and other.value is self.value

    def __hash__(self) -> int:
        return id(self.value)


class Recent:
    """Values by key, the most recently used ones, as many as weigh no more than ``capacity`` together.

    Parameters
    ----------
    capacity
        What they may weigh together.
    weigh
        What one weighs; 1 without it.
    most
        How many there may be, whatever they weigh: keys hold what they tell apart.
    """

    def __init__(self, capacity: float, weigh: Callable[[Any], float] | None = None, most: int = MOST) -> None:
        self._capacity = capacity
        self._most = most
        self._weigh = weigh or (lambda value: 1.0)
        self._values: OrderedDict[Hashable, Any] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, key: Hashable, make: Callable[[], ValueT]) -> ValueT:
        """Return the value of this key, making it (outside the lock) when it is not there.

        The newest two values stay, whatever they weigh.
        """
        with self._lock:
            if key in self._values:
                self._values.move_to_end(key)
                found: ValueT = self._values[key]
                return found
        made = make()
        with self._lock:
            kept: ValueT = self._values.setdefault(key, made)
            weight = sum(self._weigh(value) for value in self._values.values())
            while (weight > self._capacity or len(self._values) > self._most) and len(self._values) > 2:
                weight -= self._weigh(self._values.popitem(last=False)[1])
        return kept

    def __len__(self) -> int:
        return len(self._values)

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._values.clear()
