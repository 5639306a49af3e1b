"""A joint or conditional histogram on which a rectangle of cells is chosen, by mouse and keyboard."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QImage, QKeyEvent, QPainter, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from texlab.style.colouring import HISTOGRAM_TABLES, paint
from texlab.style.theme import DARK, LIGHT
from texlab.widgets.own_keys import OwnKeys, is_plain
from texlab.widgets.plain import set_tip
from texlab_core.stats.dependence import AXES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray
    from PySide6.QtGui import QMouseEvent, QPaintEvent

    from texlab.style.theme import Theme
    from texlab_core.stats.dependence import Dependence, Rectangle

ARROWS = {
    Qt.Key.Key_Left: (0, -1),
    Qt.Key.Key_Right: (0, 1),
    Qt.Key.Key_Up: (1, 0),
    Qt.Key.Key_Down: (-1, 0),
}
# Cells with fewer samples than this give no mean that is worth drawing.
FEWEST = 1e-4
MARK = "#ff4fa3"
BRUSH = "#ffb347"
TICKS = {"coefficients": (-4, -2, 0, 2, 4), "magnitudes": (-4, -2, 0, 2), "ranks": (0, 1)}
UNITS = {
    "coefficients": "in standard deviations",
    "magnitudes": "as powers of two of the root mean square",
    "ranks": "by rank",
}


class JointView(OwnKeys, QWidget):
    """Shows a histogram, low values on the left and below.

    ``brushed(rectangle)``: the cells that the user chose, first and last row and column, or None for none.
    ``pointed(row, column)``: the cell under the pointer, -1 for none.
    """

    brushed = Signal(object)
    pointed = Signal(int, int)

    def __init__(self, name: str, label: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(label)
        set_tip(
            self,
            "What is given grows to the right, what is looked at upwards. Drag over cells to see where their "
            "pixels are, here and in the columns, or use the arrow keys (with Shift for more); Escape lets go.",
        )
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self._theme: Theme = DARK if self.palette().window().color().lightness() < 128 else LIGHT
        self._found: Dependence | None = None
        self._conditional = True
        self._curves = True
        self._image: QImage | None = None
        self._brush: Rectangle | None = None
        self._anchor: tuple[int, int] | None = None
        self._end = (0, 0)
        self._pressed = False
        self._cells: tuple[tuple[int, int], ...] = ()

    @property
    def found(self) -> Dependence | None:
        """What is shown."""
        return self._found

    @property
    def brush(self) -> Rectangle | None:
        """The chosen cells."""
        return self._brush

    @property
    def cells(self) -> tuple[tuple[int, int], ...]:
        """The cells that are marked, since a pixel lies in them."""
        return self._cells

    def show_found(self, found: Dependence | None, *, conditional: bool, curves: bool) -> None:
        """Show the joint or the conditional histogram, with mean and standard deviation of every column or not."""
        if found is not self._found or conditional != self._conditional:
            self._image = None
        self._found, self._conditional, self._curves = found, conditional, curves
        if found is not None and self._brush is not None and max(self._brush) >= len(found.joint):
            self._brush = None
        self._describe()
        self.update()

    def show_brush(self, brush: Rectangle | None) -> None:
        """Choose cells without telling anyone."""
        if not self._pressed and brush != self._brush:
            self._brush = brush
            if brush is not None:
                self._anchor, self._end = (brush[0], brush[2]), (brush[1], brush[3])
            self._describe()
            self.update()

    def mark(self, cells: Sequence[tuple[int, int]]) -> None:
        """Mark cells, since a pixel lies in them."""
        if tuple(cells) != self._cells:
            self._cells = tuple(cells)
            self.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme, self._image = theme, None
        self.update()

    def sizeHint(self) -> QSize:
        """Ask for a square."""
        return QSize(180, 180)

    def minimumSizeHint(self) -> QSize:
        """Return what cells and a few numbers need."""
        metrics = self.fontMetrics()
        side = max(60, 2 * metrics.height())
        return QSize(side + metrics.horizontalAdvance("-4") + 7, side + metrics.height() + 3)

    # Where things are.

    def area(self) -> QRectF:
        """Return the square in which the histogram is painted."""
        metrics = self.fontMetrics()
        left, below = metrics.horizontalAdvance("-4") + 5.0, metrics.height() + 1.0
        side = max(8.0, min(self.width() - left - 4, self.height() - below - 2))
        return QRectF(left, 1, side, side)

    def cell_rect(self, row: int, column: int) -> QRectF:
        """Return where a cell is painted."""
        area, count = self.area(), self._count()
        step = area.width() / count
        return QRectF(area.left() + column * step, area.bottom() - (row + 1) * step, step, step)

    def _count(self) -> int:
        return len(self._found.joint) if self._found is not None else 1

    def _cell(self, place: QPointF, *, held: bool = False) -> tuple[int, int] | None:
        """Return the cell at a place; while the button is held, the nearest one."""
        area, count = self.area(), self._count()
        if self._found is None or not (held or area.contains(place)):
            return None
        column = int((place.x() - area.left()) / area.width() * count)
        row = int((area.bottom() - place.y()) / area.height() * count)
        return min(max(row, 0), count - 1), min(max(column, 0), count - 1)

    # Words.

    def describe(self, row: int, column: int) -> str:
        """Return what a cell is and holds, in words."""
        found = self._found
        if found is None or row < 0:
            return ""
        count, low, high = AXES[found.values]
        step = (high - low) / count
        upper, right = low + row * step, low + column * step
        share = found.joint[row, column]
        return (
            f"given {right:.2g} to {right + step:.2g}, looked at {upper:.2g} to {upper + step:.2g} "
            f"({UNITS[found.values]}): {share:.2%} of all, {found.conditional[row, column]:.1%} of the column"
        )

    def _describe(self) -> None:
        if self._brush is None or self._found is None:
            self.setAccessibleDescription("No cells are chosen")
            return
        top, bottom, left, right = self._brush
        share = float(self._found.joint[top : bottom + 1, left : right + 1].sum())
        self.setAccessibleDescription(
            f"Rows {top + 1} to {bottom + 1}, columns {left + 1} to {right + 1} are chosen: {share:.2%} of all"
        )

    # Mouse and keyboard.

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin to choose cells; a press beside the histogram lets go."""
        if event.button() != Qt.MouseButton.LeftButton:
            return
        cell = self._cell(event.position())
        if cell is None or self._brush == (cell[0], cell[0], cell[1], cell[1]):
            self._choose(None)
            return
        self._pressed = True
        self._anchor = cell
        self._span(cell)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Choose more cells, or tell which one is under the pointer."""
        if self._pressed:
            cell = self._cell(event.position(), held=True)
            assert cell is not None
            self._span(cell)
            return
        self.pointed.emit(*(self._cell(event.position()) or (-1, -1)))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Keep what is chosen."""
        self._pressed = False

    def leaveEvent(self, event: QEvent) -> None:
        """Tell that the pointer has left."""
        self.pointed.emit(-1, -1)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move or extend what is chosen, or let go."""
        key = Qt.Key(event.key())
        if not self.wants_key(event):
            super().keyPressEvent(event)
        elif key == Qt.Key.Key_Escape:
            self._choose(None)
        else:
            last = self._count() - 1
            row, column = self._end if self._brush is not None else (last // 2, last // 2)
            if self._brush is not None:
                row, column = row + ARROWS[key][0], column + ARROWS[key][1]
            cell = min(max(row, 0), last), min(max(column, 0), last)
            if self._brush is None or not event.modifiers() & Qt.KeyboardModifier.ShiftModifier:
                self._anchor = cell
            self._span(cell)

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it moves or extends what is chosen, or lets go of it."""
        key = Qt.Key(event.key())
        if self._found is None or not is_plain(event):
            return False
        return key in ARROWS or (key == Qt.Key.Key_Escape and self._brush is not None)

    def _span(self, cell: tuple[int, int]) -> None:
        assert self._anchor is not None
        self._end = cell
        rows, columns = sorted((self._anchor[0], cell[0])), sorted((self._anchor[1], cell[1]))
        self._choose((rows[0], rows[1], columns[0], columns[1]))

    def _choose(self, brush: Rectangle | None) -> None:
        if brush != self._brush:
            self._brush = brush
            self._describe()
            self.update()
            self.brushed.emit(brush)

    # Painting.

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint axes, cells, curves and marks."""
        if self._found is None:
            return
        painter = QPainter(self)
        area = self.area()
        painter.drawImage(area, self._painted(self._found))
        self._paint_axes(painter, area, self._found)
        if self._curves and self._conditional:
            self._paint_curves(painter, area, self._found)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        if self._brush is not None:
            top, bottom, left, right = self._brush
            self._frame(painter, self.cell_rect(bottom, left).united(self.cell_rect(top, right)), BRUSH)
        for cell in self._cells:
            self._frame(painter, self.cell_rect(*cell).adjusted(-2, -2, 2, 2), MARK)
        if self.hasFocus():
            painter.setPen(QPen(QColor(self._theme.accent), 2))
            painter.drawRect(area)
        painter.end()

    def _painted(self, found: Dependence) -> QImage:
        """Return the cells as an image, the lowest row at the bottom; kept until something else is shown."""
        if self._image is None:
            places = shares(found, conditional=self._conditional)[::-1].astype(np.float32)
            colours = np.ascontiguousarray(paint(places, HISTOGRAM_TABLES[self._theme.name]))
            rows, columns = places.shape
            # The copy holds the pixels.
            self._image = QImage(colours.data, columns, rows, 3 * columns, QImage.Format.Format_RGB888).copy()
        return self._image

    def _paint_axes(self, painter: QPainter, area: QRectF, found: Dependence) -> None:
        _, low, high = AXES[found.values]
        metrics = self.fontMetrics()
        painter.setPen(QColor(self._theme.border))
        painter.drawRect(area)
        for tick in TICKS[found.values]:
            share = (tick - low) / (high - low)
            words, half = f"{tick}", metrics.horizontalAdvance(f"{tick}") / 2
            x, y = area.left() + share * area.width(), area.bottom() - share * area.height()
            painter.setPen(QColor(self._theme.muted))
            left = min(max(x - half, 0), self.width() - 2 * half)
            painter.drawText(QPointF(left, area.bottom() + metrics.ascent() + 1), words)
            baseline = min(max(y + metrics.ascent() / 2 - 1, metrics.ascent()), area.bottom())
            painter.drawText(QPointF(area.left() - 4 - 2 * half, baseline), words)

    def _paint_curves(self, painter: QPainter, area: QRectF, found: Dependence) -> None:
        """Draw mean (solid) and mean plus and minus the standard deviation (dashed) of every column."""
        count, low, high = AXES[found.values]
        there = np.flatnonzero(found.joint.sum(axis=0) > FEWEST)
        painter.save()
        painter.setClipRect(area)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for sign, style in ((0, Qt.PenStyle.SolidLine), (1, Qt.PenStyle.DashLine), (-1, Qt.PenStyle.DashLine)):
            heights = (found.means + sign * found.spreads - low) / (high - low)
            points = [
                QPointF(
                    area.left() + (column + 0.5) / count * area.width(),
                    area.bottom() - float(heights[column]) * area.height(),
                )
                for column in there.tolist()
            ]
            pen = QPen(QColor(self._theme.result), 1.6, style)
            painter.setPen(pen)
            painter.drawPolyline(QPolygonF(points))
        painter.restore()

    @staticmethod
    def _frame(painter: QPainter, area: QRectF, colour: str) -> None:
        """Draw a bright line on a dark one: seen on every colour."""
        for each, width in (("#000000", 4), (colour, 2)):
            painter.setPen(QPen(QColor(each), width))
            painter.drawRect(area)


def shares(found: Dependence, *, conditional: bool) -> NDArray[np.float64]:
    """Return how strongly every cell (R, C) is painted, 0 .. 1.

    The joint histogram by the root of its shares, or its peak would hide all else; every column of the conditional
    one up to its own largest share.
    """
    if not conditional:
        return np.sqrt(found.joint / max(float(found.joint.max()), 1e-12))
    columns = found.conditional
    largest = columns.max(axis=0)
    return columns / np.where(largest > 0, largest, 1)
