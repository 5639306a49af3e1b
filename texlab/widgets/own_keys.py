"""Keys that belong to a part of the window while it has the keyboard: they win over the window's commands."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent, QKeySequence

if TYPE_CHECKING:
    from PySide6.QtGui import QAction
    from PySide6.QtWidgets import QWidget

_BESIDE = Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.KeypadModifier


class OwnKeys:
    """Put before a widget's class: the keys that :meth:`wants_key` names are its own, whatever the window does.

    Qt asks the widget that has the keyboard, and then those around it.
    """

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether the widget does something with the key now; its ``keyPressEvent`` asks the same."""
        return False

    def event(self, event: QEvent) -> bool:
        """Answer the question who wants a key."""
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and self.wants_key(event):
            event.accept()
            return True
        return bool(super().event(event))  # type: ignore[misc]  # the widget's class comes after this one


def is_plain(event: QKeyEvent) -> bool:
    """Return whether neither Ctrl nor Alt nor another such key is held: those are commands of the window."""
    return event.modifiers() & ~_BESIDE == Qt.KeyboardModifier.NoModifier


def is_bare(event: QKeyEvent) -> bool:
    """Return whether no other key is held, not even Shift."""
    return is_plain(event) and not event.modifiers() & Qt.KeyboardModifier.ShiftModifier


def begins_number(event: QKeyEvent) -> bool:
    """Return whether a number begins with the typed character."""
    text = event.text()
    return is_plain(event) and len(text) == 1 and (text.isdigit() or text in ".,")


class CopyKey(QObject):
    """Lets a widget that is no class of ours do an action with the key of Copy while it has the keyboard."""

    def __init__(self, widget: QWidget, action: QAction) -> None:
        super().__init__(widget)
        self._action = action
        widget.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Take the key before the window does."""
        if isinstance(event, QKeyEvent) and event.matches(QKeySequence.StandardKey.Copy):
            if event.type() == QEvent.Type.ShortcutOverride:
                event.accept()
                return True
            if event.type() == QEvent.Type.KeyPress:
                self._action.trigger()
                return True
        return super().eventFilter(watched, event)
