"""Small plots for drawings: curves in one frame, tables of numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage

    Floats = NDArray[np.float64]
    Colour = tuple[int, int, int]

# Okabe and Ito's: black, vermilion, blue, green.
COLOURS: tuple[Colour, ...] = ((24, 24, 24), (213, 94, 0), (0, 114, 178), (0, 158, 115))
_PAPER, _PALE = (255, 255, 255), (190, 190, 190)
_MANY = 3


def curves(
    lines: Sequence[tuple[Floats, Floats]], size: tuple[int, int] = (192, 256), *, bottom: float | None = None
) -> FloatImage:
    """Draw curves in one frame that fits them all, in the order of ``COLOURS``.

    Parameters
    ----------
    lines
        x and y, (n,) each.
    size
        Height and width in pixels.
    bottom
        Lowest y of the frame; None takes the lowest of the curves.

    Returns
    -------
    (H, W, 3) float32 in [0, 1].
    """
    from PIL import Image, ImageDraw

    height, width = size
    image = Image.new("RGB", (width * _MANY, height * _MANY), _PAPER)
    pen = ImageDraw.Draw(image)
    x = np.concatenate([each for each, _ in lines])
    y = np.concatenate([each for _, each in lines])
    left, right, top = float(x.min()), float(x.max()), float(y.max())
    low = float(y.min()) if bottom is None else bottom

    def place(across: Floats, up: Floats) -> list[tuple[float, float]]:
        h = (across - left) / max(right - left, 1e-12) * (width - 16) + 8
        v = height - 8 - (up - low) / max(top - low, 1e-12) * (height - 16)
        return [(float(a) * _MANY, float(b) * _MANY) for a, b in zip(h, v, strict=True)]

    corners = place(np.array([left, right]), np.array([top, low]))
    pen.rectangle([corners[0], corners[1]], outline=_PALE, width=_MANY)
    if low < 0 < top:
        pen.line(place(np.array([left, right]), np.zeros(2)), _PALE, _MANY)
    for (across, up), colour in zip(lines, COLOURS, strict=False):
        pen.line(place(across, up), colour, 2 * _MANY, joint="curve")
    small = image.resize((width, height), Image.Resampling.LANCZOS)
    return (np.asarray(small) / 255).astype(np.float32)


def table(rows: Sequence[Sequence[str]], *, shade: NDArray[np.floating] | None = None) -> FloatImage:
    """Draw a table whose first row and column are heads.

    Parameters
    ----------
    rows
        Texts; all rows have equally many.
    shade
        (rows - 1, columns - 1) from 0 (white) to 1 (dark blue), behind the numbers.
    """
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.load_default(size=15)
    widths = [max(int(font.getlength(row[place])) + 22 for row in rows) for place in range(len(rows[0]))]
    line = 28
    image = Image.new("RGB", (sum(widths), line * len(rows)), _PAPER)
    pen = ImageDraw.Draw(image)
    for row, texts in enumerate(rows):
        left = 0
        for place, text in enumerate(texts):
            ink = (24, 24, 24)
            if shade is not None and row and place:
                dark = float(np.clip(shade[row - 1, place - 1], 0, 1))
                fill = tuple(round(255 + (blue - 255) * dark) for blue in (8, 81, 156))
                pen.rectangle([left, row * line, left + widths[place] - 1, row * line + line - 1], fill=fill)
                ink = (255, 255, 255) if dark > 0.55 else ink
            anchor = "lm" if place == 0 else "rm"
            at = left + 8 if place == 0 else left + widths[place] - 10
            pen.text((at, row * line + line / 2), text, ink, font, anchor)
            left += widths[place]
    return (np.asarray(image) / 255).astype(np.float32)
