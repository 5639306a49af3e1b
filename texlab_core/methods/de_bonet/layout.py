"""The coarsest level of the output: what is laid out before anything is sampled.

The paper repeats the exemplar's coarsest level, a single pixel. A larger one that is repeated as it is tiles, and
one that is repeated with random shifts has straight cuts where repetitions meet. The layouts ``patches`` and
``fit`` choose what is laid down next to what by how well it continues what lies there already, in strips of the
exemplar at full resolution along every line between cells.

Reference: De Bonet 1997, section 4.3, for ``tile``; the others go beyond it.
"""

from __future__ import annotations

import heapq
import itertools
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from numpy.typing import NDArray

    from texlab_core.engine.streams import Streams
    from texlab_core.methods.de_bonet.choices import Coarsest
    from texlab_core.methods.de_bonet.quadtree import Grid
    from texlab_core.methods.de_bonet.seams import Seams

# Places that are compared for one patch.
_MOST_PLACES = 512
# How far the middle of a patch may lie from its place in the pattern, as a share of the patch.
_JITTER = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """How the coarsest level is laid out.

    Parameters
    ----------
    coarsest
        ``patches``: irregular parts of the exemplar, each from a place that continues its neighbours;
        ``fit``: whole repetitions, each shifted cyclically so that it continues its neighbours;
        ``shift``: repetitions shifted cyclically at random; ``tile``: repetitions as they are; ``iid``: every
        location at random.
    patch
        Width of a patch as a share of the exemplar's shorter side.
    places
        From how many of the places that continue best one is drawn.
    periodic
        Whether the output continues itself, so that its opposite sides are neighbours too.
    anew
        Whether ``patches`` lay out an output no larger than the exemplar too, instead of the exemplar itself.
    """

    coarsest: Coarsest = "patches"
    patch: float = 0.45
    places: int = 3
    periodic: bool = False
    anew: bool = False


class _Region(NamedTuple):
    """Locations that are laid down together: (2, n) rows and columns in the output, and within their box."""

    cells: NDArray[np.int64]
    inside: NDArray[np.int64]


def lay_out_steps(
    seams: Seams, exemplar: Grid, whole: tuple[int, int], output: Grid, layout: Layout, streams: Streams
) -> Generator[None, None, NDArray[np.int32]]:
    """Return the source of every location of the coarsest level, in raster order.

    An output no larger than the exemplar is not shifted, so that it can be the exemplar itself; where it is to
    continue itself, ``patches`` and ``fit`` lay it out all the same, and ``patches`` where it is to be new.

    Parameters
    ----------
    seams
        Of the exemplar.
    exemplar, output
        Locations of both.
    whole
        Rows and columns of the exemplar's coarsest level that hold nothing padded.
    streams
        Of the job.

    Returns
    -------
    ndarray
        (rows * columns,) int32.
    """
    fits = output.rows <= exemplar.rows and output.columns <= exemplar.columns
    fitted = layout.coarsest in ("patches", "fit")
    anew = layout.anew and layout.coarsest == "patches"
    if fitted and (layout.periodic or anew or not fits):
        random = streams(layout.coarsest)
        cyclic = layout.coarsest == "fit"
        room = (exemplar.rows, exemplar.columns) if cyclic else whole
        regions = (
            _repetitions(output, room) if cyclic else _patches(output, room, layout.patch, layout.periodic, random)
        )
        return (yield from _place(seams, regions, output, room, layout, random))
    row, column = np.divmod(np.arange(output.rows * output.columns, dtype=np.int64), output.columns)
    key = streams.key("coarsest")
    if layout.coarsest == "iid":
        return _hashed(key, row, column, exemplar.rows * exemplar.columns).astype(np.int32)
    if layout.coarsest == "shift" and not fits:
        tile_row, tile_column = row // exemplar.rows, column // exemplar.columns
        shift = _hashed(key, tile_row, tile_column, exemplar.rows * exemplar.columns)
        row, column = row + shift // exemplar.columns, column + shift % exemplar.columns
    source: NDArray[np.int64] = row % exemplar.rows * exemplar.columns + column % exemplar.columns
    return source.astype(np.int32)


