"""Running the cells of a sweep side by side."""

from __future__ import annotations

import contextlib
import dataclasses
import logging
import os
import queue
import threading
from concurrent.futures import ThreadPoolExecutor
from functools import cache as memoize
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, InputError
from texlab_core.measures.registry import measure_all, measure_quick
from texlab_core.measures.subject import PreparedCache, Subject
from texlab_core.sheets.sweep import Cell

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable, Mapping

    from texlab_core.engine.job import Job
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import Step

_POLL_S = 0.01


class Grid(Protocol):
    """Jobs that are run side by side; a :class:`~texlab_core.sheets.sweep.Sweep` is one."""

    @property
    def jobs(self) -> tuple[Job, ...]:
        """What is to be run."""
        ...

    def values(self, index: int) -> Mapping[str, Any]:
        """Return what is varied in one of them, by name."""
        ...


class Places(Protocol):
    """Room that is shared with other work: a cell runs while it holds a place."""

    def acquire(self, should_stop: Callable[[], bool]) -> bool:
        """Wait for a place; False when ``should_stop`` says so first."""
        ...

    def release(self) -> None:
        """Give the place back."""
        ...

    def wake(self) -> None:
        """Make everyone who waits ask ``should_stop`` again."""
        ...


class Outcome(Protocol):
    """What became of a job elsewhere."""

    @property
    def value(self) -> Any:
        """What ``finish`` made of the result; None when it failed."""
        ...

    @property
    def error(self) -> str:
        """Why it failed, one sentence; empty when it did not."""
        ...


class Elsewhere(Protocol):
    """Runs jobs in other processes; :func:`texlab_core.batch.running.run_jobs` at a place is one."""

    def __call__(
        self,
        jobs: Iterable[Job],
        *,
        finish: Callable[[Result], Any],
        should_stop: Callable[[], bool] | None,
    ) -> Generator[tuple[int, Outcome], None, None]:
        """Yield what became of each job, with its number, in the order of finishing."""
        ...


