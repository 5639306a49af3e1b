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
    stages
        (settings, seeds): so many of those that are left, and the start, with so many seeds in all.
    """

    stages: tuple[tuple[int, int], ...]

    @property
    def seeds(self) -> int:
        """How many seeds decide."""
        return self.stages[-1][1]

    @property
    def runs(self) -> int:
        """Most runs that it takes, those of the start among them."""
        before, runs = 0, 0
        for settings, seeds in self.stages:
            runs += (settings + 1) * (seeds - before)
            before = seeds
        return runs


FINAL = Final(((20, 4), (8, 12), (4, 48)))
# Of settings that differ in single thresholds only, so many are measured again.
ALIKE = 5
# Of V: what is less is no gain.
LEAST_GAIN = 0.001
# What holds is to hold when somebody tries it again with so many seeds, as surely as this.
AGAIN, SURE = 16, 0.9
# Of small budgets.
SHORT_FINAL = Final(((4, 3),))
FINAL_FROM = 600


@dataclass(frozen=True)
class Tried:
    """A setting with what came of it, seed by seed; the seeds are the first ones of the start, in the same order.

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


def compared(
    found: Sequence[Tried],
    start: Tried,
    limit: float | None,
    again: int = 0,
    group: Callable[[Params], Hashable] = lambda _: None,
) -> list[Ahead]:
    """Compare settings with the start, seed by seed.

    With the same seed two settings often have the same layout, so that their difference scatters far less than
    either of them. How much it does is estimated for each setting from its own differences, and from those of its
    group.

    Parameters
    ----------
    found, start
        Measured with the same seeds, at least two; the start with as many as any other, or more.
    limit
        Of D; None for that of the start.
    again
        The chances are those that it holds for the means over so many other seeds; 0 for the true means.
    group
        Settings of a group scatter alike.
    """
    kept = [
        [own - (start.kept[place] if limit is None else limit) for place, own in enumerate(each.kept)]
        for each in found
    ]
    gained = [[own - other for own, other in zip(each.gained, start.gained, strict=False)] for each in found]
    groups = [group(each.params) for each in found]

    def usual(values: Sequence[Sequence[float]], place: int) -> float:
        return _pooled([own for own, which in zip(values, groups, strict=True) if which == groups[place]])

    return [
        Ahead(
            within=_chance(-fmean(below), _deviation(below, usual(kept, place), again)),
            larger=_chance(fmean(above) - LEAST_GAIN, _deviation(above, usual(gained, place), again)),
            gain=fmean(above),
        )
        for place, (below, above) in enumerate(zip(kept, gained, strict=True))
    ]


def _squares(values: Sequence[float]) -> float:
    mean = fmean(values)
    return math.fsum((value - mean) ** 2 for value in values)


def _pooled(groups: Sequence[Sequence[float]]) -> float:
    """Return the variance within groups."""
    freedom = sum(len(each) - 1 for each in groups)
    return math.fsum(map(_squares, groups)) / freedom if freedom else 0.0


def _deviation(values: Sequence[float], usual: float, again: int) -> float:
    """Return how far a mean is from the true one, or from that of ``again`` other values.

    The usual variance counts as one more value.
    """
    share = 1 / len(values) + (1 / again if again else 0)
    return math.sqrt((_squares(values) + usual) / len(values) * share)


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
    group: Callable[[Params], Hashable] = lambda _: None,
) -> list[Tried]:
    """Return up to ``count`` settings that may well be better than the start.

    Parameters
    ----------
    found, start, limit, group
        As in :func:`compared`.
    kind
        What settings that are nearly the same have in common: at most ``alike`` of a kind are taken as long as
        there are others, for they have the same luck.

    Returns
    -------
    list
        By turns the surest one, and the one with the largest gain times its chance; where none has any chance,
        those nearest to the limit. Of settings with the same numbers (a knob that changes nothing) the first.
    """
    different: dict[tuple[tuple[float, ...], tuple[float, ...]], Tried] = {}
    for each in found:
        if each.usable and each.params != start.params:
            different.setdefault((each.kept, each.gained), each)
    usable = list(different.values())
    ahead = compared(usable, start, limit, group=group)
    ranks = [each.means.rank(fmean(start.kept[: len(each.kept)]) if limit is None else limit) for each in usable]
    places = range(len(usable))
    orders = [
        sorted(places, key=lambda place: (ahead[place].sure, *ranks[place]), reverse=True),
        sorted(places, key=lambda place: (ahead[place].much, *ranks[place]), reverse=True),
    ]
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


def best_at_the_end(
    found: Sequence[Tried],
    start: Tried,
    limit: float | None,
    group: Callable[[Params], Hashable] = lambda _: None,
) -> Tried:
    """Return what to suggest: the start unless another one has a larger V with D within the limit.

    Where the limit is the start's, of those that are nearly sure to hold again that with the largest V, without
    any the surest; else that with the largest V. Where nothing is within the limit, the start among them, that
    which is nearest to it.
    """
    allowed = fmean(start.kept) if limit is None else limit
    everything = [start, *(each for each in found if each.usable)]
    better = [
        each for each in everything[1:] if fmean(each.kept) <= allowed and fmean(each.gained) > fmean(start.gained)
    ]
    if limit is None and better:
        ahead = compared(better, start, None, AGAIN, group)

        def worth(place: int) -> tuple[float, float]:
            return min(ahead[place].sure, SURE), ahead[place].gain

        return better[max(range(len(better)), key=worth)]
    return max(everything, key=lambda each: each.means.rank(allowed))
