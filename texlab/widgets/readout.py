"""The value under the cursor, told where it hides nothing of what it is about."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QPalette

from texlab.widgets.plain import Label

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtCore import QRect
    from PySide6.QtWidgets import QWidget

MARGIN = 3


class Readout(Label):
    """A line of text at the lower right of a room; it lies over what is there and moves nothing.

    Parameters
    ----------
    name
        Name of the object.
    parent
        Whose child it is.
    room
        A method that returns the room, in the parent's coordinates, whenever a text is shown. Its object, which
        owns this, is not kept alive by it.
    """

    def __init__(self, name: str, parent: QWidget, room: Callable[[], QRect]) -> None:
        super().__init__(parent=parent)
        self._room = weakref.WeakMethod(room)
        self._again: Callable[[], str] | None = None
        self.setObjectName(name)
        self.setAccessibleName("Value under the cursor")
        self.setAutoFillBackground(True)
        self.setBackgroundRole(QPalette.ColorRole.ToolTipBase)
        self.setForegroundRole(QPalette.ColorRole.ToolTipText)
        self.setMargin(MARGIN)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.hide()

    def tell(self, words: Callable[[], str]) -> None:
        """Show what ``words`` returns, now and whenever what it is about has changed."""
        self.setText(words())
        self._again = words

    def tell_again(self) -> None:
        """Say what is under the pointer now; a text that nobody can renew goes."""
        if self._again is not None:
            self.tell(self._again)
        else:
            self.setText("")

    def setText(self, text: str) -> None:
        """Show a text, or nothing; its end is left out where it is longer than the room."""
        self._again = None
        self.setVisible(bool(text))
        if not text:
            super().setText("")
            return
        find = self._room()
        room = self.rect() if find is None else find()
        most = room.width() - 4 * MARGIN
        super().setText(self.fontMetrics().elidedText(text, Qt.TextElideMode.ElideRight, most))
        self.adjustSize()
        self.move(room.right() - self.width() - MARGIN, room.bottom() - self.height() - MARGIN)
        self.raise_()
