"""Columns in windows of their own: they go on living, and come back to the stage when the window is closed."""

from __future__ import annotations

import base64
import binascii
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QByteArray, QObject, QSize, Qt, Signal
from PySide6.QtWidgets import QApplication, QVBoxLayout, QWidget

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from PySide6.QtGui import QCloseEvent

    from texlab.columns.column import ColumnView

# The room that a picture has in its own window at first.
USUAL = QSize(480, 560)
MAX_GEOMETRY = 4096


class ColumnWindow(QWidget):
    """Holds a column's view; ``put_back(id)`` when it is closed."""

    put_back = Signal(int)

    def __init__(self, view: ColumnView, parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Window)
        self.column_id = view.column_id
        self.setObjectName(f"apart-{view.column_id}")
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(view)
        view.set_words("below")
        self.resize(USUAL)

    def show_title(self, title: str) -> None:
        """Say what the column is."""
        self.setWindowTitle(f"{title} - TexLab")
        self.setAccessibleName(f"Window of {title}")

    def toggle_size(self) -> None:
        """Take the whole screen, or give it back."""
        self.setWindowState(self.windowState() ^ Qt.WindowState.WindowMaximized)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Let the column go back to the stage."""
        super().closeEvent(event)
        self.put_back.emit(self.column_id)


class Apart(QObject):
    """Knows which columns have windows of their own, also those that are not there now and may come back.

    ``made(window)`` with every window; ``changed()`` when a column has left the stage or come back.
    """

    made = Signal(object)
    changed = Signal()

    def __init__(self, stage: QWidget) -> None:
        super().__init__(stage)
        self._stage = stage
        self.windows: dict[int, ColumnWindow] = {}
        # Where the windows stood, by column; None where none stood yet.
        self._places: dict[int, QByteArray | None] = {}

    def __contains__(self, column_id: int) -> bool:
        """Whether a column that is there has a window of its own."""
        return column_id in self.windows

    @property
    def places(self) -> dict[int, bytes]:
        """Where the windows stand, as Qt writes it, by column."""
        return {each: bytes(window.saveGeometry().data()) for each, window in self.windows.items()}

    def is_wanted(self, column_id: int) -> bool:
        """Whether a column is to be apart as soon as it is there."""
        return column_id in self._places

    def want(self, places: Mapping[int, bytes]) -> None:
        """Let these columns be apart as soon as they are there, at these places."""
        self._places |= {each: QByteArray(place) for each, place in places.items()}

    def detach(self, view: ColumnView) -> None:
        """Give a column a window of its own."""
        column_id = view.column_id
        if column_id in self.windows:
            return
        window = ColumnWindow(view, self._stage.window())
        window.put_back.connect(self.put_back)
        window.show_title(view.method_box.label)
        place = self._places.setdefault(column_id, None)
        if place is None or not window.restoreGeometry(place):
            middle = self._stage.mapToGlobal(self._stage.rect().center())
            window.move(middle - window.rect().center())
        self.windows[column_id] = window
        self.made.emit(window)
        self.changed.emit()
        view.show()
        window.show()

    def put_back(self, column_id: int) -> None:
        """Let a column go back to the stage."""
        self._places.pop(column_id, None)
        # It may be folded away there, and would be nobody's.
        if self._close(column_id, self._stage):
            self.changed.emit()

    def drop(self, column_id: int) -> None:
        """Close the window of a column that is going; where it stood is kept for when it comes again."""
        window = self.windows.get(column_id)
        if window is not None:
            self._places[column_id] = window.saveGeometry()
            self._close(column_id)

    def put_all_back(self) -> None:
        """Let all columns be on the stage, also those that come later."""
        self._places.clear()
        for column_id in list(self.windows):
            self.put_back(column_id)

    def close_all(self) -> None:
        """Close all windows, with their columns in them."""
        for column_id in list(self.windows):
            self._close(column_id, self._stage)

    def show_title(self, column_id: int, title: str) -> None:
        """Say what a column is over its window."""
        if column_id in self.windows:
            self.windows[column_id].show_title(title)

    def _close(self, column_id: int, home: QWidget | None = None) -> bool:
        window = self.windows.pop(column_id, None)
        if window is None:
            return False
        here = QApplication.focusWidget()
        if here is not None and window.isAncestorOf(here):
            here.clearFocus()
        window.put_back.disconnect(self.put_back)
        window.hide()
        for view in window.findChildren(QWidget, "column", Qt.FindChildOption.FindDirectChildrenOnly):
            view.setParent(home)
        for action in window.actions():
            window.removeAction(action)
        window.deleteLater()
        return True


def places_to_json(places: Mapping[int, bytes], order: Sequence[int]) -> list[list[Any]]:
    """Return where windows stand for the settings: the column's place on the stage, and the window's."""
    return [
        [order.index(each), base64.b64encode(place).decode("ascii")]
        for each, place in places.items()
        if each in order
    ]


def places_from_json(value: object, order: Sequence[int]) -> dict[int, bytes]:
    """Return where windows shall stand by column; what is damaged, or of no column, is left out."""
    found: dict[int, bytes] = {}
    for entry in value if isinstance(value, list) else ():
        if not isinstance(entry, list) or len(entry) != 2:
            continue
        place, text = entry
        if type(place) is not int or not 0 <= place < len(order) or not isinstance(text, str):
            continue
        try:
            geometry = base64.b64decode(text[:MAX_GEOMETRY], validate=True)
        except (binascii.Error, ValueError):
            continue
        found[order[place]] = geometry
    return found
