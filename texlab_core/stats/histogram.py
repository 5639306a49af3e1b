"""Histogram matching: exactly by rank, or through the lookup tables of the paper.

A target is the sorted sample whose distribution is wanted (:func:`sorted_sample`); its size need not be that of
the values. All functions work on flat or shaped float32 arrays and keep their shape.

Reference: Heeger and Bergen 1995, section 2.2; Forsyth and Ponce, section 11.3.2, algorithm 11.3.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from collections.abc import Generator

Sample = NDArray[np.float32]

PAPER_BINS = 256
PREVIEW_BINS = 16384


def sorted_sample(values: NDArray[Any]) -> Sample:
    """Return the values as a target: flat, sorted, float32."""
    ordered: Sample = np.sort(np.asarray(values, np.float32), axis=None)
    return ordered


def resample(target: Sample, count: int) -> Sample:
    """Return a sorted sample of another size: its values at (i + 1/2) m / n - 1/2, between two by a straight line.

    Parameters
    ----------
    target
        (m,) sorted, m >= 1.
    count
        n, the size wanted.
    """
    if count == target.size:
        return target
    places = (np.arange(count) + 0.5) * (target.size / count) - 0.5
    resampled: Sample = np.interp(places, np.arange(target.size), target).astype(np.float32)
    return resampled


def match_ranks(values: NDArray[Any], target: Sample, key: int = 0) -> Sample:
    """Give the values the target's distribution exactly, keeping their order.

    Parameters
    ----------
    values
        Any shape, finite; taken as float32.
    target
        Sorted sample of any size; of the same size the result holds exactly its values.
    key
        64-bit key of the random order of equal values (``streams.key(...)``): without it an area of one
        value would be filled in raster order.

    Returns
    -------
    ndarray
        float32, of the same shape.
    """
    matched = np.array(values, np.float32, order="C")
    steps = match_ranks_in_place(matched, target, key)
    while True:
        try:
            next(steps)
        except StopIteration:
            return matched


def match_ranks_in_place(values: Sample, target: Sample, key: int) -> Generator[None, None, float]:
    """Do :func:`match_ranks` in place, in pieces of at most about 5 ms.

    Parameters
    ----------
    values
        float32, C-contiguous, any shape; overwritten.
    target, key
        As in :func:`match_ranks`.

    Yields
    ------
    None
        Between two pieces.

    Returns
    -------
    float
        Mean absolute change, which is the Wasserstein-1 distance that the values had from the target.
    """
    from texlab_core.kernels import ranks

    if values.dtype != np.float32 or not values.flags.c_contiguous:
        raise ValueError("Matching in place needs contiguous float32 values.")
    flat = values.reshape(-1)
    many, seed = flat.size, np.uint64(key)
    if many <= ranks.CHUNK:
        return float(ranks.match(flat, target, seed)) / many
    pieces = [(start, min(start + ranks.CHUNK, many)) for start in range(0, many, ranks.CHUNK)]
    bits = flat.view(np.uint32)
    counts = np.zeros((ranks.PASSES, ranks.DIGITS), np.int64)
    first, second = np.empty(many, np.uint64), np.empty(many, np.uint64)
    for start, stop in pieces:
        ranks.count(bits, start, stop, counts)
        yield
    ranks.starts(counts)
    for start, stop in pieces:
        ranks.scatter_first(bits, start, stop, counts, first)
        yield
    for number, source, items in ((1, first, second), (2, second, first)):
        for start, stop in pieces:
            ranks.scatter_next(source, start, stop, number, counts, items)
            yield
    run = 0
    for start, stop in pieces:
        run = ranks.shuffle_ties(first, start, stop, run, seed)
        yield
    moved = 0.0
    for start, stop in pieces:
        moved += ranks.assign(first, start, stop, target, flat)
        yield
    return moved / many


@dataclass(frozen=True, slots=True, eq=False)
class Tables:
    """The two lookup tables of a sample.

    Parameters
    ----------
    low, high
        Range of the sample.
    cdf
        (bins + 1,) float64 from 0 to 1: share of the sample below each edge of the bins.
    inverse
        (bins + 1,) float64: the cdf resampled at evenly spaced shares.
    """

    low: float
    high: float
    cdf: NDArray[np.float64]
    inverse: NDArray[np.float64]


def tables(values: NDArray[Any], bins: int = PAPER_BINS) -> Tables:
    """Make the cdf of a sample from its histogram, and the inverse of the cdf.

    Reference: Heeger and Bergen 1995, section 2.2.
    """
    flat = np.asarray(values, np.float64).reshape(-1)
    low, high = float(flat.min()), float(flat.max())
    edges = np.linspace(low, high, bins + 1)
    cdf = np.concatenate([[0.0], np.cumsum(np.bincount(_bin_places(flat, low, high, bins)[0], minlength=bins))])
    cdf /= flat.size
    return Tables(low, high, cdf, np.interp(np.linspace(0, 1, bins + 1), cdf, edges))


def match_tables(values: NDArray[Any], target: Tables) -> Sample:
    """Give the values about the target's distribution: through their cdf and the target's inverse cdf.

    Equal values stay equal, and what is finer than a bin of the target is lost: with 256 bins as in the paper this
    can be seen; with :data:`PREVIEW_BINS` the distance left is below 1e-3 standard deviations.

    Parameters
    ----------
    values
        Any shape, finite.
    target
        From :func:`tables`; the values get as many bins.

    Returns
    -------
    ndarray
        float32, of the same shape.
    """
    bins = target.cdf.size - 1
    flat = np.asarray(values, np.float32).reshape(-1)
    low, high = float(flat.min()), float(flat.max())
    place, within = _bin_places(flat, low, high, bins)
    counts = np.bincount(place, minlength=bins)
    below = np.concatenate([[0.0], np.cumsum(counts)[:-1]]) / flat.size * bins
    share = (below.astype(np.float32))[place] + (counts / flat.size * bins).astype(np.float32)[place] * within
    index = np.minimum(share.astype(np.intp), bins - 1)
    start = target.inverse[:-1].astype(np.float32)
    rise = np.diff(target.inverse).astype(np.float32)
    matched: Sample = (start[index] + rise[index] * (share - index)).astype(np.float32)
    return matched.reshape(np.shape(values))


def _bin_places(flat: NDArray[Any], low: float, high: float, bins: int) -> tuple[NDArray[np.intp], NDArray[Any]]:
    """Return each value's bin, and where in the bin it lies, from 0 to 1."""
    scaled = (flat - flat.dtype.type(low)) * flat.dtype.type(bins / (high - low) if high > low else 0)
    place = np.minimum(scaled.astype(np.intp), bins - 1)
    return place, scaled - place
