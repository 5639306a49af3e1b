"""Masks: images that mark pixels, whatever the file made of black and white."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.inputs import ImageInput, hash_arrays
from texlab_core.errors import ImageError
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.images.exemplar import Source

THRESHOLD = 0.5
"""Compression blurs the edges of a mask to both sides; half is where the edge was."""


def as_mask(
    source: Source,
    *,
    threshold: float = THRESHOLD,
    name: str | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> ImageInput:
    """Make a mask of an image: what is brighter than the threshold, in any channel, is marked.

    Parameters
    ----------
    source
        See :func:`as_exemplar`; transparent pixels count as black.
    threshold
        0 <= threshold < 1; 0 marks everything that is not black.
    name
        For people and recipes.
    should_stop
        See :func:`as_exemplar`.

    Returns
    -------
    ImageInput
        (H, W, 1) float32, 0 or 1. Its last note states the threshold and the share of pixels that are marked.

    Raises
    ------
    ImageError
        When the image cannot be read, or the threshold is out of range.
    """
    if not 0 <= threshold < 1:
        raise ImageError(f"The threshold of a mask must be at least 0 and below 1, got {threshold!r}.")
    image = as_exemplar(source, name=name, background=0.0, should_stop=should_stop)
    marked = (image.pixels.max(axis=2, keepdims=True) > threshold).astype(np.float32)
    marked.flags.writeable = False
    note = f"The mask {image.name} marks what is brighter than {threshold:g}: {100 * float(marked.mean()):.3g} %."
    return ImageInput(marked, image.name, hash_arrays({"pixels": marked}), None, (*image.notes, note), image.depth)
