"""The multiscale Gabor filter bank: 4 octaves x 4 orientations, as Gaussians in the Fourier plane.

Reference: Navarro & Portilla 1996, section 2.1, eqs. 1 and 2.
"""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from texlab_core.work.kept import kept

Floats: TypeAlias = NDArray[np.float64]

OCTAVES = 4
ORIENTATIONS = 4
CHANNELS = OCTAVES * ORIENTATIONS

# Eq. 2: k, so that a filter falls to half its peak at a third of its centre frequency.
WIDTH_RATIO = math.sqrt(math.pi / math.log(2)) / 3


def _frozen(values: NDArray[np.floating]) -> Floats:
    frozen = np.array(values, np.float64)
    frozen.flags.writeable = False
    return frozen


# Cycles per pixel and degrees; a wave vector at 90 degrees points down the rows (horizontal stripes).
CENTRE_FREQUENCIES = _frozen(2.0 ** np.arange(-5, -1))
CENTRE_ORIENTATIONS = _frozen(np.arange(4) * 45.0)

# Channel n = 4 p + q, p = 0 the lowest octave, as in the paper's tables.
WIDTHS = _frozen(np.repeat(WIDTH_RATIO * CENTRE_FREQUENCIES, ORIENTATIONS))
_ANGLES = np.deg2rad(np.tile(CENTRE_ORIENTATIONS, OCTAVES))
_RADII = np.repeat(CENTRE_FREQUENCIES, ORIENTATIONS)
# Rounded so that the axes are hit exactly.
CENTRES_U = _frozen(np.round(_RADII * np.cos(_ANGLES), 15) + 0.0)
CENTRES_V = _frozen(np.round(_RADII * np.sin(_ANGLES), 15) + 0.0)

# Bandwidth of a channel whose input is white: the marginal of |G|^2.
WHITE_BANDWIDTHS = _frozen(WIDTHS / math.sqrt(2))


def frequencies(count: int) -> Floats:
    """Return the frequencies of an axis of ``count`` samples, in cycles per pixel, in FFT order."""
    return np.asarray(np.fft.fftfreq(count), np.float64)


def power_profile(axis: Floats, centre: Floats, width: Floats) -> Floats:
    """Return one-dimensional factors of |G|^2, exp(-2 pi d^2 / width^2), d the distance on the circle.

    Parameters
    ----------
    axis
        (n,) frequencies in cycles per pixel.
    centre, width
        (k,) centre frequencies and widths.

    Returns
    -------
    profile
        (k, n) float64.
    """
    distance = axis[None, :] - centre[:, None]
    # The spectrum of an image is periodic: a filter near 1/2 goes on at -1/2.
    distance -= np.round(distance)
    profile: Floats = np.exp((-2 * np.pi) * (distance / width[:, None]) ** 2)
    return profile


# The 16 filters and their mirror images are products of only 20 profiles: 5 places on an axis for each octave.
_PLACES = np.array([-1, -math.sqrt(0.5), 0, math.sqrt(0.5), 1])
PROFILE_CENTRES = _frozen(np.outer(CENTRE_FREQUENCIES, _PLACES).reshape(-1))
PROFILE_WIDTHS = _frozen(np.repeat(WIDTH_RATIO * CENTRE_FREQUENCIES, len(_PLACES)))
_OCTAVE = np.repeat(np.arange(OCTAVES), ORIENTATIONS) * len(_PLACES)
PROFILE_U = _OCTAVE + np.tile([4, 3, 2, 1], OCTAVES)
PROFILE_V = _OCTAVE + np.tile([2, 3, 4, 3], OCTAVES)
MIRRORED_U = _OCTAVE + np.tile([0, 1, 2, 3], OCTAVES)
MIRRORED_V = _OCTAVE + np.tile([2, 1, 0, 1], OCTAVES)
# Beyond so many widths from its centre a squared filter is below 1e-15.
_REACH = 2.35


@kept
def distinct_profiles(count: int) -> tuple[Floats, NDArray[np.int64]]:
    """Return the (20, count) distinct profiles on an axis in FFT order, and from which index their octave ends.

    Both are read-only. From ``end`` to ``count - end`` all profiles of the same octave are negligible.
    """
    profiles = power_profile(frequencies(count), PROFILE_CENTRES, PROFILE_WIDTHS)
    highest = np.repeat(CENTRE_FREQUENCIES, len(_PLACES))
    ends = np.ceil((highest + _REACH * PROFILE_WIDTHS) * count).astype(np.int64) + 1
    return profiles, ends


@kept
def channel_profiles(count: int, vertical: bool) -> Floats:
    """Return the (16, count) factors of the squared filters along one axis, in FFT order, read-only."""
    centres = CENTRES_V if vertical else CENTRES_U
    return power_profile(frequencies(count), centres, WIDTHS)


def mirrored(profile: Floats) -> Floats:
    """Return profiles over FFT-ordered axes at the negative frequencies."""
    return np.roll(profile[..., ::-1], 1, axis=-1)


def channel_name(channel: int) -> str:
    """Return a name for people ("1/16, 45°")."""
    octave, orientation = divmod(channel, ORIENTATIONS)
    return f"1/{2 ** (5 - octave)}, {45 * orientation}°"


def residual_reach(count: int) -> int:
    """Return the largest index k with k < count / 64: the low-pass residual's extent on an axis."""
    return max(0, math.ceil(count / 64) - 1)
