"""How well two places of the exemplar continue each other: strips along the lines between coarsest cells."""

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
_TABLE = 512
# Squared gray levels of a pair of which nothing can be said: opposite borders of the exemplar.
_UNKNOWN = 64.0**2


@dataclass(frozen=True, eq=False, slots=True)
class _Half:
    """The strips on one side of all lines of one direction: (lines, samples) uint8, and their pairs if few."""

    strips: NDArray[np.uint8]
    table: NDArray[np.int32] | None

    @classmethod
    def of(cls, strips: NDArray[np.uint8]) -> _Half:
        if len(strips) > _TABLE:
            return cls(strips, None)
        # Whole numbers below 2^53: exact in any order of summation.
        values = strips.astype(np.float64)
        norms = (values * values).sum(1)
        table = norms[:, None] + norms - 2 * (values @ values.T)
        return cls(strips, table.astype(np.int32))

    def squares(self, one: NDArray[np.int64], other: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return the sums of squared differences: (e,) lines against (e, n) lines."""
        if self.table is not None:
            return self.table[one[:, None], other].astype(np.int64)
        out = np.empty(other.shape, np.int64)
        for row, (line, others) in enumerate(zip(one, other, strict=True)):
            difference = self.strips[others].astype(np.int32) - self.strips[line].astype(np.int32)
            out[row] = np.einsum("ns,ns->n", difference, difference, dtype=np.int64)
        return out


@dataclass(frozen=True, eq=False, slots=True)
class Seams:
    """The lines between the cells of the coarsest level of an exemplar, and what lies on both sides of them.

    Lines of direction 0 run down, between columns: (rows, columns + 1) of them, each as long as a cell is high.
    Lines of direction 1 run across: (rows + 1, columns).

    Parameters
    ----------
    rows, columns
        Size of the coarsest level.
    halves
        For each direction: what lies before the lines (left, above) and what lies behind them.
    """

    rows: int
    columns: int
    halves: tuple[tuple[_Half, _Half], tuple[_Half, _Half]]

    @classmethod
    def of(cls, pixels: NDArray[np.float32], rows: int, columns: int) -> Seams:
        """Cut the strips out of an exemplar, (rows * n, columns * m, C) float32; it goes on periodically."""
        image = np.round(np.clip(pixels, 0, 1) * 255).astype(np.uint8)
        down = _strips(image, rows, columns)
        # The same for the transposed picture, whose lines come column by column.
        across = [
            strips.reshape(columns, rows + 1, -1).swapaxes(0, 1).reshape(columns * (rows + 1), -1)
            for strips in _strips(np.ascontiguousarray(image.swapaxes(0, 1)), columns, rows)
        ]
        return cls(
            rows,
            columns,
            ((_Half.of(down[0]), _Half.of(down[1])), (_Half.of(across[0]), _Half.of(across[1]))),
        )

    def misfit(
        self,
        direction: int,
        one: tuple[NDArray[np.int64], NDArray[np.int64]],
        other: tuple[NDArray[np.int64], NDArray[np.int64]],
        *,
        cyclic: bool,
    ) -> NDArray[np.float64]:
        """Return how badly lines fit each other: the mean squared difference of their strips, in gray levels.

        Parameters
        ----------
        direction
            0 for lines that run down, 1 for lines that run across.
        one
            Row and column of lines, (e,) each.
        other
            Row and column of the lines to compare them with, (e, n) each.
        cyclic
            Whether the exemplar goes on beyond its border; otherwise only strips within it are compared.

        Returns
        -------
        ndarray
            (e, n) float64, 0 .. 65025.
        """
        width = self.columns + 1 if direction == 0 else self.columns
        lines, others = one[0] * width + one[1], other[0] * width + other[1]
        last = self.columns if direction == 0 else self.rows
        place, places = one[1 - direction], other[1 - direction]
        squares, halves = np.zeros(others.shape), np.zeros(others.shape)
        for side, half in enumerate(self.halves[direction]):
            known = np.ones(others.shape, bool)
            if not cyclic:
                edge = 0 if side == 0 else last
                known = (place != edge)[:, None] & (places != edge)
            squares += np.where(known, half.squares(lines, others), 0)
            halves += known
        samples = self.halves[direction][0].strips.shape[1]
        return np.where(halves > 0, squares / (np.maximum(halves, 1) * samples), _UNKNOWN)


def _strips(image: NDArray[np.uint8], rows: int, columns: int) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Return what lies left and right of all lines that run down, each (rows * (columns + 1), samples)."""
    height, width, channels = image.shape
    tall, wide = height // rows, width // columns
    strip = min(STRIP, width)
    every = max(1, tall * strip * channels // _SAMPLES)
    x = np.arange(columns + 1)[:, None] * wide
    found = []
    for shift in (-strip, 0):
        across = (x + shift + np.arange(strip)) % width
        taken = image[:, across].reshape(rows, tall, columns + 1, strip, channels)[:, ::every]
        found.append(np.ascontiguousarray(taken.swapaxes(1, 2)).reshape(rows * (columns + 1), -1))
    return found[0], found[1]
