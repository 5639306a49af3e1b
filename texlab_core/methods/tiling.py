"""Tiling: the exemplar repeated, the first baseline of De Bonet's paper."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np

from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.params import Knob, Params
from texlab_core.engine.registry import Method, register
from texlab_core.engine.steps import Map, Output, Step

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import FloatImage
    from texlab_core.engine.streams import Streams

_PIXELS_AT_ONCE = 2**19


@dataclass(frozen=True, kw_only=True)
class TilingParams(Params):
    """Parameters of tiling."""

    mirror: Annotated[
        bool, Knob(help="Mirror every second repetition, so that the borders meet.", group="Synthesis")
    ] = False


def analyze(inputs: Inputs, params: TilingParams) -> Generator[Step, None, FloatImage]:
    """Return the exemplar: there is nothing to learn."""
    yield Step(1, 1, "exemplar")
    return exemplar_of(inputs).pixels


def synthesize(
    model: FloatImage, inputs: Inputs, params: TilingParams, size: tuple[int, int], streams: Streams
) -> Generator[Step, None, Output]:
    """Repeat the exemplar from the top left corner on."""
    from texlab_core.measures.copying import continuous_share

    rows = _repeated(size[0], model.shape[0], params.mirror)
    columns = _repeated(size[1], model.shape[1], params.mirror)
    image = np.zeros((*size, model.shape[2]), np.float32)
    source = np.empty((*size, 2), np.int32)
    at_once = max(1, _PIXELS_AT_ONCE // size[1])
    for first in range(0, size[0], at_once):
        part = slice(first, first + at_once)
        image[part] = model[rows[part, None], columns]
        source[part, :, 0] = rows[part, None]
        source[part, :, 1] = columns
        yield Step(min(first + at_once, size[0]), size[0], "repetitions", preview=image.copy)
    return Output(
        image=image,
        maps={"source": Map(source, "source", "Source", "px")},
        measures={"copied-share": continuous_share(source)},
    )


def _repeated(length: int, period: int, mirror: bool) -> NDArray[np.int32]:
    """Return the exemplar's row (or column) for each row (or column) of the output."""
    place = np.arange(length, dtype=np.int32)
    if not mirror:
        return place % period
    place %= 2 * period
    return np.minimum(place, 2 * period - 1 - place)


register(
    Method(
        id="tiling",
        title="Tiling",
        summary="Repeats the exemplar; the repetition shows, and nothing is random.",
        reference="J. S. De Bonet, Multiresolution sampling procedure for analysis and synthesis of texture "
        "images, SIGGRAPH 1997, fig. 2",
        params=TilingParams,
        analyze=analyze,
        synthesize=synthesize,
        fails_on=("everything that does not repeat with the exemplar's own size",),
        order=200,
        bytes_per_pixel=21,
        random=False,
        measures=("copied-share",),
    )
)
