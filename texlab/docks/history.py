"""The steps of the session as a list: where one stands, and a click goes there."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtGui import QBrush, QColor
from PySide6.QtWidgets import QListWidget, QListWidgetItem, QVBoxLayout

from texlab.docks.base import Question
from texlab.docks.frame import FramedDock
from texlab.docks.recent import Same
from texlab.state.history import NO_HISTORY
from texlab.state.intentions import GoToState

if TYPE_CHECKING:
    from texlab.state.history import History
    from texlab.state.scene import Scene
    from texlab.style.theme import Theme

START = "As it was opened"


class HistoryDock(FramedDock):
    """Lists what was done, the newest below; what undo has taken back is pale, and a click brings it again."""

    name = "history"
    title = "History"
    help = "Every change of this session; click one to go back to it, or forward again."
    order = 98
    rest_ms = 0
    empty = "Nothing was changed yet."

    def build(self) -> None:
        """Make the list."""
        self._history = NO_HISTORY
        self.list = QListWidget()
        self.list.setObjectName("history-list")
        self.list.setAccessibleName("Steps of the session")
        self.list.setUniformItemSizes(True)
        self.list.currentRowChanged.connect(self._go)
        layout = QVBoxLayout(self.body)
        layout.setContentsMargins(6, 0, 6, 6)
        layout.addWidget(self.list)

    def question(self, scene: Scene) -> Question | None:
        """Take the names of the steps; there is nothing to compute."""
        history = scene.history
        if len(history.texts) < 2:
            self.why = self.empty
            self.controls.hide()
            return None
        self.controls.show()
        return Question((self.name, Same(history)), lambda _: history)

    def show_answer(self, answer: History) -> None:
        """List the steps and stand at the present one."""
        self._history = answer
        with QSignalBlocker(self.list):
            texts = [_named(text) for text in answer.texts]
            # A long list stays where it was scrolled to while its end grows.
            if [self.list.item(row).text() for row in range(self.list.count())] != texts:
                self.list.clear()
                for text in texts:
                    self.list.addItem(QListWidgetItem(text))
            self.list.setCurrentRow(answer.at)
        self._colour()
        self.list.scrollToItem(self.list.item(answer.at))

    def paint_theme(self, theme: Theme) -> None:
        """Colour what was taken back."""
        self._colour()

    def _colour(self) -> None:
        pale = QBrush(QColor(self.theme.muted))
        for row in range(self.list.count()):
            self.list.item(row).setData(Qt.ItemDataRole.ForegroundRole, pale if row > self._history.at else None)

    def _go(self, row: int) -> None:
        if row >= 0 and row != self._history.at:
            self.intention.emit(GoToState(row))


def _named(text: str) -> str:
    return text[:1].upper() + text[1:] if text else START
