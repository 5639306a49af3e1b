"""What measures are asked about: an image, its exemplar, and what came with it."""

from __future__ import annotations

import threading
from collections import OrderedDict
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeVar

from texlab_core.engine.cache import array_bytes
from texlab_core.engine.inputs import ImageInput
from texlab_core.errors import Cancelled
from texlab_core.images.exemplar import as_exemplar
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import numpy as np
    from numpy.typing import NDArray

    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import Curve, FloatImage, Map, MapKind
    from texlab_core.images.exemplar import Source

ValueT = TypeVar("ValueT")


class PreparedCache:
    """What was computed from an exemplar alone, by its hash; what was not used for longest goes first.

    Parameters
    ----------
    max_bytes
        How much the kept arrays may take together.
    exemplars
        How many exemplars something is kept of; None for no limit.

    Any number of threads may use it; two that miss the same thing at once both compute it.
    """

    def __init__(self, max_bytes: int = 64 * 2**20, exemplars: int | None = None) -> None:
        self._max_bytes = max_bytes
        self._exemplars = exemplars
        self._kept: OrderedDict[tuple[str, str], tuple[Any, int]] = OrderedDict()
        self._lock = threading.Lock()

    def get(self, key: tuple[str, str], make: Callable[[], ValueT]) -> ValueT:
        """Return what is kept under (name, hash), or make it and keep it."""
        with self._lock:
            found = self._kept.get(key)
            if found is not None:
                self._kept.move_to_end(key)
                kept: ValueT = found[0]
                return kept
        value = make()
        with self._lock:
            self._kept[key] = value, array_bytes(value) + 256
            while len(self._kept) > 1 and self.nbytes > self._max_bytes:
                self._kept.popitem(last=False)
            if self._exemplars is not None:
                self._forget_exemplars(self._exemplars)
        return value

    def _forget_exemplars(self, count: int) -> None:
        """Keep only what belongs to the exemplars that were used last."""
        recent = set(list(dict.fromkeys(sha256 for _, sha256 in reversed(self._kept)))[:count])
        for key in [key for key in self._kept if key[1] not in recent]:
            del self._kept[key]

    @property
    def nbytes(self) -> int:
        """Bytes of everything that is kept."""
        return sum(size for _, size in self._kept.values())

    def __len__(self) -> int:
        return len(self._kept)


@dataclass(frozen=True, eq=False, kw_only=True)
class Subject:
    """An image to be measured.

    Parameters
    ----------
    image
        (H, W, C) float32 in [0, 1], C is 1 or 3.
    exemplar
        What it was made from, if that is known.
    maps, curves
        Evidence of the method, by name.
    given
        What the method itself says, by measure id.
    model
        The method's analysis.
    method
        Its id, empty if unknown (an image from another program).
    cache
        Where the exemplar's part is kept from one subject to the next.
    look
        Called every few milliseconds; may raise ``Cancelled`` to stop.
    """

    image: FloatImage
    exemplar: ImageInput | None = None
    maps: Mapping[str, Map] = field(default_factory=dict)
    curves: Mapping[str, Curve] = field(default_factory=dict)
    given: Mapping[str, float] = field(default_factory=dict)
    model: Any = None
    method: str = ""
    cache: PreparedCache = field(default_factory=PreparedCache)
    look: Callable[[], None] = go_on
    _once: dict[str, Any] = field(default_factory=dict, init=False, repr=False)

    @classmethod
    def of_result(
        cls,
        result: Result,
        cache: PreparedCache | None = None,
        should_stop: Callable[[], bool] | None = None,
    ) -> Subject:
        """Make a subject of a result."""
        exemplar = result.job.inputs.get("exemplar")
        return cls(
            image=result.image,
            exemplar=exemplar if isinstance(exemplar, ImageInput) else None,
            maps=result.maps,
            curves=result.curves,
            given=result.measures,
            model=result.model,
            method=result.job.method,
            cache=PreparedCache() if cache is None else cache,
            look=go_on if should_stop is None else stopping(should_stop),
        )

    @classmethod
    def of_images(
        cls,
        exemplar: Source,
        image: Source,
        cache: PreparedCache | None = None,
        should_stop: Callable[[], bool] | None = None,
    ) -> Subject:
        """Make a subject of an exemplar and any picture: arrays, files or image inputs.

        Raises
        ------
        ImageError
            When one of them is none.
        """
        return cls(
            image=as_exemplar(image).pixels,
            exemplar=as_exemplar(exemplar),
            cache=PreparedCache() if cache is None else cache,
            look=go_on if should_stop is None else stopping(should_stop),
        )

    def has(self, needs: tuple[str, ...]) -> bool:
        """Whether there is all that a measure needs."""
        there = {
            "exemplar": self.exemplar is not None,
            "source": self.source is not None,
            "counts": self.first_map("count") is not None,
            "curves": bool(self.curves),
            "model": self.model is not None,
            "method": bool(self.given),
        }
        return all(there[each] for each in needs)

    @property
    def source(self) -> NDArray[np.int32] | None:
        """(H, W, 2) int32: row and column in the exemplar of every pixel, if the method says so."""
        return self.first_map("source")

    def first_map(self, kind: MapKind) -> NDArray[Any] | None:
        """Return the data of the first map of a kind; None without one."""
        # One by one: some maps are only computed when they are looked at.
        return self.once(
            f"map {kind}",
            lambda: next((each.data for each in map(self.maps.__getitem__, self.maps) if each.kind == kind), None),
        )

    @property
    def pixels(self) -> FloatImage:
        """The exemplar's pixels; raises ``LookupError`` without one."""
        if self.exemplar is None:
            raise LookupError("This subject has no exemplar.")
        return self.exemplar.pixels

    def prepared(self, name: str, make: Callable[[FloatImage, Callable[[], None]], ValueT]) -> ValueT:
        """Return ``make(exemplar's pixels, look)``, kept in the cache by name and the exemplar's hash."""
        if self.exemplar is None:
            raise LookupError("This subject has no exemplar.")
        return self.cache.get((name, self.exemplar.sha256), lambda: make(self.pixels, self.look))

    def once(self, name: str, make: Callable[[], ValueT]) -> ValueT:
        """Return ``make()``, computed once for all measures of this subject."""
        if name not in self._once:
            self._once[name] = make()
        kept: ValueT = self._once[name]
        return kept


def stopping(should_stop: Callable[[], bool]) -> Callable[[], None]:
    """Return a ``look`` that raises ``Cancelled`` when ``should_stop`` says so."""

    def look() -> None:
        if should_stop():
            raise Cancelled

    return look
