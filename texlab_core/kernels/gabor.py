"""Sums over the Fourier half plane with separable Gaussians, in an order that no library's threads can change."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.kernels.jit import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Rows that are worked on at once, so that they stay in the cache.
ROWS = 32


@njit
def marginals(
    half: NDArray[np.complex64],
    first: int,
    gain_v: NDArray[np.float64],
    gain_u: NDArray[np.float64],
    ends_v: NDArray[np.int64],
    ends_u: NDArray[np.int64],
    along_u: NDArray[np.float64],
    along_v: NDArray[np.float64],
) -> None:
    """Add the marginals of |T|^2 weighted by profiles along the other axis.

    Parameters
    ----------
    half
        (rows, columns) complex64, a block of rows of the half plane.
    first
        Its first row in the whole half plane.
    gain_v, gain_u
        (n, H) and (n, columns) profiles.
    ends_v, ends_u
        (n,) the profiles that go with one another are negligible at rows from ``ends_v`` to H - ``ends_v``, and at
        columns from ``ends_u``.
    along_u
        (n, columns): sums over the rows, weighted by ``gain_v``, are added.
    along_v
        (n, H): sums over the columns, weighted by ``gain_u``, are written for the rows of the block.
    """
    count, height = gain_v.shape
    columns = half.shape[1]
    power = np.empty((ROWS, columns))
    turned = np.empty((columns, ROWS))
    line = np.empty(ROWS)
    for start in range(0, half.shape[0], ROWS):
        rows = min(ROWS, half.shape[0] - start)
        for r in range(rows):
            for j in range(columns):
                value = half[start + r, j]
                square = np.float64(value.real) * value.real + np.float64(value.imag) * value.imag
                power[r, j] = square
                turned[j, r] = square
        for n in range(count):
            end = ends_u[n]
            for r in range(rows):
                row = first + start + r
                if ends_v[n] <= row <= height - ends_v[n]:
                    continue
                weight = gain_v[n, row]
                for j in range(end):
                    along_u[n, j] += weight * power[r, j]
            line[:] = 0.0
            for j in range(end):
                weight = gain_u[n, j]
                for r in range(ROWS):
                    line[r] += weight * turned[j, r]
            for r in range(rows):
                along_v[n, first + start + r] = line[r]


@njit
def shape(
    half: NDArray[np.complex64],
    first: int,
    factor_v: NDArray[np.float32],
    factor_u: NDArray[np.float32],
    least: float,
) -> None:
    """Multiply rows of the half plane by the root of a sum of separable lobes, in place.

    Parameters
    ----------
    half
        (rows, columns) complex64, a block of rows.
    first
        Its first row in the whole half plane.
    factor_v, factor_u
        (H, m) and (m, columns) float32 factors of the power.
    least
        Lobes are left out on rows where their vertical factor is below.
    """
    columns = half.shape[1]
    power = np.empty(columns, np.float32)
    for r in range(half.shape[0]):
        power[:] = 0
        for m in range(factor_u.shape[0]):
            weight = factor_v[first + r, m]
            if weight < least:
                continue
            for j in range(columns):
                power[j] += weight * factor_u[m, j]
        for j in range(columns):
            half[r, j] *= np.sqrt(power[j])


@njit
def overlaps(first: NDArray[np.float64], second: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the sums of products of all pairs of rows, (n, m), of (n, k) and (m, k)."""
    rows, columns, count = first.shape[0], second.shape[0], first.shape[1]
    turned = np.ascontiguousarray(second.T)
    total = np.zeros((rows, columns))
    for i in range(rows):
        for k in range(count):
            weight = first[i, k]
            # Far from a filter's centre there is nothing to add.
            if weight < 1e-30:
                continue
            for j in range(columns):
                total[i, j] += weight * turned[k, j]
    return total


@njit
def covariances(values: NDArray[np.float64], offsets: NDArray[np.int64], total: NDArray[np.float64]) -> None:
    """Add the products of every pixel and its predecessors with one another.

    Parameters
    ----------
    values
        (rows + top, W + 2 margin) float64; the predecessors of the pixels from row ``top`` and within the margins.
    offsets
        (n, 2) rows above and columns to the left; their largest moduli are ``top`` and ``margin``.
    total
        (n, n) sums, added to; only j >= i.
    """
    count = offsets.shape[0]
    top, margin = offsets[:, 0].max(), np.abs(offsets[:, 1]).max()
    width = values.shape[1] - 2 * margin
    near = np.empty(count)
    for y in range(top, values.shape[0]):
        for x in range(margin, margin + width):
            for i in range(count):
                near[i] = values[y - offsets[i, 0], x - offsets[i, 1]]
            for i in range(count):
                weight = near[i]
                for j in range(i, count):
                    total[i, j] += weight * near[j]
