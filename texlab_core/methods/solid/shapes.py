"""The histograms of all bands of a solid, measured, and bands moved toward the exemplar's in the same sweep."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.solid.gains import Reach
from texlab_core.methods.solid.rounds import add, cut
from texlab_core.methods.solid.slices import CUTS, Slices
from texlab_core.transforms import solid_laplacian

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from texlab_core.methods.heeger_bergen.analysis import Target
    from texlab_core.methods.solid.rounds import AxisModel, Plan, Volume
    from texlab_core.work.tasks import Task

# Quantiles that stand for a histogram, and bins that it is counted in.
QUANTILES = 256
BINS = 4096
_SHARES = (np.arange(QUANTILES) + 0.5) / QUANTILES
_PIECE = 2**18


@dataclass(frozen=True, eq=False)
class Shape:
    """The histogram of one band.

    Parameters
    ----------
    target
        The exemplar's.
    low, width
        Where its bins begin, and how wide they are.
    shares
        (BINS + 1,) float64: of the values below the bins' edges.
    """

    target: Target
    low: float
    width: float
    shares: NDArray[np.float64]

    @property
    def spread(self) -> float:
        """What distances are divided by."""
        return self.target.spread or 1.0

    @property
    def edges(self) -> NDArray[np.float64]:
        """(BINS + 1,) float64."""
        return np.linspace(self.low, self.low + BINS * self.width, BINS + 1)

    @cached_property
    def distance(self) -> float:
        """W1 / sd from the exemplar's."""
        from texlab_core.kernels import histograms

        theirs = np.empty(BINS + 1)
        histograms.shares_below(self.target.sample, self.low, self.width, theirs)
        apart = np.abs(self.shares - theirs)
        return float(apart.sum() - 0.5 * (apart[0] + apart[-1])) * self.width / self.spread

    @property
    def variance(self) -> float:
        """That of the values."""
        share = np.diff(self.shares)
        middle = (np.arange(BINS) + 0.5) * self.width
        mean = float(share @ middle)
        return float(share @ (middle - mean) ** 2)

    @cached_property
    def quantiles(self) -> NDArray[np.float64]:
        """(QUANTILES,) float64 of the values."""
        found: NDArray[np.float64] = np.interp(_SHARES, self.shares, self.edges)
        return found

    @cached_property
    def reach(self) -> Reach:
        """How near another strength brings it, one row."""
        wanted = _quantiles(self.target, _SHARES)
        return Reach.of(self.quantiles[None], wanted[None], np.array([self.spread]))

    def to_changes(self, band: Volume, step: float) -> Task[None]:
        """Replace the band's values by what matching would add to them, times a step."""
        from texlab_core.kernels import histograms

        table = _quantiles(self.target, self.shares).astype(np.float32)
        scale = np.float32(1 / self.width if self.width > 0 else 0)
        for piece in _pieces(band):
            histograms.to_changes(piece, np.float32(self.low), scale, table, np.float32(step))
            yield piece.size // 4


@dataclass(frozen=True, slots=True, eq=False)
class Strengths:
    """What strengths all bands have and may have, in the order of ``plan.labels``.

    Parameters
    ----------
    variances
        (bands,) float64.
    spreads
        (bands,) float64: what distances are divided by.
    reach
        How near other strengths bring them.
    """

    variances: NDArray[np.float64]
    spreads: NDArray[np.float64]
    reach: Reach

    @classmethod
    def of(cls, shapes: Sequence[Shape]) -> Strengths:
        """Put the bands' together."""
        return cls(
            np.array([each.variance for each in shapes]),
            np.array([each.spread for each in shapes]),
            Reach(np.vstack([each.reach.distances for each in shapes])),
        )


def sweep(
    volume: Volume, model: AxisModel, plan: Plan, step: Callable[[int, Shape], float]
) -> Task[tuple[list[Shape], Volume]]:
    """Measure the histograms of all bands, and move bands toward the exemplar's.

    Parameters
    ----------
    volume
        (D, H, W) float32; stays as it is.
    model, plan
        Targets, and how they are matched: pooled.
    step
        Says of a band how far it goes, in units of its way; 0 leaves it as it is.

    Returns
    -------
    shapes
        Of all bands of the volume as it was, in the order of ``plan.labels``.
    moved
        (D, H, W) float32; the volume itself when no band is moved.
    """
    found: list[Shape] = []
    moved = volume

    def look(band: Volume, target: Target) -> Task[bool]:
        shape = yield from shape_of(band, target)
        length = step(len(found), shape)
        found.append(shape)
        if length:
            yield from shape.to_changes(band, length)
        return bool(length)

    some = False
    bands = yield from solid_laplacian.build(volume, plan.levels)
    for key, band in zip(plan.keys, bands, strict=True):
        if (yield from look(band, model.solid.bands[key])):
            some = True
        else:
            band[...] = 0
    if some:
        moved = yield from solid_laplacian.collapse(bands)
        yield from add(moved, volume)
    del bands
    if plan.slices is not None and model.slices is not None:
        for axes in CUTS.values():
            slices = yield from cut(volume, axes)
            whole = Slices.of(slices, plan.slices)
            spectrum = yield from whole.forward(slices)
            total = None
            for key in plan.slices.keys(whole.size):
                band = yield from whole.band(spectrum, key)
                if (yield from look(band, model.slices.bands[key])):
                    total = np.zeros_like(spectrum) if total is None else total
                    yield from whole.add(total, key, band)
            if total is not None:
                moved = volume.copy() if moved is volume else moved
                yield from add(moved, (yield from whole.inverse(total)).transpose(np.argsort(axes)))
    return found, moved


def distances_of(shapes: Sequence[Shape]) -> NDArray[np.float64]:
    """Return W1 / sd of all bands, (bands,) float64."""
    return np.array([each.distance for each in shapes])


def shape_of(band: Volume, target: Target) -> Task[Shape]:
    """Count the values of a band."""
    from texlab_core.kernels import histograms

    low, high = float(target.sample[0]), float(target.sample[-1])
    for piece in _pieces(band):
        low, high = min(low, float(piece.min())), max(high, float(piece.max()))
        yield piece.size // 16
    width = (high - low) / BINS
    counts = np.zeros((2, BINS), np.int32)
    scale = np.float32(1 / width if width > 0 else 0)
    for piece in _pieces(band):
        histograms.count(piece, np.float32(low), scale, counts)
        yield piece.size // 8
    shares = np.concatenate([[0], np.cumsum(counts.sum(axis=0))]) / band.size
    return Shape(target, low, width, shares)


def _quantiles(target: Target, shares: NDArray[np.float64]) -> NDArray[np.float64]:
    places = (shares * target.sample.size - 0.5).clip(0, target.sample.size - 1)
    below = places.astype(np.intp)
    above = np.minimum(below + 1, target.sample.size - 1)
    share = places - below
    quantiles: NDArray[np.float64] = (1 - share) * target.sample[below] + share * target.sample[above]
    return quantiles


def _pieces(band: Volume) -> Iterator[Volume]:
    flat = band.reshape(-1)
    return (flat[start : start + _PIECE] for start in range(0, flat.size, _PIECE))
