"""Several methods on one exemplar, side by side: pictures, parameter counts and distances between spectra.

Reference: Navarro & Portilla 1996, Fig. 8.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from threading import Event, Lock
from typing import TYPE_CHECKING

from texlab_core.engine.job import MAX_SEED, Job, check_seed
from texlab_core.engine.registry import find_method, methods
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, InputError, ParamError
from texlab_core.measures.registry import measure_all, written
from texlab_core.measures.subject import PreparedCache, Subject
from texlab_core.sheets.contact_sheet import LARGEST_CELL, Tile, contact_sheet, series_columns

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    import numpy as np
    from numpy.typing import NDArray

    from texlab_core.engine.inputs import ImageInput, Input
    from texlab_core.engine.params import Params
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import Step

# The paper's Fig. 8, and the four papers' own methods.
FIG_8 = ("uncoded", "msg", "car", "ac-h")
# What is said under a result, line by line.
SHEET_MEASURES = (("discriminability", "visual-difference"), ("spectral-distance", "spectral-variation"))
FIRST_SIGHT = ("heeger-bergen", "de-bonet", "msg", "efros-leung")


@dataclass(frozen=True, eq=False)
class Compared:
    """One method's result beside the exemplar.

    Parameters
    ----------
    job
        What was done.
    result
        None when it failed.
    measures
        Numbers about the result, by id.
    error
        Why it failed, one sentence.
    """

    job: Job
    result: Result | None
    measures: Mapping[str, float] = field(default_factory=dict)
    error: str = ""

    @property
    def parameters(self) -> int | None:
        """How many numbers the method keeps of the exemplar; None when it keeps the exemplar itself."""
        count = self.measures.get("parameters")
        return None if count is None else int(count)

    def caption(self) -> tuple[str, ...]:
        """Return the title, the number of parameters, and the measures of a comparison as lines of text."""
        title = find_method(self.job.method).title
        if self.result is None:
            return (title,)
        count = "" if self.parameters is None else f"{self.parameters} numbers"
        lines = (", ".join(written(self.measures, ids)) for ids in SHEET_MEASURES)
        return tuple(filter(None, (title, count, *lines)))


def plan(
    exemplar: ImageInput,
    names: Sequence[str],
    *,
    size: tuple[int, int] | None = None,
    seed: int = 0,
    same_phase: bool = False,
    params: Mapping[str, Params] | None = None,
    inputs: Mapping[str, Input] | None = None,
) -> tuple[Job, ...]:
    """Return one job for each method, all checked.

    Parameters
    ----------
    exemplar
        The texture.
    names
        Ids of methods; one may come more than once.
    size
        Height and width of the results, and a solid is as deep as its shorter side; None takes the exemplar's, and
        for a solid a cube.
    seed
        Of the first method.
    same_phase
        All take the same seed, which gives the spectral methods the same random phase; else each one takes the
        next seed.
    params
        Parameters by method; those left out take their defaults.
    inputs
        Further inputs by name; every method takes those that it knows.

    Raises
    ------
    InputError
        When there is no method, one is unknown, none takes an input, or a job cannot work.
    """
    if not names:
        raise InputError(f"methods: must name at least one of {', '.join(methods())}.")
    first = check_seed(seed)
    known = {name: {spec.name for spec in find_method(name).inputs} for name in names}
    for role in inputs or {}:
        if role == "exemplar" or not any(role in roles for roles in known.values()):
            others = sorted(set().union(*known.values()) - {"exemplar"})
            allowed = f"a further input of a compared method ({', '.join(others) or 'they take none'})"
            raise ParamError("input", allowed, role)
    return tuple(
        Job(
            method=name,
            inputs={role: each for role, each in (inputs or {}).items() if role in known[name]}
            | {"exemplar": exemplar},
            params=(params or {}).get(name),  # type: ignore[arg-type]  # None takes the defaults
            size=_size_for(name, size),  # type: ignore[arg-type]  # None takes the default
            seed=first if same_phase else (first + index) % (MAX_SEED + 1),
        )
        for index, name in enumerate(names)
    )


def _size_for(name: str, size: tuple[int, int] | None) -> tuple[int, ...] | None:
    return size if size is None or find_method(name).dimensions == 2 else (min(size), *size)


def compare(
    jobs: Sequence[Job],
    *,
    on_progress: Callable[[float], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> tuple[Compared, ...]:
    """Run jobs, as many at a time as there are cores, and measure what comes of them.

    Parameters
    ----------
    jobs
        From :func:`plan`.
    on_progress
        Called with the share that is done, from several threads in turn.
    should_stop
        Asked between steps.

    Returns
    -------
    tuple
        In the order of the jobs; those that failed hold an error.

    Raises
    ------
    Cancelled
        When ``should_stop`` said so.
    """
    if not jobs:
        return ()
    shares = [0.0] * len(jobs)
    lock, stop = Lock(), Event()
    prepared = PreparedCache()

    def stopped() -> bool:
        return stop.is_set() or (should_stop is not None and should_stop())

    def one(index: int) -> Compared:
        job = jobs[index]

        def watch(step: Step) -> None:
            with lock:
                # Progress of the analysis is not counted: it is a small part of every method.
                shares[index] = max(shares[index], step.fraction if step.phase == "synthesis" else 0.0)
                if on_progress is not None:
                    on_progress(sum(shares) / len(shares))

        try:
            result = run(job, watch, stopped, threads=1)
        except InputError as error:
            return Compared(job, None, error=str(error))
        return Compared(job, result, measure_all(Subject.of_result(result, prepared, stopped)))

    with ThreadPoolExecutor(min(len(jobs), os.cpu_count() or 1)) as pool:
        try:
            return tuple(pool.map(one, range(len(jobs))))
        except BaseException as error:
            stop.set()
            if stopped() and should_stop is not None and should_stop():
                raise Cancelled from error
            raise


def comparison_sheet(
    exemplar: ImageInput,
    compared: Sequence[Compared],
    *,
    columns: int | None = None,
    largest: int = LARGEST_CELL,
) -> NDArray[np.uint8]:
    """Draw the exemplar and the results beside it, each with its caption.

    Parameters
    ----------
    exemplar
        Drawn first.
    compared
        From :func:`compare`.
    columns
        Pictures in a row; one row up to six when None.
    largest
        Longest side at which a picture is shown.

    Returns
    -------
    uint8 array
        (H, W, 3).
    """
    tiles = comparison_tiles(exemplar, compared)
    return contact_sheet(tiles, columns or series_columns(len(tiles)), largest=largest)


def comparison_tiles(exemplar: ImageInput, compared: Sequence[Compared]) -> list[Tile]:
    """Return the pictures of a comparison with their captions, the exemplar first."""
    height, width = exemplar.size
    tiles = [Tile(exemplar.pixels, ("Exemplar", exemplar.name, f"{width} x {height}"))]
    tiles += [
        Tile(None if each.result is None else each.result.image, each.caption(), each.error) for each in compared
    ]
    return tiles
