"""Random phase noise: the exemplar's own magnitude spectrum with a random phase, at any size.

Reference: Navarro & Portilla 1996, section 4 (uncoded); Galerne, Gousseau & Morel 2011, Random phase textures.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.spectral.fourier import (
    BLOCK,
    Floats,
    Half,
    Plane,
    forward,
    inverse,
    mean_square,
    self_conjugate_columns,
)
from texlab_core.transforms.fourier import smooth_spectrum
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core.engine.progress import Progress
    from texlab_core.engine.steps import FloatImage, Step

# Share of each side over which a spot that is laid into a larger image fades out.
_FADE = 0.1


@dataclass(frozen=True, eq=False)
class Spot:
    """An exemplar without its mean, whose spectrum is taken at any size.

    Parameters
    ----------
    planes
        (C, H, W) float32.
    mean
        (C,) float64.
    """

    planes: Plane
    mean: Floats


def make_spot(pixels: FloatImage, periodic: bool, progress: Progress, stage: str) -> Generator[Step, None, Spot]:
    """Return the exemplar as a spot; ``periodic`` keeps only its periodic component.

    Reference: Moisan 2011, Periodic plus smooth image decomposition, eqs. 10 and 11.
    """
    height, width, channels = pixels.shape
    planes, mean = np.empty((channels, height, width), np.float32), np.zeros(channels)
    for channel, plane in enumerate(planes):
        name = f"{stage} {channel + 1}"
        for rows in row_blocks((height, width), BLOCK):
            plane[rows] = pixels[rows, :, channel]
            mean[channel] += plane[rows].sum(dtype=np.float64) / plane.size
            yield progress.at(name, 0.0)
        plane -= np.float32(mean[channel])
        yield progress.at(name, 0.0)
        if periodic:
            half = yield from forward(plane, progress, name)
            yield from subtract_smooth(half, plane, progress, name)
            planes[channel] = yield from inverse(half, plane.shape, progress.ended(), name)
        yield progress.at(name)
    return Spot(planes, mean)


def subtract_smooth(half: Half, plane: Plane, progress: Progress, stage: str) -> Generator[Step, None, None]:
    """Subtract from the spectrum of a plane that of its smooth component, in place."""
    for rows, smooth in smooth_spectrum(plane):
        half[rows] -= smooth.astype(half.dtype)
        yield progress.at(stage)


def spectra(
    spot: Spot, size: tuple[int, int], progress: Progress, stage: str
) -> Generator[Step, None, list[Half]]:
    """Return the spectrum of each channel on the grid of an output of any size, with the spot's variance.

    A spectrum is sampled more finely by laying the spot into a larger image, less finely by folding it.
    """
    found = []
    for channel, plane in enumerate(spot.planes):
        laid = plane if plane.shape == size else _laid(plane, size)
        half = yield from forward(laid, progress, f"{stage} {channel + 1}")
        found.append(half)
    if spot.planes.shape[1:] != size:
        # All channels alike, so that colours stay.
        power, last = 0.0, f"{stage} {len(found)}"
        for half in found:
            power += mean_square(half, size[1])
            yield progress.at(last)
        squares = np.empty(spot.planes.shape)
        for plane, square in zip(spot.planes, squares, strict=True):
            np.square(plane, out=square, dtype=np.float64)
            yield progress.at(last)
        wanted = float(squares.sum() / spot.planes[0].size)
        for half in found:
            half *= np.float32(np.sqrt(wanted / power)) if power > 0 else np.float32(1)
            yield progress.at(last)
    return found


def _laid(plane: Plane, size: tuple[int, int]) -> Plane:
    faded = plane
    for axis, (have, want) in enumerate(zip(plane.shape, size, strict=True)):
        if want > have:
            faded = faded * np.expand_dims(_fade(have), 1 - axis)
    laid = np.zeros(size, np.float32)
    height, width = size
    for top in range(0, plane.shape[0], height):
        for left in range(0, plane.shape[1], width):
            part = faded[top : top + height, left : left + width]
            laid[: part.shape[0], : part.shape[1]] += part
    return laid


def _fade(count: int) -> Plane:
    reach = max(1, round(_FADE * count))
    edge = np.sin(0.5 * np.pi * (np.arange(reach) + 0.5) / reach) ** 2
    window = np.ones(count, np.float32)
    window[:reach] = edge[: window[:reach].size]
    window[count - reach :] *= edge[::-1]
    return window


def give_phase(halves: list[Half], phase: Half, progress: Progress, stage: str) -> Generator[Step, None, None]:
    """Turn the spectra of all channels alike, in place, so that the phase of their sum is the given one.

    Reference: Galerne, Gousseau & Morel 2011, section 2.3: the channels keep their phase differences.
    """
    for rows in row_blocks((phase.shape[0], phase.shape[1]), 2**18):
        total = sum((half[rows] for half in halves[1:]), halves[0][rows])
        length = np.abs(total)
        turn = phase[rows] * np.where(length > 0, np.conj(total) / np.where(length > 0, length, 1), 1)
        for half in halves:
            half[rows] *= turn
        yield progress.at(stage)


def parameter_count(size: tuple[int, int], channels: int) -> int:
    """Return how many numbers the magnitude spectra, the channels' phase differences and the histograms are."""
    height, width = size
    alone = len(self_conjugate_columns(width)) * (2 if height % 2 == 0 else 1)
    independent = (height * width + alone) // 2
    return independent * (2 * channels - 1) + 256 * channels
