"""A panel that lies over the pictures, and goes back to its dock."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtWidgets import QFrame, QVBoxLayout, QWidget

from texlab.widgets.own_keys import OwnKeys
from texlab.widgets.plain import Label

if TYPE_CHECKING:
    from PySide6.QtGui import QKeyEvent
    from PySide6.QtWidgets import QDockWidget

# Parts of the width and the height of what it lies over.
WIDTH, HEIGHT = 0.4, 0.92


class Overlay(OwnKeys, QFrame):
    """Holds the widget of a dock over its parent, at the left or the right edge.

    Parameters
    ----------
    dock
        Whose widget is borrowed while the overlay is open.
    parent
        What it lies over.
    at_right
        At the right edge, not at the left one.
    """

    def __init__(self, dock: QDockWidget, parent: QWidget, *, at_right: bool) -> None:
        super().__init__(parent)
        self.setObjectName(f"overlay-{dock.windowTitle().lower()}")
        self.setAccessibleName(f"{dock.windowTitle()} over the pictures")
        self.setFrameShape(QFrame.Shape.StyledPanel)
        self.setAutoFillBackground(True)
        self._dock = dock
        self._below = parent
        self._at_right = at_right
        self._content: QWidget | None = None
        title = Label(dock.windowTitle())
        title.setProperty("role", "heading")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 4, 8, 4)
        layout.addWidget(title)
        parent.installEventFilter(self)
        self.hide()

    @property
    def is_open(self) -> bool:
        """Whether the panel lies over the pictures."""
        return self._content is not None

    def set_open(self, wanted: bool) -> None:
        """Borrow the panel, or give it back."""
        layout = self.layout()
        assert layout is not None
        if wanted == self.is_open:
            return
        if wanted:
            content = self._content = self._dock.widget()
            self._dock.setWidget(None)  # type: ignore[arg-type]  # none is what there is meanwhile
            layout.addWidget(content)
            content.show()
            self._place()
            content.setFocus()
        elif self._content is not None:
            layout.removeWidget(self._content)
            self._dock.setWidget(self._content)
            self._content = None
        self.setVisible(wanted)
        self.raise_()

    def _place(self) -> None:
        room = self._below.size()
        width, height = round(WIDTH * room.width()), round(HEIGHT * room.height())
        self.setGeometry(room.width() - width if self._at_right else 0, room.height() - height, width, height)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keep its part of what it lies over."""
        if watched is self._below and event.type() == QEvent.Type.Resize and self.is_open:
            self._place()
        return super().eventFilter(watched, event)

    def wants_key(self, event: QKeyEvent) -> bool:
        """Take Esc, which is nobody else's while the keyboard is in here."""
        return event.key() == Qt.Key.Key_Escape

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Close with Esc."""
        if self.wants_key(event):
            self.set_open(False)
        else:
            super().keyPressEvent(event)
