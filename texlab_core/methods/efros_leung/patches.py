"""What was filled in a picture before: laid over it again, so that the next hole is filled in the newest one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.inputs import ArraysInput
from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage

MOST_PATCHES = 4096
_NAMES = ("places", "marked", "pixels")
_PEAKS: tuple[tuple[type[np.unsignedinteger[Any]], int], ...] = ((np.uint8, 255), (np.uint16, 65535))

Patch = tuple[tuple[slice, slice], "NDArray[np.bool_]", "FloatImage"]
"""Rows and columns of a picture, which of these pixels are others (h, w), and their values (h, w, C) in [0, 1]."""


def pack_patches(patches: Sequence[Patch], name: str = "earlier fills") -> ArraysInput:
    """Return patches as an input.

    Parameters
    ----------
    patches
        In the order in which they were filled; at least one.
    name
        For people and recipes.

    Returns
    -------
    ArraysInput
        ``places`` (n, 4) int32 top, left, height, width; ``marked`` (N,) bool and ``pixels`` (N, C), one patch
        after the other, in 8 or 16 bits where these say the same, else float32.
    """
    places = [
        (rows.start, columns.start, rows.stop - rows.start, columns.stop - columns.start)
        for (rows, columns), _, _ in patches
    ]
    marked = np.concatenate([each.reshape(-1) for _, each, _ in patches])
    pixels = np.concatenate([each.reshape(-1, each.shape[2]) for _, _, each in patches]) * marked[:, None]
    return ArraysInput(
        {"places": np.array(places, np.int32), "marked": marked, "pixels": _compact(pixels.astype(np.float32))},
        name,
    )


def _compact(pixels: FloatImage) -> NDArray[Any]:
    for kind, peak in _PEAKS:
        steps = np.rint(pixels.astype(np.float64) * peak).astype(kind)
        if np.array_equal(np.divide(steps, np.float32(peak), dtype=np.float32), pixels):
            return steps
    return pixels


def check_patches(given: ArraysInput, size: tuple[int, int], channels: int) -> None:
    """Refuse patches that are none, or not of a picture of this size.

    Raises
    ------
    InputError
        When they are malformed or lie outside.
    """
    arrays = given.arrays
    if set(arrays) != set(_NAMES):
        raise InputError(f"patches: must have the arrays {', '.join(_NAMES)}, got {', '.join(arrays) or 'none'}.")
    places, marked, pixels = (arrays[name] for name in _NAMES)
    right = (
        places.dtype.kind in "iu"
        and places.ndim == 2
        and places.shape[1] == 4
        and 1 <= len(places) <= MOST_PATCHES
        and marked.dtype == bool
        and pixels.dtype in (np.uint8, np.uint16, np.float32)
        and pixels.shape == (marked.size, channels)
    )
    if not right:
        raise InputError(f"patches: {given.name} is not what was filled in a picture of {channels} channels.")
    where = places.astype(np.int64)
    inside = where[:, :2].min() >= 0 and where[:, 2:].min() >= 1 and (where[:, :2] + where[:, 2:] <= size).all()
    if not inside or marked.shape != (int((where[:, 2] * where[:, 3]).sum()),):
        raise InputError(f"patches: must lie inside the picture of {size[1]} x {size[0]} pixels.")
    if pixels.dtype == np.float32 and not (pixels.min() >= 0 and pixels.max() <= 1):
        raise InputError(f"patches: {given.name} has values outside 0 to 1.")


def patches_of(given: ArraysInput) -> Iterator[Patch]:
    """Yield the patches of an input that :func:`check_patches` lets pass, in their order."""
    pixels = given.arrays["pixels"]
    peak = {np.dtype(kind): peak for kind, peak in _PEAKS}.get(pixels.dtype)
    first = 0
    for top, left, height, width in given.arrays["places"].tolist():
        last = first + height * width
        values = pixels[first:last]
        unit = values if peak is None else np.divide(values, np.float32(peak), dtype=np.float32)
        marked = given.arrays["marked"][first:last].reshape(height, width)
        yield (slice(top, top + height), slice(left, left + width)), marked, unit.reshape(height, width, -1)
        first = last
