"""Limits of the detectors, and how they are known: one table, which the help shows.

The limits rest on one observer's labels of 459 results on 51 textures (128 -> 256 pixels), and are fitted and
judged
by ``python -m texlab_core.findings.calibrate LABELS``: precision and recall are those on textures that were
left out
of the fit. A rule with a precision of at least .9 and a recall of at least .7 makes a ``finding``; all others
only say
"look at".
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab_core.findings.finding import FINDING, LOOK_AT
from texlab_core.findings.fitted import NUMBERS

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.engine.params import Params
    from texlab_core.findings.finding import Certainty

PRECISION, RECALL = 0.9, 0.7
BANDS_ALONE = ("heeger-bergen", "mixture", "solid", "msg", "uncoded", "car", "ac-h", "bands", "pixels")
# How the coarsest level of the labelled results was laid out.
LAID_OUT = ("coarsest", ("shift",))
HISTOGRAMS = ("heeger-bergen", "mixture", "solid")


@dataclass(frozen=True, slots=True)
class Term:
    """One measure in a rule.

    Parameters
    ----------
    measure
        Its id.
    sign
        Of a term that is alone: 1 where large values are suspicious, -1 where small ones are. Together with other
        terms its weight is fitted, sign and all.
    log
        When given, ln(value + log) is taken in its place: for measures that run over powers of ten.
    """

    measure: str
    sign: int = 1
    log: float | None = None

    def of(self, value: float) -> float:
        """Return what is weighted."""
        return value if self.log is None else math.log(max(value, 0.0) + self.log)


@dataclass(frozen=True, slots=True)
class Fit:
    """What the labels gave for a rule.

    Parameters
    ----------
    weights
        Of the terms.
    limit
        Of the weighted sum: at and above it the detector speaks.
    precision, recall
        On textures left out of the fit; None where no label says it.
    cases, positive
        How many labelled results were asked about, and in how many of them the observer named it.
    pieces, alarms
        How many real other pieces of the same textures were looked at, and of how many the rule speaks although
        nothing is wrong with them. Labels do not have such results: all good ones of theirs are copies for the
        most part, so that a rule may have learned to see what is new instead of what is wrong.
    """

    weights: tuple[float, ...]
    limit: float
    precision: float | None = None
    recall: float | None = None
    cases: int = 0
    positive: int = 0
    pieces: int = 0
    alarms: int = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """When a detector speaks.

    Parameters
    ----------
    name
        Of the rule: the detector's id, and after a dot the methods it is for.
    terms
        Measures whose weighted sum is compared with the limit.
    fit
        Weights and limit.
    methods
        Ids of the methods that it is for; empty for all others, and for pictures of which no method is known.
    when
        A parameter and the values of it that the labelled results had: the rule is for no others.
    reasons
        Words of the labels that mean it; empty where the limit is not from labels.
    judged
        Ids of the methods whose labels it is judged by; empty for all.
    target
        Precision that the fit aims at.
    quiet
        Share of the good results of all methods (score 2 and above) that have to be below the limit.
    source
        Where a limit comes from that is not from labels, one sentence.
    """

    name: str
    terms: tuple[Term, ...]
    fit: Fit
    methods: tuple[str, ...] = ()
    when: tuple[str, tuple[object, ...]] | None = None
    reasons: tuple[str, ...] = ()
    judged: tuple[str, ...] = ()
    target: float = 0.6
    quiet: float | None = None
    source: str = ""

    @property
    def certainty(self) -> Certainty:
        """``finding`` where the labels allow it."""
        known = self.fit.precision is not None and self.fit.recall is not None
        sure = known and self.fit.precision >= PRECISION and self.fit.recall >= RECALL  # type: ignore[operator]
        return FINDING if sure else LOOK_AT

    def score(self, value: Callable[[str], float | None]) -> float | None:
        """Return the weighted sum, None where a measure says nothing."""
        total = 0.0
        for term, weight in zip(self.terms, self.fit.weights, strict=True):
            found = value(term.measure)
            if found is None:
                return None
            total += weight * term.of(found)
        return total

    @property
    def border(self) -> float:
        """The value of the only term at which the rule begins to speak; raises ``ValueError`` with several."""
        (term,), (weight,) = self.terms, self.fit.weights
        found = self.fit.limit / weight
        return found if term.log is None else math.exp(found) - term.log

    def fires(self, value: Callable[[str], float | None]) -> bool:
        """Whether the values reach the limit."""
        score = self.score(value)
        return score is not None and score >= self.fit.limit

    @property
    def evidence(self) -> str:
        """How the limit is known, one sentence."""
        fit = self.fit
        if fit.precision is None or fit.recall is None:
            return self.source
        of = f" of {', '.join(self.judged)}" if self.judged else ""
        if self.when is not None:
            of += f" with {self.when[0]} = {' or '.join(map(str, self.when[1]))}"
        real = f" It also speaks of {fit.alarms} of {fit.pieces} real other pieces of the textures."
        return (
            f"{fit.positive} of {fit.cases} labelled results{of} show it; on textures left out"
            f" {fit.precision:.0%} of what it says is right, and it sees {fit.recall:.0%}."
            f"{real if fit.pieces else ''}{' ' + self.source if self.source else ''}"
        )


def _rule(name: str, *terms: Term, **more: object) -> Rule:
    """Return a rule that is fitted to labels; before it is, it never speaks."""
    numbers = NUMBERS.get(name, ((0.0,) * len(terms), math.inf, 0.0, 0.0, 0, 0, 0, 0))
    return Rule(name=name, terms=terms, fit=Fit(*numbers), **more)  # type: ignore[arg-type]


def _set(name: str, *terms: Term, limit: float, **more: object) -> Rule:
    """Return a rule whose limit is not from labels; it has one term, and the limit is the value's."""
    (term,) = terms
    return Rule(name=name, terms=terms, fit=Fit((float(term.sign),), term.sign * term.of(limit)), **more)  # type: ignore[arg-type]


