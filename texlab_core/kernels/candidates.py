"""Candidate sets of De Bonet's sampling and the steady choice from them.

Sets are lists of exemplar locations in quadtree order, sorted, one after the other in ``members``; set ``e`` is
``members[starts[e]:starts[e + 1]]``. Every kernel stops early when its budget of elementary comparisons is spent
and returns how far it came.

The choice is a min-hash. For every synthesized location a keyed permutation ranks all exemplar locations; the
candidate of smallest rank wins. It is found by ranking the candidates of a short set, and by proposing locations
in the order of their rank where the set is long or not even listed: both find the same winner.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.kernels.jit import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Ints = NDArray[np.int32]
    Longs = NDArray[np.int64]
    Floats = NDArray[np.float32]

# Below this many bits the keyed permutations would not be random enough.
MIN_BITS = 12
# One proposal (a search in the list) costs about as much as ranking this many candidates.
PROPOSAL_COST = 16
DEFERRED = -1
FULL = 1

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
_MIX_2 = np.uint64(0x94D049BB133111EB)
_ONE = np.uint32(1)
_TWO = np.uint32(2)


@njit
def mix(value: np.uint64) -> np.uint64:
    """Scramble 64 bits (the finalizer of splitmix64)."""
    value = (value ^ (value >> np.uint64(30))) * _MIX_1
    value = (value ^ (value >> np.uint64(27))) * _MIX_2
    return value ^ (value >> np.uint64(31))


@njit
def _permutation(key: np.uint64, place: int) -> tuple[np.uint32, np.uint32, np.uint32]:
    """Return the offset and the two odd factors of the permutation that belongs to a synthesized location."""
    first = mix(key + np.uint64(place) * _GOLDEN)
    second = mix(first)
    return (
        np.uint32(first & np.uint64(0xFFFFFFFF)),
        np.uint32(first >> np.uint64(32)) | _ONE,
        np.uint32(second >> np.uint64(32)) | _ONE,
    )


@njit
def _rank(value: int, offset: np.uint32, one: np.uint32, two: np.uint32, bits: int) -> np.uint32:
    mask, fold = np.uint32((1 << bits) - 1), np.uint32((bits + 1) // 2)
    x = np.uint32(np.uint32(np.uint32(np.uint32(value) + offset) * one) & mask)
    x = np.uint32(x ^ np.uint32(x >> fold))
    x = np.uint32(np.uint32(x * two) & mask)
    return np.uint32(x ^ np.uint32(x >> fold))


@njit
def _odd_inverse(factor: np.uint32) -> np.uint32:
    """Return the inverse modulo 2^32: three correct bits to start with, doubled by each Newton step."""
    inverse = factor
    for _ in range(4):
        inverse = np.uint32(inverse * np.uint32(_TWO - np.uint32(factor * inverse)))
    return inverse


@njit
def _unrank(rank: np.uint32, offset: np.uint32, undo_one: np.uint32, undo_two: np.uint32, bits: int) -> int:
    mask, fold = np.uint32((1 << bits) - 1), np.uint32((bits + 1) // 2)
    x = np.uint32(rank ^ np.uint32(rank >> fold))
    x = np.uint32(np.uint32(x * undo_two) & mask)
    x = np.uint32(x ^ np.uint32(x >> fold))
    return int(np.uint32(np.uint32(np.uint32(x * undo_one) - offset) & mask))


@njit
def ranks(key: np.uint64, place: int, bits: int, candidates: Ints, out: Longs) -> None:
    """Write the rank of each candidate for a synthesized location; the smallest wins."""
    offset, one, two = _permutation(key, place)
    for i in range(candidates.size):
        out[i] = _rank(candidates[i], offset, one, two, bits)


@njit
def _matches(features: Floats, thresholds: Floats, one: int, other: int) -> bool:
    """Tell whether every component differs by no more than its threshold (eqs. 9 to 11)."""
    for j in range(thresholds.size):
        difference = features[one, j] - features[other, j]
        if difference * difference > thresholds[j]:
            return False
    return True


@njit
def _contains(members: Ints, first: int, last: int, value: int) -> bool:
    end = last
    while first < last:
        middle = (first + last) >> 1
        if members[middle] < value:
            first = middle + 1
        else:
            last = middle
    return first < end and members[first] == value


@njit
def list_set(
    parents: Ints,
    first: int,
    last: int,
    fan: int,
    features: Floats,
    thresholds: Floats,
    source: int,
    out: Ints,
    at: int,
) -> int:
    """List the children of ``parents[first:last]`` that match ``source`` into ``out[at:]``; return the end.

    ``fan`` is 4, or 1 at the coarsest level, where the parents stand for themselves.
    """
    for i in range(first, last):
        for child in range(parents[i] * fan, parents[i] * fan + fan):
            if _matches(features, thresholds, source, child):
                out[at] = child
                at += 1
    return at


@njit
def match_sets(
    first: int,
    last: int,
    base: int,
    fan: int,
    upper_of: Ints,
    upper_base: int,
    upper_starts: Longs,
    upper_members: Ints,
    source: Ints,
    classes: Ints,
    features: Floats,
    thresholds: Floats,
    defer_from: int,
    set_of: Ints,
    keys: Longs,
    known: Ints,
    starts: Longs,
    members: Ints,
    tally: Longs,
    budget: int,
) -> int:
    """Find M_m for the locations first..last-1 of a level, one set for each (parent set, source class).

    Parameters
    ----------
    base
        First location of the run that ``set_of`` (n,) covers.
    fan
        4, or 1 at the coarsest level.
    upper_of, upper_base, upper_starts, upper_members
        Sets of the parents, and the first parent that ``upper_of`` covers.
    source
        Source of every location of the level.
    classes
        Class of every exemplar location: equal when all features are.
    defer_from
        Sets of at least this many parents are not listed; their locations get ``DEFERRED``.
    keys, known
        Hash table (its length a power of two): -1 for empty, and the set that belongs to the key.
    starts, members, tally
        The sets found; tally holds their number, the number of members, and ``FULL`` when members ran out.
    """
    mask = keys.size - 1
    work = 0
    for n in range(first, last):
        if work > budget:
            return n
        upper = upper_of[(n >> 2 if fan == 4 else 0) - upper_base]
        low, high = upper_starts[upper], upper_starts[upper + 1]
        key = (np.int64(upper) << 32) | np.int64(classes[source[n]])
        slot = np.int64(mix(np.uint64(key)) & np.uint64(mask))
        while keys[slot] != -1 and keys[slot] != key:
            slot = (slot + 1) & mask
        work += 4
        if keys[slot] == key:
            set_of[n - base] = known[slot]
            continue
        if high - low >= defer_from:
            set_of[n - base] = DEFERRED
            continue
        if members.size - tally[1] < (high - low) * fan:
            tally[2] = FULL
            return n
        end = list_set(upper_members, low, high, fan, features, thresholds, source[n], members, tally[1])
        work += (high - low) * fan
        keys[slot] = key
        known[slot] = tally[0]
        set_of[n - base] = tally[0]
        tally[0] += 1
        tally[1] = end
        starts[tally[0]] = end
    return last


@njit
def _smallest(
    members: Ints,
    first: int,
    last: int,
    literal: bool,
    offset: np.uint32,
    one: np.uint32,
    two: np.uint32,
    bits: int,
) -> int:
    """Return the candidate of smallest rank by ranking them all."""
    best = np.uint32(0xFFFFFFFF)
    for i in range(first, last):
        if literal:
            for child in range(4 * members[i], 4 * members[i] + 4):
                best = min(best, _rank(child, offset, one, two, bits))
        else:
            best = min(best, _rank(members[i], offset, one, two, bits))
    return _unrank(best, offset, _odd_inverse(one), _odd_inverse(two), bits)


@njit
def _first_proposed(
    members: Ints,
    first: int,
    last: int,
    literal: bool,
    offset: np.uint32,
    one: np.uint32,
    two: np.uint32,
    bits: int,
) -> int:
    """Return the candidate of smallest rank by proposing locations in the order of their rank."""
    undo_one, undo_two = _odd_inverse(one), _odd_inverse(two)
    for rank in range(1 << bits):
        value = _unrank(np.uint32(rank), offset, undo_one, undo_two, bits)
        if _contains(members, first, last, value >> 2 if literal else value):
            return value
    return -1


@njit
def _draw(members: Ints, first: int, last: int, literal: bool, bits: int, key: np.uint64, place: int) -> int:
    """Choose a child of ``members[first:last]`` for a synthesized location."""
    parity = place & 3
    size = last - first
    offset, one, two = _permutation(key, place)
    count = 4 * size if literal else size
    if count * count > PROPOSAL_COST << bits:
        found = _first_proposed(members, first, last, literal, offset, one, two, bits)
    else:
        found = _smallest(members, first, last, literal, offset, one, two, bits)
    return found if literal else 4 * found + parity


@njit
def _draw_unlisted(
    upper_members: Ints,
    low: int,
    high: int,
    fan: int,
    features: Floats,
    thresholds: Floats,
    source: int,
    literal: bool,
    bits: int,
    key: np.uint64,
    place: int,
    tries: int,
) -> int:
    """Choose as ``_draw`` does without the list of candidates; -1 when too many proposals failed."""
    offset, one, two = _permutation(key, place)
    undo_one, undo_two = _odd_inverse(one), _odd_inverse(two)
    for rank in range(tries):
        value = _unrank(np.uint32(rank), offset, undo_one, undo_two, bits)
        match = value >> 2 if literal else value
        # Locations beyond the last one are no parent's children, and so they fail here too.
        parent = match >> 2 if fan == 4 else match
        if _contains(upper_members, low, high, parent) and _matches(features, thresholds, source, match):
            return value if literal else 4 * value + (place & 3)
    return -1


@njit
def choose_sources(
    first: int,
    last: int,
    base: int,
    set_of: Ints,
    starts: Longs,
    members: Ints,
    fan: int,
    upper_of: Ints,
    upper_base: int,
    upper_starts: Longs,
    upper_members: Ints,
    source: Ints,
    features: Floats,
    thresholds: Floats,
    literal: bool,
    bits: int,
    key: np.uint64,
    scratch: Ints,
    counts: Ints,
    children: Ints,
    budget: int,
) -> int:
    """Choose the sources of the children of locations first..last-1 (eq. 12).

    Parameters
    ----------
    set_of, starts, members
        The sets M of these locations, from :func:`match_sets`; the further arguments up to ``thresholds`` are
        the ones given there.
    literal
        All children of M are candidates; otherwise those of the same parity as the synthesized location.
    bits
        Size of the permutations: at least the bits of a candidate (of its parent, under the parity rule).
    key
        Key of the random stream of the children's level.
    scratch
        Room for one set that has to be listed after all.
    counts
        Size of M for each location of its level, -1 where it was never listed.
    children
        Sources of the children's level, written at 4 · first .. 4 · last - 1.
    """
    work = 0
    for n in range(first, last):
        if work > budget:
            return n
        which = set_of[n - base]
        work += 16
        if which >= 0:
            low, high = starts[which], starts[which + 1]
            counts[n] = high - low
            if high - low == 1 and not literal:
                # The only candidate: no need to rank it. This is what most locations of a texture have.
                for place in range(4):
                    children[4 * n + place] = 4 * members[low] + place
                continue
            for place in range(4 * n, 4 * n + 4):
                children[place] = _draw(members, low, high, literal, bits, key, place)
            work += min(4 * (high - low), 1024)
            continue
        upper = upper_of[(n >> 2 if fan == 4 else 0) - upper_base]
        low, high = upper_starts[upper], upper_starts[upper + 1]
        size = counts[n] = DEFERRED
        for place in range(4 * n, 4 * n + 4):
            found = -1
            if size < 0:
                found = _draw_unlisted(
                    upper_members, low, high, fan, features, thresholds, source[n], literal, bits, key, place,
                    (high - low) >> 2,
                )  # fmt: skip
                work += 64
                if found < 0:
                    size = list_set(upper_members, low, high, fan, features, thresholds, source[n], scratch, 0)
                    counts[n] = size
                    work += (high - low) * fan
            if found < 0:
                found = _draw(scratch, 0, size, literal, bits, key, place)
            children[place] = found
    return last
