"""Periods and orientations that moved."""

from __future__ import annotations

from texlab_core.findings.finding import Where
from texlab_core.findings.registry import Case, Detector, Seen, register
from texlab_core.findings.remedies import multiply, say, use
from texlab_core.measures.spectra import moved_peaks

MOST = 3


def _peaks(case: Case) -> Seen | None:
    if not case.fires():
        return None
    moved = [each for each in moved_peaks(case.subject) if abs(each[1].octaves) > 0.05 or abs(each[1].degrees) > 3]
    bands = tuple(
        f"period {peak.period:.3g} px at {peak.orientation:.0f}°: {shift.octaves:+.2f} octaves, "
        f"{shift.degrees:+.0f}°"
        for peak, shift in moved[:MOST]
    )
    how = f"; the strongest one, {bands[0]}" if bands else ""
    numbers = f"{case.text('spectral-variation')} of the power is at another frequency"
    words = bands[0] if bands else "all frequencies"
    return Seen(f"Periods moved: {numbers}{how}.", Where("bands", words, bands=bands))


register(
    Detector(
        id="peaks-moved",
        title="Peaks moved",
        summary="Stripes or rows have another period or direction than in the exemplar.",
        measures=("spectral-variation", "peak-shift-octaves", "peak-shift-degrees"),
        see=_peaks,
        why={
            "": "No number of this method holds the period or the direction of stripes.",
            "msg": "Emergent frequencies shift toward the nearest centre of the 16 channels, which lie an "
            "octave and 45° "
            "apart (Navarro and Portilla 1996, section 4).",
            "heeger-bergen": "A band holds energy of a whole octave and 45°, wherever in it the peak was "
            "(Heeger and "
            "Bergen 1995, section 2.1).",
            "efros-leung": "A window smaller than the period does not see where the next stripe begins "
            "(Efros and Leung "
            "1999, section 2.1).",
            "ac-h": "The middle of the autocorrelation ends before the period does (Navarro and Portilla "
            "1996, section "
            "5).",
        },
        remedies={
            "": (use("uncoded", "Try the uncoded spectrum, which keeps every frequency."),),
            "heeger-bergen": (multiply("orientations", 1.5, "Use more orientations, {value}.", most=8),),
            "efros-leung": (multiply("window", 1.5, "Use a larger window, {value} px.", most=31),),
            "de-bonet": (multiply("alpha", 0.5, "Halve α to {value}.", least=0.05), say("Try another seed.")),
        },
        order=50,
    )
)
