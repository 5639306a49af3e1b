"""Compiled parts of the fill order: layers around what is known, and what sorts the pixels of a layer."""

from __future__ import annotations

from typing import Any

import numpy as np

from texlab_core.kernels.jit import njit

UNKNOWN, KNOWN, QUEUED = 0, 1, 2


@njit
def _hash(key: Any, row: Any, column: Any) -> Any:
    """Counter-based: 64 bits that depend on (key, row, column) only (the finalizer of splitmix64, twice)."""
    bits = np.uint64(key)
    for counter in (row, column):
        bits = bits + np.uint64(counter) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(0x9E3779B97F4A7C15)
        bits = (bits ^ (bits >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        bits = (bits ^ (bits >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        bits = bits ^ (bits >> np.uint64(31))
    return bits


@njit
def frontier(status: Any, tiles: Any, first: Any, last: Any, layer: Any) -> Any:
    """Write the unknown pixels that touch a known one, of some rows, into ``layer``; return how many.

    What is written becomes ``QUEUED``.
    """
    height, width = status.shape
    count = 0
    for y in range(first, last):
        for x in range(width):
            if status[y, x] == KNOWN:
                continue
            touches = False
            for dy in range(-1, 2):
                for dx in range(-1, 2):
                    row, column = y + dy, x + dx
                    if tiles:
                        row, column = row % height, column % width
                    elif row < 0 or row >= height or column < 0 or column >= width:
                        continue
                    touches = touches or status[row, column] == KNOWN
            if touches:
                status[y, x] = QUEUED
                layer[count] = y * width + x
                count += 1
    return count


@njit
def layer_keys(
    status: Any, rows: Any, columns: Any, tiles: Any, key: Any, pixels: Any, first: Any, keys: Any
) -> None:
    """Write what sorts pixels: 12 bits of unknown neighbours, 26 of a hash, 26 of the place in the layer.

    Parameters
    ----------
    status
        (H, W) uint8.
    rows, columns
        (n,) int64, the offsets among which known neighbours are counted.
    tiles
        The image continues periodically.
    key
        Of the hash.
    pixels, first
        (m,) int32, row x width + column, and the place of the first of them in the layer.
    keys
        (m,) uint64, written.
    """
    height, width = status.shape
    for i in range(len(pixels)):
        y, x = pixels[i] // width, pixels[i] % width
        missing = len(rows)
        for k in range(len(rows)):
            row, column = y + rows[k], x + columns[k]
            if tiles:
                row, column = row % height, column % width
            elif row < 0 or row >= height or column < 0 or column >= width:
                continue
            if status[row, column] == KNOWN:
                missing -= 1
        random = _hash(key, y, x) >> np.uint64(38)
        keys[i] = (np.uint64(missing) << np.uint64(52)) | (random << np.uint64(26)) | np.uint64(first + i)


@njit
def next_layer(status: Any, tiles: Any, pixels: Any, layer: Any) -> Any:
    """Write what of ``pixels`` is unknown and the unknown neighbours of the rest into ``layer``; return how many.

    What is written becomes ``QUEUED``.
    """
    height, width = status.shape
    count = 0
    for i in range(len(pixels)):
        y, x = pixels[i] // width, pixels[i] % width
        if status[y, x] != KNOWN:
            layer[count] = pixels[i]
            count += 1
            continue
        for dy in range(-1, 2):
            for dx in range(-1, 2):
                row, column = y + dy, x + dx
                if tiles:
                    row, column = row % height, column % width
                elif row < 0 or row >= height or column < 0 or column >= width:
                    continue
                if status[row, column] == UNKNOWN:
                    status[row, column] = QUEUED
                    layer[count] = row * width + column
                    count += 1
    return count
