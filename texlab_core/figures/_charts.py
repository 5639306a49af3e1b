"""Drawings for the figures: curves over a logarithmic axis, and tables as heat maps."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

# Okabe and Ito's colours, told apart by the colour-blind too.
COLOURS = ((0, 114, 178), (213, 94, 0), (0, 158, 115), (204, 121, 167), (86, 180, 233), (230, 159, 0))
_INK, _PALE, _GRID = (24, 24, 24), (104, 104, 104), (222, 222, 222)
_OVERSAMPLING = 3


@dataclass(frozen=True)
class Line:
    """A curve of a chart."""

    label: str
    x: Sequence[float]
    y: Sequence[float]


class _Axes:
    """A frame in which numbers have places."""

    def __init__(self, box: tuple[int, int, int, int], x: tuple[float, float], y: tuple[float, float]) -> None:
        self.left, self.top, self.right, self.bottom = box
        self._x = x
        self._y = (math.log10(y[0]), math.log10(y[1]))

    def across(self, value: float) -> float:
        low, high = self._x
        return self.left + (value - low) / (high - low) * (self.right - self.left)

    def down(self, value: float) -> float:
        low, high = self._y
        return self.bottom - (math.log10(value) - low) / (high - low) * (self.bottom - self.top)


def log_chart(
    lines: Sequence[Line], *, x_label: str, y_label: str, y_range: tuple[float, float], size: tuple[int, int]
) -> NDArray[np.uint8]:
    """Draw curves over a linear x axis from the smallest to the largest x, and a logarithmic y axis.

    Parameters
    ----------
    lines
        The curves, each labelled at its right end.
    x_label, y_label
        Under and above the axes.
    y_range
        Lowest and highest y, both positive.
    size
        Height and width in pixels.

    Returns
    -------
    uint8 array
        (H, W, 3).
    """
    from PIL import Image, ImageDraw, ImageFont

    many = _OVERSAMPLING
    height, width = size[0] * many, size[1] * many
    font = ImageFont.load_default(13 * many)
    image = Image.new("RGB", (width, height), (255, 255, 255))
    draw = ImageDraw.Draw(image)
    room = max(math.ceil(font.getlength(line.label)) for line in lines) + 14 * many
    xs = [value for line in lines for value in line.x]
    axes = _Axes((52 * many, 30 * many, width - room, height - 44 * many), (min(xs), max(xs)), y_range)
    for value in _ticks(*y_range):
        y = axes.down(value)
        draw.line((axes.left, y, axes.right, y), _GRID, many)
        draw.text((axes.left - 8 * many, y), f"{value:g}", _PALE, font, anchor="rm")
    for value in sorted(set(xs)):
        x = axes.across(value)
        draw.line((x, axes.bottom, x, axes.bottom + 4 * many), _PALE, many)
        if value == int(value) and (max(xs) <= 12 or value % 5 == 0):
            draw.text((x, axes.bottom + 8 * many), f"{value:g}", _PALE, font, anchor="mt")
    draw.text(((axes.left + axes.right) / 2, height - 4 * many), x_label, _INK, font, anchor="mb")
    draw.text((8 * many, 8 * many), y_label, _INK, font, anchor="lt")
    for line, colour in zip(lines, COLOURS, strict=False):
        points = [(axes.across(x), axes.down(y)) for x, y in zip(line.x, line.y, strict=True)]
        draw.line(points, colour, 2 * many, joint="curve")
        for x, y in points:
            draw.ellipse((x - 3 * many, y - 3 * many, x + 3 * many, y + 3 * many), colour)
    ends = _spread([axes.down(line.y[-1]) for line in lines], 16 * many)
    for line, colour, y in zip(lines, COLOURS, ends, strict=False):
        draw.text((axes.right + 8 * many, y), line.label, colour, font, anchor="lm")
    return np.asarray(image.resize((size[1], size[0]), Image.Resampling.LANCZOS))


def _ticks(low: float, high: float) -> list[float]:
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    return [value for decade in decades for digit in (1, 2, 5) if low <= (value := digit * 10.0**decade) <= high]


def _spread(places: list[float], least: float) -> list[float]:
    """Move labels apart that would overlap, in their order."""
    order = sorted(range(len(places)), key=lambda index: places[index])
    moved = list(places)
    for before, after in itertools.pairwise(order):
        moved[after] = max(moved[after], moved[before] + least)
    return moved


def heat_table(
    values: NDArray[Any],
    rows: Sequence[str],
    columns: Sequence[str],
    *,
    corner: str,
    highest: float,
    digits: int = 1,
) -> NDArray[np.uint8]:
    """Draw a table whose cells are the darker, the larger their numbers are.

    Parameters
    ----------
    values
        (rows, columns) numbers from 0.
    rows, columns
        Heads.
    corner
        What the heads are.
    highest
        The number that is shown darkest.
    digits
        After the decimal point.

    Returns
    -------
    uint8 array
        (H, W, 3).
    """
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.load_default(13)
    left, top, width, height = 84, 30, 66, 34
    size = (left + width * len(columns) + 8, top + height * len(rows) + 8)
    image = Image.new("RGB", size, (255, 255, 255))
    draw = ImageDraw.Draw(image)
    draw.text((8, top - 10), corner, _PALE, font, anchor="lm")
    for column, text in enumerate(columns):
        draw.text((left + (column + 0.5) * width, top - 10), text, _INK, font, anchor="mm")
    for row, text in enumerate(rows):
        y = top + row * height
        draw.text((8, y + height // 2), text, _INK, font, anchor="lm")
        for column in range(len(columns)):
            share = min(1.0, float(values[row, column]) / highest)
            shade = tuple(round(255 + share * (dark - 255)) for dark in (8, 48, 107))
            x = left + column * width
            draw.rectangle((x + 1, y + 1, x + width - 2, y + height - 2), shade)
            ink = (255, 255, 255) if share > 0.5 else _INK
            draw.text(
                (x + width // 2, y + height // 2), f"{values[row, column]:.{digits}f}", ink, font, anchor="mm"
            )
    return np.asarray(image)


def stack(pictures: Sequence[NDArray[np.uint8]], columns: int, captions: Sequence[str]) -> NDArray[np.uint8]:
    """Put drawings of one size side by side, each with its caption above."""
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.load_default(14)
    height, width = pictures[0].shape[:2]
    rows = math.ceil(len(pictures) / columns)
    image = Image.new("RGB", (columns * width, rows * (height + 26)), (255, 255, 255))
    draw = ImageDraw.Draw(image)
    for index, (picture, caption) in enumerate(zip(pictures, captions, strict=True)):
        x, y = index % columns * width, index // columns * (height + 26)
        draw.text((x + 8, y + 16), caption, _INK, font, anchor="lm")
        image.paste(Image.fromarray(picture), (x, y + 26))
    return np.asarray(image)
