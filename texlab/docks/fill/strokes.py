"""Strokes on a soft mask: lines of a brush with a hard or soft edge, boxes and lassos; arrays only, no Qt."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

FULL = 255
"""A pixel that is marked in full."""

Box = tuple[slice, slice]
Place = tuple[float, float]
"""Row and column; the centre of the first pixel is at (0.5, 0.5)."""


def stroke_line(
    shares: NDArray[np.uint8], first: Place, last: Place, radius: float, hardness: float, *, erase: bool = False
) -> Box | None:
    """Mark what lies near the line between two places, or unmark it.

    Parameters
    ----------
    shares
        (H, W) uint8, changed in place: 0 is not marked, 255 in full.
    first, last
        Ends of the line.
    radius
        Half the width of the brush, in pixels.
    hardness
        0 .. 1: within this part of the radius a pixel is marked in full; from there it fades to 0 at the radius.
    erase
        Unmark instead.

    Returns
    -------
    What may have changed, or None when nothing lies inside of the picture.
    """
    box = _around([first, last], radius, shares.shape)
    if box is None:
        return None
    rows = np.arange(box[0].start, box[0].stop)[:, None] + 0.5 - first[0]
    columns = np.arange(box[1].start, box[1].stop)[None, :] + 0.5 - first[1]
    along = (last[0] - first[0], last[1] - first[1])
    length = along[0] ** 2 + along[1] ** 2
    share: Any = 0.0
    if length > 0:
        share = np.clip((rows * along[0] + columns * along[1]) / length, 0, 1)
    square = (rows - share * along[0]) ** 2 + (columns - share * along[1]) ** 2
    if hardness >= 1:
        painted = np.where(square <= radius**2, FULL, 0).astype(np.uint8)
    else:
        fading = (radius - np.sqrt(square)) / (radius * (1 - hardness))
        painted = np.rint(FULL * np.clip(fading, 0, 1)).astype(np.uint8)
    part = shares[box]
    if erase:
        np.minimum(part, FULL - painted, out=part)
    else:
        np.maximum(part, painted, out=part)
    return box


def stroke_box(shares: NDArray[np.uint8], corner: Place, other: Place) -> Box | None:
    """Mark a rectangle in full; returns what may have changed."""
    rows, columns = (
        slice(*(min(max(round(each), 0), side) for each in sorted(pair)))
        for *pair, side in zip(corner, other, shares.shape, strict=True)
    )
    if rows.start >= rows.stop or columns.start >= columns.stop:
        return None
    shares[rows, columns] = FULL
    return rows, columns


def stroke_lasso(shares: NDArray[np.uint8], places: Sequence[Place]) -> Box | None:
    """Mark in full the pixels whose centres lie inside a closed line; returns what may have changed."""
    box = _around(places, 0, shares.shape)
    if box is None or len(places) < 3:
        return None
    rows = np.arange(box[0].start, box[0].stop)[:, None] + 0.5
    columns = np.arange(box[1].start, box[1].stop)[None, :] + 0.5
    inside = np.zeros(shares[box].shape, bool)
    # Even-odd rule: every edge turns what lies to the right of it over.
    for (top, left), (bottom, right) in zip(places, [*places[1:], places[0]], strict=True):
        if top == bottom:
            continue
        crossed = (rows >= min(top, bottom)) & (rows < max(top, bottom))
        inside ^= crossed & (columns > left + (rows - top) * ((right - left) / (bottom - top)))
    shares[box][inside] = FULL
    return box


def united(one: Box | None, other: Box | None) -> Box | None:
    """Return the smallest box around two."""
    if one is None or other is None:
        return one or other
    rows, columns = (slice(min(a.start, b.start), max(a.stop, b.stop)) for a, b in zip(one, other, strict=True))
    return rows, columns


def marked_box(shares: NDArray[np.uint8]) -> Box | None:
    """Return the smallest box around what is marked, or None."""
    down, across = np.flatnonzero(shares.any(axis=1)), np.flatnonzero(shares.any(axis=0))
    if down.size == 0:
        return None
    return slice(int(down[0]), int(down[-1]) + 1), slice(int(across[0]), int(across[-1]) + 1)


def _around(places: Sequence[Place], radius: float, shape: tuple[int, ...]) -> Box | None:
    sides = []
    for axis in (0, 1):
        values = [place[axis] for place in places]
        first, last = int(min(values) - radius - 1), int(max(values) + radius + 2)
        sides.append(slice(max(0, first), min(shape[axis], last)))
    rows, columns = sides
    return None if rows.start >= rows.stop or columns.start >= columns.stop else (rows, columns)
