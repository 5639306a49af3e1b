"""Sweeps: one or two knobs over ranges, as a contact sheet whose cells can be taken."""

from __future__ import annotations

import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QFileDialog,
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QSizePolicy,
    QSlider,
    QVBoxLayout,
)

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock
from texlab.docks.sweeps.panel import SweepPanel
from texlab.docks.sweeps.sheet_view import LARGEST, SMALLEST, USUAL, ContactSheetView
from texlab.runs.sweep_run import ShownCell, SweepProgress, SweepRun
from texlab.runs.worker import Worker
from texlab.state.changes import with_cell
from texlab.style.numbers import duration, remaining
from texlab_core.engine.registry import find_method
from texlab_core.errors import InputError
from texlab_core.sheets.sweep import show
from texlab_core.sheets.sweep_recipes import bundled_sweeps
from texlab_core.sheets.sweep_sheet import sweep_title, write_sheet
from texlab_core.warming import Need

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.runs.controller import Controller
    from texlab.runs.worker import Task
    from texlab.state.scene import Scene
    from texlab.style.theme import Theme
    from texlab_core.engine.params import Params
    from texlab_core.sheets.sweep import Sweep
    from texlab_core.sheets.sweep_recipes import SweepRecipe

ZOOM_STEP = 16


@dataclass(frozen=True, eq=False)
class SweepsAnswer:
    """The column that is offered for a sweep, and the ready-made sweeps of its method."""

    column_id: int
    method: str
    params: Params
    seed: int | None
    recipes: tuple[SweepRecipe, ...]


