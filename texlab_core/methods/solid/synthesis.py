"""The synthesis of a solid, step by step: noise, rounds, colours, measures."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.sizes import size_text
from texlab_core.engine.steps import Output, Step, middle_slice
from texlab_core.methods.heeger_bergen import analysis
from texlab_core.methods.heeger_bergen.rounds import match
from texlab_core.methods.heeger_bergen.staged import Staged, distance_curve, mean
from texlab_core.methods.solid.balance import State, balanced_round, begin
from texlab_core.methods.solid.classes import Classes, classes_of
from texlab_core.methods.solid.rounds import AxisModel, Plan, match_round, measure, measure_slices
from texlab_core.methods.solid.slices import CUTS, SlicePlan
from texlab_core.methods.solid.told import BANDS, SLICES, VOXELS
from texlab_core.transforms import gaussian, solid_laplacian
from texlab_core.work.tasks import finish, row_blocks

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import FloatImage, FloatVolume
    from texlab_core.engine.streams import Streams
    from texlab_core.methods.solid.params import SolidParams
    from texlab_core.methods.solid.rounds import SolidModel
    from texlab_core.work.tasks import Crew, Task

# Samples worked through between two steps: a few milliseconds.
STRIDE = 2**16
# Units of progress in each stage.
UNITS = 1000
# W1 / sd at which bands settle when nothing keeps them from moving away.
SETTLED = 0.1
# Less than can be measured.
NOTHING = 1e-6


class Synthesis(Staged):
    """State of one synthesis.

    Parameters
    ----------
    model, inputs, params, size, streams
        As a method's ``synthesize`` gets them.
    team
        Works on the colour axes side by side.
    """

    def __init__(
        self,
        model: SolidModel,
        inputs: Inputs,
        params: SolidParams,
        size: tuple[int, int, int],
        streams: Streams,
        team: Crew,
    ) -> None:
        slices = model.slices
        plan = Plan(
            size,
            min(model.solid.levels, max(0, solid_laplacian.max_levels(size) - 1)),
            None
            if slices is None
            else SlicePlan(slices.levels, params.orientations, params.histograms == "pooled"),
        )
        axes = len(model.solid.planes)
        # A stage is the start, one round, or all that follows.
        super().__init__(axes, params.iterations, 1, max(1, plan.work * max(1, axes)), units=UNITS, stride=STRIDE)
        self.model, self.inputs, self.params, self.size = model, inputs, params, size
        self.streams, self.team, self.plan = streams, team, plan
        self.models = [
            AxisModel(plane, None if slices is None else slices.planes[axis])
            for axis, plane in enumerate(model.solid.planes)
        ]
        self.volume: FloatVolume | None = None
        self.labels = self.plan.labels
        self.distances = np.zeros((params.iterations, len(self.models), len(self.labels)))
        self.balanced = params.balance and params.histograms == "pooled" and params.iterations > 0
        self.states: list[State] = []
        self.classes: Classes | None = None
        self.measures: dict[str, float] = {}

    def start(self) -> Generator[Step, None, None]:
        """Make noise with the exemplar's values on each colour axis."""
        for axis, target in enumerate(self.models):
            plane = np.empty(self.size, np.float32)
            noise = self.streams("noise", axis)
            for block in row_blocks(self.size):
                plane[block] = noise.random(plane[block].shape, dtype=np.float32)
                yield self._step("noise")
            work = match(plane, target.solid.pixels, "exact", self.streams.key("start", axis))
            yield from self._steps(work, "noise")
            self.planes.append(plane)
        if self.balanced and self.models:
            self.classes = yield from self._steps(
                classes_of(self.size, self.plan.levels, self.plan.slices), "noise"
            )
            for plane, model in zip(self.planes, self.models, strict=True):
                self.states.append((yield from self._steps(begin(plane, model, self.plan), "noise")))
        self._next_stage()
        yield self._step("noise", frame="noise")

    def iterate(self, iteration: int) -> Generator[Step, None, None]:
        """Do one round on every colour axis."""
        stage = f"iteration {iteration + 1} of {self.params.iterations}"
        tasks = (self._round(iteration, axis, plane) for axis, plane in enumerate(self.planes))

        def accept(done: tuple[int, NDArray[np.float32], NDArray[np.float64]]) -> tuple[()]:
            axis, self.planes[axis], self.distances[iteration, axis] = done
            return ()

        yield from self._steps(self.team.in_order(tasks, accept), stage)
        self._next_stage()
        metrics = {"mean-distance": mean(self.distances[iteration])}
        yield self._step(stage, metrics, frame=f"iteration {iteration + 1}")

    def _round(
        self, iteration: int, axis: int, plane: NDArray[np.float32]
    ) -> Task[tuple[int, NDArray[np.float32], NDArray[np.float64]]]:
        key = partial(self.streams.key, "ties", iteration, axis)
        if self.classes is not None:
            before = self.states[axis]
            after = yield from balanced_round(before, self.models[axis], self.plan, self.classes, key)
            self.states[axis] = after
            return axis, after.volume, before.distances
        matched, distances = yield from match_round(plane, self.models[axis], self.plan, key)
        return axis, matched, distances

    def finish(self) -> Generator[Step, None, Output]:
        """Go back to colours, match the channels, and measure what came out."""
        final = []
        for plane, model in zip(self.planes, self.models, strict=True):
            final.append((yield from self._steps(measure(plane, model, self.plan), "distances")))
        levels = min(self.model.solid.levels, *(max(0, gaussian.max_levels(cut) - 1) for cut in self._cuts()))
        shares = np.zeros((max(1, len(self.models)), len(CUTS)))
        for axis, (plane, model) in enumerate(zip(self.planes, self.models, strict=True)):
            shares[axis] = yield from self._steps(measure_slices(plane, model.solid, levels), "distances")
        volume: FloatVolume = yield from self._steps(self.model.solid.to_image(self.planes, self.size), "colours")
        if self.model.solid.axes is not None or not self.models:
            yield from self._match_channels(volume)
        for block in row_blocks(volume.shape):
            np.clip(volume[block], 0, 1, out=volume[block])
            yield self._step("colours")
        self.volume = volume
        pixels = yield from self._measure_pixels(volume)
        self.measures = {
            VOXELS.id: pixels,
            BANDS.id: mean(np.array(final)),
            **{SLICES[cut].id: float(share) for cut, share in zip(CUTS, shares.mean(axis=0), strict=True)},
        }
        self._end_stages()
        yield self._step("done", {"mean-distance": mean(np.array(final))})
        return self._output(volume, np.array(final))

    def _cuts(self) -> list[tuple[int, int]]:
        return [(self.size[axes[1]], self.size[axes[2]]) for axes in CUTS.values()]

    def _match_channels(self, volume: FloatVolume) -> Generator[Step, None, None]:
        """Give red, green and blue the exemplar's histograms, one after the other."""
        for channel, sample in enumerate(self.model.solid.palette):
            plane = np.empty(self.size, np.float32)
            yield from self._copy(plane, volume[..., channel])
            key = self.streams.key("channel", channel)
            yield from self._steps(match(plane, analysis.Target(sample, 1.0), "exact", key), "colours")
            yield from self._copy(volume[..., channel], plane)

    def _measure_pixels(self, volume: FloatVolume) -> Generator[Step, None, float]:
        """Return W1 / sd between the values of solid and exemplar, averaged over the channels."""
        shares = []
        for channel, sample in enumerate(self.model.solid.palette):
            plane = np.empty(self.size, np.float32)
            yield from self._copy(plane, volume[..., channel])
            spread = float(sample.std(dtype=np.float64))
            work = match(plane, analysis.Target(sample, spread or 1.0), "exact", 0)
            shares.append((yield from self._steps(work, "distances")))
        return float(np.mean(shares))

    def _copy(self, there: NDArray[np.float32], here: NDArray[np.float32]) -> Generator[Step, None, None]:
        for block in row_blocks(self.size):
            there[block] = here[block]
            yield self._step("colours")

    def _output(self, volume: FloatVolume, final: NDArray[np.float64]) -> Output:
        means = [mean(each) for each in self.distances]
        curves = {"mean-distance": distance_curve(means, "Distance of the subbands, mean")}
        for index, label in enumerate(self.labels):
            values = [mean(each[:, index]) for each in self.distances]
            if self.states:
                values.append(mean(np.array([state.distances[index] for state in self.states])))
            elif index < len(self.plan.keys):
                values.append(mean(final[:, index]) if final.size else 0.0)
            curves[f"band-{label}"] = distance_curve(values, f"Distance of subband {label}")
        return Output(volume=volume, curves=curves, measures=self.measures, notes=self._notes())

    def _notes(self) -> tuple[str, ...]:
        if not self.models:
            return ("The exemplar is constant, and so is the result.",)
        notes = []
        if self.plan.levels != self.params.scales:
            height, width = exemplar_of(self.inputs).size
            scales = f"{self.plan.levels} of {self.params.scales} scales"
            notes.append(
                f"{scales} fit an exemplar of {width} x {height} pixels and a solid of {size_text(self.size)}."
            )
        if farther := self._farther():
            notes.append(
                f"{farther} of {len(self.labels)} bands are farther from the exemplar's than those of the noise"
                " were: what it asks of slices along the three axes does not go together in one solid."
            )
        return tuple(notes)

    def _farther(self) -> int:
        """Return how many bands end farther from the exemplar's than they began, mean over the colour axes."""
        if self.states:
            first = np.mean([state.first for state in self.states], axis=0)
            last = np.mean([state.distances for state in self.states], axis=0)
            return int((last > first + NOTHING).sum())
        if self.plan.slices is None or len(self.distances) < 2:
            return 0
        first, last = (self.distances[place].mean(axis=0) for place in (0, -1))
        return int(((last > first) & (last > SETTLED)).sum())

    def _preview(self) -> FloatImage:
        middle = self.size[0] // 2
        if self.volume is not None:
            return middle_slice(self.volume)
        planes = [plane[middle] for plane in self.planes]
        image = finish(self.model.solid.to_image(planes, (self.size[1], self.size[2])))
        clipped: FloatImage = np.clip(image, 0, 1)
        return clipped
