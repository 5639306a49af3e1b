"""Sweeps: one or two knobs over ranges, as a contact sheet whose cells can be taken."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QFileDialog,
    QHBoxLayout,
    QProgressBar,
    QSizePolicy,
    QSlider,
    QVBoxLayout,
)

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock, replace_items
from texlab.docks.sweeps.panel import SweepPanel
from texlab.docks.sweeps.places import LARGEST, SMALLEST, USUAL
from texlab.docks.sweeps.sheet_view import ContactSheetView
from texlab.state.intentions import AskOnce, CellAsColumn, RunSweep, StopSweep, TakeCell, Tell
from texlab.state.sweeps import NO_SWEEP
from texlab.style.numbers import duration, remaining
from texlab.style.text_size import grow_with_text
from texlab.widgets.plain import Label, set_tip
from texlab_core.engine.registry import find_method
from texlab_core.errors import InputError
from texlab_core.measures.registry import measures
from texlab_core.sheets.sweep import show
from texlab_core.sheets.sweep_recipes import bundled_sweeps
from texlab_core.sheets.sweep_sheet import sweep_title, write_sheet

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterable, Mapping

    from PySide6.QtGui import QKeyEvent

    from texlab.state.scene import ColumnScene, Scene
    from texlab.state.sweeps import ShownCell, SweepScene
    from texlab_core.sheets.sweep import Cell, Sweep
    from texlab_core.sheets.sweep_recipes import SweepRecipe

ZOOM_STEP = 16
AS_VARIED: list[tuple[str, Any]] = [("as varied", None)]


class SweepsDock(FramedDock):
    """Varies one or two knobs of the chosen column's method."""

    name = "sweeps"
    title = "Sweeps"
    help = "One or two parameters over ranges, side by side; click a cell to take its parameters."
    order = 60
    empty = "Choose a column to vary its parameters."

    def build(self) -> None:
        """Make the controls, the axes and the sheet."""
        self._fits = True
        self._column: ColumnScene | None = None
        # What is painted at present.
        self.shown = NO_SWEEP
        self.cells: dict[int, ShownCell] = {}
        self.kept: set[int] = set()
        self._build_line()
        self.panel = SweepPanel(self.name)
        self.sheet = ContactSheetView("sweeps-sheet", "Choose what to vary, then press Start.")
        self.sheet.taken.connect(self._take)
        self.sheet.opened.connect(self._open)
        self.sheet.kept.connect(self._keep)
        self.sheet.zoom_wanted.connect(self._zoom)
        self.heading = Label("")
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
        self._show_state()

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it starts the sweep, or stops it while it runs."""
        held = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            return held == Qt.KeyboardModifier.ControlModifier
        plain = held == Qt.KeyboardModifier.NoModifier
        return event.key() == Qt.Key.Key_Escape and plain and self.running

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Start and stop."""
        if not self.wants_key(event):
            super().keyPressEvent(event)
        elif event.key() == Qt.Key.Key_Escape:
            self.stop()
        else:
            self.start()

    @property
    def sweep(self) -> Sweep | None:
        """What the cells are of."""
        return self.shown.sweep

    @property
    def running(self) -> bool:
        """Whether cells are being made."""
        return self.shown.running

    def _build_line(self) -> None:
        self.start_button = self.add_button("start", "Start", "Run every cell (Ctrl+Return)", self.start)
        self.stop_button = self.add_button("stop", "Stop", "Stop; the finished cells stay (Esc)", self.stop)
        self.save_button = self.add_button(
            "save", "Save sheet ...", "Save the sheet as one PNG that carries the sweep", self.ask_save
        )
        self.zoom = QSlider(Qt.Orientation.Horizontal)
        self.zoom.setRange(SMALLEST, LARGEST)
        self.zoom.setSingleStep(ZOOM_STEP)
        self.zoom.setPageStep(3 * ZOOM_STEP)
        self.zoom.setValue(USUAL)
        grow_with_text(self.zoom, 110, self.zoom.setFixedWidth)
        self.zoom.valueChanged.connect(lambda side: self.sheet.set_side(side))
        self.zoom.actionTriggered.connect(self._zoomed)
        self.add_control(
            self.zoom, "zoom", "Size of the pictures", "How large the cells are shown (Ctrl+wheel, +, -)"
        )
        self.sorting = self.add_choice(
            "sort", "Order", "In which order the cells stand: as varied, or the best first", (), self._sort
        )
        self.only_kept = self.add_switch(
            "only-kept", "Kept", "Show only the cells that are kept (K)", self._show_only_kept
        )
        replace_items(self.sorting, AS_VARIED)
        self.status = Label("")
        self.add_control(self.status, "status", "State of the sweep", "How far the sweep is")

    def fold_controls(self, folded: bool) -> None:
        """Leave the whole room to the sheet, or show what is varied again."""
        super().fold_controls(folded)
        self.panel.setVisible(not folded)

    # What there is to vary, and what came of it.

    def show_scene(self, scene: Scene) -> None:
        """Offer the chosen column's knobs and show how far the sweep is."""
        self._column = column = scene.selected
        if column is not None:
            self.panel.show_method(find_method(column.method))
            self.show_body()
        if scene.sweep is not self.shown:
            before, self.shown = self.shown, scene.sweep
            self._show_sweep(is_new=before.number != scene.sweep.number)
        self._mark(scene)
        self._show_state()

    def question(self, scene: Scene) -> Question | None:
        """Ask for the ready-made sweeps of the chosen column's method."""
        column = scene.selected
        self.why = self.empty
        if column is None:
            return None
        method = column.method

        def compute(should_stop: Callable[[], bool]) -> tuple[str, tuple[SweepRecipe, ...]]:
            return method, bundled_sweeps(method)

        return Question((self.name, method), compute)

    def show_answer(self, answer: tuple[str, tuple[SweepRecipe, ...]]) -> None:
        """Offer the ready-made sweeps."""
        method, recipes = answer
        if method == self.panel.method:
            self.panel.show_sweeps(recipes)

    def _show_sweep(self, *, is_new: bool) -> None:
        shown, sweep = self.shown, self.shown.sweep
        self.panel.tell_of(shown.asked, shown.problem)
        if sweep is None:
            return
        if is_new:
            columns = len(sweep.axes[0].values) if len(sweep.axes) == 2 else None
            count, size = len(sweep.jobs), sweep.base.picture_size
            heads = headings(sweep)
            if self._fits:
                # Until the user chooses a size.
                down = heads[1] if heads is not None else ()
                self.zoom.setValue(self.sheet.fitting_side(count, columns, max(size), down))
            settings = [setting(sweep, index) for index in range(count)]
            self.kept.clear()
            self.sheet.show_grid(settings, columns, size, heads)
            self.heading.setText(" · ".join(sweep_title(sweep)))
            set_tip(self.heading, self.heading.text())
        self.cells = {each.cell.index: each for each in shown.cells}
        replace_items(self.sorting, AS_VARIED + sortings(each.cell for each in shown.cells))
        self.sheet.show_cells(self.cells)
        self._sort()
        self.progress.setValue(round(1000 * shown.fraction))
        self.status.setText(status_text(shown))

    def _show_state(self) -> None:
        self.start_button.setEnabled(self._column is not None)
        self.stop_button.setEnabled(self.running)
        self.progress.setVisible(self.running)
        self.save_button.setEnabled(bool(self.cells))
        self.sorting.setEnabled(self.sorting.count() > 1)
        self.only_kept.setEnabled(bool(self.kept) or self.only_kept.isChecked())

    # What the user does.

    def start(self) -> None:
        """Run the sweep instead of one that runs."""
        if self._column is None:
            return
        try:
            plan = self.panel.plan()
        except InputError as error:
            self.panel.tell(str(error))
            return
        self.panel.tell("")
        self.intention.emit(RunSweep(self._column.id, plan))

    def stop(self) -> None:
        """Stop; the finished cells stay."""
        self.intention.emit(StopSweep())

    # The sheet.

    def _zoomed(self, *_: object) -> None:
        self._fits = False

    def _zoom(self, steps: int) -> None:
        self._zoomed()
        self.zoom.setValue(self.zoom.value() + steps * ZOOM_STEP)

    def _sort(self) -> None:
        cells = {index: shown.cell for index, shown in self.cells.items()}
        total = 0 if self.sweep is None else len(self.sweep.jobs)
        kept = self.kept if self.only_kept.isChecked() else None
        self.sheet.show_order(arranged(total, cells, self.sorting.currentData(), kept))

    def _show_only_kept(self, _: bool) -> None:
        self._sort()
        self._show_state()

    def _keep(self, index: int) -> None:
        self.kept ^= {index}
        self.sheet.show_kept(self.kept)
        self._sort()
        self._show_state()

    def _open(self, index: int) -> None:
        self.intention.emit(CellAsColumn(self.cells[index].cell, self.shown.column_id))

    def _take(self, index: int) -> None:
        chosen = 0 if self._column is None else self._column.id
        self.intention.emit(TakeCell(self.cells[index].cell, (chosen, self.shown.column_id)))

    def _mark(self, scene: Scene) -> None:
        """Mark the cell whose parameters the column has."""
        sweep, column = self.sweep, scene.selected
        found = None
        if sweep is not None and column is not None and sweep.base.method == column.method:
            is_seed = any(axis.name == "seed" for axis in sweep.axes)
            seed = scene.seed if column.seed is None else column.seed
            found = next(
                (
                    index
                    for index, job in enumerate(sweep.jobs)
                    if job.params == column.params and (not is_seed or job.seed == seed)
                ),
                None,
            )
        self.sheet.mark(found)

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
        dialog.setNameFilter("PNG with the sweep (*.png)")
        dialog.setDefaultSuffix("png")
        dialog.selectFile(f"{Path(exemplar).stem}-{base.method}-{varied}.png")
        dialog.fileSelected.connect(self.save)
        dialog.finished.connect(dialog.deleteLater)
        dialog.open()

    def save(self, path: str) -> None:
        """Write the sheet, in the background."""
        sweep, plan = self.sweep, self.shown.plan
        cells = [self.cells[index].cell for index in sorted(self.cells)]
        if sweep is None or plan is None:
            return

        def write(should_stop: Callable[[], bool]) -> None:
            write_sheet(path, sweep, cells, name=plan.name, note=plan.note)

        def done(_: None) -> None:
            self.intention.emit(Tell(f"Saved {path} with its sweep."))

        self.intention.emit(AskOnce("sheet", write, done))


