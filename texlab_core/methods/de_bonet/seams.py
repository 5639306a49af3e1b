"""What lies along the lines between the coarsest cells of an exemplar: how well two places continue each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Pixels on each side of a line that are compared.
STRIP = 6
# A strip is thinned out along its line to about this many samples.
_SAMPLES = 512
# All pairs are compared beforehand up to this many lines.
_TABLE = 320


@dataclass(frozen=True, eq=False, slots=True)
class Lines:
    """The lines of one direction.

    Parameters
    ----------
    before, behind
        (lines, samples) uint8: what lies left of them (above them), and right of them (below them).
    table_before, table_behind
        (lines, lines) int32 sums of squared differences of the strips; (0, 0) where there are many lines.
    """

    before: NDArray[np.uint8]
    behind: NDArray[np.uint8]
    table_before: NDArray[np.int32]
    table_behind: NDArray[np.int32]

    @classmethod
    def of(cls, before: NDArray[np.uint8], behind: NDArray[np.uint8]) -> Lines:
        """Compare all pairs of strips, unless there are too many."""
        return cls(before, behind, _pairs(before), _pairs(behind))


@dataclass(frozen=True, eq=False, slots=True)
class Seams:
    """The lines between the cells of the coarsest level of an exemplar, and what lies on both sides of them.

    Parameters
    ----------
    rows, columns
        Size of the coarsest level.
    lines
        Those that run down, (rows, columns + 1) in raster order, each as long as a cell is high; and those that
        run across, (rows + 1, columns).
    """

    rows: int
    columns: int
    lines: tuple[Lines, Lines]

    @classmethod
    def of(cls, pixels: NDArray[np.float32], rows: int, columns: int) -> Seams:
        """Cut the strips out of an exemplar, (rows * n, columns * m, C) float32; it goes on periodically."""
        down = _strips(pixels, rows, columns)
        # The same for the transposed picture, whose lines come column by column.
        across = (
            np.ascontiguousarray(strips.reshape(columns, rows + 1, -1).swapaxes(0, 1)).reshape(len(strips), -1)
            for strips in _strips(pixels.swapaxes(0, 1), columns, rows)
        )
        return cls(rows, columns, (Lines.of(*down), Lines.of(*across)))


def _pairs(strips: NDArray[np.uint8]) -> NDArray[np.int32]:
    if len(strips) > _TABLE:
        return np.empty((0, 0), np.int32)
    # Whole numbers below 2^53: exact in any order of summation.
    values = strips.astype(np.float64)
    norms = (values * values).sum(1)
    pairs: NDArray[np.int32] = (norms[:, None] + norms - 2 * (values @ values.T)).astype(np.int32)
    return pairs


def _strips(pixels: NDArray[np.float32], rows: int, columns: int) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Return what lies left and right of all lines that run down, each (rows * (columns + 1), samples)."""
    height, width, channels = pixels.shape
    tall, wide = height // rows, width // columns
    strip = min(STRIP, width)
    every = max(1, tall * strip * channels // _SAMPLES)
    down = (np.arange(rows)[:, None] * tall + np.arange(0, tall, every)).ravel()
    found = []
    for shift in (-strip, 0):
        across = (np.arange(columns + 1)[:, None] * wide + shift + np.arange(strip)).ravel() % width
        taken = np.round(np.clip(pixels[np.ix_(down, across)], 0, 1) * 255).astype(np.uint8)
        lines = taken.reshape(rows, -1, columns + 1, strip * channels).swapaxes(1, 2)
        found.append(np.ascontiguousarray(lines).reshape(rows * (columns + 1), -1))
    return found[0], found[1]
