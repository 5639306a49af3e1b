"""Mixtures after Heeger and Bergen: a texture between two or more exemplars.

Reference: D. Heeger and J. Bergen, "Pyramid-based texture analysis/synthesis", SIGGRAPH 1995, section 4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from texlab_core.engine.inputs import ImageInput
from texlab_core.engine.registry import EXEMPLAR, InputSpec, Method, register
from texlab_core.engine.steps import Step
from texlab_core.methods.heeger_bergen import method as plain
from texlab_core.methods.mixture.blending import Recipe, blend
from texlab_core.methods.mixture.common import Common
from texlab_core.methods.mixture.params import MixtureParams, shares
from texlab_core.work.tasks import Pace, relay, row_blocks

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import FloatImage, Output
    from texlab_core.engine.streams import Streams
    from texlab_core.methods.heeger_bergen.analysis import TextureModel
    from texlab_core.work.tasks import Task

ReturnT = TypeVar("ReturnT")

NAMES = ("exemplar", "second", "third", "fourth")
STRIDE = 2**15
# Of the steps of a mixture: blending comes before the synthesis proper.
BLENDING = 100


@dataclass(frozen=True, slots=True, eq=False)
class MixtureModel:
    """The analyses of all exemplars, by the names of their inputs, as the plain method makes them."""

    models: dict[str, TextureModel]

    @property
    def channels(self) -> int:
        """1 when all exemplars are gray, else 3."""
        return max(each.channels for each in self.models.values())


def plain_params(params: MixtureParams) -> plain.HeegerBergenParams:
    """Return the parameters of the plain method with which mixtures are made."""
    return plain.HeegerBergenParams(
        iterations=params.iterations, scales=params.scales, orientations=params.orientations, border=params.border
    )


def analyze(inputs: Inputs, params: MixtureParams) -> Generator[Step, None, MixtureModel]:
    """Analyze every exemplar as the plain method does."""
    named = [name for name in NAMES if name in inputs]
    models: dict[str, TextureModel] = {}
    for place, name in enumerate(named):
        steps = plain.analyze({"exemplar": inputs[name]}, plain_params(params))
        models[name] = yield from _within(steps, place, len(named))
    return MixtureModel(models)


def weights(params: MixtureParams, names: tuple[str, ...]) -> Recipe:
    """Return the weights of each part for exemplars of these names, in this order."""
    found = shares(params.kind, params.weight)
    more = [getattr(params, name) if params.kind == "average" else 0.0 for name in names[2:]]
    rest = math.prod(1 - share for share in more)

    def spread(second: float) -> tuple[float, ...]:
        # The later ones take their share of all that came before.
        later = [share * math.prod(1 - each for each in more[place + 1 :]) for place, share in enumerate(more)]
        return (rest * (1 - second), rest * second, *later)

    return Recipe(
        spread(found.fine),
        spread(found.coarse),
        spread(found.pixels),
        spread(found.colours),
        params.cut if params.kind == "scales" else 0,
    )


def synthesize(
    model: MixtureModel, inputs: Inputs, params: MixtureParams, size: tuple[int, int], streams: Streams
) -> Generator[Step, None, Output]:
    """Make a texture between the exemplars, or the plain texture of one of them where it has all the weight."""
    names = tuple(name for name in NAMES if name in model.models)
    recipe = weights(params, names)
    start = shares(params.kind, params.weight).start
    alone = next((name for name, share in zip(names, recipe.colours, strict=True) if share == 1), None)
    if alone is not None and recipe.fine == recipe.coarse == recipe.pixels == recipe.colours and start == 0:
        steps = plain.synthesize(
            model.models[alone], {"exemplar": inputs[alone]}, plain_params(params), size, streams
        )
        return (yield from _in_channels(steps, model.channels))
    exemplars = [Common.of(model.models[name], model.channels) for name in names]
    blended = yield from _stepped(blend(exemplars, recipe), "mixture")
    begin = None
    if start > 0:
        begin = yield from _stepped(_starting(exemplars[1], inputs["second"], start, size), "mixture")
    steps = plain.synthesize(blended, inputs, plain_params(params), size, streams, begin)
    return (yield from _in_channels(_after(steps), model.channels))


def _starting(
    second: Common, given: object, share: float, size: tuple[int, int]
) -> Task[Callable[[int, NDArray[np.float32]], Task[None]]]:
    """Return what makes a start of noise: the second exemplar, repeated as in mirrors, in this share."""
    assert isinstance(given, ImageInput)
    rows, columns = (_mirrored(*sides) for sides in zip(size, given.size, strict=True))
    planes = yield from second.to_axes(given.pixels)

    def begin(axis: int, noise: NDArray[np.float32]) -> Task[None]:
        if axis >= len(planes):
            return
        for block in row_blocks(noise.shape):
            # Uniform noise, brought to mean 0 and standard deviation 1.
            part = (noise[block] - np.float32(0.5)) * np.float32(math.sqrt(12))
            image = planes[axis][np.ix_(rows[block], columns)]
            noise[block] = np.float32(1 - share) * part + np.float32(share) * image
            yield part.size

    return begin


def _mirrored(count: int, side: int) -> NDArray[np.intp]:
    """Return the places of an image's side that a longer one shows, there and back again."""
    places = np.arange(count) % (2 * side)
    return np.where(places < side, places, 2 * side - 1 - places)


