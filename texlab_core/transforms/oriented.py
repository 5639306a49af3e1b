"""Oriented first and second derivatives of a Gaussian: edge and line filters.

Both families are steerable, so that any number of orientations costs two (first) or three (second derivative)
separable filters and weighted sums of their responses.

Reference: De Bonet 1997, section 4.2 (filter bank); Freeman and Adelson 1991, table III (steering).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.transforms.gaussian import Border

Order = Literal[1, 2]


def default_sigma(size: int) -> float:
    """Return the standard deviation that fits a filter of this many samples: 1 for 5, 2 for 9."""
    return (size - 1) / 4


def kernels(size: int, sigma: float | None = None) -> tuple[NDArray[np.float64], ...]:
    """Return the sampled Gaussian and its first and second derivative, (size,) float64 each.

    The Gaussian sums to 1, the first derivative has unit slope on a ramp, the second has a sum of exactly zero (to
    rounding) in spite of its truncation and the response 2 on a parabola x².
    """
    sigma = default_sigma(size) if sigma is None else sigma
    x = np.arange(size) - (size - 1) / 2
    gaussian = np.exp(-(x**2) / (2 * sigma**2))
    gaussian /= gaussian.sum()
    first = x * gaussian
    first /= (x * first).sum()
    second = (x**2 - (x**2 * gaussian).sum()) * gaussian
    second *= 2 / (x**2 * second).sum()
    return gaussian, first, second


def derivatives(
    image: NDArray[np.float32],
    order: Order,
    orientations: int,
    *,
    size: int = 5,
    sigma: float | None = None,
    border: Border = "reflect",
) -> NDArray[np.float32]:
    """Differentiate a smoothed image along evenly spaced directions.

    Parameters
    ----------
    image
        (H, W) or (H, W, C) float32, neither side smaller than the filter.
    order
        1 finds edges, 2 finds lines.
    orientations
        Number of directions, k · 180° / orientations, counter-clockwise from the horizontal.
    size
        Samples of the filter along each axis, odd.
    sigma
        Standard deviation of the Gaussian in samples; ``(size - 1) / 4`` when left out.
    border
        How the image goes on beyond its border.

    Returns
    -------
    ndarray
        (orientations, H, W) or (orientations, H, W, C) float32.

    Raises
    ------
    ValueError
        When the image is smaller than the filter.
    """
    if min(image.shape[:2]) < size:
        raise ValueError(f"A filter of {size} samples does not fit an image of {image.shape[:2]}.")
    gaussian, first, second = kernels(size, sigma)
    angles = [math.pi * k / orientations for k in range(orientations)]
    out = np.empty((orientations, *image.shape), np.float32)
    # Rows count downwards and angles upwards, hence the sign of every odd derivative along y.
    if order == 1:
        along_x = _separable(image, first, gaussian, border)
        along_y = _separable(image, gaussian, first, border)
        for k, angle in enumerate(angles):
            out[k] = _weight(math.cos(angle)) * along_x - _weight(math.sin(angle)) * along_y
        return out
    xx = _separable(image, second, gaussian, border)
    xy = _separable(image, first, first, border)
    yy = _separable(image, gaussian, second, border)
    for k, angle in enumerate(angles):
        c, s = math.cos(angle), math.sin(angle)
        out[k] = _weight(c * c) * xx - _weight(2 * c * s) * xy + _weight(s * s) * yy
    return out


def _weight(value: float) -> np.float32:
    return np.float32(0 if abs(value) < 1e-12 else value)


def _separable(
    image: NDArray[np.float32], along_x: NDArray[np.float64], along_y: NDArray[np.float64], border: Border
) -> NDArray[np.float32]:
    import cv2

    if border == "reflect":
        found = cv2.sepFilter2D(image, cv2.CV_32F, along_x, along_y, borderType=cv2.BORDER_REFLECT_101)
        return np.asarray(found, np.float32).reshape(image.shape)
    reach = along_x.size // 2
    framed = cv2.copyMakeBorder(image, reach, reach, reach, reach, cv2.BORDER_WRAP)
    found = np.asarray(cv2.sepFilter2D(framed, cv2.CV_32F, along_x, along_y), np.float32)
    return found.reshape(framed.shape[:2] + image.shape[2:])[reach:-reach, reach:-reach]
