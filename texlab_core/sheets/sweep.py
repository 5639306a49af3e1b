"""Sweeps: one or two knobs over ranges, a grid of jobs."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.job import MAX_SEED, Job, check_seed
from texlab_core.engine.params import Field, Knob, describe, frozen_mapping
from texlab_core.engine.registry import find_method
from texlab_core.errors import InputError, ParamError
from texlab_core.files import strict_json
from texlab_core.files.wording import did_you_mean
from texlab_core.measures.registry import written

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from texlab_core.engine.params import Params
    from texlab_core.engine.result import Result

MAX_CELLS = 400
# The axis of a grid over many textures.
TEXTURE = "texture"
_POLL_S = 0.01
_FORMS = "NAME=FROM:TO:COUNT, NAME=FROM:TO:COUNT:log or NAME=A,B,C"


@dataclass(frozen=True)
class Vary:
    """One axis of a sweep: a knob (or ``seed``) and the values it takes, in order."""

    name: str
    values: tuple[Any, ...]

    @classmethod
    def parse(cls, text: str, params: type[Params]) -> Vary:
        """Read ``name=from:to:count[:log]``, ``name=a,b,c`` or ``name=[JSON, ...]``.

        Integers are rounded (to odd ones where only those are allowed), values that fall together are kept once.

        Raises
        ------
        ParamError
            When the knob is unknown, the text has another form, or a value is out of range.
        """
        name, equals, values = (part.strip() for part in text.partition("="))
        if not equals or not name or not values:
            raise ParamError("vary", _FORMS, text)
        knob = check_knob(name.replace("-", "_"), params)
        if values.startswith("["):
            given = strict_json.loads(values, what=f"the list of {knob.name}")
            return cls.of(knob.name, given, params)
        if ":" in values and knob.kind in ("int", "float"):
            return cls(knob.name, _range(knob, values))
        return cls(knob.name, _checked(knob, values.split(","), knob.parse))

    @classmethod
    def of(cls, name: str, values: Any, params: type[Params]) -> Vary:
        """Check values that come as data; raises ``ParamError`` like :meth:`parse`."""
        knob = check_knob(name, params)
        if not isinstance(values, list | tuple) or not values:
            raise ParamError("vary", f"a list of values for {name}", values)
        return cls(name, _checked(knob, values, knob.check))


def check_knob(name: str, params: type[Params], *, number: bool = False) -> Field:
    """Return the knob that is to be varied (a ``number``); raises ``ParamError`` when there is no such knob."""
    if name == "seed":
        return Field("seed", "int", int, 0, Knob(help="Seed of the random numbers", low=0, high=MAX_SEED))
    fields = {each.name: each for each in describe(params)}
    if name not in fields:
        known = [*fields, "seed"]
        close = did_you_mean(name, known)
        hint = f" ({close})" if close else ""
        raise ParamError("vary", f"one of {', '.join(known)}{hint}", name)
    if number and fields[name].kind not in ("int", "float"):
        raise ParamError("vary", f"a list of values for {name}", "a range")
    return fields[name]


def _range(knob: Field, text: str) -> tuple[Any, ...]:
    parts = [part.strip() for part in text.split(":")]
    if len(parts) not in (3, 4) or (len(parts) == 4 and parts[3] != "log"):
        raise ParamError("vary", _FORMS, f"{knob.name}={text}")
    first, last = knob.parse(parts[0]), knob.parse(parts[1])
    count = int(parts[2]) if parts[2].isascii() and parts[2].isdigit() and len(parts[2]) < 9 else parts[2]
    return spread(knob, first, last, count, log=len(parts) == 4)


def spread(knob: Field, first: float, last: float, count: object, *, log: bool = False) -> tuple[Any, ...]:
    """Return ``count`` values of a knob from ``first`` to ``last``, evenly or in even ratios.

    Raises
    ------
    ParamError
        When ``count`` is no whole number from 1 to 400, or ``log`` is asked for and one end is not positive.
    """
    if type(count) is not int or not 1 <= count <= MAX_CELLS:
        raise ParamError("vary", f"a count from 1 to {MAX_CELLS} for {knob.name}", count)
    if log and (first <= 0 or last <= 0):
        raise ParamError("vary", f"a range above 0 for {knob.name} in even ratios", f"{first:g}:{last:g}")
    places = np.geomspace(first, last, count) if log else np.linspace(first, last, count)
    low, high = min(first, last), max(first, last)
    # 12 digits: 0.1 + 0.2 is to be shown, and stored, as 0.3; never outside of the ends.
    values = [min(max(float(f"{place:.12g}"), low), high) for place in places]
    if knob.kind == "int":
        values = [2 * math.floor(each / 2) + 1 if knob.knob.odd else math.floor(each + 0.5) for each in values]
    return _distinct([knob.check(each) for each in values])


def _checked(knob: Field, values: Sequence[Any], check: Callable[[Any], Any]) -> tuple[Any, ...]:
    if len(values) > MAX_CELLS:
        raise ParamError("vary", f"at most {MAX_CELLS} values for {knob.name}", len(values))
    return _distinct([check(each) for each in values])


def _distinct(values: list[Any]) -> tuple[Any, ...]:
    return tuple(value for place, value in enumerate(values) if value not in values[:place])


@dataclass(frozen=True, eq=False)
class Sweep:
    """A grid of jobs, checked before any of them starts.

    Parameters
    ----------
    base
        The job that every cell shares but for the varied knobs.
    axes
        One or two; the first runs across, the second down. Two axes make rows and columns; one axis is a series.

    Raises
    ------
    InputError
        When an axis is unknown or named twice, a value is out of range, or there are more than 400 cells.
    """

    base: Job
    axes: tuple[Vary, ...]
    jobs: tuple[Job, ...] = field(init=False)

    def __post_init__(self) -> None:
        if not 1 <= len(self.axes) <= 2:
            raise InputError(f"A sweep varies one or two knobs, got {len(self.axes)}.")
        if len({axis.name for axis in self.axes}) < len(self.axes):
            raise InputError(f"A sweep varies two different knobs, got {self.axes[0].name} twice.")
        count = math.prod(len(axis.values) for axis in self.axes)
        if count > MAX_CELLS:
            raise InputError(f"A sweep has at most {MAX_CELLS} cells, got {count}.")
        object.__setattr__(self, "axes", tuple(self._checked(axis) for axis in self.axes))
        object.__setattr__(self, "jobs", tuple(self._job(index) for index in range(count)))

    def values(self, index: int) -> Mapping[str, Any]:
        """Return what is varied in one cell, by name."""
        across = self.axes[0]
        found = {across.name: across.values[index % len(across.values)]}
        if len(self.axes) == 2:
            found[self.axes[1].name] = self.axes[1].values[index // len(across.values)]
        return frozen_mapping(found)

    def _checked(self, axis: Vary) -> Vary:
        return Vary.of(axis.name, axis.values, type(self.base.params))

    def _job(self, index: int) -> Job:
        changes = dict(self.values(index))
        seed = check_seed(changes.pop("seed", self.base.seed))
        return dataclasses.replace(self.base, params=self.base.params.replace(**changes), seed=seed)


@dataclass(frozen=True, eq=False, kw_only=True)
class Cell:
    """One finished cell.

    Parameters
    ----------
    index
        Place in the grid, row by row.
    job
        What was run.
    values
        What was varied, by name.
    result
        What came out, without volume, maps, model and details; None when it failed.
    error
        Why it failed, one sentence.
    measures
        Numbers about the result by id, as :func:`texlab_core.measures.registry.measure_quick` says them.
    """

    index: int
    job: Job
    values: Mapping[str, Any]
    result: Result | None = None
    error: str = ""
    measures: Mapping[str, float] = field(default_factory=dict)

    @property
    def setting(self) -> str:
        """What was varied, in words: "alpha 0.15, beta 1"."""
        return setting_words(self.values)

    @property
    def evidence(self) -> str:
        """The numbers that a sheet says, as far as there are any: "D -3.12, V 0.45, copied 94%, candidates 14"."""
        return "failed" if self.error else ", ".join(written(self.measures, SHEET_MEASURES))

    @property
    def label(self) -> str:
        """Everything in one line."""
        return ", ".join(part for part in (self.setting, self.evidence) if part)


# What a cell of a sheet says.
SHEET_MEASURES = ("discriminability", "visual-difference", "copied-share", "median-candidates")


def show(value: object) -> str:
    """Return a varied value as a label shows it."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.4g}"
    return str(value) if isinstance(value, int | str) else type(value).__name__


def value_words(name: str, value: object) -> str:
    """Return a varied value with its name: "alpha 0.15"; a texture needs none."""
    return show(value) if name == TEXTURE else f"{name.replace('_', ' ')} {show(value)}"


def setting_words(values: Mapping[str, Any]) -> str:
    """Return what is varied in words: "alpha 0.15, beta 1"."""
    return ", ".join(value_words(name, value) for name, value in values.items())


def heads(sweep: Sweep) -> tuple[list[str], list[str]]:
    """Return what stands above the columns and left of the rows of a grid; a series has neither."""
    if len(sweep.axes) < 2:
        return [], []
    across, down = ([value_words(axis.name, value) for value in axis.values] for axis in sweep.axes)
    return across, down


def sweep_of(base: Job, texts: list[str]) -> Sweep:
    """Make a sweep from the texts of ``--vary``; raises ``InputError`` before any work starts."""
    params = find_method(base.method).params
    return Sweep(base, tuple(Vary.parse(text, params) for text in texts))
