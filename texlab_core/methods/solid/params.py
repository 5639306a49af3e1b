"""Parameters of solid textures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from texlab_core.engine.params import Knob, Params


@dataclass(frozen=True, kw_only=True)
class SolidParams(Params):
    """Parameters of solid textures."""

    iterations: Annotated[
        int,
        Knob(
            help="Rounds of matching all subbands, then the voxels; 0 leaves noise of the exemplar's colours.",
            low=0,
            high=20,
            linear_to=10,
            group="Synthesis",
            source="Heeger and Bergen 1995, section 2.3",
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
        Knob(
            help="Levels of the pyramids; structure larger than about 2^scales voxels is lost.",
            low=0,
            high=7,
            stage="analysis",
            group="Pyramid",
        ),
    ] = 4
    orientations: Annotated[
        int,
        Knob(
            help="Oriented bands at each level of the slices.",
            low=1,
            high=18,
            stage="analysis",
            group="Pyramid",
            when=("kind", ("mixed",)),
        ),
    ] = 4
    border: Annotated[
        Literal["reflect", "periodic", "wrap"],
        Knob(
            help="How the exemplar is taken to go on beyond its borders.",
            choices={
                "reflect": "mirrored",
                "periodic": "repeated, without the smooth part that makes it jump at the borders",
                "wrap": "repeated as it is: jumps at the borders look like texture",
            },
            stage="analysis",
            group="Pyramid",
            source="Heeger and Bergen 1995, section 2.4",
        ),
    ] = "reflect"
