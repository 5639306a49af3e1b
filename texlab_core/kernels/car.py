"""The causal recursion of an autoregressive field, row by row."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.kernels.jit import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray

REACH = 5


@njit
def recurse(
    noise: NDArray[np.float32],
    coefficients: NDArray[np.float64],
    field: NDArray[np.float64],
    first: int,
    last: int,
    warm: int,
    limit: float,
) -> int:
    """Compute rows ``first`` to ``last`` of x = sum a x(earlier) + noise on a cylinder.

    Parameters
    ----------
    noise
        (H, W) float32; row i of the field takes row (i - warm) mod H.
    coefficients
        (6, 11) float64: [dy, dx + 5] weighs the pixel dy rows above and dx to the left.
    field
        (warm + H, W + 10) float64 with 5 columns of the other side at both ends; earlier rows are read, and what
        lies above row 0 is 0.
    warm
        Rows before the first one that counts, and columns over which each row is started.
    limit
        Values are kept within this.

    Returns
    -------
    int
        How many values were limited in rows that count.
    """
    height, width = noise.shape
    limited = 0
    line = np.zeros(width)
    for row in range(first, last):
        source = (row - warm) % height
        for x in range(width):
            line[x] = noise[source, x]
        for dy in range(1, REACH + 1):
            if row - dy < 0:
                break
            for dx in range(-REACH, REACH + 1):
                weight = coefficients[dy, dx + REACH]
                start = REACH - dx
                for x in range(width):
                    line[x] += weight * field[row - dy, start + x]
        a1, a2, a3, a4, a5 = (
            coefficients[0, REACH + 1],
            coefficients[0, REACH + 2],
            coefficients[0, REACH + 3],
            coefficients[0, REACH + 4],
            coefficients[0, REACH + 5],
        )
        x1, x2, x3, x4, x5 = 0.0, 0.0, 0.0, 0.0, 0.0
        # The row starts before itself, on the other side of the cylinder.
        for step in range(-warm, width):
            x = step % width
            value = line[x] + a1 * x1 + a2 * x2 + a3 * x3 + a4 * x4 + a5 * x5
            if not -limit <= value <= limit:
                value = limit if value > 0 else -limit
                if step >= 0 and row >= warm:
                    limited += 1
            x1, x2, x3, x4, x5 = value, x1, x2, x3, x4
            if step >= 0:
                field[row, REACH + x] = value
        for column in range(REACH):
            left = (column - REACH) % width
            right = column % width
            field[row, column] = field[row, REACH + left]
            field[row, REACH + width + column] = field[row, REACH + right]
    return limited
