"""How well the exemplar explains itself: d_min of its own windows when their own place is left out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.efros_leung.growth import empty_canvas, make_rule, make_search
from texlab_core.methods.efros_leung.windows import make_window

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.kernels.neighbourhood_types import Pool
    from texlab_core.methods.efros_leung.windows import Matching

SAMPLES_PER_SIDE = 10
# Units of work per portion, a few milliseconds.
_BUDGET = 40_000_000


def leave_one_out(
    values: NDArray[np.uint8], allowed: NDArray[np.bool_], pool: Pool, matching: Matching
) -> Generator[tuple[int, int], None, NDArray[np.float32]]:
    """Measure d_min at places of an even grid, each time without the place itself.

    Parameters
    ----------
    values, allowed
        (C, H, W) bytes of the exemplar, (H, W) places that may be copied.
    pool, matching
        The same as candidates, and how they are compared.

    Yields
    ------
    Places done and places in all.

    Returns
    -------
    (n,) float32 distances of whole windows; empty when no place has another one to be compared with.
    """
    from texlab_core.kernels.neighbourhood_types import LAYER_BEST, POSITION
    from texlab_core.kernels.neighbourhoods import grow

    channels, height, width = values.shape
    periodic = matching.border == "periodic"
    canvas = empty_canvas(channels, (height, width))._replace(values=values)
    canvas.status[:] = 1
    # The candidate beside the place itself is a good bound on d_min from the start.
    rows, columns = np.indices((height, width), dtype=np.int32)
    canvas.source[:] = rows * width + (columns + 1) % width + 1
    queue = _grid(allowed, 0 if periodic else matching.window // 2)
    window = make_window(matching, channels)
    rule = make_rule(matching, 0, leave_out=True)._replace(tiles=periodic)
    search = make_search(pool, window, channels)
    search.levels[LAYER_BEST] = np.inf
    while search.numbers[POSITION] < len(queue):
        grow(canvas, pool, window, rule, search, queue, _BUDGET)
        yield int(search.numbers[POSITION]), len(queue)
    levels = canvas.d_min.reshape(-1)[queue]
    return levels[np.isfinite(levels)]


def _grid(allowed: NDArray[np.bool_], margin: int) -> NDArray[np.int32]:
    height, width = allowed.shape
    rows, columns = (
        np.unique(np.linspace(margin, max(margin, side - 1 - margin), SAMPLES_PER_SIDE).astype(np.int32))
        for side in (height, width)
    )
    rows, columns = rows[rows < height], columns[columns < width]
    places: NDArray[np.int32] = (rows[:, None] * np.int32(width) + columns).ravel()
    return places[allowed.ravel()[places]]
