"""What a computation tells the outside: steps while it runs, an output at its end, a result with its job."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping


FloatImage = NDArray[np.float32]
FloatVolume = NDArray[np.float32]
MapKind = Literal["source", "count", "label", "scalar"]
Phase = Literal["analysis", "synthesis"]


@dataclass(frozen=True, slots=True)
class Step:
    """One moment of a computation.

    Parameters
    ----------
    done, total
        Progress in units of the method's own; ``done`` never falls within one phase, ``0 <= done <= total``.
    stage
        What is being done, for people ("iteration 3 of 5").
    metrics
        Numbers worth watching, by name.
    preview
        Makes a picture of the state, (H, W, C) float32 in [0, 1]; valid only until the computation goes on. Of a
        volume it is the middle slice.
    frame
        Name of a stage worth keeping for the scrubber ("noise", "iteration 3", "level 2"); needs a ``preview``.
    state
        Makes a snapshot, named arrays of which an ``ArraysInput`` can be made, so that a job with this input goes
        on from here; call it before the computation goes on, or after it was stopped at this step.
    phase
        Filled in by ``run``.
    filled
        Tells which pixels of the preview have their value already, (H, W) bool; None when all have. Valid as long.
    """

    done: int
    total: int
    stage: str = ""
    metrics: Mapping[str, float] = field(default_factory=dict)
    preview: Callable[[], FloatImage] | None = None
    frame: str | None = None
    state: Callable[[], Mapping[str, NDArray[Any]]] | None = None
    phase: Phase = "synthesis"
    filled: Callable[[], NDArray[np.bool_]] | None = None

    @property
    def fraction(self) -> float:
        """Progress from 0 to 1."""
        return self.done / self.total if self.total else 1.0


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Map:
    """Data on the result's own grid; colour is the view's.

    Parameters
    ----------
    data
        ``source``: (H, W, 2) int32, row and column in the exemplar; ``count``: (H, W) integers;
        ``label``: (H, W) int32, 0 is none; ``scalar``: (H, W) float32. On a volume's grid they have D before H.
    kind
        Decides how it is shown.
    title
        For people.
    unit
        Unit of the values.
    """

    data: NDArray[Any]
    kind: MapKind
    title: str
    unit: str = ""

    def __repr__(self) -> str:
        """Return one short line."""
        return f"<Map: {self.title}, {self.kind}, {' x '.join(map(str, self.data.shape))} {self.data.dtype}>"

    @property
    def plane(self) -> Map:
        """The map itself, or the middle slice of one on a volume's grid."""
        if self.data.ndim == (3 if self.kind == "source" else 2):
            return self
        return replace(self, data=middle_slice(self.data))


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Curve:
    """A series of numbers: ``y`` over ``x``, (n,) float64 each.

    A ``reference`` is drawn beside other curves of the same axes, for holding them against it.
    """

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    title: str
    x_label: str = "iteration"
    y_label: str = ""
    reference: bool = False

    def __repr__(self) -> str:
        """Return one short line."""
        return f"<Curve: {self.title}, {self.y.size} points>"

    @classmethod
    def of(
        cls,
        y: Any,
        title: str,
        *,
        x: Any = None,
        x_label: str = "iteration",
        y_label: str = "",
        reference: bool = False,
    ) -> Curve:
        """Make a curve from any sequences; ``x`` counts from 0 when left out."""
        values = np.asarray(y, dtype=np.float64)
        places = np.arange(values.size, dtype=np.float64) if x is None else np.asarray(x, dtype=np.float64)
        return cls(places, values, title, x_label, y_label, reference)


@dataclass(frozen=True, eq=False, kw_only=True, repr=False)
class Output:
    """What a method's ``synthesize`` returns.

    Parameters
    ----------
    image
        (H, W, C) float32 in [0, 1], of the size that was asked for. Left out, it is the volume's middle slice.
    volume
        (D, H, W, C) float32 in [0, 1], from methods of three dimensions; else None.
    maps, curves
        Evidence by name (lower-case words with hyphens).
    measures
        Single numbers by name.
    notes
        One sentence each about what was done to the input ("2 rows were cropped").
    details
        Whatever the method's own views need to explain the result; nobody else looks inside.
    """

    image: FloatImage = None  # type: ignore[assignment]  # None is replaced in __post_init__
    volume: FloatVolume | None = None
    maps: Mapping[str, Map] = field(default_factory=dict)
    curves: Mapping[str, Curve] = field(default_factory=dict)
    measures: Mapping[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    details: Any = None

    def __repr__(self) -> str:
        """Return one short line."""
        return f"<Output: {' x '.join(map(str, self.image.shape))} {self.image.dtype}>"

    def __post_init__(self) -> None:
        image: FloatImage | None = self.image
        if image is None:
            if self.volume is None:
                raise TypeError("An output needs an image or a volume.")
            object.__setattr__(self, "image", middle_slice(self.volume))


def middle_slice(volume: NDArray[Any]) -> NDArray[Any]:
    """Return the slice (H, W, ...) that stands for a volume (D, H, W, ...) as a picture, as a copy."""
    middle: NDArray[Any] = volume[volume.shape[0] // 2].copy()
    return middle
