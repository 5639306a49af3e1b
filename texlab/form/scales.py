"""Slider positions and the values they stand for: linear, logarithmic, or linear with a logarithmic tail."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from texlab_core.engine.params import Field

POSITIONS = 1000
LINEAR_PART = 0.75
MOST_DECIMALS = 6


@dataclass(frozen=True)
class Scale:
    """Maps slider positions 0 .. ``positions`` to values ``low`` .. ``high`` and back."""

    low: float
    high: float
    positions: int = POSITIONS
    log: bool = False
    linear_to: float | None = None
    step: float = 0.0

    @classmethod
    def of(cls, field: Field) -> Scale:
        """Return the scale of a number field with a range."""
        knob = field.knob
        low = 0.0 if knob.low is None else float(knob.low)
        high = low + 100.0 if knob.high is None else float(knob.high)
        if field.kind != "int":
            return cls(low, high, POSITIONS, knob.log, knob.linear_to)
        low, high, step = math.ceil(low), math.floor(high), 1.0
        if knob.odd:
            low, high, step = low + (low + 1) % 2, high - (high + 1) % 2, 2.0
        is_even = not knob.log and knob.linear_to is None and (high - low) / step <= POSITIONS
        positions = round((high - low) / step) if is_even else POSITIONS
        return cls(low, high, max(positions, 1), knob.log, knob.linear_to, step)

    def value(self, position: int) -> float:
        """Return the value at a position."""
        share = min(max(position / self.positions, 0.0), 1.0)
        if self.log:
            value = self.low * math.pow(self.high / self.low, share)
        elif self.linear_to is not None:
            if share <= LINEAR_PART:
                value = self.low + (self.linear_to - self.low) * share / LINEAR_PART
            else:
                tail = (share - LINEAR_PART) / (1 - LINEAR_PART)
                value = self.linear_to * math.pow(self.high / self.linear_to, tail)
        else:
            value = self.low + (self.high - self.low) * share
        if self.step:
            value = self.low + round((value - self.low) / self.step) * self.step
        return min(max(value, self.low), self.high)

    def position(self, value: float) -> int:
        """Return the position nearest to a value."""
        value = min(max(value, self.low), self.high)
        if self.log:
            share = math.log(value / self.low) / math.log(self.high / self.low)
        elif self.linear_to is not None and value > self.linear_to:
            tail = math.log(value / self.linear_to) / math.log(self.high / self.linear_to)
            share = LINEAR_PART + (1 - LINEAR_PART) * tail
        elif self.linear_to is not None:
            share = LINEAR_PART * (value - self.low) / (self.linear_to - self.low)
        else:
            share = (value - self.low) / (self.high - self.low) if self.high > self.low else 0.0
        return round(share * self.positions)


def decimals(field: Field) -> int:
    """Return how many decimals the number box of a float field shows; limits and default are never rounded."""
    knob = field.knob
    if knob.step is not None:
        usual = _places(knob.step)
    elif knob.log and knob.low:
        # Two digits that matter at the lower end.
        usual = max(2, 1 - math.floor(math.log10(knob.low)))
    else:
        usual = 3 if (knob.high or 1.0) - (knob.low or 0.0) <= 10 else 2
    fixed = [value for value in (knob.low, knob.high, knob.linear_to, field.default) if value is not None]
    return min(MOST_DECIMALS, max(usual, *map(_places, fixed)))


def box_step(field: Field) -> float:
    """Return the step of a float field's number box: its own, or about a hundredth of the range as 1, 2 or 5."""
    if field.knob.step is not None:
        return field.knob.step
    low = field.knob.low or 0.0
    high = field.knob.linear_to or (low + 1.0 if field.knob.high is None else field.knob.high)
    aim = (high - low) / 100 if high > low else 0.01
    power = 10.0 ** math.floor(math.log10(aim) + 1e-9)
    factor = max(each for each in (1, 2, 5) if each * power <= aim * (1 + 1e-9))
    return max(factor * power, 10.0 ** -decimals(field))


def _places(value: float) -> int:
    return len(f"{value:.{MOST_DECIMALS}f}".rstrip("0").partition(".")[2])
