"""Local spatial frequency: which wavelength and orientation prevail around each pixel.

Ten wavelengths from 4 to 48 pixels by twelve orientations of Gabor pairs; their energies are smoothed, and the
peak over the wavelengths is found between the samples by a parabola.

Reference: Forsyth and Ponce, section 11.2.2, Fig. 11.11.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.errors import InputError
from texlab_core.transforms import fourier
from texlab_core.work.tasks import finish, go_on

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Plane = NDArray[np.float32]

WAVELENGTHS: tuple[float, ...] = tuple(4 * 12 ** (k / 9) for k in range(10))
ORIENTATIONS = 12
SMALLEST_SIDE = 16
# Of the Gaussians as a share of the wavelength, and of the smoothing of energies in pixels.
SIGMA, SMOOTHING = 0.5, 4.0


@dataclass(frozen=True, eq=False, slots=True)
class LocalFrequency:
    """What prevails around each pixel.

    Parameters
    ----------
    energies
        (10, H, W) float32: largest energy over the orientations, by wavelength.
    wavelength
        (H, W) float32 pixels, 4 to 48.
    orientation
        (H, W) float32 degrees of the wave vector, 0 to 180.
    coherence
        (H, W) float32, 0 (all orientations alike: the orientation means nothing) to 1.
    """

    energies: NDArray[np.float32]
    wavelength: Plane
    orientation: Plane
    coherence: Plane


def local_frequency(plane: Plane, look: Callable[[], None] = go_on) -> LocalFrequency:
    """Analyze a plane.

    Parameters
    ----------
    plane
        (H, W) float32, at least 16 pixels a side; mirrored at its borders.
    look
        Called between the pieces of the work; may raise to stop.

    Raises
    ------
    InputError
        When it is too small.
    """
    import cv2
    from scipy import fft

    height, width = plane.shape
    if min(height, width) < SMALLEST_SIDE:
        raise InputError(
            f"Local frequency needs at least {SMALLEST_SIDE} x {SMALLEST_SIDE} pixels, got {width} x {height}."
        )
    margin = min(math.ceil(3 * SIGMA * WAVELENGTHS[-1]), 4 * min(height, width))
    centred = plane - np.float32(plane.mean(dtype=np.float64))
    padded = cv2.copyMakeBorder(centred, margin, margin, margin, margin, cv2.BORDER_REFLECT_101)
    size = (fft.next_fast_len(padded.shape[0]), fft.next_fast_len(padded.shape[1]))
    extended = np.zeros(size, np.float32)
    extended[: padded.shape[0], : padded.shape[1]] = padded
    spectrum = finish(fourier.fft2(extended), look)
    v, u = (np.fft.fftfreq(count).astype(np.float32) for count in size)
    energies = np.empty((len(WAVELENGTHS), height, width), np.float32)
    best = np.zeros((height, width), np.float32)
    vector, total = np.zeros((height, width), np.complex64), np.zeros((height, width), np.float32)
    for index, wavelength in enumerate(WAVELENGTHS):
        strongest = np.zeros((height, width), np.float32)
        turned, summed = np.zeros_like(vector), np.zeros_like(total)
        for k in range(ORIENTATIONS):
            angle = math.pi * k / ORIENTATIONS
            gains = _gain(u, math.cos(angle), v, math.sin(angle), wavelength)
            values = finish(fourier.ifft2(spectrum * gains), look)
            inside = values[margin : margin + height, margin : margin + width]
            energy = np.square(inside.real) + np.square(inside.imag)
            energy = cv2.GaussianBlur(energy, (0, 0), SMOOTHING, borderType=cv2.BORDER_REFLECT_101)
            np.maximum(strongest, energy, out=strongest)
            turned += energy * np.complex64(np.exp(2j * angle))
            summed += energy
        energies[index] = strongest
        better = strongest > best
        best[better] = strongest[better]
        vector[better], total[better] = turned[better], summed[better]
    coherence = np.divide(np.abs(vector), total, out=np.zeros_like(total), where=total > 0)
    # The filters' own width leaves this much when there is one wave alone.
    coherence = np.minimum(coherence / _single_wave(), 1).astype(np.float32)
    orientation = (np.degrees(np.angle(vector)) / 2 % 180).astype(np.float32)
    return LocalFrequency(energies, _peak(energies), orientation, coherence)


def _gain(u: Plane, across: float, v: Plane, down: float, wavelength: float) -> NDArray[Any]:
    """Return twice the Gaussian lobe of a pair, less what it would give a constant."""
    sharpness = 2 * (math.pi * SIGMA * wavelength) ** 2

    def profile(axis: Plane, centre: float) -> Plane:
        distance = axis - np.float32(centre)
        distance -= np.round(distance)
        values: Plane = np.exp(-np.float32(sharpness) * distance**2)
        return values

    lobe = np.outer(profile(v, down / wavelength), profile(u, across / wavelength))
    at_zero = math.exp(-sharpness / wavelength**2)
    lobe -= np.float32(at_zero) * np.outer(profile(v, 0.0), profile(u, 0.0))
    gains: NDArray[Any] = 2 * lobe
    return gains


def _single_wave() -> float:
    """Return the coherence that a single wave has with filters of this width, between 0 and 1."""
    angles = np.pi * np.arange(ORIENTATIONS) / ORIENTATIONS
    # Squared distance of each filter's centre from the wave, in wave numbers, and from its mirror image.
    sharpness = 2 * (math.pi * SIGMA) ** 2
    energy = np.zeros(ORIENTATIONS)
    for turn in (0.0, math.pi):
        energy += np.exp(-sharpness * (2 - 2 * np.cos(angles - turn))) ** 2
    return float(np.abs((energy * np.exp(2j * angles)).sum()) / energy.sum())


def _peak(energies: NDArray[np.float32]) -> Plane:
    """Return the wavelength of greatest energy, by a parabola through the logarithms of three energies."""
    logs = np.log(np.maximum(energies, 1e-12))
    top = np.clip(energies.argmax(axis=0), 1, len(WAVELENGTHS) - 2)[None]
    before, here, after = (np.take_along_axis(logs, top + step, axis=0)[0] for step in (-1, 0, 1))
    bend = before - 2 * here + after
    shift = np.divide(before - after, 2 * bend, out=np.zeros_like(bend), where=bend < -1e-9)
    step = math.log(WAVELENGTHS[1] / WAVELENGTHS[0])
    found: Plane = (4 * np.exp((top[0] + np.clip(shift, -1, 1)) * step)).astype(np.float32)
    return np.clip(found, WAVELENGTHS[0], WAVELENGTHS[-1])
