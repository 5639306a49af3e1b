"""How much memory the program uses, and giving back what it no longer needs, where the system knows how."""

from __future__ import annotations

import os
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from texlab.app.malloc import trim
from texlab.runs.worker import Worker

# Less than this is not worth the milliseconds in which nobody else gets memory.
STEP_BYTES = 24 * 2**20
# Filters of pictures of ordinary size are worth keeping at rest too.
FILTERS_BYTES = 8 * 2**20


def memory_bytes() -> int | None:
    """Return the resident size in bytes, or None where it is not known."""
    try:
        pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
        return pages * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, IndexError, AttributeError):
        return None


def memory_text(size: int | None) -> str:
    """Return a resident size for the status bar."""
    return "" if size is None else f"{size / 2**20:.0f} MB"


def give_back() -> None:
    """Let go of large filters, and give the system what was freed, which glibc keeps in pieces."""
    from texlab_core.work.kept import shrink

    shrink(FILTERS_BYTES)
    trim()


class Thrift(QObject):
    """Gives memory back, in its own thread, once the program rests with more than it had at its least.

    Once for every rest, which work or a change of the session ends: a large picture is closed without any work.
    Less than at the rest before may still be too much: what it leaves free stays with malloc until it is asked.

    ``changed()`` when it was given.
    """

    changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._rested = False
        self._gave_at_rest = False
        self._least: int | None = None
        self._worker = Worker("memory", parent=self)
        self._worker.finished.connect(lambda _: self._gave())

    def look(self, used: int | None, *, idle: bool) -> None:
        """See what is used now, in bytes; the program was at rest when that was said twice."""
        rested, self._rested = self._rested and idle, idle
        if not idle:
            self._gave_at_rest = False
        if not rested or self._gave_at_rest or used is None or self._worker.busy:
            return
        if self._least is None or used >= self._least + STEP_BYTES:
            self._gave_at_rest = True
            self._worker.submit(lambda task: give_back())

    def stir(self) -> None:
        """Take it that something may have been freed: the next rest is another one."""
        self._rested = self._gave_at_rest = False

    def leave(self) -> None:
        """Ask the thread to end, without waiting."""
        self._worker.leave()

    def close(self) -> None:
        """Stop the thread and wait for its end."""
        self._worker.close()

    def _gave(self) -> None:
        now = memory_bytes() or 0
        self._least = now if self._least is None else min(self._least, now)
        self.changed.emit()
