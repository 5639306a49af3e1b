"""Independent bands: every frequency band sampled without conditioning, the third baseline of De Bonet's paper."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np

from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.params import Knob, Params
from texlab_core.engine.registry import Method, register
from texlab_core.engine.steps import Output
from texlab_core.methods.de_bonet.choices import COARSEST_SIDE, FITTING, Fitting

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import Step
    from texlab_core.engine.streams import Streams
    from texlab_core.methods.de_bonet.analysis import Analysis
    from texlab_core.methods.de_bonet.quadtree import Grid

_DRAWN_AT_ONCE = 2**18


@dataclass(frozen=True, kw_only=True)
class BandsParams(Params):
    """Parameters of independent bands."""

    coarsest_side: Annotated[int, COARSEST_SIDE] = 4
    border: Annotated[
        Literal["reflect", "periodic"],
        Knob(
            help="How the pyramid sees an image beyond its border.",
            stage="analysis",
            choices={"reflect": "mirrored", "periodic": "repeated"},
            group="Pyramid",
        ),
    ] = "reflect"
    fitting: Annotated[Fitting, FITTING] = "pad"


def check(inputs: Inputs, params: BandsParams, size: tuple[int, int]) -> None:
    """Refuse outputs that are too thin for the pyramid."""
    from texlab_core.methods.de_bonet.fitting import choose_depth
    from texlab_core.methods.de_bonet.growth import check_size

    check_size(size, choose_depth(*exemplar_of(inputs).size, params.coarsest_side, params.fitting))


def analyze(inputs: Inputs, params: BandsParams) -> Generator[Step, None, Analysis]:
    """Build the exemplar's Laplacian pyramid."""
    from texlab_core.methods.de_bonet.analysis import analyze_steps
    from texlab_core.methods.de_bonet.growth import analyze_in_steps

    steps = analyze_steps(
        exemplar_of(inputs).pixels,
        smallest=params.coarsest_side,
        border=params.border,
        fitting=params.fitting,
        filters="laplacian",
    )
    return (yield from analyze_in_steps(steps, "pyramid"))


def synthesize(
    model: Analysis, inputs: Inputs, params: BandsParams, size: tuple[int, int], streams: Streams
) -> Generator[Step, None, Output]:
    """Draw every value of every band uniformly from the exemplar's band, and collapse."""
    from texlab_core.methods.de_bonet.growth import grow
    from texlab_core.methods.de_bonet.quadtree import Grid

    grid = Grid.covering(*size, model.depth)
    sources = [np.empty(grid.count(level), np.int32) for level in range(model.depth + 1)]
    for _ in _draw(model.grid, model.depth, sources[-1], streams):
        pass
    finer = range(model.depth - 1, -1, -1)
    progress = ((level, count) for level in finer for count in _draw(model.grid, level, sources[level], streams))
    periodic = model.border == "periodic"
    image = yield from grow(model, grid, sources, progress, size=size, periodic=periodic)
    return Output(image=image, notes=model.notes)


def _draw(exemplar: Grid, level: int, out: NDArray[np.int32], streams: Streams) -> Generator[int, None, None]:
    """Fill ``out`` with uniform sources, yielding how many each time."""
    for part, first in enumerate(range(0, out.size, _DRAWN_AT_ONCE)):
        last = min(out.size, first + _DRAWN_AT_ONCE)
        random = streams("bands", level, part)
        out[first:last] = random.integers(exemplar.count(level), size=last - first, dtype=np.int32)
        yield last - first


register(
    Method(
        id="bands",
        title="Independent bands",
        summary="Samples every frequency band from the exemplar's without regard to the other bands.",
        reference="J. S. De Bonet, Multiresolution sampling procedure for analysis and synthesis of texture "
        "images, SIGGRAPH 1997, fig. 4",
        params=BandsParams,
        analyze=analyze,
        synthesize=synthesize,
        fails_on=("edges, lines and everything else that several bands make together",),
        check=check,
        order=202,
        bytes_per_pixel=54,
    )
)
