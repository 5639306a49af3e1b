"""Pictures that the hand moves: slices with a cross-hair, and an object that is turned."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QPen

from texlab.widgets.own_keys import OwnKeys, is_plain
from texlab.widgets.picture_area import PictureArea

if TYPE_CHECKING:
    from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QWheelEvent
    from PySide6.QtWidgets import QWidget

    from texlab.style.pictures import Picture

# A notch of the wheel.
_NOTCH = 120
_TURN_DEGREES = 0.5
_KEY_DEGREES = 10.0
_ZOOM = 1.1
_MOVES = {
    Qt.Key.Key_Left: (0, -1),
    Qt.Key.Key_Right: (0, 1),
    Qt.Key.Key_Up: (-1, 0),
    Qt.Key.Key_Down: (1, 0),
}
_TURNS = {
    Qt.Key.Key_Left: (-_KEY_DEGREES, 0.0),
    Qt.Key.Key_Right: (_KEY_DEGREES, 0.0),
    Qt.Key.Key_Up: (0.0, -_KEY_DEGREES),
    Qt.Key.Key_Down: (0.0, _KEY_DEGREES),
}


class SlicePane(OwnKeys, PictureArea):
    """A slice with its cross-hair: dragging moves it, the wheel goes through the slices.

    ``moved(row, column)`` tells where the cross-hair shall be in this picture, ``stepped(by)`` how many slices to
    go on; ``released()`` that a drag has ended.
    """

    moved = Signal(int, int)
    stepped = Signal(int)
    released = Signal()

    def __init__(self, name: str, caption: str, parent: QWidget | None = None) -> None:
        tip = (
            "Drag or use the arrow keys to move the cross-hairs; the wheel, Page Up and Page Down go through the"
            " slices; Home goes to the middle"
        )
        super().__init__(name, caption, tip, parent)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.CrossCursor)
        self.cross = (0, 0)
        self.shape = (1, 1)
        self._wheel = 0

    def show_slice(self, picture: Picture | None, cross: tuple[int, int], caption: str) -> None:
        """Show a slice with its cross-hair at (row, column)."""
        self.cross, self.caption = cross, caption
        if picture is not None:
            self.shape = picture.shape[:2]
        self.set_picture(picture)

    def place_of(self, row: int, column: int) -> QPoint:
        """Return where the middle of a voxel is painted."""
        area = self.area()
        height, width = self.shape
        x = area.x() + (column + 0.5) * area.width() / width
        return QPointF(x, area.y() + (row + 0.5) * area.height() / height).toPoint()

    def paint_marks(self, painter: QPainter, area: QRectF) -> None:
        """Paint the cross-hair, dark below light, so that it is seen on any texture."""
        height, width = self.shape
        x = area.x() + (self.cross[1] + 0.5) * area.width() / width
        y = area.y() + (self.cross[0] + 0.5) * area.height() / height
        for colour, thickness in ((QColor(0, 0, 0, 110), 3), (QColor("#ffb020"), 1)):
            painter.setPen(QPen(colour, thickness))
            painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()))
            painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y))

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take the cross-hair."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._move_to(event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Move the cross-hair along."""
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._move_to(event.position())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """End the drag."""
        if event.button() == Qt.MouseButton.LeftButton:
            self.released.emit()

    def _move_to(self, point: QPointF) -> None:
        area = self.area()
        height, width = self.shape
        if self.picture is not None and not area.isEmpty():
            row = int((point.y() - area.y()) * height / area.height())
            column = int((point.x() - area.x()) * width / area.width())
            self.moved.emit(min(max(row, 0), height - 1), min(max(column, 0), width - 1))

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Go through the slices."""
        self._wheel += event.angleDelta().y()
        steps, self._wheel = int(self._wheel / _NOTCH), self._wheel - _NOTCH * int(self._wheel / _NOTCH)
        if steps:
            self.stepped.emit(-steps)
        event.accept()

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it moves the cross-hair or goes through the slices."""
        key, others = Qt.Key(event.key()), (Qt.Key.Key_PageUp, Qt.Key.Key_PageDown, Qt.Key.Key_Home)
        return is_plain(event) and (key in _MOVES or key in others)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move by the keyboard."""
        row, column = self.cross
        key = Qt.Key(event.key())
        if not self.wants_key(event):
            super().keyPressEvent(event)
        elif key in _MOVES:
            height, width = self.shape
            down, right = _MOVES[key]
            self.moved.emit(min(max(row + down, 0), height - 1), min(max(column + right, 0), width - 1))
        elif key in (Qt.Key.Key_PageUp, Qt.Key.Key_PageDown):
            self.stepped.emit(1 if key == Qt.Key.Key_PageDown else -1)
        else:
            self.moved.emit(self.shape[0] // 2, self.shape[1] // 2)


class ObjectPane(OwnKeys, PictureArea):
    """A shaded object: ``turned(yaw, pitch)`` in degrees, ``zoomed(factor)``, ``released()`` after a drag."""

    turned = Signal(float, float)
    zoomed = Signal(float)
    homed = Signal()
    released = Signal()

    def __init__(self, name: str, caption: str, parent: QWidget | None = None) -> None:
        tip = "Drag or use the arrow keys to turn it; the wheel, + and - bring it nearer; Home turns it back"
        super().__init__(name, caption, tip, parent)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.OpenHandCursor)
        self._last: QPointF | None = None

    @property
    def dragging(self) -> bool:
        """Whether the button is down."""
        return self._last is not None

    def side(self, most: int) -> int:
        """Return the side of the square that is drawn, in pixels of the screen."""
        room = min(self.width() - 4, self.height() - 4 - self.caption_height)
        return min(max(round(room * self.devicePixelRatioF()), 32), most)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take hold of the object."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._last = event.position()
            self.setCursor(Qt.CursorShape.ClosedHandCursor)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Turn it along."""
        if self._last is not None:
            way = event.position() - self._last
            self._last = event.position()
            self.turned.emit(_TURN_DEGREES * way.x(), _TURN_DEGREES * way.y())

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let go of it."""
        if event.button() == Qt.MouseButton.LeftButton and self._last is not None:
            self._last = None
            self.setCursor(Qt.CursorShape.OpenHandCursor)
            self.released.emit()

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Bring it nearer."""
        self.zoomed.emit(_ZOOM ** (event.angleDelta().y() / _NOTCH))
        event.accept()

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it turns the object or brings it nearer."""
        key, others = Qt.Key(event.key()), (Qt.Key.Key_Plus, Qt.Key.Key_Minus, Qt.Key.Key_Home)
        return is_plain(event) and (key in _TURNS or key in others)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Turn it by the keyboard."""
        key = Qt.Key(event.key())
        if not self.wants_key(event):
            super().keyPressEvent(event)
        elif key in _TURNS:
            self.turned.emit(*_TURNS[key])
        elif key in (Qt.Key.Key_Plus, Qt.Key.Key_Minus):
            self.zoomed.emit(_ZOOM if key == Qt.Key.Key_Plus else 1 / _ZOOM)
        else:
            self.homed.emit()
