"""A bank of spots and bars: eight weighted sums of Gaussians, which answer where an image looks like one of them.

Each Gaussian is sampled and sums to 1 and the weights of each filter sum to 0, so that a constant image gives
nothing. Coarser spots and bars are found by filtering reductions of the image (:func:`responses`), or with wider
kernels (:func:`scaled_kernels`), which show the same image at several scales side by side.

Reference: Forsyth and Ponce, section 11.1.1, Figs. 11.3 to 11.5; Malik and Perona 1990.
"""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.errors import ParamError
from texlab_core.work.kept import kept
from texlab_core.work.tasks import go_on
from texlab_core.work.threads import workers

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

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
# Below 1 the samples no longer tell a bar's Gaussians apart; above 16 a kernel is larger than most textures.
SCALES = (1.0, 16.0)


@functools.cache
def kernels() -> NDArray[np.float64]:
    """Return the filters, (8, 15, 15) float64, read-only: two spots, then six bars.

    Across bar k the gray level changes along the angle k · 30°, counted from the columns' axis towards the rows'
    (bar 0 is vertical, bar 3 horizontal).
    """
    bank = _sampled(1.0)
    bank.flags.writeable = False
    return bank


@kept
def scaled_kernels(scale: float) -> NDArray[np.float64]:
    """Return the filters with all lengths times a scale, (8, n, n) float64, n odd, read-only.

    Each is scaled to a sum of absolute values of 2: the responses to an image in [0, 1] lie between -1 and 1, and
    those of different filters can be compared.

    Parameters
    ----------
    scale
        1 to 16; 1 has the sigmas of the text (Fig. 11.4), 2 to 4 show what it shows as the coarser scale (11.5).

    Raises
    ------
    ParamError
        When the scale is out of range.
    """
    low, high = SCALES
    if not low <= scale <= high:
        raise ParamError("scale", f"a number from {low:g} to {high:g}", scale)
    bank = _sampled(scale)
    # What is left of the sum by rounding would answer to a constant.
    bank -= bank.mean(axis=(1, 2), keepdims=True)
    bank *= 2 / np.abs(bank).sum(axis=(1, 2), keepdims=True)
    return bank


def filter_name(number: int) -> str:
    """Return a filter's name: two spots, then six bars by the angle across them."""
    if number < len(SPOTS):
        return f"spot of {len(SPOTS[number])} Gaussians"
    return f"bar, waves along {180 * (number - len(SPOTS)) // BARS}°"


def _sampled(scale: float) -> NDArray[np.float64]:
    reach = math.ceil(REACH * scale)
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1] / scale
    bank = np.zeros((FILTERS, *x.shape))
    for kernel, spot in zip(bank, SPOTS, strict=False):
        for weight, sigma in spot:
            kernel += weight * _gaussian(x / sigma, y / sigma)
    for k in range(BARS):
        angle = math.pi * k / BARS
        across, along = x * math.cos(angle) + y * math.sin(angle), y * math.cos(angle) - x * math.sin(angle)
        for weight, shift in BAR:
            bank[len(SPOTS) + k] += weight * _gaussian((across - shift) / BAR_ACROSS, along / BAR_ALONG)
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


def scaled_responses(
    plane: NDArray[np.float32], scale: float, look: Callable[[], None] = go_on
) -> NDArray[np.float32]:
    """Return what the filters of one scale answer, (8, H, W) float32; the plane is mirrored at its borders.

    Parameters
    ----------
    plane
        (H, W) float32.
    scale
        1 to 16; see :func:`scaled_kernels`.
    look
        Called between the filters; may raise to stop.

    Reference: Forsyth and Ponce, Figs. 11.4 and 11.5, which show their absolute values.
    """
    from scipy import fft

    bank = scaled_kernels(scale)
    reach = bank.shape[1] // 2
    height, width = plane.shape
    padded = _mirrored(plane, reach)
    size = (fft.next_fast_len(padded.shape[0], real=True), fft.next_fast_len(padded.shape[1], real=True))
    look()
    spectrum = fft.rfft2(padded, s=size, workers=workers())
    found = np.empty((FILTERS, height, width), np.float32)
    for number in range(FILTERS):
        look()
        gains = _spectrum(number, scale, size)
        whole = fft.irfft2(spectrum * gains, s=size, overwrite_x=True, workers=workers())
        found[number] = whole[2 * reach : 2 * reach + height, 2 * reach : 2 * reach + width]
    return found


@kept
def _spectrum(number: int, scale: float, size: tuple[int, int]) -> NDArray[np.complex64]:
    from scipy import fft

    # Convolution: the kernels point the same way as the image, as everywhere here (they are symmetric).
    kernel = scaled_kernels(scale)[number].astype(np.float32)
    return np.asarray(fft.rfft2(kernel, s=size), np.complex64)


def _mirrored(plane: NDArray[np.float32], reach: int) -> NDArray[np.float32]:
    """Mirror about the outermost pixels, as often as a kernel wider than the plane needs."""
    import cv2

    padded = cv2.copyMakeBorder(plane, reach, reach, reach, reach, cv2.BORDER_REFLECT_101)
    return np.asarray(padded, np.float32)


def strength(responses: NDArray[np.float32]) -> tuple[NDArray[np.float32], float]:
    """Return absolute responses, and the gray level that shows as white: their common 99.5th percentile."""
    magnitude: NDArray[np.float32] = np.abs(responses)
    return magnitude, max(float(np.percentile(magnitude, 99.5)), 1e-9)


def footprint(kernel: NDArray[np.floating], size: Sequence[int]) -> NDArray[np.float32]:
    """Return a kernel's gain at each frequency, (H, W) float32, zero frequency at (H // 2, W // 2).

    Parameters
    ----------
    kernel
        (n, n), real or complex.
    size
        Height and width of the frequency plane, n or more.
    """
    spectrum = np.abs(np.fft.fft2(kernel, s=(size[0], size[1])))
    return np.roll(spectrum, (size[0] // 2, size[1] // 2), axis=(0, 1)).astype(np.float32)
