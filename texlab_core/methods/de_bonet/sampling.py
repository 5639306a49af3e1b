"""Exact sampling with hierarchical candidate sets.

With M_m(n) the exemplar locations that match location n of the output at level m and at all coarser ones,

    M_N(n) = { q of level N : the features of q match those of n's source }
    M_m(n) = { q in children(M_{m+1}(parent n)) : the features of q match those of n's source }     m < N

and the candidates of a location of level i are the children of M_{i+1} of its parent: the set C of eqs. 9 and 11.
Levels are made one after the other; where the sets of a level would take too much memory, the output below a run
of its locations is finished first. Neither that nor the chunks change any bit: all choices are keyed by location.

Reference: De Bonet 1997, section 4.2, eqs. 8 to 12, and its pseudo-code SynthesizePyramid.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from texlab_core.methods.de_bonet.layout import lay_out_steps
from texlab_core.methods.de_bonet.quadtree import Grid
from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from numpy.typing import NDArray

    from texlab_core.engine.streams import Streams
    from texlab_core.methods.de_bonet.analysis import Analysis
    from texlab_core.methods.de_bonet.layout import Layout

Progress = tuple[int, int]

# A kernel returns after about this many comparisons: a few milliseconds.
BUDGET = 400_000
# Members of stored sets, and locations that have one, before the output is finished in parts.
STORED_MEMBERS = 2**24
STORED_NODES = 2**20
# The sets of level 1 are used at once and not stored.
NODES_AT_ONCE = 2**13


class Sets(NamedTuple):
    """Sets M of a run of locations.

    Parameters
    ----------
    base
        First location of the run.
    of
        (n,) int32: which set each location has, -1 where it is not listed.
    starts, members
        Set e is ``members[starts[e]:starts[e + 1]]``, sorted exemplar locations of this level.
    """

    base: int
    of: NDArray[np.int32]
    starts: NDArray[np.int64]
    members: NDArray[np.int32]


@dataclass(frozen=True, eq=False, slots=True)
class Sampling:
    """A sampled pyramid.

    Parameters
    ----------
    analysis
        What it was sampled from.
    grid
        Locations of the output.
    thresholds
        (N, J) float32, row k - 1 for the k-th level from the coarsest.
    literal
        For each level below N: whether all children of a match are candidates, not only those of equal parity.
    keys
        For each level below N: key of its choices.
    sources
        For each level 0 .. N: (Q,) int32 exemplar location of every output location, in quadtree order.
    matches
        For each level 0 .. N: (Q,) int32 size of M, -1 where it was never listed; level 0 has none, (0,).
    """

    analysis: Analysis
    grid: Grid
    thresholds: NDArray[np.float32]
    literal: tuple[bool, ...]
    keys: tuple[int, ...]
    sources: tuple[NDArray[np.int32], ...]
    matches: tuple[NDArray[np.int32], ...]

    def row(self, level: int) -> NDArray[np.float32]:
        """Return the thresholds of a level, (J,) float32."""
        row: NDArray[np.float32] = self.thresholds[self.grid.depth - level]
        return row


def prepare_steps(
    analysis: Analysis,
    thresholds: NDArray[np.float32],
    size: tuple[int, int],
    *,
    layout: Layout,
    literal_levels: int,
    streams: Streams,
) -> Generator[None, None, Sampling]:
    """Allocate a sampling and lay out its coarsest level.

    Parameters
    ----------
    thresholds
        (N, J) float32.
    size
        Height and width that the output must at least have.
    layout
        What the coarsest level is made of.
    literal_levels
        How many of the coarsest sampled levels take all children of a match as candidates.
    """
    grid = Grid.covering(*size, analysis.depth)
    depth = grid.depth
    sources = [np.empty(grid.count(level), np.int32) for level in range(depth)]
    laying = lay_out_steps(analysis.seams, analysis.grid, analysis.whole, grid, layout, streams)
    sources.append((yield from laying))
    matches = [np.empty(grid.count(level) if level else 0, np.int32) for level in range(depth + 1)]
    literal = tuple(level >= depth - literal_levels for level in range(depth))
    keys = tuple(streams.key("choice", level) for level in range(depth))
    return Sampling(analysis, grid, thresholds, literal, keys, tuple(sources), tuple(matches))


def sample_steps(sampling: Sampling) -> Iterator[Progress]:
    """Fill in sources and matches; yields (level, count) when ``count`` more locations of a level are made.

    A level is complete no later than the finer ones. A count of 0 means that time has passed.
    """
    depth = sampling.grid.depth
    if depth == 0:
        return
    everything = np.arange(sampling.analysis.grid.count(depth), dtype=np.int32)
    above = Sets(0, np.zeros(1, np.int32), np.array([0, everything.size]), everything)
    yield from _descend(sampling, depth, 0, sampling.grid.count(depth), above)


def candidate_bits(sampling: Sampling, level: int) -> int:
    """Return the size in bits of the permutations that rank the candidates of a level below N."""
    from texlab_core.kernels.candidates import MIN_BITS

    domain = sampling.analysis.grid.count(level if sampling.literal[level] else level + 1)
    return max(MIN_BITS, (domain - 1).bit_length())


def _descend(sampling: Sampling, level: int, first: int, last: int, above: Sets) -> Iterator[Progress]:
    """Finish the output below locations first..last-1 of a level, in as few parts as memory allows."""
    while first < last:
        at_once = NODES_AT_ONCE if level == 1 else STORED_NODES
        stop = min(last, first + at_once)
        sets = yield from _match(sampling, level, first, stop, above)
        stop = first + sets.of.size
        yield from _choose(sampling, level, first, stop, sets, above)
        if level > 1:
            yield from _descend(sampling, level - 1, 4 * first, 4 * stop, sets)
        first = stop


def _match(
    sampling: Sampling, level: int, first: int, last: int, above: Sets, *, defer: bool = True
) -> Generator[Progress, None, Sets]:
    """Return the sets of locations first..last-1, or of fewer where they would take too much memory."""
    from texlab_core.kernels.candidates import FULL, match_sets

    analysed = sampling.analysis.levels[level]
    count = last - first
    of = np.empty(count, np.int32)
    slots = 1 << (2 * count - 1).bit_length()
    keys, known = np.full(slots, -1, np.int64), np.empty(slots, np.int32)
    starts, tally = np.zeros(count + 1, np.int64), np.zeros(3, np.int64)
    members = np.empty(max(4 * count, 4 * analysed.classes.size), np.int32)
    defer_from = _defer_from(sampling) if level == 1 and defer else np.iinfo(np.int64).max
    done = first
    while done < last:
        done = match_sets(
            done, last, first, 1 if level == sampling.grid.depth else 4, above.of, above.base, above.starts,
            above.members, sampling.sources[level], analysed.classes, analysed.features, sampling.row(level),
            defer_from, of, keys, known, starts, members, tally, BUDGET,
        )  # fmt: skip
        yield level, 0
        if tally[2] == FULL:
            if members.size >= STORED_MEMBERS and done > first:
                break
            members = np.concatenate((members, np.empty_like(members)))
            tally[2] = 0
    return Sets(first, of[: done - first], starts, members[: tally[1]])


def _choose(sampling: Sampling, level: int, first: int, last: int, sets: Sets, above: Sets) -> Iterator[Progress]:
    """Choose the sources of the children of locations first..last-1."""
    from texlab_core.kernels.candidates import choose_sources

    analysed = sampling.analysis.levels[level]
    scratch = np.empty(analysed.classes.size if level == 1 else 0, np.int32)
    while first < last:
        stop = choose_sources(
            first, last, sets.base, sets.of, sets.starts, sets.members, 1 if level == sampling.grid.depth else 4,
            above.of, above.base, above.starts, above.members, sampling.sources[level], analysed.features,
            sampling.row(level), sampling.literal[level - 1], candidate_bits(sampling, level - 1),
            np.uint64(sampling.keys[level - 1]), scratch, sampling.matches[level], sampling.sources[level - 1],
            BUDGET,
        )  # fmt: skip
        yield level - 1, 4 * (stop - first)
        first = stop


def _defer_from(sampling: Sampling) -> int:
    """Return the number of parents from which proposals at level 1 are cheaper than a list."""
    if sampling.grid.depth == 1:
        return np.iinfo(np.int64).max
    parents = sampling.analysis.grid.count(2)
    return max(64, int(4 * parents**0.5))


def match_chain(sampling: Sampling, level: int, place: int) -> list[NDArray[np.int32]]:
    """Return the sets M of a location's ancestors and of itself, levels N .. ``level``, sorted int32 each."""
    from texlab_core.kernels.candidates import list_set

    depth = sampling.grid.depth
    found = np.arange(sampling.analysis.grid.count(depth), dtype=np.int32)
    chain = []
    for m in range(depth, level - 1, -1):
        fan = 1 if m == depth else 4
        out = np.empty(found.size * fan, np.int32)
        source = sampling.sources[m][place >> 2 * (m - level)]
        features = sampling.analysis.levels[m].features
        end = list_set(found, 0, found.size, fan, features, sampling.row(m), source, out, 0)
        found = out[:end]
        chain.append(found)
    return chain


def list_matches(sampling: Sampling) -> NDArray[np.int32]:
    """Return the exact size of M for every location of level 1, listing the sets that sampling did not need."""
    known: NDArray[np.int32] = sampling.matches[1]
    if (known >= 0).all():
        return known
    everything = np.arange(sampling.analysis.grid.count(sampling.grid.depth), dtype=np.int32)
    above = Sets(0, np.zeros(1, np.int32), np.array([0, everything.size]), everything)
    out = known.copy()
    _count(sampling, sampling.grid.depth, 0, sampling.grid.count(sampling.grid.depth), above, out)
    return out


def _count(sampling: Sampling, level: int, first: int, last: int, above: Sets, out: NDArray[np.int32]) -> None:
    while first < last:
        stop = min(last, first + (NODES_AT_ONCE if level == 1 else STORED_NODES))
        sets = finish(_match(sampling, level, first, stop, above, defer=False))
        stop = first + sets.of.size
        if level == 1:
            out[first:stop] = np.diff(sets.starts)[sets.of]
        else:
            _count(sampling, level - 1, 4 * first, 4 * stop, sets, out)
        first = stop
