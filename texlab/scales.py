"""Slider positions and the values they stand for: linear, logarithmic, or linear with a logarithmic tail."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from texlab_core.params import Field

POSITIONS = 1000
LINEAR_PART = 0.75


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
        step = 0.0
        if field.kind == "int":
            step = 2.0 if knob.odd else 1.0
        whole = field.kind == "int" and not knob.log and (high - low) / step <= POSITIONS
        positions = round((high - low) / step) if whole else POSITIONS
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
    """Return how many decimals the number box of a float field shows."""
    if field.knob.step is not None:
        return max(0, min(6, -math.floor(math.log10(field.knob.step) + 1e-9)))
    span = (field.knob.high or 1.0) - (field.knob.low or 0.0)
    return 3 if span <= 10 else 2