def _within(steps: Generator[Step, None, ReturnT], place: int, count: int) -> Generator[Step, None, ReturnT]:
    """Make the steps of one of several analyses parts of the whole."""
    units = 1000

    def part(step: Step) -> Step:
        return replace(step, done=round(units * (place + step.fraction)), total=units * count)

    return (yield from relay(steps, part))


def _after(steps: Generator[Step, None, ReturnT]) -> Generator[Step, None, ReturnT]:
    """Count the steps of a synthesis on from the blending."""
    return (
        yield from relay(steps, lambda step: replace(step, done=step.done + BLENDING, total=step.total + BLENDING))
    )


def _stepped(work: Task[ReturnT], stage: str) -> Generator[Step, None, ReturnT]:
    return (yield from Pace(STRIDE).steps(work, lambda _: Step(0, BLENDING, stage)))


def _in_channels(steps: Generator[Step, None, Output], channels: int) -> Generator[Step, None, Output]:
    """Give all pictures so many channels: a gray texture in a mixture with colours is shown in equal ones."""

    def wide(image: FloatImage) -> FloatImage:
        return image if image.shape[2] == channels else np.repeat(image, channels, axis=2)

    def widened(step: Step) -> Step:
        make = step.preview
        return step if make is None else replace(step, preview=lambda: wide(make()))

    output = yield from relay(steps, widened)
    return replace(output, image=wide(output.image))


register(
    Method(
        id="mixture",
        title="Mixture",
        summary="A texture between two or more exemplars: their histograms, colours or scales are mixed.",
        reference="D. Heeger and J. Bergen, Pyramid-based texture analysis/synthesis, SIGGRAPH 1995, section 4",
        params=MixtureParams,
        analyze=analyze,
        synthesize=synthesize,
        inputs=(
            replace(EXEMPLAR, help="The texture at weight 0."),
            InputSpec("second", "The texture at weight 1.", texture=True),
            InputSpec(
                "third", "One more for the kind average, with a share of its own.", required=False, texture=True
            ),
            InputSpec(
                "fourth", "One more for the kind average, with a share of its own.", required=False, texture=True
            ),
        ),
        rehearsals=(MixtureParams(weight=0.0, iterations=1), MixtureParams(kind="start", iterations=1)),
        fails_on=(
            "structure that the plain method loses already",
            "exemplars whose grain differs much in size: the mean of their histograms is neither",
            "colours that share no axis: their mixture is muddy",
        ),
        order=14,
        bytes_per_pixel=400,
    )
)
