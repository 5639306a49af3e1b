"""Every measure, declared once: columns, sweeps, sheets, ``--json`` and recipes all ask here."""

from __future__ import annotations

import logging
import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from texlab_core.engine.plugins import OWN_PACKAGE, Failure, Shelf, own_modules
from texlab_core.engine.registry import methods
from texlab_core.errors import Cancelled

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from texlab_core.measures.subject import Subject

log = logging.getLogger(__name__)

Better = Literal["lower", "higher", "neither"]
Need = Literal["exemplar", "source", "counts", "curves", "model", "method"]


@dataclass(frozen=True, kw_only=True)
class Measure:
    """One number about a result.

    Parameters
    ----------
    id
        Lower-case words with hyphens: its name in JSON, recipes and tables.
    title
        For people, short enough for a column ("copied").
    summary
        One or two sentences: what it says, and what its ends mean.
    unit
        Unit of the values, empty for plain numbers and shares.
    better
        Which end is the better one, where there is a better one.
    low, high
        Every value lies in ``low <= value <= high``.
    needs
        What of the subject it reads besides the image: its exemplar, the map of sources, of counts, curves, the
        model. ``method``: only the method itself can say it, so that it is never computed here.
    function
        ``function(subject)`` returns the number, or None where the subject lacks what it takes (too small, no
        contrast). A pure function of the subject; calls ``subject.look()`` at least every few milliseconds. None
        for measures that need ``method``.
    form
        Format of the number, as in ``format(value, form)``: the only way it is written anywhere.
    reference
        Where it comes from.
    part_of
        Id of the measure that it is a group of; shown on demand.
    live
        Fast enough to follow a slider, in the worker.
    slow
        Takes longer than many a synthesis, so that it is only computed when it is asked for by name.
    order
        Place in lists; the first ones are shown large.
    package
        Who declares it; filled in on registration.
    """

    id: str
    title: str
    summary: str
    low: float
    high: float
    better: Better
    needs: tuple[Need, ...]
    function: Callable[[Subject], float | None] | None = None
    unit: str = ""
    form: str = ".3g"
    reference: str = ""
    part_of: str = ""
    live: bool = False
    slow: bool = False
    order: int = 100
    package: str = OWN_PACKAGE

    def __post_init__(self) -> None:
        if (self.function is None) != ("method" in self.needs):
            raise ValueError(f"Measure {self.id}: either a function or the need 'method', not both.")
        if not self.low < self.high:
            raise ValueError(f"Measure {self.id}: its range must not be empty, got {self.low:g} to {self.high:g}.")

    def of(self, subject: Subject) -> float | None:
        """Return the number, or None where the subject lacks what it needs.

        Raises
        ------
        Cancelled
            When ``subject.look`` says so.
        """
        value = subject.given.get(self.id)
        if value is None and self.function is not None and subject.has(self.needs):
            value = self.function(subject)
        if value is None or not math.isfinite(value):
            return None
        return min(max(float(value), self.low), self.high)

    def known_of(self, subject: Subject) -> float | None:
        """Return the number like :meth:`of`, computed once for everybody who asks about this subject."""
        return subject.once(f"value of {self.id}", lambda: self.of(subject))

    def text(self, value: float) -> str:
        """Return the number as it is written everywhere, with its unit."""
        written = format(value, self.form)
        # No sign before what is written as zero.
        if written.startswith("-") and not written.strip("-0.%e+"):
            written = written[1:]
        return f"{written} {self.unit}" if self.unit else written


def _accepted(measure: Measure, package: str) -> Measure:
    return replace(measure, package=package)


_MEASURES = Shelf("measure", lambda: own_modules("texlab_core.measures"), _accepted)


def register(measure: Measure) -> Measure:
    """Add a measure; a second one with the same id is a programming error."""
    return _MEASURES.add(measure)


def measures() -> Mapping[str, Measure]:
    """Return every registered measure by id, in their order.

    All files of ``measures/`` are imported, then those of other packages that have an entry point of the group
    ``texlab_core.measures``, and the methods, which declare what only they can say. What cannot be used is left
    out; :func:`failures` says why.
    """
    methods()
    return _MEASURES.all()


def failures() -> tuple[Failure, ...]:
    """Return what could not be used, of our own and of other packages."""
    return _MEASURES.failures()


def find_measure(name: str) -> Measure:
    """Return the measure with this id.

    Raises
    ------
    ParamError
        When there is none; the message lists the ids.
    """
    methods()
    return _MEASURES.find(name)


def measure_all(subject: Subject, ids: Iterable[str] | None = None) -> dict[str, float]:
    """Return the numbers about a subject by id, in the registry's order.

    Parameters
    ----------
    subject
        What to measure.
    ids
        Which measures; None takes all but the slow ones, and what the method says under names of its own. Those
        that the subject lacks something for are left out, and so are those that fail, which is logged.

    Raises
    ------
    ParamError
        When an id is unknown.
    Cancelled
        When ``subject.look`` says so.
    """
    known = measures()
    wanted = None if ids is None else {find_measure(each).id for each in ids}
    found: dict[str, float] = {}
    for measure in known.values():
        if measure.id in wanted if wanted is not None else not measure.slow:
            value = _tried(measure, subject)
            if value is not None:
                found[measure.id] = value
    return found if ids is not None else found | _unknown(subject)


def _tried(measure: Measure, subject: Subject) -> float | None:
    try:
        return measure.known_of(subject)
    except Cancelled:
        raise
    except Exception:
        # One that fails, of another package perhaps, takes neither the picture nor the other numbers with it.
        log.exception("The measure %s of %s failed; it is left out.", measure.id, measure.package)
        return None


def measure_quick(subject: Subject) -> dict[str, float]:
    """Return the live measures, and whatever else the method has said already: what costs next to nothing."""
    chosen = [each.id for each in measures().values() if each.live or each.id in subject.given]
    return measure_all(subject, chosen) | _unknown(subject)


def _unknown(subject: Subject) -> dict[str, float]:
    """Return what a method says under names that nobody registers: it is not lost, but has no words either."""
    known = measures()
    return {
        name: float(value) for name, value in subject.given.items() if name not in known and math.isfinite(value)
    }


def written(values: Mapping[str, float], ids: Iterable[str]) -> list[str]:
    """Return some of the numbers with titles, as they are written everywhere: ``["D -3.12", "copied 94%"]``."""
    known = [(find_measure(each), values[each]) for each in ids if each in values]
    return [f"{measure.title} {measure.text(value)}" for measure, value in known]
