"""A result that repeats itself at its exemplar's sides, and the seam where it is laid side by side."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np

from texlab_core.measures.cuts import SMALLEST, usual
from texlab_core.measures.registry import Measure, register
from texlab_core.transforms.luma import luma

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.measures.subject import Subject

Axis = Literal["row", "column"]
_FLAT = 0.5 / 255
# Below a quarter of the exemplar the overlap of picture and shifted picture says little.
_LEAST = 4


def lag_correlation(gray: NDArray[np.float32], axis: int, lag: int) -> float | None:
    """Return the correlation of a plane with itself, shifted; None where it is flat or too short for the lag."""
    moved = np.moveaxis(gray, axis, 0)
    if moved.shape[0] < lag + max(lag // _LEAST, 2):
        return None
    first, second = (part - part.mean(dtype=np.float64) for part in (moved[lag:], moved[:-lag]))
    spread = first.std() * second.std()
    return float(np.mean(first * second) / spread) if spread > _FLAT**2 else None


def self_repetition(subject: Subject) -> float | None:
    """Return the larger correlation of the picture with itself, shifted by the exemplar's height or width."""
    gray = subject.once("gray", lambda: luma(subject.image))
    found = []
    for axis, lag in enumerate(subject.pixels.shape[:2]):
        subject.look()
        found.append(lag_correlation(gray, axis, lag))
    values = [each for each in found if each is not None]
    return max(0.0, *values) if values else None


def seams(subject: Subject) -> dict[Axis, float] | None:
    """Return by how many robust deviations of the exemplar's lines the picture jumps around its borders.

    The jump across the border, less the mean of those across the lines on both sides of it, as in cuts: by ``row``
    from the last row to the first, by ``column`` from the last column to the first. None where picture or exemplar
    are under 16 pixels wide or high.
    """
    if min(*subject.image.shape[:2], *subject.pixels.shape[:2]) < SMALLEST:
        return None
    exemplar = subject.prepared("lines", usual)
    found: dict[Axis, float] = {}
    axes: tuple[tuple[Axis, FloatImage], ...] = (
        ("row", subject.image),
        ("column", subject.image.transpose(1, 0, 2)),
    )
    for axis, image in axes:
        subject.look()
        around = np.concatenate([image[-2:], image[:2]])
        before, jump, after = np.abs(np.diff(around, axis=0)).mean(axis=(1, 2), dtype=np.float64)
        middle, deviation = exemplar[axis]
        found[axis] = (float(jump - (before + after) / 2) - middle) / deviation
    return found


def seam(subject: Subject) -> float | None:
    """Return the larger one of :func:`seams`."""
    found = seams(subject)
    return None if found is None else max(found.values())


register(
    Measure(
        id="self-repetition",
        title="repeats",
        summary="Correlation of the result with itself, shifted by the exemplar's height or width: 100% for a "
        "tiling, and for an exemplar whose own period divides its side.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("exemplar",),
        function=self_repetition,
        form=".0%",
        order=32,
    )
)
register(
    Measure(
        id="seam",
        title="seam",
        summary="How much the result jumps where it is laid beside itself, in robust deviations of the exemplar's "
        "own lines: below 5 it tiles, well above the exemplar's cuts it does not.",
        low=-1e4,
        high=1e4,
        better="lower",
        needs=("exemplar",),
        function=seam,
        form=".1f",
        order=42,
    )
)
