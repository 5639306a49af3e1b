"""Moves: single changes of De Bonet's conditions and rows, and which of them to make together.

With the same layout and the same seed, results of two thresholds differ in few places only, so that a change's
effect on D and V is known far better than either. Effects of small changes nearly add up: one that makes D smaller
pays for one that makes V larger.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from itertools import combinations
from statistics import NormalDist
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from texlab_core.methods.de_bonet.params import DeBonetParams

# What rows are multiplied by.
ROW_FACTORS = (0.5, 0.7, 1.4, 2.0, 4.0)
# Alpha is multiplied by these.
ALPHA_FACTORS = (0.5, 0.75, 1.3, 1.7, 2.7)
LARGEST_ALPHA = 0.5
# What may make the conditions fit this exemplar better, and leaves the layout as it is.
CONDITIONS: tuple[Mapping[str, Any], ...] = (
    {"beta": 0.5},
    {"beta": 1.0},
    {"channels": "scaled"},
    {"channels": "principal"},
    {"orientations": 2},
    {"orientations": 8},
    {"filters": "first"},
    {"filters": "second"},
)
# What is made together, at most, and in how many of the combinations that are tried one move takes part.
MOST_TOGETHER = 3
MOST_OFTEN = 6
# Of a sum of effects, for each move: how far it is from what is measured then (D, V), standard deviations.
OFF_KEPT, OFF_GAINED = 0.03, 0.003


class Move(NamedTuple):
    """One change.

    Parameters
    ----------
    what
        What it changes: two moves of the same do not go together.
    changes
        Parameters that become others.
    row, factor
        Row k of the threshold table that is multiplied; 0 for none.
    """

    what: str
    changes: tuple[tuple[str, Any], ...] = ()
    row: int = 0
    factor: float = 1.0


@dataclass(frozen=True)
class Effect:
    """A move, and by how much D and V became larger with it."""

    move: Move
    kept: float
    gained: float


def moves(params: DeBonetParams, depth: int) -> list[Move]:
    """Return the single changes of these parameters, whose threshold table has so many rows."""
    found = []
    for each in CONDITIONS:
        ((name, value),) = each.items()
        if getattr(params, name) != value:
            found.append(Move(name, ((name, value),)))
    alphas = {float(f"{min(params.alpha * factor, LARGEST_ALPHA):.3g}") for factor in ALPHA_FACTORS}
    found += [Move("alpha", (("alpha", each),)) for each in sorted(alphas - {params.alpha})]
    found += [Move(f"row {k}", row=k, factor=factor) for k in range(1, depth + 1) for factor in ROW_FACTORS]
    return found


def largest_chance(kept: float, gained: float, limit: float, base: float, scatter: tuple[float, float]) -> float:
    """Return the chance that D is at most the limit and V above ``base``, where both scatter so much."""
    within = NormalDist().cdf((limit - kept) / scatter[0])
    return within * NormalDist().cdf((gained - base) / scatter[1])


def together(
    effects: Sequence[Effect], offset: tuple[float, float], limit: float, count: int
) -> list[tuple[Move, ...]]:
    """Return which moves to make together, those first that are surest to gain V with D within the limit.

    Parameters
    ----------
    effects
        Of the single moves.
    offset
        D and V of what they were made from, less those of the start.
    limit
        By how much D may be larger than that of the start.
    count
        How many to return, at most.
    """
    known = [each for each in effects if math.isfinite(each.kept) and math.isfinite(each.gained)]
    ranked = []
    for number in range(2, MOST_TOGETHER + 1):
        scatter = OFF_KEPT * math.sqrt(number), OFF_GAINED * math.sqrt(number)
        for chosen in combinations(known, number):
            if len({each.move.what for each in chosen}) < number:
                continue
            kept = offset[0] + math.fsum(each.kept for each in chosen)
            gained = offset[1] + math.fsum(each.gained for each in chosen)
            sure = largest_chance(kept, gained, limit, 0.0, scatter)
            # The chance decides up to a tenth; among what is as sure, the larger V.
            ranked.append((round(sure, 1), gained, tuple(each.move for each in chosen)))
    ranked.sort(key=lambda each: each[:2], reverse=True)
    taken: Counter[Move] = Counter()
    found: list[tuple[Move, ...]] = []
    for _, _, chosen_moves in ranked:
        if len(found) == count:
            break
        if all(taken[each] < MOST_OFTEN for each in chosen_moves):
            taken.update(chosen_moves)
            found.append(chosen_moves)
    return found
