"""Histograms of large arrays: counting values in even bins, and moving each toward what its bin is to become.

Pieces of a million values take about a millisecond each pass, so that callers can stop between them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.kernels.jit import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray


@njit
def count(values: NDArray[np.float32], low: np.float32, scale: np.float32, counts: NDArray[np.int32]) -> None:
    """Add values to the counts of their bins, (2, bins) of which the sum over the first axis is meant.

    ``scale`` is bins per unit; what lies beyond the first or last bin is counted there.
    """
    last = np.float32(counts.shape[1] - 1)
    # Two rows by turns: like values in a row do not wait for each other.
    for place in range(len(values)):
        scaled = (values[place] - low) * scale
        scaled = scaled if scaled > 0 else np.float32(0)
        counts[place & 1, np.uint32(scaled if scaled < last else last)] += 1


@njit
def shares_below(sample: NDArray[np.float32], low: float, width: float, shares: NDArray[np.float64]) -> None:
    """Set the shares of a sorted sample that lie below the edges ``low + width * i``; the last one is 1."""
    below, many = 0, len(sample)
    for edge in range(len(shares) - 1):
        limit = low + width * edge
        while below < many and sample[below] < limit:
            below += 1
        shares[edge] = below / many
    shares[-1] = 1.0


@njit
def to_changes(
    values: NDArray[np.float32], low: np.float32, scale: np.float32, table: NDArray[np.float32], step: np.float32
) -> None:
    """Replace values by ``step`` times the way to what a table has at the edges of their bins, (bins + 1,)."""
    last = np.float32(len(table) - 2)
    rises = np.diff(table)
    for place in range(len(values)):
        value = values[place]
        scaled = (value - low) * scale
        bounded = scaled if scaled > 0 else np.float32(0)
        index = np.uint32(bounded if bounded < last else last)
        wanted = table[index] + (scaled - np.float32(index)) * rises[index]
        values[place] = (wanted - value) * step


@njit
def scaled_distances(
    around: NDArray[np.float64], wanted: NDArray[np.float64], factors: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return for each factor f the mean of abs(f around - wanted), (factors,)."""
    sums = np.zeros(len(factors))
    for place in range(len(around)):
        here, there = around[place], wanted[place]
        for index in range(len(factors)):
            sums[index] += abs(factors[index] * here - there)
    return sums / len(around)
