"""A picture in which something is looked for: where it was clicked, and how long that took."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QImage, QPainter, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from texlab.widgets.plain import set_tip

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtGui import QKeyEvent, QMouseEvent, QPaintEvent

    from texlab.style.pictures import Picture

# The surround is the same grey in every theme, and as light as a middling texture.
SURROUND = QColor(128, 128, 128)
# Arrow keys move by this share of the picture's longer side, with Shift by one pixel.
STEP = 24
_MOVES = {
    Qt.Key.Key_Up: (-1, 0),
    Qt.Key.Key_Down: (1, 0),
    Qt.Key.Key_Left: (0, -1),
    Qt.Key.Key_Right: (0, 1),
}


class HiddenPicture(QWidget):
    """Shows one picture at a time in an empty grey field, and takes one answer to it.

    ``pointed(row, column, seconds)`` for a click on a pixel, or for Enter at the cross that the arrow keys move;
    ``gave_up(seconds)`` for Space. Time runs from the end of the first painting of the picture, on a clock that is
    never set. The pointer is the same cross everywhere, no other widget lies over the picture, and nothing is
    painted into it.

    Parameters
    ----------
    clock
        Seconds that never go back.
    """

    pointed = Signal(int, int, float)
    gave_up = Signal(float)

    def __init__(self, parent: QWidget | None = None, clock: Callable[[], float] = time.perf_counter) -> None:
        super().__init__(parent)
        self.setObjectName("hidden-picture")
        self.setAccessibleName("Picture")
        self.setAccessibleDescription("Arrows move a cross, Enter answers, Space: cannot tell")
        set_tip(self, "")
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(200, 200)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.CrossCursor)
        self._clock = clock
        self._picture: Picture | None = None
        self._painted_at: float | None = None
        self._cross: tuple[int, int] | None = None

    def show_picture(self, picture: Picture | None) -> None:
        """Show (H, W, 3) uint8, to be answered once; None leaves the field empty."""
        self._picture = picture
        self._painted_at = None
        self._cross = None
        self.update()

    def area(self) -> QRectF:
        """Return where the picture is, in the middle: whole pixels of the screen for each pixel, or reduced."""
        if self._picture is None:
            return QRectF()
        height, width = self._picture.shape[:2]
        scale = min(self.width() / width, self.height() / height)
        # Enlarged by parts of a screen's pixel, some pixels would be wider than others.
        whole = int(scale * self.devicePixelRatioF())
        scale = whole / self.devicePixelRatioF() if whole >= 1 else scale
        area = QRectF(0, 0, width * scale, height * scale)
        area.moveTo((self.width() - area.width()) // 2, (self.height() - area.height()) // 2)
        return area

    def _pixel(self, place: QPointF) -> tuple[int, int] | None:
        area = self.area()
        if self._picture is None or not area.contains(place):
            return None
        height, width = self._picture.shape[:2]
        row = int((place.y() - area.top()) * height / area.height())
        column = int((place.x() - area.left()) * width / area.width())
        return min(row, height - 1), min(column, width - 1)

    def _seconds(self) -> float | None:
        """Return the time since the picture was seen; None while it is not."""
        return None if self._painted_at is None else self._clock() - self._painted_at

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the field, the picture, and the cross if the keys are used."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), SURROUND)
        if self._picture is not None:
            height, width = self._picture.shape[:2]
            area = self.area()
            image = QImage(self._picture.data, width, height, 3 * width, QImage.Format.Format_RGB888)
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, area.width() < width)
            painter.drawImage(area, image)
            self._paint_cross(painter, area, width / area.width())
        painter.end()
        if self._picture is not None and self._painted_at is None:
            self._painted_at = self._clock()

    def _paint_cross(self, painter: QPainter, area: QRectF, pixels: float) -> None:
        if self._cross is None:
            return
        middle = QPointF(
            area.left() + (self._cross[1] + 0.5) / pixels, area.top() + (self._cross[0] + 0.5) / pixels
        )
        for colour, width in ((QColor("white"), 3), (QColor("black"), 1)):
            painter.setPen(QPen(colour, width))
            for across, down in ((9, 0), (0, 9)):
                arm = QPointF(across, down)
                painter.drawLine(middle - arm, middle + arm)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take a click as the answer, once the picture is seen."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._answer(self._pixel(event.position()))

    def _answer(self, place: tuple[int, int] | None) -> None:
        seconds = self._seconds()
        if place is not None and seconds is not None:
            self.show_picture(None)
            self.pointed.emit(*place, seconds)

    def give_up(self) -> None:
        """Answer that nothing can be seen."""
        seconds = self._seconds()
        if seconds is not None:
            self.show_picture(None)
            self.gave_up.emit(seconds)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move the cross, answer there, or give up."""
        key = Qt.Key(event.key())
        if self._picture is not None and key in _MOVES:
            height, width = self._picture.shape[:2]
            step = (
                1 if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else max(1, max(height, width) // STEP)
            )
            # It begins in the middle of every picture: it stands nearest to no place.
            row, column = self._cross or (height // 2, width // 2)
            down, across = _MOVES[key]
            self._cross = (
                min(max(row + step * down, 0), height - 1),
                min(max(column + step * across, 0), width - 1),
            )
            self.update()
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and not event.isAutoRepeat():
            self._answer(self._cross)
        elif key == Qt.Key.Key_Space and not event.isAutoRepeat():
            self.give_up()
        else:
            super().keyPressEvent(event)
