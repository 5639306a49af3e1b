"""Sweeps: one or two knobs over ranges, as a contact sheet whose cells can be taken."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QApplication,
    QFileDialog,
    QHBoxLayout,
    QProgressBar,
    QVBoxLayout,
)

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock, replace_items
from texlab.docks.sweeps.pair_view import PairView
from texlab.docks.sweeps.panel import SweepPanel
from texlab.docks.sweeps.places import LARGEST, SMALLEST, USUAL
from texlab.docks.sweeps.sheet_view import ContactSheetView
from texlab.docks.sweeps.words import arranged, headings, setting, sortings, status_text
from texlab.state.intentions import AskOnce, CellAsColumn, CellInWindow, RunSweep, StopSweep, TakeCell, Tell
from texlab.state.sweeps import NO_SWEEP
from texlab.style.text_size import grow_with_text
from texlab.widgets.plain import Label, ShortLabel
from texlab.widgets.slider import Slider
from texlab_core.engine.registry import find_method
from texlab_core.errors import InputError
from texlab_core.sheets.sweep import TEXTURE
from texlab_core.sheets.sweep_sheet import sweep_title, write_sheet
from texlab_core.sheets.sweep_sources import bundled_sweeps

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from PySide6.QtGui import QKeyEvent

    from texlab.state.scene import Scene
    from texlab.state.sweeps import ShownCell
    from texlab_core.sheets.sweep import Sweep
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

    def build(self) -> Iterator[None]:
        """Make the controls, the axes and the sheet."""
        self._fits = True
        # What is painted at present.
        self.shown = NO_SWEEP
        self.cells: dict[int, ShownCell] = {}
        # In the order of keeping.
        self.kept: list[int] = []
        self._build_line()
        yield
        self.panel = SweepPanel(self.name)
        yield
        self.sheet = ContactSheetView("sweeps-sheet", "Choose what to vary, then press Start.")
        self.sheet.taken.connect(self._take)
        self.sheet.opened.connect(self._open)
        self.sheet.opened_here.connect(self._open_here)
        self.sheet.canvas.is_elsewhere = self._is_elsewhere
        self.sheet.kept.connect(self._keep)
        self.sheet.zoom_wanted.connect(self._zoom)
        self.sheet.compared.connect(self.compare)
        self.pair: PairView | None = None
        self.heading = ShortLabel(name="sweeps-heading", muted=True)
        self.progress = QProgressBar()
        self.progress.setObjectName("sweeps-progress")
        self.progress.setAccessibleName("Progress of the sweep")
        self.progress.setRange(0, 1000)
        self.progress.setTextVisible(False)
        policy = self.progress.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        self.progress.setSizePolicy(policy)
        self._right = right = QVBoxLayout()
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
        self.zoom = Slider("Size of the pictures", lambda side: f"{side} px")
        self.zoom.setRange(SMALLEST, LARGEST)
        self.zoom.setSingleStep(ZOOM_STEP)
        self.zoom.setPageStep(3 * ZOOM_STEP)
        self.zoom.setValue(USUAL)
        grow_with_text(self.zoom, 110, self.zoom.setFixedWidth)
        self.zoom.valueChanged.connect(lambda side: self.sheet.set_side(side))
        self.zoom.actionTriggered.connect(self._zoomed)
        self.add_slider(self.zoom, "zoom", "How large the cells are shown (Ctrl+wheel, +, -)")
        self.sorting = self.add_choice(
            "sort", "Order", "In which order the cells stand: as varied, or the best first", (), self._sort
        )
        self.only_kept = self.add_switch(
            "only-kept", "Kept", "Show only the cells that are kept (K)", self._show_only_kept
        )
        replace_items(self.sorting, AS_VARIED)
        tip = "The two cells that were kept last, side by side, with flicker and difference (C)"
        self.compare_button = self.add_button("compare", "Compare", tip, self.compare)
        self.status = Label("")
        self.add_control(self.status, "status", "State of the sweep", "How far the sweep is")

    def take_settings(self, wanted: Mapping[str, Any]) -> tuple[str, ...]:
        """Set controls by name; ``ready-made`` is the name of a sweep, which may be offered later."""
        others = {name: value for name, value in wanted.items() if name != "ready-made"}
        if isinstance(name := wanted.get("ready-made"), str):
            self.panel.choose_ready(name)
        return super().take_settings(others)

    def fold_controls(self, folded: bool) -> None:
        """Leave the whole room to the sheet, or show what is varied again."""
        super().fold_controls(folded)
        self.panel.setVisible(not folded)

    # What there is to vary, and what came of it.

    def show_scene(self, scene: Scene) -> None:
        """Offer the chosen column's knobs and show how far the sweep is."""
        super().show_scene(scene)
        column = scene.selected
        self.panel.across.show_opened(scene.opened)
        if column is not None:
            self.panel.show_method(find_method(column.method))
            self.show_body()
        if scene.sweep is not self.shown:
            before, self.shown = self.shown, scene.sweep
            # The sweep over many textures comes when they have been read.
            self._show_sweep(is_new=before.sweep is not scene.sweep.sweep)
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
            self._leave_pair()
            self.sheet.show_grid(settings, columns, size, heads)
            self.heading.setText(" · ".join((*sweep_title(sweep), *filter(None, (shown.left_out,)))))
            is_texture = sweep.axes[0].name == TEXTURE
            self.sheet.show_words("texture and parameters" if is_texture else "parameters")
        self.cells = {each.cell.index: each for each in shown.cells}
        replace_items(self.sorting, AS_VARIED + sortings(each.cell for each in shown.cells))
        self.sheet.show_cells(self.cells)
        self._sort()
        self.progress.setValue(round(1000 * shown.fraction))
        self.status.setText(status_text(shown))

    def _show_state(self) -> None:
        self.start_button.setEnabled(self.scene.selected is not None)
        self.stop_button.setEnabled(self.running)
        self.progress.setVisible(self.running)
        self.save_button.setEnabled(bool(self.cells))
        self.sorting.setEnabled(self.sorting.count() > 1)
        self.compare_button.setEnabled(len(self.kept) > 1 and not self.compares)
        self.only_kept.setEnabled(bool(self.kept) or self.only_kept.isChecked())

    # What the user does.

    def start(self) -> None:
        """Run the sweep instead of one that runs."""
        if self.scene.selected is None:
            return
        try:
            plan = self.panel.plan()
        except InputError as error:
            self.panel.tell(str(error))
            return
        self.panel.tell("")
        self.intention.emit(RunSweep(self.scene.selected.id, plan))

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
        if index in self.kept:
            self.kept.remove(index)
        else:
            self.kept.append(index)
        self.sheet.show_kept(self.kept)
        self._sort()
        self._show_state()

    def compare(self) -> None:
        """Show the two cells that were kept last side by side."""
        if len(self.kept) < 2:
            return
        if self.pair is None:
            self.pair = PairView(self.name, self._once, self.body)
            self.pair.closed.connect(self._leave_pair)
            self.pair.set_theme(self.theme)
            self._right.addWidget(self.pair, 1)
        a, b = sorted(self.kept[-2:])
        has_focus = self.sheet.canvas.hasFocus() or self.compare_button.hasFocus()
        self.sheet.hide()
        self.pair.show()
        self.pair.show_pair(self.cells[a], self.cells[b])
        if has_focus:
            self.pair.back.setFocus()
        self._show_state()

    @property
    def compares(self) -> bool:
        """Whether two cells are shown in the place of the sheet."""
        return self.pair is not None and not self.pair.isHidden()

    def _leave_pair(self) -> None:
        if self.pair is None or not self.compares:
            return
        has_focus = self.pair.isAncestorOf(QApplication.focusWidget() or self)
        self.sheet.show()
        self.pair.hide()
        if has_focus:
            self.sheet.canvas.setFocus()
        self._show_state()

    def _once(self, work: Callable[[], Any], done: Callable[[Any], None]) -> None:
        self.intention.emit(AskOnce("difference", lambda should_stop: work(), done))

    def _is_elsewhere(self, index: int) -> bool:
        """Whether a cell is of another texture than the one that all columns have."""
        cell, own = self.cells[index].cell, self.scene.exemplar
        return TEXTURE in cell.values and (own is None or cell.job.inputs["exemplar"].sha256 != own.sha256)

    def _open(self, index: int) -> None:
        if self._is_elsewhere(index):
            self.intention.emit(CellInWindow(self.cells[index].cell))
        else:
            self._open_here(index)

    def _open_here(self, index: int) -> None:
        self.intention.emit(CellAsColumn(self.cells[index].cell, self.shown.column_id))

    def _take(self, index: int) -> None:
        chosen = 0 if self.scene.selected is None else self.scene.selected.id
        self.intention.emit(TakeCell(self.cells[index].cell, (chosen, self.shown.column_id)))

    def _mark(self, scene: Scene) -> None:
        """Mark the cell whose parameters the column has."""
        sweep, column = self.sweep, scene.selected
        found = None
        if sweep is not None and column is not None and sweep.base.method == column.method:
            is_seed = any(axis.name == "seed" for axis in sweep.axes)
            is_texture, own = sweep.axes[0].name == TEXTURE, scene.exemplar
            seed = scene.seed if column.seed is None else column.seed
            found = next(
                (
                    index
                    for index, job in enumerate(sweep.jobs)
                    if job.params == column.params
                    and (not is_seed or job.seed == seed)
                    and (not is_texture or (own is not None and job.inputs["exemplar"].sha256 == own.sha256))
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
        if self.sweep.axes[0].name == TEXTURE:
            exemplar = "textures"
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
