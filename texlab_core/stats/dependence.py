"""How bands depend on each other: joint and conditional histograms of a coefficient and one that it may follow.

A band can be right by its own histogram and yet stand in the wrong places of another one. What a coefficient has
to do with its parent (the coefficient of the next coarser level over it), with another orientation at its place,
or with its neighbour in the band, is seen in the joint histogram, and better in the conditional one, whose columns
are normalized: for natural textures it widens with the absolute value of what is given and looks like a bow tie.

References: E. P. Simoncelli, Asilomar 1997; R. W. Buccigrossi and E. P. Simoncelli, IEEE Trans. Image Processing
8(12), 1999; D. A. Forsyth and J. Ponce, Computer Vision, section 11.3.2 (the independence assumption).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from texlab_core.errors import ParamError
from texlab_core.transforms.luma import luma
from texlab_core.transforms.octave_bands import ORIENTATIONS, oriented_bands
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.transforms.octave_bands import Complex

Relation = Literal["parent", "orientation", "neighbour"]
Values = Literal["coefficients", "magnitudes", "ranks"]
Rectangle = tuple[int, int, int, int]
"""First and last row, first and last column of cells, both included."""

RANKS = 8
# At the finest level; both double with every level.
BORDER = 12
SMALLEST = 40
MOST_LEVEL = 3
FARTHEST = 32
# Of the axes: number of cells, lowest and highest value.
AXES: dict[Values, tuple[int, float, float]] = {
    "coefficients": (33, -4.0, 4.0),
    "magnitudes": (28, -5.0, 2.0),
    "ranks": (RANKS, 0.0, 1.0),
}


@dataclass(frozen=True)
class Pair:
    """Which coefficient is looked at, and which one is given.

    Parameters
    ----------
    relation
        ``parent``: the next coarser level over it; ``orientation``: another orientation at its place;
        ``neighbour``: another place of its own band.
    level
        Of the coefficient that is looked at, 0 (the finest, an octave around 1/4 cycle per pixel) to 3.
    orientation
        Of the waves that the band answers to, in steps of 45 degrees clockwise from vertical stripes: 0 to 3;
        None looks at all four.
    turn
        For ``orientation``: by how many such steps the given one is turned on, 1 to 3.
    offset
        For ``neighbour``: rows down and columns to the right, in samples of the band, which lie 2^level pixels
        apart.

    Raises
    ------
    ParamError
        When there is no such pair.
    """

    relation: Relation = "parent"
    level: int = 0
    orientation: int | None = None
    turn: int = 2
    offset: tuple[int, int] = (0, 1)

    def __post_init__(self) -> None:
        if self.relation not in ("parent", "orientation", "neighbour"):
            raise ParamError("relation", "parent, orientation or neighbour", self.relation)
        if not 0 <= self.level <= MOST_LEVEL:
            raise ParamError("level", f"a whole number from 0 to {MOST_LEVEL}", self.level)
        if self.orientation is not None and not 0 <= self.orientation < ORIENTATIONS:
            raise ParamError("orientation", f"a whole number from 0 to {ORIENTATIONS - 1}", self.orientation)
        if not 1 <= self.turn < ORIENTATIONS:
            raise ParamError("turn", f"a whole number from 1 to {ORIENTATIONS - 1}", self.turn)
        if max(map(abs, self.offset)) > FARTHEST or (self.relation == "neighbour" and self.offset == (0, 0)):
            raise ParamError("offset", f"at most {FARTHEST} each way, and not 0,0", self.offset)

    @property
    def orientations(self) -> tuple[int, ...]:
        """The orientations that are looked at."""
        return tuple(range(ORIENTATIONS)) if self.orientation is None else (self.orientation,)

    @property
    def is_measure(self) -> bool:
        """Whether it is the pair of the measure ``dependence-difference``."""
        return self.relation == "parent" and self.level == 0 and self.orientation is None

    @property
    def smallest(self) -> int:
        """How many pixels a side an image must have."""
        return SMALLEST << self.level

    def given(self, orientation: int) -> tuple[int, int]:
        """Return level and orientation of the band that is given."""
        if self.relation == "parent":
            return self.level + 1, orientation
        return self.level, (orientation + self.turn * (self.relation == "orientation")) % ORIENTATIONS

    def title(self) -> str:
        """Return what is looked at and what is given, in words."""
        return ", given ".join(self.names())

    def names(self) -> tuple[str, str]:
        """Return what is looked at, and what is given."""
        which = "all orientations" if self.orientation is None else f"{45 * self.orientation}°"
        here = f"level {self.level}, {which}"
        if self.relation == "parent":
            return here, f"the parent at level {self.level + 1}"
        if self.relation == "orientation":
            return here, f"the orientation turned by {45 * self.turn}°"
        down, right = self.offset
        return here, f"the neighbour {right} to the right and {down} down"


@dataclass(frozen=True, eq=False)
class Dependence:
    """What coefficients of an image have to do with those that are given.

    Parameters
    ----------
    pair, values
        What was asked for.
    size
        Height and width of the image.
    joint
        (R, C) float64 that sums to 1: rows by the coefficient that is looked at, columns by the given one, both
        from low to high; what lies beyond the axes counts to the outermost cells.
    means, spreads
        (C,) float64: mean and standard deviation of what is looked at for every column, on the axis of the rows;
        NaN for empty columns.
    ranks
        (K, 8, 8) float64: :func:`joint_ranks` of the magnitudes, by orientation.
    scales
        (K, 2) float64: by what coefficients and magnitudes were divided, looked at and given.
    rows, columns
        (K, h, w) uint8: the cell of every sample that counts.
    grid
        Height and width of the band in samples.
    corner
        Row and column of the band's sample that is the first that counts.
    """

    pair: Pair
    values: Values
    size: tuple[int, int]
    joint: NDArray[np.float64]
    means: NDArray[np.float64]
    spreads: NDArray[np.float64]
    ranks: NDArray[np.float64]
    scales: NDArray[np.float64]
    rows: NDArray[np.uint8]
    columns: NDArray[np.uint8]
    grid: tuple[int, int]
    corner: tuple[int, int]

    @property
    def conditional(self) -> NDArray[np.float64]:
        """(R, C) float64: every column of the joint histogram divided by its sum; empty columns stay 0."""
        sums = self.joint.sum(axis=0)
        return self.joint / np.where(sums > 0, sums, 1)

    @property
    def information(self) -> float:
        """Mutual information of the magnitudes' ranks in bits, 0 .. 3, mean over the orientations."""
        return float(np.mean([mutual_information(each) for each in self.ranks]))

    @property
    def nbytes(self) -> int:
        """Memory held."""
        return self.rows.nbytes + self.columns.nbytes

    def pixels(self, cells: Rectangle) -> NDArray[np.bool_]:
        """Return which pixels (H, W) of the image lie in a rectangle of cells, for any orientation."""
        top, bottom, left, right = cells
        inside = (self.rows >= top) & (self.rows <= bottom) & (self.columns >= left) & (self.columns <= right)
        whole = np.zeros(self.grid, bool)
        first, second = self.corner
        height, width = inside.shape[1:]
        whole[first : first + height, second : second + width] = inside.any(axis=0)
        return whole[np.ix_(*(_samples(*each) for each in zip(self.size, self.grid, strict=True)))]

    def cells(self, row: int, column: int) -> tuple[tuple[int, int], ...]:
        """Return the cell (row, column) of a pixel for every orientation; none for a pixel of the border."""
        places = []
        for at, side, count, first, kept in zip(
            (row, column), self.size, self.grid, self.corner, self.rows.shape[1:], strict=True
        ):
            place = at * count // side - first
            if not (0 <= at < side and 0 <= place < kept):
                return ()
            places.append(place)
        found = zip(self.rows[:, places[0], places[1]], self.columns[:, places[0], places[1]], strict=True)
        return tuple(dict.fromkeys((int(one), int(other)) for one, other in found))