_D, _LAID_DOWN = Term("discriminability"), Term("laid-down-share")
_BACK = Term("block-distance-back", 1, 0.05)
_SPECKS, _NEW = Term("specks", 1, 0.002), Term("palette-distance", 1, 0.1)
_ODD, _EMPTY = Term("odd-blocks", 1, 0.05), Term("empty-share", 1, 0.01)
_CONTRAST = Term("local-contrast", -1, 0.01)

RULES: tuple[Rule, ...] = (
    _rule(
        "structure-lost.bands-alone",
        _D,
        methods=BANDS_ALONE,
        judged=("heeger-bergen", "msg"),
        reasons=("structure-lost",),
        target=0.95,
        quiet=0.95,
        source="Nearly all of these methods' results lost structure; the limit is above 19 of 20 good results of "
        "all methods.",
    ),
    _rule(
        "structure-lost",
        _D,
        reasons=("structure-lost",),
        target=0.93,
    ),
    _rule(
        "dependence-lost.bands-alone",
        Term("dependence-difference", 1, 0.01),
        methods=BANDS_ALONE,
        judged=("heeger-bergen", "msg"),
        reasons=("structure-lost",),
        target=0.95,
        quiet=0.95,
        source="Nearly all of these methods' results lost structure; the limit is above 19 of 20 good results of "
        "all methods.",
    ),
    _rule(
        "cuts.de-bonet",
        Term("cuts", 1, 1.0),
        _NEW,
        _ODD,
        Term("exemplar-drift", 1, 0.02),
        methods=("de-bonet",),
        when=LAID_OUT,
        judged=("de-bonet",),
        reasons=("straight-cuts",),
        target=0.94,
    ),
    _rule(
        "cuts",
        Term("cuts", 1, 1.0),
        _LAID_DOWN,
        Term("exemplar-drift", 1, 0.02),
        _SPECKS,
        Term("spectral-variation"),
        reasons=("straight-cuts",),
        target=0.93,
    ),
    _rule("repetition", _LAID_DOWN, Term("exemplar-period"), reasons=("repetition",), target=0.8),
    _rule(
        "verbatim.de-bonet",
        Term("block-distance-back", -1, 0.05),
        methods=("de-bonet",),
        when=LAID_OUT,
        judged=("de-bonet",),
        reasons=("verbatim",),
        target=0.92,
    ),
    _rule(
        "verbatim.efros-leung",
        Term("block-distance-back", -1, 0.05),
        methods=("efros-leung",),
        judged=("efros-leung",),
        reasons=("verbatim",),
        target=0.6,
    ),
    _rule("verbatim", Term("block-distance-back", -1, 0.05), _LAID_DOWN, reasons=("verbatim",), target=0.92),
    _rule(
        "noise.de-bonet",
        _BACK,
        _SPECKS,
        _EMPTY,
        _NEW,
        methods=("de-bonet",),
        when=LAID_OUT,
        judged=("de-bonet",),
        reasons=("noise",),
        target=0.92,
    ),
    _rule("noise", _SPECKS, reasons=("noise",)),
    _rule("jagged", _SPECKS, Term("local-contrast", 1, 0.01), reasons=("jagged",), target=0.4),
    _rule(
        "invented-colours.histograms",
        _NEW,
        methods=HISTOGRAMS,
        judged=("heeger-bergen",),
        reasons=("colours-invented",),
    ),
    _rule("invented-colours", _NEW, reasons=("colours-invented",)),
    _set(
        "contrast-lost",
        Term("local-contrast", -1, 0.01),
        limit=0.7,
        source="Nothing tells what the observer called lost contrast (23 of 459); a third less is said as it is.",
    ),
    _rule(
        "blotchy.histograms",
        Term("exemplar-drift", 1, 0.02),
        Term("local-contrast", 1, 0.01),
        methods=HISTOGRAMS,
        judged=("heeger-bergen",),
        reasons=("blotchy",),
        target=0.8,
    ),
    _rule(
        "garbage.efros-leung",
        _ODD,
        _BACK,
        methods=("efros-leung",),
        judged=("efros-leung",),
        reasons=("garbage",),
        target=0.85,
    ),
    _rule(
        "smear",
        _CONTRAST,
        _EMPTY,
        Term("w1-pixels", 1, 0.01),
        judged=("de-bonet", "efros-leung"),
        reasons=("smear",),
    ),
    _rule("peaks-moved", Term("spectral-variation"), reasons=("period-wrong", "orientation-wrong"), target=0.5),
    _set(
        "peaks-moved.msg",
        Term("peak-shift-octaves"),
        limit=0.25,
        methods=("msg",),
        source="Its channels lie an octave apart, so that a peak moves by up to half an octave; half of that is "
        "called a shift.",
    ),
    _rule("symmetry", Term("exemplar-symmetry"), reasons=("symmetry-lost",)),
    _rule("letters", Term("exemplar-symbols"), reasons=("letters-broken",), target=0.92),
    _rule("gradient", Term("exemplar-drift"), reasons=("gradient-lost",)),
    _set(
        "small-exemplar",
        Term("exemplar-structure"),
        limit=0.5,
        source="Not from labels: more than half of the contrast is in structure of which not four periods fit.",
    ),
)


def rule_for(finding: str, method: str, params: Params | None = None) -> Rule | None:
    """Return the rule of a detector for a result.

    That is the one which names the method, if the labels had such parameters too, else the one for all.
    """
    own = [each for each in RULES if each.name.partition(".")[0] == finding]
    for each in own:
        if method in each.methods and (each.when is None or getattr(params, each.when[0], None) in each.when[1]):
            return each
    return next((each for each in own if not each.methods), None)
