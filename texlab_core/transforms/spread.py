"""Reduce and expand around an odd side, with coarse samples that lie evenly: no place of a tile is a seam.

Of N samples around, n = ceil(N / 2) remain, N / n apart. The filters are those of the Gaussian pyramid, the
binomial (1, 4, 6, 4, 1) taken as a piecewise linear function, stretched to this distance and made to sum to one;
with N = 2 n they are the same.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Literal, TypeVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray
    from scipy.sparse import csr_array

FloatT = TypeVar("FloatT", np.float32, np.float64)


def reduce(image: NDArray[FloatT]) -> NDArray[FloatT]:
    """Halve both sides, rounding up: (H, W) or (H, W, C) to (ceil(H / 2), ceil(W / 2)) or with C, same type."""
    return _along_both(image, image.shape[:2], lambda side: _reducing(side))


def expand(
    image: NDArray[FloatT], shape: tuple[int, int], mode: Literal["interpolate", "replicate"]
) -> NDArray[FloatT]:
    """Go back to ``shape``, whose halves rounded up are the sides of the image."""
    return _along_both(image, shape, lambda side: _expanding(side, mode))


def _along_both(
    image: NDArray[FloatT], sides: tuple[int, ...], matrix_of: Callable[[int], csr_array]
) -> NDArray[FloatT]:
    planes = np.moveaxis(image[..., None] if image.ndim == 2 else image, -1, 0)
    down, across = (matrix_of(side) for side in sides)
    found = [(across @ (down @ plane).T).T.astype(image.dtype) for plane in planes]
    return np.ascontiguousarray(found[0] if image.ndim == 2 else np.stack(found, axis=-1))


def _binomial(distance: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.interp(np.abs(distance), (0, 1, 2, 3), (6, 4, 1, 0))


@lru_cache(maxsize=32)
def _reducing(side: int) -> csr_array:
    coarse = -(-side // 2)
    step = side / coarse
    middle = np.arange(coarse)[:, None] * step
    # At most three samples on each side are closer than three half steps.
    near = np.round(middle).astype(np.int64) + np.arange(-3, 4)
    return _matrix(_binomial((near - middle) / (step / 2)), near % side, side)


@lru_cache(maxsize=32)
def _expanding(side: int, mode: str) -> csr_array:
    coarse = -(-side // 2)
    step = side / coarse
    place = np.arange(side)[:, None] / step
    if mode == "replicate":
        # Blocks of two, and one of a single sample in the middle.
        return _matrix(np.ones((side, 1)), np.floor(place + 0.5 / step).astype(np.int64), coarse)
    near = np.round(place).astype(np.int64) + np.arange(-2, 3)
    return _matrix(_binomial(2 * (near - place)), near % coarse, coarse)


def _matrix(weights: NDArray[np.float64], columns: NDArray[np.int64], width: int) -> csr_array:
    """Return the sparse matrix with these weights, (rows, n), in these columns, its rows summing to one."""
    from scipy.sparse import csr_array

    weights = weights / weights.sum(1, keepdims=True)
    rows = np.repeat(np.arange(len(weights)), weights.shape[1])
    return csr_array((weights.ravel(), (rows, columns.ravel())), shape=(len(weights), width))
