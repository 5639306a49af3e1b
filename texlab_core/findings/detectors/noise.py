"""Noise and jagged edges."""

from __future__ import annotations

from texlab_core.findings.regions import densest
from texlab_core.findings.registry import Case, Detector, Seen, register
from texlab_core.findings.remedies import multiply, put, say
from texlab_core.measures.fine import speck_map

_ALPHA = multiply("alpha", 0.5, "Halve α to {value}: fewer candidates, which fit better.", least=0.05)
_EPS = multiply("eps", 0.5, "Halve ε to {value}.", least=0.05)
_TAU = multiply("tau", 0.5, "Halve τ to {value} gray levels.", least=1.0)


def _noise(case: Case) -> Seen | None:
    if not case.fires():
        return None
    back = case.value("block-distance-back")
    far = (
        ""
        if back is None
        else ", and half of the exemplar's blocks are "
        f"{case.text('block-distance-back')} and more from any in the result"
    )
    return Seen(
        f"Noise: {case.text('specks')} of the pixels stand out from their neighbours (1% in the exemplar){far}.",
        densest(speck_map(case.subject), case.subject.image.shape[:2]),
    )


def _jagged(case: Case) -> Seen | None:
    if not case.fires():
        return None
    return Seen(
        f"Edges may be jagged: {case.text('specks')} of the pixels stand out from their neighbours, at "
        f"{case.text('local-contrast')} of the exemplar's local contrast.",
        densest(speck_map(case.subject), case.subject.image.shape[:2]),
    )


register(
    Detector(
        id="noise",
        title="Noise",
        summary="Specks and grain that the exemplar does not have.",
        measures=("specks", "block-distance-back", "empty-share", "palette-distance"),
        see=_noise,
        why={
            "": "Neighbouring pixels were chosen without regard to one another.",
            "de-bonet": "With large thresholds nearly everything matches, and neighbours come from different "
            "places (De "
            "Bonet 1997, figs. 11 and 12).",
            "efros-leung": "Too many candidates match: ε or τ is large for this exemplar, or the window so "
            "large that no "
            "candidate is good (Efros and Leung 1999, section 2.1; Forsyth and Ponce, assignment c).",
            "pixels": "Every pixel is drawn alone (De Bonet 1997, fig. 3).",
            "bands": "Every band is drawn alone (De Bonet 1997, fig. 4).",
        },
        remedies={
            "": (say("Make fewer candidates match: smaller thresholds, or windows that see more."),),
            "de-bonet": (_ALPHA, put("channels", "all", "Let all channels constrain.")),
            "efros-leung": (_TAU, _EPS, multiply("window", 0.7, "Use a smaller window, {value} px.", least=9)),
        },
        order=32,
    )
)
register(
    Detector(
        id="jagged",
        title="Jagged edges",
        summary="Edges that are smooth in the exemplar are frayed or stepped.",
        measures=("specks", "local-contrast"),
        see=_jagged,
        why={
            "": "Both sides of an edge were chosen apart.",
            "de-bonet": "The fine levels come from places whose edge runs beside that of the coarse level "
            "(De Bonet "
            "1997, section 4.3).",
            "efros-leung": "A small window does not see where an edge goes on (Efros and Leung 1999, section 3).",
        },
        remedies={
            "": (say("Let more of the surroundings decide."),),
            "de-bonet": (_ALPHA,),
            "efros-leung": (multiply("window", 1.5, "Use a larger window, {value} px.", most=31),),
        },
        order=64,
    )
)
