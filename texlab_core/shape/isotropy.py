"""The orientation of a plane whose texture is isotropic: by search over hypotheses, and by spectral moments.

A plane seen through A (see :mod:`texlab_core.shape.orientation`) has its wave w at the image frequency A⁻¹ w. One
power spectrum of the picture is enough: a hypothesis moves its power to A f, and nothing is filtered again.

*Search.* Energies of oriented filters cos⁶(θ - φ) over all φ have a standard deviation that depends on three
angular harmonics h of the power alone, since cos⁶ x = (10 + 15 cos 2x + 6 cos 4x + cos 6x) / 32. It is summed over
octave bands of the hypothesis's own scales and divided by the summed mean energies.

*Moments.* The second moments of an isotropic spectrum are a multiple of 1; those of the picture are c A⁻².

Reference: Forsyth and Ponce, section 11.4.1, isotropy assumptions; Witkin 1981; Gårding 1992.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.errors import InputError
from texlab_core.shape.orientation import MOST_SLANT, Orientation, of_tensor
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Plane = NDArray[np.float32]
    Floats = NDArray[np.float64]

# A frontal texture that reads as more slanted than this is not isotropic enough for either estimator.
DOUBTFUL = 35.0
SMALLEST_SIDE = 32
# Orientations, and parts of an octave, in which the spectrum is kept.
_ANGLES, _PER_OCTAVE = 120, 6
# Beyond it little is left of what a pixel averages over.
_HIGHEST = 0.45
_OCTAVES = 9
_AT_ONCE = 256


@dataclass(frozen=True, eq=False)
class IsotropySpectrum:
    """The power spectrum of one picture, ready for any number of hypotheses.

    Parameters
    ----------
    moments
        (2, 2) float64: sums of power times f fᵀ.
    polar
        (120, 54) float64: power by orientation and by log2 of the frequency.
    """

    moments: Floats
    polar: Floats

    @cached_property
    def _angles(self) -> Floats:
        return np.asarray((np.arange(_ANGLES) + 0.5) * (np.pi / _ANGLES), np.float64)

    @cached_property
    def _banded(self) -> Floats:
        """Power in an octave band, cos² in the logarithm, centred at each part of an octave and beyond."""
        centres = (np.arange(_OCTAVES * _PER_OCTAVE) + 0.5) / _PER_OCTAVE
        bands = np.arange(-3 * _PER_OCTAVE, (_OCTAVES + 4) * _PER_OCTAVE) / _PER_OCTAVE
        gains = np.cos(np.clip((centres[:, None] - bands) * np.pi / 2, -np.pi / 2, np.pi / 2)) ** 2
        banded: Floats = self.polar @ gains
        return banded

    def cost(self, slant: Floats, tilt: Floats) -> Floats:
        """Return how far from isotropic each hypothesis leaves the texture, 0 (isotropic) to about 1.5.

        Parameters
        ----------
        slant, tilt
            (n,) degrees.

        Returns
        -------
        ndarray
            (n,) float64.
        """
        squeeze, turn = np.cos(np.radians(slant))[:, None], np.radians(tilt)[:, None]
        angle = self._angles - turn
        along, across = squeeze * np.cos(angle), np.sin(angle)
        turned = np.exp(2j * (np.arctan2(across, along) + turn))
        # Where on the axis of log2 frequencies this hypothesis moves the power of each orientation.
        moved = np.log2(np.hypot(along, across)) * _PER_OCTAVE
        rows = np.arange(_ANGLES)
        spread, mean = np.zeros(squeeze.size), np.zeros(squeeze.size)
        for octave in range(_OCTAVES):
            place = (octave + 3) * _PER_OCTAVE - moved
            lower = np.clip(place.astype(np.intp), 0, self._banded.shape[1] - 2)
            part = np.clip(place - lower, 0, 1)
            energy = self._banded[rows, lower] * (1 - part) + self._banded[rows, lower + 1] * part
            second = np.abs((energy * turned).sum(axis=1))
            fourth = np.abs((energy * turned**2).sum(axis=1))
            sixth = np.abs((energy * turned**3).sum(axis=1))
            spread += np.sqrt((15 * second) ** 2 / 2 + (6 * fourth) ** 2 / 2 + sixth**2 / 2)
            mean += 10 * energy.sum(axis=1)
        cost: Floats = np.divide(spread, mean, out=np.zeros_like(spread), where=mean > 0)
        return cost

    def by_moments(self) -> Orientation:
        """Return the orientation by second moments: closed form, live."""
        # Large where the texture is shortened: the inverse of a tensor of widths.
        swapped = np.array([[self.moments[1, 1], -self.moments[0, 1]], [-self.moments[0, 1], self.moments[0, 0]]])
        slant, tilt = of_tensor(swapped)
        return Orientation(min(slant, 89.9), tilt)

    def by_search(self, look: Callable[[], None] = go_on) -> Orientation:
        """Return the orientation of least cost: the best of a grid, refined by a simplex (Nelder and Mead).

        ``look`` is called between pieces and may raise to stop.
        """
        from scipy.optimize import minimize

        grid = landscape(self, 21, look)
        row, column = np.unravel_index(np.nanargmin(grid.cost), grid.cost.shape)
        start = np.array([grid.axis[column], grid.axis[row]])

        def cost(place: Floats) -> float:
            look()
            radius = math.hypot(*place)
            tilt = math.degrees(math.atan2(place[1], place[0])) / 2
            beyond = max(0.0, radius - MOST_SLANT)
            return float(self.cost(np.array([min(radius, MOST_SLANT)]), np.array([tilt]))[0]) + beyond

        simplex = start + np.array([[0, 0], [4, 0], [0, 4]])
        found = minimize(
            cost, start, method="Nelder-Mead", options={"initial_simplex": simplex, "xatol": 0.05, "fatol": 1e-6}
        )
        return Orientation.from_disc(float(found.x[0]), float(found.x[1]))


@dataclass(frozen=True, eq=False)
class Landscape:
    """The cost of all hypotheses, over the disc slant · (cos 2 tilt, sin 2 tilt).

    Parameters
    ----------
    cost
        (n, n) float64, NaN outside the disc; rows are the second coordinate.
    axis
        (n,) degrees, from -80 to 80.
    """

    cost: Floats
    axis: Floats


def isotropy_spectrum(image: Plane) -> IsotropySpectrum:
    """Measure a picture once for all hypotheses.

    Parameters
    ----------
    image
        (H, W) float32, at least 32 pixels a side.

    Raises
    ------
    InputError
        When it is smaller, or of one gray level.
    """
    from scipy import fft

    height, width = image.shape
    if min(height, width) < SMALLEST_SIDE:
        raise InputError(
            f"Shape from texture needs at least {SMALLEST_SIDE} x {SMALLEST_SIDE} pixels, got {width} x {height}."
        )
    window = np.outer(_hann(height), _hann(width))
    centred = image - (image * window).sum() / window.sum()
    if not np.abs(centred).max() > 1e-6:
        raise InputError("Shape from texture needs a picture with more than one gray level.")
    transform = fft.rfft2((centred * window).astype(np.float32))
    v, u = np.fft.fftfreq(height)[:, None], np.fft.rfftfreq(width)[None, :]
    radius = np.hypot(u, v)
    # The mean over a pixel belongs to the camera, not to the texture.
    power = (np.square(transform.real) + np.square(transform.imag)).astype(np.float64)
    power /= np.square(np.sinc(u) * np.sinc(v))
    # The other half of the plane is the mirror image of the columns between the first and the last.
    power[:, 1 : (width + 1) // 2] *= 2
    # A window of n pixels smears the mean over the first two frequencies.
    used = (radius < _HIGHEST) & (radius > 2.5 / min(height, width))
    power = np.where(used, power, 0)
    xy = float((power * (u * v)).sum())
    moments = np.array([[(power * u**2).sum(), xy], [xy, (power * v**2).sum()]])
    kept = power > 0
    return IsotropySpectrum(moments, _polar(power[kept], np.arctan2(v + 0 * u, u + 0 * v)[kept], radius[kept]))


def _hann(count: int) -> Floats:
    return np.asarray(np.hanning(count + 2)[1:-1], np.float64)


def _polar(power: Floats, angle: Floats, radius: Floats) -> Floats:
    """Share power among the nearest orientations; parts of an octave are filled as they come."""
    columns = _OCTAVES * _PER_OCTAVE
    place = angle / np.pi * _ANGLES - 0.5
    lower = np.floor(place).astype(np.intp)
    part = place - lower
    column = np.clip((np.log2(radius) + _OCTAVES) * _PER_OCTAVE, 0, columns - 1).astype(np.intp)
    polar = np.zeros(_ANGLES * columns)
    for row, share in ((lower % _ANGLES, 1 - part), ((lower + 1) % _ANGLES, part)):
        polar += np.bincount(row * columns + column, power * share, polar.size)
    return polar.reshape(_ANGLES, columns)


def landscape(spectrum: IsotropySpectrum, points: int = 61, look: Callable[[], None] = go_on) -> Landscape:
    """Return the cost over the disc of hypotheses, up to a slant of 80 degrees.

    Parameters
    ----------
    spectrum
        From :func:`isotropy_spectrum`.
    points
        Samples along each axis, an odd number.
    look
        Called between pieces; may raise to stop.
    """
    axis = np.linspace(-MOST_SLANT, MOST_SLANT, points)
    y, x = np.meshgrid(axis, axis, indexing="ij")
    slant, tilt = np.hypot(x, y), np.degrees(np.arctan2(y, x)) / 2
    inside = slant <= MOST_SLANT + 1e-9
    found = []
    for first in range(0, int(inside.sum()), _AT_ONCE):
        look()
        block = slice(first, first + _AT_ONCE)
        found.append(spectrum.cost(slant[inside][block], tilt[inside][block]))
    cost = np.full(slant.shape, np.nan)
    cost[inside] = np.concatenate(found)
    return Landscape(cost, axis)
