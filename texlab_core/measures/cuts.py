"""Straight cuts: jumps across one line of pixels that the lines beside it do not have."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from texlab_core.measures.registry import Measure, register
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.measures.subject import Subject

Axis = Literal["row", "column"]
Part = Literal["whole", "first half", "second half"]
SMALLEST = 16
# A tenth of a gray level: an exemplar with less scatter between its lines has none that could be seen.
FLOOR = 0.1 / 255
# The median absolute deviation of a normal distribution, as standard deviation.
_DEVIATION = 1.4826


@dataclass(frozen=True)
class Cut:
    """The line that stands out most.

    Parameters
    ----------
    value
        By how many robust deviations of the exemplar's lines.
    axis
        Whether the cut runs along a row or a column.
    line
        It lies between this row (or column) and the next one.
    part
        Which part of the line.
    """

    value: float
    axis: Axis
    line: int
    part: Part


def jumps(image: FloatImage, look: Callable[[], None]) -> NDArray[np.float64]:
    """Return by how much the jump across each line exceeds that across its two neighbours.

    Parameters
    ----------
    image
        (H, W, C) in [0, 1], at least 3 rows.
    look
        Called between the pieces; may raise to stop.

    Returns
    -------
    ndarray
        (3, H - 1) float64: for the line between rows r and r + 1, over its whole length and over its two halves,
        the mean absolute difference (over columns and channels) less the mean of those at r - 1 and r + 1.
    """
    height, width = image.shape[:2]
    halves = np.empty((2, height - 1))
    for rows in row_blocks((height - 1, width, image.shape[2])):
        look()
        step = np.abs(image[rows.start + 1 : rows.stop + 1] - image[rows])
        for place, part in enumerate((slice(0, width // 2), slice(width // 2, width))):
            halves[place, rows] = step[:, part].mean(axis=(1, 2), dtype=np.float64)
    share = (width // 2) / width
    means = np.stack([share * halves[0] + (1 - share) * halves[1], *halves])
    padded = np.pad(means, ((0, 0), (1, 1)), mode="reflect")
    excess: NDArray[np.float64] = means - (padded[:, :-2] + padded[:, 2:]) / 2
    return excess


def _both(image: FloatImage, look: Callable[[], None]) -> Iterator[tuple[Axis, NDArray[np.float64]]]:
    yield "row", jumps(image, look)
    yield "column", jumps(np.ascontiguousarray(image.transpose(1, 0, 2)), look)


def usual(pixels: FloatImage, look: Callable[[], None]) -> dict[str, tuple[float, float]]:
    """Return median and robust deviation of an exemplar's whole lines, by axis."""
    found: dict[str, tuple[float, float]] = {}
    for axis, values in _both(pixels, look):
        middle = float(np.median(values[0]))
        found[axis] = middle, max(_DEVIATION * float(np.median(np.abs(values[0] - middle))), FLOOR)
    return found


def largest_cut(subject: Subject) -> Cut | None:
    """Return the line that stands out most, None where image or exemplar are under 16 pixels wide or high."""
    if min(*subject.image.shape[:2], *subject.pixels.shape[:2]) < SMALLEST:
        return None
    exemplar = subject.prepared("lines", usual)
    return subject.once("largest cut", lambda: _largest(subject.image, exemplar, subject.look))


def _largest(image: FloatImage, exemplar: dict[str, tuple[float, float]], look: Callable[[], None]) -> Cut:
    parts: tuple[Part, ...] = ("whole", "first half", "second half")
    found = []
    for axis, values in _both(image, look):
        middle, deviation = exemplar[axis]
        place, line = np.unravel_index(int(values.argmax()), values.shape)
        found.append(Cut((float(values[place, line]) - middle) / deviation, axis, int(line), parts[place]))
    return max(found, key=lambda cut: cut.value)


def largest_cut_between(subject: Subject) -> Cut | None:
    """Return the line that stands out most among those where blocks as large as the exemplar would meet.

    None where the picture has no such line, or picture or exemplar are under 16 pixels wide or high.
    """
    sides = dict(zip(("row", "column"), subject.pixels.shape[:2], strict=True))
    if min(*subject.image.shape[:2], *sides.values()) < SMALLEST:
        return None
    exemplar = subject.prepared("lines", usual)
    parts: tuple[Part, ...] = ("whole", "first half", "second half")
    found = []
    for axis, values in _both(subject.image, subject.look):
        lines = np.arange(sides[axis] - 1, values.shape[1], sides[axis])
        if not lines.size:
            continue
        middle, deviation = exemplar[axis]
        place, line = np.unravel_index(int(values[:, lines].argmax()), (len(parts), lines.size))
        value = (float(values[place, lines[line]]) - middle) / deviation
        found.append(Cut(value, axis, int(lines[line]), parts[place]))
    return max(found, key=lambda cut: cut.value, default=None)


def own_cut(subject: Subject) -> float | None:
    """Return the largest line of the exemplar itself, on the same scale: what is usual for it."""
    if min(subject.pixels.shape[:2]) < SMALLEST:
        return None
    lines = subject.prepared("lines", usual)
    return subject.prepared("own cut", lambda pixels, look: _largest(pixels, lines, look).value)


def _cuts(subject: Subject) -> float | None:
    found = largest_cut(subject)
    return None if found is None else found.value


def _cuts_at_sides(subject: Subject) -> float | None:
    found = largest_cut_between(subject)
    return None if found is None else found.value


register(
    Measure(
        id="cuts",
        title="cuts",
        summary="The straight line (or half line) across which the picture jumps most, against the lines beside "
        "it, in robust deviations of the exemplar's own lines: 5 is usual without cuts, 9 for tiles that "
        "do not fit; compare with the exemplar's own.",
        low=-1e4,
        high=1e4,
        better="lower",
        needs=("exemplar",),
        function=_cuts,
        form=".1f",
        live=True,
        order=40,
    )
)
register(
    Measure(
        id="own-cuts",
        title="exemplar's cuts",
        summary="The same as cuts for the exemplar itself: what its largest line reaches without any cut.",
        low=-1e4,
        high=1e4,
        better="neither",
        needs=("exemplar",),
        function=own_cut,
        form=".1f",
        part_of="cuts",
        live=True,
        order=41,
    )
)
register(
    Measure(
        id="cuts-at-sides",
        title="cuts at sides",
        summary="The same as cuts, but only for the lines where blocks as large as the exemplar would meet: more "
        "certain about repetitions of the exemplar, blind to all other places.",
        low=-1e6,
        high=1e6,
        better="lower",
        needs=("exemplar",),
        function=_cuts_at_sides,
        form=".1f",
        part_of="cuts",
        order=53,
    )
)
