"""Colours that the exemplar does not have."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.measures.registry import Measure, register
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray
    from scipy.spatial import cKDTree

    from texlab_core.engine.steps import FloatImage
    from texlab_core.measures.subject import Subject

# A ninth of the pixels tells the mean well enough, and of large pictures so many do.
STEP = 3
MOST = 2**14
_QUERIES = 1024


def _tree(pixels: FloatImage, look: Callable[[], None]) -> cKDTree:
    from scipy.spatial import cKDTree

    levels = np.rint(_rgb(pixels) * 255).reshape(-1, 3)
    look()
    return cKDTree(np.unique(levels, axis=0))


def _rgb(pixels: FloatImage) -> FloatImage:
    return pixels if pixels.shape[2] == 3 else np.repeat(pixels, 3, axis=2)


def step_of(size: tuple[int, ...]) -> int:
    """Return of how many pixels in a row one is looked at: three, or more in a picture above 384 x 384."""
    return max(STEP, math.ceil(math.sqrt(math.prod(size[:2]) / MOST)))


def palette_map(subject: Subject) -> NDArray[np.float64]:
    """Return how far the colour of every third pixel of every third row is from the exemplar's nearest colour.

    Returns
    -------
    ndarray
        (ceil(H / step), ceil(W / step)) float64 in gray levels of 255, Euclidean in RGB at 8 bits; the step is
        that of :func:`step_of`.
    """
    step = step_of(subject.image.shape)

    def measure() -> NDArray[np.float64]:
        tree = subject.prepared("palette", _tree)
        sampled = _rgb(subject.image[::step, ::step])
        levels = np.rint(sampled * 255).reshape(-1, 3)
        nearest = np.empty(len(levels))
        for rows in row_blocks((len(levels), 3), 3 * _QUERIES):
            subject.look()
            nearest[rows] = tree.query(levels[rows])[0]
        return nearest.reshape(sampled.shape[:2])

    return subject.once("palette map", measure)


def palette_distance(subject: Subject) -> float | None:
    """Return the mean of :func:`palette_map`; None for an empty picture."""
    return float(palette_map(subject).mean()) if subject.image.size else None


register(
    Measure(
        id="palette-distance",
        title="new colours",
        summary="How far colours are from the exemplar's nearest colour, on average, in gray levels of 255: 0 "
        "where every colour is one of the exemplar's, 5 and more where new colours strike the eye.",
        low=0.0,
        high=442.0,
        better="lower",
        needs=("exemplar",),
        function=palette_distance,
        unit="gray levels",
        form=".2f",
        reference="D. J. Heeger and J. R. Bergen, SIGGRAPH 1995, section 3.5",
        order=66,
    )
)
