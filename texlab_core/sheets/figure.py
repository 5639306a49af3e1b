"""Figure sheets for print: panels with captions, laid out in points on one page for PDF and SVG."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from texlab_core.errors import ImageError, InputError, ParamError
from texlab_core.files.wording import printable
from texlab_core.sheets.contact_sheet import picture_bytes, series_columns
from texlab_core.sheets.figure_items import CM, INK, Box, Page, Picture, Words
from texlab_core.sheets.typeface import Typeface, typeface

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from texlab_core.sheets.contact_sheet import Tile

FIGURE_SUFFIXES = (".pdf", ".svg")
# The largest page that PDF readers must take (ISO 32000-1, annex C).
_MOST_POINTS = 14400.0
_LINE, _SMALL_GAP = 1.3, 0.5
_PALE_INK, _EMPTY = (88, 88, 88), (232, 232, 232)


@dataclass(frozen=True, slots=True)
class Figure:
    """How a figure sheet looks.

    Parameters
    ----------
    width
        Of the page in cm, 2 to 100: that of the column it is printed in.
    dpi
        Pictures finer than this at their printed size are reduced to it by area averaging, 36 to 2400.
    points
        Size of the captions, 4 to 24 points.
    columns
        Pictures in a row, from 1; None takes the sheet's own.
    letters
        Whether panels are called (a), (b), ...
    captions
        Whether panels say what they are.
    bar
        Pixels of the scale bar, from 1; 0 draws none, None about a quarter of the widest picture.

    Raises
    ------
    ParamError
        When a value is out of range.
    """

    width: float = 17.0
    dpi: float = 300.0
    points: float = 8.0
    columns: int | None = None
    letters: bool = True
    captions: bool = True
    bar: int | None = None

    def __post_init__(self) -> None:
        for name, low, high in (("width", 2, 100), ("dpi", 36, 2400), ("points", 4, 24)):
            value = getattr(self, name)
            if not low <= value <= high:
                raise ParamError(name, f"a number from {low} to {high}", value)
        if self.columns is not None and self.columns < 1:
            raise ParamError("columns", "a whole number from 1", self.columns)
        if self.bar is not None and self.bar < 0:
            raise ParamError("bar", "a whole number of pixels from 0", self.bar)


def is_figure(path: str | os.PathLike[str]) -> bool:
    """Return whether a name asks for a figure sheet."""
    return Path(path).suffix.lower() in FIGURE_SUFFIXES


def letter(index: int) -> str:
    """Return the name of a panel: (a) to (z), then (aa), (ab), ..."""
    text, rest = "", index + 1
    while rest:
        rest, place = divmod(rest - 1, 26)
        text = chr(97 + place) + text
    return f"({text})"


def figure_page(
    tiles: Sequence[Tile],
    look: Figure,
    *,
    columns: int | None = None,
    title: Sequence[str] = (),
    column_heads: Sequence[str] = (),
    row_heads: Sequence[str] = (),
    texts: Mapping[str, str] | None = None,
) -> Page:
    """Lay out pictures row by row on a page as wide as asked for and as high as needed.

    All pictures have one scale, so that they can be held against each other.

    Parameters
    ----------
    tiles
        The pictures, row by row.
    look
        How it looks.
    columns
        Pictures in a row, unless ``look`` says it; one row up to six when None.
    title
        Lines at the top: the first dark and larger, the others pale.
    column_heads, row_heads
        Above each column, left of each row; only for the sheet's own number of columns.
    texts
        What the file carries beside, JSON by key.

    Raises
    ------
    InputError
        When there is nothing to draw, or the columns are too narrow or the page too high for it.
    """
    if not tiles:
        raise InputError("A figure needs at least one picture.")
    own = columns or series_columns(len(tiles))
    across = min(look.columns or own, len(tiles))
    if across != own:
        column_heads, row_heads = (), ()
    plan = _Plan(look, typeface(), typeface("bold"), across, row_heads)
    plan.measure(tiles)
    plan.write_title(title)
    plan.write_heads(column_heads)
    for first in range(0, len(tiles), across):
        plan.draw_row(tiles[first : first + across], first, row_heads)
    plan.draw_bar()
    if plan.y > _MOST_POINTS:
        raise InputError(
            f"The figure would be {plan.y / CM:.0f} cm high, and a page has at most {_MOST_POINTS / CM:.0f} cm; "
            "ask for more columns or fewer pictures."
        )
    shown = printable(" - ".join(title) or ", ".join(tiles[0].caption[:2]) or "TexLab", 400)
    return Page(look.width * CM, plan.y, tuple(plan.items), shown, dict(texts or {}))


class _Plan:
    """A page that grows downwards."""

    def __init__(
        self, look: Figure, regular: Typeface, bold: Typeface, columns: int, row_heads: Sequence[str]
    ) -> None:
        self.look, self.regular, self.bold, self.columns = look, regular, bold, columns
        self.size = look.points
        self.line = _LINE * look.points
        self.gap = look.points
        self.items: list[Words | Picture | Box] = []
        self.y = 0.0
        page = look.width * CM
        self.left = max((regular.width(text, self.size) + self.gap for text in row_heads), default=0.0)
        self.cell = (page - self.left - (columns - 1) * self.gap) / columns
        if self.cell < 2 * look.points:
            raise InputError(
                f"{columns} columns do not fit {look.width:g} cm at {look.points:g} points; ask for fewer "
                "columns, a wider page or smaller letters."
            )

    def measure(self, tiles: Sequence[Tile]) -> None:
        """Find the scale at which the widest picture fills a column."""
        shapes = [tile.image.shape[:2] for tile in tiles if tile.image is not None]
        self.widest = max((width for _, width in shapes), default=0)
        self.scale = self.cell / self.widest if shapes else 1.0
        self.tallest = max((height for height, _ in shapes), default=0) * self.scale or self.cell / 2

    def write(self, x: float, lines: Sequence[str], *, size: float | None = None, pale: bool = False) -> None:
        """Write lines below each other and go down."""
        size = self.size if size is None else size
        for text in lines:
            self.y += _LINE * size
            # The base line stands a fifth of the line above its lower end.
            self.items.append(
                Words(
                    x, self.y - 0.3 * size, self.regular.shown(text), size, "regular", _PALE_INK if pale else INK
                )
            )

    def write_title(self, title: Sequence[str]) -> None:
        """Write the lines at the top."""
        width = self.look.width * CM
        for number, text in enumerate(title):
            size = self.size * (1 if number else 1.25)
            self.write(0.0, self.regular.wrap(printable(text, 2000), size, width), size=size, pale=number > 0)
        if title:
            self.y += _SMALL_GAP * self.gap

    def write_heads(self, heads: Sequence[str]) -> None:
        """Write what stands above the columns."""
        top = deepest = self.y
        for column, text in enumerate(heads):
            self.y = top
            self.write(self._x(column), self.regular.wrap(text, self.size, self.cell))
            deepest = max(deepest, self.y)
        self.y = deepest + (_SMALL_GAP * self.gap if heads else 0.0)

    def draw_row(self, tiles: Sequence[Tile], first: int, row_heads: Sequence[str]) -> None:
        """Draw a row of panels with what is said below them."""
        heights = [0.0 if tile.image is None else tile.image.shape[0] * self.scale for tile in tiles]
        # A row as high as its pictures; a place that only has a message is as high as the largest picture.
        high = self.tallest if any(tile.message and tile.image is None for tile in tiles) else max(heights)
        top = self.y
        if row_heads:
            self.y = top + high / 2 - self.line / 2
            self.write(0.0, [row_heads[first // self.columns]])
        deepest = top + high
        for column, tile in enumerate(tiles):
            x = self._x(column)
            if tile.image is not None:
                self._draw(x, top, tile)
            elif tile.message:
                self.items.append(Box(x, top, self.cell, high, _EMPTY))
                self.y = top + 0.2 * self.gap
                lines = self.regular.wrap(printable(tile.message, 2000), self.size, self.cell - self.gap)
                self.write(x + self.gap / 2, lines[: max(1, int(high / self.line))])
            self.y = top + high + 0.3 * self.gap
            self._caption(x, tile, first + column)
            deepest = max(deepest, self.y)
        self.y = deepest + self.gap

    def _draw(self, x: float, y: float, tile: Tile) -> None:
        assert tile.image is not None
        height, width = (side * self.scale for side in tile.image.shape[:2])
        pixels = picture_bytes(tile.image, min(1.0, self.look.dpi / 72 * self.scale))
        self.items.append(Picture(x, y, width, height, pixels))

    def _caption(self, x: float, tile: Tile, index: int) -> None:
        lines = [printable(text, 2000) for text in tile.caption if text] if self.look.captions else []
        if not self.look.letters:
            for number, text in enumerate(lines):
                self.write(x, self.regular.wrap(text, self.size, self.cell), pale=number > 0)
            return
        name = letter(index)
        indent = self.bold.width(f"{name} ", self.size)
        self.items.append(Words(x, self.y + self.line - 0.3 * self.size, name, self.size, "bold"))
        for number, text in enumerate(lines or [""]):
            shift = 0.0 if number else indent
            wrapped = self.regular.wrap(text, self.size, self.cell - shift)
            self.write(x + shift, wrapped, pale=number > 0)
        if not any(lines):
            self.y += self.line

    def draw_bar(self) -> None:
        """Draw the scale bar below the panels."""
        pixels = nice_length(self.widest / 4) if self.look.bar is None else self.look.bar
        if not pixels or not self.widest:
            return
        if pixels > self.widest:
            raise ParamError("bar", f"at most {self.widest} pixels, the width of the widest picture", pixels)
        thick = max(0.6, self.size / 8)
        self.items.append(Box(self.left, self.y + self.line / 2 - thick / 2, pixels * self.scale, thick, INK))
        text = "1 pixel" if pixels == 1 else f"{pixels} pixels"
        self.write(self.left + pixels * self.scale + self.gap / 2, [text])
        self.y += 0.3 * self.gap

    def _x(self, column: int) -> float:
        return self.left + column * (self.cell + self.gap)


def nice_length(most: float) -> int:
    """Return the largest of 1, 2, 5, 10, 20, 50, ... that is at most ``most``; 1 for less."""
    if most < 1:
        return 1
    ten = 10 ** math.floor(math.log10(most))
    return int(next(step * ten for step in (5, 2, 1) if step * ten <= most))


def encode_figure(path: str | os.PathLike[str], page: Page) -> bytes:
    """Return the bytes of a figure, as a PDF or an SVG by the ending of its name.

    Raises
    ------
    ImageError
        When the name ends in something else.
    """
    suffix = Path(path).suffix.lower()
    if suffix == ".pdf":
        from texlab_core.sheets.figure_pdf import encode_pdf

        return encode_pdf(page)
    if suffix == ".svg":
        from texlab_core.sheets.figure_svg import encode_svg

        return encode_svg(page)
    raise ImageError(f"{os.fspath(path)}: figures are written as .pdf or .svg, got {suffix!r}.")
