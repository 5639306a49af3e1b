"""Makes the tabs that a lesson needs before its steps are shown, one in every idle moment."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from texlab.widgets.once import Once
from texlab.window.lesson_desk import tab_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from texlab.docks.host import DockHost
    from texlab_core.documents.lessons import LessonStep

# Making a tab takes up to 60 ms: what the user does in between is not kept waiting for two.
PAUSE_MS = 10


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
            return
        step = self._left[0]
        host = self._hosts[tab_of(step)]
        if not host.is_made:
            host.make()
        elif step.tab is not None:
            host.dock.prepare(step.tab.settings)
        self._timer.start()
        self.advanced.emit()
