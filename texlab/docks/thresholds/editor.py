"""The large threshold table under mouse and keyboard."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPointF, Qt, Signal
from PySide6.QtGui import QHelpEvent, QKeyEvent, QKeySequence, QMouseEvent

from texlab.docks.thresholds.editable import EditableTable
from texlab.docks.thresholds.selection import Selection
from texlab.docks.thresholds.table import changed, moved, rounded
from texlab.widgets.own_keys import OwnKeys, begins_number, is_bare, is_plain
from texlab.widgets.plain import set_tip, show_tip

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtCore import QObject
    from PySide6.QtWidgets import QWidget

    from texlab_core.methods.de_bonet.thresholds import Cell, ThresholdTable

# A threshold grows e-fold over so many pixels of a drag.
PIXELS_PER_E = 60.0
FINE = 0.125
STEP, LEAP = 0.05, 0.5
ARROWS = {
    Qt.Key.Key_Left: (0, -1),
    Qt.Key.Key_Right: (0, 1),
    Qt.Key.Key_Up: (-1, 0),
    Qt.Key.Key_Down: (1, 0),
}
STEPS = {
    Qt.Key.Key_Plus: STEP,
    Qt.Key.Key_Equal: STEP,
    Qt.Key.Key_Minus: -STEP,
    Qt.Key.Key_PageUp: LEAP,
    Qt.Key.Key_PageDown: -LEAP,
}
COUNTS_TIP = (
    "Of the newest result: how many candidates a typical pixel's ancestor has left once this level was compared "
    "too (median)"
)
SEQUENCES = (
    QKeySequence.StandardKey.SelectAll,
    QKeySequence.StandardKey.Copy,
    QKeySequence.StandardKey.Paste,
)
HINT = (
    "Drag a cell up or down to change it, the head of a row or a column to change all of it (Shift: finely). "
    "Arrows move, Ctrl+arrows select more, + - PgUp PgDn change, digits type a value, Delete lets the law decide "
    "again, L locks, M mirrors, P paints, Ctrl+C and Ctrl+V copy and paste rows."
)


@dataclass
class _Drag:
    """What a drag started from; ``travel`` is how far it went, in pixels."""

    last: QPointF
    base: dict[Cell, float]
    table: ThresholdTable
    painting: bool
    travel: float = 0.0


class TableEditor(OwnKeys, EditableTable):
    """Edits a threshold table.

    ``painting_changed(on)``: the mouse paints, or drags. ``picked(value)``: a value was picked with Alt+click.
    ``copied()`` and ``pasted()``: rows are to be copied to the clipboard, or taken from it.
    """

    painting_changed = Signal(bool)
    picked = Signal(float)
    copied = Signal()
    pasted = Signal()

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(name, parent)
        set_tip(self, HINT)
        self.setMouseTracking(True)
        self._drag: _Drag | None = None
        self._more: Callable[[int, int], str] | None = None
        self._painting = False
        self._paint_value = 0.15
        self._keys: dict[Qt.Key, Callable[[], None]] = {
            Qt.Key.Key_Home: lambda: self.select(Selection.cell(self.current[0], 0)),
            Qt.Key.Key_End: lambda: self.select(Selection.cell(self.current[0], self._columns() - 1)),
            Qt.Key.Key_Return: self.type_value,
            Qt.Key.Key_Enter: self.type_value,
            Qt.Key.Key_F2: self.type_value,
            Qt.Key.Key_Delete: self.reset_selected,
            Qt.Key.Key_Backspace: self.reset_selected,
            Qt.Key.Key_L: self.toggle_lock,
            Qt.Key.Key_M: self.mirror_selected,
            Qt.Key.Key_P: lambda: self.set_painting(not self._painting),
        }
        self._entry.installEventFilter(self)

    @property
    def busy(self) -> bool:
        """Whether an edit is under way: what is shown is ahead of the session."""
        return super().busy or self._drag is not None

    @property
    def painting(self) -> bool:
        """Whether the mouse paints the paint value."""
        return self._painting

    def settle(self) -> None:
        """End what goes on, a drag too: it is told as final."""
        super().settle()
        self._drag = None

    def set_painting(self, on: bool) -> None:
        """Paint with the mouse, or drag."""
        if on != self._painting:
            self._painting = on
            self.setCursor(Qt.CursorShape.CrossCursor if on else Qt.CursorShape.ArrowCursor)
            self.painting_changed.emit(on)

    def set_paint_value(self, value: float) -> None:
        """Choose what is painted."""
        self._paint_value = value

    def _columns(self) -> int:
        return self._view.values.shape[1] if self._view is not None else 0

    def _place(self, event: QMouseEvent) -> tuple[int, int] | None:
        return self.at(event.position().x(), event.position().y())

    # Mouse.

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Select a cell, a row or a column, and begin to drag or to paint."""
        place = self._place(event)
        if place is None or self._view is None or event.button() != Qt.MouseButton.LeftButton:
            return
        self.close_entry()
        if event.modifiers() & Qt.KeyboardModifier.AltModifier and min(place) >= 0:
            self.select(Selection.cell(*place))
            self.picked.emit(float(self._view.values[place]))
            return
        self._select_at(place, extend=bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier))
        base = {cell: self._view.value(cell) for cell in self.selected_cells()}
        self._drag = _Drag(event.position(), base, self._view.table, self._painting)
        if self._painting:
            self._paint(place)

    def _select_at(self, place: tuple[int, int], *, extend: bool) -> None:
        assert self._view is not None
        row, column = place
        last_row, last_column = (side - 1 for side in self._view.values.shape)
        if row < 0:
            self.select(Selection(last_row, column, 0, column))
        elif column < 0:
            self.select(Selection(row, last_column, row, 0))
        elif extend:
            self.select(self._selection.extended(row, column))
        elif self._painting or place not in self._selection.places():
            self.select(Selection.cell(row, column))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Change what is dragged, or paint."""
        drag, place = self._drag, self._place(event)
        if drag is None:
            if not self._painting:
                heads = place is not None and min(place) < 0
                self.setCursor(Qt.CursorShape.SizeVerCursor if heads else Qt.CursorShape.ArrowCursor)
            return
        if drag.painting:
            if place is not None:
                self._paint(place)
            return
        step = event.position() - drag.last
        drag.last = event.position()
        fine = event.modifiers() & Qt.KeyboardModifier.ShiftModifier
        drag.travel += (step.x() - step.y()) * (FINE if fine else 1.0)
        by = drag.travel / PIXELS_PER_E
        # Without travel every cell is as it was, also one that follows the law.
        values = {cell: moved(value, by) for cell, value in drag.base.items()} if drag.travel else {}
        self.change(values, final=False, base=drag.table)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the drag: all of it is one step."""
        drag, self._drag = self._drag, None
        if drag is None or self._view is None:
            return
        if self._view.table != drag.table:
            self.take(self._view.table, final=True)
            return
        place = self._place(event)
        extending = event.modifiers() & Qt.KeyboardModifier.ControlModifier
        if place is not None and min(place) >= 0 and not extending:
            # A click into a larger selection chooses one cell of it.
            self.select(Selection.cell(*place))

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Type a value."""
        place = self._place(event)
        if place is not None and min(place) >= 0 and not self._painting:
            self._drag = None
            self.select(Selection.cell(*place))
            self.type_value()

    def _paint(self, place: tuple[int, int]) -> None:
        """Give the cell under the brush (or all of the row or the column) the paint value."""
        assert self._view is not None
        row, column = place
        rows = range(self._view.values.shape[0]) if row < 0 else (row,)
        columns = range(self._columns()) if column < 0 else (column,)
        if min(place) >= 0:
            self.select(Selection.cell(row, column))
        cells = [cell for r in rows for c in columns for cell in self._view.cells(r, c)]
        painted = dict.fromkeys(cells, rounded(self._paint_value))
        self.take(changed(self._view.table, painted, self._locked), final=False)

    # Keyboard.

    def event(self, event: QEvent) -> bool:
        """Say what is under the cursor."""
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent) and self._view is not None:
            place = self.at(event.pos().x(), event.pos().y())
            if place is not None and min(place) >= 0:
                locked = set(self._view.cells(*place)) <= self._locked
                words = self._view.describe(*place) + (", locked" if locked else "") + self.more_words(*place)
                show_tip(event.globalPos(), words, self)
                return True
            if event.pos().x() > self.counts_left():
                show_tip(event.globalPos(), COUNTS_TIP, self)
                return True
        return super().event(event)

    def more_words(self, row: int, column: int) -> str:
        """Return what else is said about a cell."""
        return "" if self._more is None else self._more(row, column)

    def say_more(self, more: Callable[[int, int], str] | None) -> None:
        """Let tool tips say more about cells."""
        self._more = more

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it selects, changes, or begins a number."""
        key = Qt.Key(event.key())
        if self._view is None:
            return False
        control = event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier == Qt.KeyboardModifier.ControlModifier
        if (key in ARROWS and (control or is_plain(event))) or any(map(event.matches, SEQUENCES)):
            return True
        if key in self._keys:
            return is_bare(event)
        return begins_number(event) or (is_plain(event) and key in STEPS)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move, change, type, reset, lock, mirror."""
        key = Qt.Key(event.key())
        if not self.wants_key(event):
            super().keyPressEvent(event)
        elif event.matches(QKeySequence.StandardKey.SelectAll):
            self.select_all()
        elif event.matches(QKeySequence.StandardKey.Copy):
            self.copied.emit()
        elif event.matches(QKeySequence.StandardKey.Paste):
            self.pasted.emit()
        elif key in ARROWS:
            self._move(*ARROWS[key], extend=bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier))
        elif key in STEPS:
            # On many keyboards + is typed with Shift.
            fine = event.modifiers() & Qt.KeyboardModifier.ShiftModifier and key != Qt.Key.Key_Plus
            self.nudge(STEPS[key] * (FINE if fine else 1.0))
        elif key in self._keys:
            self._keys[key]()
        else:
            self.type_value(event.text().replace(",", "."))

    def _move(self, down: int, right: int, *, extend: bool) -> None:
        assert self._view is not None
        row = min(max(self.current[0] + down, 0), self._view.values.shape[0] - 1)
        column = min(max(self.current[1] + right, 0), self._columns() - 1)
        self.select(self._selection.extended(row, column) if extend else Selection.cell(row, column))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Leave the box in which a value is typed: Escape drops it, Return and the arrows take it."""
        if watched is self._entry and event.type() == QEvent.Type.FocusOut:
            self._entry.hide()
        elif watched is self._entry and isinstance(event, QKeyEvent) and event.type() == QEvent.Type.KeyPress:
            key = Qt.Key(event.key())
            if key == Qt.Key.Key_Escape:
                self.close_entry()
                return True
            if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
                self.take_entry()
                return True
            if key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
                self.take_entry()
                self._move(*ARROWS[key], extend=False)
                return True
        return super().eventFilter(watched, event)
