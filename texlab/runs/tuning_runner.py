"""The newest search for parameters at work: its run in a worker's thread, and what there is to see of it."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab.runs.cell_runner import CellRunner, CellsMade, Teller, workers
from texlab.runs.column_run import TaskLike, job_of
from texlab.runs.kept_points import small
from texlab.state.sweeps import ShownCell
from texlab.state.tuning import TuningScene
from texlab_core.sheets.tuning import tune

if TYPE_CHECKING:
    from PySide6.QtCore import QObject

    from texlab.runs.slots import Slots
    from texlab.runs.worker import Request
    from texlab.state.chosen import Column, State
    from texlab.state.tuning import TuningPlan
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.job import Job
    from texlab_core.sheets.sweep import Cell
    from texlab_core.sheets.sweep_running import Places
    from texlab_core.sheets.tuning_report import Trial
    from texlab_core.warming import Warmth


@dataclass
class TuningRun:
    """A request for a worker: searches, each trial on a place of its own, and leaves one core to the columns."""

    base: Job
    plan: TuningPlan
    places: Places

    def __call__(self, task: TaskLike) -> CellsMade:
        """Search to the end, reporting every trial."""
        teller = Teller(task)

        def show(trial: Trial, cell: Cell | None) -> None:
            if cell is None or cell.result is None:
                return
            # Hundreds of them stay for the whole session: small pictures and numbers, no results.
            teller.add(ShownCell(dataclasses.replace(cell, values={}, result=None), small(cell.result.image)))

        found = tune(
            self.base,
            self.plan.knobs,
            limit=self.plan.limit,
            budget=self.plan.budget,
            on_trial=show,
            on_progress=teller.advance,
            should_stop=task.should_stop,
            workers=workers(),
            places=self.places,
        )
        return teller.end(found=found)


class TuningRunner(CellRunner):
    """Runs one search, the newest instead of any other."""

    scene: TuningScene

    def __init__(self, slots: Slots, warmth: Warmth, parent: QObject | None = None) -> None:
        super().__init__("tuning", TuningScene(), slots, warmth, parent)

    def start(self, plan: TuningPlan, state: State, column_id: int, exemplar: ImageInput | None) -> None:
        """Search for a column's method; what cannot be run is said in ``scene.problem``, and what runs goes on."""

        def make(column: Column, exemplar: ImageInput) -> tuple[TuningScene, Request]:
            return TuningScene(plan=plan), TuningRun(job_of(column, state, exemplar), plan, self._slots)

        self._begin(state, column_id, exemplar, make)
