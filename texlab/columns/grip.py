"""The handle by which a column is dragged to another place."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, Qt, Signal

from texlab.widgets.plain import Label, set_tip

if TYPE_CHECKING:
    from PySide6.QtGui import QMouseEvent
    from PySide6.QtWidgets import QWidget

# So far a press may wander before it is a drag.
START_PX = 6


class Grip(Label):
    """``dragged(place on the screen, final)`` while it is dragged; ``double_clicked()``."""

    dragged = Signal(object, bool)
    double_clicked = Signal()

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__("⠿", parent)
        self.setObjectName(name)
        self.setProperty("role", "muted")
        self.setCursor(Qt.CursorShape.OpenHandCursor)
        self.setAccessibleName("Drag to move the column")
        set_tip(self, "Drag to move the column, double click to rename it")
        self._from: QPoint | None = None
        self._moving = False

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._from, self._moving = event.globalPosition().toPoint(), False
        # What is around chooses the column.
        event.ignore()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Tell where it is held."""
        here = event.globalPosition().toPoint()
        if self._from is None:
            return
        self._moving = self._moving or (here - self._from).manhattanLength() >= START_PX
        if self._moving:
            self.setCursor(Qt.CursorShape.ClosedHandCursor)
            self.dragged.emit(here, False)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Tell where it was let go."""
        moving, self._from, self._moving = self._moving, None, False
        self.setCursor(Qt.CursorShape.OpenHandCursor)
        if moving:
            self.dragged.emit(event.globalPosition().toPoint(), True)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """Tell of it."""
        self._from = None
        self.double_clicked.emit()
        event.accept()
