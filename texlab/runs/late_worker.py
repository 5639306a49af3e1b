"""What works in a thread of its own, which is made when something is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

if TYPE_CHECKING:
    from texlab.runs.worker import Worker


class LateWorker(QObject):
    """Holds a worker that may not be there yet: most sessions never need it. ``changed()``: look again."""

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._worker: Worker | None = None

    def stop(self) -> None:
        """Stop what runs; what there is to see stays."""
        if self._worker is not None:
            self._worker.cancel()

    def leave(self) -> None:
        """Ask the thread to end, without waiting."""
        if self._worker is not None:
            self._worker.leave()

    def close(self) -> None:
        """Stop the thread and wait for its end."""
        if self._worker is not None:
            self._worker.close()
