"""What the spectrum dock shows, computed: pictures of spectra, profiles, peaks, distances. No Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from texlab.docks.recent import Same
from texlab.style.colouring import DIVERGING_TABLE, GRAY_TABLE, Scale, paint
from texlab_core.errors import Cancelled
from texlab_core.stats.peaks import find_peaks, match_peaks, predicted_snap
from texlab_core.stats.spectrum import (
    QUANTIZATION,
    log_spectral_distance,
    power_spectrum,
    spectral_difference,
    total_variation,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab.docks.recent import Recent
    from texlab.style.pictures import Picture
    from texlab_core.engine.steps import FloatImage
    from texlab_core.stats.peaks import Peak, Shift, Snap
    from texlab_core.stats.spectrum import Plane, Profile, Spectrum

View = Literal["power", "difference", "autocorrelation"]
# Left, top, width and height in the coordinates of the plane.
Area = tuple[float, float, float, float]
MAX_PEAKS = 5
# Peaks further apart than an octave or 45 degrees are not the same repetition.
SAME = 1.0
# Shifts of so many pixels are left out when the colours of the autocorrelation are chosen.
NEAR = 3


@dataclass(frozen=True, eq=False)
class Analysed:
    """The spectrum of one image and what is read from it."""

    spectrum: Spectrum
    decibels: Plane
    radial: Profile
    angular: Profile
    peaks: tuple[Peak, ...]


@dataclass(frozen=True, eq=False)
class PlanePicture:
    """A plane of values with its colours and coordinates.

    Parameters
    ----------
    values
        (h, w) float32.
    picture
        (h, w, 3) uint8.
    area
        Left, top, width and height, in cycles per pixel or in pixels of shift.
    scale
        Its colour bar.
    """

    values: Plane
    picture: Picture
    area: Area
    scale: Scale

    def value(self, x: float, y: float) -> float | None:
        """Return the value at a place, or None outside."""
        left, top, width, height = self.area
        rows, columns = self.values.shape
        row, column = int((y - top) / height * rows // 1), int((x - left) / width * columns // 1)
        return float(self.values[row, column]) if 0 <= row < rows and 0 <= column < columns else None


@dataclass(frozen=True, eq=False)
class SpectraAnswer:
    """What the dock shows.

    Parameters
    ----------
    view
        Which pictures.
    exemplar, result
        The spectra; no result while there is none.
    first, second
        The pictures; the difference has one only.
    snaps
        Where MSG moves each peak of the exemplar.
    matches
        Each peak of the exemplar with the nearest of the result, and the shift; None when there is none near.
    distance, variation
        Log-spectral distance in dB, and share of the power moved.
    """

    view: View
    exemplar: Analysed
    result: Analysed | None
    first: PlanePicture
    second: PlanePicture | None
    snaps: tuple[Snap | None, ...]
    matches: tuple[tuple[Peak, Shift] | None, ...]
    distance: float | None
    variation: float | None


def spectra(
    exemplar: FloatImage,
    result: FloatImage | None,
    view: View,
    recent: Recent,
    should_stop: Callable[[], bool],
) -> SpectraAnswer:
    """Compare the spectra of the luminance of two images, (H, W, C) float32 each.

    Raises
    ------
    Cancelled
        When ``should_stop`` said so.
    """
    first = recent.get(Same(exemplar), lambda: analyse(exemplar))
    if should_stop():
        raise Cancelled
    second = None if result is None else recent.get(Same(result), lambda: analyse(result))
    if should_stop():
        raise Cancelled
    if second is None and view == "difference":
        view = "power"
    distance = variation = None
    if second is not None:
        distance = log_spectral_distance(first.spectrum, second.spectrum)
        variation = total_variation(first.spectrum, second.spectrum)
    return SpectraAnswer(
        view,
        first,
        second,
        *_pictures(first, second, view),
        tuple(predicted_snap(peak) for peak in first.peaks),
        () if second is None else matched(first.peaks, second.peaks),
        distance,
        variation,
    )


def analyse(image: FloatImage) -> Analysed:
    """Return the spectrum of an image's luminance with its profiles and peaks."""
    spectrum = power_spectrum(image)
    return Analysed(
        spectrum, spectrum.log_picture(), spectrum.radial(), spectrum.angular(), find_peaks(spectrum, MAX_PEAKS)
    )


def matched(first: tuple[Peak, ...], second: tuple[Peak, ...]) -> tuple[tuple[Peak, Shift] | None, ...]:
    """Return for each peak the nearest of the second image and the shift, None when that is another repetition."""
    pairs = match_peaks(first, second)
    if not pairs:
        return (None,) * len(first)
    return tuple(
        (other, moved) if np.hypot(moved.octaves, moved.degrees / 45) < SAME else None for _, other, moved in pairs
    )


def frequency_area(size: tuple[int, int]) -> Area:
    """Return the area of a plane of frequencies with zero at (rows // 2, columns // 2), in cycles per pixel."""
    rows, columns = size
    return -(columns // 2 + 0.5) / columns, -(rows // 2 + 0.5) / rows, 1.0, 1.0


def shift_area(size: tuple[int, int]) -> Area:
    """Return the area of a plane of shifts with none at (rows // 2, columns // 2), in pixels."""
    rows, columns = size
    return -(columns // 2 + 0.5), -(rows // 2 + 0.5), float(columns), float(rows)


def decibels(power: NDArray[np.floating]) -> NDArray[np.float64]:
    """Return powers in dB above the rounding to 256 levels, at least 0."""
    return 10 * np.log10(np.maximum(np.asarray(power, np.float64) / QUANTIZATION, 1.0))


def table_of(view: View) -> NDArray[np.uint8]:
    """Return the colours of a view: gray for powers, diverging around zero for the others."""
    return GRAY_TABLE if view == "power" else DIVERGING_TABLE


def _pictures(first: Analysed, second: Analysed | None, view: View) -> tuple[PlanePicture, PlanePicture | None]:
    both = (first, second)
    if view == "difference" and second is not None:
        values = spectral_difference(first.spectrum, second.spectrum)
        limit = max(float(np.quantile(np.abs(values), 0.99)), 1.0)
        shape = (values.shape[0], values.shape[1])
        return _picture(values, frequency_area(shape), Scale(-limit, limit), view), None
    if view == "autocorrelation":
        planes = [None if each is None else each.spectrum.autocorrelation() for each in both]
        limit = max((_largest_shifted(plane) for plane in planes if plane is not None), default=1.0)
        scale, place = Scale(-limit, limit), shift_area
    else:
        planes = [None if each is None else each.decibels for each in both]
        scale = Scale(0.0, max(1.0, *(float(plane.max()) for plane in planes if plane is not None)))
        place = frequency_area
    found = [
        None if plane is None else _picture(plane, place((plane.shape[0], plane.shape[1])), scale, view)
        for plane in planes
    ]
    assert found[0] is not None
    return found[0], found[1]


def _picture(values: Plane, area: Area, scale: Scale, view: View) -> PlanePicture:
    return PlanePicture(values, paint(scale.place(values), table_of(view)), area, scale)


def _largest_shifted(plane: Plane) -> float:
    """Return the largest correlation but for the smallest shifts, which are always alike."""
    rows, columns = plane.shape
    far = plane.copy()
    far[max(0, rows // 2 - NEAR) : rows // 2 + NEAR + 1, max(0, columns // 2 - NEAR) : columns // 2 + NEAR + 1] = 0
    return max(float(np.abs(far).max()), 0.05)
