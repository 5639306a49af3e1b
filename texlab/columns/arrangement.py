"""How many rows the pictures stand in: those that make them largest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Mapping

Rows = Literal["largest", "one", "two"]
# Two lines below the picture, one line below it, or beside it.
Words = Literal["below", "line", "beside"]
SPACING = 4
# Below this nothing can be read any more: the stage scrolls instead.
LEAST_PICTURE = 120


@dataclass(frozen=True)
class Frame:
    """What a cell shows around its picture.

    Parameters
    ----------
    width, height
        In pixels.
    least
        Narrower cells cannot show it like this.
    """

    width: int
    height: int
    least: int = 0

    def joined(self, other: Frame) -> Frame:
        """Return the frame that has room for both."""
        return Frame(max(self.width, other.width), max(self.height, other.height), max(self.least, other.least))


@dataclass(frozen=True)
class Arrangement:
    """Equal cells in rows.

    Parameters
    ----------
    rows, columns
        The last row may be shorter.
    width, height
        Of one cell, in pixels.
    words
        Where the words about the picture stand.
    """

    rows: int
    columns: int
    width: int
    height: int
    words: Words

    @property
    def total(self) -> tuple[int, int]:
        """Width and height of all cells."""
        return (
            self.columns * (self.width + SPACING) - SPACING,
            self.rows * (self.height + SPACING) - SPACING,
        )

    def cell(self, place: int) -> tuple[int, int, int, int]:
        """Return x, y, width and height of the cell at a place, 0, 1, ... row by row."""
        row, column = divmod(place, self.columns)
        return column * (self.width + SPACING), row * (self.height + SPACING), self.width, self.height

    def place_at(self, x: float, y: float, count: int) -> int:
        """Return the place, 0 .. ``count`` - 1, whose cell is nearest to a point."""
        column = min(max(int(x // (self.width + SPACING)), 0), self.columns - 1)
        row = min(max(int(y // (self.height + SPACING)), 0), self.rows - 1)
        return min(row * self.columns + column, count - 1)


def arrange(
    count: int,
    room: tuple[int, int],
    frames: Mapping[Words, Frame],
    aspect: float = 1.0,
    rows: Rows = "largest",
) -> Arrangement:
    """Return the arrangement with the largest pictures.

    Parameters
    ----------
    count
        Number of cells, at least 1.
    room
        Width and height of the stage in pixels. Where the smallest readable pictures need more, they get it.
    frames
        What a cell needs around its picture by where its words stand; "below" is among them.
    aspect
        Width over height of the pictures.
    rows
        ``one`` or ``two`` leave no choice of the rows.

    Raises
    ------
    ValueError
        When there is nothing to arrange, or the words have no place.
    """
    if count < 1:
        raise ValueError(f"There must be at least one cell, got {count}.")
    numbers = {"largest": range(1, count + 1), "one": (1,), "two": (min(2, count),)}[rows]
    best: Arrangement | None = None
    best_side = -1.0
    for number in numbers:
        columns = -(-count // number)
        used = -(-count // columns)
        width = (room[0] + SPACING) // columns - SPACING
        height = (room[1] + SPACING) // used - SPACING
        for words, frame in frames.items():
            side = min((width - frame.width) / aspect, height - frame.height)
            if width < frame.least:
                continue
            if side > best_side or best is None:
                least_width = frame.width + LEAST_PICTURE
                least_height = frame.height + LEAST_PICTURE
                best = Arrangement(used, columns, max(width, least_width), max(height, least_height), words)
                best_side = side
    if best is None:
        raise ValueError("There must be a frame that fits any width.")
    return best
