"""What the exemplar asks for that the method cannot keep, whatever the parameters."""

from __future__ import annotations

from texlab_core.findings.regions import in_exemplar
from texlab_core.findings.registry import Case, Detector, Seen, register
from texlab_core.findings.remedies import multiply, put, say, use
from texlab_core.measures.exemplar_kind import own_agreement
from texlab_core.measures.limits import LIMITS

_CROP = say("Crop the exemplar to a part that is one texture everywhere.")


def _symmetry(case: Case) -> Seen | None:
    if not case.fires():
        return None
    found = own_agreement(case.subject)
    if found is None:
        return None
    name = max(found.symmetries, key=found.symmetries.__getitem__)
    words = f"symmetric: {name}"
    return Seen(
        f"The exemplar is symmetric ({name}, by {case.text('exemplar-symmetry')}), and that will be lost.",
        in_exemplar(words),
    )


def _letters(case: Case) -> Seen | None:
    if not case.fires():
        return None
    return Seen(
        f"The exemplar looks like letters or symbols: {case.text('exemplar-symbols')} of its contrast lies "
        "between two "
        "tones.",
        in_exemplar(),
    )


def _gradient(case: Case) -> Seen | None:
    if not case.fires():
        return None
    return Seen(
        f"The exemplar changes from one side to the other: a straight gradient makes "
        f"{case.text('exemplar-drift')} of "
        "its contrast, and that will be lost.",
        in_exemplar(),
    )


def _inhomogeneous(case: Case) -> Seen | None:
    uneven, drift = case.value("exemplar-unevenness"), case.value("exemplar-drift")
    reasons = []
    if uneven is not None and LIMITS["exemplar-unevenness"].zone(uneven) == "bad":
        reasons.append(f"its details vary {case.text('exemplar-unevenness')} times as much as they should")
    if drift is not None and LIMITS["exemplar-drift"].zone(drift) == "bad":
        reasons.append(f"{case.text('exemplar-drift')} of its contrast is one straight gradient")
    if not reasons:
        return None
    return Seen(f"The exemplar is not one texture everywhere: {', and '.join(reasons)}.", in_exemplar())


def _small(case: Case) -> Seen | None:
    if not case.fires():
        return None
    return Seen(
        f"The exemplar is too small for its structure: {case.text('exemplar-structure')} of its contrast is in "
        "structure of which not four periods fit into it.",
        in_exemplar(),
    )


register(
    Detector(
        id="inhomogeneous-exemplar",
        title="Inhomogeneous exemplar",
        summary="The exemplar is not the same texture everywhere: judge it first.",
        measures=("exemplar-unevenness", "exemplar-drift"),
        see=_inhomogeneous,
        why={
            "": "Every method takes the exemplar for one texture, and D means little where it is none.",
            "heeger-bergen": "One histogram stands for all places, so that what differs from place to place "
            "is mixed "
            "(Heeger and Bergen 1995, section 6: inhomogeneous input).",
            "de-bonet": "Candidates are taken from everywhere, so that parts that belong to different places "
            "meet (De "
            "Bonet 1997, section 5).",
            "efros-leung": "Growth slips from one kind of place into the other (Efros and Leung 1999, section 3).",
        },
        remedies={
            "": (_CROP,),
            "de-bonet": (
                put(
                    "coarsest_side",
                    8,
                    "Keep the coarsest level at 8 px, which keeps large changes in their place.",
                ),
                _CROP,
            ),
        },
        order=70,
    )
)
register(
    Detector(
        id="gradient",
        title="Gradient",
        summary="The exemplar changes progressively in colour or brightness.",
        measures=("exemplar-drift",),
        see=_gradient,
        why={
            "": "A progressive change is no texture: pieces are taken from all sides alike.",
            "de-bonet": "Progressive changes of size or colour do not come out, since candidates are "
            "compared without "
            "their place (De Bonet 1997, section 5).",
        },
        remedies={"": (say("Crop the exemplar across the gradient, or take the gradient out first."),)},
        order=72,
    )
)
register(
    Detector(
        id="symmetry",
        title="Symmetry",
        summary="The exemplar is symmetric, and no method keeps that.",
        measures=("exemplar-symmetry",),
        see=_symmetry,
        why={
            "": "Both halves of a symmetric figure are made apart: nothing compares them.",
            "de-bonet": "Mirror and rotational symmetry are no features of a parent structure (De Bonet "
            "1997, section "
            "5).",
        },
        remedies={
            "": (say("Take one half as exemplar and mirror the result."),),
            "de-bonet": (
                multiply("alpha", 0.33, "Lower α to {value}: whole figures are copied.", least=0.05),
                use("tiling", "Try tiling, which keeps the whole."),
            ),
        },
        order=74,
    )
)
register(
    Detector(
        id="letters",
        title="Letters or symbols",
        summary="Signs that have to be whole to be read.",
        measures=("exemplar-symbols",),
        see=_letters,
        why={
            "": "Letters are read one by one; statistics make strokes, not letters.",
            "msg": "Objects, outlines and letters vanish even with the whole spectrum, since phase makes "
            "them (Navarro "
            "and Portilla 1996, section 4).",
            "de-bonet": "Letters and symbols need small thresholds, and then are copied (De Bonet 1997, "
            "section 5).",
            "efros-leung": "Letters come out where the window is larger than one (Efros and Leung 1999, fig. 4).",
        },
        remedies={
            "": (use("efros-leung", "Try Efros-Leung with a window larger than a letter."),),
            "de-bonet": (
                multiply("alpha", 0.5, "Halve α to {value}.", least=0.05),
                use("efros-leung", "Try Efros-Leung with a window larger than a letter."),
            ),
            "efros-leung": (multiply("window", 1.5, "Use a larger window, {value} px.", most=31),),
        },
        order=76,
    )
)
register(
    Detector(
        id="small-exemplar",
        title="Exemplar too small",
        summary="Structure as large as the exemplar: how it goes on is not in it.",
        measures=("exemplar-structure",),
        see=_small,
        why={
            "": "How structure goes on can only be learned where it is seen several times.",
            "heeger-bergen": "Structure larger than about 2^scales pixels is left to chance (Heeger and "
            "Bergen 1995, "
            "section 2.1).",
            "de-bonet": "The coarsest levels are copied as they are (De Bonet 1997, section 4.3).",
            "efros-leung": "Windows have to be larger than the elements, and then few candidates are left "
            "(Efros and "
            "Leung 1999, section 2.1).",
            "msg": "Below 1/32 cycles per pixel there are five numbers only (Navarro and Portilla 1996, table 1).",
        },
        remedies={
            "": (say("Take a larger part of the source, or scale it down."),),
            "heeger-bergen": (
                multiply("scales", 1.5, "Match one more scale or two, {value}.", most=7),
                say("Take a larger part of the source, or scale it down."),
            ),
        },
        order=78,
    )
)
