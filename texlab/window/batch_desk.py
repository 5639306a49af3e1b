"""Batches from the window: one at a time, in a thread that drives processes of its own."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QUrl
from PySide6.QtGui import QDesktopServices

from texlab.window.batch_dialog import BatchDialog, BatchRequest
from texlab.window.run_dialog import RunDesk

if TYPE_CHECKING:
    from texlab.runs.worker import Task
    from texlab.state.session import Session
    from texlab.window.main_window import MainWindow
    from texlab_core.batch.places import Place
    from texlab_core.batch.running import BatchResult


class BatchDesk(RunDesk):
    """Opens the dialog, and runs what it asks for."""

    dialog: BatchDialog | None = None

    def __init__(self, window: MainWindow, session: Session) -> None:
        super().__init__(window, "batch", "Stopped; run it again to go on.")
        self._session = session

    def open(self) -> None:
        """Show the dialog."""
        if self.dialog is None:
            self.dialog = BatchDialog(self._window)
            self.dialog.asked.connect(self._run)
            self._connect(self.dialog, self.dialog.show_progress, self.dialog.show_result)
            self.dialog.page_wanted.connect(lambda page: QDesktopServices.openUrl(QUrl.fromLocalFile(page)))
        self._show(self.dialog)

    def _run(self, asked: BatchRequest) -> None:
        dialog = self.dialog
        assert dialog is not None
        data = None if asked.plan else plan_data(asked, self._session)
        self._submit(dialog, lambda task: run_request(task, asked, data))


def plan_data(asked: BatchRequest, session: Session) -> dict[str, Any]:
    """Return the plan that the fields and the columns stand for, as data; further inputs as they are."""
    chosen = session.selected_column
    columns = session.state.columns if asked.all_columns or chosen is None else (chosen,)
    methods: list[dict[str, Any]] = []
    taken: dict[str, int] = {}
    for column in columns:
        taken[column.method] = taken.get(column.method, 0) + 1
        number = taken[column.method]
        name = column.method if number == 1 else f"{column.method} {number}"
        methods.append(
            {
                "method": column.method,
                "set": column.params.to_json(),
                "inputs": dict(column.inputs),
                "name": name,
            }
        )
    return {
        "inputs": list(asked.inputs),
        "methods": methods,
        "seeds": {"from": session.state.seed, "count": asked.seeds},
        "sizes": list(asked.sizes),
        "name": "Run for many",
    }


def run_request(task: Task, asked: BatchRequest, data: dict[str, Any] | None) -> BatchResult:
    """Run a request in a worker's thread; raises ``InputError`` for what cannot be done."""
    from texlab.storage.paths import config_dir
    from texlab_core.batch.places import InProcess
    from texlab_core.batch.plan import find_plan, plan_from_json
    from texlab_core.batch.processes import Processes
    from texlab_core.batch.running import run_batch
    from texlab_core.documents.preset_store import PresetStore

    presets = PresetStore(config_dir() / "presets")
    if data is None:
        plan = find_plan(asked.plan, presets=presets)
    else:
        plan = plan_from_json(data, folder=Path.home(), presets=presets)
    place: Place = InProcess() if asked.processes == 1 else Processes(asked.processes)

    def tell(progress: Any) -> None:
        if task.due() or progress.error:
            task.progress(progress)

    return run_batch(plan, asked.out, place=place, on_progress=tell, should_stop=task.should_stop)
