"""A timer that fires once, some time after it was started last."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

if TYPE_CHECKING:
    from collections.abc import Callable


class Once(QTimer):
    """Calls a function ``after_ms`` after ``start()``; each start begins the time anew."""

    def __init__(self, parent: QObject, after_ms: int, fired: Callable[[], object]) -> None:
        super().__init__(parent)
        self.setSingleShot(True)
        self.setInterval(after_ms)
        self.timeout.connect(fired)
