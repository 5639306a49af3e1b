"""Independent pixels: every pixel drawn from the exemplar's, the second baseline of De Bonet's paper."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.params import Params
from texlab_core.engine.registry import Method, register
from texlab_core.engine.steps import Map, Output, Step

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import FloatImage
    from texlab_core.engine.streams import Streams

_PIXELS_AT_ONCE = 2**18


@dataclass(frozen=True, kw_only=True)
class PixelsParams(Params):
    """Independent pixels have no parameters."""


def analyze(inputs: Inputs, params: PixelsParams) -> Generator[Step, None, FloatImage]:
    """Return the exemplar: its pixels are the distribution."""
    yield Step(1, 1, "exemplar")
    return exemplar_of(inputs).pixels


def synthesize(
    model: FloatImage, inputs: Inputs, params: PixelsParams, size: tuple[int, int], streams: Streams
) -> Generator[Step, None, Output]:
    """Draw every pixel uniformly and independently, all channels together."""
    from texlab_core.measures.copying import continuous_share

    height, width, channels = model.shape
    count = size[0] * size[1]
    palette = model.reshape(-1, channels)
    image = np.zeros((count, channels), np.float32)
    source = np.empty((count, 2), np.int32)
    for part, first in enumerate(range(0, count, _PIXELS_AT_ONCE)):
        last = min(count, first + _PIXELS_AT_ONCE)
        drawn = streams("pixels", part).integers(height * width, size=last - first, dtype=np.int32)
        image[first:last] = palette[drawn]
        source[first:last, 0] = drawn // width
        source[first:last, 1] = drawn % width
        yield Step(last, count, "pixels", preview=image.reshape(*size, channels).copy)
    places = source.reshape(*size, 2)
    return Output(
        image=image.reshape(*size, channels),
        maps={"source": Map(places, "source", "Source", "px")},
        measures={"copied-share": continuous_share(places)},
    )


register(
    Method(
        id="pixels",
        title="Independent pixels",
        summary="Draws every pixel from the exemplar's pixels; right histogram, no structure.",
        reference="J. S. De Bonet, Multiresolution sampling procedure for analysis and synthesis of texture "
        "images, SIGGRAPH 1997, fig. 3",
        params=PixelsParams,
        analyze=analyze,
        synthesize=synthesize,
        fails_on=("everything but white noise",),
        order=201,
        bytes_per_pixel=21,
        measures=("copied-share",),
    )
)
