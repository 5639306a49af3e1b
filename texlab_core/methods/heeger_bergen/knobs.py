"""The knobs that solids and mixtures have too."""

from __future__ import annotations

from texlab_core.engine.params import Knob

ITERATIONS = Knob(
    help="Rounds of matching all subbands, then the pixels; 0 leaves noise of the exemplar's colours.",
    low=0,
    high=50,
    linear_to=10,
    group="Synthesis",
    source="Heeger and Bergen 1995, section 2.3",
)
SCALES = Knob(
    help="Levels of the pyramid; structure larger than about 2^scales pixels is lost.",
    low=0,
    high=8,
    stage="analysis",
    group="Pyramid",
)
ORIENTATIONS = Knob(help="Oriented bands at each level.", low=1, high=18, stage="analysis", group="Pyramid")
BORDER = Knob(
    help="How the exemplar is taken to go on beyond its borders.",
    choices={
        "reflect": "mirrored",
        "periodic": "repeated, without the smooth part that makes it jump at the borders",
        "wrap": "repeated as it is: jumps at the borders look like texture",
    },
    stage="analysis",
    group="Pyramid",
    source="Heeger and Bergen 1995, section 2.4",
)
