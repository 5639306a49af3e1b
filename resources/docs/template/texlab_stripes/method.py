"""Stripes: every row of the result has one colour, drawn from the exemplar's pixels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from texlab_core import Knob, Method, Output, Params, Step, exemplar_of, register

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core import Streams
    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import FloatImage


@dataclass(frozen=True, kw_only=True)
class StripesParams(Params):
    """What can be chosen."""

    width: Annotated[int, Knob(help="Rows of one stripe.", low=1, high=64, unit="px")] = 4
    softness: Annotated[float, Knob(help="How much of the exemplar's mean is mixed in.", low=0, high=1)] = 0.0


def analyze(inputs: Inputs, params: StripesParams) -> Generator[Step, None, FloatImage]:
    """Collect the colours; return (n, C) float32."""
    exemplar = exemplar_of(inputs)
    yield Step(1, 1, "collect colours")
    return exemplar.pixels.reshape(-1, exemplar.channels)


def synthesize(
    model: FloatImage, inputs: Inputs, params: StripesParams, size: tuple[int, int], streams: Streams
) -> Generator[Step, None, Output]:
    """Paint the stripes, one after the other."""
    height, width = size
    image = np.zeros((height, width, model.shape[1]), np.float32)
    stripes = -(-height // params.width)
    chosen = streams("colours").integers(0, len(model), stripes)
    mean = model.mean(axis=0, dtype=np.float64).astype(np.float32)
    for place, index in enumerate(chosen):
        colour = (1 - params.softness) * model[index] + params.softness * mean
        image[place * params.width : (place + 1) * params.width] = np.clip(colour, 0, 1)
        yield Step(place + 1, stripes, f"stripe {place + 1} of {stripes}", preview=image.copy)
    return Output(image=image, measures={"stripes": float(stripes)})


register(
    Method(
        id="stripes",
        title="Stripes",
        summary="Every row has one colour of the exemplar.",
        reference="The template of a package for TexLab, 2026.",
        params=StripesParams,
        analyze=analyze,
        synthesize=synthesize,
        fails_on=("everything that is not striped",),
        measures=("stripes",),
    )
)
