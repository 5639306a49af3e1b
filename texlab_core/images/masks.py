"""Masks: images that mark pixels, whatever the file made of black and white."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.inputs import ImageInput, hash_arrays
from texlab_core.errors import ImageError
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

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


def as_blend(
    source: Source, *, name: str | None = None, should_stop: Callable[[], bool] | None = None
) -> ImageInput:
    """Make a soft mask of an image: its grays say how much of a fill covers what was there.

    Parameters
    ----------
    source
        See :func:`as_exemplar`; transparent pixels count as black. Of colours the largest channel counts.
    name, should_stop
        As for :func:`as_mask`.

    Returns
    -------
    ImageInput
        (H, W, 1) float32 in [0, 1]. Its last note states the shares that are marked, in full and in part.

    Raises
    ------
    ImageError
        When the image cannot be read.
    """
    image = as_exemplar(source, name=name, background=0.0, should_stop=should_stop)
    return _blend(image.pixels.max(axis=2, keepdims=True), image)


def feathered(mask: ImageInput, pixels: int) -> ImageInput:
    """Return a mask whose marks fade outward: ``1 - d / (pixels + 1)`` at a distance of ``d`` pixels.

    Parameters
    ----------
    mask
        Of :func:`as_mask`.
    pixels
        Width of the edge, 0 <= pixels.

    Raises
    ------
    ImageError
        For a width below 0, or beyond the picture.
    """
    longest = max(mask.size)
    if not 0 <= pixels <= longest:
        raise ImageError(f"feather: must be from 0 to {longest} pixels for this mask, got {pixels}.")
    import cv2

    outside = np.ascontiguousarray(mask.pixels[..., 0] == 0).astype(np.uint8)
    if outside.all():
        return mask
    distance = cv2.distanceTransform(outside, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    return _blend(np.clip(1 - distance / np.float32(pixels + 1), 0, 1)[..., None].astype(np.float32), mask)


def _blend(shares: NDArray[np.float32], image: ImageInput) -> ImageInput:
    kept = np.ascontiguousarray(shares, np.float32).copy()
    kept.flags.writeable = False
    full, some = float((kept == 1).mean()), float(((kept > 0) & (kept < 1)).mean())
    note = f"The mask {image.name} marks {100 * full:.3g} % in full and {100 * some:.3g} % in part."
    return ImageInput(kept, image.name, hash_arrays({"pixels": kept}), None, (*image.notes, note), image.depth)
