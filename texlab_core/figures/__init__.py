"""The figures of the help pages, redrawn from the gallery: ``python -m texlab_core.figures FOLDER [NAME ...]``.

A module of this package whose name does not start with an underscore holds ``FIGURES``.
"""

from __future__ import annotations

import importlib
import pkgutil
from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab_core.errors import ParamError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True)
class Figure:
    """One figure.

    Parameters
    ----------
    file
        Name of its file; photographs are .jpg, drawings .png.
    shows
        What it shows, one sentence.
    draw
        Makes it, (H, W, 3) uint8.
    """

    file: str
    shows: str
    draw: Callable[[], NDArray[np.uint8]]

    @property
    def name(self) -> str:
        """The file's name without its ending."""
        return self.file.rpartition(".")[0]


def figures(names: Sequence[str] = ()) -> tuple[Figure, ...]:
    """Return the figures, or those with the given names in the order given; raises ``ParamError``."""
    found: dict[str, Figure] = {}
    for each in pkgutil.iter_modules(__path__):
        if not each.name.startswith("_"):
            module = importlib.import_module(f"{__name__}.{each.name}")
            found |= {figure.name: figure for figure in module.FIGURES}
    for name in names:
        if name not in found:
            raise ParamError("figure", f"one of {', '.join(found)}", name)
    return tuple(found[name] for name in names or found)


def encode(figure: Figure, pixels: NDArray[np.uint8]) -> bytes:
    """Return the file: JPEG of quality 85, or PNG with a palette of 256 colours."""
    import io

    from PIL import Image

    image = Image.fromarray(pixels)
    buffer = io.BytesIO()
    if figure.file.endswith(".jpg"):
        image.save(buffer, "JPEG", quality=85, optimize=True)
    else:
        image.quantize(256, dither=Image.Dither.NONE).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()
