"""What an exemplar asks for that no method keeps: symmetry, symbols, structure as large as itself."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.measures.registry import Measure, register
from texlab_core.transforms import fourier
from texlab_core.transforms.luma import luma
from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.measures.subject import Subject

SMALLEST = 16
# Wavelengths of at least this share of a side: fewer than four periods can be seen.
LARGE = 0.25
# What repeats itself this well is whole in every period.
PERIODIC = 0.99
_FLAT = 0.5 / 255
_BINS = 256


@dataclass(frozen=True)
class Agreement:
    """How well an image agrees with itself: correlations of its luminance at the best cyclic shift.

    Parameters
    ----------
    period
        With itself, shifted by an eighth of the shorter side and more; 0 .. 1.
    turned
        With itself, mirrored left and right, top and bottom, and turned by half; the axis may be anywhere.
    """

    period: float
    turned: dict[str, float]

    @property
    def symmetries(self) -> dict[str, float]:
        """What a turn gives beyond the image's own periods: (r - p) / (1 - p), 0 .. 1; 0 where p is above 0.99."""
        if self.period > PERIODIC:
            return dict.fromkeys(self.turned, 0.0)
        beyond = {name: (each - self.period) / (1 - self.period) for name, each in self.turned.items()}
        return {name: min(max(each, 0.0), 1.0) for name, each in beyond.items()}


def agreement(image: FloatImage, look: Callable[[], None]) -> Agreement | None:
    """Return how well an image (H, W, C) agrees with itself; None for a flat one."""
    gray = luma(image)
    plane = gray - np.float32(gray.mean(dtype=np.float64))
    variance = float(np.mean(np.square(plane), dtype=np.float64))
    if variance <= _FLAT**2:
        return None
    spectrum = finish(fourier.rfft2(plane), look)

    def correlations(other: NDArray[np.complex64]) -> NDArray[np.float32]:
        look()
        found: NDArray[np.float32] = finish(fourier.irfft2(spectrum * np.conjugate(other), plane.shape), look)
        return np.asarray(found / np.float32(variance), np.float32)

    own = correlations(spectrum)
    rows, columns = (np.minimum(np.arange(side), side - np.arange(side)) for side in plane.shape)
    far = np.hypot(rows[:, None], columns[None, :]) >= min(plane.shape) / 8
    turned = {}
    for name, axes in (("left and right", (1,)), ("top and bottom", (0,)), ("a half turn", (0, 1))):
        look()
        other = finish(fourier.rfft2(np.ascontiguousarray(np.flip(plane, axes))), look)
        turned[name] = float(correlations(other).max())
    return Agreement(min(max(float(own[far].max()), 0.0), 1.0), turned)


def own_agreement(subject: Subject) -> Agreement | None:
    """Return the exemplar's :func:`agreement`; None where it is flat or under 16 pixels."""
    if min(subject.pixels.shape[:2]) < SMALLEST:
        return None
    return subject.prepared("agreement", agreement)


def own_symmetry(subject: Subject) -> float | None:
    """Return the largest of the exemplar's symmetries."""
    found = own_agreement(subject)
    return None if found is None else max(found.symmetries.values())


def own_period(subject: Subject) -> float | None:
    """Return how well the exemplar agrees with itself at its best period."""
    found = own_agreement(subject)
    return None if found is None else found.period


def two_tones(image: FloatImage, look: Callable[[], None]) -> tuple[float, float] | None:
    """Split the luminance into two tones (Otsu's threshold).

    Returns
    -------
    tuple or None
        Share of the variance that lies between the tones, and the share of pixels of the rarer tone; None for a
        flat image.
    """
    gray = luma(image)
    counts = np.bincount(np.rint(gray.clip(0, 1) * (_BINS - 1)).astype(np.int64).reshape(-1), minlength=_BINS)
    look()
    share = counts / counts.sum()
    levels = np.arange(_BINS) / (_BINS - 1)
    mean = float(share @ levels)
    variance = float(share @ np.square(levels - mean))
    if variance < _FLAT**2:
        return None
    below = np.cumsum(share)[:-1]
    sums = np.cumsum(share * levels)[:-1]
    inside = (below > 0) & (below < 1)
    between = np.zeros(_BINS - 1)
    between[inside] = np.square(mean * below[inside] - sums[inside]) / (below[inside] * (1 - below[inside]))
    cut = int(between.argmax())
    return float(between[cut]) / variance, float(min(below[cut], 1 - below[cut]))


