"""Work that is done once in the background: opening, saving, writing a sheet."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from texlab.runs.worker import Request, Worker

if TYPE_CHECKING:
    from collections.abc import Callable

# The window is gone by then, and a large result that is being written is worth waiting for.
PATIENCE_S = 60.0


class Errands(QObject):
    """Each errand has a thread of its own; ``failed(sentence)`` for one that fails, ``idle()`` after the last.

    ``changed()`` when one begins or ends.
    """

    failed = Signal(str)
    idle = Signal()
    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._workers: dict[Worker, str] = {}

    @property
    def busy(self) -> bool:
        """Whether anything is under way."""
        return bool(self._workers)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of what is under way, in the order in which it began."""
        return tuple(self._workers.values())

    def run(
        self,
        name: str,
        request: Request,
        done: Callable[[Any], None] | None = None,
        failed: Callable[[], None] | None = None,
        progressed: Callable[[Any], None] | None = None,
    ) -> None:
        """Do something once; a failure becomes one sentence, then ``failed()``; ``progressed`` gets reports."""
        worker = Worker(name, parent=self)
        self._workers[worker] = name
        self.changed.emit()
        if done is not None:
            worker.finished.connect(done)
        if progressed is not None:
            worker.progressed.connect(progressed)
        worker.failed.connect(self.failed)
        if failed is not None:
            worker.failed.connect(lambda _: failed())
        worker.idle.connect(lambda: self._end(worker))
        worker.submit(request)

    def _end(self, worker: Worker) -> None:
        if worker in self._workers:
            del self._workers[worker]
            self.changed.emit()
            worker.close()
            worker.deleteLater()
            if not self._workers:
                self.idle.emit()

    def leave(self) -> None:
        """Ask every thread to end, without waiting."""
        for worker in self._workers:
            worker.leave()

    def close(self) -> None:
        """Stop and join every thread."""
        for worker in self._workers:
            worker.close(PATIENCE_S)
        self._workers.clear()
