"""Frequency responses of the steerable pyramid, computed once and kept.

All radii are absolute frequencies in radians per pixel of the full image. A raised cosine in log2 of the radius
falls from 1 at half its cut to 0 at the cut; the first one is cut at pi, the one of level l at pi / 2^(l + 1).
Since each low-pass is 1 wherever the next one is not 0, a band's response is a product of two of them.

Reference: Heeger and Bergen 1995, section 2.1, figure 1; Simoncelli and Freeman 1995; Karasaridis and Simoncelli
1996.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from texlab_core.work.kept import ARRAYS
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.work.tasks import Task

Size = tuple[int, int]
Mask = NDArray[Any]


def level_size(size: Size, level: int) -> Size:
    """Return height and width of the bands at a level: ceil(N / 2^level)."""
    return -(-size[0] >> level), -(-size[1] >> level)


def spectrum_size(size: Size) -> Size:
    """Return the shape of the half spectrum of a real image."""
    return size[0], size[1] // 2 + 1


def highpass(size: Size, dtype: np.dtype[Any]) -> Task[Mask]:
    """Return the response of the high-pass residual on the half spectrum of an image of this size."""

    def response(radius: Mask, mask: Mask, *_: Mask) -> None:
        mask[:] = _rise(radius, math.pi)

    return ARRAYS.get(("highpass", size, dtype.str), lambda: _fill(size, size, dtype, (), response))


def lowpass(size: Size, levels: int, dtype: np.dtype[Any]) -> Task[Mask]:
    """Return the response of the low-pass residual below ``levels`` levels, on its cropped half spectrum."""
    crop = level_size(size, levels)

    def response(radius: Mask, mask: Mask, *_: Mask) -> None:
        mask[:] = _fall(radius, math.pi / 2**levels)

    return ARRAYS.get(("lowpass", size, levels, dtype.str), lambda: _fill(size, crop, dtype, (), response))


def oriented(size: Size, level: int, orientations: int, dtype: np.dtype[Any]) -> Task[Mask]:
    """Return the responses (K, h, w // 2 + 1) of a level's oriented bands without their factor (-i)^(K-1)."""
    crop, cut, power = level_size(size, level), math.pi / 2**level, orientations - 1
    alpha = 2**power * math.factorial(power) / math.sqrt(orientations * math.factorial(2 * power))

    def response(radius: Mask, masks: Mask, rows: Mask, columns: Mask) -> None:
        radial = alpha * _fall(radius, cut) * _rise(radius, cut / 2)
        safe = np.where(radius > 0, radius, 1)
        across, down = columns / safe, rows / safe
        for index, mask in enumerate(masks):
            phi = math.pi * index / orientations
            # cos(theta - phi) without angles, so that opposite frequencies get exactly opposite values.
            cosine = across * math.cos(phi) + down * math.sin(phi)
            mask[:] = radial * _power(cosine, power)

    key = ("oriented", size, level, orientations, dtype.str)
    return ARRAYS.get(key, lambda: _fill(size, crop, dtype, (orientations,), response))


def _fill(
    size: Size, crop: Size, dtype: np.dtype[Any], many: tuple[int, ...], response: Callable[..., None]
) -> Task[Mask]:
    """Compute responses block by block of rows."""
    rows, columns = _frequencies(size, crop)
    masks = np.empty((*many, *spectrum_size(crop)), dtype)
    # A response costs about as much as the transform of ten times as many samples.
    for block in row_blocks(spectrum_size(crop), 2**16):
        radius = np.hypot(rows[block], columns)
        response(radius, masks[..., block, :], rows[block], columns)
        yield radius.size * 4
    return masks


def _frequencies(size: Size, crop: Size) -> tuple[Mask, Mask]:
    """Return row (h, 1) and column (1, w // 2 + 1) frequencies of the cropped half spectrum."""
    height, width = crop
    rows = np.fft.ifftshift(np.arange(-(height // 2), height - height // 2))[:, None]
    columns = np.arange(width // 2 + 1)[None, :]
    return rows * (2 * np.pi / size[0]), columns * (2 * np.pi / size[1])


def _octaves(radius: Mask, cut: float) -> Mask:
    """Return the phase of the raised cosine: 0 up to half the cut, pi / 2 from the cut on."""
    with np.errstate(divide="ignore"):
        phase: Mask = np.pi / 2 * np.clip(1 + np.log2(radius / cut), 0, 1)
    return phase


def _fall(radius: Mask, cut: float) -> Mask:
    # Exactly 0 from the cut on: the crop to ceil(N / 2^l) then loses nothing.
    fall: Mask = np.where(radius < cut, np.cos(_octaves(radius, cut)), 0)
    return fall


def _rise(radius: Mask, cut: float) -> Mask:
    rise: Mask = np.where(radius < cut, np.sin(_octaves(radius, cut)), 1)
    return rise


def _power(base: Mask, exponent: int) -> Mask:
    """Return base^exponent by squaring; NumPy's own power is ten times slower."""
    result = np.ones_like(base)
    while exponent:
        if exponent & 1:
            result = result * base
        base, exponent = base * base, exponent >> 1
    return result
