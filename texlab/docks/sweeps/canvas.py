"""The canvas of a contact sheet: paints the cells that can be seen; mouse and keyboard."""

from __future__ import annotations

import bisect
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QRect, Qt, Signal, SignalInstance
from PySide6.QtGui import QColor, QContextMenuEvent, QFont, QHelpEvent, QImage, QPainter, QPixmap
from PySide6.QtWidgets import QMenu, QScrollArea

from texlab.docks.sweeps.places import GAP, NARROWEST, CellPlaces, packed
from texlab.style.text_size import smaller
from texlab.style.theme import DARK
from texlab.widgets.own_keys import OwnKeys, is_plain
from texlab.widgets.plain import show_tip

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtGui import QKeyEvent, QMouseEvent, QPaintEvent, QWheelEvent

    from texlab.state.sweeps import ShownCell
    from texlab.style.pictures import Picture
    from texlab.style.theme import Theme

MOVES = (
    Qt.Key.Key_Left,
    Qt.Key.Key_Right,
    Qt.Key.Key_Up,
    Qt.Key.Key_Down,
    Qt.Key.Key_Home,
    Qt.Key.Key_End,
)
OPENS = (Qt.Key.Key_N, Qt.Key.Key_K, Qt.Key.Key_C)
TAKES = (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space)


class SheetCanvas(OwnKeys, CellPlaces):
    """Paints only the cells that can be seen; its signals are those of the view."""

    taken = Signal(int)
    opened = Signal(int)
    opened_here = Signal(int)
    kept_turned = Signal(int)
    compared = Signal()
    zoom_wanted = Signal(int)

    def __init__(self, area: QScrollArea, empty: str) -> None:
        super().__init__(area)
        self._empty = empty
        self.theme: Theme = DARK
        self.taken_words = "parameters"
        self.is_elsewhere: Callable[[int], bool] = lambda index: False
        """Whether a cell is of another texture than the columns, and so opens in a window of its own."""
        self._over: int | None = None
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setAccessibleName("Contact sheet")
        self.setAccessibleDescription(empty)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the cells in the part that must be painted."""
        painter = QPainter(self)
        painter.fillRect(event.rect(), QColor(self.theme.canvas))
        if not self.settings:
            painter.setPen(QColor(self.theme.muted))
            area = self.rect().adjusted(20, 0, -20, 0)
            painter.drawText(area, Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, self._empty)
        first = max(0, bisect.bisect_right(self._tops, event.rect().top()) - 1) * self._columns
        last = bisect.bisect_right(self._tops, event.rect().bottom() + GAP) * self._columns
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
            area = QRect(self._left + column * (width + GAP), GAP // 2, width, metrics.lineSpacing())
            painter.drawText(area, Qt.AlignmentFlag.AlignCenter, elided)
        for row, text in enumerate(down):
            area = QRect(GAP // 2, self._tops[row], self._left - GAP, self.picture_size.height())
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
            self._tell(self.taken, index)
        elif event.button() == Qt.MouseButton.MiddleButton:
            self._tell(self.opened, index)

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
        elsewhere = self.is_elsewhere(index)
        opens = [("Open in a &new window\tN" if elsewhere else "Open as a &new column\tN", self.opened)]
        if elsewhere:
            opens.append(("Open as a &column here: all columns take its texture", self.opened_here))
        for text, signal in (
            (f"&Take the {self.taken_words}\tReturn", self.taken),
            *opens,
            ("&Let go\tK" if index in self.kept else "&Keep\tK", self.kept_turned),
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
            self.zoom_wanted.emit(1 if event.angleDelta().y() > 0 else -1)
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
        """Move with arrows, Home, End; Return or Space takes; N, K, C: open, keep, compare; + and - zoom."""
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
            self._tell(self.taken, self.current)
        elif key == Qt.Key.Key_N:
            self._tell(self.opened, self.current)
        elif key == Qt.Key.Key_K:
            self._tell(self.kept_turned, self.current)
        elif key == Qt.Key.Key_C:
            self.compared.emit()
        else:
            self.zoom_wanted.emit(-1 if key == Qt.Key.Key_Minus else 1)

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
        return f"{star}{shown.cell.label}. Click to take the {self.taken_words}."

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

    def _shown_picture(self, index: int) -> Picture | None:
        shown = self.cells.get(index)
        return None if shown is None else shown.picture

    def _tell(self, signal: SignalInstance, index: int, _: bool = False) -> None:
        """Tell what is wanted of a cell, once there is something to want."""
        if self._shown_picture(index) is not None and index in self._places:
            signal.emit(index)
