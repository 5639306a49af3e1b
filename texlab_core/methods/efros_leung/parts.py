"""How what is unknown is divided into parts, and in which order they are filled: from geometry alone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable

    from numpy.typing import NDArray

Box = tuple[slice, slice]
"""Rows and columns."""

CELL = 32
"""Holes that touch neighbouring cells of so many pixels are one hole."""
WHOLE = 6
"""Holes of at most so many cells in either side are one part; larger ones are cut."""
TILE = 4
"""Side in cells of the parts that they are cut into."""


def size_of(box: Box) -> tuple[int, int]:
    """Return height and width."""
    return box[0].stop - box[0].start, box[1].stop - box[1].start


def dilated(box: Box, by: int, size: tuple[int, ...]) -> Box:
    """Return a box that is larger on all sides, as far as there is an image of this size."""
    rows, columns = box
    return (
        slice(max(rows.start - by, 0), min(rows.stop + by, size[0])),
        slice(max(columns.start - by, 0), min(columns.stop + by, size[1])),
    )


def shifted(box: Box, outer: Box) -> Box:
    """Return a box by its place in another one."""
    (rows, columns), top, left = box, outer[0].start, outer[1].start
    return slice(rows.start - top, rows.stop - top), slice(columns.start - left, columns.stop - left)


def parts_of(unknown: NDArray[np.bool_]) -> Generator[None, None, list[Box]]:
    """Divide what is unknown, and order the parts so that each touches what is known by then.

    Parameters
    ----------
    unknown
        (H, W) bool; some of it is False.

    Returns
    -------
    list of Box
        They cover everything unknown, and do not overlap in it. First those that touch what is known, from top to
        bottom; then, in the same order, those that touch one of these; and so on.
    """
    import cv2

    cells = yield from _cells(unknown)
    count, labels, stats, _ = cv2.connectedComponentsWithStats(cells, connectivity=8)
    waiting: list[Box] = []
    for label in range(1, count):
        left, top, width, height = (int(stats[label, each]) for each in range(4))
        whole = max(height, width) <= WHOLE
        sides = (height, width) if whole else (TILE, TILE)
        own = labels[top : top + height, left : left + width] == label
        for row in range(0, height, sides[0]):
            for column in range(0, width, sides[1]):
                there = own[row : row + sides[0], column : column + sides[1]]
                waiting += _tight(unknown, (top + row, left + column), there)
        yield
    return (yield from _ordered(unknown, sorted(waiting, key=_corner)))


def _corner(box: Box) -> tuple[int, int]:
    return box[0].start, box[1].start


def _cells(unknown: NDArray[np.bool_]) -> Generator[None, None, NDArray[np.uint8]]:
    """Return which cells have something unknown."""
    height, width = unknown.shape
    cells = np.zeros((-(-height // CELL), -(-width // CELL)), np.uint8)
    for row in range(cells.shape[0]):
        band = unknown[row * CELL : (row + 1) * CELL].any(axis=0)
        cells[row] = np.add.reduceat(band, np.arange(0, width, CELL)) > 0
        if row % 8 == 0:
            yield
    return cells


def _tight(unknown: NDArray[np.bool_], corner: tuple[int, int], own: NDArray[np.bool_]) -> Iterable[Box]:
    """Return the smallest box around what is unknown in some cells, as a list of at most one."""
    rows = slice(corner[0] * CELL, min((corner[0] + own.shape[0]) * CELL, unknown.shape[0]))
    columns = slice(corner[1] * CELL, min((corner[1] + own.shape[1]) * CELL, unknown.shape[1]))
    # Other holes may reach into the same rectangle; they are parts of their own.
    mine = np.repeat(np.repeat(own, CELL, axis=0), CELL, axis=1)[: size_of((rows, columns))[0]]
    there = unknown[rows, columns] & mine[:, : columns.stop - columns.start]
    down, across = (np.flatnonzero(there.any(axis=axis)) for axis in (1, 0))
    if down.size == 0:
        return []
    return [
        (
            slice(rows.start + int(down[0]), rows.start + int(down[-1]) + 1),
            slice(columns.start + int(across[0]), columns.start + int(across[-1]) + 1),
        )
    ]


def _ordered(unknown: NDArray[np.bool_], waiting: list[Box]) -> Generator[None, None, list[Box]]:
    left = unknown.copy()
    order: list[Box] = []
    while waiting:
        now = []
        for box in waiting:
            if not left[dilated(box, 1, left.shape)].all():
                now.append(box)
            yield
        for box in now:
            left[box] = False
        order += now
        waiting = [box for box in waiting if box not in now]
    return order
