"""The table of all thresholds, levels by features, with what the chosen one lets through."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import QAbstractSpinBox, QHBoxLayout, QVBoxLayout, QWidget

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock
from texlab.docks.recent import Same
from texlab.docks.thresholds.distance_view import Distances, DistanceView
from texlab.docks.thresholds.editor import TableEditor
from texlab.docks.thresholds.table import Axes, KnownAxes, law_of, make_view, origin_of, table_field
from texlab.state.intentions import EditField
from texlab.widgets.number_box import NumberBox
from texlab.widgets.plain import Label, set_tip
from texlab_core.engine.registry import find_method
from texlab_core.errors import Cancelled
from texlab_core.methods.de_bonet.thresholds import MAX_THRESHOLD
from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.docks.thresholds.table import Origin, TableView
    from texlab.state.scene import ColumnScene, Scene
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.methods.de_bonet.thresholds import Cell, ThresholdTable

SIDE = 250


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
        "was set by hand; all other cells follow the law α / k^β. Beside it: what the chosen threshold lets "
        "through."
    )
    order = 24
    rest_ms = 0

    def build(self) -> None:
        """Make the controls, the table and what stands beside it."""
        self._known = KnownAxes()
        self._locks: dict[int, frozenset[Cell]] = {}
        self._column: ColumnScene | None = None
        self._exemplar: ImageInput | None = None
        self._field = ""
        self.editor = TableEditor("thresholds-table")
        self.distances = DistanceView("thresholds-distances")
        self._build_controls()
        self.cell_name = Label()
        self.cell_name.setObjectName("thresholds-cell")
        self.cell_name.setWordWrap(True)
        self.passing = Label()
        self.passing.setObjectName("thresholds-passing")
        self.measures = Label()
        self.measures.setObjectName("thresholds-measures")
        self.measures.setWordWrap(True)
        set_tip(
            self.measures,
            "Of the column's newest result: how many candidates a typical pixel was chosen from, and the share of "
            "neighbouring pixels that were copied together",
        )
        beside = QWidget()
        beside.setFixedWidth(SIDE)
        column = QVBoxLayout(beside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(2)
        column.addWidget(self.cell_name)
        column.addWidget(self.distances, 1)
        column.addWidget(self.passing)
        column.addWidget(self.measures)
        layout = QHBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addWidget(self.editor, 1)
        layout.addWidget(beside)
        self.setFocusProxy(self.editor)
        self.editor.edited.connect(self._edit)
        self.editor.current_changed.connect(lambda *_: self.ask())
        self.editor.value_changed.connect(self._show_cell)
        self.editor.locks_changed.connect(self._remember_locks)
        self.editor.painting_changed.connect(self.paint.setChecked)
        self.editor.picked.connect(self.value.setValue)
        self.distances.edited.connect(lambda value, final: self.editor.set_value(value, final=final))

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
        ):  # fmt: skip
            self.add_button(name, label, tip, act)

    # Asking and showing.

    def question(self, scene: Scene) -> Question | None:
        """Show the table of the chosen column at once; ask for the distances of the chosen cell."""
        column = scene.selected
        if self._column is not None and (column is None or column.id != self._column.id):
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

        def compute(should_stop: Callable[[], bool]) -> Distances:
            return Distances.of(model, k, feature)

        return Question((self.name, Same(model), k, feature), compute)

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

    def show_answer(self, answer: Distances | Known) -> None:
        """Show the distances of the chosen cell, or ask for them when levels and features are known by now."""
        if isinstance(answer, Known):
            self._known.learn(answer.column_id, answer.axes, answer.origin)
            self.ask()
            return
        self.distances.show_distances(answer)
        self._show_cell()

    def _show_table(self, column: ColumnScene, field: str) -> None:
        if self._column is None or column.id != self._column.id:
            self.editor.set_locked(self._locks.get(column.id, frozenset()))
        self._column, self._field = column, field
        view = self._view(column, getattr(column.params, field))
        self.arrangement.setVisible(view is not None and len(view.axes.channels) > 1)
        self.editor.show_view(view)
        self.measures.setText(measures_text(column))

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
        self.cell_name.setText(f"{view.heads[column].title}, k {row + 1}")
        set_tip(self.cell_name, view.describe(row, column))
        value = float(view.values[row, column])
        self.distances.show_threshold(value)
        if not self.paint.isChecked():
            with QSignalBlocker(self.value):
                self.value.setValue(value)
        share = self.distances.share
        self.passing.setText("" if share is None else f"lets {share:.1%} of all pairs through")

    def _rearrange(self) -> None:
        if self._column is not None and self.editor.view is not None:
            self.editor.show_view(self._view(self._column, self.editor.view.table))
        self.ask()

    # What the user does.

    def _settle(self) -> None:
        """End what goes on before another column is shown: it was meant for this one."""
        if self.distances.busy:
            self.distances.settle()
        self.editor.settle()

    def _edit(self, table: ThresholdTable, final: bool) -> None:
        if self._column is not None:
            self.intention.emit(EditField(self._column.id, self._field, table, final))

    def _value_set(self, value: float) -> None:
        self.editor.set_paint_value(value)
        if not self.paint.isChecked():
            self.editor.set_value(value)

    def _remember_locks(self) -> None:
        if self._column is not None:
            self._locks[self._column.id] = self.editor.locked


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
