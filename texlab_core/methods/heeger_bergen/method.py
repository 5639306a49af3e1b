"""Heeger and Bergen: noise is given the exemplar's histograms, in the pixels and in every subband of a pyramid.

Reference: D. Heeger and J. Bergen, "Pyramid-based texture analysis/synthesis", SIGGRAPH 1995; Forsyth and Ponce,
sections 11.2 and 11.3.2.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np

from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.params import Knob, Params
from texlab_core.engine.registry import Method, register
from texlab_core.engine.steps import Output, Step
from texlab_core.methods.heeger_bergen import analysis
from texlab_core.methods.heeger_bergen.knobs import BORDER, ITERATIONS, ORIENTATIONS, SCALES
from texlab_core.methods.heeger_bergen.palette import transport_palette
from texlab_core.methods.heeger_bergen.rounds import Matching, Plan, match, match_round, measure
from texlab_core.methods.heeger_bergen.staged import Staged, distance_curve, mean
from texlab_core.transforms.colour import interleave
from texlab_core.work.tasks import Pace, crew, finish, row_blocks

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import FloatImage
    from texlab_core.engine.streams import Streams
    from texlab_core.methods.heeger_bergen.analysis import TextureModel
    from texlab_core.transforms.steerable import BandKey
    from texlab_core.work.tasks import Crew, Task

# Samples worked through between two steps: below 1 ms, or 15 ms in planes too large for the cache memory.
STRIDE = 2**15

# Units of progress in each stage.
UNITS = 100


@dataclass(frozen=True, kw_only=True)
class HeegerBergenParams(Params):
    """Parameters of Heeger and Bergen's method."""

    iterations: Annotated[int, ITERATIONS] = 5
    matching: Annotated[
        Matching,
        Knob(
            help="How a histogram is given to a subband.",
            choices={
                "exact": "by rank: the result has the very values of the exemplar",
                "bins": "through the paper's lookup tables of 256 bins",
            },
            group="Synthesis",
            source="Heeger and Bergen 1995, section 2.2",
        ),
    ] = "exact"
    rgb_matching: Annotated[
        bool,
        Knob(
            help="Match the histograms of red, green and blue once the colour axes are put together.",
            label="rgb matching",
            when=("palette", ("off",)),
            formerly=True,
            group="Colour",
        ),
    ] = True
    palette: Annotated[
        Literal["off", "transport"],
        Knob(
            help="Colours that the exemplar does not have appear because its axes are matched one by one.",
            choices={
                "off": "leave them; at most the histograms of red, green and blue are matched at the end",
                "transport": "move all colours onto the exemplar's palette at the end (sliced optimal transport)",
            },
            group="Colour",
            source="Heeger and Bergen 1995, section 2.5; Pitié, Kokaram and Dahyot 2007",
        ),
    ] = "off"
    palette_rounds: Annotated[
        int,
        Knob(
            help="Random rotations of the colour space for the transport.",
            low=1,
            high=64,
            group="Colour",
            when=("palette", ("transport",)),
        ),
    ] = 16
    pyramid: Annotated[
        analysis.Pyramid,
        Knob(
            help="The subbands whose histograms are matched.",
            choices={
                "steerable": "scales and orientations",
                "laplacian": "scales only: oriented structure is lost",
                "textbook": "Laplacian pyramid that expands by replicating pixels (Forsyth and Ponce, 11.2.1)",
            },
            stage="analysis",
            group="Pyramid",
            source="Heeger and Bergen 1995, section 2.1",
        ),
    ] = "steerable"
    scales: Annotated[int, SCALES] = 4
    orientations: Annotated[
        int,
        replace(
            ORIENTATIONS,
            source="Forsyth and Ponce, chapter 11, assignment b",
            when=("pyramid", ("steerable",)),
        ),
    ] = 4
    odd_sides: Annotated[
        analysis.OddSides,
        Knob(
            help="How a Laplacian pyramid halves an odd side of an image that wraps around.",
            choices={
                "spread": "coarse samples lie evenly around it, so that the result tiles at any size",
                "doubled": "as if its last sample were there twice: a seam shows",
            },
            stage="analysis",
            when=("pyramid", ("laplacian", "textbook")),
            formerly="doubled",
            group="Pyramid",
        ),
    ] = "spread"
    border: Annotated[analysis.Border, BORDER] = "reflect"


