"""The end of a search: which settings are worth measuring on seeds that it never saw, and on how many.

D and V scatter from seed to seed, and of hundreds of settings that were tried with two seeds the best one is
mostly the luckiest one. So those that are likely to be better go on, are measured with other seeds, and of them
again the likely ones; only the seeds of the end decide.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from statistics import NormalDist, fmean
from typing import TYPE_CHECKING

from texlab_core.sheets.tuning_search import Measured

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Sequence

    from texlab_core.engine.params import Params


@dataclass(frozen=True)
class Final:
    """How many settings are measured with how many fresh seeds.

    Parameters
    ----------
    candidates, first
        So many settings with so many seeds.
    finalists, seeds
        So many of them with all seeds.
    """

    candidates: int
    first: int
    finalists: int
    seeds: int

    @property
    def runs(self) -> int:
        """Most runs that it takes, those of the start among them."""
        return (self.candidates + 1) * self.first + (self.finalists + 1) * (self.seeds - self.first)


FINAL = Final(candidates=14, first=5, finalists=5, seeds=16)
# Of settings that differ in single thresholds only, so many are measured again.
ALIKE = 2
# Of V: what is less does not show in two digits.
LEAST_GAIN = 0.005
# Of small budgets.
SHORT_FINAL = Final(candidates=4, first=3, finalists=4, seeds=3)
FINAL_FROM = 300


@dataclass(frozen=True)
class Tried:
    """A setting with what came of it, seed by seed; the seeds are those of the start, in the same order.

    Parameters
    ----------
    params
        The setting.
    kept, gained
        D and V, a number for each seed.
    """

    params: Params
    kept: tuple[float, ...]
    gained: tuple[float, ...]

    @property
    def usable(self) -> bool:
        """Whether all numbers are there."""
        return all(map(math.isfinite, (*self.kept, *self.gained)))

    @property
    def means(self) -> Measured:
        """The means over the seeds."""
        return Measured(params=self.params, kept=fmean(self.kept), gained=fmean(self.gained))


@dataclass(frozen=True)
class Ahead:
    """By how much a setting is better, and the chance that it truly is.

    Parameters
    ----------
    within
        Chance that D is at most the limit.
    larger
        Chance that V is larger than that of the start by what can be seen.
    gain
        By how much V is larger.
    """

    within: float
    larger: float
    gain: float

    @property
    def sure(self) -> float:
        """Chance of both."""
        return self.within * self.larger

    @property
    def much(self) -> float:
        """The gain of V, times the chance that D is within the limit."""
        return self.within * max(0.0, self.gain)


def compared(found: Sequence[Tried], start: Tried, limit: float | None) -> list[Ahead]:
    """Compare settings with the start, seed by seed.

    With the same seed two settings often have the same layout, so that their difference scatters far less than
    either of them. How much it does is estimated for each setting from its own differences, and from those of all.

    Parameters
    ----------
    found, start
        Measured with the same seeds, at least two.
    limit
        Of D; None for that of the start.
    """
    kept = [
        [own - (start.kept[place] if limit is None else limit) for place, own in enumerate(each.kept)]
        for each in found
    ]
    gained = [[own - other for own, other in zip(each.gained, start.gained, strict=True)] for each in found]
    usual = [_pooled(each) for each in (kept, gained)]
    return [
        Ahead(
            within=_chance(-fmean(below), _deviation(below, usual[0])),
            larger=_chance(fmean(above) - LEAST_GAIN, _deviation(above, usual[1])),
            gain=fmean(above),
        )
        for below, above in zip(kept, gained, strict=True)
    ]


def _squares(values: Sequence[float]) -> float:
    mean = fmean(values)
    return math.fsum((value - mean) ** 2 for value in values)


def _pooled(groups: Sequence[Sequence[float]]) -> float:
    """Return the variance within groups."""
    freedom = sum(len(each) - 1 for each in groups)
    return math.fsum(map(_squares, groups)) / freedom if freedom else 0.0


def _deviation(values: Sequence[float], usual: float) -> float:
    """Return the standard error of a mean; the usual variance counts as one more value."""
    return math.sqrt((_squares(values) + usual) / len(values) / len(values))


def _chance(ahead: float, deviation: float) -> float:
    """Return the chance that a difference which was measured as ``ahead`` is above 0; without deviation 1 or 0."""
    if deviation <= 0:
        return float(ahead >= 0)
    return NormalDist().cdf(ahead / deviation)


def promising(
    found: Sequence[Tried],
    start: Tried,
    limit: float | None,
    count: int,
    kind: Callable[[Params], Hashable] = lambda params: params,
    alike: int = ALIKE,
) -> list[Tried]:
    """Return up to ``count`` settings that may well be better than the start.

    Parameters
    ----------
    found, start, limit
        As in :func:`compared`.
    kind
        What settings that are nearly the same have in common: at most ``alike`` of a kind are taken as long as
        there are others, for they have the same luck.

    Returns
    -------
    list
        The surest ones where the limit is the start's. Else by turns the surest one, and the one with the largest
        gain times its chance; where none has any chance, those nearest to the limit. Of settings with the same
        numbers (a knob that changes nothing) the first.
    """
    different: dict[tuple[tuple[float, ...], tuple[float, ...]], Tried] = {}
    for each in found:
        if each.usable and each.params != start.params:
            different.setdefault((each.kept, each.gained), each)
    usable = list(different.values())
    ahead = compared(usable, start, limit)
    ranks = [each.means.rank(fmean(start.kept) if limit is None else limit) for each in usable]
    places = range(len(usable))
    orders = [sorted(places, key=lambda place: (ahead[place].sure, *ranks[place]), reverse=True)]
    if limit is not None:
        orders.append(sorted(places, key=lambda place: (ahead[place].much, *ranks[place]), reverse=True))
    chosen: list[int] = []
    for turn in zip(*orders, strict=True):
        chosen += [place for place in dict.fromkeys(turn) if place not in chosen]
    taken: Counter[Hashable] = Counter()
    first: list[Tried] = []
    rest: list[Tried] = []
    for place in chosen:
        own = kind(usable[place].params)
        taken[own] += 1
        (first if taken[own] <= alike else rest).append(usable[place])
    return (first + rest)[:count]


def best_at_the_end(found: Sequence[Tried], start: Tried, limit: float | None) -> Tried:
    """Return what to suggest: the start unless another one has a larger V with D within the limit.

    Of several the surest where the limit is the start's, else that with the largest V; where nothing is within the
    limit, the start among them, that which is nearest to it.
    """
    allowed = fmean(start.kept) if limit is None else limit
    everything = [start, *(each for each in found if each.usable)]
    better = [
        each for each in everything[1:] if fmean(each.kept) <= allowed and fmean(each.gained) > fmean(start.gained)
    ]
    if limit is None and better:
        ahead = compared(better, start, None)
        return better[max(range(len(better)), key=lambda place: (ahead[place].sure, ahead[place].gain))]
    return max(everything, key=lambda each: each.means.rank(allowed))
