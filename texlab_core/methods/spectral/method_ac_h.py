"""AC-H: the centre of the autocorrelation and the histogram, one of the yardsticks of MSG."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.params import Params
from texlab_core.engine.progress import Progress
from texlab_core.engine.registry import Method, register
from texlab_core.engine.steps import Output
from texlab_core.methods.spectral import told
from texlab_core.methods.spectral.choices import HistogramChoice
from texlab_core.methods.spectral.encoding import HISTOGRAM, Finish

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import Step
    from texlab_core.engine.streams import Streams
    from texlab_core.methods.spectral.acf import Acf
    from texlab_core.methods.spectral.fourier import Floats
    from texlab_core.methods.spectral.tone import Tone


@dataclass(frozen=True, kw_only=True)
class AcHParams(Params):
    """Parameters of the autocorrelation model."""

    histogram: Annotated[HistogramChoice, HISTOGRAM] = "coded"


@dataclass(frozen=True, eq=False)
class AcHModel:
    """The autocorrelation's centre and the tone of the exemplar."""

    acf: Acf
    tone: Tone
    masses: Floats


def analyze(inputs: Inputs, params: AcHParams) -> Generator[Step, None, AcHModel]:
    """Measure 60 samples of the autocorrelation and the variance."""
    from texlab_core.methods.spectral.acf import measure
    from texlab_core.methods.spectral.tone import split_tone

    progress = Progress({"colours and histogram": 1, "transform": 2, "autocorrelation": 2})
    plane, tone, masses = yield from split_tone(exemplar_of(inputs).pixels, progress, "colours and histogram")
    acf = yield from measure(plane, progress, "transform", "autocorrelation")
    return AcHModel(acf, tone, masses)


def synthesize(
    model: AcHModel, inputs: Inputs, params: AcHParams, size: tuple[int, int], streams: Streams
) -> Generator[Step, None, Output]:
    """Give the spectrum of the samples a random phase, then the histogram."""
    from texlab_core.methods.spectral.acf import PARAMETERS, shape_noise
    from texlab_core.methods.spectral.fourier import inverse, random_phase

    progress = Progress({"phase": 1, "spectrum": 2, "transform": 1, "histogram": 1})
    half = yield from random_phase(size, streams, progress, "phase")
    clipped = yield from shape_noise(half, model.acf, size, progress, "spectrum")
    plane = yield from inverse(half, size, progress, "transform")
    finish = Finish.choose(model.tone, model.masses, params.histogram, exemplar_of(inputs).channels)
    image = yield from finish.apply(plane, progress, "histogram")
    return Output(
        image=image,
        measures={told.PARAMETERS.id: float(PARAMETERS + finish.parameters), told.NEGATIVE_POWER.id: clipped},
        notes=(f"{100 * clipped:.2g} % of the spectrum was negative and was clipped.",) if clipped else (),
        details=model.acf,
    )


register(
    Method(
        id="ac-h",
        title="AC-H",
        summary="The 11 x 11 centre of the autocorrelation, and the histogram.",
        reference="Navarro & Portilla 1996, section 4, Fig. 7a (autocorrelation and histogram model)",
        params=AcHParams,
        analyze=analyze,
        synthesize=synthesize,
        fails_on=(
            "objects, outlines and letters: phase is random",
            "anything that repeats at more than five pixels",
        ),
        order=43,
        bytes_per_pixel=23,
        measures=(told.PARAMETERS.id, told.NEGATIVE_POWER.id),
    )
)
