"""Straight cuts within the result, and at its borders where it was to tile."""

from __future__ import annotations

from texlab_core.findings.finding import Region, Where
from texlab_core.findings.regions import along
from texlab_core.findings.registry import Case, Detector, Seen, register
from texlab_core.findings.remedies import multiply, put, say
from texlab_core.measures.cuts import largest_cut, largest_cut_between
from texlab_core.measures.limits import LIMITS
from texlab_core.measures.registry import find_measure
from texlab_core.measures.repeats import seams

# A line that jumps this many times as far as any of the exemplar's is worth a look, whatever the labels taught.
PLAIN = 2.0


def _plain(case: Case) -> bool:
    """Whether a line jumps far beyond the exemplar's own: only a hint, for no labels are of such results."""
    if case.rule is not None and case.rule.methods:
        return False
    cut, own = case.value("cuts"), case.value("own-cuts")
    return cut is not None and own is not None and cut >= max(PLAIN * own, LIMITS["cuts"].bad)


def _usual(case: Case) -> bool:
    """Whether the exemplar has larger lines, in results unlike those that the limits for one method are from."""
    cut, own = case.value("cuts"), case.value("own-cuts")
    of_all = case.rule is None or not case.rule.methods
    return of_all and (cut is None or own is None or cut < own)


def _cuts(case: Case) -> Seen | None:
    labelled = case.fires()
    if not labelled and not _plain(case):
        return None
    # Where copies are laid side by side the cut is where they meet; elsewhere lines of the texture may jump more.
    cut = largest_cut_between(case.subject) if labelled else None
    if cut is None or cut.value < LIMITS["cuts"].good:
        cut = largest_cut(case.subject)
    if cut is None:
        return None
    where = along(cut, case.subject.image.shape[:2])
    return Seen(
        f"A straight cut runs {where.words}: it jumps by {find_measure('cuts').text(cut.value)} deviations, "
        "the exemplar's own "
        "largest "
        f"line by {case.text('own-cuts')}.",
        where,
        hint=not labelled or _usual(case),
    )


def _meant_to_tile(case: Case) -> bool:
    """Whether the result was to continue itself: by the method, or because it was asked for."""
    if case.method in ("heeger-bergen", "msg", "uncoded"):
        return True
    if case.method == "tiling":
        return True
    return bool(case.knob("tileable") or case.knob("tiles"))


def _seam(case: Case) -> Seen | None:
    if not _meant_to_tile(case):
        return None
    found, own = seams(case.subject), case.value("own-cuts")
    if found is None or own is None:
        return None
    axis = max(found, key=lambda each: found[each])
    # A line of the exemplar itself may stand at the border.
    if found[axis] < max(LIMITS["cuts"].bad, own):
        return None
    height, width = case.subject.image.shape[:2]
    if axis == "row":
        regions = (Region(0, 0, 1, width), Region(height - 1, 0, 1, width))
        words = "first and last row"
    else:
        regions = (Region(0, 0, height, 1), Region(0, width - 1, height, 1))
        words = "first and last column"
    return Seen(
        f"It does not tile: between the {words} it jumps by {case.text('seam')} deviations, the exemplar's own "
        f"largest line by {case.text('own-cuts')}.",
        Where("result", words, regions),
    )


register(
    Detector(
        id="cuts",
        title="Straight cuts",
        summary="The picture breaks along a straight line.",
        measures=(
            "cuts",
            "own-cuts",
            "laid-down-share",
            "specks",
            "spectral-variation",
            "palette-distance",
            "odd-blocks",
            "exemplar-drift",
        ),
        see=_cuts,
        why={
            "": "Pieces were laid side by side that do not continue one another.",
            "de-bonet": "The coarsest level was repeated, and repetitions that lie side by side do not fit "
            "(De Bonet "
            "1997, section 4.3).",
            "tiling": "The exemplar's opposite borders do not continue one another (De Bonet 1997, fig. 2).",
        },
        remedies={
            "": (say("Let pieces overlap, or choose pieces whose borders agree."),),
            "de-bonet": (
                put(
                    "coarsest", "patches", "Lay the coarsest level out in patches that continue their neighbours."
                ),
                put("border", "smooth", "Let the pyramid see the exemplar as periodic plus smooth."),
                multiply("places", 0.34, "Draw from the {value} best places only.", least=1),
            ),
        },
        order=20,
    )
)
register(
    Detector(
        id="does-not-tile",
        title="Does not tile",
        summary="Laid side by side, the result shows a seam.",
        measures=("seam", "own-cuts"),
        see=_seam,
        why={
            "": "Opposite borders of the result were not made as neighbours.",
            "de-bonet": "The result was made at the next multiples of 2^N and cropped, so that its borders are no "
            "neighbours (De Bonet 1997, section 4.1: sides that halve).",
            "efros-leung": "A causal window sees nothing ahead and cannot close the tile (Efros and Leung "
            "1999, section "
            "2.1).",
            "heeger-bergen": "A Laplacian pyramid that halves an odd side sees its last sample twice (Heeger and "
            "Bergen 1995, section 2.1).",
            "tiling": "The result's sides are no multiples of the exemplar's, or the exemplar itself does "
            "not tile.",
        },
        remedies={
            "": (say("Choose sides that are multiples of a power of two."),),
            "de-bonet": (put("uneven", "fewer", "Take fewer halvings, so that it tiles at this size."),),
            "efros-leung": (put("shape", "square", "Take a square window."),),
            "heeger-bergen": (put("odd_sides", "spread", "Spread the coarse samples evenly around an odd side."),),
        },
        order=25,
    )
)
