"""The order of filling, from geometry alone: outward in layers, in each layer most known neighbours first."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.kernels.neighbourhood_types import Window

# Work per portion: pixels that are only looked at, and offsets that are visited.
PIXELS_AT_ONCE = 2**19
OFFSETS_AT_ONCE = 2**21


def first_layer(
    status: NDArray[np.uint8], window: Window, tiles: bool, key: int
) -> Generator[None, None, NDArray[np.int32]]:
    """Return the unknown pixels that touch a known one, in the order of filling; yields between portions.

    Parameters
    ----------
    status
        (H, W) uint8 of the kernels; the pixels returned become ``QUEUED``.
    window
        Within which known neighbours are counted.
    tiles
        The image continues periodically.
    key
        Of the hash that orders equals.

    Returns
    -------
    (n,) int32, row x width + column.
    """
    from texlab_core.kernels.layers import frontier

    height, width = status.shape
    rows = max(1, PIXELS_AT_ONCE // width)
    parts = []
    for first in range(0, height, rows):
        last = min(first + rows, height)
        layer = np.empty((last - first) * width, np.int32)
        parts.append(layer[: frontier(status, tiles, first, last, layer)].copy())
        yield
    return (yield from _most_known_first(status, window, tiles, key, np.concatenate(parts)))


def following_layer(
    status: NDArray[np.uint8], window: Window, tiles: bool, key: int, layer: NDArray[np.int32]
) -> Generator[None, None, NDArray[np.int32]]:
    """Return the layer after ``layer``: what is unknown of it and around it; see :func:`first_layer`."""
    from texlab_core.kernels.layers import next_layer

    parts = []
    for first in range(0, len(layer), PIXELS_AT_ONCE // 8):
        pixels = layer[first : first + PIXELS_AT_ONCE // 8]
        found = np.empty(9 * len(pixels), np.int32)
        parts.append(found[: next_layer(status, tiles, pixels, found)].copy())
        yield
    pixels = np.concatenate(parts) if parts else np.empty(0, np.int32)
    return (yield from _most_known_first(status, window, tiles, key, pixels))


def raster_rows(status: NDArray[np.uint8], first: int) -> tuple[NDArray[np.int32], int]:
    """Return the unknown pixels of some rows from ``first`` on, in raster order, and the row after them."""
    from texlab_core.kernels.layers import KNOWN

    height, width = status.shape
    last = min(height, first + max(1, PIXELS_AT_ONCE // width))
    unknown = np.flatnonzero(status[first:last].ravel() != KNOWN)
    return (unknown + first * width).astype(np.int32), last


def _most_known_first(
    status: NDArray[np.uint8], window: Window, tiles: bool, key: int, pixels: NDArray[np.int32]
) -> Generator[None, None, NDArray[np.int32]]:
    from texlab_core.kernels.layers import layer_keys

    # The same order however the pixels were found, in one piece or after a resume.
    pixels.sort()
    keys = np.empty(len(pixels), np.uint64)
    portion = max(1, OFFSETS_AT_ONCE // len(window.rows))
    for first in range(0, len(pixels), portion):
        part = slice(first, first + portion)
        layer_keys(status, window.rows, window.columns, tiles, np.uint64(key), pixels[part], first, keys[part])
        yield
    keys.sort()
    yield
    keys &= np.uint64(2**26 - 1)
    ordered: NDArray[np.int32] = pixels[keys]
    return ordered
