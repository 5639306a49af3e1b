"""The part of a large image whose subbands are looked at. NumPy only, no Qt."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from texlab_core.engine.steps import FloatImage

MOST_SIDE = 1024
# The corner lies on the grid of the coarsest level.
GRID = 256


def middle_of(image: FloatImage) -> FloatImage:
    """Return the middle of a large image, at most 1024 x 1024 pixels, at full size; a small one whole.

    Subbands of all of it would take a hundred times what can be seen of them, and reduced they would show nothing.
    """
    height, width = image.shape[:2]
    rows, columns = min(height, MOST_SIDE), min(width, MOST_SIDE)
    top, left = ((height - rows) // 2 // GRID * GRID, (width - columns) // 2 // GRID * GRID)
    return image[top : top + rows, left : left + columns]


def middle_words(image: FloatImage) -> str:
    """Return which part of an image is looked at; empty for all of it."""
    part = middle_of(image)
    if part.shape == image.shape:
        return ""
    size, whole = (f"{each.shape[1]} x {each.shape[0]}" for each in (part, image))
    return f"the middle {size} of {whole} pixels"