def _hashed(key: int, row: NDArray[np.int64], column: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """Return a number in 0 .. count - 1 for each place, the same wherever the place is asked for."""
    value = (row.astype(np.uint64) << np.uint64(32)) + column.astype(np.uint64)
    with np.errstate(over="ignore"):
        value = (value + np.uint64(1)) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(key)
        value = (value ^ (value >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        value = (value ^ (value >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    value ^= value >> np.uint64(31)
    return ((value >> np.uint64(32)) * np.uint64(count) >> np.uint64(32)).astype(np.int64)


def _repetitions(output: Grid, room: tuple[int, int]) -> Iterator[_Region]:
    """Split the output into blocks as large as the exemplar."""
    for top in range(0, output.rows, room[0]):
        for left in range(0, output.columns, room[1]):
            extent = (min(room[0], output.rows - top), min(room[1], output.columns - left))
            inside = np.indices(extent).reshape(2, -1)
            yield _Region(inside + np.array([[top], [left]]), inside)


def _patches(
    output: Grid, room: tuple[int, int], share: float, periodic: bool, random: np.random.Generator
) -> Iterator[_Region]:
    """Split the output into irregular patches: the cells nearest to each middle of a jittered brick pattern."""
    from texlab_core.kernels.patches import nearest_middles

    step = max(1.0, share * min(room))
    counts, steps, starts = [], [], []
    for length in (output.rows, output.columns):
        if periodic:
            # A whole number of patches, at least two: with one alone, nothing would be chosen to continue itself.
            count = max(min(2, length), round(length / step))
            counts.append(count)
            steps.append(length / count)
        else:
            counts.append(int(np.ceil(length / step)) + 3)
            steps.append(step)
        starts.append(-(1 + random.random()) * steps[-1])
    jitter = (random.random((2, *counts)) - 0.5) * 2 * _JITTER
    row_step, column_step = steps
    middles_down = starts[0] + (np.arange(counts[0])[:, None] + jitter[0]) * row_step
    shifted = np.arange(counts[1]) + (np.arange(counts[0]) % 2)[:, None] / 2
    middles_right = starts[1] + (shifted + jitter[1]) * column_step

    rows, columns = np.indices((output.rows, output.columns)).reshape(2, -1)
    label, offset = np.empty(rows.size, np.int64), np.empty((2, rows.size))
    middles = np.stack((middles_down, middles_right))
    size = np.array([output.rows, output.columns])
    nearest_middles(middles, np.array(starts), np.array(steps), size, periodic, label, offset)
    # Distances from one middle are whole numbers apart.
    order = np.argsort(label, kind="stable")
    cells, offset = np.stack((rows, columns))[:, order], offset[:, order]
    bounds = [0, *(np.flatnonzero(np.diff(label[order])) + 1).tolist(), order.size]
    for first, last in itertools.pairwise(bounds):
        part, off = cells[:, first:last], offset[:, first:last]
        inside = np.ascontiguousarray(np.round(off - off.min(1, keepdims=True)), np.int64)
        if inside[0].max() < room[0] and inside[1].max() < room[1]:
            yield _Region(np.ascontiguousarray(part), inside)
            continue
        # What is larger than the exemplar is laid down in parts.
        boxes = inside // np.array(room)[:, None]
        number = boxes[0] * (boxes[1].max() + 1) + boxes[1]
        for each in np.unique(number):
            chosen = inside[:, number == each]
            lower = np.ascontiguousarray(chosen - chosen.min(1, keepdims=True))
            yield _Region(np.ascontiguousarray(part[:, number == each]), lower)


def _connected(regions: list[_Region], output: Grid, periodic: bool) -> Iterator[_Region]:
    """Yield the regions in their order, but each (the first apart) only when a neighbour of it has come before."""
    number = np.empty((output.rows, output.columns), np.int64)
    for index, region in enumerate(regions):
        number[region.cells[0], region.cells[1]] = index
    beside: list[set[int]] = [set() for _ in regions]
    for axis in (0, 1):
        kept = range(number.shape[axis] if periodic else number.shape[axis] - 1)
        pairs = np.stack([each.take(kept, axis).ravel() for each in (number, np.roll(number, -1, axis))])
        for one, other in np.unique(pairs[:, pairs[0] != pairs[1]], axis=1).T.tolist():
            beside[one].add(other)
            beside[other].add(one)
    waiting, known = [0], {0}
    while waiting:
        index = heapq.heappop(waiting)
        yield regions[index]
        for each in beside[index] - known:
            known.add(each)
            heapq.heappush(waiting, each)


def _place(
    seams: Seams,
    regions: Iterator[_Region],
    output: Grid,
    room: tuple[int, int],
    layout: Layout,
    random: np.random.Generator,
) -> Generator[None, None, NDArray[np.int32]]:
    """Lay down one region after the other, each from a place that continues what lies beside it."""
    from texlab_core.kernels.patches import weigh_places

    taken = np.full((2, output.rows, output.columns), -1, np.int64)
    cyclic = layout.coarsest == "fit"
    extent = np.array([seams.rows, seams.columns])
    for region in _connected(list(regions), output, layout.periodic):
        places = _places(region, room, cyclic, random)
        cost, same = np.zeros(places.shape[1]), np.zeros(places.shape[1], np.bool_)
        neighbours = 0
        for direction, lines in enumerate(seams.lines):
            neighbours += weigh_places(
                region.cells, region.inside, places, taken, extent, layout.periodic, cyclic, direction,
                lines.before, lines.behind, lines.table_before, lines.table_behind, cost, same,
            )  # fmt: skip
        # Going on as a neighbour does would fit best, and repeat the exemplar.
        allowed = np.flatnonzero(~same)
        if allowed.size == 0:
            allowed = np.arange(same.size)
        if neighbours:
            allowed = allowed[np.argsort(cost[allowed], kind="stable")[: layout.places]]
        chosen = int(allowed[random.integers(allowed.size)])
        found = region.inside + places[:, chosen, None]
        taken[:, region.cells[0], region.cells[1]] = found % extent[:, None] if cyclic else found
        yield
    source: NDArray[np.int32] = (taken[0] * seams.columns + taken[1]).ravel().astype(np.int32)
    return source


def _places(
    region: _Region, room: tuple[int, int], cyclic: bool, random: np.random.Generator
) -> NDArray[np.int64]:
    """Return where in the exemplar the box of a region can lie, (2, n): everywhere, or where it fits."""
    extent = (0, 0) if cyclic else region.inside.max(1).tolist()
    rows, columns = room[0] - extent[0], room[1] - extent[1]
    if rows * columns <= _MOST_PLACES:
        return _every_place(rows, columns)
    chosen = random.choice(rows * columns, _MOST_PLACES, replace=False)
    return np.stack(np.divmod(chosen, columns))


@lru_cache(maxsize=256)
def _every_place(rows: int, columns: int) -> NDArray[np.int64]:
    # Kernels are compiled anew for arrays that are read-only; nobody writes into this one.
    return np.indices((rows, columns)).reshape(2, -1)
