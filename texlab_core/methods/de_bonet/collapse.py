"""Collapse: from sources to pixels, one level at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.de_bonet.analysis import PIXELS_AT_ONCE
from texlab_core.work.tasks import row_bounds

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.methods.de_bonet.analysis import Analysis
    from texlab_core.methods.de_bonet.quadtree import Grid


def coarsest(analysis: Analysis, grid: Grid, source: NDArray[np.int32]) -> FloatImage:
    """Return the coarsest Gaussian level of the output, (h, w, C) float32."""
    band = analysis.levels[grid.depth].band
    return band[source].astype(np.float32).reshape(*grid.shape(grid.depth), -1)


def collapse_steps(
    analysis: Analysis, grid: Grid, level: int, coarser: FloatImage, source: NDArray[np.int32], periodic: bool
) -> Generator[None, None, FloatImage]:
    """Grow the output by one level, (h, w, C) float32; yields after each block of rows.

    Parameters
    ----------
    grid
        Locations of the output.
    level
        The level to make.
    coarser
        Gaussian level ``level + 1`` of the output.
    source
        (Q,) int32 sources of the level in quadtree order.
    periodic
        Border rule of the output: that of the analysis, or periodic so that it tiles.

    Reference: De Bonet 1997, section 4.2 (CollapsePyramid), the inverse of eq. 5.
    """
    from texlab_core.kernels.collapse import collapse_rows

    height, width = grid.shape(level)
    channels = coarser.shape[2]
    out = np.empty((height, width, channels), np.float32)
    framed = np.empty((width // 2 + 2, channels), np.float32)
    row_part, column_part = grid.parts(level)
    for first, last in row_bounds((height, width * channels), PIXELS_AT_ONCE):
        collapse_rows(
            coarser, periodic, analysis.levels[level].band, source, row_part, column_part, framed, out, first, last
        )
        yield
    return out


def enlarge(image: FloatImage, times: int, periodic: bool) -> FloatImage:
    """Double the size ``times`` times with no detail added: what a level looks like at the output's size."""
    from texlab_core.transforms.gaussian import expand

    for _ in range(times):
        shape = (2 * image.shape[0], 2 * image.shape[1])
        image = expand(image, shape, "periodic" if periodic else "reflect")
    return image