@dataclass(frozen=True, slots=True, eq=False)
class Convergence:
    """Distances of the subbands round by round, for the convergence plot and the heat map.

    Parameters
    ----------
    keys
        Places of the subbands, from fine to coarse.
    distances
        (iterations + 1, axes, bands) float64: W1 / sd after i rounds. What matching the channels of a colour image
        does afterwards is not in it.
    final
        (axes, bands) float64: the same of the finished picture.
    """

    keys: tuple[BandKey, ...]
    distances: NDArray[np.float64]
    final: NDArray[np.float64]


def analyze(inputs: Inputs, params: HeegerBergenParams) -> Generator[Step, None, TextureModel]:
    """Sort the pixels and the subbands of every colour axis."""
    image = exemplar_of(inputs).pixels
    with crew() as team:
        work = analysis.analyze(
            image, params.pyramid, params.scales, params.orientations, params.border, team, params.odd_sides
        )
        total = analysis.expected_work(image.size, params.pyramid, params.orientations, params.border)
        done = 0

        def step(samples: int) -> Step:
            nonlocal done
            done = min(done + samples, total)
            return Step(done, total, "pyramid of the exemplar")

        return (yield from Pace(STRIDE).steps(work, step))


def synthesize(
    model: TextureModel,
    inputs: Inputs,
    params: HeegerBergenParams,
    size: tuple[int, int],
    streams: Streams,
    begin: Callable[[int, NDArray[np.float32]], Task[None]] | None = None,
) -> Generator[Step, None, Output]:
    """Make a texture from noise; ``begin(axis, noise)`` may turn an axis's noise into another start, in place."""
    with crew() as team:
        run = _Run(model, inputs, params, size, streams, team, begin)
        yield from run.start()
        for iteration in range(params.iterations):
            yield from run.iterate(iteration)
        image = yield from run.finish()
    return run.output(image)


