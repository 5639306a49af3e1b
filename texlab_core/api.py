"""Texture synthesis in one line."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method, methods
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from texlab_core.engine.inputs import Input
    from texlab_core.engine.registry import Method
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import Step
    from texlab_core.images.exemplar import Source


def synthesize(
    image: Source,
    method: str = "heeger-bergen",
    *,
    size: tuple[int, int] | None = None,
    seed: int = 0,
    inputs: Mapping[str, Input] | None = None,
    on_step: Callable[[Step], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
    **params: object,
) -> Result:
    """Make more of a texture.

    Parameters
    ----------
    image
        The exemplar: an array (H, W) or (H, W, C), a file, ``gallery:NAME``, or what ``as_exemplar`` returned.
    method
        Id of a registered method.
    size
        Height and width of the result; None takes the exemplar's.
    seed
        0 .. 2147483647; the same seed gives the same bits.
    inputs
        Further named inputs, for methods that take some.
    on_step
        Called with every step while it runs.
    should_stop
        Asked between steps; True stops the run.
    **params
        Parameters of the method, by name; those left out take their defaults.

    Returns
    -------
    Result
        ``image`` is (H, W, C) float32 in [0, 1]; maps, curves and measures explain it.

    Raises
    ------
    InputError
        When the image, the method or a parameter cannot be used; the sentence says why.
    Cancelled
        When ``should_stop`` said so.
    """
    chosen = find_method(method)
    job = Job(
        method=method,
        inputs={**(inputs or {}), "exemplar": as_exemplar(image)},
        params=chosen.params.from_json(params),
        size=size,  # type: ignore[arg-type]  # None takes the exemplar's
        seed=seed,
    )
    return run(job, on_step, should_stop)


def available_methods() -> Mapping[str, Method]:
    """Return every registered method by id, in their order."""
    return methods()
