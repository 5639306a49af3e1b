"""The newest sweep at work: its thread, and what there is to see of it."""

from __future__ import annotations

import dataclasses
import time
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from texlab.runs.sweep_run import SweepProgress, SweepRun, sweep_of
from texlab.runs.worker import Worker
from texlab.state.sweeps import SweepScene
from texlab_core.errors import InputError
from texlab_core.warming import Need

if TYPE_CHECKING:
    from texlab.runs.slots import Slots
    from texlab.state.session import State
    from texlab.state.sweeps import SweepPlan
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.warming import Warmth


class SweepRunner(QObject):
    """Runs one sweep, the newest instead of any other; ``changed()`` tells that ``scene`` is another one."""

    changed = Signal()

    def __init__(self, slots: Slots, warmth: Warmth, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.scene = SweepScene()
        self._slots = slots
        self._warmth = warmth
        self._begun = 0.0
        # Most sessions have no sweep, and need no thread for it.
        self._worker: Worker | None = None

    def start(self, plan: SweepPlan, state: State, column_id: int, exemplar: ImageInput | None) -> None:
        """Run what was asked for; what cannot be run is said in ``scene.problem``, and what runs goes on."""
        column = state.column(column_id)
        if column is None or exemplar is None:
            self._show(asked=plan, problem="There is no exemplar yet.")
            return
        try:
            sweep = sweep_of(plan, state, column, exemplar)
        except InputError as error:
            self._show(asked=plan, problem=str(error))
            return
        number = self.scene.number + 1
        self.scene = SweepScene(number, plan, "", plan, sweep, column_id, "running")
        self._begun = time.perf_counter()
        if self._worker is None:
            self._worker = self._make_worker()
        need, warmth = Need(column.method, exemplar.channels), self._warmth
        self._worker.submit(SweepRun(sweep, self._slots), first=lambda task: warmth.wait(need, task.should_stop))
        self.changed.emit()

    def stop(self) -> None:
        """Stop; the finished cells stay."""
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
        worker = Worker("sweep", parent=self)
        worker.progressed.connect(self._progressed)
        worker.finished.connect(lambda report: self._progressed(report, status="finished"))
        worker.failed.connect(lambda sentence: self._show(status="failed", problem=sentence))
        worker.cancelled.connect(lambda: self._show(status="stopped"))
        return worker

    def _progressed(self, report: SweepProgress, **more: Any) -> None:
        seconds = time.perf_counter() - self._begun
        self._show(cells=report.cells, fraction=report.fraction, seconds=seconds, **more)

    def _show(self, **changes: Any) -> None:
        self.scene = dataclasses.replace(self.scene, **changes)
        self.changed.emit()
