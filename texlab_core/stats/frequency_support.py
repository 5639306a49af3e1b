"""Which part of the frequency plane each band of a pyramid keeps: an annulus, or a wedge of it.

The gain of a band is what a wave of the image is multiplied by on its way into the band. Where a level is sampled
more coarsely than the image, waves beyond its Nyquist frequency appear there as others; the gain counts the wave
for what it is in the image.

Reference: Forsyth and Ponce, section 11.2.2, Figs. 11.8, 11.12 and 11.13.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.stats.bands import band_keys, most_levels, names
from texlab_core.stats.filter_bands import FILTER_SIDE, GABOR_OCTAVES
from texlab_core.transforms import filters, gabor, oriented, spots_bars
from texlab_core.transforms.gaussian import BINOMIAL
from texlab_core.work.tasks import finish, go_on

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.stats.pyramid_kinds import PyramidKind
    from texlab_core.transforms.steerable import BandKey

    Plane = NDArray[np.float32]
    Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class Support:
    """The support of one band.

    Parameters
    ----------
    key
        Its place in the pyramid.
    title, label
        Names, long and short.
    gain
        (H, W) float32 from 0, zero frequency at (H // 2, W // 2); derivatives and Gabor channels may exceed 1.
    """

    key: BandKey
    title: str
    label: str
    gain: Plane

    @property
    def relative(self) -> Plane:
        """The gain as a share of its largest value."""
        return self.gain / max(float(self.gain.max()), 1e-12)

    def outline(self, share: float = 0.5) -> NDArray[np.bool_]:
        """Return where the gain is at least a share of its largest value, (H, W) bool."""
        return self.relative >= share


def supports(
    kind: PyramidKind,
    size: tuple[int, int],
    levels: int = 4,
    orientations: int = 4,
    look: Callable[[], None] = go_on,
) -> tuple[Support, ...]:
    """Return the support of every band, from fine to coarse.

    Parameters
    ----------
    kind
        Any of the pyramids.
    size
        Height and width of the image, which are those of the frequency plane.
    levels, orientations
        As for :func:`texlab_core.stats.bands.split`; fewer levels where the image is too small.
    look
        Called between the bands; may raise to stop.
    """
    levels = min(levels, most_levels(size, kind))
    found = []
    for key in band_keys(kind, levels, orientations):
        look()
        gain = _gain(kind, key, size, levels, orientations)
        rolled = np.roll(gain, (size[0] // 2, size[1] // 2), axis=(0, 1)).astype(np.float32)
        found.append(Support(key, *names(key, kind, orientations), rolled))
    return tuple(found)


def _gain(kind: PyramidKind, key: BandKey, size: tuple[int, int], levels: int, orientations: int) -> NDArray[Any]:
    """Return the gain over the whole plane in FFT order."""
    if kind == "steerable":
        return _steerable(key, size, levels, orientations)
    if kind in ("gabor", "gabor magnitude"):
        return _gabor(key, size)
    v, u = (np.asarray(np.fft.fftfreq(count), np.float64) for count in size)
    smoothed = np.outer(_reductions(v, key.level), _reductions(u, key.level))
    if key.kind == "lowpass":
        return smoothed
    fine = 1 << key.level
    if kind == "laplacian":
        # Reduced and expanded: the filter once more on the way down and once on the way up.
        passed = np.outer(_binomial(v * fine), _binomial(u * fine)) ** 2
        gain: Floats = smoothed * (1 - passed)
        return gain
    kernel = (
        _derivative(key.orientation, orientations) if kind == "oriented" else spots_bars.kernels()[key.orientation]
    )
    return smoothed * np.abs(_transfer(kernel, v * fine, u * fine))


def _binomial(frequency: Floats) -> Floats:
    angle = 2 * np.pi * frequency
    response: Floats = BINOMIAL[2] + 2 * BINOMIAL[1] * np.cos(angle) + 2 * BINOMIAL[0] * np.cos(2 * angle)
    return response


def _reductions(frequency: Floats, level: int) -> Floats:
    gain = np.ones_like(frequency)
    for each in range(level):
        gain *= _binomial(frequency * (1 << each))
    return gain


def _transfer(kernel: NDArray[Any], v: Floats, u: Floats) -> NDArray[np.complex128]:
    """Return a kernel's response at any frequencies, in cycles per sample of its own level."""
    reach = np.arange(kernel.shape[0]) - kernel.shape[0] // 2
    down, across = (np.exp(-2j * np.pi * np.outer(axis, reach)) for axis in (v, u))
    response: NDArray[np.complex128] = down @ kernel @ across.T
    return response


def _derivative(number: int, orientations: int) -> Floats:
    """Return the kernel of a derivative as the bands number them: angles towards the rows."""
    gaussian, first, second = oriented.kernels(FILTER_SIDE)
    order, index = divmod(number, orientations)
    c, s = np.cos(np.pi * index / orientations), np.sin(np.pi * index / orientations)
    if order == 0:
        return np.asarray(c * np.outer(gaussian, first) + s * np.outer(first, gaussian), np.float64)
    mixed = 2 * c * s * np.outer(first, first)
    return np.asarray(c * c * np.outer(gaussian, second) + mixed + s * s * np.outer(second, gaussian), np.float64)


def _steerable(key: BandKey, size: tuple[int, int], levels: int, orientations: int) -> NDArray[Any]:
    kept = np.dtype(np.float64)
    if key.kind == "highpass":
        half = finish(filters.highpass(size, kept))
    elif key.kind == "lowpass":
        half = finish(filters.lowpass(size, levels, kept))
    else:
        half = finish(filters.oriented(size, key.level, orientations, kept))[key.orientation]
    crop = filters.level_size(size, key.level)
    whole = np.zeros(size)
    # Rows of either sign keep their place; a column and its mirror image have the same absolute gain.
    rows = np.fft.ifftshift(np.arange(-(crop[0] // 2), crop[0] - crop[0] // 2))
    columns = np.arange(crop[1] // 2 + 1)
    half = np.abs(half)
    whole[rows[:, None], columns] = half
    whole[-rows[:, None], -columns] = half
    return whole


def _gabor(key: BandKey, size: tuple[int, int]) -> NDArray[Any]:
    if key.kind == "lowpass":
        return gabor.residual_gain(size)
    channel = 4 * (GABOR_OCTAVES - 1 - key.level) + key.orientation
    return gabor.channel_gain(channel, size)
