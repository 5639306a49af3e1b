"""A round after which no band is farther from the exemplar's than before.

The average of four solids that were matched one by one has bands that are weaker than each of them made them, and
some that began near are pushed away by what their neighbours put into them. So the average is corrected: a filter
gives every band a strength with which it is no farther away (:mod:`texlab_core.methods.solid.gains`), and bands
whose histogram has a worse shape than before are matched once more by themselves. When that does not do, less of
the average is taken; when nothing does, the solid stays as it is and has settled.

This is ours: Heeger and Bergen 1995, section 3, take the average as it is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.solid.gains import Reach, find_gains
from texlab_core.methods.solid.rounds import PIECE, match_round
from texlab_core.methods.solid.shapes import Shapes, measure_shapes, move
from texlab_core.stats.histogram import match_ranks_in_place
from texlab_core.transforms import solid_spectrum
from texlab_core.work.tasks import row_blocks
from texlab_core.work.threads import sums_in_one_thread

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.methods.solid.classes import Classes
    from texlab_core.methods.solid.rounds import AxisModel, Plan, Volume
    from texlab_core.work.tasks import Task

# How much a band may rise in a round, in standard deviations, as long as it stays below where it began.
SLACK = 1e-3
# How much of the average is taken, and which part of the way the bands are to go, one after the other.
_TRIES = ((1.0, 0.5, 30.0), (0.4, 0.2, 3.0), (0.0, 0.5, 3.0), (0.0, 0.2, 3.0), (0.0, 0.08, 3.0))
_CORRECTIONS = 3
_FILTERINGS = 3
# Part of the way that a band has to go at least, and part of its distance that its shape is to lose.
_MARGIN, _SHARE = 0.1, 0.6
_LONGEST = 1.5


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
    settled
        Whether no further round is of use.
    """

    volume: Volume
    distances: NDArray[np.float64]
    first: NDArray[np.float64]
    settled: bool = False


def begin(volume: Volume, model: AxisModel, plan: Plan) -> Task[State]:
    """Measure the noise that a solid is made of."""
    shapes = yield from measure_shapes(volume, model, plan)
    return State(volume, shapes.distances, shapes.distances)


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
        No band is farther away than in the noise, or more than ``SLACK`` farther than before the round. Only the
        first round may break this, where none of the tries does without.
    """
    if state.settled:
        return state
    beginning = state.distances is state.first
    average, _ = yield from match_round(state.volume, model, plan, tie_key)
    least: tuple[float, State] | None = None
    for number, (share, aim, eager) in enumerate(_TRIES):
        key = partial(tie_key, 8, number)
        volume = yield from _between(state.volume, average, share, model, key(0))
        shapes = yield from measure_shapes(volume, model, plan)
        for correction in range(1, _CORRECTIONS + 1):
            correct = _Correction(state, model, plan, classes, aim, eager, partial(key, correction))
            volume = yield from correct.apply(volume, shapes, reshape=correction > 1)
            shapes = yield from measure_shapes(volume, model, plan)
            after = State(volume, shapes.distances, state.first)
            rise = float((after.distances - state.distances).max())
            if rise <= SLACK and (after.distances <= np.maximum(state.first, state.distances)).all():
                return after
            cost = 2 * max(rise, 0.0) + float(after.distances.mean())
            if least is None or cost < least[0]:
                least = (cost, after)
    if beginning and least is not None:
        return least[1]
    return replace(state, settled=True)


@dataclass(frozen=True, slots=True, eq=False)
class _Correction:
    """How a solid is corrected that has moved some bands away."""

    state: State
    model: AxisModel
    plan: Plan
    classes: Classes
    aim: float
    eager: float
    tie_key: Callable[..., int]

    def apply(self, volume: Volume, shapes: Shapes, *, reshape: bool) -> Task[Volume]:
        """Return the solid with the strengths, and if asked for the shapes, that its bands need."""
        # The voxels' histogram says how much power there is in all.
        whole = float(self.model.solid.pixels.sample.var(dtype=np.float64))
        responses = np.vstack([self.classes.responses, np.ones(self.classes.responses.shape[1])])
        spectrum = yield from solid_spectrum.forward(volume)
        power = yield from self.classes.power(spectrum)
        # What the classes say that a band holds is right but for a factor.
        factors = np.append(shapes.variances, whole) / np.maximum(responses @ power, 1e-30)
        responses *= factors[:, None]
        before, reach = self.state.distances, Reach.of(shapes.quantiles, shapes.wanted, shapes.spreads)
        least = reach.least
        room = np.maximum(before - least, 0)
        low, high = (shapes.variances * each for each in reach.within(before - _MARGIN * self.aim * room))
        near, far = (shapes.variances * each for each in reach.within(before - self.aim * room))
        steps = (self.eager * (least - before * (1 - _SHARE * self.aim)) / np.maximum(least, 1e-9)).clip(
            0, _LONGEST
        )
        if reshape and steps.any():
            volume = yield from move(volume, self.model, self.plan, steps, partial(self.tie_key, 0))
            yield from self._match_voxels(volume, 1)
            spectrum = yield from solid_spectrum.forward(volume)
            power = yield from self.classes.power(spectrum)
        for turn in range(_FILTERINGS):
            if turn:
                spectrum = yield from solid_spectrum.forward(volume)
                power = yield from self.classes.power(spectrum)
            now = responses @ power
            with sums_in_one_thread():
                gains = find_gains(
                    responses,
                    power,
                    np.append(low, whole),
                    np.append(high, whole),
                    np.append(now[:-1].clip(near, far), whole),
                    np.maximum(np.append(shapes.spreads**2, whole), now),
                )
            yield from self.classes.apply(spectrum, gains * factors)
            volume = yield from solid_spectrum.inverse(spectrum, volume.shape)
            yield from self._match_voxels(volume, 2 + turn)
        return volume

    def _match_voxels(self, volume: Volume, place: int) -> Task[None]:
        yield from match_ranks_in_place(volume, self.model.solid.pixels.sample, self.tie_key(1, place))


def _between(volume: Volume, average: Volume, share: float, model: AxisModel, key: int) -> Task[Volume]:
    """Return a solid between two, with the exemplar's voxels."""
    if share in (0, 1):
        return average if share else volume
    mixed = np.empty_like(volume)
    for block in row_blocks(volume.shape, PIECE):
        mixed[block] = volume[block] + np.float32(share) * (average[block] - volume[block])
        yield mixed[block].size // 8
    yield from match_ranks_in_place(mixed, model.solid.pixels.sample, key)
    return mixed
