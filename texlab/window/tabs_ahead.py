"""Makes tabs before they are shown: those that a lesson needs, and all others while nobody does anything."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QDeadlineTimer, QEvent, QObject, QTimer, Signal
from PySide6.QtWidgets import QApplication

from texlab.widgets.once import Once
from texlab.window.lesson_desk import tab_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from texlab.docks.host import DockHost
    from texlab.window.main_window import MainWindow
    from texlab_core.documents.lessons import LessonStep

# What the user does between two pieces of a tab is not kept waiting for both.
PAUSE_MS = 5
# Nobody has touched anything for so long, and nothing was computed.
REST_MS = 2000
LOOK_MS = 500
# Between two pieces at rest: nobody waits for them.
STEP_MS = 40
HANDS = frozenset(
    (
        QEvent.Type.MouseMove,
        QEvent.Type.MouseButtonPress,
        QEvent.Type.MouseButtonRelease,
        QEvent.Type.Wheel,
        QEvent.Type.KeyPress,
        QEvent.Type.KeyRelease,
        QEvent.Type.TouchBegin,
        QEvent.Type.TouchUpdate,
        QEvent.Type.TabletMove,
        QEvent.Type.TabletPress,
    )
)


class TabsAhead(QObject):
    """Makes tabs, and the parts of them that steps show, so that a step has nothing left to make.

    ``advanced()`` when something more was made.
    """

    advanced = Signal()

    def __init__(self, hosts: Mapping[str, DockHost], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._hosts = hosts
        self._left: list[LessonStep] = []
        self._timer = Once(self, PAUSE_MS, self._make_one)

    def want(self, steps: Iterable[LessonStep]) -> None:
        """Make ready what these steps show, the first of them first, and nothing else any more."""
        self._left = [step for step in steps if not self.ready(step)]
        self._timer.stop()
        if self._left:
            self._timer.start()

    def ready(self, step: LessonStep) -> bool:
        """Return whether everything is made that a step shows; a tab that there is not is never waited for."""
        host = self._hosts.get(tab_of(step))
        if host is None:
            return True
        return host.is_made and (step.tab is None or host.dock.is_prepared(step.tab.settings))

    def _make_one(self) -> None:
        while self._left and self.ready(self._left[0]):
            self._left.pop(0)
        if not self._left:
            # A tab that is seen is made by itself.
            self.advanced.emit()
            return
        step = self._left[0]
        host = self._hosts[tab_of(step)]
        if not host.is_made:
            host.make_more()
        elif step.tab is not None:
            host.dock.prepare(step.tab.settings)
        self._timer.start()
        self.advanced.emit()


class TabsAtRest(QObject):
    """Makes the tabs that nobody has seen, piece by piece, once hands and machine have rested for a while.

    Any event of mouse or keyboard in the window, a menu or a box that is open, and anything that is computed begin
    the rest anew. When all tabs are made it looks no more.

    Parameters
    ----------
    window
        Whose tabs they are.
    is_idle
        Says that nothing is computed.
    """

    def __init__(self, window: MainWindow, is_idle: Callable[[], bool], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._window = window
        self._is_idle = is_idle
        self._rested = QDeadlineTimer()
        self._look = QTimer(self)
        self._look.setInterval(LOOK_MS)
        self._look.timeout.connect(self._see)
        self._next = Once(self, STEP_MS, self._make)

    @property
    def active(self) -> bool:
        """Whether there are tabs left that will be made."""
        return self._look.isActive()

    def start(self) -> None:
        """Look out for rests, until all tabs are made."""
        handle = self._window.windowHandle()
        if handle is not None:
            handle.installEventFilter(self)
        self._begin_anew()
        self._look.start()

    def stop(self) -> None:
        """Make nothing more."""
        self._look.stop()
        self._next.stop()
        handle = self._window.windowHandle()
        if handle is not None:
            handle.removeEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Leave the turn to the hands."""
        if event.type() in HANDS:
            self._begin_anew()
        return super().eventFilter(watched, event)

    def _begin_anew(self) -> None:
        self._rested.setRemainingTime(REST_MS)
        self._next.stop()

    def _rests(self) -> bool:
        if QApplication.activePopupWidget() is not None or QApplication.activeModalWidget() is not None:
            return False
        return self._is_idle()

    def _see(self) -> None:
        if not self._rests():
            self._begin_anew()
        elif self._rested.hasExpired() and not self._next.isActive():
            self._next.start()

    def _make(self) -> None:
        if not self._rests():
            self._begin_anew()
        elif self._window.make_more():
            self._next.start()
        else:
            self.stop()
