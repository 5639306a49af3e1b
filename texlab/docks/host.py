"""Asks the docks' questions in the background and hands them the answers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QDeadlineTimer, QEvent, QObject, QTimer

from texlab.runs.worker import Task, Worker
from texlab.state.scene import same_but_probe

if TYPE_CHECKING:
    from texlab.docks.base import Dock, Question
    from texlab.runs.slots import Slots
    from texlab.state.scene import Scene

NOTHING_YET = "There is nothing to show yet."


class DockHost(QObject):
    """Drives one dock: only while it is visible, one question at a time, the newest scene next.

    A running question is not interrupted by a newer scene, or a live run would never be shown; the newer scene is
    asked about as soon as the answer is there, but not within ``dock.rest_ms`` of it: while a control is dragged,
    the pictures come first. A question is dropped when its dock goes out of sight: all docks share the places, and
    nobody who looks at one waits for what nobody sees.
    """

    def __init__(self, dock: Dock, slots: Slots, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.dock = dock
        self._worker: Worker | None = None
        self._slots = slots
        self._scene: Scene | None = None
        self._asked: tuple[Any, ...] | None = None
        self._computing = False
        # Whether the dock has an answer.
        self._holds = False
        self._dirty = False
        self._was_seen: bool | None = None
        self._rested = QDeadlineTimer(0)
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.timeout.connect(self._update)
        self._look = QTimer(self)
        self._look.setSingleShot(True)
        self._look.setInterval(0)
        self._look.timeout.connect(self._update)
        dock.installEventFilter(self)
        dock.asks.connect(self._update)

    def show_scene(self, scene: Scene) -> None:
        """Take a newer scene."""
        before, self._scene = self._scene, scene
        moved = before is not None and not self.dock.follows_pointer and same_but_probe(scene, before)
        if not moved:
            self._update()
        if before is not None and not moved and self._holds and not self.seen and _is_about_others(scene, before):
            # A tab behind another one would keep its pictures, and all that was computed from them, for good.
            self._asked, self._holds = None, False
            self.dock.forget()

    def leave(self) -> None:
        """Ask the thread to end, without waiting."""
        if self._worker is not None:
            self._worker.leave()

    def close(self) -> None:
        """Stop and join the thread."""
        self._rest.stop()
        self._look.stop()
        if self._worker is not None:
            self._worker.close()

    @property
    def busy(self) -> bool:
        """Whether an answer is under way, or a newer scene waits to be asked about."""
        return self._computing or ((self._rest.isActive() or self._look.isActive()) and self.seen)

    @property
    def seen(self) -> bool:
        """Whether any part of the dock can be seen: Qt calls the tabs behind the front one visible, too."""
        return self.dock.isVisible() and not self.dock.visibleRegion().isEmpty()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Catch up when the dock comes into sight or goes: shown, hidden, its frame brought to the front."""
        if event.type() == QEvent.Type.ParentChange and watched is self.dock:
            frame = self.dock.parentWidget()
            if frame is not None:
                frame.installEventFilter(self)
        elif event.type() in (QEvent.Type.Show, QEvent.Type.Hide, QEvent.Type.Move, QEvent.Type.Resize):
            # The frame has its new place when the event has been handled.
            self._look.start()
        return super().eventFilter(watched, event)

    def _update(self) -> None:
        seen = self.seen
        if seen is not self._was_seen:
            self._was_seen = seen
            self.dock.set_seen(seen)
            if not seen:
                self._drop()
        if self._scene is None or not seen:
            return
        self.dock.show_scene(self._scene)
        if self._computing:
            self._dirty = True
            return
        if not self._rested.hasExpired():
            if not self._rest.isActive():
                self._rest.start(self._rested.remainingTime())
            return
        question = self.dock.question(self._scene)
        if question is None:
            self._asked = None
            self.dock.present_nothing(NOTHING_YET)
            return
        if question.key == self._asked:
            return
        self._asked = question.key
        self._ask(question)

    def _ask(self, question: Question) -> None:
        if self._worker is None:
            self._worker = Worker(self.dock.name, self._slots, self)
            self._worker.finished.connect(self._answered)
            self._worker.failed.connect(self._refused)

        def work(task: Task) -> Any:
            return question.compute(task.should_stop)

        self._computing = True
        self.dock.present_waiting()
        self._worker.submit(work)

    def _drop(self) -> None:
        """Forget a question under way: it is asked anew when the dock is seen again."""
        if self._worker is not None and self._computing:
            self._worker.cancel()
            self._asked, self._computing, self._dirty = None, False, False

    def _answered(self, answer: Any) -> None:
        self._computing = False
        self._holds = True
        self._rested.setRemainingTime(self.dock.rest_ms)
        self.dock.present(answer)
        self._again()

    def _refused(self, sentence: str) -> None:
        self._computing = False
        self.dock.present_nothing(sentence)
        self._again()

    def _again(self) -> None:
        if self._dirty:
            self._dirty = False
            self._update()


def _is_about_others(scene: Scene, before: Scene) -> bool:
    """Whether the exemplar is another one, or the chosen column's result."""
    if scene.exemplar is not before.exemplar:
        return True
    now, then = scene.selected, before.selected
    return now is not None and then is not None and now.result is not then.result
