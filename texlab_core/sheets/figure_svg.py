"""Figure sheets as SVG: text is text, the typeface and the pictures are inside.

Reference: SVG 1.1, with fonts as CSS has them.
"""

from __future__ import annotations

import base64
import re
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape, unescape

from texlab_core.images.formats.writing import encode_png
from texlab_core.sheets.figure_items import CM, Box, Page, Picture
from texlab_core.sheets.typeface import FAMILY, Weight, typeface

if TYPE_CHECKING:
    from texlab_core.sheets.figure_items import Ink

_WEIGHTS: dict[Weight, int] = {"regular": 400, "bold": 700}
_CARRIED = re.compile(r'<metadata id="[a-z-]{1,40}">(.*?)(</metadata>|\Z)', re.DOTALL)


def encode_svg(page: Page) -> bytes:
    """Return the page as an SVG file; the same page gives the same bytes."""
    width, height = page.width, page.height
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" version="1.1" '
        f'width="{_n(width / CM)}cm" height="{_n(height / CM)}cm" viewBox="0 0 {_n(width)} {_n(height)}">',
        f"<title>{escape(page.title)}</title>",
    ]
    lines += [f'<metadata id="{key}">{escape(text)}</metadata>' for key, text in page.texts.items()]
    lines.append(f"<style>{''.join(_face(page, weight) for weight in _WEIGHTS)}</style>")
    lines.append(f'<rect width="{_n(width)}" height="{_n(height)}" fill="#ffffff"/>')
    for item in page.items:
        if isinstance(item, Picture):
            data = base64.b64encode(encode_png(item.pixels)).decode("ascii")
            lines.append(
                f'<image x="{_n(item.x)}" y="{_n(item.y)}" width="{_n(item.width)}" height="{_n(item.height)}" '
                'preserveAspectRatio="none" style="image-rendering:pixelated" '
                f'xlink:href="data:image/png;base64,{data}"/>'
            )
        elif isinstance(item, Box):
            lines.append(
                f'<rect x="{_n(item.x)}" y="{_n(item.y)}" width="{_n(item.width)}" height="{_n(item.height)}" '
                f'fill="{_colour(item.ink)}"/>'
            )
        else:
            lines.append(
                f'<text x="{_n(item.x)}" y="{_n(item.y)}" font-family="\'{FAMILY}\', sans-serif" '
                f'font-size="{_n(item.size)}" font-weight="{_WEIGHTS[item.weight]}" fill="{_colour(item.ink)}">'
                f"{escape(item.text)}</text>"
            )
    return "\n".join([*lines, "</svg>", ""]).encode()


def carried_text(head: bytes) -> str | None:
    """Return the first text that :func:`encode_svg` put in, from the first bytes of a file; None without one.

    Raises
    ------
    ValueError
        When it is cut off or no text; the message continues a sentence.
    """
    text = head.decode("utf-8", "replace")
    found = _CARRIED.search(text) if "<svg" in text[:1000] else None
    if found is None:
        return None
    if not found[2]:
        raise ValueError("is damaged")
    return unescape(found[1])


def _face(page: Page, weight: Weight) -> str:
    text = "".join(sorted({letter for each in page.words if each.weight == weight for letter in each.text}))
    if not text:
        return ""
    data = base64.b64encode(typeface(weight).subset(text)).decode("ascii")
    return (
        f"@font-face{{font-family:'{FAMILY}';font-weight:{_WEIGHTS[weight]};"
        f"src:url(data:font/ttf;base64,{data}) format('truetype')}}"
    )


def _colour(ink: Ink) -> str:
    return "#{:02x}{:02x}{:02x}".format(*ink)


def _n(value: float) -> str:
    return f"{value:.4f}".rstrip("0").rstrip(".")
