"""Growing a pyramid by one level: expand, and add the bands that were copied.

The expansion is that of :func:`texlab_core.transforms.gaussian.expand` at even sizes. It is written out here
because each sample then takes the same operations in the same order wherever it lies, in the analysis as in
the synthesis: a verbatim copy of the exemplar's bands gives back the exemplar bit for bit.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.kernels.jit import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Picture = NDArray[np.float32]
    Ints = NDArray[np.int32]

_SIX = np.float32(6)
_EIGHTH = np.float32(1 / 8)
_HALF = np.float32(1 / 2)


@njit
def _expand_row(coarse: Picture, row: int, periodic: bool, framed: Picture, out: Picture) -> None:
    """Write row ``row`` of the expansion of (h, w, C) into (2 w, C); ``framed`` is (w + 2, C) scratch."""
    height, width, channels = coarse.shape
    i = row >> 1
    below = i + 1 if i + 1 < height else (0 if periodic else height - 1)
    if row & 1:
        for x in range(width):
            for c in range(channels):
                framed[x + 1, c] = (coarse[i, x, c] + coarse[below, x, c]) * _HALF
    else:
        above = i - 1 if i > 0 else (height - 1 if periodic else min(1, height - 1))
        for x in range(width):
            for c in range(channels):
                framed[x + 1, c] = (coarse[above, x, c] + _SIX * coarse[i, x, c] + coarse[below, x, c]) * _EIGHTH
    for c in range(channels):
        framed[0, c] = framed[width, c] if periodic else framed[min(2, width), c]
        framed[width + 1, c] = framed[1, c] if periodic else framed[width, c]
    for x in range(width):
        for c in range(channels):
            out[2 * x, c] = (framed[x, c] + _SIX * framed[x + 1, c] + framed[x + 2, c]) * _EIGHTH
            out[2 * x + 1, c] = (framed[x + 1, c] + framed[x + 2, c]) * _HALF


@njit
def expand_rows(coarse: Picture, periodic: bool, framed: Picture, out: Picture, first: int, last: int) -> None:
    """Expand (h, w, C) into rows first..last-1 of ``out`` (2 h, 2 w, C)."""
    for row in range(first, last):
        _expand_row(coarse, row, periodic, framed, out[row])


@njit
def collapse_rows(
    coarse: Picture,
    periodic: bool,
    band: NDArray[np.float64],
    source: Ints,
    row_part: Ints,
    column_part: Ints,
    framed: Picture,
    out: Picture,
    first: int,
    last: int,
) -> None:
    """Expand into rows first..last-1 of ``out`` and add the band at each location's source (eq. 5, inverted).

    Parameters
    ----------
    band
        (P, C) the exemplar's Laplacian level in quadtree order.
    source
        (Q,) source of each synthesized location; the location of a pixel is ``row_part[y] + column_part[x]``.
    """
    channels = band.shape[1]
    for y in range(first, last):
        row = out[y]
        _expand_row(coarse, y, periodic, framed, row)
        for x in range(column_part.size):
            q = source[row_part[y] + column_part[x]]
            for c in range(channels):
                row[x, c] = np.float32(band[q, c] + np.float64(row[x, c]))


@njit
def source_rows(
    source: Ints, row_part: Ints, column_part: Ints, coordinates: Ints, out: Ints, first: int, last: int
) -> None:
    """Write row and column of the source of each pixel into rows first..last-1 of ``out`` (H, W, 2)."""
    for y in range(first, last):
        for x in range(out.shape[1]):
            q = source[row_part[y] + column_part[x]]
            out[y, x, 0] = coordinates[q, 0]
            out[y, x, 1] = coordinates[q, 1]
