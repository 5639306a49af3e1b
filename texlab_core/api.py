"""Texture synthesis in one line, or in a series."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method, methods
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.named_input import inputs_of
from texlab_core.progress import progress_bar
from texlab_core.series import Series

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from texlab_core.engine.inputs import Input
    from texlab_core.engine.registry import Method
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import Step
    from texlab_core.images.exemplar import Source


def synthesize(
    image: Source,
    method: str = "heeger-bergen",
    *,
    size: tuple[int, ...] | None = None,
    seed: int = 0,
    inputs: Mapping[str, Source | Input | Mapping[str, Any]] | None = None,
    on_step: Callable[[Step], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
    progress: bool = False,
    **params: object,
) -> Result:
    """Make more of a texture.

    Parameters
    ----------
    image
        The exemplar: an array (H, W) or (H, W, C) of any type of numbers (see ``as_exemplar``), a file,
        ``gallery:NAME``, or what ``as_exemplar`` returned.
    method
        Id of a registered method.
    size
        Height and width of the result, or depth, height and width for a solid; None takes the exemplar's.
    seed
        0 .. 2147483647; the same seed gives the same bits.
    inputs
        Further named inputs, for methods that take some: an image in any of the forms of ``image``, a file, or
        what :mod:`texlab_core.engine.inputs` makes.
    on_step
        Called with every step while it runs.
    should_stop
        Asked between steps; True stops the run.
    progress
        Show a progress bar, in a notebook or on a terminal.
    **params
        Parameters of the method, by name; those left out take their defaults.

    Returns
    -------
    Result
        ``image`` is (H, W, C) float32 in [0, 1], ``volume`` (D, H, W, C) for a solid; maps, curves and measures
        explain it.

    Raises
    ------
    InputError
        When the image, the method or a parameter cannot be used; the sentence says why.
    Cancelled
        When ``should_stop`` said so.

    Examples
    --------
    >>> from texlab_core import synthesize
    >>> result = synthesize("gallery:structured-pebbles", "tiling", size=(64, 96), seed=1)
    >>> result.image.shape
    (64, 96, 3)
    """
    chosen = find_method(method)
    job = Job(
        method=method,
        inputs={**inputs_of([chosen], inputs or {}), "exemplar": as_exemplar(image)},
        params=chosen.params.from_json(params),
        size=size,  # type: ignore[arg-type]  # None takes the exemplar's
        seed=seed,
    )
    if not progress:
        return run(job, on_step, should_stop)
    with progress_bar(chosen.title) as show:

        def both(step: Step) -> None:
            show(step)
            if on_step is not None:
                on_step(step)

        return run(job, both, should_stop)


def sweep(
    image: Source,
    method: str = "heeger-bergen",
    *,
    vary: Mapping[str, Sequence[object]],
    size: tuple[int, ...] | None = None,
    seed: int = 0,
    inputs: Mapping[str, Source | Input | Mapping[str, Any]] | None = None,
    on_step: Callable[[Step], None] | None = None,
    **params: object,
) -> Series:
    """Vary parameters; every result is made when it is asked for.

    Parameters
    ----------
    image, method, size, seed, inputs, on_step, **params
        As for :func:`synthesize`.
    vary
        The values of each parameter (or of ``seed``), by name. All combinations are taken; the first one changes
        fastest.

    Returns
    -------
    Series
        Every job is checked already; nothing has run yet.

    Raises
    ------
    InputError
        When an image, a method or a value cannot be used.

    Examples
    --------
    >>> from texlab_core import sweep
    >>> series = sweep("gallery:structured-pebbles", "tiling", vary={"seed": [1, 2, 3]}, size=(32, 32))
    >>> len(series)
    3
    >>> series[1].job.seed
    2
    """
    from texlab_core.sheets.sweep import Vary

    chosen = find_method(method)
    exemplar = as_exemplar(image)
    base = chosen.params.from_json(params)
    further = inputs_of([chosen], inputs or {})
    axes = [Vary.of(name, list(values), chosen.params) for name, values in vary.items()]
    if not axes:
        raise InputError("vary: must name at least one parameter and its values.")
    jobs: list[Job] = []
    changes: list[dict[str, Any]] = []
    # product changes the last one fastest.
    for values in itertools.product(*(axis.values for axis in reversed(axes))):
        change = {axis.name: value for axis, value in zip(axes, reversed(values), strict=True)}
        knobs = {name: value for name, value in change.items() if name != "seed"}
        jobs.append(
            Job(
                method=method,
                inputs={**further, "exemplar": exemplar},
                params=base.replace(**knobs),
                size=size,  # type: ignore[arg-type]  # None takes the exemplar's
                seed=change.get("seed", seed),
            )
        )
        changes.append(change)
    return Series(jobs, changes, on_step=on_step)


def compare(
    image: Source,
    methods: Sequence[str] | None = None,
    *,
    size: tuple[int, int] | None = None,
    seed: int = 0,
    same_phase: bool = False,
    inputs: Mapping[str, Source | Input | Mapping[str, Any]] | None = None,
    on_step: Callable[[Step], None] | None = None,
) -> Series:
    """Run several methods on one exemplar; every result is made when it is asked for.

    Parameters
    ----------
    image, size, on_step
        As for :func:`synthesize`.
    methods
        Ids; None takes the four papers' own.
    seed
        Of the first method; each other one takes the next.
    same_phase
        All take the same seed, which gives the spectral methods the same random phase.
    inputs
        Further inputs by name, as for :func:`synthesize`; every method takes those that it knows.

    Returns
    -------
    Series
        Every job is checked already; nothing has run yet.

    Raises
    ------
    InputError
        When the image or a method cannot be used.
    """
    from texlab_core.sheets.comparison import FIRST_SIGHT, plan

    exemplar = as_exemplar(image)
    names = FIRST_SIGHT if methods is None else methods
    further = None if inputs is None else inputs_of([find_method(each) for each in names], inputs)
    jobs = plan(exemplar, names, size=size, seed=seed, same_phase=same_phase, inputs=further)
    return Series(jobs, [{"method": job.method, "seed": job.seed} for job in jobs], on_step=on_step)


def available_methods() -> Mapping[str, Method]:
    """Return every registered method by id, in their order."""
    return methods()
