"""Contact sheets: pictures in a grid with legible captions, as one picture."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage

MAX_SHEET_PIXELS = 64 * 2**20
LARGEST_CELL = 512
_PAPER, _INK, _PALE_INK, _EMPTY = (255, 255, 255), (24, 24, 24), (104, 104, 104), (232, 232, 232)
_MIN_CELL = 88
_GAP = 8


@dataclass(frozen=True, eq=False)
class Tile:
    """One picture of a sheet.

    Parameters
    ----------
    image
        (H, W, C) float32 in [0, 1], C of 1 or 3; None leaves the place empty.
    caption
        Written below it: the first line dark, the others pale.
    message
        Written in its place when there is no image.
    """

    image: FloatImage | None
    caption: tuple[str, ...] = ()
    message: str = ""


def series_columns(count: int) -> int:
    """Return how many columns a series of ``count`` pictures gets: one row up to six, then about 8 to 5."""
    return count if count <= 6 else math.ceil(math.sqrt(1.6 * count))


def check_sheet(cells: int, columns: int, size: tuple[int, int], largest: int = LARGEST_CELL) -> None:
    """Refuse a sheet that would be too large, before its cells are computed.

    Parameters
    ----------
    cells, columns
        Shape of the grid.
    size
        Height and width of the cells' images.
    largest
        Longest side at which they are shown.

    Raises
    ------
    InputError
        When it would have more than 64 megapixels.
    """
    scale = min(1.0, largest / max(size))
    height, width = (max(side * scale, _MIN_CELL) + 3 * _GAP for side in size)
    pixels = math.ceil(cells / columns) * height * columns * width
    if pixels > MAX_SHEET_PIXELS:
        raise InputError(
            f"A sheet of {cells} cells would have {pixels / 2**20:.0f} megapixels, and at most "
            f"{MAX_SHEET_PIXELS // 2**20} are written; ask for fewer or smaller cells."
        )


def contact_sheet(
    tiles: Sequence[Tile],
    columns: int,
    *,
    title: Sequence[str] = (),
    column_heads: Sequence[str] = (),
    row_heads: Sequence[str] = (),
    largest: int = LARGEST_CELL,
    share: float = 0.0,
) -> NDArray[np.uint8]:
    """Draw pictures row by row, each with its caption, on white.

    Parameters
    ----------
    tiles
        The pictures, row by row.
    columns
        Pictures in a row.
    title
        Lines at the top: the first dark and larger, the others pale.
    column_heads, row_heads
        Above each column, left of each row.
    largest
        Longest side at which a picture is shown; when one is larger, all are scaled down together, by area
        averaging.
    share
        Size of the captions as a part of the largest picture's side, for sheets that are read from afar; 0 leaves
        it to :func:`font_size`.

    Returns
    -------
    uint8 array
        (H, W, 3).
    """
    from PIL import Image, ImageDraw

    sides = [max(tile.image.shape[:2]) for tile in tiles if tile.image is not None]
    scale = min(1.0, largest / max(sides, default=1))
    pictures = [None if tile.image is None else _rgb(picture_bytes(tile.image, scale)) for tile in tiles]
    plan = _plan(tiles, pictures, columns, title, column_heads, row_heads, share)
    sheet = Image.new("RGB", plan.size, _PAPER)
    draw = ImageDraw.Draw(sheet)
    pen = plan.pen
    y = _GAP
    for lines, font, ink in plan.titles:
        y = _Pen(draw, font).write((_GAP, y), lines, ink)
    pen.draw = draw
    for column, text in enumerate(column_heads):
        x, y = plan.place(column)
        pen.write((x, y - plan.head_height), pen.wrap(text, plan.width))
    for row, text in enumerate(row_heads):
        pen.write((_GAP, plan.tops[row] + (plan.heights[row] - pen.line) // 2), [text])
    for index, (tile, picture) in enumerate(zip(tiles, pictures, strict=True)):
        x, y = plan.place(index)
        height = plan.heights[index // columns]
        if picture is None and tile.message:
            draw.rectangle((x, y, x + plan.width - 1, y + height - 1), fill=_EMPTY)
            pen.write((x + 4, y + 4), pen.fit(tile.message, plan.width - 8, height - 8))
        elif picture is not None:
            sheet.paste(Image.fromarray(picture), (x, y))
        below = y + height + 4
        for number, text in enumerate(tile.caption):
            below = pen.write((x, below), pen.wrap(text, plan.width), _PALE_INK if number else _INK)
    return np.asarray(sheet).copy()


class _Pen:
    """Writes lines of one font."""

    def __init__(self, draw: Any, font: Any) -> None:
        self.draw = draw
        self.font = font
        self.line = math.ceil(1.35 * font.size)

    def write(self, place: tuple[int, int], lines: Sequence[str], ink: tuple[int, int, int] = _INK) -> int:
        """Write lines below each other and return where the next one would stand."""
        x, y = place
        for text in lines:
            self.draw.text((x, y), text, ink, self.font)
            y += self.line
        return y

    def wrap(self, text: str, width: int) -> list[str]:
        """Break a text between words, and words that are wider than ``width`` after a hyphen or anywhere."""
        lines: list[str] = []
        for word in text.split():
            joined = f"{lines[-1]} {word}" if lines else word
            if lines and self.font.getlength(joined) <= width:
                lines[-1] = joined
                continue
            rest = word
            while len(rest) > 1 and self.font.getlength(rest) > width:
                lengths = range(len(rest) - 1, 0, -1)
                fitting = next(n for n in lengths if n == 1 or self.font.getlength(rest[:n]) <= width)
                fitting = rest.rfind("-", 0, fitting) + 1 or fitting
                lines.append(rest[:fitting])
                rest = rest[fitting:]
            lines.append(rest)
        return lines

    def fit(self, text: str, width: int, height: int) -> list[str]:
        """Break a text and shorten it to ``height``."""
        lines = self.wrap(text, width)
        most = max(1, height // self.line)
        return lines if len(lines) <= most else [*lines[: most - 1], f"{lines[most - 1][:-1]}…"]


@dataclass(frozen=True)
class _Plan:
    """Where things stand on a sheet, in pixels."""

    pen: _Pen
    titles: list[tuple[list[str], Any, tuple[int, int, int]]]
    columns: int
    left: int
    width: int
    tops: list[int]
    heights: list[int]
    head_height: int
    size: tuple[int, int]

    def place(self, index: int) -> tuple[int, int]:
        """Return left and top of a cell."""
        return self.left + index % self.columns * (self.width + _GAP), self.tops[index // self.columns]


def _plan(
    tiles: Sequence[Tile],
    pictures: Sequence[NDArray[np.uint8] | None],
    columns: int,
    title: Sequence[str],
    column_heads: Sequence[str],
    row_heads: Sequence[str],
    share: float,
) -> _Plan:
    from PIL import ImageFont

    shapes = [(0, 0) if picture is None else picture.shape[:2] for picture in pictures]
    tallest, widest = (max(shape[axis] for shape in shapes) or _MIN_CELL for axis in (0, 1))
    size = max(font_size(max(tallest, widest)) if share <= 0 else 0, round(share * max(tallest, widest)))
    pen = _Pen(None, ImageFont.load_default(size))
    width = max(widest, _MIN_CELL)
    left = _GAP + max((math.ceil(pen.font.getlength(text)) + _GAP for text in row_heads), default=0)
    sheet_width = left + columns * (width + _GAP)
    large = _Pen(None, ImageFont.load_default(round(1.25 * size)))
    titles = [(large.wrap(text, sheet_width - 2 * _GAP), large.font, _INK) for text in title[:1]]
    titles += [(pen.wrap(text, sheet_width - 2 * _GAP), pen.font, _PALE_INK) for text in title[1:]]
    title_height = sum(len(lines) * _Pen(None, font).line for lines, font, _ in titles) + 4 * bool(titles)
    head_height = pen.line * max((len(pen.wrap(text, width)) for text in column_heads), default=0)
    head_height += 4 * bool(head_height)
    top = _GAP + title_height + head_height
    captions = [sum(len(pen.wrap(text, width)) for text in tile.caption) for tile in tiles]
    tops, heights = [], []
    for first in range(0, len(tiles), columns):
        row = range(first, min(first + columns, len(tiles)))
        # A row as high as its pictures; a place that only has a message is as high as the largest picture.
        high = max(shapes[index][0] for index in row)
        heights.append(tallest if any(tiles[index].message for index in row) else high)
        tops.append(top)
        top += heights[-1] + 4 + pen.line * max(captions[index] for index in row) + _GAP
    return _Plan(pen, titles, columns, left, width, tops, heights, head_height, (sheet_width, top))


def font_size(side: int) -> int:
    """Return the size of the captions, in pixels, for pictures of this side: 12 at 64, 18 at 512."""
    return round(min(18, max(12, 9 + side / 56)))


def picture_bytes(image: FloatImage, scale: float = 1.0) -> NDArray[np.uint8]:
    """Return a picture as it is shown.

    Parameters
    ----------
    image
        (H, W, C) float32 in [0, 1], C of 1 or 3.
    scale
        Factor of both sides; below 1 by area averaging.

    Returns
    -------
    uint8 array
        (H', W', C).
    """
    height, width, channels = image.shape
    shown: NDArray[Any] = image
    if scale < 1:
        import cv2

        size = (max(1, round(width * scale)), max(1, round(height * scale)))
        shown = cv2.resize(image, size, interpolation=cv2.INTER_AREA).reshape(size[1], size[0], channels)
    rounded: NDArray[np.uint8] = (np.clip(shown, 0, 1) * 255 + 0.5).astype(np.uint8)
    return rounded


def _rgb(picture: NDArray[np.uint8]) -> NDArray[np.uint8]:
    return picture if picture.shape[2] == 3 else np.repeat(picture, 3, axis=2)
