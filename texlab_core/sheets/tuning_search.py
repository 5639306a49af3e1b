"""Coordinate search over numeric knobs: which parameters to try next, from the numbers alone."""

from __future__ import annotations

import math
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

from texlab_core.errors import InputError

if TYPE_CHECKING:
    from texlab_core.engine.params import Field, Params
    from texlab_core.engine.streams import Streams

# Places of a first look at one knob, and at two together.
ALONE = 9
TOGETHER = 6
# The finest step, as a share of a knob's range.
FINEST = 1 / 256


@dataclass(frozen=True, kw_only=True)
class Measured:
    """Parameters and their two numbers: one that is to stay below a limit (D), one that is to be large (V)."""

    params: Params
    kept: float
    gained: float

    @property
    def usable(self) -> bool:
        """Whether both numbers are there."""
        return math.isfinite(self.kept) and math.isfinite(self.gained)

    def rank(self, limit: float) -> tuple[int, float, float]:
        """Return what to compare by, larger is better: V within the limit (then D), else how near to it."""
        if not self.usable:
            return 0, 0.0, 0.0
        return (2, self.gained, -self.kept) if self.kept <= limit else (1, -self.kept, self.gained)


# Runs: about 330 of them are the end's.
DEFAULT_BUDGET = 1500
# Every setting is tried with this many seeds, the job's own first: D scatters by .15 from seed to seed.
SEARCH_SEEDS = 2


class Asked(NamedTuple):
    """What a search wants to know: means of D and V of parameters over the first so many seeds."""

    phase: str
    params: Sequence[Params]
    seeds: int = SEARCH_SEEDS


# Is sent what was measured (fewer when the budget ends).
Rounds = Generator[Asked, Sequence[Measured], None]


def best_of(found: Sequence[Measured], limit: float, best: Measured) -> Measured:
    """Return the best one; the present one stays unless another is truly better."""
    for each in found:
        if each.rank(limit) > best.rank(limit):
            best = each
    return best


def knob_rounds(start: Measured, fields: Sequence[Field], limit: float, streams: Streams) -> Rounds:
    """Look at a grid of the first two knobs and along the others, then halve steps around the best.

    Parameters
    ----------
    start
        Where to begin, measured.
    fields
        The knobs, numbers.
    limit
        Of :meth:`Measured.rank`.
    streams
        Decide in which order the knobs are taken.
    """
    best = start
    count = ALONE if len(fields) == 1 else TOGETHER
    grid = [grid_values(each, count) for each in fields[:2]]
    names = [each.name for each in fields[:2]]
    found = yield Asked(
        "grid", _with(best.params, [dict(zip(names, each, strict=True)) for each in product(*grid)])
    )
    best = best_of(found, limit, best)
    for each in fields[2:]:
        values = [{each.name: value} for value in grid_values(each, ALONE)]
        best = best_of((yield Asked(f"along {each.name}", _with(best.params, values))), limit, best)
    step = 0.5 / (count - 1)
    turn = 0
    while step >= FINEST:
        before = best
        order = streams("tuning knobs", turn).permutation(len(fields))
        for place in order:
            knob = fields[int(place)]
            here = place_of(knob, getattr(best.params, knob.name))
            values = [{knob.name: value_at(knob, here + side * step)} for side in (-1, 1)]
            best = best_of((yield Asked("steps", _with(best.params, values))), limit, best)
        turn += 1
        if best is before:
            step /= 2


def _with(params: Params, changes: Sequence[dict[str, float]]) -> list[Params]:
    """Return copies with changes, without those that do not go together."""
    made = []
    for each in changes:
        try:
            made.append(params.replace(**each))
        except InputError:
            continue
    return made


def ends(knob: Field) -> tuple[float, float]:
    """Return the range that is looked through: the linear part of the slider, or around the default."""
    around = max(abs(float(knob.default)), 1.0)
    low = float(knob.default) - 4 * around if knob.knob.low is None else float(knob.knob.low)
    high = knob.knob.linear_to if knob.knob.linear_to is not None else knob.knob.high
    return low, max(low + around, float(knob.default) + 4 * around) if high is None else float(high)


def _logarithmic(knob: Field) -> bool:
    return knob.knob.log and ends(knob)[0] > 0


def value_at(knob: Field, place: float) -> float:
    """Return the value at a place of the range, 0 .. 1; places beyond are moved to its ends."""
    low, high = ends(knob)
    place = min(max(place, 0.0), 1.0)
    value = low * (high / low) ** place if _logarithmic(knob) else low + (high - low) * place
    value = min(max(float(f"{value:.6g}"), low), high)
    if knob.kind == "int":
        return 2 * math.floor(value / 2) + 1 if knob.knob.odd else math.floor(value + 0.5)
    return value


def place_of(knob: Field, value: float) -> float:
    """Return the place of a value, 0 .. 1: :func:`value_at` of it is the value, up to 6 digits."""
    low, high = ends(knob)
    value = min(max(float(value), low), high)
    if _logarithmic(knob):
        return math.log(value / low) / math.log(high / low)
    return (value - low) / (high - low)


def grid_values(knob: Field, count: int) -> list[float]:
    """Return up to ``count`` values over the whole range, each once."""
    values = [value_at(knob, place / (count - 1)) for place in range(count)]
    return [each for place, each in enumerate(values) if each not in values[:place] and _fits(knob, each)]


def _fits(knob: Field, value: float) -> bool:
    try:
        knob.check(value)
    except InputError:
        return False
    return True
