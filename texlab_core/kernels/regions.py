"""Connected areas of constant offset in a source map: union-find over rows."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.kernels.jit import njit

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Source = NDArray[np.int32]
    Labels = NDArray[np.int32]


@njit
def _same_offset(source: Source, row: int, column: int, drow: int, dcolumn: int) -> bool:
    """Tell whether a pixel continues the source of its left (drow 0) or upper (dcolumn 0) neighbour."""
    y, there = source[row, column, 0], source[row - drow, column - dcolumn, 0]
    x, beside = source[row, column, 1], source[row - drow, column - dcolumn, 1]
    return bool(y >= 0 and there >= 0 and y - there == drow and x - beside == dcolumn)


@njit
def count_continuous(source: Source, first: int, last: int) -> int:
    """Count the pixels of rows first..last-1 that continue their left or upper neighbour, once for each."""
    count = 0
    for row in range(first, last):
        for column in range(source.shape[1]):
            if column > 0 and _same_offset(source, row, column, 0, 1):
                count += 1
            if row > 0 and _same_offset(source, row, column, 1, 0):
                count += 1
    return count


@njit
def _root(parent: Labels, node: int) -> int:
    while parent[node] != node:
        parent[node] = parent[parent[node]]
        node = parent[node]
    return node


@njit
def join_rows(source: Source, parent: Labels, first: int, last: int) -> None:
    """Join every pixel of rows first..last-1 with the neighbours it continues; the root is the first pixel.

    ``parent`` is (H * W,) and is filled for these rows; earlier rows must have been joined before.
    """
    width = source.shape[1]
    for row in range(first, last):
        for column in range(width):
            here = row * width + column
            parent[here] = here
            if column > 0 and _same_offset(source, row, column, 0, 1):
                parent[here] = _root(parent, here - 1)
            if row > 0 and _same_offset(source, row, column, 1, 0):
                one, other = _root(parent, here), _root(parent, here - width)
                parent[max(one, other)] = min(one, other)


@njit
def count_roots(parent: Labels, sizes: Labels, first: int, last: int) -> None:
    """Point nodes first..last-1 at their roots and count them in ``sizes`` (H * W,)."""
    for node in range(first, last):
        root = _root(parent, node)
        parent[node] = root
        sizes[root] += 1


@njit
def write_labels(parent: Labels, rank: Labels, labels: Labels, first: int, last: int) -> None:
    """Write ``labels[node] = rank[root of node]`` for nodes first..last-1."""
    for node in range(first, last):
        labels[node] = rank[parent[node]]
