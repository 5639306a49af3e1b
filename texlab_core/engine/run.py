"""Jobs, random streams, and the only loop that drives a method."""

from __future__ import annotations

import importlib.metadata
import platform
import time
from dataclasses import replace
from functools import cache as memoize
from typing import TYPE_CHECKING, Any, Literal

from texlab_core.engine.params import frozen_mapping
from texlab_core.engine.plugins import OWN_PACKAGE
from texlab_core.engine.registry import find_method
from texlab_core.engine.result import Result
from texlab_core.engine.streams import Streams
from texlab_core.errors import Cancelled
from texlab_core.version import __version__
from texlab_core.work.threads import use_workers

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Mapping

    from texlab_core.engine.cache import AnalysisCache
    from texlab_core.engine.job import Job
    from texlab_core.engine.registry import Method
    from texlab_core.engine.steps import Output, Step

# What computes the bits: transforms and sums, compiled kernels and their compiler, scaling and filters.
LIBRARIES = ("numpy", "scipy", "numba", "llvmlite", "opencv-contrib-python-headless")


def run(
    job: Job,
    on_step: Callable[[Step], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
    *,
    cache: AnalysisCache | None = None,
    threads: int | None = None,
) -> Result:
    """Run a job to its end.

    Parameters
    ----------
    job
        What to do.
    on_step
        Called with every step, in this thread. Watching changes no bit of the result.
    should_stop
        Asked between steps.
    cache
        Where analyses are kept and found.
    threads
        Threads within one transform; None means two. No bit of the result depends on it.

    Returns
    -------
    Result
        The output with its job, versions and elapsed time.

    Raises
    ------
    Cancelled
        When ``should_stop`` said so.
    InputError
        When the input turns out to be unusable for this method.
    """
    method = find_method(job.method)
    start = time.perf_counter()
    with use_workers(threads):
        model = model_of(job, on_step, should_stop, cache=cache)
        steps = method.synthesize(model, job.inputs, job.params, job.size, Streams(job.seed))
        output: Output = _drive(steps, "synthesis", on_step, should_stop)
    return Result(
        job=job,
        model=model,
        image=output.image,
        volume=output.volume,
        maps=output.maps,
        curves=output.curves,
        measures=output.measures,
        notes=output.notes,
        details=output.details,
        elapsed_s=time.perf_counter() - start,
        versions=versions_for(method),
    )


def model_of(
    job: Job,
    on_step: Callable[[Step], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
    *,
    cache: AnalysisCache | None = None,
) -> Any:
    """Return the analysis of a job, found in a cache or made and kept there; otherwise like :func:`run`."""
    model = cache.get(job.analysis_key) if cache is not None else None
    if model is None:
        method = find_method(job.method)
        model = _drive(method.analyze(job.inputs, job.params), "analysis", on_step, should_stop)
        if cache is not None:
            cache.put(job.analysis_key, model)
    return model


def _drive(
    steps: Generator[Step, None, Any],
    phase: Literal["analysis", "synthesis"],
    on_step: Callable[[Step], None] | None,
    should_stop: Callable[[], bool] | None,
) -> Any:
    try:
        while True:
            if should_stop is not None and should_stop():
                raise Cancelled
            try:
                step = next(steps)
            except StopIteration as end:
                return end.value
            if on_step is not None:
                on_step(step if step.phase == phase else replace(step, phase=phase))
    finally:
        steps.close()


@memoize
def versions() -> Mapping[str, str]:
    """Return the versions that influence the bits of every method: the program's, Python's, and of libraries."""
    found = {"python": platform.python_version(), "texlab": __version__}
    for name in LIBRARIES:
        found[name] = version_of(name)
    return frozen_mapping(found)


def versions_for(method: Method) -> Mapping[str, str]:
    """Return the versions that influence a method's bits: those of :func:`versions`, and of its own package."""
    if method.package == OWN_PACKAGE:
        return versions()
    return frozen_mapping({**versions(), method.package: version_of(method.package)})


def version_of(name: str) -> str:
    """Return the version of an installed package, "unknown" where there is none."""
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return "unknown"
