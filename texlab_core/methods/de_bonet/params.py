"""The parameters of De Bonet's multiresolution sampling."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from texlab_core.engine.params import Knob, Params
from texlab_core.methods.de_bonet.choices import (
    COARSEST_SIDE,
    FITTING,
    Channels,
    Coarsest,
    ExemplarBorder,
    FilterSet,
    Fitting,
    Normalization,
)
from texlab_core.methods.de_bonet.thresholds import MAX_K, ThresholdTable


@dataclass(frozen=True, kw_only=True)
class DeBonetParams(Params):
    """Parameters of De Bonet's multiresolution sampling."""

    alpha: Annotated[
        float,
        Knob(
            help="How different two parent structures may be and still count as the same; 0 copies.",
            low=0,
            high=4,
            step=0.005,
            linear_to=0.5,
            source="De Bonet 1997, eq. 13",
            group="Thresholds",
        ),
    ] = 0.15
    beta: Annotated[
        float,
        Knob(
            help="How much stricter fine levels are than coarse ones: T = α / k^β, k = 1 at the coarsest.",
            low=0,
            high=2,
            step=0.05,
            source="De Bonet 1997, eq. 13",
            group="Thresholds",
        ),
    ] = 0.0
    thresholds: Annotated[
        ThresholdTable,
        Knob(
            help="Cells of the threshold table that do not follow the law.",
            source="De Bonet 1997, eq. 11",
            group="Thresholds",
        ),
    ] = ThresholdTable()  # noqa: RUF009 - immutable
    siblings: Annotated[
        Literal["parity", "literal", "mixed"],
        Knob(
            help="Which children of a matching location are candidates.",
            choices={
                "parity": "the one in the same place among its siblings; α = 0 copies exactly",
                "literal": "all four, as printed; shuffles siblings even at α = 0",
                "mixed": "all four on the coarsest levels, the same place on the others",
            },
            source="De Bonet 1997, pseudo-code",
            group="Sampling",
        ),
    ] = "parity"
    literal_levels: Annotated[
        int,
        Knob(
            help="How many of the coarsest sampled levels take all four children.",
            low=1,
            high=MAX_K,
            when=("siblings", ("mixed",)),
            group="Sampling",
        ),
    ] = 1
    coarsest: Annotated[
        Coarsest,
        Knob(
            help="How the coarsest level is laid out; all but patches only in outputs larger than the exemplar.",
            choices={
                "patches": "irregular parts of the exemplar, each from a place that continues its neighbours",
                "fit": "repeated, every repetition shifted cyclically so that it continues its neighbours",
                "shift": "repeated, every repetition shifted cyclically at random; straight cuts show",
                "tile": "repeated as it is, as in the paper; the tiling shows",
                "iid": "every location drawn at random",
            },
            source="De Bonet 1997, section 4.3 (tile)",
            group="Layout",
        ),
    ] = "patches"
    patch: Annotated[
        float,
        Knob(
            help="Width of a patch as a share of the exemplar's shorter side; smaller ones make more that is new.",
            low=0.1,
            high=1,
            step=0.05,
            when=("coarsest", ("patches",)),
            formerly=0.45,
            group="Layout",
        ),
    ] = 0.45
    places: Annotated[
        int,
        Knob(
            help="From how many of the places that continue best one is drawn; 1 takes the best.",
            low=1,
            high=50,
            log=True,
            when=("coarsest", ("patches", "fit")),
            formerly=3,
            group="Layout",
        ),
    ] = 3
    tileable: Annotated[
        bool,
        Knob(
            help="Make an output that continues itself: its opposite sides are neighbours in layout and collapse.",
            group="Layout",
        ),
    ] = False
    uneven: Annotated[
        Literal["fewer", "crop"],
        Knob(
            help="What becomes of a tile whose sides are no multiples of 2^N.",
            choices={
                "fewer": "fewer halvings, so that it tiles",
                "crop": "made at the next multiples and cropped, so that it does not tile",
            },
            when=("tileable", (True,)),
            formerly="crop",
            group="Layout",
        ),
    ] = "fewer"
    coarsest_side: Annotated[int, COARSEST_SIDE] = 8
    fit_filters: Annotated[
        bool,
        Knob(help="Stop the pyramid where the filters no longer fit.", stage="analysis", group="Pyramid"),
    ] = True
    border: Annotated[
        ExemplarBorder,
        Knob(
            help="How the pyramid sees the exemplar beyond its border.",
            stage="analysis",
            choices={
                "reflect": "mirrored",
                "periodic": "repeated",
                "smooth": "repeated, after removing the smooth component that makes opposite borders differ",
            },
            group="Pyramid",
        ),
    ] = "reflect"
    fitting: Annotated[Fitting, FITTING] = "pad"
    pyramid: Annotated[
        Literal["laplacian", "steerable"],
        Knob(
            help="Which bands are sampled.",
            stage="analysis",
            choices={
                "laplacian": "those of the Laplacian pyramid, constrained by derivatives: the paper",
                "steerable": "oriented ones, which are features too: the textbook's algorithm 11.5",
            },
            source="Forsyth & Ponce, algorithm 11.5, assignments a and b",
            formerly="laplacian",
            group="Pyramid",
        ),
    ] = "laplacian"
    bands: Annotated[
        int,
        Knob(
            help="Orientations of the steerable pyramid.",
            low=1,
            high=18,
            stage="analysis",
            when=("pyramid", ("steerable",)),
            source="Forsyth & Ponce, assignment b",
            formerly=4,
            group="Pyramid",
        ),
    ] = 4
    filters: Annotated[
        FilterSet,
        Knob(
            help="Features of a parent structure beside its Laplacian bands.",
            stage="analysis",
            choices={
                "both": "first and second derivatives: edges and lines",
                "first": "first derivatives: edges",
                "second": "second derivatives: lines",
                "laplacian": "none: the paper's counterexample",
            },
            source="De Bonet 1997, section 4.2",
            group="Features",
        ),
    ] = "both"
    orientations: Annotated[
        int,
        Knob(
            help="Directions of each derivative.",
            low=2,
            high=8,
            stage="analysis",
            when=("filters", ("both", "first", "second")),
            group="Features",
        ),
    ] = 4
    filter_size: Annotated[
        int,
        Knob(
            help="Side of the derivative filters; their σ is (size - 1) / 4.",
            low=3,
            high=9,
            unit="px",
            odd=True,
            stage="analysis",
            when=("filters", ("both", "first", "second")),
            group="Features",
        ),
    ] = 5
    channels: Annotated[
        Channels,
        Knob(
            help="Which channels constrain; colours always move together.",
            stage="analysis",
            choices={
                "all": "each channel has its own features, and all of them must match",
                "scaled": "the same, with thresholds multiplied by the number of channels",
                "principal": "features of the exemplar's principal colour axes, those with 5 % of the variance",
                "luminance": "features of the luminance alone",
            },
            group="Features",
        ),
    ] = "all"
    normalization: Annotated[
        Normalization,
        Knob(
            help="What squared feature differences are divided by, Z.",
            stage="analysis",
            choices={
                "variance": "the variance of the feature at its level",
                "level": "one constant per level: the mean variance of its features",
                "range": "the squared range of the feature at its level",
                "sum": "the sum of its squares over all pixels; nearly everything matches",
                "printed": "the size of its sum over all pixels, as printed: positive and negative values cancel, "
                "and chance decides how much matches",
            },
            source="De Bonet 1997, eq. 10",
            group="Features",
        ),
    ] = "variance"

    @property
    def smallest_side(self) -> int:
        """Shorter side that the coarsest level may not fall below."""
        derived = self.pyramid == "laplacian" and self.filters != "laplacian"
        fitted = self.filter_size if self.fit_filters and derived else 1
        return max(self.coarsest_side, fitted)

    def depth(self, exemplar: tuple[int, int]) -> int:
        """Return the number of halvings N for an exemplar of this height and width."""
        from texlab_core.methods.de_bonet.fitting import choose_depth

        return choose_depth(*exemplar, self.smallest_side, self.fitting)
