"""The panels below the pictures: open, or only their names as a strip."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QSize, Qt, Signal

if TYPE_CHECKING:
    from collections.abc import Mapping

    from PySide6.QtWidgets import QDockWidget, QMainWindow, QTabBar

    from texlab.storage.settings import Settings

# Below this height of the window, in pixels, panels and pictures have no room side by side.
LOW = 1200
SHARE = 0.4
LEAST = 120
# A panel that floats is at least as large when it leaves the strip.
FLOATING = QSize(480, 240)
UNLIMITED = 16_777_215
KEPT = "panels"


class PanelStrip(QObject):
    """Opens and closes the docks at the lower edge; a click on a name opens it, one on the open one closes all.

    ``toggled(open)`` after every change.
    """

    toggled = Signal(bool)

    def __init__(self, window: QMainWindow, docks: Mapping[str, QDockWidget], settings: Settings) -> None:
        super().__init__(window)
        self._window = window
        self._docks = docks
        self._settings = settings
        self._open = True
        self._height = 0
        self._watched: list[QTabBar] = []

    @property
    def is_open(self) -> bool:
        """Whether the panels are seen, and not only their names."""
        return self._open

    def start(self) -> None:
        """Open the panels, or not, as they were left; at first by the height of the window."""
        kept = self._settings.values.get(KEPT)
        self.set_open(kept if isinstance(kept, bool) else self._window.height() >= LOW)

    def watch(self, tabs: QTabBar) -> None:
        """Follow the clicks on the names of the panels."""
        if tabs not in self._watched:
            self._watched.append(tabs)
            tabs.tabBarClicked.connect(lambda place: self._clicked(tabs, place))

    def set_open(self, wanted: bool) -> None:
        """Show the panels, or only their names."""
        if wanted == self._open:
            return
        below = self._below()
        if not wanted:
            self._height = max([dock.height() for dock in below if dock.isVisible()], default=0)
        self._open = wanted
        self._settings.values[KEPT] = wanted
        self.refresh()
        if wanted and below:
            height = max(self._height, LEAST) if self._height else round(self._window.height() * SHARE)
            self._window.resizeDocks([below[0]], [height], Qt.Orientation.Vertical)
        self.toggled.emit(wanted)

    def toggle(self) -> None:
        """Open what is closed, close what is open."""
        self.set_open(not self._open)

    def follow(self, dock: QDockWidget) -> None:
        """Take note when a dock is let float, or comes back."""
        dock.topLevelChanged.connect(lambda floats: self._floated(dock, floats))

    def _floated(self, dock: QDockWidget, floats: bool) -> None:
        self.refresh()
        if floats and dock.height() < FLOATING.height():
            # One that was never seen, or was only a name, has no height of its own.
            dock.resize(dock.size().expandedTo(FLOATING))

    def refresh(self) -> None:
        """Let what was dragged out of the strip be seen, and what came into it not."""
        below = self._below()
        for dock in self._docks.values():
            dock.setMaximumHeight(UNLIMITED if self._open or dock not in below else 0)

    def _below(self) -> list[QDockWidget]:
        area = Qt.DockWidgetArea.BottomDockWidgetArea
        return [
            dock
            for dock in self._docks.values()
            if not dock.isFloating() and self._window.dockWidgetArea(dock) == area
        ]

    def _clicked(self, tabs: QTabBar, place: int) -> None:
        if place >= 0 and tabs.isVisible():
            # The bar has not turned to the new name yet.
            self.set_open(not self._open or place != tabs.currentIndex())
