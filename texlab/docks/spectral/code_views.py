"""Numbers of a code that can be dragged: a heat map of cells, and the bars of the histogram."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from texlab.widgets.heat_map import HeatMap
from texlab.widgets.own_keys import OwnKeys, begins_number, is_bare, is_plain

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtGui import QKeyEvent, QPaintEvent

    from texlab.style.theme import Theme

# Pixels of the mouse to a step; with Shift, ten times as many.
PIXELS = 4
FINE = 10
KEYS = {
    Qt.Key.Key_Plus: 1,
    Qt.Key.Key_Equal: 1,
    Qt.Key.Key_Minus: -1,
    Qt.Key.Key_PageUp: 5,
    Qt.Key.Key_PageDown: -5,
}
OTHERS = (Qt.Key.Key_Delete, Qt.Key.Key_Backspace, Qt.Key.Key_Return, Qt.Key.Key_Enter)
SIDEWAYS = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}
UPWARDS = {Qt.Key.Key_Up: 1, Qt.Key.Key_Down: -1}


def steps_of(event: QKeyEvent) -> int:
    """Return by how many steps a key changes a number, 0 for none."""
    return KEYS.get(Qt.Key(event.key()), 0)


def changes_number(event: QKeyEvent) -> bool:
    """Return whether a key changes the chosen number, empties it or begins to type one."""
    return (
        begins_number(event)
        or (is_plain(event) and event.key() in KEYS)
        or (is_bare(event) and event.key() in OTHERS)
    )


class CodeGrid(HeatMap):
    """Cells that are dragged up and down.

    ``dragged(place, steps)`` while the mouse moves, counted from where it was pressed; ``dropped()`` at its end;
    ``nudged(place, steps)`` and ``emptied(place)`` by the keyboard; ``typed(place, text)`` when a number is begun.
    """

    dragged = Signal(int, float)
    dropped = Signal()
    nudged = Signal(int, int)
    emptied = Signal(int)
    typed = Signal(int, str)

    def __init__(self, name: str, label: str, parent: QWidget | None = None) -> None:
        super().__init__(name, label, parent)
        self._changed: NDArray[np.bool_] = np.zeros((0, 0), bool)
        self._pressed: tuple[int, float] | None = None
        self._moved = False
        self.least = QSize(96, 60)

    def mark_changed(self, changed: NDArray[np.bool_]) -> None:
        """Mark the cells, (R, C), that are not as they were measured."""
        self._changed = changed
        self.update()

    @property
    def place(self) -> int:
        """The chosen cell, counted row by row; -1 for none."""
        return -1 if self.selected is None else self._place(*self.selected)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose a cell and begin to drag it."""
        super().mousePressEvent(event)
        cell = self._cell_at(event)
        if event.button() == Qt.MouseButton.LeftButton and cell is not None:
            self._pressed = (self._place(*cell), event.position().y())
            self._moved = False

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Drag the pressed cell, or tell which one is under the cursor."""
        super().mouseMoveEvent(event)
        cell = self._cell_at(event)
        self.setCursor(Qt.CursorShape.SizeVerCursor if cell or self._pressed else Qt.CursorShape.ArrowCursor)
        if self._pressed is not None:
            place, y = self._pressed
            by = (y - event.position().y()) / PIXELS
            if event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
                by /= FINE
            if by or self._moved:
                self._moved = True
                self.dragged.emit(place, by)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the drag."""
        super().mouseReleaseEvent(event)
        if self._pressed is not None and event.button() == Qt.MouseButton.LeftButton:
            self._pressed = None
            if self._moved:
                self.dropped.emit()

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it moves, changes the chosen cell, or begins a number."""
        return (self.place >= 0 and changes_number(event)) or super().wants_key(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Change the chosen cell by + and -, empty it by Delete, begin a number by a digit."""
        steps = steps_of(event)
        if self.place < 0 or not changes_number(event):
            super().keyPressEvent(event)
        elif steps:
            self.nudged.emit(self.place, steps)
        elif event.key() in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            self.emptied.emit(self.place)
        else:
            self.typed.emit(self.place, event.text() if begins_number(event) else "")

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the cells, and a corner in those that were changed."""
        super().paintEvent(event)
        if not self._changed.any():
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for row, column in np.argwhere(self._changed).tolist():
            corner = self.cell_rect(row, column).adjusted(0, 0, -1, -1).topRight()
            painter.setPen(QPen(QColor("#000000"), 1))
            painter.setBrush(QColor("#ffffff"))
            painter.drawPolygon(QPolygonF([corner, corner - QPointF(8, 0), corner + QPointF(0, 8)]))
        painter.end()

    def _place(self, row: int, column: int) -> int:
        return row * int(self._places.shape[1]) + column


class HistogramBars(OwnKeys, QWidget):
    """Sixteen bars that follow the mouse; moving it sideways draws over several.

    ``dragged({place: value})`` in the unit of the bars, ``dropped()`` at the end; the keyboard as in
    :class:`CodeGrid`.
    """

    chosen = Signal(int)
    hovered = Signal(int)
    dragged = Signal(object)
    dropped = Signal()
    nudged = Signal(int, int)
    emptied = Signal(int)
    typed = Signal(int, str)

    def __init__(self, name: str, label: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(label)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(110, 60)
        self.setMouseTracking(True)
        self._theme: Theme | None = None
        self._values: NDArray[np.float64] = np.zeros(0)
        self._measured: NDArray[np.float64] | None = None
        self._top = 1.0
        self._place = -1
        self._pressed = -1
        self._last = QPointF()

    @property
    def place(self) -> int:
        """The chosen bar, -1 for none."""
        return self._place

    def select(self, place: int) -> None:
        """Choose a bar without telling anyone."""
        self._place = place
        self.update()

    def show_bars(self, values: NDArray[np.float64], measured: NDArray[np.float64] | None) -> None:
        """Show bars, and lines where the exemplar's are."""
        same = np.array_equal(values, self._values) and (
            measured is self._measured
            or (measured is not None and self._measured is not None and np.array_equal(measured, self._measured))
        )
        self._values, self._measured = values, measured
        # While other numbers are dragged, nothing is painted here.
        if same and self._pressed < 0:
            return
        if self._pressed < 0:
            both = values if measured is None else np.concatenate([values, measured])
            # The scale stands still while a bar is dragged.
            self._top = 1.15 * max(float(both.max(initial=0)), 1e-6)
        self.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.update()

    def sizeHint(self) -> QSize:
        """Ask for bars that can be hit."""
        return QSize(190, 100)

    def bar_point(self, place: int, value: float) -> QPointF:
        """Return where the top of a bar of this value is, in the widget."""
        area = self._area()
        width = area.width() / max(len(self._values), 1)
        return QPointF(area.left() + (place + 0.5) * width, area.bottom() - value / self._top * area.height())

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint bars, the measured values and the scale."""
        if self._theme is None or not self._values.size:
            return
        painter = QPainter(self)
        area = self._area()
        painter.fillRect(area, QColor(self._theme.base))
        width = area.width() / len(self._values)
        for place, value in enumerate(self._values.tolist()):
            top = self.bar_point(place, max(value, 0)).y()
            left = area.left() + place * width
            bar = QRectF(left + 1, max(top, area.top()), width - 2, area.bottom() - max(top, area.top()))
            painter.fillRect(bar, QColor(self._theme.accent if place == self._place else self._theme.result))
            if self._measured is not None:
                y = self.bar_point(place, max(float(self._measured[place]), 0)).y()
                painter.setPen(QPen(QColor(self._theme.exemplar), 2))
                painter.drawLine(QPointF(left, y), QPointF(left + width, y))
        painter.setPen(QColor(self._theme.muted))
        flags = Qt.AlignmentFlag
        below = QRectF(area.left(), area.bottom(), area.width(), self.height() - area.bottom())
        painter.drawText(below, flags.AlignLeft | flags.AlignVCenter, "black")
        painter.drawText(below, flags.AlignRight | flags.AlignVCenter, "white")
        if self.hasFocus():
            painter.setPen(QPen(QColor(self._theme.accent), 1))
            painter.drawRect(area.adjusted(0, 0, -1, -1))
        painter.end()

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose a bar; it follows the mouse from here on."""
        place = self._place_at(event.position())
        if event.button() == Qt.MouseButton.LeftButton and place >= 0:
            self._pressed = place
            self._last = event.position()
            self._choose(place)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Draw over the bars between here and the last place, or tell which bar is under the cursor."""
        here = event.position()
        self.hovered.emit(self._place_at(here))
        if self._pressed < 0:
            return
        first, last = (self._place_at(point, clip=True) for point in (self._last, here))
        area = self._area()
        count = abs(last - first)
        drawn = {}
        # All bars on the way, but for the one that had its value before.
        for step in range(min(count, 1), count + 1):
            share = step / count if count else 1.0
            y = self._last.y() + share * (here.y() - self._last.y())
            place = first + (step if last >= first else -step)
            drawn[place] = max((area.bottom() - y) / max(area.height(), 1) * self._top, 0.0)
        self.dragged.emit(drawn)
        self._last = here
        self._pressed = last
        if self._place != last:
            self._choose(last)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the drag."""
        if self._pressed >= 0 and event.button() == Qt.MouseButton.LeftButton:
            self._pressed = -1
            self.dropped.emit()

    def leaveEvent(self, event: QEvent) -> None:
        """Tell that the cursor has left."""
        super().leaveEvent(event)
        self.hovered.emit(-1)

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it moves, changes the chosen bar, or begins a number."""
        if is_plain(event) and event.key() in SIDEWAYS:
            return bool(self._values.size)
        return self._place >= 0 and (changes_number(event) or (is_plain(event) and event.key() in UPWARDS))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Go to another bar by left and right, change it by + and - or up and down, empty it by Delete."""
        key = Qt.Key(event.key())
        steps = steps_of(event) or UPWARDS.get(key, 0)
        if not self.wants_key(event):
            super().keyPressEvent(event)
        elif key in SIDEWAYS:
            self._choose(min(max(self._place + SIDEWAYS[key], 0), len(self._values) - 1))
        elif steps:
            self.nudged.emit(self._place, steps)
        elif key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            self.emptied.emit(self._place)
        else:
            self.typed.emit(self._place, event.text() if begins_number(event) else "")

    def _choose(self, place: int) -> None:
        self._place = place
        self.update()
        self.chosen.emit(place)

    def _area(self) -> QRectF:
        return QRectF(2, 2, max(self.width() - 4, 1), max(self.height() - self.fontMetrics().height() - 4, 1))

    def _place_at(self, point: QPointF, *, clip: bool = False) -> int:
        area = self._area()
        place = int((point.x() - area.left()) / area.width() * max(len(self._values), 1) // 1)
        if clip:
            return min(max(place, 0), len(self._values) - 1)
        return place if area.contains(point) and place < len(self._values) else -1
