"""Random phase noise: the best that second-order statistics can do, and the yardstick of the coded methods."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np

from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.params import Knob, Params
from texlab_core.engine.progress import Progress
from texlab_core.engine.registry import Method, register
from texlab_core.engine.steps import Output
from texlab_core.methods.spectral.told import PARAMETERS

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import FloatImage, Step
    from texlab_core.engine.streams import Streams
    from texlab_core.methods.spectral.uncoded import Spot


@dataclass(frozen=True, kw_only=True)
class UncodedParams(Params):
    """Parameters of random phase noise."""

    border: Annotated[
        Literal["as-is", "periodic"],
        Knob(
            "What to do about the jump between opposite borders, which the spectrum sees as a cross.",
            choices={
                "as-is": "nothing, as in the paper",
                "periodic": "keep the periodic component, without the smooth image that explains the jump",
            },
            stage="analysis",
            source="Moisan 2011, eqs. 10 and 11",
            group="Analysis",
        ),
    ] = "as-is"


def analyze(inputs: Inputs, params: UncodedParams) -> Generator[Step, None, Spot]:
    """Remove the mean, and the smooth component if that is asked for."""
    from texlab_core.methods.spectral.uncoded import make_spot

    pixels = exemplar_of(inputs).pixels
    stages = {f"channel {channel + 1}": 1.0 for channel in range(pixels.shape[2])}
    progress = Progress(stages)
    return (yield from make_spot(pixels, params.border == "periodic", progress, "channel"))


def synthesize(
    model: Spot, inputs: Inputs, params: UncodedParams, size: tuple[int, int], streams: Streams
) -> Generator[Step, None, Output]:
    """Give the exemplar's spectrum a random phase, then its histograms."""
    from texlab_core.methods.spectral.fourier import BLOCK, inverse, random_phase
    from texlab_core.methods.spectral.uncoded import give_phase, parameter_count, spectra
    from texlab_core.stats import histogram
    from texlab_core.work.tasks import row_blocks

    channels = range(len(model.planes))
    weights: dict[str, float] = {"phase": 1.0}
    for stage, weight in (("spectrum", 1.0), ("transform", 1.0), ("histogram", 4.0)):
        weights |= {f"{stage} {channel + 1}": weight for channel in channels}
    progress = Progress(weights)

    phase = yield from random_phase(size, streams, progress, "phase")
    halves = yield from spectra(model, size, progress, "spectrum")
    yield from give_phase(halves, phase, progress, f"spectrum {len(halves)}")
    height, width = size
    planes = []
    for channel, half in enumerate(halves):
        half[0, 0] = model.mean[channel] * height * width
        planes.append((yield from inverse(half, size, progress, f"transform {channel + 1}")))
    yield progress.at(f"transform {len(halves)}", preview=lambda: np.clip(np.stack(planes, axis=2), 0, 1))

    pixels = exemplar_of(inputs).pixels
    image: FloatImage = np.empty((height, width, len(planes)), np.float32)
    for channel, plane in enumerate(planes):
        stage = f"histogram {channel + 1}"
        target = histogram.sorted_sample(pixels[:, :, channel])
        yield progress.at(stage, 0.3)
        for _ in histogram.match_ranks_in_place(plane, target, streams.key("ties", channel)):
            yield progress.at(stage, 0.6)
        for rows in row_blocks((height, width), BLOCK):
            image[rows, :, channel] = plane[rows]
            yield progress.at(stage, 0.6 + 0.4 * rows.stop / height)
    return Output(
        image=image, measures={PARAMETERS.id: float(parameter_count(model.planes.shape[1:], len(halves)))}
    )


register(
    Method(
        id="uncoded",
        title="Uncoded spectrum",
        summary="The exemplar's magnitude spectrum and histogram with a random phase.",
        reference="Navarro & Portilla 1996, section 4; Galerne, Gousseau & Morel 2011, Random phase textures",
        params=UncodedParams,
        analyze=analyze,
        synthesize=synthesize,
        fails_on=("objects, outlines and letters: phase is random", "textures with few large elements"),
        order=41,
        bytes_per_pixel=43,
        measures=(PARAMETERS.id,),
    )
)
