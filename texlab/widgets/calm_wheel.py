"""Boxes and sliders that leave the wheel to what scrolls, unless they have the keyboard."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox

if TYPE_CHECKING:
    from PySide6.QtGui import QWheelEvent
    from PySide6.QtWidgets import QWidget


class CalmWheel:
    """Put before a widget's class: the wheel changes its value only while it has the keyboard.

    Whoever scrolls a panel with the pointer over a box would else change what the box says. Qt passes on what a
    widget ignores to those around it. The wheel does not give it the keyboard either: :meth:`keep_wheel_calm` is
    called once the widget is made.
    """

    def keep_wheel_calm(self) -> None:
        """Let clicks and Tab alone give the widget the keyboard."""
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)  # type: ignore[attr-defined]  # the widget's class follows

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Turn the value, or leave the wheel to what is around."""
        if self.hasFocus():  # type: ignore[attr-defined]  # the widget's class comes after this one
            super().wheelEvent(event)  # type: ignore[misc]
        else:
            event.ignore()


class ChoiceBox(CalmWheel, QComboBox):
    """A list to choose from; every one of the window is one."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.keep_wheel_calm()
