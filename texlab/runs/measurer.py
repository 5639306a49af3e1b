"""When the numbers about a column's picture are made: pictures never wait for them."""

from __future__ import annotations

import logging
import time
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from texlab.runs.worker import BEHIND_PICTURES, Worker
from texlab.widgets.once import Once

if TYPE_CHECKING:
    from texlab.runs.column_run import Measured, MeasureRun
    from texlab.runs.slots import Slots

log = logging.getLogger(__name__)

# While a control is dragged, numbers that are older than this are made beside the next pictures,
OVERDUE_S = 0.7
# but no more often than that measuring takes this share of the time.
MEASURING_SHARE = 0.05
# A draft is measured when the next event does not come within this: it would take a core from its picture.
REST_MS = 60


class Measurer(QObject):
    """Measures a column's newest picture, one at a time.

    ``told(found)`` on the way and ``came(found)`` at the end, while ``present`` is still what they are about;
    ``failed()`` when a picture cannot be measured.
    """

    told = Signal(object)
    came = Signal(object)
    failed = Signal()

    def __init__(self, name: str, slots: Slots, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.present: MeasureRun | None = None
        """What is measured now."""
        self._next: MeasureRun | None = None
        self._last_s = 0.0
        self._since_s = self._took_s = 0.0
        self._rest = Once(self, REST_MS, self._measure_next)
        self.worker = Worker(name, slots, self, niceness=BEHIND_PICTURES)
        self.worker.progressed.connect(self.told)
        self.worker.finished.connect(self._finished)
        self.worker.failed.connect(self._failed)

    @property
    def busy(self) -> bool:
        """Whether numbers are still to come."""
        return self.present is not None or self._next is not None

    @property
    def overdue(self) -> bool:
        """Whether the last numbers are so old that measuring goes on beside the next pictures."""
        return time.monotonic() - self._last_s >= max(OVERDUE_S, self._took_s / MEASURING_SHARE)

    def measure(self, run: MeasureRun, *, dragged: bool) -> None:
        """Measure a picture next: at once, or as soon as a drag rests."""
        self._next = run
        if self.present is not None:
            return
        if dragged and not self.overdue:
            self._rest.start()
        else:
            self._measure_next()

    def stop(self) -> None:
        """Forget what is measured, and what was to be."""
        self._rest.stop()
        self.present = self._next = None
        self.worker.cancel()

    def forget(self) -> None:
        """Let go of the picture, of whose numbers nobody is told any more."""
        self.present = self._next = None

    @property
    def ended(self) -> bool:
        """Whether the thread has ended."""
        return self.worker.ended

    def leave(self) -> None:
        """Ask the thread to end, without waiting."""
        self._rest.stop()
        self.worker.leave()

    def close(self) -> None:
        """Stop the thread and wait for its end."""
        self.worker.close()

    def _measure_next(self) -> None:
        self._rest.stop()
        self.present, self._next = self._next, None
        if self.present is not None:
            self._since_s = time.monotonic()
            self.worker.submit(self.present)

    def _finished(self, found: Measured) -> None:
        self._last_s = time.monotonic()
        # What is no draft is measured thoroughly, which says nothing of how long the quick numbers take.
        quick = self.present is not None and self.present.draft
        self._took_s = self._last_s - self._since_s if quick else 0.0
        self.came.emit(found)
        self._measure_next()

    def _failed(self, sentence: str) -> None:
        # The picture is there all the same.
        log.warning("A picture could not be measured: %s", sentence)
        self.failed.emit()
        self._measure_next()
