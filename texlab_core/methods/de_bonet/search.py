"""Three ways to the parent structures that match a location's, with counters (exercise 1).

*Blank search* compares the whole parent structure with every location of the exemplar's level.

*Hash keys*: a few components of the parent structure are divided by the square roots of their thresholds and
rounded down. Two structures that match differ by at most one in each of these numbers, so that all matches have
one of the 3^d keys around a structure's own; the structures under these keys are compared, the others are not
looked at. A component whose threshold is 0 must be equal and needs one key only; one that is constant tells
nothing and is not used.

*The hierarchy* compares the coarsest level and then only the children of what matched there (what sampling does).

All three find the same set. A structure counts as verified when it is compared, however early that fails.

Reference: Forsyth and Ponce, section 11.3.3, exercise 1; De Bonet 1997, eqs. 8 to 11.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.errors import ParamError
from texlab_core.methods.de_bonet.sampling import list_matches, match_chain
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.methods.de_bonet.sampling import Sampling

    Ints = NDArray[np.int64]
    Places = NDArray[np.intp]

# Components of a key: with more there are fewer structures under a key, but 3^d keys to look at.
COMPONENTS = 4
MOST_COMPONENTS = 6
_MOST_CELLS = 2**9
_PAIRS = 4096
_AT_ONCE = 2**18


@dataclass(frozen=True, slots=True)
class Tally:
    """What one way of searching did.

    Parameters
    ----------
    keys
        Keys that were looked up (0 without keys).
    verified
        Structures that were compared.
    found
        Structures that match.
    """

    keys: int
    verified: int
    found: int


@dataclass(frozen=True, slots=True)
class Component:
    """One component of the keys: a level, a feature, and the threshold between two of its values."""

    level: int
    feature: int
    threshold: float


@dataclass(frozen=True, slots=True, eq=False)
class Searched:
    """The same question answered three ways.

    Parameters
    ----------
    level
        The level whose locations were searched.
    blank, keys, hierarchy
        What each way did.
    matches
        (n,) int32: sorted locations of the exemplar's level, in quadtree order; the same for all three.
    key
        The key of the structure that was searched for.
    components
        What its numbers are.
    """

    level: int
    blank: Tally
    keys: Tally
    hierarchy: Tally
    matches: NDArray[np.int32]
    key: tuple[int, ...]
    components: tuple[Component, ...]


class KeyIndex:
    """The exemplar's parent structures of one level, by their keys.

    Parameters
    ----------
    sampling
        From the details of a De Bonet result.
    level
        1 to the coarsest: structures hold the features of this level and of all coarser ones.
    components
        How many numbers a key has, 1 to 6.

    Raises
    ------
    ParamError
        When level or components is out of range.
    """

    def __init__(self, sampling: Sampling, level: int, components: int = COMPONENTS) -> None:
        depth = sampling.grid.depth
        if not 1 <= level <= depth:
            raise ParamError("level", f"a whole number from 1 to {depth}", level)
        if not 1 <= components <= MOST_COMPONENTS:
            raise ParamError("components", f"a whole number from 1 to {MOST_COMPONENTS}", components)
        self.sampling, self.level = sampling, level
        self.components = _choose(sampling, level, components)
        self._tables = [self._values(each) for each in self.components]
        cells = self._cells(self._tables)
        # One number for each key: cells counted from one below the lowest, so that neighbours exist.
        self._low = cells.min(axis=0) - 1
        self._spans = cells.max(axis=0) - self._low + 2
        packed = self._pack(cells)
        self._order = np.argsort(packed, kind="stable").astype(np.int32)
        self._keys, self._starts = np.unique(packed[self._order], return_index=True)
        self._ends = np.append(self._starts[1:], packed.size)
        steps = [(0,) if each.threshold == 0 else (-1, 0, 1) for each in self.components]
        self._around = np.array(list(itertools.product(*steps)), np.int64)

    @property
    def structures(self) -> int:
        """Parent structures in the index: one for each location of the level."""
        return self._order.size

    @property
    def distinct(self) -> int:
        """Different keys that they have."""
        return int(self._keys.size)

    @property
    def around(self) -> int:
        """Keys that have to be looked at for one structure."""
        return len(self._around)

    def keys_of(self, places: Places) -> Ints:
        """Return the keys of locations of the output, (n, d) int64."""
        return self._cells([self._values_at(each, places) for each in self.components])

    def bucket_sizes(self, places: Places) -> Ints:
        """Return how many structures lie under the keys around each location of the output, (n,) int64."""
        found, known = self._look_up(places)
        sizes: Ints = np.where(known, (self._ends - self._starts)[found], 0).sum(axis=1)
        return sizes

    def candidates(self, place: int) -> NDArray[np.int32]:
        """Return the structures under the keys around one location of the output, sorted."""
        found, known = self._look_up(np.array([place]))
        parts = [self._order[self._starts[each] : self._ends[each]] for each in found[known]]
        return np.sort(np.concatenate(parts)) if parts else np.empty(0, np.int32)

    def _look_up(self, places: Places) -> tuple[Places, NDArray[np.bool_]]:
        around = self.keys_of(places)[:, None, :] + self._around
        # What lies beyond the exemplar's own cells has no structures.
        inside = ((around >= self._low) & (around < self._low + self._spans)).all(axis=-1)
        wanted = self._pack(around)
        found = np.minimum(np.searchsorted(self._keys, wanted), self._keys.size - 1)
        return found, inside & (self._keys[found] == wanted)

    def _cells(self, values: list[NDArray[np.float32]]) -> Ints:
        """Return the cells of values of each component, (n, d) int64."""
        cells = np.empty((values[0].size, len(values)), np.int64)
        for number, (component, table, each) in enumerate(zip(self.components, self._tables, values, strict=True)):
            if component.threshold == 0:
                cells[:, number] = np.searchsorted(np.unique(table), each)
                continue
            # A hair wider than the threshold: rounding must not push a match two cells away.
            width = np.sqrt(np.float64(component.threshold)) * (1 + 1e-6)
            # So many cells from the middle everything shares one, and matches still differ by at most 1.
            cells[:, number] = np.clip(np.floor(each.astype(np.float64) / width), -_MOST_CELLS, _MOST_CELLS)
        return cells

    def _values(self, component: Component) -> NDArray[np.float32]:
        """Return one component of the parent structure of every location of the exemplar's level."""
        places = np.arange(self.sampling.analysis.grid.count(self.level)) >> 2 * (component.level - self.level)
        features = self.sampling.analysis.levels[component.level].features
        values: NDArray[np.float32] = features[places, component.feature]
        return values

    def _values_at(self, component: Component, places: Places) -> NDArray[np.float32]:
        """Return the same of locations of the output: each of their ancestors has a source of its own."""
        ancestors = places >> 2 * (component.level - self.level)
        features = self.sampling.analysis.levels[component.level].features
        values: NDArray[np.float32] = features[
            self.sampling.sources[component.level][ancestors], component.feature
        ]
        return values

    def _pack(self, cells: Ints) -> Ints:
        packed = np.zeros(cells.shape[:-1], np.int64)
        for number in range(cells.shape[-1]):
            packed = packed * self._spans[number] + (cells[..., number] - self._low[number])
        return packed


