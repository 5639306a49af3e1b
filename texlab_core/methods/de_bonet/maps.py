"""Maps and figures of a sampled pyramid: sources, numbers of candidates, continuity."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.de_bonet.analysis import PIXELS_AT_ONCE
from texlab_core.methods.de_bonet.sampling import list_matches, match_chain
from texlab_core.work.tasks import row_bounds

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.methods.de_bonet.sampling import Sampling

# Locations whose candidates are listed for the median where listing them all would take too long.
_SAMPLED = 64


def source_map_steps(
    sampling: Sampling, level: int, size: tuple[int, int]
) -> Generator[None, None, NDArray[np.int32]]:
    """Return row and column of the source of every pixel of a level, (height, width, 2) int32.

    Coordinates are those of the fitted exemplar at that level; at level 0 those of the exemplar itself.
    """
    from texlab_core.kernels.collapse import source_rows

    height, width = size
    out = np.empty((height, width, 2), np.int32)
    row_part, column_part = sampling.grid.parts(level)
    places = sampling.analysis.levels[level].coordinates
    if level == 0:
        analysis = sampling.analysis
        places = np.stack((analysis.rows[places[:, 0]], analysis.columns[places[:, 1]]), axis=1)
    for first, last in row_bounds((height, width), PIXELS_AT_ONCE):
        source_rows(sampling.sources[level], row_part, column_part, places, out, first, last)
        yield
    return out


def candidate_map(sampling: Sampling, size: tuple[int, int]) -> NDArray[np.int32]:
    """Return the exact number of candidates of every pixel of the finest level, (height, width) int32."""
    grid = sampling.grid
    if grid.depth == 0:
        return np.ones(size, np.int32)
    matches = list_matches(sampling)
    children = 4 if sampling.literal[0] else 1
    of_parents = (matches * children)[grid.order(1)]
    return np.ascontiguousarray(of_parents.repeat(2, axis=0).repeat(2, axis=1)[: size[0], : size[1]])


def median_candidates(sampling: Sampling, level: int) -> float:
    """Return the median number of candidates of a level below N.

    Where some were never listed, a regular sample of 64 of them stands for all of them.
    """
    matches = sampling.matches[level + 1]
    children = 4 if sampling.literal[level] else 1
    unlisted = np.flatnonzero(matches < 0)
    if unlisted.size == 0:
        return float(np.median(matches)) * children
    chosen = unlisted[np.linspace(0, unlisted.size - 1, min(_SAMPLED, unlisted.size)).astype(np.int64)]
    listed = matches[matches >= 0]
    sampled = np.array([match_chain(sampling, level + 1, int(place))[-1].size for place in chosen])
    values = np.concatenate((listed, sampled))
    weights = np.concatenate((np.ones(listed.size), np.full(sampled.size, unlisted.size / sampled.size)))
    order = np.argsort(values, kind="stable")
    heaped = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(heaped, heaped[-1] / 2)]) * children
