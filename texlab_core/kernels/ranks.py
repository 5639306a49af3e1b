"""Rank matching: replace every value by the target value of the same rank, with ties broken at random.

Values are ranked by a radix sort of three passes over 11 bits. An item holds a value's bits, turned so that
unsigned order is numeric order, above its index. :func:`match` does all of it for one piece of at most ``CHUNK``
values; for more, the caller runs the stages itself, piece by piece, so that no call takes more than about 5 ms.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.kernels.jit import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray

CHUNK = 2**18
DIGITS = 2048
PASSES = 3

_BITS = 11
_MASK = np.uint32(DIGITS - 1)
_SIGN = np.uint32(0x80000000)
_GLANCE = 64
_LOW = np.uint64(0xFFFFFFFF)
_SHIFT = np.uint64(32)
_GOLDEN = np.uint64(0x9E3779B97F4A7C15)
_MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
_MIX_2 = np.uint64(0x94D049BB133111EB)
_S27 = np.uint64(27)
_S30 = np.uint64(30)
_S31 = np.uint64(31)


@njit
def hash_index(key: np.uint64, index: np.uint64) -> np.uint64:
    """Return 64 well mixed bits for an index (SplitMix64)."""
    mixed = key + (index + np.uint64(1)) * _GOLDEN
    mixed = (mixed ^ (mixed >> _S30)) * _MIX_1
    mixed = (mixed ^ (mixed >> _S27)) * _MIX_2
    return mixed ^ (mixed >> _S31)


@njit
def _ordered(bits: np.uint32) -> np.uint32:
    """Turn the bits of a float32 so that their unsigned order is its order; both zeros become one."""
    if bits == _SIGN:
        return _SIGN
    # Without a branch on the sign, which no processor could predict.
    return np.uint32(bits ^ np.uint32(np.uint32(np.int32(bits) >> np.int32(31)) | _SIGN))


@njit
def _value(key: np.uint32) -> np.float32:
    """Return the float32 that :func:`_ordered` made a key of."""
    return np.uint32(key ^ np.uint32(np.uint32(np.int32(~key) >> np.int32(31)) | _SIGN)).view(np.float32)


@njit
def count(bits: NDArray[np.uint32], start: int, stop: int, counts: NDArray[np.int64]) -> None:
    """Add the digits of a piece to ``counts``, (3, 2048)."""
    for value in bits[start:stop]:
        key = _ordered(value)
        counts[0, key & _MASK] += 1
        counts[1, (key >> np.uint32(_BITS)) & _MASK] += 1
        counts[2, key >> np.uint32(2 * _BITS)] += 1


@njit
def starts(counts: NDArray[np.int64]) -> None:
    """Turn the counts of each pass into the place of each digit's first item, in place."""
    for number in range(PASSES):
        total = 0
        for digit in range(DIGITS):
            here = counts[number, digit]
            counts[number, digit] = total
            total += here


@njit
def scatter_first(
    bits: NDArray[np.uint32], start: int, stop: int, places: NDArray[np.int64], items: NDArray[np.uint64]
) -> None:
    """Make the items of a piece and send each to the place of its lowest digit."""
    for index in range(start, stop):
        key = _ordered(bits[index])
        digit = key & _MASK
        items[places[0, digit]] = (np.uint64(key) << _SHIFT) | np.uint64(index)
        places[0, digit] += 1


@njit
def scatter_next(
    source: NDArray[np.uint64],
    start: int,
    stop: int,
    number: int,
    places: NDArray[np.int64],
    items: NDArray[np.uint64],
) -> None:
    """Send the items of a piece to the places of their digit ``number``."""
    shift = np.uint64(32 + _BITS * number)
    mask = np.uint64(DIGITS - 1)
    for item in source[start:stop]:
        digit = (item >> shift) & mask
        items[places[number, digit]] = item
        places[number, digit] += 1


@njit
def shuffle_ties(items: NDArray[np.uint64], start: int, stop: int, run: int, key: np.uint64) -> int:
    """Put runs of equal values into random order (Fisher-Yates from the inside out).

    ``run`` is where the run of the item before ``start`` begins; returns the same for the item before ``stop``. An
    item's draw depends on the key and its index only.
    """
    for first in range(max(start, 1), stop, _GLANCE):
        last = min(first + _GLANCE, stop)
        # Ties are rare: a loop without branches, over two views of its own, looks for any first.
        after, before = items[first:last], items[first - 1 : last - 1]
        ties = 0
        for place in range(len(after)):
            ties += (after[place] >> _SHIFT) == (before[place] >> _SHIFT)
        if ties == 0:
            run = last - 1
            continue
        for place in range(first, last):
            item = items[place]
            if item >> _SHIFT != items[place - 1] >> _SHIFT:
                run = place
                continue
            other = run + np.int64(hash_index(key, item & _LOW) % np.uint64(place - run + 1))
            items[place] = items[other]
            items[other] = item
    return run


@njit
def assign(
    items: NDArray[np.uint64], start: int, stop: int, target: NDArray[np.float32], values: NDArray[np.float32]
) -> float:
    """Replace the values of the items ``start`` to ``stop``; return the sum of the absolute changes.

    Rank r of n takes the sorted target of m at (r + 1/2) m / n - 1/2, between two values by a straight line.
    """
    moved = 0.0
    many, size = len(values), len(target)
    ratio = size / many
    for rank in range(start, stop):
        item = items[rank]
        if size == many:
            wanted = target[rank]
        else:
            place = min(max((rank + 0.5) * ratio - 0.5, 0.0), size - 1.0)
            below = int(place)
            above = min(below + 1, size - 1)
            weight = place - below
            wanted = np.float32(target[below] * (1.0 - weight) + target[above] * weight)
        # The old value comes from the item: values are only written, since they are far apart in memory.
        moved += abs(np.float64(_value(np.uint32(item >> _SHIFT))) - np.float64(wanted))
        values[item & _LOW] = wanted
    return moved


@njit
def match(values: NDArray[np.float32], target: NDArray[np.float32], key: np.uint64) -> float:
    """Match one piece in place; return the sum of the absolute changes."""
    many = len(values)
    bits = values.view(np.uint32)
    counts = np.zeros((PASSES, DIGITS), np.int64)
    first = np.empty(many, np.uint64)
    second = np.empty(many, np.uint64)
    count(bits, 0, many, counts)
    starts(counts)
    scatter_first(bits, 0, many, counts, first)
    scatter_next(first, 0, many, 1, counts, second)
    scatter_next(second, 0, many, 2, counts, first)
    shuffle_ties(first, 0, many, 0, key)
    return assign(first, 0, many, target, values)
