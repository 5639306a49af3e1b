"""The last few values that were computed, shared between threads, and keys by identity."""

from __future__ import annotations

import threading
from collections import OrderedDict
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable

ValueT = TypeVar("ValueT")


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
    """Values by key, the most recently used ones."""

    def __init__(self, capacity: int) -> None:
        self._capacity = capacity
        self._values: OrderedDict[Hashable, Any] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, key: Hashable, make: Callable[[], ValueT]) -> ValueT:
        """Return the value of this key, making it (outside the lock) when it is not there."""
        with self._lock:
            if key in self._values:
                self._values.move_to_end(key)
                found: ValueT = self._values[key]
                return found
        made = make()
        with self._lock:
            kept: ValueT = self._values.setdefault(key, made)
            while len(self._values) > self._capacity:
                self._values.popitem(last=False)
        return kept
