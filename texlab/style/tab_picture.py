"""What a tab shows as the bytes of a file: PNG, or SVG with that PNG inside, with how it was made; no Qt here."""

from __future__ import annotations

import base64
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape

if TYPE_CHECKING:
    from collections.abc import Mapping

    from texlab.style.pictures import Picture
    from texlab_core.engine.result import Result

TAB_KEY = "texlab-tab"
SUFFIXES = (".png", ".svg")


def picture_texts(made: Mapping[str, Any], result: Result | None) -> dict[str, str]:
    """Return what is written into the file: how the tab was set, and the recipe of the result that it shows.

    Parameters
    ----------
    made
        Tab, stage, controls: JSON data.
    result
        Of the column that was chosen, if it had finished.
    """
    from texlab_core.documents.reading import KEY
    from texlab_core.documents.recipe import written_recipe
    from texlab_core.files.strict_json import packed

    texts = {TAB_KEY: packed(dict(made))}
    if result is not None:
        texts[KEY] = written_recipe(result)
    return texts


def encode_picture(suffix: str, picture: Picture, texts: Mapping[str, str]) -> bytes:
    """Return the bytes of a PNG or an SVG file.

    Parameters
    ----------
    suffix
        ".png" or ".svg".
    picture
        (H, W, 3) uint8.
    texts
        By key; text chunks of the PNG, and metadata of the SVG.

    Raises
    ------
    ValueError
        When the suffix is another one.
    """
    from texlab_core.files.strict_json import packed
    from texlab_core.images.formats.writing import encode_png

    if suffix not in SUFFIXES:
        raise ValueError(f"A tab's picture is saved as {' or '.join(SUFFIXES)}, not as {suffix}.")
    png = encode_png(picture, texts)
    if suffix == ".png":
        return png
    height, width = picture.shape[:2]
    inside = base64.b64encode(png).decode("ascii")
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
        f'viewBox="0 0 {width} {height}">\n<metadata>{escape(packed(dict(texts)))}</metadata>\n'
        f'<image width="{width}" height="{height}" href="data:image/png;base64,{inside}"/>\n</svg>\n'
    ).encode()
