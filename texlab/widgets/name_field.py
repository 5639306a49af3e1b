"""A field in which a name is typed over what it names."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QLineEdit

if TYPE_CHECKING:
    from PySide6.QtGui import QFocusEvent, QKeyEvent
    from PySide6.QtWidgets import QWidget


class NameField(QLineEdit):
    """``taken(name)`` on Return or when it is left; Escape drops what was typed. It goes by itself."""

    taken = Signal(str)

    def __init__(self, over: QWidget, name: str) -> None:
        super().__init__(name, over.parentWidget())
        self.setObjectName("name-field")
        self.setAccessibleName("Name of the column")
        self.setPlaceholderText("by what differs")
        self.setGeometry(over.geometry())
        self._before = name
        self._done = False
        self.returnPressed.connect(lambda: self._end(take=True))
        self.show()
        self.selectAll()
        self.setFocus(Qt.FocusReason.OtherFocusReason)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Leave with Escape."""
        if event.key() == Qt.Key.Key_Escape:
            self._end(take=False)
            return
        super().keyPressEvent(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Take the name when something else is clicked."""
        super().focusOutEvent(event)
        self._end(take=True)

    def _end(self, *, take: bool) -> None:
        if self._done:
            return
        self._done = True
        if take and self.text() != self._before:
            self.taken.emit(self.text())
        self.hide()
        self.deleteLater()
