"""A finding: what is wrong, where, why in this method, and what to try."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from collections.abc import Mapping

Certainty = Literal["finding", "look at"]
Place = Literal["result", "exemplar", "bands", "parameters"]
FINDING: Certainty = "finding"
LOOK_AT: Certainty = "look at"
# How a hint begins in reports.
HINT = "Look at this: "


@dataclass(frozen=True, slots=True)
class Region:
    """A rectangle of pixels."""

    top: int
    left: int
    height: int
    width: int

    def to_json(self) -> dict[str, int]:
        """Return the four numbers by name."""
        return {"top": self.top, "left": self.left, "height": self.height, "width": self.width}


@dataclass(frozen=True, slots=True)
class Where:
    """Where it is seen.

    Parameters
    ----------
    place
        In the result, in the exemplar, in bands of frequencies, or in a parameter.
    words
        The same for people ("rows 96 to 127").
    regions
        Rectangles of the result or of the exemplar, the worst first; none for the whole picture.
    bands
        Which ones, in words ("4 px, 45°").
    """

    place: Place
    words: str
    regions: tuple[Region, ...] = ()
    bands: tuple[str, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """Return everything by name."""
        return {
            "place": self.place,
            "words": self.words,
            "regions": [each.to_json() for each in self.regions],
            "bands": list(self.bands),
        }


@dataclass(frozen=True)
class Remedy:
    """What to try.

    Parameters
    ----------
    words
        One sentence.
    params
        Values of the method's knobs by name; empty where no knob of the method helps.
    method
        Another method, by id; empty to stay with this one.
    """

    words: str
    params: Mapping[str, Any] = field(default_factory=dict)
    method: str = ""

    def to_json(self) -> dict[str, Any]:
        """Return everything by name."""
        return {"words": self.words, "params": dict(self.params), "method": self.method or None}


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One thing that is wrong with a result.

    Parameters
    ----------
    id, title
        Of its detector.
    what
        One sentence with its number.
    where
        Where it is seen.
    why
        One sentence: why it happens in this method, with the section of the paper.
    remedy
        What to try.
    certainty
        ``finding`` where at least nine of ten are right on labelled results; ``look at`` for a hint.
    measures
        Ids of the measures that it rests on.
    """

    id: str
    title: str
    what: str
    where: Where
    why: str
    remedy: Remedy
    certainty: Certainty
    measures: tuple[str, ...]

    @property
    def sentence(self) -> str:
        """Title and number on one line, for reports; a hint says that it is one."""
        return self.what if self.certainty == FINDING else f"{HINT}{self.what}"

    def to_json(self) -> dict[str, Any]:
        """Return everything as JSON data, ``remedy`` under the key ``try``."""
        return {
            "id": self.id,
            "title": self.title,
            "what": self.what,
            "where": self.where.to_json(),
            "why": self.why,
            "try": self.remedy.to_json(),
            "certainty": self.certainty,
            "measures": list(self.measures),
        }


def counted(findings: tuple[Finding, ...] | list[Finding]) -> tuple[int, int]:
    """Return how many findings and how many hints there are: they are never added up."""
    sure = sum(each.certainty == FINDING for each in findings)
    return sure, len(findings) - sure
