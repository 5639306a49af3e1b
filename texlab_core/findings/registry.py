"""Every detector of findings, declared once: window, command line, batches and help all ask here."""

from __future__ import annotations

import logging
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from texlab_core.engine.plugins import OWN_PACKAGE, Failure, Shelf, own_modules
from texlab_core.errors import Cancelled
from texlab_core.findings.finding import LOOK_AT, Finding, Remedy, Where
from texlab_core.findings.limits import rule_for
from texlab_core.measures.registry import find_measure

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from texlab_core.engine.params import Params
    from texlab_core.findings.finding import Certainty
    from texlab_core.findings.limits import Rule
    from texlab_core.measures.subject import Subject

log = logging.getLogger(__name__)

OTHER = ""
# Smaller pictures and exemplars are not examined: limits come from sides of 128 and 256 pixels.
SMALLEST = 32


@dataclass(frozen=True, eq=False)
class Case:
    """A result that is examined.

    Parameters
    ----------
    subject
        The picture with its exemplar and evidence.
    method
        Id of the method; empty for a picture from somewhere else.
    params
        Its parameters, where they are known.
    rule
        Limits of the detector that is asked, None where it needs none.
    """

    subject: Subject
    method: str = ""
    params: Params | None = None
    rule: Rule | None = None

    def value(self, measure: str) -> float | None:
        """Return a measure of the subject, computed once for all detectors."""
        return find_measure(measure).known_of(self.subject)

    def text(self, measure: str) -> str:
        """Return a measure as it is written everywhere; raises ``LookupError`` where there is none."""
        value = self.value(measure)
        if value is None:
            raise LookupError(measure)
        return find_measure(measure).text(value)

    def fires(self) -> bool:
        """Whether the values are beyond the limits of the rule."""
        return self.rule is not None and self.rule.fires(self.value)

    def knob(self, name: str) -> object:
        """Return the value of a parameter, None where it is not known."""
        return getattr(self.params, name, None)


@dataclass(frozen=True)
class Seen:
    """What a detector saw: one sentence with its number, where, and a remedy where it depends on the values.

    A ``hint`` only says "look at", however sure the detector's rule is: the rule said nothing.
    """

    what: str
    where: Where
    remedy: Remedy | None = None
    measures: tuple[str, ...] = ()
    hint: bool = False


@dataclass(frozen=True, kw_only=True)
class Detector:
    """One kind of failure.

    Parameters
    ----------
    id
        Lower-case words with hyphens: its name in JSON and in the failure gallery.
    title
        For people, short enough for a list.
    summary
        One sentence: how it looks.
    measures
        Ids of the measures that it rests on.
    see
        ``see(case)`` returns what was seen, None when all is well. Calls ``case.subject.look()`` at least every
        few milliseconds.
    why
        Why it happens, one sentence with the section of the paper, by id of the method; under the empty id for
        all other methods and for pictures of which no method is known.
    remedies
        What to try, in order of preference, by id of the method in the same way. ``remedy(case)`` returns None
        where it would change nothing.
    methods
        Ids of the only methods that it is asked about; empty for all.
    certainty
        Where no labels tell; the table of limits goes before.
    order
        Place in lists.
    package
        Who declares it; filled in on registration.
    """

    id: str
    title: str
    summary: str
    measures: tuple[str, ...]
    see: Callable[[Case], Seen | None]
    why: Mapping[str, str]
    remedies: Mapping[str, tuple[Callable[[Case], Remedy | None], ...]] = field(default_factory=dict)
    methods: tuple[str, ...] = ()
    certainty: Certainty = LOOK_AT
    order: int = 100
    package: str = OWN_PACKAGE

    def __post_init__(self) -> None:
        if OTHER not in self.why:
            raise ValueError(f"Detector {self.id}: why must have a sentence for other methods, under ''.")

    def examine(self, case: Case) -> Finding | None:
        """Return the finding, None when all is well or nothing can be said."""
        if self.methods and case.method not in self.methods:
            return None
        rule = rule_for(self.id, case.method, case.params)
        seen = self.see(replace(case, rule=rule))
        if seen is None:
            return None
        return Finding(
            id=self.id,
            title=self.title,
            what=seen.what,
            where=seen.where,
            why=self.why.get(case.method, self.why[OTHER]),
            remedy=seen.remedy or self._remedy(case),
            certainty=LOOK_AT if seen.hint else self.certainty if rule is None else rule.certainty,
            measures=seen.measures or self.measures,
        )

    def _remedy(self, case: Case) -> Remedy:
        for each in self.remedies.get(case.method, self.remedies.get(OTHER, ())):
            found = each(case)
            if found is not None:
                return found
        return Remedy("No parameter of this method helps; try another one beside it.")


