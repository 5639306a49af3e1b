"""Failures that the papers name, ready to be made: exemplar, method, parameters, what to look at, and why."""

from __future__ import annotations

import functools
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.errors import ParamError
from texlab_core.files.wording import did_you_mean
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from texlab_core.engine.inputs import ImageInput


@dataclass(frozen=True, kw_only=True)
class Failure:
    """One example.

    Parameters
    ----------
    name
        Lower-case words with hyphens: its name on the command line.
    title
        For people.
    exemplar
        A texture of the gallery, without ``gallery:``.
    method
        Id of the method.
    params
        What differs from its defaults.
    middle
        Side of the square in the middle of the exemplar that is used; None for the whole.
    look
        What to look at, one sentence.
    why
        Why it fails, one sentence with the section of the paper.
    finding
        Id of the finding that names it.
    shows
        False for the counterpart on which the finding must not appear.
    size
        Height and width of the result.
    """

    name: str
    title: str
    exemplar: str
    method: str
    look: str
    why: str
    finding: str
    params: Mapping[str, Any] = field(default_factory=dict)
    middle: int | None = None
    shows: bool = True
    size: tuple[int, int] = (256, 256)

    @property
    def source(self) -> str:
        """The exemplar as ``gallery:NAME``."""
        return f"gallery:{self.exemplar}"

    def image(self, should_stop: Callable[[], bool] | None = None) -> ImageInput:
        """Return the exemplar, or the part of it that is used."""
        if self.middle is None:
            return as_exemplar(self.source, should_stop=should_stop)
        height, width = as_exemplar(self.source, should_stop=should_stop).size
        side = self.middle
        crop = Crop((height - side) // 2, (width - side) // 2, side, side)
        return as_exemplar(self.source, crop=crop, should_stop=should_stop)

    def job(self, size: tuple[int, ...] | None = None, should_stop: Callable[[], bool] | None = None) -> Job:
        """Return the job that makes it, at another size if one is given."""
        params = find_method(self.method).params.from_json(dict(self.params))
        return Job(
            method=self.method,
            inputs={"exemplar": self.image(should_stop)},
            params=params,
            size=self.size if size is None else size,
        )

    def to_json(self) -> dict[str, Any]:
        """Return everything as JSON data."""
        height, width = self.size
        return {
            "name": self.name,
            "title": self.title,
            "exemplar": self.source,
            "middle": self.middle,
            "method": self.method,
            "parameters": dict(self.params),
            "size": {"width": width, "height": height},
            "look_at": self.look,
            "why": self.why,
            "finding": self.finding,
            "shows": self.shows,
        }


_HB, _DB, _EL, _MSG = "heeger-bergen", "de-bonet", "efros-leung", "msg"

_EXAMPLES = (
    Failure(
        name="wood-grain",
        title="Wood grain",
        exemplar="oriented-woodgrain",
        method=_HB,
        look="The long lines of the grain are broken into short strokes.",
        why="Long lines are made of many coefficients that agree; each band is matched without asking its "
        "neighbours "
        "(Heeger and Bergen 1995, section 6: wood grain).",
        finding="structure-lost",
    ),
    Failure(
        name="coral",
        title="Coral",
        exemplar="structured-coral",
        method=_HB,
        look="Branches lose their outlines and become an even grain.",
        why="Outlines need fine details to stand where coarse ones do (Heeger and Bergen 1995, section 6: coral).",
        finding="dependence-lost",
    ),
    Failure(
        name="dots-in-lines",
        title="Dots in lines",
        exemplar="structured-dotlines",
        method=_HB,
        look="Dots no longer stand in rows, and some run together.",
        why="No histogram of a band says that dots stand in lines (Heeger and Bergen 1995, section 6).",
        finding="structure-lost",
    ),
    Failure(
        name="hay",
        title="Hay",
        exemplar="oriented-hay",
        method=_HB,
        look="Stalks have no beginning and no end, and do not lie over one another.",
        why="Which stalk lies above is a relation between bands, and those are random (Heeger and Bergen 1995, "
        "section 6: hay).",
        finding="dependence-lost",
    ),
    Failure(
        name="fur",
        title="Fur",
        exemplar="oriented-fur",
        method=_HB,
        look="Hairs no longer turn together; all directions are mixed everywhere.",
        why="One histogram for each direction stands for all places (Heeger and Bergen 1995, section 6).",
        finding="dependence-lost",
    ),
    Failure(
        name="marble",
        title="Marble",
        exemplar="stochastic-marble",
        method=_HB,
        look="The sharp veins become clouds.",
        why="A vein is an edge, where all scales agree; matched alone they do not (Heeger and Bergen 1995, "
        "section 6: marble).",
        finding="structure-lost",
    ),
    Failure(
        name="inhomogeneous-seeds",
        title="Seeds that grow",
        exemplar="inhomogeneous-seedgradient",
        method=_HB,
        look="Large and small seeds are mixed everywhere; compare with even-seeds.",
        why="One histogram stands for all places, so that what differs from place to place is mixed (Heeger and "
        "Bergen 1995, section 6: inhomogeneous input).",
        finding="inhomogeneous-exemplar",
    ),
    Failure(
        name="even-seeds",
        title="Even seeds",
        exemplar="structured-seeds",
        method=_HB,
        look="The counterpart: the same seeds, all alike. The grain is even, and nothing is said of the exemplar.",
        why="The exemplar is the same texture everywhere, as the method takes it to be (Heeger and Bergen 1995, "
        "section 6).",
        finding="inhomogeneous-exemplar",
        shows=False,
    ),
    Failure(
        name="colours",
        title="Colours that were not there",
        exemplar="structured-coral",
        method=_HB,
        look="Greenish and violet tints between the exemplar's colours.",
        why="Colour axes that are decorrelated are not independent; matched apart they meet in new colours "
        "(Heeger "
        "and Bergen 1995, section 3.5).",
        finding="invented-colours",
    ),
    Failure(
        name="mirror-symmetry",
        title="Mirror symmetry",
        exemplar="failure-mirror",
        method=_DB,
        look="Both halves of the figure are made apart, and no axis is left.",
        why="Mirror symmetry is no feature of a parent structure (De Bonet 1997, section 5).",
        finding="symmetry",
    ),
    Failure(
        name="rotational-symmetry",
        title="Rotational symmetry",
        exemplar="failure-rosettes",
        method=_DB,
        middle=128,
        look="Discs do not close: their parts come from different places.",
        why="Rotational symmetry is no feature of a parent structure, and a disc as large as the exemplar is seen "
        "once only (De Bonet 1997, section 5).",
        finding="small-exemplar",
    ),
    Failure(
        name="change-of-size",
        title="Progressive change of size",
        exemplar="failure-sizegradient",
        method=_DB,
        look="Large dots stand beside small ones; they no longer grow from left to right.",
        why="Candidates are compared without their place, so that a progressive change is lost (De Bonet 1997, "
        "section 5).",
        finding="inhomogeneous-exemplar",
    ),
    Failure(
        name="change-of-colour",
        title="Progressive change of colour",
        exemplar="failure-colourgradient",
        method=_DB,
        look="Patches of red and blue instead of a run from red to blue.",
        why="Candidates are compared without their place, so that a progressive change is lost (De Bonet 1997, "
        "section 5).",
        finding="inhomogeneous-exemplar",
    ),
    Failure(
        name="letters",
        title="Letters",
        exemplar="letters-scattered",
        method=_DB,
        look="Strokes of different letters are put together; hardly one can be read.",
        why="A letter is right or wrong as a whole, and parent structures see parts (De Bonet 1997, section 5).",
        finding="letters",
    ),
    Failure(
        name="symbols",
        title="Symbols",
        exemplar="failure-symbols",
        method=_DB,
        look="Symbols are cut and mended with parts of others.",
        why="A symbol is right or wrong as a whole, and parent structures see parts (De Bonet 1997, section 5).",
        finding="letters",
    ),
    Failure(
        name="small-thresholds",
        title="Thresholds too small",
        exemplar="stochastic-gravel",
        method=_DB,
        params={"alpha": 0.02},
        look="Whole stones stand as in the exemplar; between pieces there are seams.",
        why="With small thresholds a location matches only itself, and its neighbours come along (De Bonet 1997, "
        "figs. 11 and 12).",
        finding="alpha-range",
    ),
    Failure(
        name="large-thresholds",
        title="Thresholds too large",
        exemplar="stochastic-gravel",
        method=_DB,
        params={"alpha": 1.0},
        look="Stones fall apart into grain.",
        why="With large thresholds nearly everything matches, and neighbours come from different places (De Bonet "
        "1997, figs. 11 and 12).",
        finding="alpha-range",
    ),
    Failure(
        name="shifted-copies",
        title="Shifted copies",
        exemplar="quasiperiodic-brick",
        method=_DB,
        params={"coarsest": "shift"},
        middle=96,
        size=(192, 192),
        look="Four copies of the exemplar, with a cross of straight cuts between them.",
        why="The coarsest level is the exemplar's, repeated, and the finer ones follow it (De Bonet 1997, section "
        "4.3).",
        finding="cuts",
    ),
    Failure(
        name="gabor-structure",
        title="Structure and the spectrum",
        exemplar="structured-pebbles",
        method=_MSG,
        look="Grain of the right coarseness, but no stones.",
        why="Phase makes objects, and it is random (Navarro and Portilla 1996, section 4).",
        finding="structure-lost",
    ),
    Failure(
        name="gabor-peaks",
        title="Peaks between the centres",
        exemplar="oriented-canefence",
        method=_MSG,
        look="The slats have another width: their period moved to that of the nearest channel.",
        why="Emergent frequencies shift toward the nearest centre of the channels, which lie an octave apart "
        "(Navarro "
        "and Portilla 1996, section 4).",
        finding="peaks-moved",
    ),
    Failure(
        name="gabor-letters",
        title="Letters and the spectrum",
        exemplar="letters-page",
        method=_MSG,
        look="Lines of something like writing, without a single letter, and not as many lines.",
        why="Letters vanish even with the whole spectrum, since phase makes them; the period of the lines "
        "moves to "
        "the nearest channel (Navarro and Portilla 1996, section 4).",
        finding="structure-lost",
    ),
    Failure(
        name="growing-garbage",
        title="Growing garbage",
        exemplar="quasiperiodic-brick",
        method=_EL,
        params={"window": 5},
        middle=96,
        size=(128, 128),
        look="Growth slipped into one kind of place and goes on with it.",
        why="A pixel that fits badly is part of the next windows, which fit worse (Efros and Leung 1999, "
        "section 3).",
        finding="garbage",
    ),
    Failure(
        name="verbatim-copying",
        title="Verbatim copying",
        exemplar="stochastic-gravel",
        method=_EL,
        params={"tau": 0.0},
        middle=96,
        size=(128, 128),
        look="Large parts of the exemplar stand in the result as they are.",
        why="Once a window is found exactly nothing else matches, and the exemplar goes on (Efros and Leung 1999, "
        "section 3).",
        finding="tau-range",
    ),
    Failure(
        name="small-window",
        title="Window too small",
        exemplar="structured-pebbles",
        method=_EL,
        params={"window": 5},
        middle=96,
        size=(128, 128),
        look="Pebbles lose their outlines, since a window of five pixels does not see a whole one.",
        why="A window smaller than the texture's elements does not see how they go on (Efros and Leung 1999, "
        "section "
        "3; Forsyth and Ponce, Fig. 11.22).",
        finding="structure-lost",
    ),
    Failure(
        name="large-tau",
        title="Threshold too large for the contrast",
        exemplar="stochastic-gravel",
        method=_EL,
        params={"tau": 40.0},
        middle=96,
        size=(128, 128),
        look="Grain without stones: nearly every place matches.",
        why="Whatever differs by less than τ matches, and a good part of the contrast is less than that "
        "(Forsyth and "
        "Ponce, section 11.3.4).",
        finding="tau-range",
    ),
    Failure(
        name="tiling",
        title="Tiling",
        exemplar="structured-coffeebeans",
        method="tiling",
        middle=96,
        look="A straight seam at every border, and the same beans again and again.",
        why="Repeating is all that this method does (De Bonet 1997, fig. 2).",
        finding="repetition",
    ),
    Failure(
        name="independent-pixels",
        title="Independent pixels",
        exemplar="stochastic-gravel",
        method="pixels",
        look="The right colours, and nothing else.",
        why="Every pixel is drawn alone (De Bonet 1997, fig. 3).",
        finding="noise",
    ),
    Failure(
        name="independent-bands",
        title="Independent bands",
        exemplar="structured-pebbles",
        method="bands",
        look="Grain at every scale, and no edge.",
        why="Every band is drawn alone (De Bonet 1997, fig. 4).",
        finding="dependence-lost",
    ),
)


@functools.cache
def examples() -> Mapping[str, Failure]:
    """Return all examples by name, in their order: those of one method together."""
    return MappingProxyType({each.name: each for each in _EXAMPLES})


def find_example(name: str) -> Failure:
    """Return the example with this name.

    Raises
    ------
    ParamError
        When there is none; the message lists the names.
    """
    known = examples()
    if name in known:
        return known[name]
    close = did_you_mean(name, known)
    hint = f" ({close})" if close else ""
    raise ParamError("failure", f"one of {', '.join(known)}{hint}", name)
