"""A magnifier that shows the same place of every picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QRect, Qt
from PySide6.QtGui import QColor, QImage, QPainter
from PySide6.QtWidgets import QWidget

if TYPE_CHECKING:
    from PySide6.QtGui import QPaintEvent

    from texlab.style.pictures import Picture

# Pixels of the picture across, and of the screen for each.
ACROSS = 17
ENLARGED = 8
EDGE = "#ffd54a"


def piece_around(picture: Picture, row: int, column: int, across: int = ACROSS) -> tuple[Picture, int, int]:
    """Return what lies around a pixel, and the row and column of the pixel in it.

    Parameters
    ----------
    picture
        (H, W, 3) uint8.
    row, column
        The pixel, inside the picture.
    across
        Rows and columns at most; fewer at the edges of the picture.
    """
    half = across // 2
    top, left = max(row - half, 0), max(column - half, 0)
    return picture[top : row + half + 1, left : column + half + 1], row - top, column - left


class Magnifier(QWidget):
    """Paints the surroundings of a pixel in the lower right corner of its parent; lets the mouse through."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("magnifier")
        self.setAccessibleName("Magnifier")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.piece: Picture | None = None
        self._centre = (0, 0)
        self.hide()

    def look(self, picture: Picture | None, row: int, column: int) -> None:
        """Show what is around a pixel; outside of the picture nothing."""
        inside = picture is not None and 0 <= row < picture.shape[0] and 0 <= column < picture.shape[1]
        if not inside or picture is None:
            self.piece = None
            self.hide()
            return
        piece, *centre = piece_around(picture, row, column)
        self.piece, self._centre = piece.copy(), (centre[0], centre[1])
        parent = self.parentWidget()
        assert parent is not None
        side = min(ACROSS * ENLARGED, parent.width() // 2, parent.height() // 2)
        self.setGeometry(parent.width() - side - 2, parent.height() - side - 2, side, side)
        self.show()
        self.raise_()
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint every pixel as a square, the middle one framed."""
        if self.piece is None:
            return
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor("#777777"))
        height, width = self.piece.shape[:2]
        scale = self.width() / ACROSS
        half = ACROSS // 2
        left, top = (half - self._centre[1]) * scale, (half - self._centre[0]) * scale
        image = QImage(self.piece.tobytes(), width, height, 3 * width, QImage.Format.Format_RGB888)
        painter.drawImage(QRect(round(left), round(top), round(width * scale), round(height * scale)), image)
        painter.setPen(QColor(EDGE))
        painter.drawRect(QRect(round(half * scale), round(half * scale), round(scale), round(scale)))
        painter.drawRect(self.rect().adjusted(0, 0, -1, -1))
