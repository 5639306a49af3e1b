"""Colours and contrast: invented colours, lost contrast, blotches."""

from __future__ import annotations

from texlab_core.findings.limits import HISTOGRAMS
from texlab_core.findings.regions import densest, everywhere
from texlab_core.findings.registry import Case, Detector, Seen, register
from texlab_core.findings.remedies import multiply, put, say, use
from texlab_core.measures.palette import palette_map, step_of

# Gray levels from which on a new colour can be seen beside the exemplar's.
STRIKING = 10.0


def _colours(case: Case) -> Seen | None:
    if not case.fires():
        return None
    found = palette_map(case.subject)
    striking = found > STRIKING
    where = densest(
        striking if striking.any() else found > 0, case.subject.image.shape[:2], step_of(case.subject.image.shape)
    )
    what = (
        f"Colours were invented: pixels are {case.text('palette-distance')} from the exemplar's nearest colour on "
        f"average, {striking.mean():.1%} of them by more than {STRIKING:g}."
    )
    return Seen(what, where)


def _contrast(case: Case) -> Seen | None:
    if not case.fires():
        return None
    return Seen(
        f"Contrast is lost: within places of 16 x 16 pixels it is {case.text('local-contrast')} of the "
        "exemplar's.",
        everywhere(),
    )


def _blotchy(case: Case) -> Seen | None:
    if not case.fires():
        return None
    return Seen(
        f"Blotches: local contrast is {case.text('local-contrast')} of the exemplar's, which itself drifts "
        "from side "
        f"to side ({case.text('exemplar-drift')} of its contrast).",
        everywhere(),
    )


register(
    Detector(
        id="invented-colours",
        title="Invented colours",
        summary="Colours appear that the exemplar does not have.",
        measures=("palette-distance",),
        see=_colours,
        why={
            "": "Sums of bands or of axes that were made apart give colours that nobody asked for.",
            "heeger-bergen": "The colour axes are decorrelated, not independent; matched one by one they meet in "
            "colours that the exemplar lacks (Heeger and Bergen 1995, section 3.5).",
            "de-bonet": "Bands from different places are added, and where they do not fit the sum is a new colour "
            "(De Bonet 1997, section 4.3).",
        },
        remedies={
            "": (say("Take a method that copies whole pixels, such as Efros-Leung."),),
            "heeger-bergen": (
                put("palette", "transport", "Move all colours onto the exemplar's palette at the end."),
                multiply("iterations", 2.0, "Double the rounds to {value}.", most=20),
            ),
            "de-bonet": (
                multiply("alpha", 0.5, "Halve α to {value}, so that bands fit better.", least=0.05),
                put("border", "smooth", "Let the pyramid see the exemplar as periodic plus smooth."),
            ),
        },
        order=40,
    )
)
register(
    Detector(
        id="contrast-lost",
        title="Contrast lost",
        summary="The result is flatter than the exemplar.",
        measures=("local-contrast",),
        see=_contrast,
        why={
            "": "Contrast of neighbourhoods is no number that is kept, unlike the histogram of the whole.",
            "msg": "Random phases spread energy evenly, so that bright and dark details drown (Navarro and "
            "Portilla "
            "1996, section 4).",
            "efros-leung": "Growth slid into a flat place of the exemplar, whose windows match themselves "
            "(Efros and "
            "Leung 1999, section 3).",
        },
        remedies={
            "": (use("heeger-bergen", "Try Heeger-Bergen, which matches the histogram of every band."),),
            "msg": (put("histogram", "full", "Match the exemplar's histogram in 256 numbers."),),
            "efros-leung": (
                multiply("window", 1.5, "Use a larger window, {value} px.", most=31),
                multiply("tau", 0.5, "Halve τ to {value} gray levels.", least=1.0),
            ),
        },
        order=60,
    )
)
register(
    Detector(
        id="blotchy",
        title="Blotchy",
        summary="Light and dark patches that the exemplar does not have.",
        measures=("exemplar-drift", "local-contrast"),
        see=_blotchy,
        why={
            "": "What changes slowly over the exemplar is taken for texture and spread as patches (Heeger "
            "and Bergen "
            "1995, section 6: inhomogeneous input).",
        },
        remedies={"": (say("Crop the exemplar to an even part, or take out its gradient first."),)},
        methods=HISTOGRAMS,
        order=62,
    )
)
