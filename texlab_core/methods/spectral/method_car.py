"""CAR: a causal autoregressive model with 60 coefficients, one of the yardsticks of MSG."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.params import Knob, Params
from texlab_core.engine.progress import Progress
from texlab_core.engine.registry import Method, register
from texlab_core.engine.steps import Output
from texlab_core.methods.spectral.choices import HistogramChoice
from texlab_core.methods.spectral.encoding import HISTOGRAM, Finish
from texlab_core.methods.spectral.told import LARGEST_POLE, PARAMETERS

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import Step
    from texlab_core.engine.streams import Streams
    from texlab_core.methods.spectral.car import Car
    from texlab_core.methods.spectral.fourier import Floats
    from texlab_core.methods.spectral.tone import Tone


@dataclass(frozen=True, kw_only=True)
class CarParams(Params):
    """Parameters of the causal autoregressive model."""

    synthesis: Annotated[
        Literal["spectrum", "recursion"],
        Knob(
            "How the model makes a texture.",
            choices={
                "spectrum": "its magnitude spectrum with a random phase, as in the paper's comparison",
                "recursion": "pixel by pixel from the earlier ones, plus noise",
            },
            source="Navarro & Portilla 1996, section 4, Fig. 6",
            group="Synthesis",
        ),
    ] = "spectrum"
    histogram: Annotated[HistogramChoice, HISTOGRAM] = "coded"


@dataclass(frozen=True, eq=False)
class CarModel:
    """The fitted model, its largest pole, and the tone of the exemplar."""

    car: Car
    pole: float
    tone: Tone
    masses: Floats


def analyze(inputs: Inputs, params: CarParams) -> Generator[Step, None, CarModel]:
    """Fit the 60 coefficients and find the largest pole."""
    from texlab_core.methods.spectral.car import fit, largest_pole
    from texlab_core.methods.spectral.tone import split_tone

    progress = Progress({"colours and histogram": 1, "least squares": 8, "stability": 3})
    plane, tone, masses = yield from split_tone(exemplar_of(inputs).pixels, progress, "colours and histogram")
    car = yield from fit(plane, progress, "least squares")
    pole = yield from largest_pole(car, progress, "stability")
    return CarModel(car, pole, tone, masses)


def synthesize(
    model: CarModel, inputs: Inputs, params: CarParams, size: tuple[int, int], streams: Streams
) -> Generator[Step, None, Output]:
    """Make a texture with the model's spectrum, or by its recursion."""
    from texlab_core.methods.spectral.car import COEFFICIENTS, recurse, shape_noise
    from texlab_core.methods.spectral.fourier import inverse, random_phase

    progress = Progress({"phase": 1, "spectrum": 1, "transform": 1, "histogram": 1})
    half = yield from random_phase(size, streams, progress, "phase")
    limited = 0.0
    if params.synthesis == "recursion":
        plane, limited = yield from recurse(half, model.car, size, progress, "transform")
    else:
        yield from shape_noise(half, model.car, size, progress, "spectrum")
        plane = yield from inverse(half, size, progress, "transform")
    finish = Finish.choose(model.tone, model.masses, params.histogram, exemplar_of(inputs).channels)
    image = yield from finish.apply(plane, progress, "histogram")
    return Output(
        image=image,
        measures={PARAMETERS.id: float(COEFFICIENTS + finish.parameters), LARGEST_POLE.id: model.pole},
        notes=_notes(model.pole, limited),
        details=model.car,
    )


def _notes(pole: float, limited: float) -> tuple[str, ...]:
    notes = []
    if pole >= 1:
        notes.append(f"The recursion is unstable: its largest pole has the modulus {pole:.4f}.")
    if limited:
        notes.append(f"{100 * limited:.2g} % of the values grew without end and were limited.")
    return tuple(notes)


register(
    Method(
        id="car",
        title="CAR",
        summary="Every pixel a weighted sum of 60 earlier ones, plus noise.",
        reference="Navarro & Portilla 1996, section 4, Fig. 7b (causal autoregressive model)",
        params=CarParams,
        analyze=analyze,
        synthesize=synthesize,
        fails_on=(
            "objects, outlines and letters: phase is random",
            "periodic textures with a period longer than five pixels",
            "strictly periodic textures, for which the recursion is unstable",
        ),
        rehearsals=(CarParams(synthesis="recursion"),),
        order=42,
        bytes_per_pixel=23,
        measures=(PARAMETERS.id, LARGEST_POLE.id),
    )
)
