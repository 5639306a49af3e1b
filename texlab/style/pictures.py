"""Values to what is painted, and back to numbers for people; no Qt here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from texlab_core.engine.steps import FloatImage


def to_picture(image: FloatImage) -> Picture:
    """Return (H, W, 3) uint8 for an (H, W, C) float image in [0, 1]; gray is repeated."""
    scaled = np.multiply(image, 255.0, dtype=np.float32)
    np.add(scaled, 0.5, out=scaled)
    np.clip(scaled, 0.0, 255.0, out=scaled)
    values = scaled.astype(np.uint8)
    if values.shape[2] == 1:
        values = np.broadcast_to(values, (*values.shape[:2], 3))
    return np.ascontiguousarray(values)


def thinned(pixels: NDArray[Any], side: int) -> NDArray[Any]:
    """Return every n-th pixel, at most ``side`` x ``side``, as an array of its own."""
    step = max(1, -(-max(pixels.shape[:2]) // side))
    return np.array(pixels[::step, ::step], order="C")


def describe_value(image: FloatImage, row: int, column: int) -> str:
    """Return the value of a pixel for the status bar."""
    values = image[row, column]
    numbers = " ".join(f"{value:.3f}" for value in values)
    return f"{'RGB' if len(values) == 3 else 'gray'} {numbers}"


Picture = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Lit:
    """Pixels of a picture that light up.

    Parameters
    ----------
    column_id
        Of the column; 0 for the exemplar.
    image
        The very values whose pixels they are: they light up in no other picture.
    veil
        (H, W, 4) uint8, laid over the picture.
    """

    column_id: int
    image: FloatImage
    veil: NDArray[np.uint8]


@dataclass(frozen=True)
class Mark:
    """A rectangle to outline in the exemplar (or a result), in pixels; ``role`` decides its colour.

    ``chosen`` is the one that was taken, ``candidate`` another that could have been, ``window`` a neighbourhood.
    ``dotted`` ones belong to the second of two things that are compared.
    """

    top: float
    left: float
    height: float
    width: float
    role: Literal["chosen", "candidate", "window"] = "candidate"
    dotted: bool = False