class _Run(Staged):
    """State of one synthesis."""

    def __init__(
        self,
        model: TextureModel,
        inputs: Inputs,
        params: HeegerBergenParams,
        size: tuple[int, int],
        streams: Streams,
        team: Crew,
        begin: Callable[[int, NDArray[np.float32]], Task[None]] | None = None,
    ) -> None:
        axes = len(model.planes)
        super().__init__(
            axes,
            # One round on one axis is a stage, a turn of the palette is half a stage.
            params.iterations * max(axes, 1),
            1 + (params.palette_rounds // 2 if params.palette == "transport" else 0),
            # Every sample of every band is transformed, matched and transformed back.
            size[0] * size[1] * (4 * params.orientations + 4),
            units=UNITS,
            stride=STRIDE,
        )
        self.begin = begin
        self.model, self.inputs, self.params, self.size = model, inputs, params, size
        self.streams, self.team = streams, team
        levels = min(model.levels, analysis.max_levels(size, params.pyramid))
        around = analysis.around(params.odd_sides)
        self.plan = Plan(params.pyramid, levels, params.orientations, params.matching, around)
        self.keys = self.plan.keys
        self.image: FloatImage | None = None
        self.distances = np.zeros((params.iterations + 1, axes, len(self.keys)))
        self.final = self.distances[-1]

    def start(self) -> Generator[Step, None, None]:
        """Make noise with the exemplar's pixel values on each axis."""
        for axis, target in enumerate(self.model.planes):
            plane = np.empty(self.size, np.float32)
            noise = self.streams("noise", axis)
            for rows in row_blocks(self.size):
                plane[rows] = noise.random(plane[rows].shape, dtype=np.float32)
                yield self._step("noise")
            if self.begin is not None:
                yield from self._steps(self.begin(axis, plane), "noise")
            work = match(plane, target.pixels, self.plan.matching, self.streams.key("start", axis))
            yield from self._steps(work, "noise")
            self.planes.append(plane)
        self._next_stage()
        yield self._step("noise", frame="noise")

    def iterate(self, iteration: int) -> Generator[Step, None, None]:
        """Do one round on every axis."""
        stage = f"iteration {iteration + 1} of {self.params.iterations}"
        for axis, target in enumerate(self.model.planes):
            tie_key = partial(self.streams.key, "ties", iteration, axis)
            work = match_round(self.planes[axis], target, self.plan, tie_key, self.team)
            self.planes[axis], self.distances[iteration, axis] = yield from self._steps(work, stage)
            self._next_stage()
        yield self._step(
            stage, {"mean-distance": mean(self.distances[iteration])}, frame=f"iteration {iteration + 1}"
        )

    def finish(self) -> Generator[Step, None, FloatImage]:
        """Go back to colours, match the channels, and measure what came out."""
        self.distances[-1] = yield from self._measure(self.planes)
        self.final = self.distances[-1]
        image = yield from self._steps(self.model.to_image(self.planes, self.size), "colours")
        if self.model.axes is not None or not self.model.planes:
            image = yield from self._colours(image)
        self.image = np.clip(image, 0, 1, out=image)
        if self.model.axes is not None and self.model.planes:
            self.final = yield from self._measure(
                (yield from self._steps(self.model.axes.to_axes_task(image), "distances"))
            )
        self._end_stages()
        yield self._step("done", {"mean-distance": mean(self.distances[-1])})
        return image

    def _measure(
        self, planes: Sequence[NDArray[np.float32]] | NDArray[np.float32]
    ) -> Generator[Step, None, NDArray[np.float64]]:
        """Return the distances (axes, bands) of the planes."""
        distances = np.zeros(self.distances.shape[1:])
        for axis, (plane, target) in enumerate(zip(planes, self.model.planes, strict=True)):
            work = measure(plane, target, self.plan, self.team)
            distances[axis] = yield from self._steps(work, "distances")
        return distances

    def _colours(self, image: FloatImage) -> Generator[Step, None, FloatImage]:
        if self.params.palette == "transport" and self.model.axes is not None:
            exemplar = exemplar_of(self.inputs).pixels
            moving = transport_palette(image, exemplar, self.params.palette_rounds, self.streams)
            return (yield from self._steps(moving, "palette"))
        if not self.params.rgb_matching:
            return image
        channels = np.ascontiguousarray(np.moveaxis(image, -1, 0))
        for channel, (plane, sample) in enumerate(zip(channels, self.model.palette, strict=True)):
            key = self.streams.key("channel", channel)
            work = match(plane, analysis.Target(sample, 1.0), self.plan.matching, key)
            yield from self._steps(work, "colours")
        return (yield from self._steps(interleave(channels), "colours"))

    def output(self, image: FloatImage) -> Output:
        """Return the picture with its evidence."""
        means = [mean(row) for row in self.distances]
        curves = {"mean-distance": distance_curve(means, "Distance of the subbands, mean")}
        for index, key in enumerate(self.keys):
            values = [mean(row[:, index]) for row in self.distances]
            curves[f"band-{key.label}"] = distance_curve(values, f"Distance of subband {key.label}")
        return Output(
            image=image,
            curves=curves,
            notes=self._notes(),
            details=Convergence(self.keys, self.distances, self.final),
        )

    def _notes(self) -> tuple[str, ...]:
        if not self.model.planes:
            return ("The exemplar is constant, and so is the result.",)
        if self.plan.levels == self.params.scales:
            return ()
        (height, width), (rows, columns) = exemplar_of(self.inputs).size, self.size
        return (
            f"{self.plan.levels} of {self.params.scales} scales fit an exemplar of {width} x {height} and a"
            f" result of {columns} x {rows} pixels.",
        )

    def _preview(self) -> FloatImage:
        image = self.image
        if image is None:
            image = finish(self.model.to_image(self.planes, self.size))
        return np.clip(image, 0, 1)


register(
    Method(
        id="heeger-bergen",
        title="Heeger-Bergen",
        summary="Noise is given the exemplar's histograms, in the pixels and in every subband of a pyramid.",
        reference="D. Heeger and J. Bergen, Pyramid-based texture analysis/synthesis, SIGGRAPH 1995",
        params=HeegerBergenParams,
        analyze=analyze,
        synthesize=synthesize,
        fails_on=(
            "structure that several scales or orientations make together (wood grain, coral, hay, marble)",
            "objects with sharp outlines (letters, bricks, coins)",
            "exemplars that are not the same all over: the result is blotchy",
        ),
        order=10,
        bytes_per_pixel=310,
    )
)