def own_symbols(subject: Subject) -> float | None:
    """Return how much the exemplar looks like print: two tones, the rarer one as marks; 0 .. 1."""
    if min(subject.pixels.shape[:2]) < SMALLEST:
        return None

    def prepare(pixels: FloatImage, look: Callable[[], None]) -> float | None:
        tones = two_tones(pixels, look)
        if tones is None:
            return None
        split, rare = tones
        # Print covers a few to thirty percent of its ground.
        return split if 0.02 <= rare <= 0.35 else 0.0

    return subject.prepared("two tones", prepare)


def large_share(image: FloatImage, look: Callable[[], None]) -> float | None:
    """Return the share of the luminance's variance at wavelengths of a quarter of a side and longer.

    Of the periodic part, without the mean and without the best straight gradient; None for a flat image.
    """
    gray = _level(luma(image))
    height, width = gray.shape
    if float(gray.std(dtype=np.float64)) < _FLAT:
        return None
    power = np.square(np.abs(finish(fourier.periodic_spectrum(gray), look)))
    look()
    rows, columns = np.fft.fftfreq(height)[:, None] * height, np.fft.fftfreq(width)[None, :] * width
    power[0, 0] = 0
    large = np.hypot(rows, columns) <= 1 / LARGE
    total = float(power.sum(dtype=np.float64))
    return float(power[large].sum(dtype=np.float64)) / total if total > 0 else None


def _level(gray: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return a plane without its mean and its best linear function of row and column."""
    plane = gray.astype(np.float64) - gray.mean(dtype=np.float64)
    for axis in (0, 1):
        side = gray.shape[axis]
        place = np.arange(side) - (side - 1) / 2
        slope = float(np.mean(place * plane.mean(axis=1 - axis))) / max(float(np.mean(np.square(place))), 1e-12)
        plane -= slope * (place[:, None] if axis == 0 else place)
    return np.asarray(plane, np.float32)


def own_structure(subject: Subject) -> float | None:
    """Return the exemplar's :func:`large_share`."""
    if min(subject.pixels.shape[:2]) < SMALLEST:
        return None
    value = subject.prepared("large structure", large_share)
    return value if value is None or math.isfinite(value) else None


register(
    Measure(
        id="exemplar-symmetry",
        title="exemplar symmetric",
        summary="How well the exemplar agrees with its mirror image, or with itself turned by half, beyond "
        "what its "
        "periods give (correlation at the best shift): 10% is usual, above 60% it has a symmetry that no "
        "method keeps.",
        low=0.0,
        high=1.0,
        better="neither",
        needs=("exemplar",),
        function=own_symmetry,
        form=".0%",
        order=82,
    )
)
register(
    Measure(
        id="exemplar-period",
        title="exemplar periodic",
        summary="How well the exemplar agrees with itself, shifted by an eighth of its side or more: near 100% "
        "for bricks and other exact periods, 10% to 30% for gravel and the like.",
        low=0.0,
        high=1.0,
        better="neither",
        needs=("exemplar",),
        function=own_period,
        form=".0%",
        order=85,
    )
)
register(
    Measure(
        id="exemplar-symbols",
        title="exemplar two tones",
        summary="Share of the exemplar's contrast that lies between two tones, the rarer of which covers 2 to 35% "
        "(0 otherwise): above 85% it is like print, letters or symbols on a ground.",
        low=0.0,
        high=1.0,
        better="neither",
        needs=("exemplar",),
        function=own_symbols,
        form=".0%",
        order=83,
    )
)
register(
    Measure(
        id="exemplar-structure",
        title="exemplar coarse",
        summary="Share of the exemplar's contrast in structure of which fewer than four periods fit into it, "
        "straight gradients apart: where it is most, the exemplar is too small to say how it goes on.",
        low=0.0,
        high=1.0,
        better="neither",
        needs=("exemplar",),
        function=own_structure,
        form=".0%",
        order=84,
    )
)
