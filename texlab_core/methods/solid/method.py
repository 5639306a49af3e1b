"""Solid textures after Heeger and Bergen: a block of noise is given the exemplar's histograms, scale by scale.

Reference: D. Heeger and J. Bergen, "Pyramid-based texture analysis/synthesis", SIGGRAPH 1995, section 3.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.registry import Estimate, Method, register
from texlab_core.engine.steps import Step
from texlab_core.errors import ParamError
from texlab_core.methods.heeger_bergen import analysis
from texlab_core.methods.solid.params import SolidParams
from texlab_core.methods.solid.rounds import SolidModel
from texlab_core.methods.solid.told import MEASURES
from texlab_core.work.tasks import Pace, crew

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import Output
    from texlab_core.engine.streams import Streams

MAX_SIDE = 256

# Samples worked through between two steps.
STRIDE = 2**16


def check(inputs: Inputs, params: SolidParams, size: tuple[int, ...]) -> None:
    """Refuse sides above 256 voxels."""
    if max(size) > MAX_SIDE:
        depth, height, width = size
        raise ParamError("size", f"at most {MAX_SIDE} voxels a side", f"{width} x {height} x {depth}")


def estimate(inputs: Inputs, params: SolidParams, size: tuple[int, ...]) -> Estimate:
    """Foretell time and memory from the number of voxels."""
    axes = exemplar_of(inputs).channels
    samples = math.prod(size)
    sides = params.orientations if params.kind == "mixed" else 0
    # Microseconds for a voxel, on one core of an ordinary machine.
    balanced = params.balance and params.histograms == "pooled"
    plain = 0.06 + (0.06 * sides + 0.1 if sides else 0)
    seconds = axes * samples * (0.1 + params.iterations * (1.5 if balanced else 1) * plain) * 1e-6
    # Volumes of floats that are there at the same time: the planes, the image, and those of two axes at work.
    volumes = 3 * axes + min(axes, 2) * ((12 if sides else 6) + (4 if balanced else 0))
    return Estimate(seconds, 4 * samples * volumes)


def analyze(inputs: Inputs, params: SolidParams) -> Generator[Step, None, SolidModel]:
    """Sort the pixels and the subbands of every colour axis."""
    image = exemplar_of(inputs).pixels
    pyramids: list[analysis.Pyramid] = ["laplacian", "steerable"] if params.kind == "mixed" else ["laplacian"]
    totals = [analysis.expected_work(image.size, each, params.orientations, params.border) for each in pyramids]
    total, models = sum(totals), []
    with crew() as team:
        for index, pyramid in enumerate(pyramids):
            done = sum(totals[:index])
            most = done + totals[index]

            def step(samples: int, most: int = most) -> Step:
                nonlocal done
                done = min(done + samples, most)
                return Step(done, total, "pyramid of the exemplar")

            work = analysis.analyze(image, pyramid, params.scales, params.orientations, params.border, team)
            models.append((yield from Pace(STRIDE).steps(work, step)))
    return SolidModel(models[0], models[1] if len(models) == 2 else None)


def synthesize(
    model: SolidModel, inputs: Inputs, params: SolidParams, size: tuple[int, int, int], streams: Streams
) -> Generator[Step, None, Output]:
    """Make a solid from noise."""
    from texlab_core.methods.solid.synthesis import Synthesis

    with crew() as team:
        work = Synthesis(model, inputs, params, size, streams, team)
        yield from work.start()
        for iteration in range(params.iterations):
            yield from work.iterate(iteration)
        return (yield from work.finish())


register(
    Method(
        id="solid",
        title="Solid texture",
        summary="A block of noise is given the exemplar's histograms in every subband; it can be cut anywhere.",
        reference="D. Heeger and J. Bergen, Pyramid-based texture analysis/synthesis, SIGGRAPH 1995, section 3",
        params=SolidParams,
        analyze=analyze,
        synthesize=synthesize,
        check=check,
        estimate=estimate,
        rehearsals=(SolidParams(kind="mixed", iterations=1),),
        fails_on=(
            "shapes: slices have the exemplar's colours and grain, not its outlines",
            "exemplars with one direction, such as wood grain: no solid has it in all slices",
            "structure larger than 2^scales voxels",
        ),
        measures=MEASURES,
        dimensions=3,
        order=12,
    )
)
