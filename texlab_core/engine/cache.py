"""Models kept by analysis key."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np


class AnalysisCache:
    """Models by analysis key, the most recently used ones; safe to share between threads.

    Parameters
    ----------
    capacity
        How many models are kept.
    max_bytes
        How much their arrays may take together; the newest model is kept whatever it takes.
    """

    def __init__(self, capacity: int = 16, max_bytes: int = 2**30) -> None:
        self._capacity = capacity
        self._max_bytes = max_bytes
        self._models: OrderedDict[tuple[object, ...], Any] = OrderedDict()
        self._sizes: dict[tuple[object, ...], int] = {}
        self._lock = threading.Lock()

    def get(self, key: tuple[object, ...]) -> Any | None:
        """Return the model, or None."""
        with self._lock:
            if key in self._models:
                self._models.move_to_end(key)
            return self._models.get(key)

    def put(self, key: tuple[object, ...], model: Any) -> None:
        """Keep a model, dropping those that were not used for longest."""
        size = array_bytes(model)
        with self._lock:
            self._models[key], self._sizes[key] = model, size
            self._models.move_to_end(key)
            while len(self._models) > self._capacity or (
                len(self._models) > 1 and sum(self._sizes.values()) > self._max_bytes
            ):
                del self._sizes[self._models.popitem(last=False)[0]]

    def clear(self) -> None:
        """Forget everything."""
        with self._lock:
            self._models.clear()
            self._sizes.clear()


def array_bytes(value: object, seen: set[int] | None = None) -> int:
    """Return how many bytes the arrays in dataclasses and containers take, shared ones counted once."""
    seen = set() if seen is None else seen
    if id(value) in seen:
        return 0
    seen.add(id(value))
    if isinstance(value, np.ndarray):
        return array_bytes(value.base, seen) if isinstance(value.base, np.ndarray) else value.nbytes
    if is_dataclass(value):
        return sum(array_bytes(getattr(value, each.name, None), seen) for each in fields(value))
    if isinstance(value, Mapping):
        return sum(array_bytes(each, seen) for each in value.values())
    if isinstance(value, list | tuple | set | frozenset):
        return sum(array_bytes(each, seen) for each in value)
    return 0
