"""TIFF pictures that are too large to be decoded whole, scaled down a strip or tile at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.images.formats.decoded import MAX_REDUCED

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.images.formats.decoded import Gate

_CONTIGUOUS = 1


def reducing_factor(page: Any, gate: Gate) -> int:
    """Return how many pixels of a side become one while the page is read.

    1 for pages that can be decoded whole, for those that are not to be made as small as that, and for samples that
    are not averaged here: floats, other depths than 8 and 16 bits, palettes, separate planes.
    """
    width, height = int(page.imagewidth), int(page.imagelength)
    plain = page.bitspersample in (8, 16) and page.dtype is not None and page.dtype.kind == "u"
    if width * height <= MAX_REDUCED or not plain or page.planarconfig != _CONTIGUOUS or page.colormap is not None:
        return 1
    largest = int(1 / gate.scale) if gate.reduced else 1
    for factor in range(2, largest + 1):
        if -(-width // factor) * -(-height // factor) <= MAX_REDUCED:
            return factor
    return 1


def reduced_samples(page: Any, factor: int) -> NDArray[np.uint16]:
    """Return the means over blocks of ``factor`` x ``factor`` pixels, (H, W, S) uint16 over its whole range."""
    height, width, samples = int(page.imagelength), int(page.imagewidth), int(page.samplesperpixel)
    rows, columns = -(-height // factor), -(-width // factor)
    total = np.zeros((rows, columns, samples), np.float64)
    for part, place, _ in page.segments(maxworkers=1):
        if part is None:
            continue
        top, left = place[2], place[3]
        # Tiles reach beyond the picture.
        values = part[0][: height - top, : width - left].astype(np.float64)
        sums = np.add.reduceat(values, _starts(top, values.shape[0], factor), axis=0)
        sums = np.add.reduceat(sums, _starts(left, values.shape[1], factor), axis=1)
        above, before = top // factor, left // factor
        total[above : above + sums.shape[0], before : before + sums.shape[1]] += sums
    # Blocks at the lower and right side may be smaller.
    down, across = (np.minimum(factor, side - factor * np.arange(-(-side // factor))) for side in (height, width))
    share = 65535 / (2**page.bitspersample - 1)
    means: NDArray[np.uint16] = np.rint(total * (share / (down[:, None] * across))[..., None]).astype(np.uint16)
    return means


def _starts(first: int, count: int, factor: int) -> NDArray[np.int64]:
    """Return where, in a run of samples from ``first`` on, a block begins."""
    edges = np.arange(-(first % factor), count, factor)
    return np.maximum(edges, 0)
