"""Colours as points: principal axes, and moving one cloud of colours onto another.

Reference: Heeger and Bergen 1995, section 2.5; Pitié, Kokaram and Dahyot 2007 (transport along rotated axes).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.work.tasks import finish, row_blocks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.work.tasks import Task

SMALLEST_SPREAD = 1e-3
CONSTANT_SPREAD = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class ColourAxes:
    """The principal axes of an image's colours, the most spread first.

    Parameters
    ----------
    mean
        (C,) float64.
    directions
        (A, C) float64, orthonormal rows; A <= C, since axes along which the colours hardly differ are dropped.
    spread
        (A,) float64, standard deviation along each axis.
    """

    mean: NDArray[np.float64]
    directions: NDArray[np.float64]
    spread: NDArray[np.float64]

    def to_axes(self, pixels: NDArray[Any]) -> NDArray[np.float32]:
        """Return planes (A, H, W) float32 of mean 0 and covariance 1: M (x - mean) with M = S^-1 U^t."""
        return finish(self.to_axes_task(pixels))

    def to_axes_task(self, pixels: NDArray[Any]) -> Task[NDArray[np.float32]]:
        """Do :meth:`to_axes` in pieces."""
        matrix = self.directions / self.spread[:, None]
        offset = -np.sum(matrix * self.mean, axis=1)
        return combine(np.moveaxis(pixels, -1, 0), matrix, offset)

    def from_axes(self, planes: Sequence[NDArray[np.float32]]) -> Task[FloatImage]:
        """Return the colours (H, W, C) float32 of A planes (H, W): M^-1 y + mean."""
        channels = yield from combine(planes, (self.directions * self.spread[:, None]).T, self.mean)
        return (yield from interleave(channels))


def principal_axes(pixels: NDArray[Any]) -> ColourAxes:
    """Return the principal axes of an image's colours.

    Axes with a standard deviation below 1e-3 are dropped; the first one is kept unless the image is constant.

    Parameters
    ----------
    pixels
        (H, W, C) in [0, 1]; mean and covariance are computed in float64.
    """
    return finish(principal_axes_task(pixels))


def principal_axes_task(pixels: NDArray[Any]) -> Task[ColourAxes]:
    """Do :func:`principal_axes` in pieces."""
    flat = pixels.reshape(-1, pixels.shape[-1])
    many, channels = flat.shape
    total = np.zeros(channels)
    for rows in row_blocks(flat.shape):
        # Row after row, whatever the blocks.
        total = np.add.reduce(np.vstack([total, flat[rows]]), axis=0)
        yield flat[rows].size
    mean = total / many
    centred = np.empty((channels, many))
    for rows in row_blocks(flat.shape):
        centred[:, rows] = (flat[rows] - mean).T
        yield flat[rows].size
    covariance = np.empty((channels, channels))
    for one, other in combinations_with_replacement(range(channels), 2):
        covariance[one, other] = covariance[other, one] = np.mean(centred[one] * centred[other])
        yield many
    return axes_of_covariance(mean, covariance, channels)


def axes_of_covariance(mean: NDArray[np.float64], covariance: NDArray[np.float64], count: int) -> ColourAxes:
    """Return the principal axes of colours of this mean, (C,), and covariance, (C, C): at most ``count``.

    Axes with a standard deviation below 1e-3 are dropped; the first one is kept unless the colours are constant.
    """
    values, vectors = np.linalg.eigh(covariance)
    spread = np.sqrt(np.maximum(values[::-1], 0))
    directions = vectors.T[::-1]
    # An axis points to where its largest component is positive: the sign is not left to the library.
    largest = np.argmax(np.abs(directions), axis=1)
    directions = directions * np.sign(directions[np.arange(len(directions)), largest])[:, None]
    keep = (spread >= SMALLEST_SPREAD) & (np.arange(len(spread)) < count)
    keep[0] = count > 0 and spread[0] >= CONSTANT_SPREAD
    return ColourAxes(mean, np.ascontiguousarray(directions[keep]), spread[keep])


def combine(
    planes: Sequence[NDArray[Any]] | NDArray[Any],
    matrix: NDArray[np.float64],
    offset: NDArray[np.float64] | None = None,
) -> Task[NDArray[np.float32]]:
    """Return ``matrix @ planes + offset``, (n, H, W) float32, in an order that no library's threads can change."""
    result = np.empty((len(matrix), *planes[0].shape), np.float32)
    for block in row_blocks(planes[0].shape, 2**17):
        for number, row in enumerate(matrix.astype(np.float32)):
            total = result[number, block]
            total[...] = 0 if offset is None else offset[number]
            for plane, factor in zip(planes, row, strict=True):
                total += plane[block] * factor
        yield result[:, block].size
    return result


def interleave(channels: NDArray[np.float32]) -> Task[FloatImage]:
    """Return channels (C, H, W) as an image (H, W, C)."""
    image = np.empty((*channels.shape[1:], len(channels)), np.float32)
    for block in row_blocks(image.shape):
        image[block] = np.moveaxis(channels[:, block], 0, -1)
        yield image[block].size // 4
    return image
