"""Quadtree order of the locations of a pyramid: the children of location p are 4p .. 4p + 3.

The coarsest level is in raster order; below it, two bits per level say which of the four children is meant
(2 · lower row + right column). Parent, children and parity are then shifts, and the part of the picture under a
run of locations is a run of locations on every finer level.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.errors import ParamError

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Grid:
    """The locations of all levels of a pyramid.

    Parameters
    ----------
    rows, columns
        Size of the coarsest level.
    depth
        Index N of the coarsest level; level 0 is the finest.
    """

    rows: int
    columns: int
    depth: int

    @classmethod
    def covering(cls, height: int, width: int, depth: int) -> Grid:
        """Return the smallest grid of this depth whose finest level holds height x width pixels."""
        side = 2**depth
        return cls(-(-height // side), -(-width // side), depth)

    def shape(self, level: int) -> tuple[int, int]:
        """Height and width of a level."""
        shift = self.depth - level
        return self.rows << shift, self.columns << shift

    def count(self, level: int) -> int:
        """Return the number of locations of a level."""
        return (self.rows * self.columns) << 2 * (self.depth - level)

    def parts(self, level: int) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Return what row and column contribute to a location: (height,) and (width,) int32, to be added.

        Both are read-only and shared.
        """
        return _parts(self, level)

    def order(self, level: int) -> NDArray[np.int32]:
        """Return the location of every pixel of a level, (height, width) int32."""
        row_part, column_part = self.parts(level)
        return row_part[:, None] + column_part[None, :]

    def coordinates(self, level: int) -> NDArray[np.int32]:
        """Return row and column of every location of a level, (count, 2) int32."""
        height, width = self.shape(level)
        places = np.empty((height * width, 2), np.int32)
        order = self.order(level)
        places[order, 0] = np.arange(height, dtype=np.int32)[:, None]
        places[order, 1] = np.arange(width, dtype=np.int32)[None, :]
        return places

    def checked_location(self, level: int, row: int, column: int) -> int:
        """Return :meth:`location`; raises ``ParamError`` where a level has no such row or column."""
        height, width = self.shape(level)
        for name, value, limit in (("row", row, height), ("column", column, width)):
            if not 0 <= value < limit:
                raise ParamError(name, f"a whole number from 0 to {limit - 1}", value)
        return self.location(level, row, column)

    def location(self, level: int, row: int, column: int) -> int:
        """Return the location at a row and column of a level."""
        shift = self.depth - level
        inside = 2**shift - 1
        cell = (row >> shift) * self.columns + (column >> shift)
        low = 2 * _spread(np.array([row & inside]), shift) + _spread(np.array([column & inside]), shift)
        return (cell << 2 * shift) + int(low[0])


@lru_cache(maxsize=64)
def _parts(grid: Grid, level: int) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    height, width = grid.shape(level)
    shift = grid.depth - level
    row, column = np.arange(height), np.arange(width)
    inside = 2**shift - 1
    row_part = ((row >> shift) * grid.columns << 2 * shift) + 2 * _spread(row & inside, shift)
    column_part = (column >> shift << 2 * shift) + _spread(column & inside, shift)
    parts = row_part.astype(np.int32), column_part.astype(np.int32)
    for part in parts:
        part.flags.writeable = False
    return parts


def _spread(value: NDArray[np.int64], bits: int) -> NDArray[np.int64]:
    """Put a zero bit between any two bits."""
    out = np.zeros_like(value)
    for bit in range(bits):
        out |= (value >> bit & 1) << 2 * bit
    return out
