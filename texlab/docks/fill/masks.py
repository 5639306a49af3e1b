"""Masks as inputs of a job, and masks from files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.inputs import ImageInput, hash_arrays

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage


def fill_inputs(
    exemplar: ImageInput, image: FloatImage, mask: NDArray[np.bool_], region: NDArray[np.bool_]
) -> tuple[tuple[str, ImageInput], ...]:
    """Return the further inputs of a fill; a start image only where it is not the exemplar itself."""
    inputs = [("mask", mask_input(mask, "painted hole"))]
    if image is not exemplar.pixels:
        inputs.append(("start", ImageInput(image, "result", hash_arrays({"pixels": image}))))
    if region.any():
        inputs.append(("region", mask_input(region, "painted region")))
    return tuple(inputs)


def mask_input(mask: NDArray[np.bool_], name: str) -> ImageInput:
    """Return a mask as an image: 1 where it is marked."""
    pixels = np.ascontiguousarray(mask[..., None], np.float32)
    pixels.flags.writeable = False
    return ImageInput(pixels, name, hash_arrays({"pixels": pixels}))


def read_mask(path: str, size: tuple[int, ...]) -> NDArray[np.bool_]:
    """Read a mask: what is transparent, or in a picture without transparency what is brighter than half.

    Raises
    ------
    InputError
        When it cannot be read or has another size.
    """
    from texlab_core.errors import InputError
    from texlab_core.images.exemplar import as_exemplar

    over_white, over_black = (as_exemplar(path, background=level).pixels for level in (1.0, 0.0))
    # Transparent pixels, and no others, depend on what they are laid over.
    opaque = over_white.shape == over_black.shape and np.array_equal(over_white, over_black)
    if opaque:
        mask: NDArray[np.bool_] = over_white.mean(axis=2) > 0.5
    else:
        light, dark = (_three(each) for each in (over_white, over_black))
        mask = (light - dark).max(axis=2) > 0.5
    if mask.shape != tuple(size):
        raise InputError(
            f"mask: must have the size of the picture, {size[1]} x {size[0]} pixels, "
            f"got {mask.shape[1]} x {mask.shape[0]}."
        )
    return mask


def _three(pixels: FloatImage) -> Any:
    return np.broadcast_to(pixels, (*pixels.shape[:2], 3))
