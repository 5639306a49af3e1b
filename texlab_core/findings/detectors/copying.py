"""Repetition and verbatim copying: what D does not see."""

from __future__ import annotations

from texlab_core.findings.finding import Region, Where
from texlab_core.findings.regions import everywhere, marked
from texlab_core.findings.registry import Case, Detector, Seen, register
from texlab_core.findings.remedies import multiply, put, say, use
from texlab_core.measures.patches import SIDE, found_patches


def _repetition(case: Case) -> Seen | None:
    if not case.fires():
        return None
    height, width = (int(side) for side in case.subject.pixels.shape[:2])
    rows, columns = (int(side) for side in case.subject.image.shape[:2])
    blocks = tuple(
        Region(top, left, min(height, rows - top), min(width, columns - left))
        for top in range(0, min(rows, 2 * height), height)
        for left in range(0, min(columns, 2 * width), width)
    )
    repeats = case.value("self-repetition")
    again = "" if repeats is None else f", and the result repeats itself at that distance by {repeats:.0%}"
    return Seen(
        f"The exemplar was laid down as a whole: its blocks agree with a shift of it by "
        f"{case.text('laid-down-share')}{again}.",
        Where("result", f"blocks of {width} x {height} pixels", blocks),
    )


def _verbatim(case: Case) -> Seen | None:
    if not case.fires():
        return None
    found = found_patches(case.subject)
    where = everywhere()
    if found is not None and found.any():
        where = marked(found, more=SIDE - 1)
    share = case.value("patches-copied")
    exact = "" if share is None else f"; {share:.0%} of 9 x 9 patches are the exemplar's, bit for bit"
    return Seen(
        f"The exemplar is there again: half of its blocks have one within {case.text('block-distance-back')} "
        "in the "
        f"result{exact}.",
        where,
    )


register(
    Detector(
        id="repetition",
        title="Repetition",
        summary="The exemplar was laid down as a whole, again and again.",
        measures=("laid-down-share", "exemplar-period", "self-repetition"),
        see=_repetition,
        why={
            "": "Large pieces were copied at a few shifts only.",
            "de-bonet": "The coarsest level is the exemplar's, repeated, and with small thresholds the finer "
            "ones follow "
            "it (De Bonet 1997, section 4.3).",
            "efros-leung": "Once all of a window matches exactly there is one candidate left, and the "
            "exemplar goes on "
            "(Efros and Leung 1999, section 3).",
            "tiling": "Repeating is all that this method does (De Bonet 1997, fig. 2).",
        },
        remedies={
            "": (say("Ask for more that is new: larger thresholds, smaller windows or pieces."),),
            "de-bonet": (
                put("coarsest", "patches", "Lay the coarsest level out in patches from different places."),
                multiply("alpha", 1.5, "Raise α to {value}.", most=0.45),
                multiply("patch", 0.6, "Take smaller patches, {value} of the exemplar's side.", least=0.2),
            ),
            "efros-leung": (multiply("tau", 2.0, "Double τ to {value} gray levels.", least=3.0, most=15.0),),
            "tiling": (use("de-bonet", "Try De Bonet, which makes something new."),),
        },
        order=30,
    )
)
register(
    Detector(
        id="verbatim",
        title="Verbatim copying",
        summary="Large parts of the exemplar stand in the result as they are.",
        measures=("block-distance-back", "laid-down-share", "patches-copied"),
        see=_verbatim,
        why={
            "": "Nothing hinders the method from going on with what it copied before.",
            "de-bonet": "With small thresholds a location matches only itself, so that its neighbours come "
            "along (De "
            "Bonet 1997, figs. 11 and 12).",
            "efros-leung": "A window that is found exactly allows no other candidate; large windows and a "
            "small τ do "
            "that (Efros and Leung 1999, section 3: verbatim copying).",
        },
        remedies={
            "": (say("Ask for more that is new: larger thresholds, smaller windows or pieces."),),
            "de-bonet": (
                multiply("alpha", 1.5, "Raise α to {value}.", most=0.45),
                multiply("patch", 0.6, "Take smaller patches, {value} of the exemplar's side.", least=0.2),
            ),
            "efros-leung": (
                multiply("tau", 2.0, "Double τ to {value} gray levels.", least=3.0, most=15.0),
                multiply("window", 0.7, "Use a smaller window, {value} px.", least=9),
            ),
        },
        order=35,
    )
)
