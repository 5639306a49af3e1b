"""Laplacian pyramid of a volume, taken as periodic along all three axes, in pieces of a few slices.

The filter is separable: within a slice it is that of :mod:`texlab_core.transforms.gaussian`, across the slices the
same five weights. The sample (i, j, k) of a coarse level lies on the sample (2i, 2j, 2k) of the finer one.

Reference: Burt and Adelson 1983; Heeger and Bergen 1995, section 3 (solid textures).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.transforms import gaussian
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from texlab_core.transforms.gaussian import FloatT
    from texlab_core.work.tasks import Task

# Samples worked through between two pauses; a millisecond or two.
PIECE = 2**17


def max_levels(shape: Sequence[int]) -> int:
    """Return how often a volume can be reduced until its shortest side is 1."""
    return (min(shape) - 1).bit_length()


def reduced_shape(shape: Sequence[int]) -> tuple[int, int, int]:
    """Return the shape of the next coarser level: every side halved and rounded up."""
    depth, height, width = (-(-side // 2) for side in shape)
    return depth, height, width


def reduce(volume: NDArray[FloatT]) -> Task[NDArray[FloatT]]:
    """Smooth with 1/16 (1, 4, 6, 4, 1) along the three axes and keep every second sample.

    Parameters
    ----------
    volume
        (D, H, W) float32 or float64, any sides from 1.

    Yields
    ------
    int
        Samples worked through since the last time.

    Returns
    -------
    ndarray
        (ceil(D / 2), ceil(H / 2), ceil(W / 2)), of the same type.
    """
    depth = volume.shape[0]
    coarse = np.empty(reduced_shape(volume.shape), volume.dtype)
    outer, inner, centre = (volume.dtype.type(weight) for weight in gaussian.BINOMIAL[:3])
    for index in range(len(coarse)):
        middle = 2 * index
        before, after = (middle - 1) % depth, (middle + 1) % depth
        plane = centre * volume[middle]
        plane += inner * (volume[before] + volume[after])
        plane += outer * (volume[(middle - 2) % depth] + volume[(middle + 2) % depth])
        coarse[index] = gaussian.reduce(plane, "periodic")
        yield 2 * plane.size
    return coarse


def add_expanded(volume: NDArray[FloatT], coarse: NDArray[FloatT], sign: int) -> Task[None]:
    """Add (sign 1) or subtract (sign -1) a coarse level, brought to double size, in place.

    At an odd side a periodic volume is as if its last coarse sample were doubled, so that a constant stays one.

    Parameters
    ----------
    volume
        (D, H, W); overwritten.
    coarse
        (ceil(D / 2), ceil(H / 2), ceil(W / 2)), of the same type.
    sign
        1 or -1.

    Raises
    ------
    ValueError
        When the shapes do not belong to each other.
    """
    if coarse.shape != reduced_shape(volume.shape):
        raise ValueError(f"add_expanded: a volume of {coarse.shape} is no level below one of {volume.shape}.")
    kind, many, plane = volume.dtype.type, len(coarse), volume.shape[1:]
    eighth, six, half = kind(sign * 0.125), kind(sign * 0.75), kind(sign * 0.5)
    last = first = _expanded(coarse[0], plane)
    # Only three expanded slices are there at any time; the first one comes again at the end.
    before = _expanded(coarse[-1], plane) if many > 1 else first
    for index in range(many):
        here = last
        after = first if index + 1 == many else _expanded(coarse[index + 1], plane)
        volume[2 * index] += six * here + eighth * (before + after)
        if 2 * index + 1 < len(volume):
            volume[2 * index + 1] += half * (here + after)
        before, last = here, after
        yield 2 * here.size


def build(volume: NDArray[FloatT], levels: int) -> Task[list[NDArray[FloatT]]]:
    """Split a volume into bands: L_i = G_i - expand(G_{i+1}) and L_N = G_N.

    Parameters
    ----------
    volume
        (D, H, W) float32 or float64; stays as it is.
    levels
        0 .. :func:`max_levels`.

    Returns
    -------
    list of ndarray
        Band-pass levels, finest first, and the low-pass residual; C-contiguous, in memory of their own.

    Raises
    ------
    ValueError
        When the volume or ``levels`` cannot be used.
    """
    if volume.ndim != 3 or volume.size == 0 or volume.dtype not in (np.float32, np.float64):
        raise ValueError(f"A volume must be (D, H, W), float32 or float64, got {volume.shape} {volume.dtype}.")
    if not 0 <= levels <= max_levels(volume.shape):
        raise ValueError(f"levels: must be from 0 to {max_levels(volume.shape)} for {volume.shape}, got {levels}.")
    bands = []
    band = np.empty(volume.shape, volume.dtype)
    for block in row_blocks(volume.shape, PIECE):
        band[block] = volume[block]
        yield 0
    for _ in range(levels):
        coarser = yield from reduce(band)
        following = coarser.copy()
        yield from add_expanded(band, coarser, -1)
        bands.append(band)
        band = following
    bands.append(band)
    return bands


def collapse(pyramid: list[NDArray[FloatT]]) -> Task[NDArray[FloatT]]:
    """Return the volume of a pyramid, within 1e-6 of the one it was built from; the bands are overwritten."""
    volume = pyramid[-1]
    for band in reversed(pyramid[:-1]):
        yield from add_expanded(band, volume, 1)
        volume = band
    return volume


def _expanded(plane: NDArray[FloatT], shape: Sequence[int]) -> NDArray[FloatT]:
    return gaussian.expand(plane, shape, "periodic")
