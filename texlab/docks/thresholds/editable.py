"""The large threshold table: what is selected and locked, and what can be done to it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor, QPen
from PySide6.QtWidgets import QLineEdit, QWidget

from texlab.docks.thresholds.map import TableMap
from texlab.docks.thresholds.selection import Selection
from texlab.docks.thresholds.table import cell_text, changed, mirrored, moved, replaced, reset, rounded
from texlab.form.knobs import SETTLE_MS
from texlab.style.numbers import parse_number
from texlab.widgets.plain import set_tip
from texlab.widgets.settling import Settling
from texlab_core.methods.de_bonet.thresholds import MAX_THRESHOLD

if TYPE_CHECKING:
    from PySide6.QtGui import QPainter

    from texlab.docks.thresholds.table import TableView
    from texlab_core.methods.de_bonet.thresholds import Cell, ThresholdTable

FRAME = "#5aa9f0"


class EditableTable(TableMap):
    """A threshold table whose cells can be changed.

    ``edited(table, final)``: ``final`` is False while a drag or a series of keys goes on.
    ``current_changed(row, column)``: another cell was chosen. ``locks_changed()`` and ``value_changed()``: the
    chosen cell is locked or holds otherwise.
    """

    edited = Signal(object, bool)
    current_changed = Signal(int, int)
    value_changed = Signal()
    locks_changed = Signal()

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(name, "Threshold table", parent=parent)
        self._selection = Selection.cell(0, 0)
        self._settle = Settling(self, SETTLE_MS, self._settled)
        self._entry = QLineEdit(self)
        self._entry.setObjectName(f"{name}-entry")
        self._entry.setAccessibleName("Value of the selected cells")
        set_tip(self._entry, "A threshold from 0; Return takes it, Escape does not")
        self._entry.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._entry.hide()

    @property
    def busy(self) -> bool:
        """Whether an edit is under way: what is shown is ahead of the session."""
        return self._settle.isActive()

    def show_view(self, view: TableView | None) -> None:
        """Show a table; an edit under way and the selection stay."""
        if view is not None and self._view is not None and self.busy:
            view = replaced(view, self._view.table)
        super().show_view(view)
        if view is None:
            return
        kept = self._selection.within(*view.values.shape)
        if kept != self._selection:
            self.select(kept)
        else:
            self._describe()
            self.value_changed.emit()

    # Selection and locks.

    @property
    def current(self) -> tuple[int, int]:
        """Row and column of the chosen cell."""
        return self._selection.to_row, self._selection.to_column

    @property
    def selection(self) -> Selection:
        """What is selected."""
        return self._selection

    def select(self, selection: Selection) -> None:
        """Select cells."""
        if self._view is not None:
            selection = selection.within(*self._view.values.shape)
        before, self._selection = self.current, selection
        self._describe()
        self.update()
        if self.current != before:
            self.current_changed.emit(*self.current)
        self.value_changed.emit()

    def select_all(self) -> None:
        """Select the whole table."""
        if self._view is not None:
            rows, columns = self._view.values.shape
            self.select(Selection(0, 0, rows - 1, columns - 1))

    def selected_cells(self) -> list[Cell]:
        """Return the cells of the table that are selected."""
        if self._view is None:
            return []
        return [cell for place in self._selection.places() for cell in self._view.cells(*place)]

    @property
    def locked(self) -> frozenset[Cell]:
        """Cells that nothing changes."""
        return self._locked

    def set_locked(self, cells: frozenset[Cell]) -> None:
        """Lock these cells and no others."""
        self._locked = cells
        self.update()

    def toggle_lock(self) -> None:
        """Lock the selected cells, or unlock them when all are locked."""
        cells = frozenset(self.selected_cells())
        self._locked = self._locked - cells if cells <= self._locked else self._locked | cells
        self.update()
        self.locks_changed.emit()

    # Changes.

    def set_value(self, value: float, *, final: bool = True) -> None:
        """Give all selected cells a value."""
        self.change(dict.fromkeys(self.selected_cells(), rounded(value)), final=final)

    def nudge(self, by: float) -> None:
        """Multiply all selected cells by e^by; several nudges in a row are one step."""
        if self._view is not None:
            view = self._view
            self._settle.start()
            self.change({cell: moved(view.value(cell), by) for cell in self.selected_cells()}, final=False)

    def reset_selected(self) -> None:
        """Let the law decide about the selected cells again."""
        if self._view is not None:
            self.take(reset(self._view.table, self.selected_cells(), self._locked), final=True)

    def reset_all(self) -> None:
        """Let the law decide about every cell again, but for the locked ones."""
        if self._view is not None:
            table = self._view.table
            self.take(reset(table, [cell for cell, _ in table.cells], self._locked), final=True)

    def mirror_selected(self) -> None:
        """Copy the selected cells to those of the mirrored orientation."""
        if self._view is not None:
            self.change(mirrored(self._view, self.selected_cells()), final=True)

    def change(self, values: dict[Cell, float], *, final: bool, base: ThresholdTable | None = None) -> None:
        """Set cells of a table, the one that is shown when it is left out."""
        if self._view is not None:
            self.take(changed(base or self._view.table, values, self._locked), final=final)

    def take(self, table: ThresholdTable, *, final: bool) -> None:
        """Show a table at once and tell about it."""
        assert self._view is not None
        if final:
            self._settle.stop()
        differs = table != self._view.table
        if differs:
            self._view = replaced(self._view, table)
            self._describe()
            self.update()
            self.value_changed.emit()
        if differs or final:
            self.edited.emit(table, final)

    def settle(self) -> None:
        """End what goes on: it is told as final."""
        self.close_entry()
        if self.busy:
            self._settled()

    def _settled(self) -> None:
        if self._view is not None:
            self.take(self._view.table, final=True)

    def _describe(self) -> None:
        if self._view is not None and self._view.values.size:
            self.setAccessibleDescription(self._view.describe(*self.current))

    # Typing.

    def type_value(self, start: str = "") -> None:
        """Open a box over the chosen cell to type a value in."""
        if self._view is None:
            return
        area = self.cell_rect(*self.current)
        wide = QRectF(0, 0, max(area.width(), 64), max(area.height(), self._entry.sizeHint().height()))
        wide.moveCenter(area.center())
        wide.moveLeft(min(max(wide.left(), 0), self.width() - wide.width()))
        wide.moveTop(min(max(wide.top(), 0), self.height() - wide.height()))
        self._entry.setGeometry(wide.toRect())
        self._entry.setText(start or cell_text(float(self._view.values[self.current])))
        if not start:
            self._entry.selectAll()
        self._entry.show()
        self._entry.setFocus()

    def take_entry(self) -> None:
        """Take what was typed."""
        value = parse_number(self._entry.text())
        self.close_entry()
        if value is not None and 0 <= value <= MAX_THRESHOLD:
            self.set_value(value)

    def close_entry(self) -> None:
        """Close the box without taking what was typed."""
        if self._entry.isVisible():
            self._entry.hide()
            self.setFocus()

    def paint_more(self, painter: QPainter) -> None:
        """Frame the selection, and the chosen cell within it."""
        places = self._selection.places()
        whole = self.cell_rect(*places[0]).united(self.cell_rect(*places[-1]))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        # A bright line on a dark one is seen on every colour.
        for area, width in ((whole, 3 if self.hasFocus() else 2), (self.cell_rect(*self.current), 2)):
            outer = area.adjusted(-1.5, -1.5, 0.5, 0.5)
            for colour, line in (("#000000", width + 2), (FRAME, width)):
                painter.setPen(QPen(QColor(colour), line))
                painter.drawRect(outer)
