"""The histograms of all bands of a solid, measured but not matched, and bands moved toward the exemplar's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.heeger_bergen.rounds import match
from texlab_core.methods.solid.rounds import add, cut
from texlab_core.methods.solid.slices import CUTS, Slices
from texlab_core.transforms import solid_laplacian
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from texlab_core.methods.heeger_bergen.analysis import Target
    from texlab_core.methods.solid.rounds import AxisModel, Plan, Volume
    from texlab_core.work.tasks import Task

# Quantiles that stand for a histogram, and bins that it is counted in.
QUANTILES = 256
BINS = 2048
_SHARES = (np.arange(QUANTILES) + 0.5) / QUANTILES
_PIECE = 2**17


@dataclass(frozen=True, slots=True, eq=False)
class Shapes:
    """The histograms of all bands, in the order of ``plan.labels``.

    Parameters
    ----------
    distances
        (bands,) float64: W1 / sd from the exemplar's.
    quantiles, wanted
        (bands, QUANTILES) float64: of the bands, and of the exemplar's.
    variances
        (bands,) float64.
    spreads
        (bands,) float64: what distances are divided by.
    """

    distances: NDArray[np.float64]
    quantiles: NDArray[np.float64]
    wanted: NDArray[np.float64]
    variances: NDArray[np.float64]
    spreads: NDArray[np.float64]


def measure_shapes(volume: Volume, model: AxisModel, plan: Plan) -> Task[Shapes]:
    """Measure the histograms of all bands that are matched.

    Parameters
    ----------
    volume
        (D, H, W) float32; stays as it is.
    model, plan
        Targets, and how they are matched: pooled.
    """
    found, targets = [], []
    bands = yield from solid_laplacian.build(volume, plan.levels)
    for key, band in zip(plan.keys, bands, strict=True):
        targets.append(model.solid.bands[key])
        found.append((yield from _shape(band, targets[-1])))
    del bands
    if plan.slices is not None and model.slices is not None:
        for axes in CUTS.values():
            slices = yield from cut(volume, axes)
            whole = Slices.of(slices, plan.slices)
            spectrum = yield from whole.forward(slices)
            for key in plan.slices.keys(whole.size):
                band = yield from whole.band(spectrum, key)
                targets.append(model.slices.bands[key])
                found.append((yield from _shape(band, targets[-1])))
    return Shapes(
        np.array([each[0] for each in found]),
        np.array([each[1] for each in found]),
        np.array([_quantiles(target) for target in targets]),
        np.array([each[2] for each in found]),
        np.array([target.spread or 1.0 for target in targets]),
    )


def move(
    volume: Volume, model: AxisModel, plan: Plan, steps: NDArray[np.float64], tie_key: Callable[..., int]
) -> Task[Volume]:
    """Move some bands toward the exemplar's histograms and leave the others as they are.

    Parameters
    ----------
    volume
        (D, H, W) float32; stays as it is.
    model, plan
        Targets, and how they are matched: pooled.
    steps
        (bands,) how far, in units of the way; above 1, as neighbours hold a part of every band.
    tie_key
        Gives a 64-bit key for any whole numbers.
    """
    moved = volume.copy()
    many = len(plan.keys)
    bands = yield from solid_laplacian.build(volume, plan.levels)
    for index, (key, band) in enumerate(zip(plan.keys, bands, strict=True)):
        yield from _change(band, model.solid.bands[key], steps[index], tie_key(0, index))
    yield from add(moved, (yield from solid_laplacian.collapse(bands)))
    if plan.slices is None or model.slices is None:
        return moved
    for number, axes in enumerate(CUTS.values(), 1):
        slices = yield from cut(volume, axes)
        whole = Slices.of(slices, plan.slices)
        keys = plan.slices.keys(whole.size)
        some = steps[many : many + len(keys)]
        many += len(keys)
        if not some.any():
            continue
        spectrum = yield from whole.forward(slices)
        total = np.zeros_like(spectrum)
        for index, key in enumerate(keys):
            if some[index]:
                band = yield from whole.band(spectrum, key)
                yield from _change(band, model.slices.bands[key], some[index], tie_key(number, index))
                yield from whole.add(total, key, band)
        yield from add(moved, (yield from whole.inverse(total)).transpose(np.argsort(axes)))
    return moved


def _change(band: Volume, target: Target, step: float, key: int) -> Task[None]:
    """Replace a band by what matching would add to it, times a step."""
    if step == 0:
        band[...] = 0
        return
    before = band.copy()
    yield from match(band, target, "exact", key)
    for block in _blocks(band):
        band[block] -= before[block]
        band[block] *= np.float32(step)
        yield band[block].size // 8


def _shape(band: Volume, target: Target) -> Task[tuple[float, NDArray[np.float64], float]]:
    """Return distance, quantiles and variance of a band, from its histogram."""
    low, high = float(target.sample[0]), float(target.sample[-1])
    total = square = 0.0
    for block in _blocks(band):
        part = band[block]
        low, high = min(low, float(part.min())), max(high, float(part.max()))
        total += float(part.sum(dtype=np.float64))
        square += float((part.astype(np.float64) ** 2).sum())
        yield part.size // 8
    counts = np.zeros(BINS)
    scale = np.float32(BINS / (high - low) if high > low else 0)
    for block in _blocks(band):
        places = ((band[block] - np.float32(low)) * scale).astype(np.int32).reshape(-1)
        np.clip(places, 0, BINS - 1, out=places)
        counts += np.bincount(places, minlength=BINS)
        yield places.size // 4
    edges = np.linspace(low, high, BINS + 1)
    shares = np.concatenate([[0.0], np.cumsum(counts)]) / band.size
    theirs = np.searchsorted(target.sample, edges.astype(np.float32)) / target.sample.size
    theirs[0], theirs[-1] = 0.0, 1.0
    apart = np.abs(shares - theirs)
    distance = float((apart[1:] + apart[:-1]).sum()) * 0.5 * (high - low) / BINS
    variance = square / band.size - (total / band.size) ** 2
    return distance / (target.spread or 1.0), np.interp(_SHARES, shares, edges), max(variance, 0.0)


def _quantiles(target: Target) -> NDArray[np.float64]:
    places = (_SHARES * target.sample.size - 0.5).clip(0, target.sample.size - 1)
    below = places.astype(np.intp)
    above = np.minimum(below + 1, target.sample.size - 1)
    share = places - below
    quantiles: NDArray[np.float64] = (1 - share) * target.sample[below] + share * target.sample[above]
    return quantiles


def _blocks(volume: Volume) -> Iterator[slice]:
    return iter(row_blocks(volume.shape, _PIECE))
