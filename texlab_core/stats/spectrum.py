"""Power spectra: pictures, profiles, autocorrelation, and two distances between the spectra of two images.

Frequencies are in cycles per pixel: u horizontal, v down the rows. Orientations are those of the wave vector in
degrees from 0 to 180; stripes run at right angles to it, so that 90 degrees are horizontal stripes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import scipy  # scipy.fft is loaded on its first use
from numpy.typing import NDArray

from texlab_core.transforms import fourier
from texlab_core.transforms.luma import luma
from texlab_core.work.kept import kept
from texlab_core.work.tasks import finish, go_on, row_blocks
from texlab_core.work.threads import workers

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.engine.steps import FloatImage

Plane: TypeAlias = NDArray[np.float32]
Floats: TypeAlias = NDArray[np.float64]

# Power of rounding to 256 levels: what lies below cannot be told from it.
QUANTIZATION = (1 / 255) ** 2 / 12
# Cells per axis in which spectra are averaged before they are compared.
_CELLS = 64


@dataclass(frozen=True, eq=False)
class Profile:
    """Mean power along one coordinate of the Fourier plane.

    Parameters
    ----------
    x
        (n,) float64: frequencies, or orientations in degrees.
    power
        (n,) float64: mean power; white noise of variance s^2 has s^2.
    """

    x: Floats
    power: Floats


@dataclass(frozen=True, eq=False)
class Spectrum:
    """The power spectrum of an image.

    Parameters
    ----------
    power
        (H, W // 2 + 1) float32 half plane of |T|^2 / pixels, 0 at zero frequency; white noise of variance s^2 has
        s^2 everywhere.
    width
        Width of the image.
    """

    power: Plane
    width: int

    @property
    def size(self) -> tuple[int, int]:
        """Height and width of the image."""
        return self.power.shape[0], self.width

    @cached_property
    def variance(self) -> float:
        """Variance of the image (Parseval)."""
        height, width = self.size
        return float(np.sum(self.power @ _column_weights(width), dtype=np.float64)) / (height * width)

    def full(self) -> Plane:
        """Return the whole plane, (H, W), zero frequency at (H // 2, W // 2)."""
        height, width = self.size
        whole = np.empty(self.size, np.float32)
        columns = self.power.shape[1]
        whole[:, :columns] = self.power
        if width > columns:
            # Negative frequencies mirror the positive ones through the origin.
            mirror = self.power[:, (width - 1) // 2 : 0 : -1]
            whole[0, columns:] = mirror[0]
            whole[1:, columns:] = mirror[:0:-1]
        return np.roll(whole, (height // 2, width // 2), axis=(0, 1))

    def log_picture(self) -> Plane:
        """Return the plane in dB above the rounding to 256 levels, at least 0, zero frequency in the centre."""
        decibels: Plane = 10 * np.log10(np.maximum(self.full() / np.float32(QUANTIZATION), np.float32(1)))
        return decibels

    def radial(self, bins: int = 64) -> Profile:
        """Return the mean power by frequency, 0 to 1/2, over all orientations."""
        u, v = self._axes()
        radius = np.hypot(v[:, None], u)
        return self._profile(radius, 0.5 / bins, bins)

    def angular(self, bins: int = 60, lowest: float = 1 / 64, highest: float = 0.5) -> Profile:
        """Return the mean power by orientation of the wave vector, within a band of frequencies."""
        u, v = self._axes()
        radius = np.hypot(v[:, None], u)
        angle = np.degrees(np.arctan2(v[:, None], u)) % 180
        # Centred bins: the first one holds 0 and 180 degrees.
        step = 180 / bins
        place = np.floor(angle / step + 0.5) % bins * step + step / 2
        place[(radius < lowest) | (radius > highest)] = np.inf
        profile = self._profile(place, step, bins)
        return Profile(profile.x - step / 2, profile.power)

    def autocorrelation(self) -> Plane:
        """Return the periodic autocorrelation, (H, W), 1 at (H // 2, W // 2), which is no shift; 0 if constant."""
        lags: Plane = scipy.fft.irfft2(self.power, s=self.size, workers=workers())
        if lags[0, 0] > 0:
            lags /= lags[0, 0]
        return np.roll(lags, (self.size[0] // 2, self.size[1] // 2), axis=(0, 1))

    def _axes(self) -> tuple[Floats, Floats]:
        return np.arange(self.power.shape[1]) / self.width, np.asarray(np.fft.fftfreq(self.size[0]), np.float64)

    def _profile(self, place: Floats, step: float, bins: int) -> Profile:
        weights = np.broadcast_to(_column_weights(self.width).astype(np.float64), place.shape).copy()
        weights[0, 0] = 0
        index = np.minimum(place / step, bins).astype(np.int64).reshape(-1)
        count = np.bincount(index, weights.reshape(-1), bins + 1)[:bins]
        total = np.bincount(index, (weights * self.power).reshape(-1), bins + 1)[:bins]
        power = np.divide(total, count, out=np.zeros(bins), where=count > 0)
        return Profile((np.arange(bins, dtype=np.float64) + 0.5) * step, np.asarray(power, np.float64))


def power_spectrum(image: FloatImage, look: Callable[[], None] = go_on) -> Spectrum:
    """Return the power spectrum of the luminance of an image.

    Parameters
    ----------
    image
        (H, W, C) float32 in [0, 1]; its mean is removed first.
    look
        Called between the parts; may raise to stop.
    """
    look()
    plane = luma(image)
    look()
    transform = finish(fourier.rfft2(plane - np.float32(plane.mean(dtype=np.float64))), look)
    power = np.empty(transform.shape, np.float32)
    for rows in row_blocks(power.shape):
        look()
        # The transform is scaled by 1 / pixels.
        power[rows] = np.square(transform[rows].real) + np.square(transform[rows].imag)
        power[rows] *= np.float32(plane.size)
    power[0, 0] = 0
    return Spectrum(power, plane.shape[1])


def log_spectral_distance(first: Spectrum, second: Spectrum) -> float:
    """Return the root mean square difference of two spectra in dB.

    Both are averaged over cells of 1/64 cycle per pixel, so that images of different sizes can be compared and the
    speckle of a single image does not count; below the rounding to 256 levels all powers are alike.
    """
    one, other, weights = _common_cells(first, second)
    difference = 10 * np.log10((one + QUANTIZATION) / (other + QUANTIZATION))
    return math.sqrt(float(np.sum(weights * difference**2) / max(weights.sum(), 1e-12)))


def spectral_difference(first: Spectrum, second: Spectrum) -> Plane:
    """Return by how many dB the second spectrum lies above the first, cell by cell.

    Returns
    -------
    difference
        (v, u) float32 with at most 64 cells on each axis, zero frequency at (v // 2, u // 2). Its root mean square
        is the :func:`log_spectral_distance`.
    """
    one, other, weights = _common_cells(first, second)
    decibels = np.where(weights > 0, 10 * np.log10((other + QUANTIZATION) / (one + QUANTIZATION)), 0.0)
    cells_u = min(_CELLS, first.width, second.width)
    return Spectrum(decibels.astype(np.float32), cells_u).full()


def total_variation(first: Spectrum, second: Spectrum) -> float:
    """Return which share of the power, 0 to 1, would have to move to make two spectra alike, by cells."""
    one, other, weights = _common_cells(first, second)
    totals = [float(np.sum(weights * each)) for each in (one, other)]
    if min(totals) <= 0:
        return 0.0 if max(totals) <= 0 else 1.0
    return 0.5 * float(np.sum(weights * np.abs(one / totals[0] - other / totals[1])))


def _common_cells(first: Spectrum, second: Spectrum) -> tuple[Floats, Floats, Floats]:
    """Return both spectra averaged over the same cells of the half plane, and the cells' weights."""
    cells_v, cells_u = (min(_CELLS, a, b) for a, b in zip(first.size, second.size, strict=True))
    found = [_cells(each, cells_v, cells_u) for each in (first, second)]
    weights = np.broadcast_to(_column_weights(cells_u).astype(np.float64), found[0][0].shape).copy()
    for _, filled in found:
        weights *= filled
    return found[0][0], found[1][0], weights


def _cells(spectrum: Spectrum, cells_v: int, cells_u: int) -> tuple[Floats, NDArray[np.bool_]]:
    """Return triangular averages of the power, and which cells hold any frequency but zero."""
    height, width = spectrum.size
    over_v = _triangles(height, cells_v)
    over_u = _triangles(width, cells_u)[: cells_u // 2 + 1, : width // 2 + 1]
    # Zero frequency holds no power and does not count.
    count = np.outer(over_v.sum(axis=1), over_u.sum(axis=1)) - np.outer(over_v[:, 0], over_u[:, 0])
    filled = count > 1e-9
    total = over_v @ (spectrum.power @ over_u.T.astype(np.float32)).astype(np.float64)
    return np.divide(total, count, out=np.zeros_like(total), where=filled), filled


@kept
def _triangles(count: int, cells: int) -> Floats:
    """Return (cells, count) weights of FFT frequencies in cells centred at k / cells, overlapping by half."""
    distance = np.fft.fftfreq(count)[None, :] - np.arange(cells)[:, None] / cells
    distance -= np.round(distance)
    weights: Floats = np.maximum(1 - np.abs(distance) * cells, 0)
    return weights


def _column_weights(width: int) -> NDArray[np.float32]:
    """Return how often each column of a half plane counts in the whole plane."""
    weights = np.full(width // 2 + 1, 2, np.float32)
    weights[0] = 1
    if width % 2 == 0:
        weights[-1] = 1
    return weights