def dependence(
    image: FloatImage,
    pair: Pair,
    values: Values = "coefficients",
    like: Dependence | None = None,
    look: Callable[[], None] = go_on,
) -> Dependence:
    """Return what the bands of an image have to do with each other.

    Parameters
    ----------
    image
        (H, W, C) float32; its luma is looked at.
    pair
        Which coefficients.
    values
        Of the axes: ``coefficients`` (real parts, over their standard deviation), ``magnitudes`` (powers of two,
        over their root mean square) or ``ranks`` (eighths of the magnitudes by rank).
    like
        An exemplar's, whose scales are taken, so that both have the same axes.
    look
        Called every few milliseconds; may raise ``Cancelled``.

    Raises
    ------
    ParamError
        When the image is too small for the level.
    """
    if values not in AXES:
        raise ParamError("values", f"one of {', '.join(AXES)}", values)
    height, width = image.shape[:2]
    if min(height, width) < pair.smallest:
        needed = f"at least {pair.smallest} pixels high and wide for level {pair.level}"
        raise ParamError("image", needed, f"{width} x {height}")
    samples, grid, corner = _samples_of(luma(image), pair, look)
    rows, columns, ranks, scales, sums = [], [], [], [], np.zeros((3, AXES[values][0]))
    cells, low, high = AXES[values]
    for place, (one, other) in enumerate(samples):
        look()
        magnitudes = np.abs(one), np.abs(other)
        look()
        ranks.append(joint_ranks(*magnitudes))
        known = None if like is None else like.scales[place]
        scale = np.array([_scale(each, values) for each in (one, other)]) if known is None else known
        scales.append(scale)
        look()
        if values == "ranks":
            axis = [(eighths(each) + 0.5) / RANKS for each in magnitudes]
        elif values == "magnitudes":
            axis = [np.log2(np.maximum(each / by, 2.0**-20)) for each, by in zip(magnitudes, scale, strict=True)]
        else:
            axis = [each.real / by for each, by in zip((one, other), scale, strict=True)]
        row, column = ((np.clip((each - low) / (high - low), 0, 1) * cells).astype(np.intp) for each in axis)
        np.minimum(row, cells - 1, out=row)
        np.minimum(column, cells - 1, out=column)
        look()
        looked_at = axis[0].reshape(-1).astype(np.float64)
        for power, total in enumerate(sums):
            total += np.bincount(column.reshape(-1), looked_at**power, cells)
        rows.append(row.astype(np.uint8))
        columns.append(column.astype(np.uint8))
    all_rows, all_columns = np.array(rows), np.array(columns)
    flat = all_rows.reshape(-1) * np.intp(cells) + all_columns.reshape(-1)
    joint = np.bincount(flat, minlength=cells * cells).reshape(cells, cells) / flat.size
    with np.errstate(invalid="ignore", divide="ignore"):
        means = sums[1] / sums[0]
        spreads = np.sqrt(np.maximum(sums[2] / sums[0] - means**2, 0))
    return Dependence(
        pair, values, (height, width), joint, means, spreads, np.array(ranks), np.array(scales), all_rows,
        all_columns, grid, corner,
    )  # fmt: skip