class SweepsDock(FramedDock):
    """Varies one or two knobs of the chosen column's method."""

    name = "sweeps"
    title = "Sweeps"
    help = "One or two parameters over ranges, side by side; click a cell to take its parameters."
    order = 60
    empty = "Choose a column to vary its parameters."

    def build(self) -> None:
        """Make the controls, the axes and the sheet."""
        self._worker: Worker | None = None
        self._column_id = 0
        self._method = ""
        self._started_at = 0.0
        self._fits = True
        self.sweep: Sweep | None = None
        self.cells: dict[int, ShownCell] = {}
        self._origin = 0
        self._sheet_name = ("sweep", "")
        self._build_line()
        self.panel = SweepPanel(self.name)
        self.sheet = ContactSheetView("sweeps-sheet", "Choose what to vary, then press Start.")
        self.sheet.taken.connect(self._take)
        self.sheet.zoom_wanted.connect(self._zoom)
        self.heading = QLabel("")
        self.heading.setObjectName("sweeps-heading")
        self.heading.setProperty("role", "muted")
        # A long line must not widen the window.
        self.heading.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.progress = QProgressBar()
        self.progress.setObjectName("sweeps-progress")
        self.progress.setAccessibleName("Progress of the sweep")
        self.progress.setRange(0, 1000)
        self.progress.setTextVisible(False)
        policy = self.progress.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        self.progress.setSizePolicy(policy)
        right = QVBoxLayout()
        right.setSpacing(2)
        right.addWidget(self.heading)
        right.addWidget(self.progress)
        right.addWidget(self.sheet, 1)
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addWidget(self.panel)
        layout.addLayout(right, 1)
        for keys, act in (("Ctrl+Return", self.start), ("Escape", self.stop)):
            shortcut = QShortcut(QKeySequence(keys), self)
            shortcut.setContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
            shortcut.activated.connect(act)
        self._show_state()

    def _build_line(self) -> None:
        self.start_button = self.add_button("start", "Start", "Run every cell (Ctrl+Return)", self.start)
        self.stop_button = self.add_button("stop", "Stop", "Stop; the finished cells stay (Esc)", self.stop)
        self.save_button = self.add_button(
            "save", "Save sheet ...", "Save the sheet as one PNG that carries its recipe", self.ask_save
        )
        self.zoom = QSlider(Qt.Orientation.Horizontal)
        self.zoom.setRange(SMALLEST, LARGEST)
        self.zoom.setSingleStep(ZOOM_STEP)
        self.zoom.setPageStep(3 * ZOOM_STEP)
        self.zoom.setValue(USUAL)
        self.zoom.setFixedWidth(110)
        self.zoom.valueChanged.connect(lambda side: self.sheet.set_side(side))
        self.zoom.actionTriggered.connect(self._zoomed)
        self.add_control(
            self.zoom, "zoom", "Size of the pictures", "How large the cells are shown (Ctrl+wheel, +, -)"
        )
        self.status = QLabel("")
        self.add_control(self.status, "status", "State of the sweep", "How far the sweep is")

    def paint_theme(self, theme: Theme) -> None:
        """Give the sheet its colours."""
        self.sheet.set_theme(theme)

    # What there is to vary.

    def question(self, scene: Scene) -> Question | None:
        """Ask for the ready-made sweeps of the chosen column's method."""
        column = scene.selected
        if column is None:
            return None
        seed = None if column.result is None or column.result.job is None else column.result.job.seed

        def compute(should_stop: Callable[[], bool]) -> SweepsAnswer:
            return SweepsAnswer(column.id, column.method, column.params, seed, bundled_sweeps(column.method))

        return Question((self.name, column.id, column.method, column.params, seed), compute)

    def show_answer(self, answer: SweepsAnswer) -> None:
        """Offer the column's knobs; what was chosen for its method before comes back."""
        self._column_id = answer.column_id
        if answer.method != self._method:
            self._method = answer.method
            self.panel.show_method(find_method(answer.method), answer.recipes)
        self._mark(answer)
        self._show_state()

    # The run.

    @property
    def running(self) -> bool:
        """Whether cells are being made."""
        return self._worker is not None and self._worker.busy

    def start(self) -> None:
        """Run the sweep instead of one that runs."""
        if self.start_button.isEnabled():
            self.intention.emit(self._start)

    def _start(self, controller: Controller) -> None:
        column = controller.session.state.column(self._column_id)
        exemplar = controller.exemplar
        if column is None or exemplar is None:
            self.panel.tell("There is no exemplar yet.")
            return
        try:
            sweep = self.panel.plan().sweep(controller.session.state, column, exemplar)
        except InputError as error:
            self.panel.tell(str(error))
            return
        self.panel.tell("")
        recipe = self.panel.chosen_recipe
        self._sheet_name = ("sweep", "") if recipe is None else (recipe.name, recipe.note)
        self._origin = column.id
        self.sweep, self.cells = sweep, {}
        columns = len(sweep.axes[0].values) if len(sweep.axes) == 2 else None
        if self._fits:
            # Until the user chooses a size.
            self.zoom.setValue(self.sheet.fitting_side(len(sweep.jobs), columns, max(sweep.base.size)))
        self.sheet.show_grid([setting(sweep, index) for index in range(len(sweep.jobs))], columns, sweep.base.size)
        title, shared = sweep_title(sweep)
        self.heading.setText(f"{title} · {shared}")
        self.heading.setToolTip(self.heading.text())
        if self._worker is None:
            self._worker = self._make_worker()
        self._started_at = time.perf_counter()
        need, warmth = Need(column.method, exemplar.channels), controller.warmth
        self._worker.submit(
            SweepRun(sweep, controller.slots), first=lambda task: warmth.wait(need, task.should_stop)
        )
        self._progressed(SweepProgress((), 0.0))

    def _make_worker(self) -> Worker:
        worker = Worker("sweep", parent=self)
        worker.progressed.connect(self._progressed)
        worker.finished.connect(self._finished)
        worker.failed.connect(self._failed)
        worker.cancelled.connect(self._cancelled)
        worker.idle.connect(self._show_state)
        return worker

    def stop(self) -> None:
        """Stop; the finished cells stay."""
        if self._worker is not None and self.running:
            self._worker.cancel()

    def shut_down(self) -> None:
        """Stop and join the thread."""
        if self._worker is not None:
            self._worker.close()

    def _progressed(self, report: SweepProgress) -> None:
        self.cells = {shown.cell.index: shown for shown in report.cells}
        self.sheet.show_cells(self.cells)
        self.progress.setValue(round(1000 * report.fraction))
        elapsed = time.perf_counter() - self._started_at
        left = ""
        if report.fraction > 0.05:
            left = f" · about {remaining(elapsed * (1 - report.fraction) / report.fraction)} left"
        self.status.setText(f"{self._counts()}{left}")
        self._show_state()

    def _finished(self, report: SweepProgress) -> None:
        self._progressed(report)
        self.status.setText(f"{self._counts()} · {duration(time.perf_counter() - self._started_at)}")
        self._show_state()

    def _failed(self, sentence: str) -> None:
        self.panel.tell(sentence)
        self._show_state()

    def _cancelled(self) -> None:
        self.status.setText(f"{self._counts()} · stopped")
        self._show_state()

    def _counts(self) -> str:
        total = 0 if self.sweep is None else len(self.sweep.jobs)
        failed = sum(shown.picture is None for shown in self.cells.values())
        return f"{len(self.cells)} of {total}{f' · {failed} failed' if failed else ''}"

    def _show_state(self) -> None:
        self.start_button.setEnabled(bool(self._method))
        self.stop_button.setEnabled(self.running)
        self.progress.setVisible(self.running)
        self.save_button.setEnabled(bool(self.cells))

    # The sheet.

    def _zoomed(self, *_: object) -> None:
        self._fits = False

    def _zoom(self, steps: int) -> None:
        self._zoomed()
        self.zoom.setValue(self.zoom.value() + steps * ZOOM_STEP)

    def _take(self, index: int) -> None:
        cell = self.cells[index].cell
        wanted = (self._column_id, self._origin)

        def act(controller: Controller) -> None:
            session = controller.session
            found = with_cell(session.state, cell, wanted)
            if found is None:
                title = find_method(cell.job.method).title
                controller.problem.emit(f"No column runs {title} any more; add one to take the parameters.")
                return
            state, column_id = found
            session.apply(state, f"sweep {cell.setting}")
            session.select(column_id)

        self.intention.emit(act)
        self.sheet.mark(index)

    def _mark(self, answer: SweepsAnswer) -> None:
        """Mark the cell whose parameters the column has."""
        if self.sweep is None or self.sweep.base.method != answer.method:
            self.sheet.mark(None)
            return
        is_seed = any(axis.name == "seed" for axis in self.sweep.axes)
        if is_seed and answer.seed is None:
            return
        same = (
            index
            for index, job in enumerate(self.sweep.jobs)
            if job.params == answer.params and (not is_seed or job.seed == answer.seed)
        )
        self.sheet.mark(next(same, None))

    def ask_save(self) -> None:
        """Ask where to save the sheet."""
        if self.sweep is None or not self.cells:
            return
        base = self.sweep.base
        exemplar = base.inputs["exemplar"].name.removeprefix("gallery:")
        varied = "-".join(axis.name for axis in self.sweep.axes)
        dialog = QFileDialog(self, "Save sheet")
        dialog.setObjectName("sweeps-save-dialog")
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setNameFilter("PNG with recipe (*.png)")
        dialog.setDefaultSuffix("png")
        dialog.selectFile(f"{Path(exemplar).stem}-{base.method}-{varied}.png")
        dialog.fileSelected.connect(self.save)
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def save(self, path: str) -> None:
        """Write the sheet, in the background."""
        sweep, (name, note) = self.sweep, self._sheet_name
        cells = [self.cells[index].cell for index in sorted(self.cells)]
        if sweep is None:
            return

        def work(task: Task) -> str:
            write_sheet(path, sweep, cells, name=name, note=note)
            return path

        def act(controller: Controller) -> None:
            controller.once("sheet", work, lambda saved: controller.said.emit(f"Saved {saved} with its recipe."))

        self.intention.emit(act)


def setting(sweep: Sweep, index: int) -> str:
    """Return what is varied in a cell, in words."""
    return ", ".join(f"{name.replace('_', ' ')} {show(value)}" for name, value in sweep.values(index).items())
