"""The newest search for parameters at work: its run in a worker's thread, and what there is to see of it."""

from __future__ import annotations

import dataclasses
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from texlab.runs.column_run import TaskLike, job_of
from texlab.runs.kept_points import small
from texlab.runs.worker import Worker
from texlab.state.sweeps import ShownCell
from texlab.state.tuning import TuningScene
from texlab_core.errors import InputError
from texlab_core.sheets.tuning import Trial, Tuning, tune
from texlab_core.warming import Need

if TYPE_CHECKING:
    from texlab.runs.slots import Slots
    from texlab.state.session import State
    from texlab.state.tuning import TuningPlan
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.job import Job
    from texlab_core.sheets.sweep import Cell
    from texlab_core.sheets.sweep_running import Places
    from texlab_core.warming import Warmth


@dataclass(frozen=True, eq=False)
class TuningProgress:
    """All trials that have finished so far, the share of the budget used, and what was found at the end."""

    trials: tuple[ShownCell, ...]
    fraction: float
    found: Tuning | None = None


@dataclass
class TuningRun:
    """A request for a worker: searches, each trial on a place of its own, and leaves one core to the columns."""

    base: Job
    plan: TuningPlan
    places: Places

    def __call__(self, task: TaskLike) -> TuningProgress:
        """Search to the end, reporting every trial."""
        made: list[ShownCell] = []
        fraction = 0.0

        def show(trial: Trial, cell: Cell | None) -> None:
            if cell is None or cell.result is None:
                return
            # Hundreds of them stay for the whole session: small pictures and numbers, no results.
            made.append(ShownCell(dataclasses.replace(cell, values={}, result=None), small(cell.result.image)))
            task.progress(TuningProgress(tuple(made), fraction))

        def advance(share: float) -> None:
            nonlocal fraction
            fraction = share
            if task.due():
                task.progress(TuningProgress(tuple(made), share))

        found = tune(
            self.base,
            self.plan.knobs,
            limit=self.plan.limit,
            budget=self.plan.budget,
            on_trial=show,
            on_progress=advance,
            should_stop=task.should_stop,
            workers=max(1, (os.cpu_count() or 1) - 1),
            places=self.places,
        )
        return TuningProgress(tuple(made), 1.0, found)


class TuningRunner(QObject):
    """Runs one search, the newest instead of any other; ``changed()`` tells that ``scene`` is another one."""

    changed = Signal()

    def __init__(self, slots: Slots, warmth: Warmth, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.scene = TuningScene()
        self._slots = slots
        self._warmth = warmth
        # Most sessions have no search, and need no thread for it.
        self._worker: Worker | None = None

    def start(self, plan: TuningPlan, state: State, column_id: int, exemplar: ImageInput | None) -> None:
        """Search for a column's method; what cannot be run is said in ``scene.problem``, and what runs goes on."""
        column = state.column(column_id)
        if column is None or exemplar is None:
            self._show(problem="There is no exemplar yet.")
            return
        try:
            base = job_of(column, state, exemplar)
        except InputError as error:
            self._show(problem=str(error))
            return
        self.scene = TuningScene(self.scene.number + 1, "", plan, column_id, "running")
        if self._worker is None:
            self._worker = self._make_worker()
        need, warmth = Need(column.method, exemplar.channels), self._warmth
        self._worker.submit(
            TuningRun(base, plan, self._slots), first=lambda task: warmth.wait(need, task.should_stop)
        )
        self.changed.emit()

    def stop(self) -> None:
        """Stop; the points stay."""
        if self._worker is not None:
            self._worker.cancel()

    def leave(self) -> None:
        """Ask the thread to end, without waiting."""
        if self._worker is not None:
            self._worker.leave()

    def close(self) -> None:
        """Stop the thread and wait for its end."""
        if self._worker is not None:
            self._worker.close()

    def _make_worker(self) -> Worker:
        worker = Worker("tuning", parent=self)
        worker.progressed.connect(self._progressed)
        worker.finished.connect(lambda report: self._progressed(report, status="finished"))
        worker.failed.connect(lambda sentence: self._show(status="failed", problem=sentence))
        worker.cancelled.connect(lambda: self._show(status="stopped"))
        return worker

    def _progressed(self, report: TuningProgress, **more: Any) -> None:
        self._show(trials=report.trials, fraction=report.fraction, found=report.found, **more)

    def _show(self, **changes: Any) -> None:
        self.scene = dataclasses.replace(self.scene, **changes)
        self.changed.emit()
