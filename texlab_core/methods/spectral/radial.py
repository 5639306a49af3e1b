"""Bandwidths of the Gabor channels along and across the direction of their waves, instead of along u and v.

The paper's footnote: "another possibility is to use radial and angular bandwidths, which would probably be more
adequate for most unstructured textures". For waves at 0° and 90° these are the bandwidths along u and v, or v and
u; for the diagonal ones the marginals are taken over rotated axes, and the synthetic channels are Gaussians whose
axes are rotated with them. Such a Gaussian is no product of two profiles, so that the sums over the Fourier plane
are taken sample by sample.

Reference: Navarro & Portilla 1996, section 3.1.2, footnote.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.spectral.bandwidths import equivalent_bandwidths
from texlab_core.transforms.gabor_bank import (
    CENTRE_ORIENTATIONS,
    CENTRES_U,
    CENTRES_V,
    CHANNELS,
    ORIENTATIONS,
    WHITE_BANDWIDTHS,
    channel_profiles,
    frequencies,
    mirrored,
    residual_reach,
)
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.methods.spectral.choices import BandwidthMeasure
    from texlab_core.methods.spectral.fourier import Floats, Half

    Size = tuple[int, int]

DIAGONALS = np.flatnonzero(np.arange(CHANNELS) % 2)
_ANGLES = np.deg2rad(np.tile(CENTRE_ORIENTATIONS, CHANNELS // ORIENTATIONS))
_COSINES, _SINES = np.cos(_ANGLES), np.sin(_ANGLES)
# Samples of one channel in a piece of a few milliseconds.
_PIECE = 2**16
# A grid of this side is enough for sums over channels that are at least four of its samples wide.
_ENOUGH, _SAMPLES_WIDE = 512, 4
_NEGLIGIBLE = 1e-12


def radial_bandwidths(
    half: Half, width: int, along: tuple[Floats, Floats], measure: BandwidthMeasure
) -> Generator[float, None, tuple[Floats, Floats]]:
    """Measure the bandwidths of all channels, yielding fractions.

    Parameters
    ----------
    half
        (H, W // 2 + 1) half plane of the picture without its mean.
    width
        W.
    along
        (16,) bandwidths along u and along v, which are the radial and angular ones of waves at 0 and 90 degrees.
    measure
        As for bandwidths along u and v.

    Returns
    -------
    radial, angular
        (16,) float64, in cycles per pixel.
    """
    along_u, along_v = along
    upright = np.arange(CHANNELS) % ORIENTATIONS == 0
    radial, angular = np.where(upright, along_u, along_v), np.where(upright, along_v, along_u)
    height, columns = half.shape
    # The lobes at positive u: what they have beyond u = 0 is below 1e-4 of their peak.
    v, u = frequencies(height), np.arange(columns) / width
    gain_v, gain_u = channel_profiles(height, vertical=True), channel_profiles(width, vertical=False)[:, :columns]
    rising = CENTRES_U[DIAGONALS] < 0
    gain_v = np.where(rising[:, None], mirrored(gain_v[DIAGONALS]), gain_v[DIAGONALS])
    gain_u = np.where(
        rising[:, None],
        mirrored(channel_profiles(width, vertical=False)[DIAGONALS])[:, :columns],
        gain_u[DIAGONALS],
    )
    # Diagonals of a square grid are 1 / (n sqrt 2) apart.
    step = 1 / (math.sqrt(2) * min(height, width))
    bins = 2 * math.ceil(1 / (math.sqrt(2) * step)) + 2
    sums = np.zeros((2, DIAGONALS.size, bins))
    for rows in row_blocks(half.shape, _PIECE):
        power = np.square(half[rows].real, dtype=np.float64) + np.square(half[rows].imag, dtype=np.float64)
        for sign in (1, -1):
            # Along the wave vector (1, 1) or (1, -1), and across it.
            places = [((u + way * v[rows, None]) / (math.sqrt(2) * step) + bins // 2) for way in (sign, -sign)]
            for index in np.flatnonzero(rising == (sign < 0)):
                weighted = power * gain_v[index, rows, None] * gain_u[index]
                for axis, place in enumerate(places):
                    sums[axis, index] += _shared(place, weighted, bins)
        yield rows.stop / height
    for bandwidths, each in zip((radial, angular), sums, strict=True):
        bandwidths[DIAGONALS] = _of_diagonals(each, measure, step)
    return radial, angular


def _of_diagonals(sums: Floats, measure: BandwidthMeasure, step: float) -> Floats:
    """Return the equivalent bandwidths of marginals over diagonals, (8, n), ``step`` apart."""
    # Of a texture that tiles by half its diagonal every other line is empty: neighbours are taken together.
    pairs = sums[:, :-1] + sums[:, 1:]
    white = WHITE_BANDWIDTHS[DIAGONALS]
    wide = equivalent_bandwidths(pairs, measure, step, white)
    # That adds step² / 4 to the variance of a Gaussian, whose bandwidth is sqrt(2 pi) deviations.
    narrow = np.sqrt(np.maximum(wide**2 - np.pi / 2 * step**2, (step / 2) ** 2))
    found: Floats = np.where(pairs.sum(axis=1) > 0, narrow, white)
    return found


def _shared(place: Floats, weights: Floats, bins: int) -> Floats:
    """Return a histogram in which every weight is shared between the two nearest bins."""
    lower = np.floor(place + 1e-9)
    part: Floats = np.maximum(place - lower, 0)
    index: NDArray[np.intp] = lower.astype(np.intp).reshape(-1)
    low = np.bincount(index, (weights * (1 - part)).reshape(-1), bins)
    high = np.bincount(index + 1, (weights * part).reshape(-1), bins)
    return np.asarray(low[:bins] + high[:bins], np.float64)


class RadialLobes:
    """The squared Gaussians of the synthetic channels, their axes along and across their waves.

    Parameters
    ----------
    radial, angular
        (16,) in cycles per pixel.
    size
        Height and width of the output.
    """

    def __init__(self, radial: Floats, angular: Floats, size: Size) -> None:
        self.size = size
        self.radial, self.angular = radial, angular
        self._energies: Floats = np.zeros(CHANNELS)
        self._overlap: Floats = np.zeros((CHANNELS, CHANNELS))

    def energies(self) -> Floats:
        """Return the mean squares of the channels for unit amplitude; both lobes count."""
        return self._energies

    def overlap(self) -> Floats:
        """Return the energy (16, 16) each filter passes of each channel of unit amplitude, less the residual."""
        return self._overlap

    def power(self, channel: int, v: Floats, u: Floats) -> Floats:
        """Return one lobe's power at frequencies v (rows) and u (columns), 1 at its centre."""
        down, across = v - CENTRES_V[channel], u - CENTRES_U[channel]
        # The spectrum of an image is periodic: a filter near 1/2 goes on at -1/2.
        down, across = (down - np.round(down))[:, None], across - np.round(across)
        c, s = _COSINES[channel], _SINES[channel]
        along = (across * c + down * s) / self.radial[channel]
        aside = (down * c - across * s) / self.angular[channel]
        found: Floats = np.exp(-2 * np.pi * (along**2 + aside**2))
        return found

    def measured(self) -> Generator[float, None, None]:
        """Sum energies and overlaps over the output's grid, or over a smaller one where that is fine enough.

        To be run before :meth:`energies` and :meth:`overlap`; yields fractions.
        """
        from texlab_core.kernels.gabor import overlaps

        fine = min(float(self.radial.min()), float(self.angular.min())) * _ENOUGH >= _SAMPLES_WIDE
        height, width = (min(side, _ENOUGH) if fine else side for side in self.size)
        v, u = frequencies(height), frequencies(width)
        gain_v, gain_u = channel_profiles(height, vertical=True), channel_profiles(width, vertical=False)
        pairs = ((gain_v, gain_u), (mirrored(gain_v), mirrored(gain_u)))
        low_v, low_u = _low(height), _low(width)
        sums, total = np.zeros(CHANNELS), np.zeros((CHANNELS, CHANNELS))
        blocks = row_blocks((height, width), _PIECE)
        for number, rows in enumerate(blocks):
            for channel in range(CHANNELS):
                lobe = self.power(channel, v[rows], u)
                if lobe.max() < _NEGLIGIBLE:
                    continue
                sums[channel] += lobe.sum()
                # The low-pass residual is written over the channels.
                lobe[np.ix_(low_v[rows], low_u)] = 0
                for over_v, over_u in pairs:
                    passed = overlaps(np.ascontiguousarray(over_u), lobe)
                    total[:, channel] += (passed * over_v[:, rows]).sum(axis=1)
                yield (number + channel / CHANNELS) / len(blocks)
        pixels = self.size[0] * self.size[1]
        self._energies = 2 * sums / (height * width) / pixels
        self._overlap = 2 * total / (height * width) / pixels

    def shaped(self, half: Half, gains: Floats) -> Generator[float, None, None]:
        """Multiply a half plane by the root of the channels' summed power, in place; yields fractions."""
        height, width = self.size
        v, u = frequencies(height), np.arange(half.shape[1]) / width
        blocks = row_blocks(half.shape, _PIECE // 2)
        for number, rows in enumerate(blocks):
            power = np.zeros(half[rows].shape)
            for channel in range(CHANNELS):
                power += gains[channel] * self.power(channel, v[rows], u)
                power += gains[channel] * self.power(channel, -v[rows], -u)
                yield (number + channel / CHANNELS) / len(blocks)
            half[rows] *= np.sqrt(power).astype(np.float32)

    def filtered(self, half: Half, channel: int, gain: float) -> Generator[float, None, None]:
        """Multiply a half plane by one channel's amplitude, both lobes, in place; yields fractions."""
        height, width = self.size
        v, u = frequencies(height), np.arange(half.shape[1]) / width
        for rows in row_blocks(half.shape, _PIECE):
            both = np.sqrt(self.power(channel, v[rows], u)) + np.sqrt(self.power(channel, -v[rows], -u))
            half[rows] *= (math.sqrt(gain) * both).astype(np.float32)
            yield rows.stop / height


def _low(count: int) -> NDArray[np.bool_]:
    """Return where an axis in FFT order belongs to the low-pass residual."""
    return np.asarray(np.abs(frequencies(count) * count) <= residual_reach(count) + 1e-9)
