"""Arrays that are made again when they are needed, kept meanwhile: so many bytes of them, whoever made them.

A cache that counts its arrays is a trap: as many of a large picture as of a small one weigh a thousand times more.
"""

from __future__ import annotations

import functools
import threading
from collections import OrderedDict
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar, cast

from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.work.tasks import Task

ArgumentsT = ParamSpec("ArgumentsT")
MadeT = TypeVar("MadeT", bound=NDArray[Any] | tuple[NDArray[Any], ...])

CAPACITY = 256 * 2**20


class ArrayCache:
    """Read-only arrays, or tuples of them, by key, the most recently used ones; safe to share between threads.

    Parameters
    ----------
    capacity
        Bytes that they may take together. The newest one is kept whatever it takes.
    """

    def __init__(self, capacity: int) -> None:
        self._capacity = capacity
        self._arrays: OrderedDict[tuple[object, ...], tuple[Any, int]] = OrderedDict()
        self._lock = threading.Lock()
        self._bytes = 0

    @property
    def nbytes(self) -> int:
        """Bytes held at the moment."""
        return self._bytes

    def get(self, key: tuple[object, ...], make: Callable[[], Task[MadeT]]) -> Task[MadeT]:
        """Return the value of this key, made piece by piece when it is not there."""
        found = self.find(key)
        if found is not None:
            return cast("MadeT", found)
        # Made outside the lock: two threads may do the same work, but none waits for another's.
        made = yield from make()
        return self.keep(key, made)

    def find(self, key: tuple[object, ...]) -> Any:
        """Return the value of this key, or None."""
        with self._lock:
            if key not in self._arrays:
                return None
            self._arrays.move_to_end(key)
            return self._arrays[key][0]

    def keep(self, key: tuple[object, ...], made: MadeT) -> MadeT:
        """Keep a value, unless another thread was faster; return the one that is kept."""
        parts = made if isinstance(made, tuple) else (made,)
        for each in parts:
            each.flags.writeable = False
        size = sum(each.nbytes for each in parts)
        with self._lock:
            kept = self._arrays.setdefault(key, (made, size))[0]
            self._bytes += size if kept is made else 0
            while self._bytes > self._capacity and len(self._arrays) > 1:
                self._drop()
        return cast("MadeT", kept)

    def shrink(self, nbytes: int) -> None:
        """Drop what was not used for longest until the rest takes no more than this."""
        with self._lock:
            while self._bytes > nbytes:
                self._drop()

    def clear(self) -> None:
        """Drop everything."""
        self.shrink(0)

    def _drop(self) -> None:
        self._bytes -= self._arrays.popitem(last=False)[1][1]


ARRAYS = ArrayCache(CAPACITY)


def shrink(nbytes: int) -> None:
    """Let go of arrays, which are made again when they are needed, until they take no more than this."""
    ARRAYS.shrink(nbytes)


def kept(make: Callable[ArgumentsT, MadeT]) -> Callable[ArgumentsT, MadeT]:
    """Keep what a function returns for each of its (hashable) arguments: arrays, which are read-only from then."""
    name = f"{make.__module__}.{make.__qualname__}"

    @functools.wraps(make)
    def find_or_make(*args: ArgumentsT.args, **named: ArgumentsT.kwargs) -> MadeT:
        key = (name, args, tuple(sorted(named.items())))
        found = ARRAYS.find(key)
        return ARRAYS.keep(key, make(*args, **named)) if found is None else cast("MadeT", found)

    return find_or_make
