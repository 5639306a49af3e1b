"""A panel that takes the whole stage: the pictures make room until they are wanted back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QPushButton, QWidget

from texlab.widgets.plain import Label

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from PySide6.QtWidgets import QDockWidget, QMainWindow

    from texlab.window.message_bar import MessageBar
    from texlab.window.panel_strip import PanelStrip

UNLIMITED = 16_777_215


class BigPanel(QObject):
    """Lets the panels below have all of the height, with a line above them that leads back."""

    def __init__(
        self,
        window: QMainWindow,
        docks: Mapping[str, QDockWidget],
        strip: PanelStrip,
        middle: QWidget,
        show: Callable[[str], None],
        messages: MessageBar,
    ) -> None:
        super().__init__(window)
        self._window = window
        self._docks = docks
        self._middle = middle
        self._show = show
        self._messages = messages
        self._stage: QWidget | None = None
        self._height = 0
        self.bar = QFrame(middle)
        self.bar.setObjectName("big-panel-bar")
        row = QHBoxLayout(self.bar)
        row.setContentsMargins(6, 2, 6, 2)
        self.label = Label("The panels have the whole stage.", muted=True)
        self.button = QPushButton("Back to the pictures")
        self.button.setObjectName("big-panel-back")
        self.button.clicked.connect(self.give_back)
        row.addWidget(self.label, 1)
        row.addWidget(self.button)
        self.bar.hide()
        strip.toggled.connect(lambda is_open: None if is_open else self.give_back())

    @property
    def is_big(self) -> bool:
        """Whether the panels have the stage."""
        return self.bar.isVisibleTo(self._middle)

    def set_stage(self, stage: QWidget) -> None:
        """Say what makes room."""
        self._stage = stage

    def toggle(self, name: str) -> None:
        """Let a panel take the stage; give it back when they have it."""
        if self.is_big:
            self.give_back()
            return
        dock = self._docks.get(name)
        if dock is None or self._stage is None or dock.isFloating():
            return
        self._show(name)
        self._height = dock.height()
        self._stage.hide()
        # The line is too low for a sentence: that lies over the panel.
        self._messages.lie_over(self._middle, self._window)
        self.bar.show()
        self._middle.setMaximumHeight(max(self.bar.sizeHint().height(), self._middle.minimumSizeHint().height()))
        self._window.resizeDocks([dock], [self._window.height()], Qt.Orientation.Vertical)

    def give_back(self) -> None:
        """Show the pictures again."""
        if not self.is_big or self._stage is None:
            return
        self.bar.hide()
        self._middle.setMaximumHeight(UNLIMITED)
        self._stage.show()
        self._messages.lie_over(self._middle, self._middle)
        dock = next(
            (
                each
                for each in self._docks.values()
                if each.isVisible()
                and not each.isFloating()
                and self._window.dockWidgetArea(each) == Qt.DockWidgetArea.BottomDockWidgetArea
            ),
            None,
        )
        if dock is not None and self._height:
            self._window.resizeDocks([dock], [self._height], Qt.Orientation.Vertical)
