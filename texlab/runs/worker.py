"""Work in the background: the only file that knows both threads and Qt.

Every :class:`Worker` is one thread with a one-slot mailbox: the newest request replaces a waiting one and stops a
running one, unless it is patient. Requests carry a generation number, checked in the thread and again on arrival,
so that nothing stale is ever delivered. Every request that starts ends with exactly one of finished, failed,
cancelled.
"""

from __future__ import annotations

import contextlib
import logging
import os
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from PySide6.QtCore import QObject, Signal, Slot

from texlab.runs.slots import Rank, Slots
from texlab_core.errors import Cancelled, InputError

log = logging.getLogger(__name__)

PROGRESS_INTERVAL_S = 1 / 60
# Threads of work let the window go first, and those that measure let pictures go first.
NICENESS = 5
BEHIND_PICTURES = 15


@dataclass(frozen=True, slots=True)
class _Event:
    generation: int
    kind: Literal["started", "finished", "failed", "idle", "progress"]
    value: Any = None


class Task:
    """What a request sees of the world while it runs (in the worker's thread)."""

    def __init__(self, worker: Worker, generation: int, rank: Rank) -> None:
        self._worker = worker
        self.generation = generation
        self._rank = rank
        self._last = 0.0

    def should_stop(self) -> bool:
        """Whether a newer request, a cancel or a close has come."""
        return self.generation < self._worker._oldest

    def due(self) -> bool:
        """Whether enough time has passed for another progress report to be shown."""
        return time.perf_counter() - self._last >= PROGRESS_INTERVAL_S

    def progress(self, value: object) -> None:
        """Report; the newest report replaces one that the window has not taken yet."""
        self._last = time.perf_counter()
        self._worker._post_progress(self.generation, value)

    def give_way(self) -> float:
        """Let what goes first have the place for a while; return the seconds that it took."""
        slots = self._worker._slots
        return 0.0 if slots is None else slots.give_way(self.should_stop, self._rank)


Request = Callable[[Task], Any]


@dataclass(frozen=True, slots=True)
class _Asked:
    request: Request
    first: Request | None
    rank: Rank


