"""How much of a result was copied: continuous neighbours and connected areas, from a source map."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

import numpy as np

from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

_PIXELS_AT_ONCE = 2**18
ValueT = TypeVar("ValueT")


def continuous_share(source_map: NDArray[np.int32]) -> float:
    """Share of neighbouring pixels whose sources are neighbours in the same way.

    Parameters
    ----------
    source_map
        (H, W, 2) int32, row and column in the exemplar of every pixel; a negative row means that it has none.

    Returns
    -------
    float
        0 .. 1, over all horizontal and vertical neighbours; 1 for a verbatim copy and for a single pixel.

    Reference: the measure of copying behind De Bonet 1997, figs. 11 and 12 (how much was rearranged).
    """
    return _drive(continuous_share_steps(source_map))


def continuous_share_steps(source_map: NDArray[np.int32]) -> Generator[float, None, float]:
    """Do what :func:`continuous_share` does in parts of a few milliseconds, yielding the share done (0 .. 1)."""
    from texlab_core.kernels.regions import count_continuous

    source = _checked(source_map)
    height, width = source.shape[:2]
    pairs = height * (width - 1) + width * (height - 1)
    count = 0
    for first, last in _row_blocks(height, width):
        count += count_continuous(source, first, last)
        yield last / height
    return count / pairs if pairs else 1.0


def copied_regions(source_map: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Label the connected areas (4-neighbours) that were copied with one offset.

    Parameters
    ----------
    source_map
        (H, W, 2) int32, row and column in the exemplar of every pixel; a negative row means that it has none.

    Returns
    -------
    labels
        (H, W) int32: 1 is the largest area, then by falling size, areas of equal size in raster order; 0 is a
        pixel that continues none of its neighbours.
    sizes
        (areas + 1,) int64: ``sizes[label]`` in pixels; ``sizes[0]`` counts the pixels that continue none.
    """
    return _drive(copied_regions_steps(source_map))


def copied_regions_steps(
    source_map: NDArray[np.int32],
) -> Generator[float, None, tuple[NDArray[np.int32], NDArray[np.int64]]]:
    """Do what :func:`copied_regions` does in parts of a few milliseconds, yielding the share done (0 .. 1)."""
    from texlab_core.kernels.regions import count_roots, join_rows, write_labels

    source = _checked(source_map)
    height, width = source.shape[:2]
    blocks = _row_blocks(height, width)
    parent = np.empty(height * width, np.int32)
    for done, (first, last) in enumerate(blocks):
        join_rows(source, parent, first, last)
        yield (done + 1) / (3 * len(blocks))
    counts = np.zeros(height * width, np.int32)
    for done, (first, last) in enumerate(blocks):
        count_roots(parent, counts, first * width, last * width)
        yield (done + 1 + len(blocks)) / (3 * len(blocks))
    found = []
    for first, last in blocks:
        found.append(first * width + np.flatnonzero(counts[first * width : last * width] > 1))
        yield 2 / 3
    roots = np.concatenate(found)
    yield 2 / 3
    roots = roots[np.argsort(-counts[roots], kind="stable")]
    yield 2 / 3
    rank = np.zeros(height * width, np.int32)
    rank[roots] = np.arange(1, roots.size + 1, dtype=np.int32)
    yield 2 / 3
    labels = np.empty(height * width, np.int32)
    for done, (first, last) in enumerate(blocks):
        write_labels(parent, rank, labels, first * width, last * width)
        yield (done + 1 + 2 * len(blocks)) / (3 * len(blocks))
    single = height * width - int(counts[roots].sum())
    return labels.reshape(height, width), np.concatenate(([single], counts[roots])).astype(np.int64)


def largest_copy(sizes: NDArray[np.int64]) -> float:
    """Return the largest copied piece as a share of the picture, from the sizes of :func:`copied_regions`."""
    total = int(sizes.sum())
    return float(sizes[1]) / total if sizes.size > 1 else 1.0 / total if total else 0.0


def _drive(steps: Generator[float, None, ValueT]) -> ValueT:
    while True:
        try:
            next(steps)
        except StopIteration as end:
            value: ValueT = end.value
            return value


def _row_blocks(height: int, width: int) -> list[tuple[int, int]]:
    rows = max(1, _PIXELS_AT_ONCE // max(1, width))
    return [(first, min(height, first + rows)) for first in range(0, height, rows)]


def _checked(source_map: NDArray[np.int32]) -> NDArray[np.int32]:
    if source_map.ndim != 3 or source_map.shape[2] != 2:
        raise InputError(f"source map: must have the shape (H, W, 2), got {source_map.shape}.")
    return np.ascontiguousarray(source_map, dtype=np.int32)
