"""Where words stand in a plot: near their points, inside, and never over each other; no Qt here."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

# How far from its point a label may stand, in its own heights; what is farther seems to belong to another one.
FARTHEST = 6


@dataclass(frozen=True)
class Label:
    """Words that are to stand at a point.

    Parameters
    ----------
    x, y
        The point, in pixels from the upper left corner of the plot.
    width, height
        Of the words, in pixels.
    anchor
        Which part of the words lies at the point, 0 .. 1 from the left and from the top.
    """

    x: float
    y: float
    width: float
    height: float
    anchor: tuple[float, float] = (0.0, 1.0)


def place_labels(labels: Sequence[Label], room: tuple[float, float]) -> list[tuple[float, float] | None]:
    """Return left and top for each label, None where it is too large or would cover one before it.

    Parameters
    ----------
    labels
        The most important ones first.
    room
        Width and height of the plot.
    """
    taken: list[tuple[float, float, float, float]] = []
    found: list[tuple[float, float] | None] = []
    for label in labels:
        fits = label.width <= room[0] and label.height <= room[1]
        places = _places(label, room) if fits else iter(())
        place = next((each for each in places if not _covers(each, label, taken)), None)
        found.append(place)
        if place is not None:
            taken.append((*place, place[0] + label.width, place[1] + label.height))
    return found


def _places(label: Label, room: tuple[float, float]) -> Iterator[tuple[float, float]]:
    """Yield the wanted place, then others around the point, the nearest first."""
    across, down = label.anchor
    wanted = label.x - across * label.width, label.y - down * label.height
    yield _inside(wanted, label, room)
    # On either side of the point, and over or under it, by halves of its height.
    lefts = [label.x - part * label.width for part in (across, 1 - across, 0.5)]
    steps = range(-2 * FARTHEST, 2 * FARTHEST + 1)
    tops = [label.y - down * label.height + step * label.height / 2 for step in steps]
    others = {_inside((left, top), label, room) for left in lefts for top in tops}
    yield from sorted(others, key=lambda each: (math.hypot(each[0] - wanted[0], each[1] - wanted[1]), each))


def _inside(place: tuple[float, float], label: Label, room: tuple[float, float]) -> tuple[float, float]:
    left = min(max(place[0], 0.0), room[0] - label.width)
    top = min(max(place[1], 0.0), room[1] - label.height)
    return left, top


def _covers(place: tuple[float, float], label: Label, taken: Sequence[tuple[float, float, float, float]]) -> bool:
    left, top = place
    right, bottom = left + label.width, top + label.height
    return any(left < r and x < right and top < b and y < bottom for x, y, r, b in taken)
