"""A window that is as large after a change of what it shows as before."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from texlab.widgets.once import Once

if TYPE_CHECKING:
    from PySide6.QtCore import QSize
    from PySide6.QtWidgets import QWidget


class SameSize(QObject):
    """Takes back what a window has grown while old and new parts stood in it together."""

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self._window = window
        self._size: QSize | None = None
        self._later = Once(self, 0, self._take_back)

    def keep(self) -> None:
        """Be as large as now once what is changed next has its places."""
        if self._size is None:
            self._size = self._window.size()
        self._later.start()

    def _take_back(self) -> None:
        size, self._size = self._size, None
        window = self._window
        if size is None or window.isMaximized() or window.isFullScreen():
            return
        if window.height() > size.height() or window.width() > size.width():
            window.resize(size)