def run_sweep_elsewhere(
    sweep: Grid,
    on_cell: Callable[[Cell], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
    *,
    elsewhere: Elsewhere,
    on_progress: Callable[[float], None] | None = None,
    ids: tuple[str, ...] | None = None,
) -> tuple[Cell, ...]:
    """Run every cell in other processes or on a cluster; bits and cells are those of :func:`run_sweep`.

    Parameters
    ----------
    sweep, on_cell, should_stop, on_progress
        As in :func:`run_sweep`; progress counts whole cells.
    elsewhere
        Runs the jobs.
    ids
        Of the measures that are taken of each result, where it is made; the quick ones when None.

    Raises
    ------
    Cancelled
        When ``should_stop`` said so.
    """
    cells: dict[int, Cell] = {}
    finish = partial(_measured, ids=ids)
    with contextlib.closing(elsewhere(iter(sweep.jobs), finish=finish, should_stop=should_stop)) as outcomes:
        for index, outcome in outcomes:
            make = partial(Cell, index=index, job=sweep.jobs[index], values=sweep.values(index))
            if outcome.error:
                cell = make(error=outcome.error)
            else:
                light, numbers = outcome.value
                cell = make(result=dataclasses.replace(light, job=sweep.jobs[index]), measures=numbers)
            cells[index] = cell
            if on_progress is not None:
                on_progress(len(cells) / len(sweep.jobs))
            if on_cell is not None:
                on_cell(cell)
    return tuple(cells[index] for index in sorted(cells))


def _measured(result: Result, *, ids: tuple[str, ...] | None) -> tuple[Result, dict[str, float]]:
    """Return a result as it travels, and the numbers about it."""
    subject = Subject.of_result(result, _prepared())
    numbers = measure_quick(subject) if ids is None else measure_all(subject, ids)
    # The job stays where it was made: its inputs are large.
    return dataclasses.replace(_light(result), job=None), numbers  # type: ignore[arg-type]


@memoize
def _prepared() -> PreparedCache:
    """Return what this process has prepared of the last exemplars for measuring."""
    return PreparedCache(exemplars=2)


def _light(result: Result) -> Result:
    return dataclasses.replace(result, volume=None, model=None, maps={}, details=None)


def run_sweep(
    sweep: Grid,
    on_cell: Callable[[Cell], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
    *,
    on_progress: Callable[[float], None] | None = None,
    cache: AnalysisCache | None = None,
    workers: int | None = None,
    places: Places | None = None,
    prepared: PreparedCache | None = None,
    measure: Callable[[Subject], dict[str, float]] | None = None,
) -> tuple[Cell, ...]:
    """Run every cell, as many side by side as there are cores.

    No bit of a cell depends on the others, on their order or on the number of workers. Cells that share an
    analysis make it once. A cell that fails keeps its sentence, the others go on.

    Parameters
    ----------
    sweep
        The grid.
    on_cell
        Called with each cell as it finishes, in this thread, in the order of finishing.
    should_stop
        Asked in this thread about a hundred times a second.
    on_progress
        Called in this thread with the share done, 0 .. 1, never falling.
    cache
        Where analyses are kept and found; a new one when None.
    workers
        Threads; None means one for each core.
    places
        Where each cell takes a place while it runs; None means that there is room.
    prepared
        Where the exemplar's part of the measures is kept and found; a new one when None.
    measure
        Says the numbers about each result; the quick ones when None.

    Returns
    -------
    tuple of Cell
        In the order of the grid.

    Raises
    ------
    Cancelled
        When ``should_stop`` said so; every thread has ended then.
    """
    state = _State(
        sweep,
        AnalysisCache() if cache is None else cache,
        PreparedCache() if prepared is None else prepared,
        measure_quick if measure is None else measure,
        places,
    )
    count = max(1, min(len(sweep.jobs), (os.cpu_count() or 1) if workers is None else workers))
    cells: dict[int, Cell] = {}
    with ThreadPoolExecutor(count, thread_name_prefix="sweep") as pool:
        try:
            # A lone worker's transforms may use their usual threads; a place is one core.
            threads = None if count == 1 and places is None else 1
            for index in range(len(sweep.jobs)):
                pool.submit(state.run_cell, index, threads)
            while len(cells) < len(sweep.jobs):
                if should_stop is not None and should_stop():
                    raise Cancelled
                try:
                    outcome = state.finished.get(timeout=_POLL_S)
                except queue.Empty:
                    outcome = None
                if on_progress is not None:
                    on_progress(float(state.fractions.mean()))
                if outcome is not None:
                    cells[outcome.index] = outcome
                    if on_cell is not None:
                        on_cell(outcome)
        finally:
            state.stop.set()
            if places is not None:
                places.wake()
            pool.shutdown(wait=True, cancel_futures=True)
    return tuple(cells[index] for index in sorted(cells))


class _State:
    """What the threads of one sweep share."""

    def __init__(
        self,
        sweep: Grid,
        cache: AnalysisCache,
        prepared: PreparedCache,
        measure: Callable[[Subject], dict[str, float]],
        places: Places | None,
    ) -> None:
        self.sweep = sweep
        self.cache = cache
        self.prepared = prepared
        self.measure = measure
        self.places = places
        self.stop = threading.Event()
        self.finished: queue.SimpleQueue[Cell] = queue.SimpleQueue()
        self.fractions = np.zeros(len(sweep.jobs))
        self._locks: dict[tuple[object, ...], threading.Lock] = {}
        self._guard = threading.Lock()

    def run_cell(self, index: int, threads: int | None) -> None:
        if self.places is None:
            self._run_cell(index, threads)
        elif self.places.acquire(self.stop.is_set):
            try:
                self._run_cell(index, threads)
            finally:
                self.places.release()

    def _run_cell(self, index: int, threads: int | None) -> None:
        make = partial(Cell, index=index, job=self.sweep.jobs[index], values=self.sweep.values(index))
        try:
            cell = make(**self._run(index, threads))
        except Cancelled:
            return
        except InputError as error:
            cell = make(error=str(error))
        except MemoryError:
            cell = make(error="There is not enough memory for this; try a smaller size.")
        except Exception as error:
            logging.getLogger(__name__).exception("A cell of a sweep failed")
            cell = make(error=f"Something unexpected happened ({type(error).__name__}: {error}).")
        self.fractions[index] = 1.0
        self.finished.put(cell)

    def _run(self, index: int, threads: int | None) -> dict[str, Any]:
        job = self.sweep.jobs[index]
        turn = _Turn(self._lock_of(job), self.stop)

        def watch(step: Step) -> None:
            if step.phase == "synthesis":
                turn.give_back()
            share = 0.1 * step.fraction if step.phase == "analysis" else 0.1 + 0.89 * step.fraction
            self.fractions[index] = max(self.fractions[index], share)

        try:
            if self.cache.get(job.analysis_key) is None:
                turn.take()
            result = run(job, watch, self.stop.is_set, cache=self.cache, threads=threads)
        finally:
            turn.give_back()
        found = self.measure(Subject.of_result(result, self.prepared, self.stop.is_set))
        return {"result": _light(result), "measures": found}

    def _lock_of(self, job: Job) -> threading.Lock:
        with self._guard:
            return self._locks.setdefault(job.analysis_key, threading.Lock())


class _Turn:
    """A lock that is waited for in short naps, and given back once."""

    def __init__(self, lock: threading.Lock, stop: threading.Event) -> None:
        self._lock = lock
        self._stop = stop
        self._held = False

    def take(self) -> None:
        while not self._held:
            if self._stop.is_set():
                raise Cancelled
            self._held = self._lock.acquire(timeout=_POLL_S)

    def give_back(self) -> None:
        if self._held:
            self._held = False
            self._lock.release()
