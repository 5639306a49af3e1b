"""A bank of spots and bars: eight weighted sums of Gaussians, which answer where an image looks like one of them.

Each Gaussian is sampled and sums to 1 and the weights of each filter sum to 0, so that a constant image gives
nothing. Coarser spots and bars are found by filtering reductions of the image.

Reference: Forsyth and Ponce, section 11.1.1, Figs. 11.3 to 11.5; Malik and Perona 1990.
"""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

# (weight, standard deviation in samples) of the concentric Gaussians of each spot.
SPOTS = (((1, 0.62), (-2, 1.0), (1, 1.6)), ((1, 0.71), (-1, 1.14)))
# (weight, offset across the bar) of the Gaussians of a bar, and their deviations across and along it.
BAR = ((-1, -1.0), (2, 0.0), (-1, 1.0))
BAR_ACROSS, BAR_ALONG = 1.0, 2.0
BARS = 6
FILTERS = len(SPOTS) + BARS
# Three standard deviations of the longest Gaussian, and its offset.
REACH = 7


@functools.cache
def kernels() -> NDArray[np.float64]:
    """Return the filters, (8, 15, 15) float64, read-only: two spots, then six bars.

    Across bar k the gray level changes along the angle k · 30°, counted from the columns' axis towards the rows'
    (bar 0 is vertical, bar 3 horizontal).
    """
    y, x = np.mgrid[-REACH : REACH + 1, -REACH : REACH + 1].astype(np.float64)
    bank = np.zeros((FILTERS, *x.shape))
    for kernel, spot in zip(bank, SPOTS, strict=False):
        for weight, sigma in spot:
            kernel += weight * _gaussian(x / sigma, y / sigma)
    for k in range(BARS):
        angle = math.pi * k / BARS
        across, along = x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle)
        for weight, shift in BAR:
            bank[len(SPOTS) + k] += weight * _gaussian((across - shift) / BAR_ACROSS, along / BAR_ALONG)
    bank.flags.writeable = False
    return bank


def _gaussian(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    values: NDArray[np.float64] = np.exp(-(x**2 + y**2) / 2)
    values /= values.sum()
    return values


def responses(plane: NDArray[np.float32]) -> Iterator[NDArray[np.float32]]:
    """Yield what each filter answers, (H, W) float32; the plane, (H, W) float32, is mirrored at its borders."""
    import cv2

    for kernel in kernels():
        found = cv2.filter2D(plane, cv2.CV_32F, kernel, borderType=cv2.BORDER_REFLECT_101)
        yield np.asarray(found, np.float32)
