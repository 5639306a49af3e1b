"""Edits that end a moment after the last key or turn of a wheel, and the end of all of them at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab.widgets.once import Once

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtCore import QObject


class Settling(Once):
    """Waits until nothing follows, then says that the edit has ended.

    Parameters
    ----------
    parent
        Whose edit it is.
    rest_ms
        How long nothing must follow.
    ended
        Called at its end.
    """

    def __init__(self, parent: QObject, rest_ms: int, ended: Callable[[], object]) -> None:
        super().__init__(parent, rest_ms, lambda: ended())

    def end_now(self) -> None:
        """Do not wait any longer, where something is waited for."""
        if self.isActive():
            self.stop()
            self.timeout.emit()


def settle_all(top: QObject) -> None:
    """End every edit under way within a window: what comes next is about what is seen."""
    for each in top.findChildren(Settling):
        each.end_now()
