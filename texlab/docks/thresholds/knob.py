"""The threshold table in the parameter panel: a small heat map and the way to the large one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from texlab.docks.thresholds.map import TableMap
from texlab.docks.thresholds.table import Axes, KnownAxes, law_of, make_view
from texlab.form.knobs import KnobWidget, register_editor
from texlab.widgets.own_keys import OwnKeys, is_plain
from texlab.widgets.plain import Label, set_tip
from texlab_core.methods.de_bonet.thresholds import ThresholdTable

if TYPE_CHECKING:
    from PySide6.QtGui import QKeyEvent, QMouseEvent

    from texlab.state.scene import ColumnScene
    from texlab_core.engine.params import Field

DOCK = "thresholds"


class _Map(OwnKeys, TableMap):
    """The small heat map: a double click or Return opens the large one."""

    def __init__(self, field: Field, knob: ThresholdKnob) -> None:
        super().__init__(f"map-{field.name}", field.label, small=True, parent=knob)
        self._knob = knob

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Open the large table."""
        self._knob.open_dock()

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it opens the large table."""
        return is_plain(event) and event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Open the large table."""
        if self.wants_key(event):
            self._knob.open_dock()
        else:
            super().keyPressEvent(event)


class ThresholdKnob(KnobWidget):
    """Shows the table of the chosen column small."""

    def __init__(self, field: Field, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._table: ThresholdTable = field.default
        self._column: ColumnScene | None = None
        self._known = KnownAxes()
        self.map = _Map(field, self)
        set_tip(
            self.map,
            "Rows: levels, coarsest first. Columns: features. A corner marks the cells that were set by hand. "
            "Double click or Return opens the large table.",
        )
        self.button = QPushButton("Edit table")
        self.button.setObjectName(f"edit-{field.name}")
        self.button.setAccessibleName("Edit the threshold table")
        set_tip(self.button, "Open the table of all thresholds, levels by features, below the images")
        self.button.clicked.connect(lambda _: self.open_dock())
        self.note = Label(name=f"note-{field.name}", muted=True, wraps=True)
        line = QHBoxLayout()
        line.addWidget(self.note, 1)
        line.addWidget(self.button, 0, Qt.AlignmentFlag.AlignTop)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(3)
        layout.addWidget(self.map)
        layout.addLayout(line)
        self.setFocusProxy(self.map)
        self._show()

    def open_dock(self) -> None:
        """Ask for the large table."""
        self.dock_wanted.emit(DOCK)

    def set_value(self, value: Any) -> None:
        """Show a table."""
        if value != self._table:
            self._table = value
            self._show()

    def set_context(self, context: ColumnScene | None) -> None:
        """Take levels and features from the column's result, and the law from its parameters."""
        before, self._column = self._column, context
        if before is None or context is None or self._differ(before, context):
            self._show()

    @staticmethod
    def _differ(before: ColumnScene, column: ColumnScene) -> bool:
        models = [None if each.result is None else each.result.model for each in (before, column)]
        return before.params is not column.params or models[0] is not models[1] or before.id != column.id

    def _show(self) -> None:
        axes = self._known.of(self._column) if self._column is not None else None
        words = words_for(self._table, axes)
        if axes is None or self._column is None:
            self.note.setText(f"{words} Levels and features are known after the first run.")
        else:
            self.map.show_view(make_view(axes, "each", self._table, law_of(self._column.params)))
            self.note.setText(words)
        self.map.setVisible(axes is not None)


def words_for(table: ThresholdTable, axes: Axes | None) -> str:
    """Return how many cells were set by hand: those that the exemplar has, and those that have nothing to do.

    Parameters
    ----------
    table
        The cells.
    axes
        Levels and features of the exemplar; None while they are not known, and all cells count.
    """
    names = None if axes is None else {feature.name for feature in axes.features}
    idle = sum(
        names is not None and (axes is None or k > axes.depth or name not in names) for (k, name), _ in table.cells
    )
    count = len(table.cells) - idle
    words = f"{count or 'No'} cell{'s' * (count != 1)} set by hand" if table.cells else "All cells follow the law"
    more = f"; {idle} for levels or features that this exemplar does not have" if idle else ""
    return f"{words}{more}."


def register() -> None:
    """Make it the editor of every parameter that is a threshold table."""
    register_editor(ThresholdTable, ThresholdKnob)
