"""A round after which all bands are nearer to the exemplar's than those of the noise.

The average of four solids that were matched one by one has bands that are weaker than each of them made them, and
some that began near are pushed away by what their neighbours put into them. So the average is corrected, as often
as it takes: a filter gives every band a strength with which it is no farther away
(:mod:`texlab_core.methods.solid.gains`), and bands whose histogram has too bad a shape for that are matched once
more by themselves. A band that is still too far away is asked for more the next time. When that does not do, the
solid stays as it is, and the next round goes a shorter way.

This is ours: Heeger and Bergen 1995, section 3, take the average as it is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.solid.gains import find_gains
from texlab_core.methods.solid.shapes import Strengths, distances_of, shape_of, sweep
from texlab_core.methods.solid.slices import CUTS
from texlab_core.stats.histogram import match_ranks_in_place
from texlab_core.transforms import solid_spectrum
from texlab_core.work.tasks import row_blocks
from texlab_core.work.threads import sums_in_one_thread

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.methods.solid.classes import Classes
    from texlab_core.methods.solid.rounds import AxisModel, Plan, Volume
    from texlab_core.methods.solid.shapes import Shape
    from texlab_core.work.tasks import Task

# How much a band may rise in a round, in parts of its distance in the noise, as long as it stays below that.
RISE = 0.05
# How much nearer than in the noise all bands are to be, in standard deviations: at least, and when it is aimed at.
NEARER, _AIMED = 1e-4, 1e-3
# How often the first round is corrected at most, and the others, which begin nearer.
_CORRECTIONS_AT_FIRST, _CORRECTIONS = 8, 5
_FILTERINGS = 2
# Which part of its way a band is to go by its strength, and has to go at least.
_AIM, _LEAST = 0.5, 0.05
# Part of its distance that a shape is to lose, how soon it is moved at full length, and how long that is.
_LOSS, _EAGER, _LONGEST = 0.3, 30.0, 1.5
# What is left of these aims from one correction to the next: in the end only bands that are too far away move.
_CALM = 0.5
# A band that is too far away is asked for as much more, but no more than this part of where it began.
_MOST_ASKED = 0.1
# How much of the way to the average a round goes; the next one is taken when one fails, and after the last none.
_SHARES = (1.0, 0.3, 0.0)


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """A solid between two rounds, on one colour axis.

    Parameters
    ----------
    volume
        (D, H, W) float32.
    distances
        (bands,) float64: W1 / sd of every band.
    first
        Those of the noise.
    failed
        How many rounds have failed.
    """

    volume: Volume
    distances: NDArray[np.float64]
    first: NDArray[np.float64]
    failed: int = 0

    @property
    def excess(self) -> float:
        """By how much some band is not nearer than in the noise, at most; 0 when all are."""
        return max(float((self.distances - self.first).max()) + NEARER, 0.0)

    def risen(self, before: State) -> bool:
        """Whether some band is farther away than before by more than it may be."""
        return bool((self.distances > before.distances + RISE * self.first).any())


def begin(volume: Volume, model: AxisModel, plan: Plan) -> Task[State]:
    """Measure the noise that a solid is made of."""
    shapes, _ = yield from sweep(volume, model, plan, lambda place, shape: 0.0)
    first = distances_of(shapes)
    return State(volume, first, first)


def balanced_round(
    state: State, model: AxisModel, plan: Plan, classes: Classes, tie_key: Callable[..., int]
) -> Task[State]:
    """Do one round on one colour axis.

    Parameters
    ----------
    state
        Stays as it is.
    model, plan
        Targets, and how they are matched: pooled.
    classes
        Of the solid's frequencies.
    tie_key
        Gives a 64-bit key for any whole numbers.

    Returns
    -------
    State
        All bands are nearer than in the noise, and none has risen by more than ``RISE`` of its distance there.
        When the first round cannot keep this it comes as near to it as it can, and the next ones make up for it.
    """
    beginning = state.distances is state.first
    if state.failed >= len(_SHARES) and not state.excess:
        return state
    best: State | None = None
    while True:
        after = yield from _try(state, model, plan, classes, tie_key)
        if not (after.excess or (after.risen(state) and not beginning)):
            return after
        if best is None or _cost(after) < _cost(best):
            best = after
        state = replace(state, failed=state.failed + 1)
        # Noise is no answer, so the first round tries whatever there is.
        if not beginning or state.failed == len(_SHARES):
            return best if beginning or best.excess < state.excess else state


def _try(state: State, model: AxisModel, plan: Plan, classes: Classes, tie_key: Callable[..., int]) -> Task[State]:
    """Go a part of the way to the average, and correct it until it will do; return what came nearest to it."""
    beginning = state.distances is state.first
    place = min(state.failed, len(_SHARES) - 1)
    share = _SHARES[place] * (1.0 if plan.slices is None else 1 / (1 + len(CUTS)))
    volume = state.volume
    if share:
        _, volume = yield from sweep(volume, model, plan, lambda place, shape: share)
        yield from match_ranks_in_place(volume, model.solid.pixels.sample, tie_key(place, 0))
    # Where the bands are to be in the end.
    wanted = np.minimum(state.distances + 0.5 * RISE * state.first, state.first - _AIMED)
    best: State | None = None
    corrections = _CORRECTIONS_AT_FIRST if beginning else _CORRECTIONS
    for number in range(corrections + 1):
        calm = _CALM**number if number < corrections else 0.0
        corrects = _Correction(model, plan, classes, wanted, calm)
        shapes, moved = yield from sweep(volume, model, plan, corrects.step)
        if number or share:
            after = replace(state, volume=volume, distances=distances_of(shapes))
            if not (after.excess or (after.risen(state) and not beginning)):
                return after
            if best is None or _cost(after) < _cost(best):
                best = after
        if number < corrections:
            more = np.minimum(np.maximum(distances_of(shapes) - wanted, 0), _MOST_ASKED * state.first)
            wanted = wanted - more
            corrects = replace(corrects, wanted=wanted)
            key = tie_key(place, 1 + number)
            volume = yield from corrects.apply(volume, moved, Strengths.of(shapes), key)
    assert best is not None
    return best


def _cost(state: State) -> float:
    return 2 * state.excess + float(state.distances.mean())


@dataclass(frozen=True, slots=True, eq=False)
class _Correction:
    """How a solid is corrected that has moved some bands away.

    Parameters
    ----------
    model, plan, classes
        As for a round.
    wanted
        (bands,) at which distance each band is to be.
    calm
        Of the aims; 0 where nothing is to be moved.
    """

    model: AxisModel
    plan: Plan
    classes: Classes
    wanted: NDArray[np.float64]
    calm: float

    def step(self, place: int, shape: Shape) -> float:
        """Return how far a band is moved; above 1, as neighbours hold a part of every band."""
        if not self.calm:
            return 0.0
        least = float(shape.reach.least[0])
        over = least - self.wanted[place] * (1 - _LOSS * self.calm)
        return float(np.clip(_EAGER * over / max(least, 1e-9), 0, _LONGEST))

    def apply(self, volume: Volume, moved: Volume, held: Strengths, key: int) -> Task[Volume]:
        """Return the solid, moved already, with the strengths that its bands need."""
        # The voxels' histogram says how much power there is in all.
        whole = float(self.model.solid.pixels.sample.var(dtype=np.float64))
        responses = np.vstack([self.classes.responses, np.ones(self.classes.responses.shape[1])])
        spectrum = yield from solid_spectrum.forward(volume)
        power = yield from self.classes.power(spectrum)
        # What the classes say that a band holds is right but for a factor.
        factors = np.append(held.variances, whole) / np.maximum(responses @ power, 1e-30)
        responses *= factors[:, None]
        room = np.maximum(self.wanted - held.reach.least, 0)
        low, high = (held.variances * each for each in held.reach.within(self.wanted - _LEAST * self.calm * room))
        near, far = (held.variances * each for each in held.reach.within(self.wanted - _AIM * self.calm * room))
        if moved is not volume:
            yield from self._match_about(moved)
            spectrum = yield from solid_spectrum.forward(moved)
            power = yield from self.classes.power(spectrum)
        filtered = volume
        for turn in range(_FILTERINGS):
            if turn:
                yield from self._match_about(filtered)
                spectrum = yield from solid_spectrum.forward(filtered)
                power = yield from self.classes.power(spectrum)
            now = responses @ power
            with sums_in_one_thread():
                gains = find_gains(
                    responses,
                    power,
                    np.append(low, whole),
                    np.append(high, whole),
                    np.append(now[:-1].clip(near, far), whole),
                    np.maximum(np.append(held.spreads**2, whole), now),
                )
            yield from self.classes.apply(spectrum, gains * factors)
            filtered = yield from solid_spectrum.inverse(spectrum, volume.shape)
        yield from match_ranks_in_place(filtered, self.model.solid.pixels.sample, key)
        return filtered

    def _match_about(self, volume: Volume) -> Task[None]:
        """Give the voxels about the exemplar's values, in a third of the time of the exact ones."""
        shape = yield from shape_of(volume, self.model.solid.pixels)
        changes = volume.copy()
        yield from shape.to_changes(changes, 1.0)
        for block in row_blocks(volume.shape):
            volume[block] += changes[block]
            yield volume[block].size // 8
