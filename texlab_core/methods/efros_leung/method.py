"""Efros and Leung: grow the image pixel by pixel, each copied from where its surroundings occur."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from texlab_core.engine.inputs import ImageInput, exemplar_of
from texlab_core.engine.registry import EXEMPLAR, Estimate, InputSpec, Method, register
from texlab_core.engine.steps import Step
from texlab_core.methods.efros_leung.fill import fills
from texlab_core.methods.efros_leung.params import EfrosLeungParams
from texlab_core.methods.efros_leung.told import DISTANCE, EXACT_SHARE, GARBAGE, OWN_DISTANCE
from texlab_core.work.tasks import relay, through

if TYPE_CHECKING:
    from collections.abc import Generator

    import numpy as np
    from numpy.typing import NDArray

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage, Output
    from texlab_core.engine.steps import Step as AnyStep
    from texlab_core.engine.streams import Streams
    from texlab_core.kernels.neighbourhood_types import Pool


@dataclass(frozen=True, eq=False)
class EfrosLeungModel:
    """The candidates, and d_min of the exemplar's own windows with their place left out, (n,) float32."""

    pool: Pool
    levels: NDArray[np.float32]


def _by_parts(inputs: Inputs, params: EfrosLeungParams) -> bool:
    return params.reach > 0 and fills(inputs)


def check(inputs: Inputs, params: EfrosLeungParams, size: tuple[int, int]) -> None:
    """Refuse what cannot work; see :func:`texlab_core.methods.efros_leung.checks.check_inputs`."""
    from texlab_core.methods.efros_leung.checks import check_inputs

    parts = _by_parts(inputs, params)
    check_inputs(inputs, params.matching(exemplar_of(inputs)), size, params.place, by_parts=parts)


def estimate(inputs: Inputs, params: EfrosLeungParams, size: tuple[int, int]) -> Estimate:
    """Foretell the memory of a run, from the pixels of the images and of the output."""
    images = sum(math.prod(each.size) for each in inputs.values() if isinstance(each, ImageInput))
    if _by_parts(inputs, params):
        # The picture and its maps, and one part.
        return Estimate(None, 50 * math.prod(size) + 2**26)
    return Estimate(None, 65 * (images + math.prod(size)))


def analyze(inputs: Inputs, params: EfrosLeungParams) -> Generator[AnyStep, None, EfrosLeungModel | None]:
    """Lay the exemplar out for the search, and measure how well it explains itself; None when filled by parts."""
    from texlab_core.methods.efros_leung.candidates import make_pool, to_bytes
    from texlab_core.methods.efros_leung.fill import allowed_centres
    from texlab_core.methods.efros_leung.level import leave_one_out

    if _by_parts(inputs, params):
        yield Step(1, 1, "every part has its own surroundings")
        return None
    matching = params.matching(exemplar_of(inputs))
    values = to_bytes(exemplar_of(inputs).pixels)
    allowed = allowed_centres(inputs, matching)
    pool = make_pool(values, allowed, matching)
    measuring = leave_one_out(values, allowed, pool, matching)
    levels = yield from relay(measuring, lambda part: Step(*part, "matching the exemplar with itself"))
    return EfrosLeungModel(pool, levels)


def synthesize(
    model: EfrosLeungModel | None,
    inputs: Inputs,
    params: EfrosLeungParams,
    size: tuple[int, int],
    streams: Streams,
) -> Generator[AnyStep, None, Output]:
    """Fill everything that is unknown, and tell where it came from."""
    from texlab_core.methods.efros_leung.blending import blended
    from texlab_core.methods.efros_leung.by_parts import fill_by_parts

    if model is None:
        output = yield from fill_by_parts(
            inputs, params.matching, size, streams, reach=params.reach, anchor=params.place
        )
    else:
        output = yield from _grow(model, inputs, params, size, streams)
    return (yield from blended(output, inputs, params.place))


def _grow(
    model: EfrosLeungModel, inputs: Inputs, params: EfrosLeungParams, size: tuple[int, int], streams: Streams
) -> Generator[AnyStep, None, Output]:
    from texlab_core.methods.efros_leung.evidence import report
    from texlab_core.methods.efros_leung.explain import Grown
    from texlab_core.methods.efros_leung.fill import begin, full_state, make_growth, settings_digest

    matching = params.matching(exemplar_of(inputs))
    exemplar = exemplar_of(inputs)
    laying = begin(inputs, matching, size, streams, seed_patch=params.seed_patch, anchor=params.place)
    beginning = yield from through(laying, Step(0, size[0] * size[1], "laying out what is known"))
    settings = settings_digest(inputs, matching, size, streams)
    growth = make_growth(beginning, model.pool, matching, streams, settings)

    def state() -> dict[str, NDArray[np.generic]]:
        return full_state(growth, exemplar, beginning.given)

    last = growth.step()
    yield replace(last, state=state)
    for last in growth.run():
        yield replace(last, state=state)
    grown = Grown(growth.canvas, model.pool, matching, growth.choice_key, growth.since, state)
    return (yield from report(grown, exemplar, beginning.given, model.levels, last))


def draft(inputs: Inputs, params: EfrosLeungParams, size: tuple[int, int], seed: int) -> FloatImage:
    """Show roughly and at once what the parameters do; see :mod:`texlab_core.methods.efros_leung.draft`."""
    from texlab_core.methods.efros_leung.draft import draft

    return draft(
        {name: each for name, each in inputs.items() if name != "patches"},
        params.matching(exemplar_of(inputs)),
        size,
        seed,
        seed_patch=params.seed_patch,
        anchor=params.place,
    )


def ask_why(result: Result) -> None:
    """Ask why the pixel that was filled last is what it is."""
    from texlab_core.methods.efros_leung.explain import explain

    order = result.details.canvas.order
    row, column = divmod(int(order.argmax()), order.shape[1])
    explain(result.details, row, column)


register(
    Method(
        id="efros-leung",
        title="Efros-Leung",
        summary="Grows the image pixel by pixel, each copied from a place with the same surroundings.",
        reference='A. Efros and T. Leung, "Texture synthesis by non-parametric sampling", ICCV 1999; '
        "Forsyth & Ponce, Computer Vision, section 11.3.4, algorithm 11.6.",
        params=EfrosLeungParams,
        analyze=analyze,
        synthesize=synthesize,
        check=check,
        draft=draft,
        questions=(ask_why,),
        inputs=(
            EXEMPLAR,
            InputSpec(
                "start", "An image to fill or to extend; the exemplar when only a mask is given.", required=False
            ),
            InputSpec(
                "mask",
                "What is not black is to be filled; as large as the start image.",
                required=False,
                background=0.0,
            ),
            InputSpec(
                "blend",
                "Instead of a mask: how much of the fill covers what was there, 0 (black) to 1 (white).",
                required=False,
                background=0.0,
            ),
            InputSpec(
                "region",
                "What is not black may be copied; as large as the exemplar.",
                required=False,
                background=0.0,
            ),
            InputSpec(
                "patches",
                "What was filled in the start image before: laid over it first, and not copied from.",
                "arrays",
                required=False,
            ),
            InputSpec("state", "Where a stopped or finished run stood, to go on from.", "arrays", required=False),
        ),
        fails_on=(
            "windows smaller than the texture's elements: they fall apart",
            "windows much larger than its elements: specks, or the exemplar copied verbatim",
            "growth that has lost its way: the same few pixels over and over",
        ),
        order=30,
        estimate=estimate,
        measures=("copied-share", "largest-copy", EXACT_SHARE.id, DISTANCE.id, OWN_DISTANCE.id, GARBAGE.id),
    )
)