def rank_histograms(image: FloatImage, pair: Pair, look: Callable[[], None] = go_on) -> NDArray[np.float64]:
    """Return :func:`joint_ranks` of the magnitudes (K, 8, 8), by orientation, as in :class:`Dependence`."""
    samples, _, _ = _samples_of(luma(image), pair, look)
    found = []
    for one, other in samples:
        look()
        found.append(joint_ranks(np.abs(one), np.abs(other)))
    return np.array(found)


def joint_ranks(first: NDArray[np.floating], second: NDArray[np.floating]) -> NDArray[np.float64]:
    """Return the joint histogram of the ranks of two arrays of one shape.

    Returns
    -------
    ndarray
        (8, 8) float64 that sums to 1; rows are eighths of the first array's values by rank, columns of the
        second's. All are 1 / 64 where they are independent; the diagonal holds all where one follows from the
        other. Each column times 8 is the distribution of the first, given that eighth of the second.
    """
    counts = np.bincount((eighths(first) * RANKS + eighths(second)).reshape(-1), minlength=RANKS * RANKS)
    return counts.reshape(RANKS, RANKS) / first.size


def eighths(values: NDArray[np.floating]) -> NDArray[np.int64]:
    """Return in which eighth of all values by rank each one lies, 0 .. 7; equal values lie in one."""
    edges = np.quantile(values.reshape(-1), np.arange(1, RANKS) / RANKS)
    return np.searchsorted(edges, values, side="left")


