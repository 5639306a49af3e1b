"""The parameters of Efros and Leung."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from texlab_core.engine.params import Knob, Params
from texlab_core.methods.efros_leung.fill import Anchor
from texlab_core.methods.efros_leung.windows import (
    FULL_SPREAD,
    Border,
    Criterion,
    Matching,
    Shape,
    TauScale,
    effective_tau,
)

if TYPE_CHECKING:
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.methods.efros_leung.fill import Place


_AROUND = ("shape", ("square", "disc", "cross"))


@dataclass(frozen=True, kw_only=True)
class EfrosLeungParams(Params):
    """Parameters of non-parametric sampling."""

    window: Annotated[
        int,
        Knob(
            help="Side of the window that is compared: about as large as the largest regular feature.",
            low=3,
            high=41,
            odd=True,
            unit="px",
            stage="analysis",
            source="Efros & Leung 1999, section 2.1; Forsyth & Ponce, Fig. 11.22",
            group="Window",
        ),
    ] = 15
    shape: Annotated[
        Shape,
        Knob(
            help="Which pixels around belong to the window.",
            choices={
                "square": "all within the side",
                "disc": "those within the radius",
                "cross": "the row and the column of the pixel",
                "causal": "the rows above and what is left of it; filled row by row",
            },
            stage="analysis",
            source="Forsyth & Ponce, assignment c",
            group="Window",
        ),
    ] = "square"
    criterion: Annotated[
        Criterion,
        Knob(
            help="How two windows are compared.",
            choices={
                "ssd": "squared differences, the middle counts most",
                "flat-ssd": "squared differences, all count the same",
                "sad": "absolute differences, the middle counts most",
                "ncc": "1 - correlation: ignores brightness and contrast",
            },
            stage="analysis",
            source="Forsyth & Ponce, assignment c",
            group="Match set",
        ),
    ] = "ssd"
    eps: Annotated[
        float,
        Knob(
            help="Candidates match up to (1 + eps) times the smallest distance; above 0.3 comes noise.",
            low=0.0,
            high=2.0,
            step=0.01,
            source="Efros & Leung 1999, section 2.1",
            group="Match set",
        ),
    ] = 0.1
    tau: Annotated[
        float,
        Knob(
            help="Whatever differs less than this matches too; 0 copies the exemplar verbatim once it can.",
            low=0.0,
            high=60.0,
            linear_to=20.0,
            step=0.5,
            unit="gray levels",
            source="Forsyth & Ponce, 11.3.4 (the threshold)",
            group="Match set",
        ),
    ] = 3.0
    tau_scale: Annotated[
        TauScale,
        Knob(
            help="What the gray levels of tau are.",
            choices={
                "relative": "fewer for an exemplar of little contrast: in proportion to its spread, in full "
                f"from a standard deviation of {FULL_SPREAD:g} gray levels",
                "absolute": "those of the image, whatever its contrast",
            },
            when=("criterion", ("ssd", "flat-ssd", "sad")),
            formerly="absolute",
            group="Match set",
        ),
    ] = "relative"
    error_limit: Annotated[
        float,
        Knob(
            help="Fill only pixels whose best match differs less; raised by 1.1 when none is left (0: no limit).",
            low=0.0,
            high=100.0,
            step=1.0,
            unit="gray levels",
            source="Efros & Leung 1999, section 2.3",
            group="Order",
            when=_AROUND,
        ),
    ] = 0.0
    border: Annotated[
        Border,
        Knob(
            help="What windows of the exemplar see beyond its border.",
            choices={"inside": "nothing, they lie inside", "periodic": "the exemplar again"},
            stage="analysis",
            group="Borders",
        ),
    ] = "inside"
    tiles: Annotated[
        bool,
        Knob(
            help="Make an output that continues itself when it is laid side by side.",
            group="Borders",
            when=_AROUND,
        ),
    ] = False
    seed_patch: Annotated[
        int,
        Knob(
            help="Side of the patch of the exemplar from which the image grows.",
            low=1,
            high=64,
            unit="px",
            source="Forsyth & Ponce, algorithm 11.6",
            group="Beginning",
        ),
    ] = 3
    anchor: Annotated[
        Anchor,
        Knob(
            help="Where an image that is extended lies in the larger output.",
            choices={
                "center": "in the middle",
                "top-left": "top left",
                "top": "top",
                "top-right": "top right",
                "left": "left",
                "right": "right",
                "bottom-left": "bottom left",
                "bottom": "bottom",
                "bottom-right": "bottom right",
                "at": "so many pixels from the left and from the top",
            },
            group="Beginning",
        ),
    ] = "center"
    left: Annotated[
        int,
        Knob(
            help="Pixels to the left of an image that is extended.",
            low=0,
            high=65535,
            linear_to=256,
            unit="px",
            when=("anchor", ("at",)),
            formerly=0,
            group="Beginning",
        ),
    ] = 0
    top: Annotated[
        int,
        Knob(
            help="Pixels above an image that is extended.",
            low=0,
            high=65535,
            linear_to=256,
            unit="px",
            when=("anchor", ("at",)),
            formerly=0,
            group="Beginning",
        ),
    ] = 0
    reach: Annotated[
        int,
        Knob(
            help="Fill hole by hole, and copy only from so near around each; 0: from everywhere.",
            low=0,
            high=4096,
            linear_to=256,
            unit="px",
            stage="analysis",
            formerly=0,
            group="Beginning",
        ),
    ] = 0

    @property
    def place(self) -> Place:
        """Where an image that is extended lies in the output."""
        return (self.top, self.left) if self.anchor == "at" else self.anchor

    def matching(self, exemplar: ImageInput) -> Matching:
        """Return what decides which candidates of an exemplar match."""
        return Matching(
            window=self.window,
            shape=self.shape,
            criterion=self.criterion,
            eps=self.eps,
            tau=effective_tau(self.tau, self.tau_scale, self.criterion, exemplar.pixels),
            error_limit=self.error_limit,
            border=self.border,
            tiles=self.tiles,
        )
