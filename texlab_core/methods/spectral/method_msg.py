"""MSG: a texture as 69 numbers, most of them energies and bandwidths of 16 Gabor channels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Literal

from texlab_core.engine.inputs import DataInput, ImageInput
from texlab_core.engine.params import Knob, Params
from texlab_core.engine.progress import Progress
from texlab_core.engine.registry import InputSpec, Method, register
from texlab_core.engine.steps import Output
from texlab_core.errors import InputError, ParamError
from texlab_core.methods.spectral.choices import (
    BandwidthAxes,
    BandwidthMeasure,
    Equations,
    HistogramChoice,
    PhaseChoice,
)
from texlab_core.methods.spectral.encoding import HISTOGRAM, Finish, encode, gray_of
from texlab_core.methods.spectral.told import ENERGY_ERROR, PARAMETERS

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.steps import Curve, Step
    from texlab_core.engine.streams import Streams
    from texlab_core.methods.spectral.code import MsgCode
    from texlab_core.methods.spectral.fourier import Floats
    from texlab_core.methods.spectral.synthesis import Design


@dataclass(frozen=True, kw_only=True)
class MsgParams(Params):
    """Parameters of the multiscale Gabor scheme."""

    bandwidths: Annotated[
        BandwidthMeasure,
        Knob(
            "How the equivalent bandwidth of a channel is measured (of an exemplar; a code has its own).",
            choices={
                "participation": "(sum P)² / (√2 sum P²): not biased by a noisy maximum",
                "paper": "sum over maximum: too narrow, gives a woven look",
            },
            stage="analysis",
            source="Navarro & Portilla 1996, eq. 4",
            group="Analysis",
        ),
    ] = "participation"
    bandwidth_axes: Annotated[
        BandwidthAxes,
        Knob(
            "Along which axes bandwidths are measured (of an exemplar; a code has its own).",
            choices={
                "uv": "horizontal and vertical frequency, as in the paper",
                "radial": "along and across the waves of each channel, as its footnote suggests",
            },
            stage="analysis",
            source="Navarro & Portilla 1996, section 3.1.2, footnote",
            formerly="uv",
            group="Analysis",
        ),
    ] = "uv"
    colours: Annotated[
        Literal["keep", "gray"],
        Knob(
            "What becomes of colours (of an exemplar; a code has its own).",
            choices={
                "keep": "44 numbers beyond the paper's 69: mean colour 3, axes of the colours 9, two curves of 16",
                "gray": "none: the exemplar's luma in the paper's 69 numbers",
            },
            stage="analysis",
            formerly="keep",
            group="Analysis",
        ),
    ] = "keep"
    phase: Annotated[
        PhaseChoice,
        Knob(
            "Where the randomness comes from.",
            choices={
                "one": "one random phase with the summed power of all channels: exact energies",
                "sixteen": "an independent noise for each channel, as in the paper",
            },
            source="Navarro & Portilla 1996, section 3.2",
            group="Synthesis",
        ),
    ] = "one"
    histogram: Annotated[HistogramChoice, HISTOGRAM] = "coded"
    bandwidth_levels: Annotated[
        int,
        Knob(
            "Quantize every bandwidth to this many levels, 2 to 16; 0 keeps them as they are.",
            0,
            16,
            source="Navarro & Portilla 1996, section 4 (five levels)",
            group="Synthesis",
        ),
    ] = 0
    equations: Annotated[
        Equations,
        Knob(
            "Corrected equations, or those that were printed.",
            choices={
                "corrected": "1/b² = 1/(2A²) - 1/a², and overlaps summed on the output's grid",
                "printed": "b² = 2A² - a², which is negative nearly always; shows what goes wrong",
            },
            source="Navarro & Portilla 1996, eqs. 6 and 10",
            group="Synthesis",
        ),
    ] = "corrected"

    def check(self) -> None:
        """Refuse one level: it would say nothing."""
        if self.bandwidth_levels == 1:
            raise ParamError("bandwidth_levels", "0 or a whole number from 2 to 16", 1)


@dataclass(frozen=True, eq=False)
class MsgModel:
    """What MSG synthesizes from: the code, and the uncoded histogram if there was an exemplar."""

    code: MsgCode
    masses: Floats | None
    channels: int


@dataclass(frozen=True, eq=False)
class MsgDetails:
    """What the views of MSG show: the code that was used, and the synthetic channels made from it."""

    code: MsgCode
    design: Design


def check(inputs: Inputs, params: MsgParams, size: tuple[int, int]) -> None:
    """Refuse jobs that have nothing to synthesize from, and codes that are malformed."""
    given = inputs.get("code")
    if isinstance(given, DataInput):
        from texlab_core.methods.spectral.codefile import code_from_json

        axes = code_from_json(given.data, what=f"the code {given.name}").code.axes
    elif "exemplar" not in inputs:
        raise InputError("MSG needs an exemplar or a code of numbers, and neither was given.")
    else:
        axes = params.bandwidth_axes
    if axes == "radial" and params.equations == "printed":
        raise ParamError("equations", "corrected where bandwidths are radial and angular", params.equations)
    if params.histogram == "full" and "exemplar" not in inputs:
        raise InputError(
            "histogram: must be coded when there is no exemplar, since a code holds no full histogram."
        )


def analyze(inputs: Inputs, params: MsgParams) -> Generator[Step, None, MsgModel]:
    """Measure the code of the exemplar; a code that is given is taken as it is."""
    given, exemplar = inputs.get("code"), inputs.get("exemplar")
    masses = None
    if isinstance(exemplar, ImageInput):
        pixels = gray_of(exemplar.pixels) if params.colours == "gray" else exemplar.pixels
        code, masses = yield from encode(pixels, params.bandwidths, params.bandwidth_axes)
        channels = exemplar.channels
    if isinstance(given, DataInput):
        from texlab_core.methods.spectral.codefile import code_from_json

        code = code_from_json(given.data).code
        channels = code.tone.channels
    return MsgModel(code, masses, channels)


def synthesize(
    model: MsgModel, inputs: Inputs, params: MsgParams, size: tuple[int, int], streams: Streams
) -> Generator[Step, None, Output]:
    """Make a texture from the numbers alone."""
    from texlab_core.methods.spectral.synthesis import design, design_radial, synthesize_plane

    noise = 4 if params.phase == "one" else 40
    code = model.code.quantized(params.bandwidth_levels) if params.bandwidth_levels else model.code
    summed = {"overlaps": 20} if code.axes == "radial" else {}
    progress = Progress({**summed, "phase": noise, "channels": 2, "transform": 4, "histogram": 4})
    if code.axes == "radial":
        plan = yield from progress.follow(design_radial(code, size), "overlaps")
    else:
        plan = design(code, size, params.equations)
    yield progress.at("phase", 0.0)
    plane = yield from synthesize_plane(code, plan, size, streams, params.phase, progress)
    finish = Finish.choose(code.tone, model.masses, params.histogram, model.channels)
    image = yield from finish.apply(plane, progress, "histogram")
    return Output(
        image=image,
        curves=_curves(code, model.masses),
        measures={
            PARAMETERS.id: float(code.parameters - code.tone.parameters + finish.parameters),
            ENERGY_ERROR.id: plan.error,
        },
        notes=_notes(code, plan),
        details=MsgDetails(code, plan),
    )


def _curves(code: MsgCode, masses: Floats | None) -> dict[str, Curve]:
    from texlab_core.engine.steps import Curve

    curves = {"histogram-coded": Curve.of(code.tone.histogram.masses(), "Coded histogram", x_label="gray level")}
    if masses is not None:
        curves["histogram-exemplar"] = Curve.of(masses, "Histogram of the exemplar", x_label="gray level")
    return curves


def _notes(code: MsgCode, plan: Design) -> tuple[str, ...]:
    notes = []
    if plan.imaginary:
        notes.append(f"{plan.imaginary} of the 32 bandwidths of eq. 6 as printed are imaginary and were set to 0.")
    if plan.clipped:
        notes.append(
            "Some channels would need negative energy; the nearest ones without miss the code by "
            f"{100 * plan.error:.2g} %."
        )
    if code.tone.colours is not None:
        notes.append(
            "The colours follow the first principal component, with 44 numbers beyond the paper's 69: mean colour "
            "3, axes of the colours 9, two curves of 16."
        )
    return tuple(notes)


def read_code_input(path: Path) -> DataInput:
    """Read a file as the input ``code``, checked."""
    from texlab_core.methods.spectral.codefile import load_code_input

    return load_code_input(path)


register(
    Method(
        id="msg",
        title="MSG",
        summary="A texture in 69 numbers (44 more for colours), from which any amount of it is made.",
        reference="Navarro & Portilla 1996, Robust method for texture synthesis-by-analysis based on a multiscale "
        "Gabor scheme",
        params=MsgParams,
        analyze=analyze,
        synthesize=synthesize,
        fails_on=(
            "objects, outlines and letters: phase is random",
            "periodic textures between the filters' centres: peaks move by up to half an octave or 22.5 degrees",
            "details finer than three pixels",
        ),
        inputs=(
            InputSpec("exemplar", "The texture to measure.", required=False),
            InputSpec(
                "code",
                "A code of numbers, instead of an exemplar.",
                kind="data",
                required=False,
                read=read_code_input,
            ),
        ),
        check=check,
        order=40,
        bytes_per_pixel=35,
        measures=(PARAMETERS.id, ENERGY_ERROR.id),
    )
)