def _choose(sampling: Sampling, level: int, components: int) -> tuple[Component, ...]:
    """Return components, one after the other: each parts most of the pairs that are still together.

    Pairs are near each other and far apart: what parts far ones may still leave the children of one parent
    together.
    """
    count = sampling.analysis.grid.count(level)
    one = np.arange(min(count, _PAIRS), dtype=np.int64) * (count // min(count, _PAIRS))
    pairs = [(one, (one * 7 + count // 3) % count), (one, one ^ 1 if count > 1 else one)]
    first, second = (np.concatenate(each) for each in zip(*pairs, strict=True))
    second = np.minimum(second, count - 1)
    possible, together = [], []
    for each in range(level, sampling.grid.depth + 1):
        features, row = sampling.analysis.levels[each].features, sampling.row(each)
        shift = 2 * (each - level)
        for feature in range(features.shape[1]):
            if np.ptp(features[:, feature]) > 0:
                apart = np.abs(features[first >> shift, feature] - features[second >> shift, feature])
                possible.append(Component(each, feature, float(row[feature])))
                together.append(apart <= 2 * np.sqrt(row[feature]))
    chosen: list[int] = []
    left = np.ones(first.size, bool)
    while len(chosen) < min(components, len(possible)):
        remaining = [index for index in range(len(possible)) if index not in chosen]
        best = min(remaining, key=lambda index: int(np.count_nonzero(left & together[index])))
        chosen.append(best)
        left &= together[best]
    # An exemplar of one colour has nothing but constants: any of them makes one key for all.
    found = tuple(possible[index] for index in chosen)
    return found or (Component(level, 0, float(sampling.row(level)[0])),)


def _verified(sampling: Sampling, level: int, place: int, candidates: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return those candidates whose whole parent structure matches that of a location of the output."""
    for each in range(sampling.grid.depth, level - 1, -1):
        shift = 2 * (each - level)
        features = sampling.analysis.levels[each].features
        difference = features[candidates >> shift] - features[sampling.sources[each][place >> shift]]
        candidates = candidates[(difference * difference <= sampling.row(each)).all(axis=1)]
    return candidates


def search(
    sampling: Sampling,
    row: int,
    column: int,
    level: int,
    components: int = COMPONENTS,
    index: KeyIndex | None = None,
) -> Searched:
    """Search the parent structures that match that of one location of the output, three ways.

    Parameters
    ----------
    sampling
        From the details of a De Bonet result.
    row, column
        The location, in the output at ``level``.
    level
        1 to the coarsest; the candidates of a pixel of level i are the children of the matches of level i + 1.
    components
        Numbers of a key.
    index
        A :class:`KeyIndex` of this sampling and level, when there is one already.

    Raises
    ------
    ParamError
        When the location is not in the output, or another parameter is out of range.
    """
    index = KeyIndex(sampling, level, components) if index is None else index
    place = sampling.grid.checked_location(level, row, column)
    blank = _verified(sampling, level, place, np.arange(index.structures, dtype=np.int32))
    under_keys = index.candidates(place)
    keyed = _verified(sampling, level, place, under_keys)
    chain = match_chain(sampling, level, place)
    tested = sampling.analysis.grid.count(sampling.grid.depth) + sum(4 * each.size for each in chain[:-1])
    return Searched(
        level,
        Tally(0, index.structures, blank.size),
        Tally(index.around, under_keys.size, keyed.size),
        Tally(0, tested, chain[-1].size),
        _same(blank, keyed, chain[-1]),
        tuple(int(each) for each in index.keys_of(np.array([place]))[0]),
        index.components,
    )


def _same(*found: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the set that all ways found; anything else is a fault of the program."""
    if not all(np.array_equal(found[0], each) for each in found[1:]):
        raise AssertionError("The three ways of searching must find the same structures.")
    return found[0]


@dataclass(frozen=True, slots=True)
class Survey:
    """What the three ways cost for all locations of a level of the output.

    Parameters
    ----------
    level
        The level.
    locations
        Locations of the output.
    structures
        Parent structures of the exemplar.
    distinct
        Different keys that these have.
    blank, keys, hierarchy
        Sums over all locations.
    """

    level: int
    locations: int
    structures: int
    distinct: int
    blank: Tally
    keys: Tally
    hierarchy: Tally


def survey(
    sampling: Sampling, level: int, components: int = COMPONENTS, look: Callable[[], None] = go_on
) -> Survey:
    """Count what the three ways cost for every location of a level.

    Parameters
    ----------
    sampling
        From the details of a De Bonet result.
    level
        1 to the coarsest.
    components
        Numbers of a key.
    look
        Called between pieces; may raise to stop.

    Raises
    ------
    ParamError
        When level or components is out of range.
    """
    index = KeyIndex(sampling, level, components)
    locations = sampling.grid.count(level)
    under_keys = 0
    for first in range(0, locations, max(1, _AT_ONCE // index.around)):
        look()
        places = np.arange(first, min(locations, first + max(1, _AT_ONCE // index.around)))
        under_keys += int(index.bucket_sizes(places).sum())
    depth = sampling.grid.depth
    # Each location tests the coarsest level, and four children of every match of each of its ancestors.
    tested = locations * sampling.analysis.grid.count(depth)
    for each in range(depth, level, -1):
        look()
        tested += 4 * int(_matches(sampling, each).sum()) << 2 * (each - level)
    found = int(_matches(sampling, level).sum())
    return Survey(
        level,
        locations,
        index.structures,
        index.distinct,
        Tally(0, locations * index.structures, found),
        Tally(locations * index.around, under_keys, found),
        Tally(0, tested, found),
    )


def _matches(sampling: Sampling, level: int) -> Ints:
    """Return how many structures match each location of a level of the output."""
    counted = list_matches(sampling) if level == 1 else sampling.matches[level]
    return counted.astype(np.int64)
