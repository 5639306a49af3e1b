"""A small table of numbers as coloured cells, for mouse and keyboard."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QEvent, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from texlab.style.colouring import ink_on, paint
from texlab.style.text_size import is_teaching, tight_line
from texlab.widgets.own_keys import OwnKeys, is_plain
from texlab.widgets.tables import add_copying

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray
    from PySide6.QtGui import QKeyEvent, QPaintEvent

    from texlab.style.theme import Theme

# Between the words of two cells.
PADDING = 4
ARROWS = {
    Qt.Key.Key_Left: (0, -1),
    Qt.Key.Key_Right: (0, 1),
    Qt.Key.Key_Up: (-1, 0),
    Qt.Key.Key_Down: (1, 0),
}


class HeatMap(OwnKeys, QWidget):
    """Cells with a colour and a number each; ``chosen`` and ``hovered`` tell (row, column), -1 for none."""

    chosen = Signal(int, int)
    hovered = Signal(int, int)

    def __init__(self, name: str, label: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(label)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.least = QSize(120, 60)
        self._needed = QSize()
        self._theme: Theme | None = None
        self._places: NDArray[np.float32] = np.zeros((0, 0), np.float32)
        self._colours: NDArray[np.uint8] = np.zeros((0, 0, 3), np.uint8)
        self._texts: list[list[str]] = []
        self._rows: list[str] = []
        self._columns: list[str] = []
        self._selected: tuple[int, int] | None = None
        add_copying(self, self.as_text)

    def as_text(self) -> str:
        """Return the cells with the names of rows and columns: tabs between columns, a line for each row."""
        rows = [
            ["", *self._columns],
            *([name, *texts] for name, texts in zip(self._rows, self._texts, strict=False)),
        ]
        return "".join("\t".join(" ".join(cell.split()) for cell in row) + "\n" for row in rows)

    def show_cells(
        self,
        places: NDArray[Any],
        texts: Sequence[Sequence[str]],
        rows: Sequence[str],
        columns: Sequence[str],
        table: NDArray[np.uint8],
    ) -> None:
        """Show cells.

        Parameters
        ----------
        places
            (R, C), place of each cell's colour in the table, 0 .. 1; NaN leaves a cell out.
        texts
            What is written into the cells.
        rows, columns
            Names of rows and columns.
        table
            (size, 3) uint8.
        """
        self._places = np.asarray(places, np.float32)
        self._colours = paint(self._places, table)
        self._texts = [list(row) for row in texts]
        self._rows, self._columns = list(rows), list(columns)
        if self._selected is not None and not self._exists(*self._selected):
            self._selected = None
        self._ask_for_room()
        self.update()

    @property
    def selected(self) -> tuple[int, int] | None:
        """Row and column of the chosen cell."""
        return self._selected

    def select(self, cell: tuple[int, int] | None) -> None:
        """Mark a cell without telling anyone."""
        self._selected = cell if cell is not None and self._exists(*cell) else None
        self.update()

    def text(self, row: int, column: int) -> str:
        """Return what is written in a cell."""
        return self._texts[row][column]

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.update()

    def sizeHint(self) -> QSize:
        """Ask for cells that hold their numbers."""
        rows, columns = self._places.shape
        return QSize(60 + 46 * max(columns, 2), 24 + 22 * max(rows, 3))

    def minimumSizeHint(self) -> QSize:
        """Return the least size; when one teaches, what every name and number has room in."""
        needed = self._needed if is_teaching() else QSize()
        return self.least.expandedTo(needed)

    def _ask_for_room(self) -> None:
        metrics = self.fontMetrics()
        left, top, _, _ = self._geometry()
        words = [*self._columns, *(text for row in self._texts for text in row)]
        width = max((metrics.horizontalAdvance(each) for each in words), default=0) + PADDING
        rows, columns = self._places.shape
        needed = QSize(math.ceil(left + columns * width), math.ceil(top + rows * (tight_line(metrics) + 1)))
        if needed != self._needed:
            self._needed = needed
            self.updateGeometry()

    def changeEvent(self, event: QEvent) -> None:
        """Ask for room for other letters."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self._ask_for_room()

    def cell_rect(self, row: int, column: int) -> QRectF:
        """Return where a cell is painted."""
        left, top, width, height = self._geometry()
        return QRectF(left + column * width, top + row * height, width, height)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint names, cells and numbers."""
        if self._theme is None or not self._places.size:
            return
        painter = QPainter(self)
        left, top, width, height = self._geometry()
        metrics = self.fontMetrics()
        painter.setPen(QColor(self._theme.muted))
        middle = Qt.AlignmentFlag.AlignCenter
        for row, name in enumerate(self._rows):
            area = QRectF(0, top + row * height, left - 6, height)
            painter.drawText(area, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, name)
        for column, name in enumerate(self._columns):
            if metrics.horizontalAdvance(name) <= width:
                painter.drawText(QRectF(left + column * width, 0, width, top), middle, name)
        for row, column in np.argwhere(np.isfinite(self._places)).tolist():
            self._paint_cell(painter, row, column)
        if self._selected is not None:
            pen = QPen(QColor(self._theme.accent), 3)
            painter.setPen(pen)
            painter.drawRect(self.cell_rect(*self._selected).adjusted(1, 1, -2, -2))
        painter.end()

    def _paint_cell(self, painter: QPainter, row: int, column: int) -> None:
        area = self.cell_rect(row, column).adjusted(0, 0, -1, -1)
        red, green, blue = (int(part) for part in self._colours[row, column])
        painter.fillRect(area, QColor(red, green, blue))
        words = self._texts[row][column]
        metrics = self.fontMetrics()
        if metrics.horizontalAdvance(words) <= area.width() and tight_line(metrics) <= area.height() + 1:
            painter.setPen(QColor(ink_on(red, green, blue)))
            painter.drawText(area, Qt.AlignmentFlag.AlignCenter, words)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Tell which cell is under the cursor."""
        self.hovered.emit(*(self._cell_at(event) or (-1, -1)))

    def leaveEvent(self, event: QEvent) -> None:
        """Tell that the cursor has left."""
        self.hovered.emit(-1, -1)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose the cell under the cursor."""
        if (cell := self._cell_at(event)) is not None:
            self._choose(*cell)

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it leads to another cell."""
        return is_plain(event) and event.key() in ARROWS and bool(self._places.size)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move with the arrow keys."""
        step = ARROWS.get(Qt.Key(event.key()))
        if step is None or not self.wants_key(event):
            super().keyPressEvent(event)
            return
        row, column = self._selected or (0, 0)
        if self._selected is not None:
            row, column = row + step[0], column + step[1]
        row = min(max(row, 0), self._places.shape[0] - 1)
        # A row may have fewer cells (residuals have one): the last of them is taken.
        known = np.flatnonzero(np.isfinite(self._places[row]))
        if known.size:
            self._choose(row, int(known[np.argmin(np.abs(known - column))]))

    def _choose(self, row: int, column: int) -> None:
        self._selected = (row, column)
        self.update()
        self.chosen.emit(row, column)

    def _exists(self, row: int, column: int) -> bool:
        rows, columns = self._places.shape
        return 0 <= row < rows and 0 <= column < columns and bool(np.isfinite(self._places[row, column]))

    def _cell_at(self, event: QMouseEvent) -> tuple[int, int] | None:
        left, top, width, height = self._geometry()
        point = event.position()
        row, column = int((point.y() - top) // height), int((point.x() - left) // width)
        return (row, column) if self._exists(row, column) else None

    def _geometry(self) -> tuple[float, float, float, float]:
        """Return left and top of the first cell, width and height of each."""
        metrics = self.fontMetrics()
        left = max((metrics.horizontalAdvance(name) for name in self._rows), default=0) + 10.0
        top = (tight_line(metrics) if is_teaching() else metrics.height()) + 2.0 if any(self._columns) else 2.0
        rows, columns = (max(1, side) for side in self._places.shape)
        return left, top, max(4.0, (self.width() - left) / columns), max(4.0, (self.height() - top) / rows)
