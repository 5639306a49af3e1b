"""Compiled search of non-parametric sampling: exact matching of partly known windows, in small portions.

Distances are exact integers (weights >= 1, sum of weights x 65025 < 2^31), so that leaving out hopeless candidates
changes no bit: the order of summation does not matter, and a partial sum never falls.

All helpers live in this file because the cache of the compiler does not follow imports.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from llvmlite import ir  # type: ignore[import-untyped]
from numba import njit as njit_numba
from numba import types
from numba.extending import intrinsic

from texlab_core.kernels.jit import njit
from texlab_core.kernels.neighbourhood_types import (
    BEST,
    BUCKETS,
    COLUMN,
    COLUMN_END,
    ENTRIES,
    ERROR_LIMIT,
    EXCLUDED,
    FILLED,
    FOUND,
    KNOWN,
    LANES,
    LAST,
    LAYER_BEST,
    LIMIT,
    NCC,
    NEVER,
    NEXT,
    POSITION,
    SAD,
    SQUARES,
    STARTED,
    STRIDE,
    TARGET,
    WEIGHT,
)

if TYPE_CHECKING:
    from collections.abc import Callable

# Handing a named tuple on counts references to all its arrays, which takes longer than many a helper.
_inlined = njit_numba(nogil=True, forceinline=True, error_model="numpy")


@_inlined
def _hash(key: Any, row: Any, column: Any) -> Any:
    """Counter-based: 64 bits that depend on (key, row, column) only (the finalizer of splitmix64, twice)."""
    bits = np.uint64(key)
    for counter in (row, column):
        bits = bits + np.uint64(counter) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(0x9E3779B97F4A7C15)
        bits = (bits ^ (bits >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        bits = (bits ^ (bits >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        bits = bits ^ (bits >> np.uint64(31))
    return bits


@_inlined
def _pick(key: Any, row: Any, column: Any, count: Any) -> Any:
    """Return a uniform choice from 0 .. count - 1."""
    return np.int64(((_hash(key, row, column) >> np.uint64(33)) * np.uint64(count)) >> np.uint64(31))


@_inlined
def _limit(best: Any, weight: Any, rule: Any) -> Any:
    """Return the largest distance in the match set, max((1 + eps) d_min, tau^2), in the units of the sums."""
    if rule.criterion == NCC:
        return max((1.0 + rule.eps / 1e6) * best, (rule.tau / 255e3) ** 2)
    if best >= NEVER:
        return NEVER
    share = np.int64(best) * np.int64(1000000 + rule.eps) // np.int64(1000000)
    if rule.criterion == SAD:
        level = np.int64(rule.tau) * np.int64(weight) // np.int64(1000)
    else:
        level = np.int64(rule.tau) * np.int64(rule.tau) * np.int64(weight) // np.int64(1000000)
    return np.float64(max(share, level))


def _summing(addends: Callable[..., list[Any]], count: int) -> Any:
    """Make a function that sums over the entries for LANES candidates at once, in vector registers.

    The function takes (values, base, offset, weight, value, last, limit, sums), leaves the sums of the candidates
    base, base + 1, ... in the rows of ``sums`` and returns ``last``. Unless there are several sums it stops as
    soon as all are above ``limit``, and returns minus the entries summed. Plain loops cannot say this: they load
    and store the sums for every entry, or gather candidate by candidate.
    """

    @intrinsic
    def sum_lanes(
        _: Any, values: Any, base: Any, offset: Any, weight: Any, value: Any, last: Any, limit: Any, sums: Any
    ) -> Any:
        signature = types.int64(values, types.int64, offset, weight, value, types.int64, types.int32, sums)

        def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
            return _write_sum(context, builder, signature, args, addends, count)

        return signature, generate

    return sum_lanes


def _write_sum(context: Any, builder: Any, signature: Any, args: Any, addends: Any, count: int) -> Any:
    """Write the loop: STRIDE entries, then a look whether any candidate is still within the limit."""
    place, integer, lanes = ir.IntType(64), ir.IntType(32), ir.VectorType(ir.IntType(32), LANES)

    def data(number: int) -> Any:
        return context.make_array(signature.args[number])(context, builder, args[number]).data

    def spread(scalar: Any) -> Any:
        first = builder.insert_element(ir.Constant(lanes, ir.Undefined), scalar, integer(0))
        return builder.shuffle_vector(first, ir.Constant(lanes, ir.Undefined), ir.Constant(lanes, None))

    values, offset, weight, value, sums = (data(number) for number in (0, 2, 3, 4, 7))
    base, last, limit = args[1], args[5], spread(args[6])
    before = builder.block
    loop, after = builder.append_basic_block("entries"), builder.append_basic_block("done")
    builder.branch(loop)
    builder.position_at_end(loop)
    k = builder.phi(place)
    k.add_incoming(place(0), before)
    zeros = ir.Constant(lanes, None)
    totals = [builder.phi(lanes) for _ in range(count)]
    for total in totals:
        total.add_incoming(zeros, before)
    added = list(totals)
    for step in range(STRIDE):
        entry = builder.add(k, place(step))
        start = builder.add(base, builder.load(builder.gep(offset, [entry])))
        row = builder.bitcast(builder.gep(values, [start]), ir.VectorType(ir.IntType(8), LANES).as_pointer())
        e = builder.zext(builder.load(row, align=1), lanes)
        t, w = (spread(builder.load(builder.gep(each, [entry]))) for each in (value, weight))
        added = [builder.add(total, each) for total, each in zip(added, addends(builder, e, t, w), strict=True)]
    following = builder.add(k, place(STRIDE))
    go_on = builder.icmp_signed("<", following, last)
    alive = ir.Constant(ir.IntType(1), 1)
    if count == 1:
        within = builder.bitcast(builder.icmp_signed("<=", added[0], limit), ir.IntType(LANES))
        alive = builder.icmp_unsigned("!=", within, ir.IntType(LANES)(0))
        go_on = builder.and_(go_on, alive)
    k.add_incoming(following, loop)
    for total, each in zip(totals, added, strict=True):
        total.add_incoming(each, loop)
    builder.cbranch(go_on, loop, after)
    builder.position_at_end(after)
    for number, total in enumerate(added):
        row = builder.bitcast(builder.gep(sums, [place(number * LANES)]), lanes.as_pointer())
        builder.store(total, row, align=4)
    return builder.select(alive, following, builder.neg(following))


def _square(builder: Any, e: Any, t: Any, w: Any) -> list[Any]:
    difference = builder.sub(t, e)
    return [builder.mul(builder.mul(w, difference), difference)]


def _absolute(builder: Any, e: Any, t: Any, w: Any) -> list[Any]:
    difference = builder.sub(t, e)
    negative = builder.icmp_signed("<", difference, ir.Constant(difference.type, None))
    return [builder.mul(w, builder.select(negative, builder.neg(difference), difference))]


def _moments(builder: Any, e: Any, t: Any, w: Any) -> list[Any]:
    weighted = builder.mul(w, e)
    return [weighted, builder.mul(weighted, e), builder.mul(weighted, t)]


# w (t - e)^2; w |t - e|; and w e, w e^2, w t e for the correlation.
_sum_squares = _summing(_square, 1)
_sum_absolutes = _summing(_absolute, 1)
_sum_moments = _summing(_moments, 3)


@_inlined
def _correlation_distance(levels: Any, first: Any, second: Any, mixed: Any) -> Any:
    """Return 1 - r from integer moments; without contrast on one side only, nothing is farther."""
    weight, target, squares = levels[WEIGHT], levels[TARGET], levels[SQUARES]
    of_target = weight * squares - target * target
    of_candidate = weight * np.float64(second) - np.float64(first) * np.float64(first)
    if of_target == 0.0 and of_candidate == 0.0:
        return 0.0
    if of_target == 0.0 or of_candidate == 0.0:
        return np.inf
    together = weight * np.float64(mixed) - target * np.float64(first)
    return max(0.0, 1.0 - together / np.sqrt(of_target * of_candidate))


@_inlined
def _sum_group(pool: Any, rule: Any, search: Any, base: Any, limit: Any) -> Any:
    """Sum for LANES candidates; return the entries summed, negative when none of them is within ``limit``."""
    last, sums = search.numbers[ENTRIES], search.sums
    bound = np.int32(min(limit, 2147483647.0))
    if rule.criterion == NCC:
        return _sum_moments(pool.values, base, search.offset, search.weight, search.value, last, bound, sums)
    if rule.criterion == SAD:
        return _sum_absolutes(pool.values, base, search.offset, search.weight, search.value, last, bound, sums)
    return _sum_squares(pool.values, base, search.offset, search.weight, search.value, last, bound, sums)


@_inlined
def _distance_of(rule: Any, search: Any, lane: Any) -> Any:
    """Return the distance of a candidate of the last group, as a sum (or 1 - correlation)."""
    if rule.criterion == NCC:
        first, second, mixed = search.sums[0, lane], search.sums[1, lane], search.sums[2, lane]
        return _correlation_distance(search.levels, first, second, mixed)
    return np.float64(search.sums[0, lane])


@_inlined
def _gather(canvas: Any, pool: Any, window: Any, rule: Any, search: Any, y: Any, x: Any) -> None:
    """Collect the known part of the window around (y, x), and the candidates on which it lies inside."""
    values, status, numbers, levels = canvas.values, canvas.status, search.numbers, search.levels
    rows, columns, weights, reach = window.rows, window.columns, window.weights, window.reach
    offset, weight, value, telling = search.spare_offset, search.spare_weight, search.spare_value, search.telling
    mean, variance, plane, stride, tiles = pool.mean, pool.variance, pool.plane, pool.stride, rule.tiles
    channels, height, width = values.shape
    top, bottom, left, right = 0, 0, 0, 0
    n = 0
    total = 0
    inner = reach <= y < height - reach and reach <= x < width - reach
    for k in range(len(rows)):
        row, column = y + rows[k], x + columns[k]
        if not inner:
            if tiles:
                row, column = row % height, column % width
            elif row < 0 or row >= height or column < 0 or column >= width:
                continue
        if status[row, column] != KNOWN:
            continue
        top, bottom = min(top, rows[k]), max(bottom, rows[k])
        left, right = min(left, columns[k]), max(right, columns[k])
        total += channels * weights[k]
        for channel in range(channels):
            offset[n] = channel * plane + rows[k] * stride + columns[k]
            weight[n] = weights[k]
            value[n] = values[channel, row, column]
            difference = value[n] - mean[channel]
            telling[n] = weights[k] * (difference * difference + variance[channel])
            n += 1
    levels[WEIGHT] = total
    margin = pool.margin
    if margin > 0:
        top, bottom, left, right = 0, 0, 0, 0
    numbers[COLUMN], numbers[COLUMN_END] = margin - left, margin + pool.width - 1 - right
    numbers[NEXT] = (margin - top) * stride + numbers[COLUMN]
    numbers[LAST] = (margin + pool.height - 1 - bottom) * stride + numbers[COLUMN_END]
    numbers[ENTRIES] = n
    numbers[FOUND] = 0
    levels[BEST] = NEVER
    levels[LIMIT] = NEVER


@_inlined
def _sort_entries(search: Any) -> None:
    """Put the entries that tell most first: those with the largest expected w (t - e)^2 over the exemplar.

    Only the speed depends on it. Entries without weight fill up to a multiple of STRIDE.
    """
    telling, bucket, counts, levels = search.telling, search.bucket, search.counts, search.levels
    offset, weight, value = search.offset, search.weight, search.value
    from_offset, from_weight, from_value = search.spare_offset, search.spare_weight, search.spare_value
    n = search.numbers[ENTRIES]
    largest = 0.0
    for k in range(n):
        largest = max(largest, telling[k])
    scale = (BUCKETS - 1) / largest if largest > 0 else 0.0
    counts[:] = 0
    for k in range(n):
        bucket[k] = BUCKETS - 1 - np.int64(scale * telling[k])
        counts[bucket[k] + 1] += 1
    for each in range(BUCKETS):
        counts[each + 1] += counts[each]
    first, second = 0.0, 0.0
    for k in range(n):
        place = int(counts[bucket[k]])
        counts[bucket[k]] += 1
        offset[place], weight[place], value[place] = from_offset[k], from_weight[k], from_value[k]
        weighted = np.float64(from_weight[k]) * from_value[k]
        first += weighted
        second += weighted * from_value[k]
    levels[TARGET], levels[SQUARES] = first, second
    while n % STRIDE:
        offset[n], weight[n], value[n] = 0, 0, 0
        n += 1
    search.numbers[ENTRIES] = n


@_inlined
def _is_candidate(pool: Any, rule: Any, search: Any, place: Any) -> Any:
    numbers = search.numbers
    column = place % pool.stride
    if column < numbers[COLUMN] or column > numbers[COLUMN_END] or pool.allowed[place] == 0:
        return False
    return not (rule.leave_out and place == numbers[EXCLUDED])


@_inlined
def _note(rule: Any, search: Any, place: Any, distance: Any) -> None:
    """Keep a candidate that is within the limit, and lower the limit when it is the best so far."""
    levels = search.levels
    if distance > levels[LIMIT]:
        return
    found = search.numbers[FOUND]
    search.found[found] = place
    search.distance[found] = distance
    search.numbers[FOUND] = found + 1
    if distance < levels[BEST]:
        levels[BEST] = distance
        levels[LIMIT] = _limit(distance, levels[WEIGHT], rule)


@_inlined
def _coherent(canvas: Any, pool: Any, rule: Any, search: Any, y: Any, x: Any) -> Any:
    """List the candidates that continue what a neighbour was copied from (at most 8); return how many."""
    status, sources, places, numbers = canvas.status, canvas.source, search.bucket, search.numbers
    margin, stride, pool_height, pool_width = pool.margin, pool.stride, pool.height, pool.width
    first_column, last_column, first, last = numbers[COLUMN], numbers[COLUMN_END], numbers[NEXT], numbers[LAST]
    height, width = status.shape
    count = 0
    latest = -1
    for dy in range(-1, 2):
        for dx in range(-1, 2):
            row, column = y + dy, x + dx
            if rule.tiles:
                row, column = row % height, column % width
            elif row < 0 or row >= height or column < 0 or column >= width:
                continue
            source = sources[row, column] - 1
            if status[row, column] != KNOWN or source < 0 or source - dy * pool_width - dx == latest:
                continue
            latest = source - dy * pool_width - dx
            row, column = source // pool_width - dy, source % pool_width - dx
            if margin > 0:
                row, column = row % pool_height + margin, column % pool_width + margin
            place = row * stride + column
            if column < first_column or column > last_column or place < first or place > last:
                continue
            is_new = True
            for k in range(count):
                is_new = is_new and places[k] != place
            if is_new and _is_candidate(pool, rule, search, place):
                places[count] = place
                count += 1
    return count


@_inlined
def _try(pool: Any, rule: Any, search: Any, count: Any) -> None:
    """Compare the candidates listed in ``search.bucket``: they bound d_min before the others are looked at."""
    for k in range(count):
        place = search.bucket[k]
        if _sum_group(pool, rule, search, place, search.levels[LIMIT]) > 0:
            _note(rule, search, place, _distance_of(rule, search, 0))


@_inlined
def _begin(canvas: Any, pool: Any, window: Any, rule: Any, search: Any, y: Any, x: Any) -> Any:
    """Prepare the search for one pixel; return its cost in units of work."""
    _gather(canvas, pool, window, rule, search, y, x)
    numbers = search.numbers
    if numbers[ENTRIES] == 0:
        search.levels[BEST] = 0.0
        return 10 * len(window.rows)
    _sort_entries(search)
    count = _coherent(canvas, pool, rule, search, y, x)
    for k in range(rule.guesses):
        span = numbers[LAST] - numbers[NEXT] + 1
        place = numbers[NEXT] + _pick(rule.key, y * 65536 + k + 1, x, span)
        if _is_candidate(pool, rule, search, place):
            search.bucket[count] = place
            count += 1
    _try(pool, rule, search, count)
    if rule.guesses == 0 or count == 0:
        # They are found again in their turn: only the bound stays.
        numbers[FOUND] = 0
    else:
        numbers[NEXT] = numbers[LAST] + 1
    return (count + 1) * LANES * numbers[ENTRIES] + 20 * len(window.rows)


@_inlined
def _scan(pool: Any, rule: Any, search: Any, budget: Any) -> Any:
    """Compare candidates, LANES at once, until all are done or the budget is spent; return the work done."""
    values, allowed, before, stride = pool.values, pool.allowed, pool.before, pool.stride
    offset, weight, value, sums = search.offset, search.weight, search.value, search.sums
    found, distance, numbers, levels = search.found, search.distance, search.numbers, search.levels
    entries, last, first_column, last_column = (
        numbers[ENTRIES],
        numbers[LAST],
        numbers[COLUMN],
        numbers[COLUMN_END],
    )
    base, count, best, limit = numbers[NEXT], numbers[FOUND], levels[BEST], levels[LIMIT]
    excluded = numbers[EXCLUDED] if rule.leave_out else -1
    work = 0
    while base <= last and work < budget:
        end = min(base + LANES, last + 1)
        summed = 0
        if before[end] > before[base]:
            bound = np.int32(min(limit, 2147483647.0))
            if rule.criterion == NCC:
                summed = _sum_moments(values, base, offset, weight, value, entries, bound, sums)
            elif rule.criterion == SAD:
                summed = _sum_absolutes(values, base, offset, weight, value, entries, bound, sums)
            else:
                summed = _sum_squares(values, base, offset, weight, value, entries, bound, sums)
            work += LANES * (abs(summed) + 5)
        if summed > 0:
            for lane in range(end - base):
                place = base + lane
                column = place % stride
                if sums[0, lane] > limit and rule.criterion != NCC:
                    continue
                if column < first_column or column > last_column or allowed[place] == 0 or place == excluded:
                    continue
                if rule.criterion == NCC:
                    each = _correlation_distance(levels, sums[0, lane], sums[1, lane], sums[2, lane])
                else:
                    each = np.float64(sums[0, lane])
                if each <= limit:
                    found[count], distance[count] = place, each
                    count += 1
                    if each < best:
                        best = each
                        limit = _limit(best, levels[WEIGHT], rule)
            work += LANES * 20
        base += LANES
        work += 10
    numbers[NEXT], numbers[FOUND], levels[BEST], levels[LIMIT] = base, count, best, limit
    return work


@_inlined
def _choose(canvas: Any, pool: Any, rule: Any, search: Any, y: Any, x: Any) -> None:
    """Choose uniformly from the match set and copy the pixel."""
    numbers, levels = search.numbers, search.levels
    if numbers[ENTRIES] == 0:
        # No known neighbour: any pixel that may be copied.
        count = pool.before[pool.plane]
        wanted = _pick(rule.key, y, x, count)
        place = np.searchsorted(pool.before, wanted, side="right") - 1
    else:
        count = 0
        for k in range(numbers[FOUND]):
            if search.distance[k] <= levels[LIMIT]:
                search.found[count] = search.found[k]
                count += 1
        place = search.found[_pick(rule.key, y, x, count)]
    row, column = place // pool.stride - pool.margin, place % pool.stride - pool.margin
    canvas.matches[y, x] = count
    canvas.source[y, x] = row * pool.width + column + 1
    for channel in range(canvas.values.shape[0]):
        canvas.values[channel, y, x] = pool.values[channel * pool.plane + place]
    numbers[FILLED] += 1
    canvas.order[y, x] = numbers[FILLED]
    canvas.status[y, x] = KNOWN


@_inlined
def _distance_now(rule: Any, search: Any) -> Any:
    """Return d_min of the pixel at hand in its own units."""
    levels = search.levels
    if search.numbers[ENTRIES] == 0:
        return 0.0
    if rule.criterion == NCC:
        return min(levels[BEST], 2.0)
    return levels[BEST] / levels[WEIGHT]


@njit
def grow(canvas: Any, pool: Any, window: Any, rule: Any, search: Any, queue: Any, budget: Any) -> Any:
    """Go on with the queue until it is at its end or ``budget`` units of work are spent; return the work done.

    ``search.numbers[POSITION]`` is the place in the queue. A pixel can be left in the middle of its search and be
    gone on with in the next call: no bit of the result depends on the budget.
    """
    numbers, levels = search.numbers, search.levels
    width = canvas.status.shape[1]
    work = 0
    while numbers[POSITION] < len(queue) and work < budget:
        y, x = queue[numbers[POSITION]] // width, queue[numbers[POSITION]] % width
        if numbers[STARTED] == 0:
            if rule.leave_out:
                numbers[EXCLUDED] = (y + pool.margin) * pool.stride + x + pool.margin
            work += _begin(canvas, pool, window, rule, search, y, x)
            numbers[STARTED] = 1
        if numbers[ENTRIES] > 0:
            work += _scan(pool, rule, search, budget - work)
            if numbers[NEXT] <= numbers[LAST]:
                break
        numbers[STARTED] = 0
        numbers[POSITION] += 1
        distance = _distance_now(rule, search)
        canvas.d_min[y, x] = distance
        levels[LAYER_BEST] = min(levels[LAYER_BEST], distance)
        if rule.leave_out or distance > levels[ERROR_LIMIT]:
            continue
        _choose(canvas, pool, rule, search, y, x)
    return work


@njit
def measure_all(
    canvas: Any, pool: Any, window: Any, rule: Any, search: Any, y: Any, x: Any, distances: Any
) -> None:
    """Write the distance of every candidate for one pixel, per unit of weight; places that are none get NaN.

    ``distances`` is (plane,) float64; nothing is chosen. Without a known neighbour all distances are 0.
    """
    numbers, levels = search.numbers, search.levels
    _begin(canvas, pool, window, rule, search, y, x)
    distances[:] = np.nan
    last = numbers[ENTRIES]
    for base in range(numbers[NEXT], numbers[LAST] + 1, LANES):
        if last > 0:
            _sum_group(pool, rule, search, base, np.inf)
        for lane in range(min(LANES, numbers[LAST] + 1 - base)):
            if not _is_candidate(pool, rule, search, base + lane):
                continue
            distance = _distance_of(rule, search, lane) if last > 0 else 0.0
            if rule.criterion != NCC and last > 0:
                distance /= levels[WEIGHT]
            distances[base + lane] = distance
