"""Complex band-pass planes: an octave around a frequency, by orientation, with no more samples than they need."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from texlab_core.transforms import fourier
from texlab_core.work.kept import kept
from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

ORIENTATIONS = 4
FINEST = 0.25
# Filters of larger images are not kept.
_KEPT_PIXELS = 2**19
Complex: TypeAlias = NDArray[np.complex64]


def oriented_bands(
    plane: NDArray[np.float32],
    octaves: int,
    look: Callable[[], None],
    wanted: Callable[[tuple[int, int]], bool] = lambda _: True,
) -> Iterator[tuple[int, int, Complex]]:
    """Split the periodic part of a plane (H, W) into analytic bands.

    Octave k is centred at 2^-k / 4 cycles per pixel, a half-wave of a cosine in log frequency that ends one octave
    to each side: energies of neighbouring octaves add up. Orientation o is cos^3 around 45 o degrees, over half of
    the Fourier plane. Only those are computed whose (octave, orientation) is ``wanted``.

    Yields
    ------
    octave, orientation, band
        (h, w) complex64 with H / 2^k samples or so over the same scene; the magnitude is the envelope of a
        sinusoid of the octave's centre and the orientation.
    """
    height, width = plane.shape
    spectrum = finish(fourier.periodic_spectrum(plane), look)
    for octave in range(octaves):
        size = band_size((height, width), octave)
        rows, columns = (_kept(side, count) for side, count in zip(plane.shape, size, strict=True))
        part = spectrum if size == plane.shape else spectrum[np.ix_(rows, columns)]
        filters = _kept_filters if height * width <= _KEPT_PIXELS else _filters
        for orientation, weights in enumerate(filters((height, width), octave)):
            if not wanted((octave, orientation)):
                continue
            look()
            band = finish(fourier.ifft2(part * weights), look)
            yield octave, orientation, band


def band_size(size: tuple[int, int], octave: int) -> tuple[int, int]:
    """Return the samples of a band that hold all its frequencies."""
    if octave == 0:
        return size
    height, width = (min(side, max(2, 2 * math.ceil(side / 2 ** (octave + 1)))) for side in size)
    return height, width


def _kept(side: int, count: int) -> NDArray[np.int64]:
    """Return where the ``count`` lowest frequencies of ``side`` lie, in FFT order."""
    frequencies = np.arange(count)
    frequencies[(count + 1) // 2 :] -= count
    return np.asarray(frequencies % side, np.int64)


def _filters(size: tuple[int, int], octave: int) -> Iterator[NDArray[np.float32]]:
    small = band_size(size, octave)
    v, u = (np.fft.fftfreq(count, 1 / count) / side for side, count in zip(size, small, strict=True))
    radius = np.hypot(v[:, None], u)
    radius[0, 0] = 1
    octaves = np.clip(np.log2(radius * (2**octave / FINEST)), -1, 1)
    radial = np.cos(np.pi / 2 * octaves)
    radial[0, 0] = 0
    # Twice: one half of the plane carries what both did. Fewer samples: the inverse transform divides by fewer.
    radial *= 2 * math.prod(small) / math.prod(size)
    for orientation in range(ORIENTATIONS):
        angle = math.pi * orientation / ORIENTATIONS
        cosine = (v[:, None] * math.sin(angle) + u * math.cos(angle)) / radius
        yield (radial * np.maximum(cosine, 0) ** 3).astype(np.float32)


@kept
def _kept_filters(size: tuple[int, int], octave: int) -> tuple[NDArray[np.float32], ...]:
    return tuple(_filters(size, octave))
