"""How far the spectrum of a result is from its exemplar's, and where its peaks have moved."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.measures.registry import Measure, register
from texlab_core.stats.spectrum import log_spectral_distance, power_spectrum, total_variation

if TYPE_CHECKING:
    from texlab_core.measures.subject import Subject
    from texlab_core.stats.peaks import Peak, Shift
    from texlab_core.stats.spectrum import Spectrum

PEAKS = 5


def spectra(subject: Subject) -> tuple[Spectrum, Spectrum]:
    """Return the power spectra of the exemplar's and the image's luminance."""
    exemplar = subject.prepared("spectrum", power_spectrum)
    image = subject.once("spectrum", lambda: power_spectrum(subject.image, subject.look))
    subject.look()
    return exemplar, image


def _distance(subject: Subject) -> float:
    return log_spectral_distance(*spectra(subject))


def _variation(subject: Subject) -> float:
    return total_variation(*spectra(subject))


def moved_peaks(subject: Subject) -> tuple[tuple[Peak, Shift], ...]:
    """Return each strong peak of the exemplar, the strongest first, with how far the nearest one has moved."""
    from texlab_core.stats.peaks import find_peaks, match_peaks

    exemplar, image = spectra(subject)
    own = subject.prepared("peaks", lambda pixels, look: find_peaks(exemplar, PEAKS))
    subject.look()
    other = subject.once("peaks", lambda: find_peaks(image, 2 * PEAKS))
    subject.look()
    return tuple((peak, shift) for peak, _, shift in match_peaks(own, other))


def peak_shifts(subject: Subject) -> tuple[tuple[float, Shift], ...]:
    """Return for each strong peak of the exemplar its share of the variance and how far the nearest one moved."""
    return tuple((peak.share, shift) for peak, shift in moved_peaks(subject))


def _octaves(subject: Subject) -> float | None:
    return _mean([(share, abs(shift.octaves)) for share, shift in peak_shifts(subject)])


def _degrees(subject: Subject) -> float | None:
    return _mean([(share, abs(shift.degrees)) for share, shift in peak_shifts(subject)])


def _mean(found: list[tuple[float, float]]) -> float | None:
    total = sum(weight for weight, _ in found)
    return sum(weight * value for weight, value in found) / total if total > 0 else None


register(
    Measure(
        id="spectral-distance",
        title="spectrum",
        summary="Root mean square difference of the two power spectra in decibels; 0 for equal spectra, 2 to 4 is "
        "usual for a good result.",
        low=0.0,
        high=200.0,
        better="lower",
        needs=("exemplar",),
        function=_distance,
        unit="dB",
        form=".1f",
        live=True,
        order=50,
    )
)
register(
    Measure(
        id="spectral-variation",
        title="power moved",
        summary="Share of the power that would have to move to another frequency to make the two spectra alike: "
        "the total variation between them.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("exemplar",),
        function=_variation,
        form=".0%",
        live=True,
        order=51,
    )
)
register(
    Measure(
        id="peak-shift-octaves",
        title="peaks moved",
        summary="How far the strongest peaks of the exemplar's spectrum are from the nearest peaks of the "
        "result, in octaves of frequency, weighted by their power; 0 where every period is kept.",
        low=0.0,
        high=20.0,
        better="lower",
        needs=("exemplar",),
        function=_octaves,
        unit="oct",
        form=".2f",
        reference="R. Navarro and J. Portilla, EUSIPCO 1996, section 4",
        order=52,
    )
)
register(
    Measure(
        id="peak-shift-degrees",
        title="peaks turned",
        summary="How far the strongest peaks of the exemplar's spectrum are from the nearest peaks of the "
        "result, in degrees of orientation, weighted by their power.",
        low=0.0,
        high=90.0,
        better="lower",
        needs=("exemplar",),
        function=_degrees,
        unit="°",
        form=".0f",
        reference="R. Navarro and J. Portilla, EUSIPCO 1996, section 4",
        order=53,
    )
)
