"""A picture in a rectangle of its own, with marks over it and a caption below."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from texlab.style.text_size import whole_words
from texlab.widgets.plain import set_tip

if TYPE_CHECKING:
    from PySide6.QtGui import QPaintEvent

    from texlab.style.pictures import Picture
    from texlab.style.theme import Theme

SMALLEST = 72


class PictureArea(QWidget):
    """A picture as large as it fits, sharp pixels, a caption below."""

    def __init__(self, name: str, caption: str, tip: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(caption or tip)
        set_tip(self, tip)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(SMALLEST, SMALLEST)
        self.caption = caption
        self.picture: Picture | None = None
        self._ink, self._canvas, self.focus_colour = QColor("black"), QColor("white"), QColor("blue")

    def set_theme(self, theme: Theme) -> None:
        """Take the colours of a theme."""
        self._ink, self._canvas, self.focus_colour = (
            QColor(theme.muted),
            QColor(theme.canvas),
            QColor(theme.accent),
        )
        self.update()

    def set_picture(self, picture: Picture | None) -> None:
        """Show (H, W, 3) uint8, or nothing."""
        self.picture = picture
        self.update()

    @property
    def caption_height(self) -> int:
        """Pixels of the line below the picture."""
        return self.fontMetrics().height() + 1

    def area(self) -> QRectF:
        """Return where the picture is painted."""
        room = QRectF(self.rect()).adjusted(2, 2, -2, -2 - self.caption_height)
        if self.picture is None or room.isEmpty():
            return room
        height, width = self.picture.shape[:2]
        scale = min(room.width() / width, room.height() / height)
        area = QRectF(0, 0, width * scale, height * scale)
        area.moveCenter(room.center())
        return area

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint picture, marks, focus and caption."""
        painter = QPainter(self)
        painter.fillRect(self.rect(), self._canvas)
        area = self.area()
        if self.picture is not None:
            height, width = self.picture.shape[:2]
            image = QImage(self.picture.data, width, height, 3 * width, QImage.Format.Format_RGB888)
            smooth = area.width() < width
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, smooth)
            painter.drawImage(area, image)
            self.paint_marks(painter, area)
        painter.setPen(self._ink)
        below = self.rect().adjusted(4, self.height() - self.caption_height, -4, 0)
        shown = whole_words(self.caption, painter.fontMetrics(), below.width())
        painter.drawText(below, Qt.AlignmentFlag.AlignCenter, shown)
        if self.hasFocus():
            painter.setPen(QPen(self.focus_colour, 2))
            painter.drawRect(self.rect().adjusted(1, 1, -1, -1))
        painter.end()

    def paint_marks(self, painter: QPainter, area: QRectF) -> None:
        """Paint over the picture."""