def mutual_information(joint: NDArray[np.float64]) -> float:
    """Return the mutual information in bits of a joint histogram that sums to 1.

    0 for the product of its margins; log2(n) where one of n equally frequent cells follows from the other.
    """
    apart = joint.sum(axis=1)[:, None] * joint.sum(axis=0)
    there = joint > 0
    return max(0.0, float((joint[there] * np.log2(joint[there] / apart[there])).sum()))


def difference(first: NDArray[np.float64], second: NDArray[np.float64]) -> float:
    """Return the total variation (0 .. 1) between joint histograms (K, R, C), mean over the first axis.

    For the finest level, its parents and all orientations it is the measure ``dependence-difference``.
    """
    return float(np.abs(first - second).sum(axis=(1, 2)).mean()) / 2


def _samples_of(
    plane: NDArray[np.float32], pair: Pair, look: Callable[[], None]
) -> tuple[list[tuple[Complex, Complex]], tuple[int, int], tuple[int, int]]:
    """Return the two bands of every orientation where they count, the band's size, and the first that counts."""
    given = {orientation: pair.given(orientation) for orientation in pair.orientations}
    wanted = {*given.values(), *((pair.level, orientation) for orientation in given)}
    levels = max(level for level, _ in wanted) + 1
    bands = {
        (level, orientation): band
        for level, orientation, band in oriented_bands(plane, levels, look, wanted.__contains__)
    }
    height, width = bands[pair.level, pair.orientations[0]].shape
    border = BORDER << pair.level
    starts, ends = [], []
    for count, side, step in zip((height, width), plane.shape, pair.offset, strict=True):
        kept = math.ceil(border * count / side)
        step *= pair.relation == "neighbour"
        starts.append(kept + max(0, -step))
        ends.append(count - kept - max(0, step))
    if min(end - start for start, end in zip(starts, ends, strict=True)) < 1:
        raise ParamError("offset", "small enough for the image", pair.offset)
    inner = slice(starts[0], ends[0]), slice(starts[1], ends[1])
    found = []
    for orientation, key in given.items():
        look()
        child, other = bands[pair.level, orientation], bands[key]
        if pair.relation == "parent":
            places = (_samples(*sides) for sides in zip(child.shape, other.shape, strict=True))
            other = other[np.ix_(*places)]
        elif pair.relation == "neighbour":
            other = np.roll(other, (-pair.offset[0], -pair.offset[1]), axis=(0, 1))
        found.append((child[inner], other[inner]))
    return found, (height, width), (starts[0], starts[1])


def _samples(side: int, count: int) -> NDArray[np.int64]:
    """Return which of ``count`` samples lies over each of ``side`` places."""
    return np.arange(side) * count // side


def _scale(band: Complex, values: Values) -> float:
    """Return the root mean square of a band, or of its real part, which has no mean; 1 for an empty band."""
    part = np.abs(band) if values == "magnitudes" else band.real
    return math.sqrt(float(np.square(part, dtype=np.float64).mean())) or 1.0
