"""The table of all thresholds, levels by features, with what the chosen one lets through."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QAbstractSpinBox, QHBoxLayout, QVBoxLayout, QWidget

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock
from texlab.docks.recent import Same
from texlab.docks.thresholds import binds
from texlab.docks.thresholds.distance_view import DistanceView
from texlab.docks.thresholds.editor import TableEditor
from texlab.docks.thresholds.law_line import LawLine
from texlab.docks.thresholds.rows import pasted, rows_text
from texlab.docks.thresholds.table import Axes, KnownAxes, law_of, make_view, origin_of, table_field
from texlab.state.intentions import EditField, Tell
from texlab.style.text_size import grow_with_text, is_teaching
from texlab.widgets.number_box import NumberBox
from texlab.widgets.plain import Label, set_tip
from texlab_core.engine.registry import find_method
from texlab_core.errors import Cancelled, InputError
from texlab_core.methods.de_bonet.report import DeBonetDetails
from texlab_core.methods.de_bonet.thresholds import MAX_THRESHOLD
from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtGui import QResizeEvent

    from texlab.docks.thresholds.table import Origin, TableView
    from texlab.state.scene import ColumnScene, Scene
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.methods.de_bonet.binding import Binding
    from texlab_core.methods.de_bonet.sampling import Sampling
    from texlab_core.methods.de_bonet.thresholds import Cell, ThresholdTable

SIDE = 250
# Between table and distances, and at the borders.
SPARE = 20


@dataclass(frozen=True, eq=False)
class Known:
    """The axes of a column, and what they depend on."""

    column_id: int
    axes: Axes
    origin: Origin


class ThresholdsDock(FramedDock):
    """Edits the threshold table of the chosen column."""

    name = "thresholds"
    title = "Thresholds"
    help = (
        "Every threshold of the table T: one row for each level (k = 1 is the coarsest), one column for each "
        "feature. Drag a cell up or down, or the head of a row or a column (Shift: finely). A corner marks what "
        "was set by hand; all other cells follow the law α / k^β; neighbours that hold the same are one field. "
        "Beside it: what the chosen threshold lets through."
    )
    order = 24
    # The threshold of the chosen cell is a parameter.
    no_settings = frozenset({"value"})
    rest_ms = 0

    def build(self) -> None:
        """Make the controls, the table and what stands beside it."""
        self._known = KnownAxes()
        self._locks: dict[int, frozenset[Cell]] = {}
        self._column_id = 0
        self._exemplar: ImageInput | None = None
        self._field = ""
        self._found: Binding | None = None
        self.editor = TableEditor("thresholds-table")
        self._measured: binds.Answered | None = None
        self.distances = DistanceView("thresholds-distances")
        self._build_controls()
        self.cell_name = Label(name="thresholds-cell", wraps=True)
        self.passing = Label(name="thresholds-passing", wraps=True)
        self.measures = Label(name="thresholds-measures", wraps=True)
        set_tip(
            self.measures,
            "Of the column's newest result: how many candidates a typical pixel was chosen from, and the share of "
            "neighbouring pixels that were copied together",
        )
        self.binding_words = Label(name="thresholds-binding", wraps=True)
        self.law = LawLine("thresholds_law")
        self.law.edited.connect(self._edit_law)
        beside = QWidget()
        grow_with_text(beside, SIDE, beside.setFixedWidth)
        self._beside = beside
        column = QVBoxLayout(beside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        column.addWidget(self.cell_name)
        column.addWidget(self.distances, 1)
        column.addWidget(self.passing)
        column.addWidget(self.measures)
        column.addWidget(self.binding_words)
        table = QVBoxLayout()
        table.setSpacing(2)
        table.addWidget(self.law)
        table.addWidget(self.editor, 1)
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addLayout(table, 1)
        layout.addWidget(beside)
        self.setFocusProxy(self.editor)
        self.editor.edited.connect(self._edit)
        self.editor.current_changed.connect(lambda *_: self.ask())
        self.editor.value_changed.connect(self._show_cell)
        self.editor.locks_changed.connect(self._remember_locks)
        self.editor.painting_changed.connect(self.paint.setChecked)
        self.editor.picked.connect(self.value.setValue)
        self.editor.copied.connect(self.copy_rows)
        self.editor.pasted.connect(self.paste_rows)
        self.editor.say_more(self._more_words)
        self.distances.edited.connect(lambda value, final: self.editor.set_value(value, final=final))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Leave the distances out where one teaches and there is room for the table only."""
        super().resizeEvent(event)
        self._make_room()

    def _make_room(self) -> None:
        needed = self.editor.minimumSizeHint().width() + self._beside.maximumWidth() + SPARE
        self._beside.setVisible(not is_teaching() or needed <= self.width())

    def _build_controls(self) -> None:
        self.arrangement = self.add_choice(
            "channels",
            "Channels",
            "Every channel has its own thresholds, or one cell changes those of all channels",
            [("each channel", "each"), ("channels together", "together")],
            self._rearrange,
        )
        self.value = NumberBox()
        self.value.setRange(0, MAX_THRESHOLD)
        self.value.setDecimals(5)
        self.value.setStepType(QAbstractSpinBox.StepType.AdaptiveDecimalStepType)
        self.value.setPrefix("T = ")
        tip = "The threshold of the selected cells; while painting, the one that is painted (Alt+click picks it)"
        self.value.valueChanged.connect(self._value_set)
        self.add_control(self.value, "value", "Threshold", tip)
        self.paint = self.add_switch(
            "paint", "Paint", "Paint this value over cells with the mouse (P)", self.editor.set_painting
        )
        editor = self.editor
        for name, label, tip, act in (
            ("lock", "Lock", "Lock the selected cells: nothing changes them; again unlocks them (L)",
             editor.toggle_lock),
            ("mirror", "Mirror", "Copy the selected cells to the mirrored orientation, θ to 180° - θ (M)",
             editor.mirror_selected),
            ("reset", "Reset", "Let the selected cells follow the law again (Delete)", editor.reset_selected),
            ("reset-all", "Reset all", "Let every cell follow the law again, but for locked ones",
             editor.reset_all),
            ("copy", "Copy rows", "Copy the rows of the selected cells as text: into another column's table, or a "
             "spreadsheet (Ctrl+C)", self.copy_rows),
            ("paste", "Paste rows", "Paste copied rows: a single one into every selected row, several where they "
             "came from (Ctrl+V)", self.paste_rows),
        ):  # fmt: skip
            self.add_button(name, label, tip, act)
        self.colouring = self.add_choice(
            "colouring",
            "Colour",
            "Colour cells by their thresholds; by the share of their level's exclusions that each alone causes; "
            "or by the candidates that each would add if it let everything through",
            binds.COLOURINGS,
            self._colouring_changed,
        )

    # Asking and showing.

    def question(self, scene: Scene) -> Question | None:
        """Show the table of the chosen column at once; ask for the distances of the chosen cell."""
        column = scene.selected
        if self._column_id and (column is None or column.id != self._column_id):
            self._settle()
        field = table_field(column.params) if column is not None else None
        if column is None or field is None:
            self.why = "" if column is None else f"{column.title} has no threshold table."
            return None
        self._exemplar = scene.exemplar
        axes = self._known.of(column, scene.exemplar)
        if axes is None and scene.exemplar is not None and column.status not in ("waiting", "running"):
            return self._ask_axes(column, scene.exemplar)
        if axes is None:
            self.why = f"The levels and features of {column.title} are known when it has run once."
            return None
        if axes.depth == 0:
            self.why = "The pyramid has a single level, which is copied: there is nothing to compare."
            return None
        self.why = ""
        self._show_table(column, field)
        k, name = self.editor.selected_cells()[-1]
        model, feature = axes.model, [each.name for each in axes.features].index(name)
        sampling = self._sampling if self.colouring.currentData() != "values" else None

        def compute(should_stop: Callable[[], bool]) -> binds.Answered:
            return binds.answer(model, k, feature, sampling, lambda: self._sampling, should_stop)

        return Question((self.name, Same(model), k, feature, Same(sampling)), compute)

    @property
    def _sampling(self) -> Sampling | None:
        """Of the newest result: what is computed for an older one stops."""
        column = self.scene.selected
        details = column.result.details if column is not None and column.result is not None else None
        return details.sampling if isinstance(details, DeBonetDetails) else None

    def _ask_axes(self, column: ColumnScene, exemplar: ImageInput) -> Question:
        """Ask for the analysis of a column that was stopped before it had a result."""
        method, params, column_id = find_method(column.method), column.params, column.id
        inputs = {"exemplar": exemplar, **dict(column.inputs)}
        origin = origin_of(exemplar, params)

        def compute(should_stop: Callable[[], bool]) -> Known:
            def look() -> None:
                if should_stop():
                    raise Cancelled

            return Known(column_id, Axes.of(finish(method.analyze(inputs, params), look)), origin)

        return Question((self.name, column_id, origin), compute)

    def show_answer(self, answer: binds.Answered | Known) -> None:
        """Show the distances of the chosen cell, or ask for them when levels and features are known by now."""
        if isinstance(answer, Known):
            self._known.learn(answer.column_id, answer.axes, answer.origin)
            self.ask()
            return
        self._measured = answer
        # While a newer result is looked into, that of the last one stays.
        if answer.found is not None or self.colouring.currentData() == "values":
            self._found = answer.found
        self._show_binding()
        self._show_cell()

    def _show_table(self, column: ColumnScene, field: str) -> None:
        if column.id != self._column_id:
            self.editor.set_locked(self._locks.get(column.id, frozenset()))
            self._found = None
        self._column_id, self._field = column.id, field
        view = self._view(column, getattr(column.params, field))
        self.arrangement.setVisible(view is not None and len(view.axes.channels) > 1)
        self.editor.show_view(view)
        self._make_room()
        if view is not None:
            self.editor.show_counts(binds.counts(column, view.axes.depth))
            self.law.show_law(column.params, view.axes.depth)
        self.measures.setText(measures_text(column))
        self._show_binding()

    def _view(self, column: ColumnScene, table: ThresholdTable) -> TableView | None:
        axes = self._known.of(column, self._exemplar)
        if axes is None:
            return None
        return make_view(axes, self.arrangement.currentData(), table, law_of(column.params))

    def _show_cell(self) -> None:
        view = self.editor.view
        if view is None:
            return
        row, column = self.editor.current
        k, name = self.editor.selected_cells()[-1]
        cell = Same(view.axes.model), k, [each.name for each in view.axes.features].index(name)
        # No curve stands under the name of another cell.
        known = self._measured is not None and self._measured.cell == cell
        self.distances.show_distances(self._measured.distances if known and self._measured is not None else None)
        self.cell_name.setText(f"{view.heads[column].title}, k {row + 1}")
        set_tip(self.cell_name, view.describe(row, column))
        value = float(view.values[row, column])
        self.distances.show_threshold(value)
        if not self.paint.isChecked():
            with QSignalBlocker(self.value):
                self.value.setValue(value)
        share = self.distances.share
        self.passing.setText("" if share is None else f"lets {share:.1%} of all pairs through")

    def _show_binding(self) -> None:
        """Colour the table by what its cells exclude, where that is wanted and known."""
        view, found, colouring = self.editor.view, self._found, self.colouring.currentData()
        shown = found is not None and view is not None and colouring != "values"
        numbers = binds.of_cells(view, found, colouring) if shown else None  # type: ignore[arg-type]
        self.editor.show_shading(None if numbers is None else binds.shading(numbers))
        words = ""
        if colouring != "values":
            words = "" if view is None or found is None else binds.strictest(view, found)
            words = words or "What binds is known as soon as there is a result."
        self.binding_words.setText(words)
        self.binding_words.setVisible(bool(words))

    def _more_words(self, row: int, column: int) -> str:
        view, found = self.editor.view, self._found
        words = "" if view is None or found is None else binds.words(view, found, row, column)
        return f"; {words}" if words else ""

    def _colouring_changed(self) -> None:
        self._show_binding()
        self.ask()

    def _rearrange(self) -> None:
        column = next((each for each in self.scene.columns if each.id == self._column_id), None)
        if column is not None and self.editor.view is not None:
            self.editor.show_view(self._view(column, self.editor.view.table))
        self.ask()

    # What the user does.

    def _settle(self) -> None:
        """End what goes on before another column is shown: it was meant for this one."""
        if self.distances.busy:
            self.distances.settle()
        self.editor.settle()
        self.law.settle()

    def _edit(self, table: ThresholdTable, final: bool) -> None:
        if self._column_id:
            self.intention.emit(EditField(self._column_id, self._field, table, final))

    def _edit_law(self, name: str, value: float, final: bool) -> None:
        if self._column_id:
            self.intention.emit(EditField(self._column_id, name, value, final))

    def copy_rows(self) -> None:
        """Put the rows of the selected cells on the clipboard."""
        view = self.editor.view
        if view is None:
            return
        rows = {row for row, _ in self.editor.selection.places()}
        QGuiApplication.clipboard().setText(rows_text(view, rows))
        self.intention.emit(Tell(f"{len(rows)} row{'s' * (len(rows) != 1)} copied."))

    def paste_rows(self) -> None:
        """Set what copied rows say; locked cells stay."""
        view = self.editor.view
        if view is None:
            return
        try:
            cells, note = pasted(
                QGuiApplication.clipboard().text(), view, {r for r, _ in self.editor.selection.places()}
            )
        except InputError as bad:
            self.intention.emit(Tell(str(bad), problem=True))
            return
        self.editor.change(cells, final=True)
        if note:
            self.intention.emit(Tell(note))

    def _value_set(self, value: float) -> None:
        self.editor.set_paint_value(value)
        if not self.paint.isChecked():
            self.editor.set_value(value)

    def _remember_locks(self) -> None:
        if self._column_id:
            self._locks[self._column_id] = self.editor.locked


def measures_text(column: ColumnScene) -> str:
    """Return how many candidates there are and how much is copied, as far as the result tells."""
    measures = column.result.measures if column.result is not None else {}
    parts = []
    if "median-candidates" in measures:
        count = measures["median-candidates"]
        parts.append(f"{count:.0f} candidate{'' if count == 1 else 's'} (median)")
    if "copied-share" in measures:
        parts.append(f"{measures['copied-share']:.0%} copied")
    return " · ".join(parts)
