"""How far the distributions of pixels and of subbands are from the exemplar's: Wasserstein-1 over the spread."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from texlab_core.measures.registry import Measure, register
from texlab_core.stats.distances import w1_sorted
from texlab_core.transforms.luma import luma

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from texlab_core.engine.steps import FloatImage
    from texlab_core.measures.subject import Subject

LEVELS = 4
ORIENTATIONS = 4
SMALLEST = 8
# A band this much weaker than its plane is measured against the plane: rounding has no distribution to keep.
FAINT = 1e-3
Sample: TypeAlias = NDArray[np.float32]


def _channels(image: FloatImage, look: Callable[[], None]) -> tuple[Sample, ...]:
    return tuple(_sorted(image[:, :, channel], look) for channel in range(image.shape[2]))


def _sorted(values: NDArray[np.float32], look: Callable[[], None]) -> Sample:
    look()
    return np.sort(values, axis=None)


def w1_pixels(subject: Subject) -> float:
    """Return the mean over the channels of W1 / standard deviation (1 where it is 0) of the exemplar's.

    A gray picture beside a coloured one counts as three equal channels.
    """
    own = subject.prepared("sorted channels", _channels)
    other = subject.once("sorted channels", lambda: _channels(subject.image, subject.look))
    count = max(len(own), len(other))
    pairs = zip(own * (count // len(own)), other * (count // len(other)), strict=True)
    return (
        sum(_relative(one, two, float(one.std(dtype=np.float64)) or 1.0, subject.look) for one, two in pairs)
        / count
    )


def _relative(own: Sample, other: Sample, spread: float, look: Callable[[], None]) -> float:
    look()
    return w1_sorted(own, other) / spread


def _bands(gray: NDArray[np.float32], levels: int, look: Callable[[], None]) -> Iterator[Sample]:
    from texlab_core.stats.bands import split

    for band in split(gray, "steerable", levels, ORIENTATIONS, look):
        yield _sorted(band.plane, look)


def band_distances(subject: Subject) -> tuple[float, ...] | None:
    """Return W1 / standard deviation of every subband: four scales, as far as they fit, of four orientations.

    The bands are those of the luminance in the steerable pyramid, borders reflected, from fine to coarse with the
    residuals at the ends, as in :func:`texlab_core.stats.bands.split`.
    """
    from texlab_core.stats.bands import most_levels

    sides = (*subject.image.shape[:2], *subject.pixels.shape[:2])
    if min(sides) < SMALLEST:
        return None
    levels = min(LEVELS, *(most_levels(each.shape[:2], "steerable") for each in (subject.image, subject.pixels)))

    def prepare(pixels: FloatImage, look: Callable[[], None]) -> tuple[tuple[Sample, ...], float]:
        gray = luma(pixels)
        return tuple(_bands(gray, levels, look)), float(gray.std(dtype=np.float64))

    own, whole = subject.prepared(f"sorted bands {levels}", prepare)
    gray = subject.once("gray", lambda: luma(subject.image))
    if whole == 0:
        return None
    distances = []
    for one, other in zip(own, _bands(gray, levels, subject.look), strict=True):
        spread = float(one.std(dtype=np.float64))
        distances.append(_relative(one, other, spread if spread > FAINT * whole else whole, subject.look))
    return tuple(distances)


def w1_bands(subject: Subject) -> float | None:
    """Return the mean of :func:`band_distances`."""
    found = band_distances(subject)
    return None if found is None else sum(found) / len(found)


register(
    Measure(
        id="w1-pixels",
        title="W1 pixels",
        summary="How far the histograms of the colour channels are from the exemplar's: the mean way of a value "
        "(Wasserstein-1), in standard deviations of the exemplar; 0 for equal histograms.",
        low=0.0,
        high=1e4,
        better="lower",
        needs=("exemplar",),
        function=w1_pixels,
        form=".3f",
        reference="D. J. Heeger and J. R. Bergen, SIGGRAPH 1995, section 2.2",
        order=60,
    )
)
register(
    Measure(
        id="w1-bands",
        title="W1 bands",
        summary="How far the histograms of the subbands are from the exemplar's (Wasserstein-1 in standard "
        "deviations of the exemplar's band, mean over four scales of four orientations and the residuals, "
        "luminance).",
        low=0.0,
        high=1e4,
        better="lower",
        needs=("exemplar",),
        function=w1_bands,
        form=".3f",
        reference="D. J. Heeger and J. R. Bergen, SIGGRAPH 1995, section 2.3",
        order=61,
    )
)
