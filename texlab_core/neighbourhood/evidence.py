"""What a finished growth shows: the image, maps of where and how each pixel was found, copying and doubt."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.stats.copying import continuous_share, copied_regions_steps
from texlab_core.steps import Curve, Map, Output, Step

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.inputs import ImageInput
    from texlab_core.neighbourhood.explain import Grown
    from texlab_core.steps import FloatImage

_PIXELS_AT_ONCE = 2**18
_BINS = 64
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
    image = np.empty((height, width, exemplar.channels), np.float32)
    source = np.empty((height, width, 2), np.int32)
    rows = max(1, _PIXELS_AT_ONCE // width)
    for first in range(0, height, rows):
        part = slice(first, first + rows)
        places = canvas.source[part]
        source[part, :, 0], source[part, :, 1] = places // exemplar.size[1], places % exemplar.size[1]
        source[part][places < 0] = -1
        image[part] = exemplar.pixels[source[part, :, 0], source[part, :, 1]]
        if given is not None:
            image[part] = np.where(places[..., None] < 0, given[part], image[part])
        yield Step(last.done, last.total, "measuring", preview=last.preview, state=last.state)
    filled = canvas.order > 0
    # Only what was filled counts as copied: what was given is no work of the method.
    copied = np.where(filled[..., None], source, np.int32(-1))
    labelling = copied_regions_steps(copied)
    while True:
        try:
            next(labelling)
        except StopIteration as end:
            labels, sizes = end.value
            break
        yield Step(last.done, last.total, "measuring", preview=last.preview, state=last.state)
    distances = canvas.d_min[filled]
    by_order = distances[np.argsort(canvas.order[filled])]
    unit = UNITS[grown.matching.criterion]
    yield Step(last.done, last.total, "measuring", preview=last.preview, state=last.state)
    return Output(
        image=image,
        maps={
            "source": Map(source, "source", "Where each pixel comes from"),
            "order": Map(canvas.order.astype(np.float32), "scalar", "Order of filling", "pixels"),
            "matches": Map(canvas.matches, "count", "Size of the match set", "pixels"),
            "distance": Map(canvas.d_min, "scalar", "Smallest distance d_min", unit),
            "copied": Map(labels, "label", "Areas copied in one piece"),
        },
        curves=_curves(by_order, levels, unit),
        measures=_measures(grown, by_order, levels) | _copying(filled, copied, sizes),
        notes=_notes(grown),
        details=grown,
    )


def _curves(distances: NDArray[np.float32], levels: NDArray[np.float32], unit: str) -> dict[str, Curve]:
    """Return d_min along the order of filling, and the exemplar's own level beside it."""
    if not distances.size:
        return {}
    edges = np.unique(np.linspace(0, distances.size, _BINS + 1).astype(np.int64))
    means = np.add.reduceat(distances.astype(np.float64), edges[:-1]) / np.diff(edges)
    curves = {
        "distance": Curve.of(
            means, "Smallest distance while growing", x=edges[1:], x_label="pixels filled", y_label=unit
        )
    }
    if levels.size:
        level = np.full(2, levels.mean(dtype=np.float64))
        curves["leave-one-out"] = Curve.of(
            level, "The exemplar with itself", x=edges[[0, -1]], x_label="pixels filled", y_label=unit
        )
    return curves


def _measures(grown: Grown, distances: NDArray[np.float32], levels: NDArray[np.float32]) -> dict[str, float]:
    """Return copying (d_min = 0) and doubt (d_min over the exemplar's own level, repetition of sources)."""
    measures: dict[str, float] = {}
    if levels.size:
        measures["leave-one-out"] = float(levels.mean(dtype=np.float64))
    if not distances.size:
        return measures
    sources = grown.canvas.source[grown.canvas.order > 0]
    measures["copied-share"] = float((distances == 0).mean())
    measures["distance"] = float(distances.mean(dtype=np.float64))
    measures["source-repetition"] = float(sources.size / np.count_nonzero(np.bincount(sources)))
    level = measures.get("leave-one-out", 0.0)
    if level > 0:
        measures["distance-over-level"] = measures["distance"] / level
    return measures


def _copying(filled: NDArray[np.bool_], source: NDArray[np.int32], sizes: NDArray[np.int64]) -> dict[str, float]:
    """Return how much of what was filled continues its neighbour, and the largest area copied in one piece."""
    height, width = filled.shape
    pairs = np.count_nonzero(filled[1:] & filled[:-1]) + np.count_nonzero(filled[:, 1:] & filled[:, :-1])
    count = int(filled.sum())
    if pairs == 0:
        return {}
    all_pairs = (height - 1) * width + height * (width - 1)
    largest = int(sizes[1]) if sizes.size > 1 else 1
    return {
        "continuous-share": continuous_share(source) * all_pairs / pairs,
        "largest-copy": largest / count,
    }


def _notes(grown: Grown) -> tuple[str, ...]:
    matching = grown.matching
    notes = []
    if matching.tiles and matching.causal:
        notes.append("A causal window sees nothing ahead, so the output was not made to tile.")
    if matching.error_limit > 0 and matching.causal:
        notes.append("A causal window is filled row by row, so the growing error limit was not used.")
    return tuple(notes)
