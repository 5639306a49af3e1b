"""The value under the cursor, over a corner of a view."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QPalette

from texlab.widgets.plain import Label

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget


class Readout(Label):
    """A line of text that lies over a corner of its parent and takes no room in the layout."""

    def __init__(self, name: str, parent: QWidget) -> None:
        super().__init__(parent=parent)
        self._over = parent
        self.setObjectName(name)
        self.setAccessibleName("Value under the cursor")
        self.setAutoFillBackground(True)
        self.setBackgroundRole(QPalette.ColorRole.ToolTipBase)
        self.setForegroundRole(QPalette.ColorRole.ToolTipText)
        self.setMargin(3)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.hide()

    def setText(self, text: str) -> None:
        """Show a text, or nothing."""
        super().setText(text)
        self.setVisible(bool(text))
        if text:
            self.adjustSize()
            area = self._over.rect()
            self.move(max(0, area.right() - self.width() - 6), area.bottom() - self.height() - 6)
            self.raise_()
