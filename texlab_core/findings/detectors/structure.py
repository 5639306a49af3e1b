"""Structure that is lost, and the dependence between scales that carries it."""

from __future__ import annotations

from texlab_core.findings.limits import BANDS_ALONE
from texlab_core.findings.regions import everywhere, worst_blocks
from texlab_core.findings.registry import Case, Detector, Seen, register
from texlab_core.findings.remedies import multiply, put, use
from texlab_core.measures.limits import LIMITS

EFROS = use("efros-leung", "Try Efros-Leung, which copies whole surroundings pixel by pixel.")
DE_BONET = use("de-bonet", "Try De Bonet, which lets coarse bands decide what fine ones may be.")


def _structure(case: Case) -> Seen | None:
    if not case.fires():
        return None
    limit = LIMITS["discriminability"]
    return Seen(
        f"The structure is lost: D is {case.text('discriminability')}; results that look right have "
        f"{limit.good:g} and less, and 19 of 20 at {limit.bad:g} and above look wrong.",
        worst_blocks(case.subject),
    )


def _dependence(case: Case) -> Seen | None:
    if not case.fires() or case.rule is None:
        return None
    what = (
        f"Fine details no longer follow the coarse ones: their dependence differs by "
        f"{case.text('dependence-difference')}; 19 of 20 good results are below {case.rule.border:.2f}."
    )
    return Seen(what, everywhere())


register(
    Detector(
        id="structure-lost",
        title="Structure lost",
        summary="Shapes, edges and their arrangement are not those of the exemplar.",
        measures=("discriminability",),
        see=_structure,
        why={
            "": "What the eye groups into shapes depends on many pixels together; statistics of few of them "
            "do not "
            "hold it.",
            "heeger-bergen": "Only the histogram of every band is matched, so that whatever lies in the "
            "relations of "
            "bands, edges above all, is random (Heeger and Bergen 1995, section 6).",
            "msg": "69 numbers keep the spectrum and the gray levels; the phase, which makes edges and "
            "objects, is "
            "random (Navarro and Portilla 1996, section 4).",
            "de-bonet": "With large thresholds candidates match that do not belong together, so that "
            "structure comes "
            "apart (De Bonet 1997, section 4.3).",
            "efros-leung": "A window smaller than the texture's elements does not see how they go on (Efros "
            "and Leung "
            "1999, section 3).",
        },
        remedies={
            "": (EFROS, DE_BONET),
            "de-bonet": (
                multiply("alpha", 0.5, "Halve α to {value}: fewer candidates, which fit better.", least=0.05),
                put("channels", "all", "Let all channels constrain."),
                EFROS,
            ),
            "efros-leung": (
                multiply("window", 1.5, "Use a larger window, {value} px, which sees whole elements.", most=31),
                multiply("tau", 0.5, "Halve τ to {value} gray levels.", least=1.0),
                DE_BONET,
            ),
        },
        order=10,
    )
)
register(
    Detector(
        id="dependence-lost",
        title="Dependence lost",
        summary="Fine details stand where coarse ones do not ask for them: every band was made alone.",
        measures=("dependence-difference",),
        see=_dependence,
        why={
            "": "Every band is made without asking the others: the independence assumption (Forsyth and Ponce, "
            "section 11.3.2).",
            "heeger-bergen": "Every band is matched without asking the others: the independence assumption "
            "(Heeger "
            "and Bergen 1995, section 6; Forsyth and Ponce, section 11.3.2).",
            "msg": "The phases of all channels are random, so that fine and coarse waves do not meet at edges "
            "(Navarro and Portilla 1996, section 4).",
        },
        remedies={"": (DE_BONET,)},
        methods=BANDS_ALONE,
        order=15,
    )
)
