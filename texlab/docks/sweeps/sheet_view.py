"""A contact sheet that fills while it is looked at: pictures in a grid with captions, mouse and keyboard."""

from __future__ import annotations

import bisect
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QEvent, QPoint, QRect, QSize, Qt, Signal
from PySide6.QtGui import QColor, QContextMenuEvent, QFont, QHelpEvent, QImage, QPainter, QPixmap
from PySide6.QtWidgets import QFrame, QMenu, QScrollArea, QWidget

from texlab.style.text_size import smaller
from texlab.style.theme import DARK
from texlab.widgets.own_keys import OwnKeys, is_plain
from texlab.widgets.plain import show_tip

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from PySide6.QtGui import (
        QFontMetrics,
        QKeyEvent,
        QMouseEvent,
        QPaintEvent,
        QResizeEvent,
        QWheelEvent,
    )

    from texlab.state.sweeps import ShownCell
    from texlab.style.pictures import Picture
    from texlab.style.theme import Theme

SMALLEST, USUAL, LARGEST = 48, 112, 384
_GAP = 10
MOVES = (
    Qt.Key.Key_Left,
    Qt.Key.Key_Right,
    Qt.Key.Key_Up,
    Qt.Key.Key_Down,
    Qt.Key.Key_Home,
    Qt.Key.Key_End,
)
OPENS = (Qt.Key.Key_N, Qt.Key.Key_K)
TAKES = (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space)
NARROWEST = 76