def status_text(shown: SweepScene) -> str:
    """Return how far a sweep is, in words."""
    total = 0 if shown.sweep is None else len(shown.sweep.jobs)
    failed = sum(each.picture is None for each in shown.cells)
    counts = f"{len(shown.cells)} of {total}{f' · {failed} failed' if failed else ''}"
    if shown.status == "finished":
        return f"{counts} · {duration(shown.seconds)}"
    if shown.status == "stopped":
        return f"{counts} · stopped"
    if shown.running and shown.fraction > 0.05:
        left = shown.seconds * (1 - shown.fraction) / shown.fraction
        return f"{counts} · about {remaining(left)} left"
    return counts


def sortings(cells: Iterable[Cell]) -> list[tuple[str, Any]]:
    """Return (text, measure) for every measure by which these cells can be sorted."""
    known = {id for cell in cells for id in cell.measures}
    return [(f"by {each.title}", each.id) for each in measures().values() if each.id in known]


def arranged(
    total: int, cells: Mapping[int, Cell], by: str | None, kept: Collection[int] | None
) -> list[int] | None:
    """Return the cells that are shown in their order; None for all of them in their places.

    Parameters
    ----------
    total
        Number of cells, finished or not.
    cells
        Those that have finished, by index.
    by
        Id of a measure: the best value comes first, or the largest where none is better; cells without it, last.
    kept
        Only these; None for all.
    """
    if by is None and kept is None:
        return None
    shown = [index for index in range(total) if kept is None or index in kept]
    if by is None:
        return shown
    sign = 1 if measures()[by].better == "lower" else -1
    values = {index: cell.measures[by] for index, cell in cells.items() if by in cell.measures}
    return sorted(shown, key=lambda index: (index not in values, sign * values.get(index, 0.0)))


def headings(sweep: Sweep) -> tuple[list[str], list[str]] | None:
    """Return the headings of columns and rows; None for a series, whose cells have captions."""
    if len(sweep.axes) < 2:
        return None
    across, down = (
        [f"{axis.name.replace('_', ' ')} {show(value)}" for value in axis.values] for axis in sweep.axes
    )
    return across, down


def setting(sweep: Sweep, index: int) -> str:
    """Return what is varied in a cell, in words."""
    return ", ".join(f"{name.replace('_', ' ')} {show(value)}" for name, value in sweep.values(index).items())
