"""Growing garbage and smears: growth that lost its way."""

from __future__ import annotations

from texlab_core.findings.regions import marked, worst_blocks
from texlab_core.findings.registry import Case, Detector, Seen, register
from texlab_core.findings.remedies import multiply, put, say
from texlab_core.measures.fine import SIDE, empty_map

_WINDOW = multiply("window", 1.5, "Use a larger window, {value} px.", most=31)


def _garbage(case: Case) -> Seen | None:
    if not case.fires():
        return None
    own = case.value("garbage")
    missed = (
        ""
        if own is None
        else f", and windows were found {case.text('garbage')} times as badly as the exemplar's own"
    )
    return Seen(
        f"Growth lost its way: the odd blocks are {case.text('odd-blocks')} from anything in the "
        f"exemplar{missed}.",
        worst_blocks(case.subject),
    )


def _smear(case: Case) -> Seen | None:
    if not case.fires():
        return None
    found = empty_map(case.subject)
    return Seen(
        f"Smears: {case.text('empty-share')} of the places of 16 x 16 pixels have fewer details than any of the "
        f"exemplar, and colours moved by {case.text('w1-pixels')} of its spread.",
        marked(found, SIDE),
    )


register(
    Detector(
        id="garbage",
        title="Garbage",
        summary="A region that looks like nothing in the exemplar, often the same few pixels over and over.",
        measures=("odd-blocks", "block-distance-back"),
        see=_garbage,
        why={
            "": "What was made badly is the surroundings of what is made next.",
            "efros-leung": "A pixel that fits badly is part of the next windows, which fit worse: growth "
            "slips into the "
            "wrong part of the search space (Efros and Leung 1999, section 3: growing garbage).",
        },
        remedies={
            "": (say("Try another seed."),),
            "efros-leung": (
                _WINDOW,
                put("error_limit", 10.0, "Fill only what fits within 10 gray levels, the rest later."),
            ),
        },
        methods=("efros-leung",),
        order=22,
    )
)
register(
    Detector(
        id="smear",
        title="Smears",
        summary="Places without details, as if wiped.",
        measures=("empty-share", "local-contrast", "w1-pixels"),
        see=_smear,
        why={
            "": "A flat place continues itself best.",
            "efros-leung": "A window without contrast matches every flat place, so that flatness spreads "
            "(Efros and Leung "
            "1999, section 3).",
            "de-bonet": "Flat parents have many candidates, and bands that do not fit cancel (De Bonet 1997, "
            "section "
            "4.3).",
        },
        remedies={
            "": (say("Try another seed, or an exemplar with fewer flat places."),),
            "efros-leung": (_WINDOW, multiply("tau", 0.5, "Halve τ to {value} gray levels.", least=1.0)),
            "de-bonet": (multiply("alpha", 0.5, "Halve α to {value}.", least=0.05),),
        },
        order=66,
    )
)
