"""What a finished growth shows: the image, maps of where and how each pixel was found, copying and doubt."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.steps import Curve, Map, Output, Step
from texlab_core.measures.copying import continuous_share_steps, copied_regions_steps, largest_copy
from texlab_core.methods.efros_leung.told import DISTANCE, EXACT_SHARE, GARBAGE, OWN_DISTANCE
from texlab_core.work.tasks import row_blocks, through

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.steps import FloatImage
    from texlab_core.methods.efros_leung.explain import Grown

_PIXELS_AT_ONCE = 2**17
_BINS = 64
_NO_LEVELS = np.empty(0, np.float32)
UNITS = {"ssd": "gray levels²", "flat-ssd": "gray levels²", "sad": "gray levels", "ncc": ""}


def report(
    grown: Grown, exemplar: ImageInput, given: FloatImage | None, levels: NDArray[np.float32], last: Step
) -> Generator[Step, None, Output]:
    """Make the output of a finished growth.

    Parameters
    ----------
    grown
        The finished growth.
    exemplar
        Where the pixels come from, at full precision.
    given
        (H, W, C) float32, pixels that have no source; None when all have one.
    levels
        (n,) float32, d_min of the exemplar's own windows with their place left out.
    last
        Tells how far the run is, for the steps of this part.
    """
    canvas = grown.canvas
    height, width = canvas.status.shape
    step = replace(last, stage="measuring")
    image = np.empty((height, width, exemplar.channels), np.float32)
    source = np.empty((height, width, 2), np.int32)
    order = np.empty((height, width), np.float32)
    for part in row_blocks((height, width), _PIXELS_AT_ONCE):
        places = canvas.source[part] - 1
        source[part, :, 0], source[part, :, 1] = places // exemplar.size[1], places % exemplar.size[1]
        source[part][places < 0] = -1
        image[part] = exemplar.pixels[source[part, :, 0], source[part, :, 1]]
        if given is not None:
            image[part] = np.where(places[..., None] < 0, given[part], image[part])
        order[part] = canvas.order[part]
        yield step
    unit = UNITS[grown.matching.criterion]
    labels, measures, curves = yield from measuring(source, canvas.order, canvas.d_min, unit, step, levels)
    return Output(
        image=image,
        maps={
            "source": Map(source, "source", "Where each pixel comes from"),
            "order": Map(order, "scalar", "Order of filling", "pixels"),
            "matches": Map(canvas.matches, "count", "Size of the match set", "pixels"),
            "distance": Map(canvas.d_min, "scalar", "Smallest distance d_min", unit),
            "copied": Map(labels, "label", "Areas copied in one piece"),
        },
        curves=curves,
        measures=measures,
        notes=_notes(grown),
        details=grown,
    )


def measuring(
    source: NDArray[np.int32],
    order: NDArray[Any],
    d_min: NDArray[np.float32],
    unit: str,
    step: Step,
    levels: NDArray[np.float32] = _NO_LEVELS,
) -> Generator[Step, None, tuple[NDArray[np.int32], dict[str, float], dict[str, Curve]]]:
    """Measure a finished growth.

    Parameters
    ----------
    source
        (H, W, 2) int32; a negative row is a pixel that was given: it has no source, and is no work of the method.
    order, d_min
        (H, W), 0 or the number of the filled pixel; (H, W) float32.
    unit
        Of ``d_min``.
    step
        Yielded between portions.
    levels
        As for :func:`report`.

    Returns
    -------
    labels, measures, curves
        (H, W) int32 areas copied in one piece; numbers; curves.
    """
    tally = _Tally(int(order.max(initial=0)))
    for part in row_blocks(order.shape, _PIXELS_AT_ONCE):
        tally.add(order[part], d_min[part])
        yield step
    labels, sizes = yield from through(copied_regions_steps(source), step)
    continuity = yield from through(continuous_share_steps(source), step)
    measures = _measures(tally, levels) | _copying(source, continuity, sizes)
    return labels, measures, _curves(tally, levels, unit)


class _Tally:
    """Sums over the filled pixels, row by row: d_min along the order of filling, exact matches."""

    def __init__(self, last: int) -> None:
        self.last = last
        self.bins = min(_BINS, last)
        self.counts = np.zeros(self.bins, np.int64)
        self.sums = np.zeros(self.bins)
        self.exact = 0

    def add(self, order: NDArray[Any], distances: NDArray[np.float32]) -> None:
        filled = order > 0
        if not filled.any():
            return
        bins = (order[filled].astype(np.int64) - 1) * self.bins // self.last
        self.counts += np.bincount(bins, minlength=self.bins)
        self.sums += np.bincount(bins, weights=distances[filled], minlength=self.bins)
        self.exact += int(np.count_nonzero(distances[filled] == 0))

    @property
    def filled(self) -> int:
        return int(self.counts.sum())


def _curves(tally: _Tally, levels: NDArray[np.float32], unit: str) -> dict[str, Curve]:
    """Return d_min along the order of filling, and the exemplar's own level beside it."""
    if not tally.filled:
        return {}
    there = tally.counts > 0
    ends = np.ceil(np.arange(1, tally.bins + 1) * tally.last / tally.bins)
    means = tally.sums[there] / tally.counts[there]
    label = "pixels filled"
    curves = {
        "distance": Curve.of(means, "Smallest distance while growing", x=ends[there], x_label=label, y_label=unit)
    }
    if levels.size:
        level = np.full(2, levels.mean(dtype=np.float64))
        curves["leave-one-out"] = Curve.of(
            level,
            "The exemplar's own windows",
            x=[0, tally.last],
            x_label=label,
            y_label=unit,
            reference=True,
        )
    return curves


def _measures(tally: _Tally, levels: NDArray[np.float32]) -> dict[str, float]:
    """Return how far the windows were from the exemplar's, alone and against the exemplar's own level."""
    measures: dict[str, float] = {}
    if levels.size:
        measures[OWN_DISTANCE.id] = float(levels.mean(dtype=np.float64))
    if not tally.filled:
        return measures
    measures[EXACT_SHARE.id] = tally.exact / tally.filled
    measures[DISTANCE.id] = float(tally.sums.sum() / tally.filled)
    level = measures.get(OWN_DISTANCE.id, 0.0)
    if level > 0:
        measures[GARBAGE.id] = measures[DISTANCE.id] / level
    return measures


def _copying(source: NDArray[np.int32], continuity: float, sizes: NDArray[np.int64]) -> dict[str, float]:
    filled = int(np.count_nonzero(source[:, :, 0] >= 0))
    return {"copied-share": continuity, "largest-copy": largest_copy(sizes, filled)} if filled else {}


def _notes(grown: Grown) -> tuple[str, ...]:
    matching = grown.matching
    notes = []
    if matching.tiles and matching.causal:
        notes.append("A causal window sees nothing ahead, so the output was not made to tile.")
    if matching.error_limit > 0 and matching.causal:
        notes.append("A causal window is filled row by row, so the growing error limit was not used.")
    return tuple(notes)
