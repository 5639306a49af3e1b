"""Classes of equal rows in a feature table."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.kernels.jit import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray

_PRIME = np.uint64(0x9E3779B97F4A7C15)


@njit
def classify_rows(
    words: NDArray[np.uint32],
    table: NDArray[np.int32],
    classes: NDArray[np.int32],
    found: int,
    first: int,
    last: int,
) -> int:
    """Give equal rows among ``words[:last]`` (P, J) the same class, numbered in order of appearance.

    Rows before ``first`` have theirs, ``found`` classes in all; returns the number of classes afterwards.
    ``table`` is a hash table of rows, -1 where empty; its length is a power of two above P.
    """
    mask = table.size - 1
    for row in range(first, last):
        value = _PRIME
        for j in range(words.shape[1]):
            value = (value ^ np.uint64(words[row, j])) * _PRIME
            value ^= value >> np.uint64(29)
        slot = np.int64(value & np.uint64(mask))
        while True:
            other = table[slot]
            if other < 0:
                table[slot] = row
                classes[row] = found
                found += 1
                break
            same = True
            for j in range(words.shape[1]):
                if words[row, j] != words[other, j]:
                    same = False
                    break
            if same:
                classes[row] = classes[other]
                break
            slot = (slot + 1) & mask
    return found
