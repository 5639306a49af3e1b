"""Inner loops of the layout of a coarsest level by patches that continue each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.kernels.jit import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Bytes = NDArray[np.uint8]
    Ints = NDArray[np.int32]
    Longs = NDArray[np.int64]
    Doubles = NDArray[np.float64]
    Flags = NDArray[np.bool_]

# Squared gray levels of a pair of which nothing can be said: opposite borders of the exemplar.
UNKNOWN = 64.0**2


@njit
def nearest_middles(
    middles: Doubles, starts: Doubles, steps: Doubles, size: Longs, periodic: bool, label: Longs, offset: Doubles
) -> None:
    """Find the nearest middle of a patch for every cell of an output.

    Parameters
    ----------
    middles
        (2, n, m) rows and columns of the middles, a jittered brick pattern.
    starts, steps
        (2,) where the pattern begins and how wide it is, down and across.
    size
        (2,) height and width in cells.
    periodic
        Whether distances are taken around the output.
    label
        (height * width,): number of the middle.
    offset
        (2, height * width): how far below and beside it the cell lies.
    """
    _, rows, columns = middles.shape
    for y in range(size[0]):
        near_row = int(np.floor((y - starts[0]) / steps[0]))
        for x in range(size[1]):
            near_column = int(np.floor((x - starts[1]) / steps[1]))
            nearest = np.inf
            cell = y * size[1] + x
            for i in range(near_row - 1, near_row + 3):
                for j in range(near_column - 2, near_column + 3):
                    if periodic:
                        row, column = i % rows, j % columns
                    else:
                        row, column = min(max(i, 0), rows - 1), min(max(j, 0), columns - 1)
                    dy, dx = y - middles[0, row, column], x - middles[1, row, column]
                    if periodic:
                        dy = (dy + size[0] / 2) % size[0] - size[0] / 2
                        dx = (dx + size[1] / 2) % size[1] - size[1] / 2
                    distance = dy * dy + dx * dx
                    if distance < nearest:
                        nearest = distance
                        label[cell] = row * columns + column
                        offset[0, cell], offset[1, cell] = dy, dx


@njit
def _squares(strips: Bytes, table: Ints, one: int, other: int) -> float:
    """Return the sum of squared differences of two strips, looked up where it was computed beforehand."""
    if table.size > 0:
        return float(table[one, other])
    total = 0
    for i in range(strips.shape[1]):
        difference = int(strips[one, i]) - int(strips[other, i])
        total += difference * difference
    return float(total)


@njit
def misfit(
    before: Bytes,
    behind: Bytes,
    table_before: Ints,
    table_behind: Ints,
    one: int,
    other: int,
    at_first: bool,
    at_last: bool,
) -> float:
    """Return the mean squared difference of what lies on both sides of two lines, in gray levels.

    ``at_first`` and ``at_last`` say whether one of the lines is the exemplar's own border, beyond which nothing is
    known.
    """
    halves, squares = 0, 0.0
    if not at_first:
        halves += 1
        squares += _squares(before, table_before, one, other)
    if not at_last:
        halves += 1
        squares += _squares(behind, table_behind, one, other)
    return squares / (halves * before.shape[1]) if halves else UNKNOWN


@njit
def weigh_places(
    cells: Longs,
    inside: Longs,
    places: Longs,
    taken: Longs,
    extent: Longs,
    periodic: bool,
    cyclic: bool,
    direction: int,
    before: Bytes,
    behind: Bytes,
    table_before: Ints,
    table_behind: Ints,
    cost: Doubles,
    same: Flags,
) -> int:
    """Add up how badly a patch at each place continues its neighbours across the lines of one direction.

    Parameters
    ----------
    cells
        (2, n) rows and columns of the patch's cells in the output.
    inside
        (2, n) the same within its box.
    places
        (2, m) where the box could lie in the exemplar.
    taken
        (2, height, width) rows and columns of what was laid down; -1 for nothing yet.
    extent
        (2,) rows and columns of the exemplar's coarsest level.
    periodic, cyclic
        Whether output and exemplar go on beyond their borders.
    direction
        0: lines that run down, neighbours on the left and right; 1: lines that run across.
    before, behind, table_before, table_behind
        Strips on both sides of the lines, (lines, samples), and their squared differences, (lines, lines) or
        empty.
    cost, same
        (m,): what is added to, and whether the place goes on as a neighbour does.

    Returns
    -------
    int
        Number of neighbours.
    """
    found = 0
    axis = 1 - direction
    last = extent[axis]
    width = extent[1] + 1 if direction == 0 else extent[1]
    for n in range(cells.shape[1]):
        for step in (-1, 1):
            y, x = cells[0, n], cells[1, n]
            if direction == 0:
                x += step
            else:
                y += step
            if periodic:
                y, x = y % taken.shape[1], x % taken.shape[2]
            elif y < 0 or x < 0 or y >= taken.shape[1] or x >= taken.shape[2]:
                continue
            if taken[0, y, x] < 0:
                continue
            found += 1
            row, column = taken[0, y, x], taken[1, y, x]
            # The line between both, as the neighbour has it and as the patch would have it.
            far = (column if direction == 0 else row) + (1 if step < 0 else 0)
            if cyclic:
                far %= last
            one = (row * width + far) if direction == 0 else (far * width + column)
            for m in range(places.shape[1]):
                own_row, own_column = inside[0, n] + places[0, m], inside[1, n] + places[1, m]
                if cyclic:
                    own_row, own_column = own_row % extent[0], own_column % extent[1]
                near = (own_column if direction == 0 else own_row) + (1 if step > 0 else 0)
                if cyclic:
                    near %= last
                other = (own_row * width + near) if direction == 0 else (near * width + own_column)
                cost[m] += misfit(
                    before, behind, table_before, table_behind, one, other,
                    not cyclic and (far == 0 or near == 0), not cyclic and (far == last or near == last),
                )  # fmt: skip
                goes_on_row = own_row + (step if direction == 1 else 0)
                goes_on_column = own_column + (step if direction == 0 else 0)
                if (goes_on_row - row) % extent[0] == 0 and (goes_on_column - column) % extent[1] == 0:
                    same[m] = True
    return found
