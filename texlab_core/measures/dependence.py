"""How fine structure depends on coarse structure: child against parent, exemplar against result.

Heeger and Bergen's method matches every band alone, "made without asking the others"; the textbook calls that the
independence assumption. Here the joint histogram of the magnitudes of a band (child) and of the band one octave
below (parent) is taken, each magnitude replaced by its rank, so that only their dependence is left.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.measures._bands import ORIENTATIONS, oriented_bands
from texlab_core.measures.registry import Measure, register
from texlab_core.transforms.luma import luma

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.measures.subject import Subject

BINS = 8
BORDER = 12
SMALLEST = 40


def joint_ranks(first: NDArray[np.floating], second: NDArray[np.floating]) -> NDArray[np.float64]:
    """Return the joint histogram of the ranks of two arrays of one shape.

    Returns
    -------
    ndarray
        (8, 8) float64 that sums to 1; rows are eighths of the first array's values by rank, columns of the
        second's. All are 1 / 64 where they are independent; the diagonal holds all where one follows from the
        other. Each column times 8 is the distribution of the first, given that eighth of the second.
    """
    rows, columns = _eighths(first), _eighths(second)
    counts = np.bincount(rows * BINS + columns, minlength=BINS * BINS)
    return counts.reshape(BINS, BINS) / rows.size


def _eighths(values: NDArray[np.floating]) -> NDArray[np.int64]:
    flat = values.reshape(-1)
    edges = np.quantile(flat, np.arange(1, BINS) / BINS)
    return np.searchsorted(edges, flat, side="left")


def child_and_parent(image: FloatImage, look: Callable[[], None]) -> NDArray[np.float64]:
    """Return the joint histograms (4, 8, 8) of the finest magnitudes with their parents, by orientation."""
    magnitudes: dict[tuple[int, int], NDArray[np.float32]] = {}
    for octave, orientation, band in oriented_bands(luma(image), 2, look):
        look()
        magnitudes[octave, orientation] = np.abs(band)
    height, width = image.shape[:2]
    inner = slice(BORDER, height - BORDER), slice(BORDER, width - BORDER)
    found = []
    for orientation in range(ORIENTATIONS):
        look()
        child, parent = magnitudes[0, orientation], magnitudes[1, orientation]
        rows = np.arange(height) * parent.shape[0] // height
        columns = np.arange(width) * parent.shape[1] // width
        found.append(joint_ranks(child[inner], parent[np.ix_(rows, columns)][inner]))
    return np.array(found)


def dependence_difference(subject: Subject) -> float | None:
    """Return the total variation (0 .. 1) between the joint histograms, mean over the orientations."""
    if min(*subject.image.shape[:2], *subject.pixels.shape[:2]) < SMALLEST:
        return None
    own = subject.prepared("child and parent", child_and_parent)
    other = subject.once("child and parent", lambda: child_and_parent(subject.image, subject.look))
    return float(np.abs(own - other).sum(axis=(1, 2)).mean()) / 2


register(
    Measure(
        id="dependence-difference",
        title="dependence",
        summary="How differently fine details depend on coarse ones: total variation between the joint histograms "
        "of a band's magnitudes and its parent's, by rank. 0 for the exemplar itself; what matching every band "
        "alone loses.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("exemplar",),
        function=dependence_difference,
        form=".3f",
        reference="D. A. Forsyth and J. Ponce, Computer Vision, section 11.3.2; D. J. Heeger and J. R. Bergen, "
        "SIGGRAPH 1995, section 6",
        order=62,
    )
)
