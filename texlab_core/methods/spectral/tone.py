"""How a plane of Gaussian noise becomes a picture: its histogram, and colours that follow its gray level.

The paper is gray. For colour, the first principal component of the colours is coded as if it were a gray image;
the other two follow it through their mean at each sixteenth of its histogram. That goes beyond the paper.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from texlab_core.methods.spectral.digits import keep_digits
from texlab_core.methods.spectral.fourier import BLOCK, Floats, Plane
from texlab_core.methods.spectral.marginal import (
    SAMPLES,
    Histogram16,
    encode_histogram,
    histogram256,
    quantiles,
    rank_index,
)
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core.engine.progress import Progress
    from texlab_core.engine.steps import FloatImage, Step

Vector: TypeAlias = tuple[float, float, float]

# Colours closer to gray than this (rms, gray levels) are coded as gray.
_GRAY = 0.25
# Steps of gray in which colours are gathered.
_STEPS = 2**12


@dataclass(frozen=True)
class Colours:
    """Colours as a function of the gray level: 12 + 32 numbers.

    Parameters
    ----------
    mean
        Mean colour, RGB in gray levels.
    axes
        Orthonormal principal axes of the colours, the most important first.
    curves
        Mean of the second and of the third component in each sixteenth of the histogram, in gray levels.
    """

    mean: Vector
    axes: tuple[Vector, Vector, Vector]
    curves: tuple[tuple[float, ...], tuple[float, ...]]

    def at(self, gray: Floats, ranks: Floats) -> Floats:
        """Return the (n, 3) RGB colours, in gray levels, of gray levels with their ranks in the histogram."""
        axes = np.array(self.axes)
        middles = (np.arange(SAMPLES) + 0.5) / SAMPLES
        scores = np.stack(
            [
                (gray - gray_weights(axes[0])[1]) * np.abs(axes[0]).sum() - axes[0] @ np.array(self.mean),
                np.interp(ranks, middles, self.curves[0]),
                np.interp(ranks, middles, self.curves[1]),
            ],
            axis=-1,
        )
        colours: Floats = np.array(self.mean) + scores @ axes
        return colours


@dataclass(frozen=True)
class Tone:
    """What the last step of every spectral synthesis gives a plane.

    Parameters
    ----------
    histogram
        The coded histogram of the gray plane.
    colours
        None for gray.
    """

    histogram: Histogram16
    colours: Colours | None = None

    @property
    def channels(self) -> int:
        """Channels of the pictures it makes: 1 or 3."""
        return 1 if self.colours is None else 3

    @property
    def parameters(self) -> int:
        """How many numbers it consists of: 16, or 60 with colours."""
        return SAMPLES + (0 if self.colours is None else 12 + 2 * SAMPLES)

    def apply(
        self, plane: Plane, progress: Progress, stage: str, masses: Floats | None = None
    ) -> Generator[Step, None, FloatImage]:
        """Match a plane to the histogram and give it its colours, with one lookup table.

        Parameters
        ----------
        plane
            (H, W) float32; only the order of its values counts, unless they are all equal, then the value itself.
        masses
            (256,) an uncoded histogram to match instead of the coded one.

        Returns
        -------
        image
            (H, W, C) float32 in [0, 1].
        """
        masses = self.histogram.masses() if masses is None else masses
        low, high = float(plane.min()), float(plane.max())
        ranked = yield from rank_index(plane, low, high, progress, stage)
        gray = quantiles(masses, ranked.ranks) if high > low else np.full_like(ranked.ranks, np.clip(low, 0, 255))
        table = gray[:, None] if self.colours is None else self.colours.at(gray, ranked.ranks)
        table = np.clip(table / 255, 0, 1).astype(np.float32)
        image = np.empty((*plane.shape, table.shape[1]), np.float32)
        for rows in row_blocks((plane.shape[0], plane.shape[1] * 4), BLOCK):
            np.take(table, ranked.index[rows], axis=0, out=image[rows], mode="clip")
            yield progress.at(stage, 0.5 + 0.5 * rows.stop / plane.shape[0])
        return image


def gray_weights(axis: Floats) -> tuple[Floats, float]:
    """Return weights and offset that make an axis of colours a gray picture within 0 .. 255.

    Negative components count from white, so that the weights' moduli sum to 1: gray = weights @ rgb + offset.
    """
    total = np.abs(axis).sum()
    return axis / total, float(255 * -np.minimum(axis, 0).sum() / total)


def split_tone(
    pixels: FloatImage, progress: Progress, stage: str
) -> Generator[Step, None, tuple[Plane, Tone, Floats]]:
    """Split an exemplar into what its spectrum and what its tone describes.

    Parameters
    ----------
    pixels
        (H, W, C) float32 in [0, 1]; C is 1 or 3.

    Returns
    -------
    plane
        (H, W) float32 in [0, 255]: the image itself, or its first principal component as a weighted mean.
    tone
        With colours, unless every pixel is gray.
    masses
        (256,) the uncoded histogram of the plane.
    """
    moments = None
    if pixels.shape[2] == 3:
        moments = yield from _moments(pixels, progress, stage)
    if moments is None:
        plane = pixels[:, :, 0] * np.float32(255)
        colours = None
        yield progress.at(stage, 0.5)
    else:
        mean, axes = moments
        plane = yield from _gray_plane(pixels, axes, progress, stage)
        curves = yield from _curves(pixels, plane, mean, axes, progress, stage)
        red, green, blue = (_vector(axis) for axis in axes)
        colours = Colours(mean=_vector(mean), axes=(red, green, blue), curves=curves)
    masses = yield from histogram256(plane, progress, stage)
    return plane, Tone(encode_histogram(masses), colours), masses


def _moments(
    pixels: FloatImage, progress: Progress, stage: str
) -> Generator[Step, None, tuple[Floats, Floats] | None]:
    """Return the mean colour in gray levels and the principal axes as rows, or None when all pixels are gray."""
    total, products, chroma = np.zeros(3), np.zeros((3, 3)), 0.0
    for rows in _pixel_blocks(pixels):
        flat = pixels[rows].reshape(-1, 3).astype(np.float64) - 0.5
        total += flat.sum(axis=0)
        products += [[np.sum(one * other) for other in flat.T] for one in flat.T]
        chroma += float(np.square(flat[:, :2] - flat[:, 1:]).sum())
        yield progress.at(stage, 0.25 * rows.stop / pixels.shape[0])
    count = pixels.shape[0] * pixels.shape[1]
    if 255 * np.sqrt(chroma / count) < _GRAY:
        return None
    mean = total / count
    axes = np.linalg.eigh(products / count - np.outer(mean, mean))[1].T[::-1]
    # The sign is free: brighter is positive.
    axes = axes * np.where(axes.sum(axis=1, keepdims=True) < 0, -1, 1)
    return 255 * (mean + 0.5), np.ascontiguousarray(axes)


def _gray_plane(pixels: FloatImage, axes: Floats, progress: Progress, stage: str) -> Generator[Step, None, Plane]:
    weights, offset = gray_weights(axes[0])
    scaled = (255 * weights).astype(np.float32)
    plane = np.empty(pixels.shape[:2], np.float32)
    for rows in _pixel_blocks(pixels):
        # Written out: three products in a fixed order give the same bits in any block.
        part = pixels[rows, :, 0] * scaled[0]
        part += pixels[rows, :, 1] * scaled[1]
        part += pixels[rows, :, 2] * scaled[2]
        np.clip(part + np.float32(offset), 0, 255, out=plane[rows])
        yield progress.at(stage, 0.25 + 0.25 * rows.stop / pixels.shape[0])
    return plane


def _curves(
    pixels: FloatImage, plane: Plane, mean: Floats, axes: Floats, progress: Progress, stage: str
) -> Generator[Step, None, tuple[tuple[float, ...], tuple[float, ...]]]:
    """Return the mean second and third component in each sixteenth of the gray plane's histogram."""
    counts, sums = np.zeros(_STEPS), np.zeros((3, _STEPS))
    for rows in _pixel_blocks(pixels):
        step = (plane[rows] * np.float32((_STEPS - 1) / 255)).astype(np.int64).reshape(-1)
        counts += np.bincount(step, minlength=_STEPS)
        for channel in range(3):
            sums[channel] += np.bincount(step, pixels[rows, :, channel].reshape(-1), minlength=_STEPS)
        yield progress.at(stage, 0.5 + 0.25 * rows.stop / pixels.shape[0])
    # Equal gray levels share their mean colour, however many sixteenths they cover.
    ranks = np.concatenate([[0.0], np.cumsum(counts)]) / plane.size
    edges = np.linspace(0, 1, SAMPLES + 1)
    cumulative = np.concatenate([np.zeros((3, 1)), np.cumsum(sums, axis=1)], axis=1) * (255 / plane.size)
    colours = np.stack([np.diff(np.interp(edges, ranks, each)) for each in cumulative]) * SAMPLES
    second, third = axes[1:] @ (colours - mean[:, None])
    return keep_digits(second), keep_digits(third)


def _pixel_blocks(pixels: FloatImage) -> list[slice]:
    return row_blocks((pixels.shape[0], pixels.shape[1]), 2**17)


def _vector(values: Floats) -> Vector:
    red, green, blue = keep_digits(values)
    return red, green, blue
