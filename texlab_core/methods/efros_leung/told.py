"""What only Efros and Leung's method can say of its results: how well the windows were matched."""

from __future__ import annotations

from texlab_core.measures.registry import Measure, register

EXACT_SHARE = register(
    Measure(
        id="exact-share",
        title="exact",
        summary="Share of the pixels whose known surroundings were found in the exemplar without any difference "
        "(d_min = 0): they continue a verbatim copy.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("method",),
        form=".0%",
        order=74,
    )
)
DISTANCE = register(
    Measure(
        id="window-distance",
        title="d_min",
        summary="Mean smallest distance of a pixel's known surroundings from the exemplar, in gray levels "
        "squared for squared differences; it cannot be compared across windows.",
        low=0.0,
        high=1e6,
        better="lower",
        needs=("method",),
        form=".3g",
        order=75,
    )
)
OWN_DISTANCE = register(
    Measure(
        id="own-window-distance",
        title="exemplar's d_min",
        summary="The same for the exemplar's own windows with their place left out: what is usual for it.",
        low=0.0,
        high=1e6,
        better="neither",
        needs=("method",),
        form=".3g",
        part_of="window-distance",
        order=76,
    )
)
GARBAGE = register(
    Measure(
        id="garbage",
        title="garbage",
        summary="Mean smallest distance d_min over the exemplar's own: at 1 the windows are found as well as "
        "its own ones, well above 1 the growth has lost its way. Near chance on gravel and the like.",
        low=0.0,
        high=1e6,
        better="lower",
        needs=("method",),
        form=".2f",
        reference="A. Efros and T. Leung, ICCV 1999, section 3",
        order=45,
    )
)
