"""Where: rectangles around what a detector saw."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.findings.finding import Region, Where
from texlab_core.measures.blocks import block_map

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.measures.cuts import Cut
    from texlab_core.measures.subject import Subject

MOST = 3
TILE = 32


def worst_blocks(subject: Subject) -> Where:
    """Return the places whose blocks are most unlike the exemplar's."""
    found = block_map(subject)
    if found is None:
        return everywhere()
    high = np.percentile(found.distances, 90)
    places = []
    for part, weight in _pieces(found.distances >= max(high, 1e-9), found.distances):
        top, left = int(found.tops[part[0].start]), int(found.lefts[part[1].start])
        bottom, right = int(found.tops[part[0].stop - 1]), int(found.lefts[part[1].stop - 1])
        places.append((weight, Region(top, left, bottom - top + found.side, right - left + found.side)))
    return _where(places)


def marked(mask: NDArray[np.bool_], step: int = 1, more: int = 0) -> Where:
    """Return the largest connected parts of a map of the result, one entry for ``step`` x ``step`` pixels.

    Each entry stands for so many pixels ``more`` to the right and below.
    """
    places = []
    for part, weight in _pieces(mask, mask.astype(np.float64)):
        rows, columns = part
        height, width = ((part.stop - part.start) * step + more for part in (rows, columns))
        places.append((weight, Region(rows.start * step, columns.start * step, height, width)))
    return _where(places)


def densest(mask: NDArray[np.bool_], size: tuple[int, int], step: int = 1) -> Where:
    """Return the places of 32 x 32 pixels with the most marks in a map of every ``step``-th pixel."""
    side = max(1, TILE // step)
    rows, columns = (np.arange(0, length, side) for length in mask.shape)
    sums = np.add.reduceat(np.add.reduceat(mask.astype(np.float64), rows, axis=0), columns, axis=1)
    order = np.argsort(-sums, axis=None, kind="stable")[:MOST]
    places = []
    for place in order:
        row, column = (int(each) for each in np.unravel_index(int(place), sums.shape))
        if sums[row, column] > 0:
            top, left = int(rows[row]) * step, int(columns[column]) * step
            height, width = min(side * step, size[0] - top), min(side * step, size[1] - left)
            places.append((float(sums[row, column]), Region(top, left, height, width)))
    return _where(places)


def along(cut: Cut, size: tuple[int, int]) -> Where:
    """Return the two lines of pixels on both sides of a cut."""
    length = size[1] if cut.axis == "row" else size[0]
    first = length // 2 if cut.part == "second half" else 0
    last = length // 2 if cut.part == "first half" else length
    if cut.axis == "row":
        region = Region(cut.line, first, 2, last - first)
    else:
        region = Region(first, cut.line, last - first, 2)
    part = "" if cut.part == "whole" else f", {cut.part}"
    return Where("result", f"between {cut.axis}s {cut.line} and {cut.line + 1}{part}", (region,))


def everywhere() -> Where:
    """Return the whole result."""
    return Where("result", "everywhere")


def in_exemplar(words: str = "the exemplar as a whole") -> Where:
    """Return the exemplar."""
    return Where("exemplar", words)


def _pieces(mask: NDArray[np.bool_], weights: NDArray[np.float64]) -> list[tuple[tuple[slice, slice], float]]:
    """Return bounding boxes of connected parts with the sum of their weights."""
    from scipy import ndimage

    labels, count = ndimage.label(mask)
    if not count:
        return []
    sums = ndimage.sum_labels(weights, labels, np.arange(1, count + 1))
    boxes = ndimage.find_objects(labels)
    return [((box[0], box[1]), float(weight)) for box, weight in zip(boxes, sums, strict=True)]


def _where(places: list[tuple[float, Region]]) -> Where:
    ordered = [region for _, region in sorted(places, key=lambda place: -place[0])[:MOST]]
    if not ordered:
        return everywhere()
    first = ordered[0]
    words = f"most of all in {first.width} x {first.height} pixels at row {first.top}, column {first.left}"
    return Where("result", words, tuple(ordered))
