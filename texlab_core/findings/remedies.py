"""What to try, as functions of the parameters at hand: None where it would change nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab_core.engine.params import describe
from texlab_core.findings.finding import Remedy

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.findings.registry import Case

    Advice = Callable[[Case], Remedy | None]


def multiply(knob: str, factor: float, words: str, *, least: float = 0.0, most: float | None = None) -> Advice:
    """Return the advice to multiply a number; ``words`` has ``{value}`` where the new one is named.

    Parameters
    ----------
    knob
        Name of the parameter, a number.
    factor
        New value over old one.
    words
        One sentence.
    least, most
        The new value stays within; None takes the knob's own limit.
    """

    def advise(case: Case) -> Remedy | None:
        old = case.knob(knob)
        if case.params is None or not isinstance(old, int | float):
            return None
        field = next(each for each in describe(type(case.params)) if each.name == knob)
        value = float(f"{old * factor:.3g}")
        highest = field.knob.high if most is None else most
        value = max(value, least)
        value = value if highest is None else min(value, float(highest))
        new = _odd(value, field.knob.odd) if isinstance(old, int) else value
        # Against the direction of the advice is no advice.
        if new == old or (new > old) != (factor > 1):
            return None
        return Remedy(words.format(value=f"{new:g}"), {knob: new})

    return advise


def _odd(value: float, odd: bool) -> int:
    return int(value) // 2 * 2 + 1 if odd else round(value)


def put(knob: str, value: Any, words: str) -> Advice:
    """Return the advice to give a parameter this value."""

    def advise(case: Case) -> Remedy | None:
        known = case.params is not None and hasattr(case.params, knob)
        return Remedy(words, {knob: value}) if known and case.knob(knob) != value else None

    return advise


def use(method: str, words: str) -> Advice:
    """Return the advice to take another method."""
    return lambda case: Remedy(words, method=method) if case.method != method else None


def say(words: str) -> Advice:
    """Return advice in words alone, where nothing that could be set helps."""
    return lambda case: Remedy(words)
