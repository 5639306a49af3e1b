"""Spectral peaks: where a texture repeats, and where the MSG code will move that.

Reference: Navarro & Portilla 1996, section 4 (emergent frequencies shift toward the nearest central frequencies).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.transforms.gabor_bank import CENTRES_U, CENTRES_V, WIDTHS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from texlab_core.stats.spectrum import Spectrum

# A peak is at least so many times the mean power around it, and at least this share of the variance.
_CONTRAST = 5.0
_SHARE = 0.003
_APART = 7
_SURROUND = 25
# Below, the MSG code has the low-pass residual.
RESIDUAL_LIMIT = 1 / 64


@dataclass(frozen=True)
class Shift:
    """From one frequency to another.

    Parameters
    ----------
    octaves
        log2 of the ratio of frequencies; above 0 it becomes finer.
    degrees
        Turn of the wave vector, -90 to 90; above 0 from the horizontal toward down the rows.
    """

    octaves: float
    degrees: float


@dataclass(frozen=True)
class Peak:
    """A repetition: one peak of the power spectrum (its mirror image is left out).

    Parameters
    ----------
    u, v
        Frequency in cycles per pixel, horizontal and down the rows; u >= 0.
    share
        Share of the image's variance in the peak and its neighbours, both mirror images.
    contrast
        Ratio to the mean power around.
    """

    u: float
    v: float
    share: float
    contrast: float

    @property
    def frequency(self) -> float:
        """Distance from the origin, in cycles per pixel."""
        return math.hypot(self.u, self.v)

    @property
    def period(self) -> float:
        """Pixels from one stripe to the next."""
        return 1 / self.frequency

    @property
    def orientation(self) -> float:
        """Direction of the wave vector in degrees, 0 to 180; 90 is down the rows (horizontal stripes)."""
        angle = math.degrees(math.atan2(self.v, self.u)) % 180
        # Rounded to what can be measured, 180 is 0.
        return angle if angle < 179.95 else 0.0


def find_peaks(spectrum: Spectrum, count: int = 5) -> tuple[Peak, ...]:
    """Return the strongest peaks, the one with the largest share of the variance first.

    A peak is the highest power within 3 samples, averaged over 3 x 3, and stands out from the 25 x 25 around it.
    """
    from scipy import ndimage

    height, width = spectrum.size
    if min(height, width) < 8 or spectrum.variance <= 0:
        return ()
    full = spectrum.full()
    middle = (height // 2, width // 2)
    near = ndimage.uniform_filter(full, 3, mode="wrap")
    around = ndimage.uniform_filter(full, _SURROUND, mode="wrap")
    contrast = near / np.maximum(around - near * (9 / _SURROUND**2), 1e-12)
    share = 2 * 9 * near / (spectrum.variance * height * width)
    found = (
        (near >= ndimage.maximum_filter(near, _APART, mode="wrap")) & (contrast >= _CONTRAST) & (share >= _SHARE)
    )
    # One of each pair of mirror images; not the few lowest frequencies, which are the slope toward zero.
    rows, columns = np.nonzero(found)
    k_v, k_u = rows - middle[0], columns - middle[1]
    kept = ((k_u > 0) | ((k_u == 0) & (k_v > 0))) & (np.hypot(k_u, k_v) > 2.5)
    order = np.argsort(-share[rows[kept], columns[kept]], kind="stable")
    peaks: list[Peak] = []
    for row, column in zip(rows[kept][order], columns[kept][order], strict=True):
        u, v = _centroid(full, int(row), int(column), middle)
        peak = Peak(u, v, float(share[row, column]), float(contrast[row, column]))
        if not any(math.hypot((peak.u - each.u) * width, (peak.v - each.v) * height) < 2 for each in peaks):
            peaks.append(peak)
        if len(peaks) == count:
            break
    return tuple(peaks)


def _centroid(full: NDArray[np.float32], row: int, column: int, middle: tuple[int, int]) -> tuple[float, float]:
    """Return the centre of the power in 3 x 3 samples: a sinusoid between samples spreads over both."""
    steps = np.arange(-1, 2)
    part = full[np.ix_((row + steps) % full.shape[0], (column + steps) % full.shape[1])].astype(np.float64)
    total = max(float(part.sum()), 1e-300)
    v = (row - middle[0] + float(part.sum(axis=1) @ steps) / total) / full.shape[0]
    u = (column - middle[1] + float(part.sum(axis=0) @ steps) / total) / full.shape[1]
    return (u, v) if u >= 0 else (-u, -v)


@dataclass(frozen=True)
class Snap:
    """Where MSG will move a peak.

    Parameters
    ----------
    channel
        The Gabor channel 4 p + q that answers most to it.
    u, v
        That channel's centre, on the side of the peak.
    shift
        From the peak to the centre.
    """

    channel: int
    u: float
    v: float
    shift: Shift


def predicted_snap(peak: Peak) -> Snap | None:
    """Return the centre that a peak moves to: that of the filter with the largest answer.

    None below 1/64 cycle per pixel: that is the low-pass residual's, which has no centres.
    """
    if peak.frequency < RESIDUAL_LIMIT:
        return None
    best, side, least = 0, 1, math.inf
    for channel in range(len(WIDTHS)):
        for sign in (1, -1):
            distance = math.hypot(peak.u - sign * CENTRES_U[channel], peak.v - sign * CENTRES_V[channel])
            if distance / WIDTHS[channel] < least:
                best, side, least = channel, sign, distance / WIDTHS[channel]
    u, v = side * float(CENTRES_U[best]), side * float(CENTRES_V[best])
    return Snap(best, u, v, shift(peak.u, peak.v, u, v))


def shift(u: float, v: float, to_u: float, to_v: float) -> Shift:
    """Return the shift from one frequency to another; neither may be zero."""
    turn = math.degrees(math.atan2(to_v, to_u) - math.atan2(v, u))
    return Shift(math.log2(math.hypot(to_u, to_v) / math.hypot(u, v)), (turn + 90) % 180 - 90)


def match_peaks(first: Sequence[Peak], second: Sequence[Peak]) -> tuple[tuple[Peak, Peak, Shift], ...]:
    """Pair each peak of an exemplar with the nearest of a result, in octaves and in turns of 45 degrees.

    Returns
    -------
    pairs
        Peak of the exemplar, peak of the result, shift; empty when either has none.
    """
    pairs = []
    for peak in first:
        moved = [(each, shift(peak.u, peak.v, each.u, each.v)) for each in second]
        if moved:
            other, found = min(moved, key=lambda item: math.hypot(item[1].octaves, item[1].degrees / 45))
            pairs.append((peak, other, found))
    return tuple(pairs)
