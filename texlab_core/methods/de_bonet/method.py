"""De Bonet: sampling every spatial frequency band conditioned on all the coarser ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.registry import Method, register
from texlab_core.methods.de_bonet.params import DeBonetParams

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core.engine.inputs import Inputs
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage, Output, Step
    from texlab_core.engine.streams import Streams
    from texlab_core.methods.de_bonet.analysis import Analysis


def check(inputs: Inputs, params: DeBonetParams, size: tuple[int, int]) -> None:
    """Refuse outputs that are too thin for the pyramid."""
    from texlab_core.methods.de_bonet.growth import check_size

    depth = params.depth(exemplar_of(inputs).size)
    check_size(size, depth)
    if params.pyramid == "steerable":
        from texlab_core.methods.de_bonet.steerable import check_steerable_size

        check_steerable_size(size, depth)


def analyze(inputs: Inputs, params: DeBonetParams) -> Generator[Step, None, Analysis]:
    """Build pyramid and features of the exemplar."""
    return (yield from _analyze(inputs, params, params.depth(exemplar_of(inputs).size)))


def _analyze(inputs: Inputs, params: DeBonetParams, depth: int) -> Generator[Step, None, Analysis]:
    from texlab_core.methods.de_bonet.analysis import analyze_steps
    from texlab_core.methods.de_bonet.growth import analyze_in_steps

    if params.pyramid == "steerable":
        from texlab_core.methods.de_bonet.steerable import analyze_steerable_steps

        oriented = analyze_steerable_steps(
            exemplar_of(inputs).pixels,
            depth=depth,
            orientations=params.bands,
            border=params.border,
            fitting=params.fitting,
            normalization=params.normalization,
            channels=params.channels,
        )
        return (yield from analyze_in_steps(oriented, "pyramid"))
    steps = analyze_steps(
        exemplar_of(inputs).pixels,
        depth=depth,
        border=params.border,
        fitting=params.fitting,
        normalization=params.normalization,
        filters=params.filters,
        orientations=params.orientations,
        filter_size=params.filter_size,
        channels=params.channels,
    )
    return (yield from analyze_in_steps(steps, "features"))


def synthesize(
    model: Analysis, inputs: Inputs, params: DeBonetParams, size: tuple[int, int], streams: Streams
) -> Generator[Step, None, Output]:
    """Sample level by level, growing the picture on the way (SynthesizePyramid)."""
    from texlab_core.engine.steps import Step
    from texlab_core.methods.de_bonet.fitting import even_halvings
    from texlab_core.methods.de_bonet.growth import grow
    from texlab_core.methods.de_bonet.layout import Layout
    from texlab_core.methods.de_bonet.report import report_steps
    from texlab_core.methods.de_bonet.sampling import prepare_steps, sample_steps
    from texlab_core.methods.de_bonet.steerable import SteerableAnalysis, grow_steerable
    from texlab_core.work.tasks import through

    notes: tuple[str, ...] = ()
    if params.tileable and (depth := even_halvings(*size)) < model.depth:
        multiples = f"multiples of {2**model.depth} pixels"
        if params.uneven == "fewer":
            notes = (
                f"So that it tiles, the pyramid has {depth} halvings and not {model.depth}; sides that are "
                f"{multiples} have them all.",
            )
            model = yield from _analyze(inputs, params, depth)
        else:
            notes = (f"The output was cropped and does not tile: its sides must be {multiples}.",)
    depth = model.depth
    literal = {"parity": 0, "literal": depth, "mixed": min(depth, params.literal_levels)}
    thresholds = params.thresholds.matrix(params.alpha, params.beta, depth, model.feature_names)
    preparing = prepare_steps(
        model,
        thresholds,
        size,
        layout=Layout(
            coarsest=params.coarsest,
            patch=params.patch,
            places=params.places,
            periodic=params.tileable,
            # Where no feature may differ, the input comes back.
            anew=bool((thresholds > 0).any()),
        ),
        literal_levels=literal[params.siblings],
        streams=streams,
    )
    sampling = yield from through(preparing, Step(0, 1, "layout"))
    growing: Generator[Step, None, FloatImage]
    if isinstance(model, SteerableAnalysis):
        growing = grow_steerable(
            model,
            sampling.grid,
            sampling.sources,
            sample_steps(sampling),
            size=size,
            after=sampling.grid.count(0),
        )
    else:
        growing = grow(
            model,
            sampling.grid,
            sampling.sources,
            sample_steps(sampling),
            size=size,
            periodic=params.tileable or model.border == "periodic",
            after=sampling.grid.count(0),
        )
    image = yield from growing
    return (yield from report_steps(sampling, size, image, model.notes + notes))


def ask_why(result: Result) -> None:
    """Ask why a pixel is what it is, and which thresholds bind."""
    from texlab_core.methods.de_bonet.binding import binding
    from texlab_core.methods.de_bonet.explain import explain

    explain(result.details.sampling, 0, 0)
    binding(result.details.sampling, 4)


register(
    Method(
        id="de-bonet",
        title="De Bonet",
        summary="Samples every frequency band from the exemplar, conditioned on the features of all coarser ones.",
        reference="J. S. De Bonet, Multiresolution sampling procedure for analysis and synthesis of texture "
        "images, SIGGRAPH 1997",
        params=DeBonetParams,
        analyze=analyze,
        synthesize=synthesize,
        fails_on=(
            "letters and symbols",
            "objects on large flat areas",
            "checkerboards and exact symmetry",
            "gradients of colour or size",
        ),
        check=check,
        # Sets of candidates that are never listed as a whole.
        rehearsals=(DeBonetParams(alpha=4.0),),
        questions=(ask_why,),
        order=20,
        bytes_per_pixel=110,
        measures=("copied-share", "median-candidates", "largest-copy"),
    )
)
