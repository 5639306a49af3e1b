"""Why a pixel is what it is: its window, the best matches, the match set and the choice, made again on demand."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.efros_leung.growth import make_rule, make_search
from texlab_core.methods.efros_leung.windows import in_distance_units, make_window

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.kernels.neighbourhood_types import Canvas, Pool
    from texlab_core.methods.efros_leung.windows import Matching


@dataclass(frozen=True, eq=False)
class Grown:
    """A finished growth as ``details`` of a result.

    Parameters
    ----------
    canvas, pool, matching
        The image with its maps, the candidates, and how they were compared.
    choice_key
        Key of the hash that chose.
    since
        How many pixels were filled under other settings, in the runs that this one went on from.
    state
        Makes the arrays of an ``ArraysInput`` from which a larger image goes on.
    """

    canvas: Canvas
    pool: Pool
    matching: Matching
    choice_key: int
    since: int
    state: Callable[[], Mapping[str, NDArray[np.generic]]]


@dataclass(frozen=True, eq=False)
class Explanation:
    """Why a pixel was chosen.

    Parameters
    ----------
    pixel
        Row and column in the result.
    given
        Whether it was known from the start; then there was no match.
    earlier
        Whether it was filled in an earlier run, under other settings: then this is how it would match under these.
    window
        (w, w, C) float32 in [0, 1]: what was known around it, mid-gray elsewhere.
    weights
        (w, w) float32, sum 1: weight of each known pixel in the comparison, 0 elsewhere.
    places, distances
        (n, 2) int32 rows and columns in the exemplar, (n,) float64 distances: the best candidates, best first.
    d_min, limit
        Smallest distance, and the largest one in the match set.
    match_set
        (m, 2) int32: every candidate that the choice was made from.
    chosen, chosen_distance
        Row and column in the exemplar that was copied, and its distance.
    """

    pixel: tuple[int, int]
    given: bool
    earlier: bool
    window: FloatImage
    weights: NDArray[np.float32]
    places: NDArray[np.int32]
    distances: NDArray[np.float64]
    d_min: float
    limit: float
    match_set: NDArray[np.int32]
    chosen: tuple[int, int] | None
    chosen_distance: float


def explain(grown: Grown, row: int, column: int, *, best: int = 12) -> Explanation:
    """Repeat the search for one pixel of a finished growth, with what was known when it was filled.

    Parameters
    ----------
    grown
        ``result.details`` of the method.
    row, column
        The pixel, 0 <= row < H, 0 <= column < W.
    best
        How many candidates to list.

    Raises
    ------
    IndexError
        When the pixel lies outside.
    """
    from texlab_core.kernels.neighbourhoods import measure_all

    canvas, pool, matching = grown.canvas, grown.pool, grown.matching
    height, width = canvas.status.shape
    if not (0 <= row < height and 0 <= column < width):
        raise IndexError(f"The pixel ({row}, {column}) lies outside of {height} x {width}.")
    moment = int(canvas.order[row, column])
    given = moment == 0
    known = (canvas.order < moment) if not given else np.zeros((height, width), bool)
    then = canvas._replace(status=known.astype(np.uint8))
    shown, weights = _window(then, matching, row, column)
    source = int(canvas.source[row, column]) - 1
    chosen = None if source < 0 else (source // pool.width, source % pool.width)
    if given:
        none = np.empty((0, 2), np.int32)
        return Explanation(
            (row, column), True, False, shown, weights, none, np.empty(0), 0.0, 0.0, none, chosen, 0.0
        )
    rule = make_rule(matching, grown.choice_key)
    window = make_window(matching, canvas.values.shape[0])
    distances = np.empty(pool.plane)
    measure_all(
        then, pool, window, rule, make_search(pool, window, canvas.values.shape[0]), row, column, distances
    )
    candidates = np.flatnonzero(~np.isnan(distances))
    found = distances[candidates]
    d_min = float(found.min())
    limit = max((1.0 + matching.eps) * d_min, in_distance_units(matching.tau, matching.criterion))
    order = np.argsort(found, kind="stable")
    own = int(pool.stride * (source // pool.width + pool.margin) + source % pool.width + pool.margin)
    earlier = moment <= grown.since
    # The size of the match set was found in exact integers, and d as shown is rounded.
    count = np.count_nonzero(found <= limit) if earlier else int(canvas.matches[row, column])
    match_set = candidates[order[:count]]
    return Explanation(
        pixel=(row, column),
        given=False,
        earlier=earlier,
        window=shown,
        weights=weights,
        places=_positions(candidates[order[:best]], pool),
        distances=found[order[:best]],
        d_min=d_min,
        limit=limit,
        match_set=_positions(np.sort(match_set), pool),
        chosen=chosen,
        chosen_distance=float(distances[own]),
    )


def _positions(places: NDArray[np.int64], pool: Pool) -> NDArray[np.int32]:
    rows, columns = places // pool.stride - pool.margin, places % pool.stride - pool.margin
    return np.stack([rows, columns], axis=1).astype(np.int32)


def _window(canvas: Canvas, matching: Matching, row: int, column: int) -> tuple[FloatImage, NDArray[np.float32]]:
    """Return what was known around a pixel, and the weights of it."""
    channels, height, width = canvas.values.shape
    side, reach = matching.window, matching.window // 2
    rows, columns = row + np.arange(-reach, reach + 1), column + np.arange(-reach, reach + 1)
    inside = np.ones((side, side), bool)
    if not matching.wraps:
        inside = ((rows >= 0) & (rows < height))[:, None] & ((columns >= 0) & (columns < width))
    at = np.ix_(rows % height, columns % width)
    known = inside & (canvas.status[at] == 1)
    values = np.moveaxis(canvas.values[:, *at], 0, 2).astype(np.float32) / np.float32(255.0)
    window = make_window(matching, channels)
    weights = np.zeros((side, side), np.float32)
    weights[window.rows + reach, window.columns + reach] = window.weights
    weights *= known
    total = weights.sum()
    return np.where(known[..., None], values, np.float32(0.5)), weights / total if total else weights