class Worker(QObject):
    """One thread with a one-slot mailbox. All signals arrive in the thread that made the worker.

    The thread starts with the first request: most sessions never ask for most of what there is.
    """

    started = Signal(int)
    progressed = Signal(object)
    finished = Signal(object)
    failed = Signal(str)
    cancelled = Signal()
    idle = Signal()
    _event = Signal(object)

    def __init__(
        self,
        name: str,
        slots: Slots | None = None,
        parent: QObject | None = None,
        *,
        niceness: int = NICENESS,
    ) -> None:
        super().__init__(parent)
        self._niceness = niceness
        self.setObjectName(f"worker-{name}")
        self._slots = slots
        self._mail = threading.Condition()
        self._request: _Asked | None = None
        self._newest = 0
        # Requests from before this one are stale: whatever they report is dropped.
        self._oldest = 0
        self._reported = 0
        self._closing = False
        self._ending = False
        self._runs = False
        # Events that wait in the queue of the window's side: what was run is not over before they are told.
        self._ends = 0
        self._owes = False
        self._progress: tuple[int, object] | None = None
        self._event.connect(self._receive)
        self._thread = threading.Thread(target=self._work, name=f"texlab-{name}", daemon=True)

    @property
    def generation(self) -> int:
        """Number of the newest request."""
        return self._newest

    @property
    def behind(self) -> bool:
        """Whether what was reported last is not about the newest request."""
        return self._reported < self._newest

    @property
    def busy(self) -> bool:
        """Whether a request waits or runs, or what came of it has yet to be told; false again with ``idle``."""
        with self._mail:
            return self._runs or self._request is not None or self._ends > 0

    @property
    def occupied(self) -> bool:
        """Whether the thread itself waits for a place or runs at this moment, whatever has been told of it."""
        with self._mail:
            return self._runs or self._request is not None

    def submit(
        self,
        request: Request,
        *,
        patient: bool = False,
        first: Request | None = None,
        rank: Rank = Rank.REST,
    ) -> int:
        """Run ``request`` instead of whatever waits or runs; returns its generation number.

        ``first`` waits for what the request needs: it is called before a place is taken and ``started`` is told.
        What it returns, unless that is None, is the answer, and the request is not made.
        A patient request lets the running one finish: what is asked for faster than it can be answered would
        otherwise never be seen.
        """
        with self._mail:
            self._newest += 1
            if not patient:
                self._oldest = self._newest
            self._request = _Asked(request, first, rank)
            self._owes = True
            if not (self._started or self._closing or self._ending):
                self._thread.start()
            self._mail.notify()
        if self._slots is not None:
            self._slots.wake()
        return self._newest

    def cancel(self) -> None:
        """Stop what runs and forget what waits."""
        with self._mail:
            self._request = None
            self._newest += 1
            self._oldest = self._reported = self._newest
            owed, self._owes = self._owes, False
        if self._slots is not None:
            self._slots.wake()
        if owed:
            self.cancelled.emit()

    def leave(self) -> None:
        """Ask the thread to end, without waiting; nothing is delivered any more."""
        with self._mail:
            self._closing = True
            self._request = self._progress = None
            self._newest += 1
            self._oldest = self._newest
            self._mail.notify()
        if self._slots is not None:
            self._slots.wake()

    @property
    def _started(self) -> bool:
        return self._thread.ident is not None

    @property
    def ended(self) -> bool:
        """Whether the thread has ended, or was never needed."""
        return not self._thread.is_alive()

    def close(self, timeout_s: float = 5.0) -> None:
        """Stop the thread and wait for its end."""
        self.leave()
        self._join(timeout_s)
        if self._thread.is_alive():
            log.error("%s did not end within %.0f s.", self._thread.name, timeout_s)

    def finish(self, timeout_s: float = 60.0) -> None:
        """Let the thread do what it was asked for last, and wait for its end; nothing is delivered any more."""
        with self._mail:
            self._ending = True
            self._mail.notify()
        self._join(timeout_s)
        self.close(0.0)

    def _join(self, timeout_s: float) -> None:
        if self._started:
            self._thread.join(timeout_s)

    # The thread's side.

    def _work(self) -> None:
        _give_way(self._niceness)
        while True:
            with self._mail:
                while self._request is None and not (self._closing or self._ending):
                    self._mail.wait()
                if self._closing or self._request is None:
                    return
                asked, self._request = self._request, None
                generation = self._newest
                self._runs = True
            assert asked is not None
            self._run_one(asked, Task(self, generation, asked.rank))
            del asked
            with self._mail:
                self._runs = False
                self._ends += 1
            self._tell(_Event(generation, "idle"))

    def _run_one(self, asked: _Asked, task: Task) -> None:
        place = (
            self._slots.place(task.should_stop, asked.rank)
            if self._slots is not None
            else contextlib.nullcontext()
        )
        try:
            value = None if asked.first is None else asked.first(task)
            if value is None:
                with place:
                    self._tell(_Event(task.generation, "started"))
                    value = asked.request(task)
        except Cancelled:
            return
        except (InputError, OSError) as error:
            self._tell(_Event(task.generation, "failed", str(error)))
        except MemoryError:
            self._tell(_Event(task.generation, "failed", "There is not enough memory for this size."))
        except Exception as error:
            log.exception("A background task failed.")
            text = f"{type(error).__name__}: {error}. The log has the details."
            self._tell(_Event(task.generation, "failed", text))
        else:
            self._tell(_Event(task.generation, "finished", value))

    def _post_progress(self, generation: int, value: object) -> None:
        with self._mail:
            if self._closing:
                return
            pending = self._progress is not None
            self._progress = (generation, value)
        if not pending:
            self._tell(_Event(generation, "progress"))

    def _tell(self, event: _Event) -> None:
        """Post an event to the window's side."""
        try:
            if not self._closing:
                self._event.emit(event)
        except RuntimeError:
            # What could not be stopped in time outlives its worker's Qt half; nobody listens any more.
            if not self._closing:
                raise

    # The window's side.

    @Slot(object)
    def _receive(self, event: _Event) -> None:
        if event.kind == "idle":
            with self._mail:
                self._ends -= 1
            if not self.busy:
                self.idle.emit()
            return
        if event.kind == "progress":
            self._receive_progress()
            return
        if event.generation < self._oldest or self._closing:
            return
        self._reported = event.generation
        if event.kind == "started":
            self.started.emit(event.generation)
            return
        # A newer request is still owed its own end.
        self._owes = event.generation < self._newest
        if event.kind == "finished":
            self._receive_progress()
            self.finished.emit(event.value)
        else:
            self.failed.emit(event.value)

    def _receive_progress(self) -> None:
        with self._mail:
            waiting, self._progress = self._progress, None
        if waiting is not None and waiting[0] >= self._oldest and not self._closing:
            self.progressed.emit(waiting[1])


def _give_way(niceness: int) -> None:
    """Let the window's thread go first, where a thread can say so (Linux)."""
    if sys.platform == "linux":
        with contextlib.suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), niceness)
