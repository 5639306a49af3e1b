"""What works in a thread of its own and is seen as a frozen scene: sweeps, searches, fills."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from texlab.runs.worker import Worker

if TYPE_CHECKING:
    from texlab.runs.slots import Slots


class SceneRunner(QObject):
    """Runs what was asked for last instead of what ran before; ``changed()`` tells that ``scene`` is another one.

    Parameters
    ----------
    name
        Of the thread.
    scene
        What there is to see before anything was asked for.
    slots
        Places that the whole run takes; None where its parts take places of their own.
    """

    changed = Signal()
    scene: Any

    def __init__(self, name: str, scene: Any, slots: Slots | None, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.scene = scene
        self._worker = Worker(name, slots, self)

    def stop(self) -> None:
        """Stop what runs; what there is to see stays."""
        self._worker.cancel()

    def leave(self) -> None:
        """Ask the thread to end, without waiting."""
        self._worker.leave()

    def close(self) -> None:
        """Stop the thread and wait for its end."""
        self._worker.close()

    def _show(self, **changes: Any) -> None:
        self.scene = dataclasses.replace(self.scene, **changes)
        self.changed.emit()