def _accepted(detector: Detector, package: str) -> Detector:
    """Return a detector with its package; raises ``ParamError`` when it rests on a measure that does not exist."""
    for each in detector.measures:
        find_measure(each)
    return replace(detector, package=package)


_DETECTORS = Shelf("finding", lambda: own_modules("texlab_core.findings.detectors"), _accepted)


def register(detector: Detector) -> Detector:
    """Add a detector; a second one with the same id is a programming error."""
    return _DETECTORS.add(detector)


def detectors() -> Mapping[str, Detector]:
    """Return every detector by id, in their order; imports what declares them once.

    These are the files of ``findings/detectors/``, then the modules that other installed packages name as entry
    points of the group ``texlab_core.findings``. What cannot be used is left out; :func:`failures` says why.
    """
    return _DETECTORS.all()


def failures() -> tuple[Failure, ...]:
    """Return what could not be used, of our own and of other packages."""
    return _DETECTORS.failures()


def find_detector(name: str) -> Detector:
    """Return the detector with this id.

    Raises
    ------
    ParamError
        When there is none; the message lists the ids.
    """
    return _DETECTORS.find(name)


def unexamined(subject: Subject) -> str:
    """Return why a result cannot be examined, one sentence; empty when it can be."""
    if subject.exemplar is None:
        return "Nothing is looked for without an exemplar."
    if min(*subject.image.shape[:2], *subject.exemplar.size) < SMALLEST:
        return f"Nothing is looked for where the result or the exemplar is under {SMALLEST} pixels."
    return ""


@dataclass(frozen=True)
class Examined:
    """What came of looking at a result.

    Parameters
    ----------
    findings
        Everything that is wrong, the certain things first, then hints, each in their order.
    why
        Why something was not looked for, one sentence; empty where everything was.
    failed
        Ids of the detectors that broke.
    """

    findings: tuple[Finding, ...] = ()
    why: str = ""
    failed: tuple[str, ...] = ()


def examine(subject: Subject, params: Params | None = None, method: str | None = None) -> Examined:
    """Look for everything that can be wrong with a result.

    A detector that fails is left out, which is logged and said.

    Parameters
    ----------
    subject
        The picture with its exemplar; nothing is found without one, or where either is under 32 pixels.
    params
        The method's parameters, where they are known.
    method
        Id of the method; None takes the subject's own, empty for a picture from another program.

    Raises
    ------
    Cancelled
        When ``subject.look`` says so.
    """
    why = unexamined(subject)
    if why:
        return Examined(why=why)
    case = Case(subject, subject.method if method is None else method, params)
    found: list[Finding] = []
    failed: list[Detector] = []
    for each in detectors().values():
        subject.look()
        try:
            finding = each.examine(case)
        except Cancelled:
            raise
        except Exception:
            log.exception("The detector %s of %s failed; it is left out.", each.id, each.package)
            failed.append(each)
        else:
            found += [] if finding is None else [finding]
    found.sort(key=lambda finding: finding.certainty == LOOK_AT)
    return Examined(tuple(found), _left_out(failed), tuple(each.id for each in failed))


def _left_out(failed: list[Detector]) -> str:
    if not failed:
        return ""
    names = ", ".join(each.title for each in failed)
    several = "these detectors" if len(failed) > 1 else "this detector"
    return f"Not looked for, since {several} failed: {names}. The log says why."


def find_all(subject: Subject, params: Params | None = None, method: str | None = None) -> tuple[Finding, ...]:
    """Return the findings of :func:`examine`, without what could not be looked for."""
    return examine(subject, params, method).findings
