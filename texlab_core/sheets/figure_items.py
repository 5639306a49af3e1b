"""What a figure sheet is drawn of: words, pictures and boxes on a page, in points from the top left."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from texlab_core.sheets.typeface import Weight

CM = 72 / 2.54
Ink = tuple[int, int, int]
INK: Ink = (24, 24, 24)


@dataclass(frozen=True, slots=True)
class Words:
    """A line of text: left end of its base line in points from the top left, and how it is written."""

    x: float
    y: float
    text: str
    size: float
    weight: Weight = "regular"
    ink: Ink = INK


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """A picture: left, top, width and height in points, and (H, W, 1 | 3) uint8."""

    x: float
    y: float
    width: float
    height: float
    pixels: NDArray[np.uint8]


@dataclass(frozen=True, slots=True)
class Box:
    """A filled rectangle: left, top, width and height in points."""

    x: float
    y: float
    width: float
    height: float
    ink: Ink


@dataclass(frozen=True, eq=False)
class Page:
    """What is drawn, in points.

    Parameters
    ----------
    width, height
        Of the page.
    items
        In the order of drawing.
    title
        Of the document.
    texts
        What the file carries beside, JSON by key.
    """

    width: float
    height: float
    items: tuple[Words | Picture | Box, ...]
    title: str
    texts: Mapping[str, str] = field(default_factory=dict)

    @property
    def words(self) -> tuple[Words, ...]:
        """The lines of text."""
        return tuple(each for each in self.items if isinstance(each, Words))
