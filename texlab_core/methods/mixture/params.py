"""Parameters of mixtures, and what a weight means for each kind."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Literal, NamedTuple

from texlab_core.engine.params import Knob, Params
from texlab_core.methods.heeger_bergen.analysis import Border
from texlab_core.methods.heeger_bergen.knobs import BORDER, ITERATIONS, ORIENTATIONS, SCALES

Kind = Literal["average", "palette", "start", "scales"]


def _share(name: str) -> Knob:
    """Return the knob of a further exemplar's share."""
    return Knob(
        help=f"Share of the input {name}, where one is given; the others share the rest.",
        low=0.0,
        high=1.0,
        step=0.05,
        group="Mixture",
        when=("kind", ("average",)),
    )


@dataclass(frozen=True, kw_only=True)
class MixtureParams(Params):
    """Parameters of mixtures."""

    weight: Annotated[
        float,
        Knob(
            help="From the exemplar (0) to the second one (1), each as Heeger and Bergen's method makes it.",
            low=0.0,
            high=1.0,
            step=0.05,
            group="Mixture",
        ),
    ] = 0.5
    kind: Annotated[
        Kind,
        Knob(
            help="What is mixed; the mixture in full is at weight 0.5.",
            choices={
                "average": "everything: subbands, colours and their spread, in these shares",
                "palette": "the colours of the exemplar on the pattern of the second one",
                "start": "the second one is the start instead of noise, and becomes the exemplar's texture",
                "scales": "the coarse scales of the exemplar and the fine ones of the second one",
            },
            group="Mixture",
            source="Heeger and Bergen 1995, section 4",
        ),
    ] = "average"
    cut: Annotated[
        int,
        Knob(
            help="So many levels, from the finest, count as fine.",
            low=1,
            high=8,
            group="Mixture",
            when=("kind", ("scales",)),
        ),
    ] = 2
    third: Annotated[float, _share("third")] = 0.0
    fourth: Annotated[float, _share("fourth")] = 0.0
    iterations: Annotated[
        int,
        replace(
            ITERATIONS,
            help="Rounds of matching all subbands, then the pixels; 1 is often enough for the kind start.",
        ),
    ] = 5
    scales: Annotated[int, SCALES] = 4
    orientations: Annotated[int, ORIENTATIONS] = 4
    border: Annotated[
        Border,
        replace(
            BORDER,
            help="How the exemplars are taken to go on beyond their borders.",
            choices={
                "reflect": "mirrored",
                "periodic": "repeated, without the smooth part that makes them jump at the borders",
                "wrap": "repeated as they are: jumps at the borders look like texture",
            },
        ),
    ] = "reflect"


class Shares(NamedTuple):
    """What comes from the second exemplar, 0 to 1 each.

    Parameters
    ----------
    fine, coarse
        Of the histograms of the fine and of the coarse subbands.
    pixels
        Of the histograms of the colour axes.
    colours
        Of the colours: mean, axes, spread, and histograms of the channels.
    start
        Of the start; the rest is noise.
    """

    fine: float
    coarse: float
    pixels: float
    colours: float
    start: float = 0.0


def shares(kind: Kind, weight: float) -> Shares:
    """Return what a weight means: at 0 all is the exemplar's, at 1 all is the second one's.

    Up to one half, what makes the kind goes over to the second exemplar; from there on, the rest follows.
    """
    first, rest = min(2 * weight, 1.0), max(2 * weight - 1, 0.0)
    if kind == "palette":
        return Shares(first, first, first, rest)
    if kind == "scales":
        return Shares(first, rest, weight, weight)
    if kind == "start":
        return Shares(rest, rest, rest, rest, start=1 - abs(2 * weight - 1))
    return Shares(weight, weight, weight, weight)
