"""A picture on which the part to use is drawn with the mouse."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QPen

from texlab.widgets.own_keys import OwnKeys, is_bare
from texlab.widgets.picture_area import PictureArea
from texlab_core.engine.inputs import Crop

if TYPE_CHECKING:
    from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter

    from texlab.style.pictures import Picture

SMALLEST = 8


class CropPane(OwnKeys, PictureArea):
    """Shows a source and the part of it that is used; ``cropped(Crop or None)`` when another one was drawn."""

    cropped = Signal(object)

    def __init__(self, name: str, caption: str) -> None:
        tip = "Drag to use a part of the picture; double-click or press Delete to use all of it"
        super().__init__(name, caption, tip)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setCursor(Qt.CursorShape.CrossCursor)
        self.crop: Crop | None = None
        self._from: tuple[int, int] | None = None
        self._drawn: Crop | None = None

    def show_source(self, picture: Picture | None, crop: Crop | None, caption: str) -> None:
        """Show a source with the part that is used."""
        self.crop, self.caption = crop, caption
        self.set_picture(picture)

    def place_of(self, row: float, column: float) -> QPointF:
        """Return where a place of the picture is painted."""
        area = self.area()
        assert self.picture is not None
        height, width = self.picture.shape[:2]
        return QPointF(area.x() + column * area.width() / width, area.y() + row * area.height() / height)

    def paint_marks(self, painter: QPainter, area: QRectF) -> None:
        """Outline the part, and dim the rest."""
        crop = self._drawn or self.crop
        if crop is None:
            return
        part = QRectF(
            self.place_of(crop.top, crop.left), self.place_of(crop.top + crop.height, crop.left + crop.width)
        )
        dim = QColor(0, 0, 0, 130)
        for rest in (
            QRectF(area.topLeft(), QPointF(area.right(), part.top())),
            QRectF(QPointF(area.left(), part.bottom()), area.bottomRight()),
            QRectF(QPointF(area.left(), part.top()), QPointF(part.left(), part.bottom())),
            QRectF(QPointF(part.right(), part.top()), QPointF(area.right(), part.bottom())),
        ):
            painter.fillRect(rest, dim)
        painter.setPen(QPen(self.focus_colour, 2))
        painter.drawRect(part)

    def _at(self, point: QPointF) -> tuple[int, int]:
        area = self.area()
        assert self.picture is not None
        height, width = self.picture.shape[:2]
        row = round((point.y() - area.y()) * height / max(area.height(), 1e-9))
        column = round((point.x() - area.x()) * width / max(area.width(), 1e-9))
        return min(max(row, 0), height), min(max(column, 0), width)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a part."""
        if event.button() == Qt.MouseButton.LeftButton and self.picture is not None:
            self._from = self._at(event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Draw it."""
        if self._from is not None:
            (top, left), (bottom, right) = self._from, self._at(event.position())
            height, width = abs(bottom - top), abs(right - left)
            drawn = Crop(min(top, bottom), min(left, right), height, width)
            self._drawn = drawn if min(height, width) >= SMALLEST else None
            self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Use it."""
        drawn, self._drawn, self._from = self._drawn, None, None
        if event.button() == Qt.MouseButton.LeftButton and drawn is not None:
            self.crop = drawn
            self.update()
            self.cropped.emit(drawn)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Use the whole picture."""
        self._whole()

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it takes the crop away."""
        return is_bare(event) and event.key() in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Use the whole picture."""
        if self.wants_key(event):
            self._whole()
        else:
            super().keyPressEvent(event)

    def _whole(self) -> None:
        if self.crop is not None:
            self.crop = None
            self.update()
            self.cropped.emit(None)
