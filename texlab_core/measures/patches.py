"""Verbatim copying without a source map: patches of the result that are found in the exemplar, bit for bit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.measures.registry import Measure, register
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.measures.subject import Subject

SIDE = 9
# Odd factors of a hash by rows and columns; all arithmetic is modulo 2^64.
_DOWN, _ACROSS = np.uint64(0x9E3779B97F4A7C15), np.uint64(0xC2B2AE3D27D4EB4F)
_MIX = np.uint64(0xBF58476D1CE4E5B9)


def patch_hashes(image: FloatImage, look: Callable[[], None]) -> tuple[NDArray[np.uint64], NDArray[np.bool_]]:
    """Return a 64-bit hash of every 9 x 9 patch of an image rounded to 8 bits, and which patches are flat.

    Parameters
    ----------
    image
        (H, W, C) in [0, 1], at least 9 x 9; one channel counts as three equal ones.
    look
        Called between the pieces; may raise to stop.

    Returns
    -------
    hashes
        (H - 8, W - 8) uint64; different patches share one in a case of 10^19.
    flat
        (H - 8, W - 8) bool: all of its pixels are equal, so that it says nothing.
    """
    height, width = image.shape[:2]
    values = np.empty((height, width), np.uint64)
    for rows in row_blocks(image.shape):
        look()
        levels = np.rint(image[rows] * np.float32(255)).astype(np.uint64)
        packed = levels[:, :, 0] << np.uint64(16) | levels[:, :, image.shape[2] // 2] << np.uint64(8)
        values[rows] = packed | levels[:, :, -1]
    mixed = _scattered(values)
    look()
    across = _rolling(mixed, _ACROSS, 1, look)
    hashes = _rolling(across, _DOWN, 0, look)
    # A patch is flat when the hash of its pixels is that of its first pixel, repeated.
    repeated = np.uint64(_powers(_ACROSS) * _powers(_DOWN) % 2**64)
    flat = hashes == mixed[: height - SIDE + 1, : width - SIDE + 1] * repeated
    return hashes, flat


def _scattered(values: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Return values with their bits scattered: the sums below are linear, and colours are not to be."""
    mixed = (values + np.uint64(1)) * _MIX
    mixed ^= mixed >> np.uint64(29)
    mixed *= _DOWN
    mixed ^= mixed >> np.uint64(32)
    return mixed


def _rolling(
    values: NDArray[np.uint64], factor: np.uint64, axis: int, look: Callable[[], None]
) -> NDArray[np.uint64]:
    count = values.shape[axis] - SIDE + 1
    total = np.zeros([count if each == axis else side for each, side in enumerate(values.shape)], np.uint64)
    for place in range(SIDE):
        look()
        total *= factor
        total += values[place : place + count] if axis == 0 else values[:, place : place + count]
    return total


def _powers(factor: np.uint64) -> int:
    return sum(pow(int(factor), place, 2**64) for place in range(SIDE)) % 2**64


def found_patches(subject: Subject) -> NDArray[np.bool_] | None:
    """Return for every 9 x 9 patch of the image whether the exemplar has it; None where either is smaller."""
    if min(*subject.image.shape[:2], *subject.pixels.shape[:2]) < SIDE:
        return None

    def prepare(pixels: FloatImage, look: Callable[[], None]) -> NDArray[np.uint64]:
        return np.unique(patch_hashes(pixels, look)[0])

    known = subject.prepared("patch hashes", prepare)
    hashes, flat = subject.once("patch hashes", lambda: patch_hashes(subject.image, subject.look))
    found = np.empty(hashes.shape, bool)
    for rows in row_blocks(hashes.shape, 2**16):
        subject.look()
        places = np.searchsorted(known, hashes[rows])
        found[rows] = known[np.minimum(places, known.size - 1)] == hashes[rows]
    found &= ~flat
    return found


def patches_copied(subject: Subject) -> float | None:
    """Return the share of the patches that are not flat which the exemplar has, None where all are flat."""
    found = found_patches(subject)
    if found is None:
        return None
    _, flat = subject.once("patch hashes", lambda: patch_hashes(subject.image, subject.look))
    count = flat.size - int(np.count_nonzero(flat))
    return int(np.count_nonzero(found)) / count if count else None


register(
    Measure(
        id="patches-copied",
        title="patches copied",
        summary="Share of patches of 9 x 9 pixels that the exemplar has too, bit for bit at 8 bits, flat ones "
        "left out: verbatim copying, found in any picture without the method's help.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("exemplar",),
        function=patches_copied,
        form=".0%",
        order=39,
    )
)