class ContactSheetView(QScrollArea):
    """Shows the cells of a sweep in their places.

    ``taken(index)``: a finished cell was clicked, or chosen with Return. ``opened(index)``: it is wanted as a
    column (N, the middle button, the menu). ``kept(index)``: it is to be kept, or let go (K, the menu).
    ``zoom_wanted(steps)``: the wheel was turned with Ctrl held, or + or - was pressed.
    """

    taken = Signal(int)
    opened = Signal(int)
    kept = Signal(int)
    zoom_wanted = Signal(int)

    def __init__(self, name: str, empty: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.canvas = _Canvas(self, empty)
        self.canvas.setObjectName(f"{name}-canvas")
        self.setWidget(self.canvas)

    def show_grid(
        self,
        settings: Sequence[str],
        columns: int | None,
        shape: tuple[int, int],
        headings: tuple[Sequence[str], Sequence[str]] | None = None,
    ) -> None:
        """Start an empty sheet.

        Parameters
        ----------
        settings
            What was varied, one text for each cell, row by row.
        columns
            Cells in a row; None lets a series flow with the width of the window.
        shape
            Height and width of the pictures to come.
        headings
            Of the columns and of the rows of a grid: then no cell needs its setting as a caption.
        """
        self.canvas.settings = list(settings)
        self.canvas.order = list(range(len(settings)))
        self.canvas.fixed_columns = columns
        self.canvas.headings = headings
        self.canvas.kept = frozenset()
        self.canvas.shape = shape
        self.canvas.cells = {}
        self.canvas.pixmaps.clear()
        self.canvas.marked = None
        self.canvas.current = 0
        self.canvas.relayout()
        self.verticalScrollBar().setValue(0)
        self.horizontalScrollBar().setValue(0)

    def show_cells(self, cells: Mapping[int, ShownCell]) -> None:
        """Show the cells that have finished."""
        self.canvas.show_cells(cells)

    def show_order(self, order: Sequence[int] | None) -> None:
        """Show these cells in this order, as a series; None shows all in their places."""
        self.canvas.show_order(order)

    def show_kept(self, kept: Collection[int]) -> None:
        """Mark the cells that are kept with a star."""
        self.canvas.kept = frozenset(kept)
        self.canvas.update()

    def fitting_side(self, count: int, columns: int | None, largest: int, down: Sequence[str] = ()) -> int:
        """Return a size for square cells: all are in sight if that is possible, else the columns of a grid.

        Parameters
        ----------
        count, columns
            Number of cells, and of cells in a row; None for a series.
        largest
            Size beyond which the pictures would be enlarged.
        down
            Headings of the rows, which need room beside them.
        """
        width = self.width() - self.verticalScrollBar().sizeHint().width()
        width -= self.canvas.room_beside(down) - _GAP
        caption = 4 + 3 * self.canvas.fontMetrics().lineSpacing()
        for side in range(min(largest, LARGEST), USUAL, -4):
            across = columns or max(1, (width - _GAP) // (side + _GAP))
            rows = -(-count // across)
            is_wide = _GAP + across * (side + _GAP) > width
            if not is_wide and _GAP + rows * (side + caption + _GAP) <= self.height():
                return side
        return USUAL if columns is None else min(max((width - _GAP) // columns - _GAP, NARROWEST), USUAL)

    def set_side(self, side: int) -> None:
        """Show the cells at another size: the longest side of a picture in pixels."""
        self.canvas.set_side(side)

    def mark(self, index: int | None) -> None:
        """Mark the cell that has the parameters of the column."""
        if index != self.canvas.marked:
            self.canvas.marked = index
            self.canvas.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self.canvas.theme = theme
        palette = self.viewport().palette()
        palette.setColor(palette.ColorRole.Window, QColor(theme.canvas))
        self.viewport().setPalette(palette)
        self.canvas.update()

    def cell_rect(self, index: int) -> QRect:
        """Return where a cell (picture and caption) stands on the canvas."""
        return self.canvas.rect_of(index)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Let a series flow anew."""
        super().resizeEvent(event)
        self.canvas.relayout()


class _Canvas(OwnKeys, QWidget):
    """Paints only the cells that can be seen."""

    def __init__(self, view: ContactSheetView, empty: str) -> None:
        super().__init__()
        self._view = view
        self._empty = empty
        self.theme: Theme = DARK
        self.settings: list[str] = []
        # Indices of the cells in the order in which they stand; another order, or a part, has no rows and columns.
        self.order: list[int] = []
        self.is_grid = True
        self.headings: tuple[Sequence[str], Sequence[str]] | None = None
        self.kept: frozenset[int] = frozenset()
        self.fixed_columns: int | None = None
        self.shape = (1, 1)
        self.cells: dict[int, ShownCell] = {}
        self.pixmaps: dict[int, QPixmap] = {}
        self.marked: int | None = None
        self.current = 0
        self._side = USUAL
        self._columns = 1
        self._left = _GAP
        self._places: dict[int, int] = {}
        self._tops = [_GAP]
        self._lines: list[int] = []
        self._over: int | None = None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setAccessibleName("Contact sheet")
        self.setAccessibleDescription(empty)

    # Geometry.

    @property
    def columns(self) -> int:
        """Cells in a row."""
        return self._columns

    @property
    def picture_size(self) -> QSize:
        """Size at which the pictures are painted."""
        height, width = self.shape
        scale = self._side / max(height, width)
        return QSize(max(1, round(width * scale)), max(1, round(height * scale)))

    @property
    def _cell_width(self) -> int:
        return max(self.picture_size.width(), NARROWEST)

    def rect_of(self, index: int) -> QRect:
        """Return the rectangle of a cell; an empty one for a cell that is not shown."""
        if index not in self._places:
            return QRect()
        row, column = divmod(self._places[index], self._columns)
        x = self._left + column * (self._cell_width + _GAP)
        return QRect(x, self._tops[row], self._cell_width, self._tops[row + 1] - _GAP - self._tops[row])

    def index_at(self, place: QPoint) -> int | None:
        """Return the cell at a place."""
        half = _GAP // 2
        column = (place.x() - self._left + half) // (self._cell_width + _GAP)
        row = bisect.bisect_right(self._tops, place.y() + half) - 1
        at = row * self._columns + column
        inside = 0 <= column < self._columns and row >= 0
        return self.order[at] if inside and at < len(self.order) else None

    def relayout(self) -> None:
        """Place the cells anew; a row is as high as its longest caption."""
        viewport = self._view.viewport().size()
        width = self._cell_width
        fitting = max(1, (viewport.width() - _GAP) // (width + _GAP))
        fixed = self.fixed_columns if self.is_grid else None
        self._columns = fixed or min(fitting, max(len(self.order), 1))
        self._places = {index: place for place, index in enumerate(self.order)}
        line, picture = self.fontMetrics().lineSpacing(), self.picture_size.height()
        self._left = self.room_beside(self._heads[1])
        self._tops, self._lines = [_GAP + (line + _GAP // 2 if self._heads[0] else 0)], []
        for first in range(0, len(self.order), self._columns):
            self._lines.append(self._caption_lines(first))
            self._tops.append(self._tops[-1] + picture + 4 + self._lines[-1] * line + _GAP)
        wanted = QSize(self._left + self._columns * (width + _GAP), self._tops[-1]) if self.order else QSize(0, 0)
        # As large as the view where that is larger, but never so large that a scroll bar comes for nothing.
        self.resize(wanted.expandedTo(viewport))
        self.update()

    def room_beside(self, down: Sequence[str]) -> int:
        """Return where the first column begins, beside the headings of the rows."""
        widest = max(map(self.fontMetrics().horizontalAdvance, down), default=0)
        return _GAP + (min(widest, NARROWEST) + _GAP if down else 0)

    def _caption_lines(self, first: int) -> int:
        """Return how many lines the captions of the row that starts with this cell need."""
        metrics, width = self.fontMetrics(), self._cell_width
        row = self.order[first : first + self._columns]
        count = max(len(packed(self._caption(index), width, metrics)) for index in row)
        found = [len(packed(self.cells[each].cell.evidence, width, metrics)) for each in row if each in self.cells]
        return count + max(found, default=self._evidence_lines)

    @property
    def _heads(self) -> tuple[Sequence[str], Sequence[str]]:
        """Headings of the columns and of the rows, as long as the cells stand in them."""
        return self.headings if self.headings is not None and self.is_grid else ((), ())

    def _caption(self, index: int) -> str:
        """Return what is varied in a cell, where no heading says it."""
        return "" if self._heads[0] else self.settings[index]

    def show_order(self, order: Sequence[int] | None) -> None:
        """Show these cells in this order; None shows all in their places."""
        wanted = list(range(len(self.settings)) if order is None else order)
        if (wanted, order is None) == (self.order, self.is_grid):
            return
        self.order, self.is_grid = wanted, order is None
        if self.current not in wanted:
            self.current = wanted[0] if wanted else 0
        self.relayout()

    @property
    def _evidence_lines(self) -> int:
        """Lines of evidence below a cell that has not finished: as many as below the others."""
        metrics = self.fontMetrics()
        some = list(self.cells.values())[:20]
        return max((len(packed(each.cell.evidence, self._cell_width, metrics)) for each in some), default=0)

    def set_side(self, side: int) -> None:
        """Show the cells at another size, keeping the one in the middle in sight."""
        if side == self._side:
            return
        self._side = side
        self.pixmaps.clear()
        self.relayout()
        self._reveal(self.current)

    def show_cells(self, cells: Mapping[int, ShownCell]) -> None:
        """Show the cells that have finished."""
        fresh = [index for index, cell in cells.items() if self.cells.get(index) is not cell]
        self.cells = dict(cells)
        if not fresh:
            return
        for index in fresh:
            self.pixmaps.pop(index, None)
        rows = range(0, len(self.order), self._columns)
        if [self._caption_lines(first) for first in rows] != self._lines:
            self.relayout()
        for index in fresh:
            self.update(self.rect_of(index).adjusted(-4, -4, 4, 4))

    # Painting.

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the cells in the part that must be painted."""
        painter = QPainter(self)
        painter.fillRect(event.rect(), QColor(self.theme.canvas))
        if not self.settings:
            painter.setPen(QColor(self.theme.muted))
            area = self.rect().adjusted(20, 0, -20, 0)
            painter.drawText(area, Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, self._empty)
        first = max(0, bisect.bisect_right(self._tops, event.rect().top()) - 1) * self._columns
        last = bisect.bisect_right(self._tops, event.rect().bottom() + _GAP) * self._columns
        self._paint_headings(painter)
        for index in self.order[first:last]:
            if self.rect_of(index).adjusted(-4, -4, 4, 4).intersects(event.rect()):
                self._paint_cell(painter, index)
        painter.end()

    def _paint_headings(self, painter: QPainter) -> None:
        across, down = self._heads
        metrics, width = self.fontMetrics(), self._cell_width
        painter.setPen(QColor(self.theme.text))
        for column, text in enumerate(across):
            elided = metrics.elidedText(text, Qt.TextElideMode.ElideRight, width)
            area = QRect(self._left + column * (width + _GAP), _GAP // 2, width, metrics.lineSpacing())
            painter.drawText(area, Qt.AlignmentFlag.AlignCenter, elided)
        for row, text in enumerate(down):
            area = QRect(_GAP // 2, self._tops[row], self._left - _GAP, self.picture_size.height())
            flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
            painter.drawText(area, flags, text)

    def _paint_cell(self, painter: QPainter, index: int) -> None:
        theme, area = self.theme, self.rect_of(index)
        size = self.picture_size
        box = QRect(area.left() + (area.width() - size.width()) // 2, area.top(), size.width(), size.height())
        shown = self.cells.get(index)
        self._paint_frame(painter, index, area)
        if shown is None or shown.picture is None:
            painter.fillRect(box, QColor(theme.raised if shown is not None else theme.base))
        if shown is None:
            painter.setPen(QColor(theme.muted))
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, "…")
        elif shown.picture is None:
            self._paint_error(painter, box, shown.cell.error)
        else:
            painter.drawPixmap(box, self._pixmap(index, shown.picture))
        if index in self.kept:
            self._paint_star(painter, box)
        self._paint_caption(painter, area.adjusted(0, size.height() + 3, 0, 0), index, shown)

    def _paint_star(self, painter: QPainter, box: QRect) -> None:
        side = self.fontMetrics().height() + 4
        area = QRect(box.right() - side + 1, box.top(), side, side)
        painter.fillRect(area, QColor(self.theme.accent))
        painter.setPen(QColor(self.theme.accent_text))
        painter.drawText(area, Qt.AlignmentFlag.AlignCenter, "★")

    def _paint_frame(self, painter: QPainter, index: int, area: QRect) -> None:
        theme = self.theme
        if index == self.marked:
            painter.fillRect(area.adjusted(-4, -4, 4, 4), QColor(theme.accent))
        elif index == self._over:
            painter.fillRect(area.adjusted(-4, -4, 4, 4), QColor(theme.raised))
        if index == self.current and self.hasFocus():
            painter.setPen(QColor(theme.text))
            painter.drawRect(area.adjusted(-4, -4, 3, 3))

    def _paint_caption(self, painter: QPainter, area: QRect, index: int, shown: ShownCell | None) -> None:
        theme, metrics = self.theme, self.fontMetrics()
        strong, pale = (theme.text, theme.muted) if index != self.marked else (theme.accent_text,) * 2
        evidence = "" if shown is None else shown.cell.evidence
        failed = shown is not None and shown.picture is None and index != self.marked
        y = area.top() + metrics.ascent()
        for text, colour in ((self._caption(index), strong), (evidence, theme.error if failed else pale)):
            painter.setPen(QColor(colour))
            for line in packed(text, area.width(), metrics):
                elided = metrics.elidedText(line, Qt.TextElideMode.ElideRight, area.width())
                painter.drawText(area.left() + (area.width() - metrics.horizontalAdvance(elided)) // 2, y, elided)
                y += metrics.lineSpacing()

    def _paint_error(self, painter: QPainter, box: QRect, sentence: str) -> None:
        usual = painter.font()
        small = QFont(usual)
        small.setPointSizeF(smaller(usual.pointSizeF(), 0.85, 6.0))
        painter.setFont(small)
        painter.setPen(QColor(self.theme.error))
        flags = Qt.TextFlag.TextWrapAnywhere if box.width() < NARROWEST else Qt.TextFlag.TextWordWrap
        painter.save()
        painter.setClipRect(box)
        painter.drawText(box.adjusted(4, 3, -4, -3), flags, sentence)
        painter.restore()
        painter.setFont(usual)

    def _pixmap(self, index: int, picture: Picture) -> QPixmap:
        made = self.pixmaps.get(index)
        ratio = self.devicePixelRatioF()
        if made is None or made.devicePixelRatio() != ratio:
            height, width = picture.shape[:2]
            image = QImage(picture.data, width, height, 3 * width, QImage.Format.Format_RGB888)
            size = self.picture_size * ratio
            # Enlarged pixels stay pixels.
            smaller = size.width() < width
            mode = (
                Qt.TransformationMode.SmoothTransformation if smaller else Qt.TransformationMode.FastTransformation
            )
            scaled = image.scaled(size, Qt.AspectRatioMode.IgnoreAspectRatio, mode)
            made = QPixmap.fromImage(scaled)
            made.setDevicePixelRatio(ratio)
            self.pixmaps[index] = made
        return made

    # Mouse and keyboard.

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Make the cell under the pointer the current one."""
        index = self.index_at(event.position().toPoint())
        if index is not None:
            self._go(index)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Take a cell when it was clicked; with the middle button it becomes a column."""
        index = self.index_at(event.position().toPoint())
        if index is None or index != self.current:
            return
        if event.button() == Qt.MouseButton.LeftButton:
            self._tell(self._view.taken, index)
        elif event.button() == Qt.MouseButton.MiddleButton:
            self._tell(self._view.opened, index)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Offer what can be done with the cell under the pointer, or with the current one."""
        by_key = event.reason() == QContextMenuEvent.Reason.Keyboard
        index = self.current if by_key else self.index_at(event.pos())
        if index is None or self._shown_picture(index) is None:
            return
        self._go(index)
        menu = QMenu(self)
        menu.setObjectName("sweeps-cell-menu")
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for text, signal in (
            ("&Take the parameters\tReturn", self._view.taken),
            ("Open as a &new column\tN", self._view.opened),
            ("&Let go\tK" if index in self.kept else "&Keep\tK", self._view.kept),
        ):
            menu.addAction(text).triggered.connect(partial(self._tell, signal, index))
        menu.popup(self.mapToGlobal(self.rect_of(index).center()) if by_key else event.globalPos())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Light the cell under the pointer; a hand where a click takes something."""
        self._point(self.index_at(event.position().toPoint()))

    def leaveEvent(self, event: QEvent) -> None:
        """Light no cell."""
        self._point(None)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Zoom while Ctrl is held; scroll else."""
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            self._view.zoom_wanted.emit(1 if event.angleDelta().y() > 0 else -1)
            event.accept()
        else:
            super().wheelEvent(event)

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it moves, takes or zooms."""
        key, zooms = event.key(), (Qt.Key.Key_Plus, Qt.Key.Key_Equal, Qt.Key.Key_Minus)
        if not is_plain(event):
            return False
        return key in zooms or (bool(self.settings) and (key in MOVES or key in TAKES or key in OPENS))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move with the arrows, Home and End; take with Return or Space, N opens, K keeps, + and - zoom."""
        if not self.wants_key(event):
            super().keyPressEvent(event)
            return
        key = Qt.Key(event.key())
        last, at = len(self.order) - 1, self._places.get(self.current, 0)
        moves = {
            Qt.Key.Key_Left: at - 1,
            Qt.Key.Key_Right: at + 1,
            Qt.Key.Key_Up: at - self._columns,
            Qt.Key.Key_Down: at + self._columns,
            Qt.Key.Key_Home: 0,
            Qt.Key.Key_End: last,
        }
        if key in moves:
            if 0 <= moves[key] <= last:
                self._go(self.order[moves[key]])
        elif key in TAKES:
            self._tell(self._view.taken, self.current)
        elif key == Qt.Key.Key_N:
            self._tell(self._view.opened, self.current)
        elif key == Qt.Key.Key_K:
            self._tell(self._view.kept, self.current)
        else:
            self._view.zoom_wanted.emit(-1 if key == Qt.Key.Key_Minus else 1)

    def event(self, event: QEvent) -> bool:
        """Show the whole text of a cell as its tooltip."""
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            index = self.index_at(event.pos())
            show_tip(event.globalPos(), self.describe(index) if index is not None else "", self)
            return True
        return super().event(event)

    def describe(self, index: int) -> str:
        """Return everything that is known of a cell."""
        shown = self.cells.get(index)
        if shown is None:
            return f"{self.settings[index]}: not finished yet"
        if shown.picture is None:
            return f"{self.settings[index]}: {shown.cell.error}"
        star = "Kept: " if index in self.kept else ""
        return f"{star}{shown.cell.label}. Click to take the parameters."

    def _point(self, index: int | None) -> None:
        if index == self._over:
            return
        self._over = index
        can_take = index is not None and self._shown_picture(index) is not None
        self.setCursor(Qt.CursorShape.PointingHandCursor if can_take else Qt.CursorShape.ArrowCursor)
        self.update()

    def _go(self, index: int) -> None:
        self.current = index
        self.setAccessibleDescription(self.describe(index))
        self._reveal(index)
        self.update()

    def _reveal(self, index: int) -> None:
        if index in self._places:
            area = self.rect_of(index)
            middle = area.center()
            self._view.ensureVisible(middle.x(), middle.y(), area.width() // 2 + _GAP, area.height() // 2 + _GAP)

    def _shown_picture(self, index: int) -> Picture | None:
        shown = self.cells.get(index)
        return None if shown is None else shown.picture

    def _tell(self, signal: Any, index: int, _: bool = False) -> None:
        """Tell what is wanted of a cell, once there is something to want."""
        if self._shown_picture(index) is not None and index in self._places:
            signal.emit(index)


def packed(text: str, width: int, metrics: QFontMetrics) -> list[str]:
    """Break a text at its commas into lines that fit ``width`` pixels; what is still too wide, at its spaces."""
    lines: list[str] = []
    for part in text.split(", ") if text else []:
        joined = f"{lines[-1]}, {part}" if lines else part
        if lines and metrics.horizontalAdvance(joined) <= width:
            lines[-1] = joined
            continue
        words = part.split()
        lines.append(words[0])
        for word in words[1:]:
            if metrics.horizontalAdvance(f"{lines[-1]} {word}") <= width:
                lines[-1] += f" {word}"
            else:
                lines.append(word)
    return lines
