"""What a pop-out test says: hits and misses by method, with intervals, beside what guessing reaches."""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist, median
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Answer:
    """What was said about one picture.

    Parameters
    ----------
    trial
        Number of the picture.
    row, column
        The pixel that was clicked; both None when the viewer could not tell.
    seconds
        From the first painting of the picture; None where no time was taken.
    """

    trial: int
    row: int | None
    column: int | None
    seconds: float | None = None


@dataclass(frozen=True, kw_only=True)
class Score:
    """What came of the answers about one method.

    Parameters
    ----------
    name
        Of the setting.
    hits, misses
        Clicks on the piece, and all other answers.
    untold
        How many of the misses were no click: the viewer could not tell.
    low, high
        Wilson's interval of the share of hits, at 95 %.
    chance
        Share of hits of the best click without looking.
    seconds
        Median time of the hits; None without hits or times.
    machine
        Hits of the machine observer in the same pictures; None where it did not look.
    """

    name: str
    hits: int
    misses: int
    untold: int
    low: float
    high: float
    chance: float
    seconds: float | None
    machine: int | None

    @property
    def answers(self) -> int:
        """Number of pictures that were answered."""
        return self.hits + self.misses

    @property
    def share(self) -> float:
        """Share of hits; NaN without answers."""
        return self.hits / self.answers if self.answers else math.nan

    @property
    def luck(self) -> float:
        """Probability of as many hits or more by guessing."""
        return at_least(self.hits, self.answers, self.chance)

    @property
    def verdict(self) -> str:
        """What can be said, in a few words."""
        if not self.answers:
            return "no answers"
        if self.low > self.chance:
            return "the piece stands out"
        if self.high < self.chance:
            return "found less often than by guessing"
        return "not told from guessing"


def wilson(hits: int, count: int, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Return Wilson's score interval of a share, without continuity correction; (0, 1) for no cases.

    Reference: E. B. Wilson, JASA 22 (1927): the shares p within z sqrt(p (1 - p) / count) of hits / count.
    """
    if not 0 <= hits <= count:
        raise ValueError(f"hits must be from 0 to {count}, got {hits}.")
    if count == 0:
        return 0.0, 1.0
    z = NormalDist().inv_cdf((1 + confidence) / 2)
    share, spread = hits / count, z * z / count
    middle = (share + spread / 2) / (1 + spread)
    half = z * math.sqrt(share * (1 - share) / count + spread / (4 * count)) / (1 + spread)
    # At the ends the interval touches them exactly; rounding must not leave them out.
    return (0.0 if hits == 0 else middle - half), (1.0 if hits == count else middle + half)


def at_least(hits: int, count: int, chance: float) -> float:
    """Return the probability of ``hits`` or more of ``count``, each with probability ``chance`` (0 .. 1)."""
    if hits <= 0:
        return 1.0
    return min(
        1.0,
        math.fsum(math.comb(count, k) * chance**k * (1 - chance) ** (count - k) for k in range(hits, count + 1)),
    )


def score(name: str, answers: Iterable[tuple[Answer, bool]], chance: float, machine: int | None = None) -> Score:
    """Return the score of the answers about one method, each with whether it is a hit."""
    listed = list(answers)
    hits = sum(hit for _, hit in listed)
    low, high = wilson(hits, len(listed))
    times = [each.seconds for each, hit in listed if hit and each.seconds is not None]
    return Score(
        name=name,
        hits=hits,
        misses=len(listed) - hits,
        untold=sum(each.row is None for each, _ in listed),
        low=low,
        high=high,
        chance=chance,
        seconds=median(times) if times else None,
        machine=machine,
    )
