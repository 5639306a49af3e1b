"""Parameters of solid textures."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Literal

from texlab_core.engine.params import Knob, Params
from texlab_core.methods.heeger_bergen.analysis import Border
from texlab_core.methods.heeger_bergen.knobs import BORDER, ITERATIONS, ORIENTATIONS, SCALES


@dataclass(frozen=True, kw_only=True)
class SolidParams(Params):
    """Parameters of solid textures."""

    iterations: Annotated[
        int,
        replace(
            ITERATIONS,
            help="Rounds of matching all subbands, then the voxels; 0 leaves noise of the exemplar's colours.",
            high=20,
        ),
    ] = 5
    histograms: Annotated[
        Literal["pooled", "per-slice"],
        Knob(
            help="Over what the histogram of a slice's subband is taken.",
            choices={
                "pooled": "over all slices across an axis; what is coarser than all bands is left as it is",
                "per-slice": "over each slice alone, the coarsest part too: this leaves streaks along the axes",
            },
            group="Synthesis",
            source="Heeger and Bergen 1995, section 3",
            when=("kind", ("mixed",)),
        ),
    ] = "pooled"
    balance: Annotated[
        bool,
        Knob(
            help="Correct every round until all subbands are nearer to the exemplar's than those of noise. Off "
            "leaves the rounds as in the paper: some subbands then end farther off than they began.",
            group="Synthesis",
            when=("histograms", ("pooled",)),
            formerly=False,
        ),
    ] = True
    kind: Annotated[
        Literal["laplacian", "mixed"],
        Knob(
            help="The subbands whose histograms are matched.",
            choices={
                "laplacian": "the scales of the solid: quick; grain without direction",
                "mixed": "also the scales and orientations of all its slices along the three axes",
            },
            stage="analysis",
            group="Pyramid",
            source="Heeger and Bergen 1995, section 3",
        ),
    ] = "laplacian"
    scales: Annotated[
        int,
        replace(
            SCALES, help="Levels of the pyramids; structure larger than about 2^scales voxels is lost.", high=7
        ),
    ] = 4
    orientations: Annotated[
        int,
        replace(ORIENTATIONS, help="Oriented bands at each level of the slices.", when=("kind", ("mixed",))),
    ] = 4
    border: Annotated[Border, BORDER] = "reflect"
