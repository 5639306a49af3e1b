"""A threshold table as a heat map: rows are levels, coarsest first, columns are features."""

from __future__ import annotations

import math
from collections import Counter
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from PySide6.QtCore import QEvent, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from texlab.docks.thresholds.numbers import NumberWriter
from texlab.docks.thresholds.painting import (
    CHANNEL_COLOURS,
    cell_colour,
    colours,
    draw_corner,
    draw_glyph,
    draw_lock,
    shades,
)
from texlab.docks.thresholds.table import cell_texts, runs
from texlab.style.text_size import is_teaching, tight_line
from texlab.style.theme import DARK, LIGHT

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtGui import QPaintEvent, QResizeEvent

    from texlab.docks.thresholds.table import Head, TableView
    from texlab.style.theme import Theme

GROUP_GAP = 5.0
STRIP = 3.0
COUNTED = "left"


class Grid(NamedTuple):
    """Left sides of the columns, top of the first row, size of a cell; measured for these heads."""

    lefts: tuple[float, ...]
    top: float
    width: float
    height: float
    heads: tuple[Head, ...]


class TableMap(QWidget):
    """Paints a :class:`TableView`; the small one in the form has neither numbers nor names of levels."""

    def __init__(self, name: str, label: str, *, small: bool = False, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(label)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self._small = small
        self._theme: Theme = DARK if self.palette().window().color().lightness() < 128 else LIGHT
        self._view: TableView | None = None
        self._grid: Grid | None = None
        self._writer: NumberWriter | None = None
        self._locked: frozenset[tuple[int, str]] = frozenset()
        self._shading: NDArray[np.float64] | None = None
        self._counts: tuple[str, ...] = ()
        vertical = QSizePolicy.Policy.Fixed if small else QSizePolicy.Policy.Expanding
        self.setSizePolicy(QSizePolicy.Policy.Expanding, vertical)

    @property
    def view(self) -> TableView | None:
        """What is shown."""
        return self._view

    def show_view(self, view: TableView | None) -> None:
        """Show a table."""
        before, self._view = self._view, view
        if before is None or view is None or view.values.shape != before.values.shape:
            self._grid = None
            self.updateGeometry()
        if before is None or view is None or not view.looks_like(before):
            self.update()

    def show_shading(self, shares: NDArray[np.float64] | None) -> None:
        """Colour the cells by shares (rows, columns) in 0 .. 1 instead of by their thresholds, or no longer."""
        if shares is not self._shading:
            self._shading = shares
            self.update()

    def show_counts(self, counts: tuple[str, ...]) -> None:
        """Write a number behind every row, or none."""
        if counts != self._counts:
            self._counts = counts
            self._grid = None
            self.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.update()

    def changeEvent(self, event: QEvent) -> None:
        """Follow the palette where nobody tells about the theme."""
        super().changeEvent(event)
        self._grid = None
        if event.type() == QEvent.Type.PaletteChange:
            self.set_theme(DARK if self.palette().window().color().lightness() < 128 else LIGHT)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Measure anew."""
        super().resizeEvent(event)
        self._grid = None

    def sizeHint(self) -> QSize:
        """Ask for rows that can be read."""
        rows = self._view.axes.depth if self._view is not None else 4
        if self._small:
            return QSize(200, round(self._top() + rows * (self.fontMetrics().height() + 2)))
        return QSize(520, round(self._top() + rows * 30))

    def minimumSizeHint(self) -> QSize:
        """Allow low docks; the small one keeps its height. When one teaches, have room for every name."""
        hint = self.sizeHint()
        if self._small:
            return QSize(100, hint.height())
        if self._view is None or not is_teaching():
            return QSize(200, 90)
        return QSize(*(max(pair) for pair in zip((200, 90), self._needed(self._view), strict=True)))

    def _needed(self, view: TableView) -> tuple[int, int]:
        """Return the width and height in which names of rows are whole, and the first words of groups."""
        metrics = self.fontMetrics()
        groups = Counter(head.group for head in view.heads)
        shared = [metrics.horizontalAdvance(name.split(" ")[0]) / n for name, n in groups.items() if n > 1]
        column = max(shared, default=0.0)
        columns = len(view.heads) * max(column, metrics.averageCharWidth()) + GROUP_GAP * len(groups)
        height = self._top() + self._rows() * tight_line(metrics)
        return math.ceil(self._left() + columns + self._right()), math.ceil(height)

    # Where things are.

    def cell_rect(self, row: int, column: int) -> QRectF:
        """Return where a cell is painted."""
        grid = self._geometry()
        return QRectF(grid.lefts[column], grid.top + row * grid.height, grid.width, grid.height)

    def row_rect(self, row: int) -> QRectF:
        """Return where the head of a row is painted."""
        grid = self._geometry()
        return QRectF(0, grid.top + row * grid.height, grid.lefts[0], grid.height)

    def column_rect(self, column: int) -> QRectF:
        """Return where the head of a column is painted."""
        grid = self._geometry()
        return QRectF(grid.lefts[column], 0, grid.width, grid.top)

    def at(self, x: float, y: float) -> tuple[int, int] | None:
        """Return the cell at a place; row -1 is the head of a column, column -1 that of a row."""
        if self._view is None:
            return None
        grid = self._geometry()
        row = -1 if y < grid.top else int((y - grid.top) // grid.height)
        column = int(np.searchsorted(grid.lefts, x, side="right")) - 1
        inside = row < self._view.axes.depth and x < grid.lefts[-1] + grid.width
        return (row, column) if inside and max(row, column) >= 0 else None

    def _geometry(self) -> Grid:
        """Return where the cells are; measured anew when size, font or heads are others."""
        assert self._view is not None
        heads = self._view.heads
        if self._grid is None or self._grid.heads is not heads:
            rows, columns = self._view.values.shape
            left, top = self._left(), self._top()
            gaps = [0.0, *(GROUP_GAP * (one.group != other.group) for one, other in pairwise(heads))]
            width = max(3.0, (self.width() - left - 1 - sum(gaps) - self._right()) / columns)
            lefts = left + np.arange(columns) * width + np.cumsum(gaps)
            height = max(3.0, (self.height() - top - 1) / max(rows, 1))
            self._grid = Grid(tuple(lefts.tolist()), top, width, height, heads)
        return self._grid

    def _left(self) -> float:
        if self._view is None:
            return 0.0
        metrics = self.fontMetrics()
        lines = [line for name in self._row_names() for line in name.split("\n")]
        return max((metrics.horizontalAdvance(line) for line in lines), default=0) + 8.0

    def _right(self) -> float:
        """Return the room for the numbers behind the rows."""
        if not self._counts or self._small:
            return 0.0
        metrics = self.fontMetrics()
        return max(metrics.horizontalAdvance(words) for words in (COUNTED, *self._counts)) + 10.0

    def counts_left(self) -> float:
        """Return where the numbers behind the rows begin; the right border without them."""
        return self.width() - self._right()

    def _top(self) -> float:
        return STRIP + 2.0 if self._small else self.fontMetrics().height() + self._glyph_side() + 6.0

    def _glyph_side(self) -> float:
        return self.fontMetrics().ascent() + 2.0

    def _row_names(self) -> list[str]:
        assert self._view is not None
        axes = self._view.axes
        if self._small:
            return [f"k {k}" for k in range(1, axes.depth + 1)]
        return [
            f"k {k}, level {axes.level(k)}\n{width} × {height}"
            for k, (height, width) in enumerate(axes.sizes, start=1)
        ]

    # Painting.

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint heads, cells and marks."""
        if self._view is None:
            return
        painter = QPainter(self)
        self._paint_rows(painter)
        self._paint_columns(painter)
        self._paint_cells(painter)
        self.paint_more(painter)
        if self.hasFocus() and self._small:
            painter.setPen(QPen(QColor(self._theme.accent), 1))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(self.rect().adjusted(0, 0, -1, -1))
        painter.end()

    def paint_more(self, painter: QPainter) -> None:
        """Paint what lies over the cells."""

    def _paint_rows(self, painter: QPainter) -> None:
        painter.setPen(QColor(self._theme.muted))
        flags = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        for row, name in enumerate(self._row_names()):
            area = self.row_rect(row).adjusted(0, 0, -6, 0)
            # The size of the level is left out where there is no room for two lines.
            low = area.height() < 2 * self.fontMetrics().lineSpacing()
            painter.drawText(area, flags, name.split("\n")[0] if low else name)
        room = self._right()
        if room:
            grid = self._geometry()
            right = QRectF(self.width() - room, 0, room - 2, grid.top - 2)
            painter.drawText(right, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignBottom, COUNTED)
            for row, words in enumerate(self._counts[: self._rows()]):
                painter.drawText(
                    QRectF(right.left(), self.row_rect(row).top(), right.width(), grid.height), flags, words
                )

    def _paint_columns(self, painter: QPainter) -> None:
        assert self._view is not None
        heads = self._view.heads
        glyph = self._glyph_side()
        start = 0
        for column, head in enumerate(heads):
            area = self.column_rect(column)
            colour = QColor(CHANNEL_COLOURS.get(head.group, self._theme.text))
            if self._small:
                painter.fillRect(QRectF(area.left(), 0, area.width(), STRIP), colour)
                continue
            place = QRectF(area.left() + 1, area.bottom() - glyph - 2, area.width() - 2, glyph)
            draw_glyph(painter, head.first, place, colour)
            if column + 1 == len(heads) or heads[column + 1].group != head.group:
                first = self.column_rect(start)
                self._paint_group(painter, head.group, QRectF(first.topLeft(), area.bottomRight()))
                start = column + 1

    def _paint_group(self, painter: QPainter, group: str, area: QRectF) -> None:
        metrics = self.fontMetrics()
        words = metrics.elidedText(group, Qt.TextElideMode.ElideRight, int(area.width()))
        if is_teaching() and words != group:
            # "first" says as much as "first derivative"; what cannot be read from afar the signs below tell.
            words = group.split(" ")[0]
            words = words if metrics.horizontalAdvance(words) <= area.width() else ""
        painter.setPen(QColor(self._theme.text))
        line = QRectF(area.left(), 0, area.width(), metrics.height())
        painter.drawText(line, Qt.AlignmentFlag.AlignCenter, words)

    def _paint_cells(self, painter: QPainter) -> None:
        view = self._view
        assert view is not None
        shown = self._shading if self._shading is not None and self._shading.shape == view.values.shape else None
        table = colours(view.values, self._theme) if shown is None else shades(shown, self._theme)
        writer = self._writer_for_cells()
        ink = QColor(self._theme.text)
        for row, parts in enumerate(runs(view, self._locked)):
            for first, last in parts:
                # Cells that hold the same are one field, unless their colours say more.
                fields = [(first, last)] if shown is None else [(each, each) for each in range(first, last + 1)]
                for left, right in fields:
                    area = self.cell_rect(row, left).united(self.cell_rect(row, right)).adjusted(0, 0, -1, -1)
                    painter.fillRect(area, cell_colour(*(int(part) for part in table[row, left])))
                self._paint_number(painter, writer, row, first, last)
                area = self.cell_rect(row, first).adjusted(0, 0, -1, -1)
                if view.changed[row, first]:
                    draw_corner(painter, area, QColor(self._theme.accent))
                if self._locked and all(cell in self._locked for cell in view.cells(row, first)):
                    draw_lock(painter, area, ink)

    def _paint_number(self, painter: QPainter, writer: NumberWriter, row: int, first: int, last: int) -> None:
        view = self._view
        assert view is not None
        if self._small:
            return
        painter.setPen(QColor(self._theme.text))
        area = self.cell_rect(row, first).united(self.cell_rect(row, last)).adjusted(0, 0, -1, -1)
        writer.write(painter, _texts(view, row, first), area, bold=bool(view.changed[row, first]))

    def _writer_for_cells(self) -> NumberWriter:
        if self._writer is None or self._writer.key != self.font().key():
            self._writer = NumberWriter(self.font())
        return self._writer

    def _rows(self) -> int:
        return self._view.axes.depth if self._view is not None else 0


def _texts(view: TableView, row: int, column: int) -> tuple[str, ...]:
    """Return what may be written into a cell, the fullest first."""
    return ("≠",) if view.mixed[row, column] else cell_texts(float(view.values[row, column]))
