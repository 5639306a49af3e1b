"""Where the panels are: for exploring, teaching and tuning."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication

from texlab.style.theme import set_text_size
from texlab.window.panel_strip import LOW

if TYPE_CHECKING:
    from collections.abc import Mapping

    from PySide6.QtWidgets import QDockWidget, QMainWindow

    from texlab.storage.settings import Settings
    from texlab.style.theme import ThemeSource
    from texlab.window.panel_strip import PanelStrip

TEACH_FACTOR = 1.35
# What is in front, and the share of the height and the width of the parameters in pixels.
FRONT = {"explore": "pyramid", "teach": "pyramid"}
HEIGHTS = {"explore": 0.33, "teach": 0.45, "tune": 0.3}
WIDTHS = {"explore": 250, "teach": 270, "tune": 380}
SIDES = {"gallery": Qt.DockWidgetArea.LeftDockWidgetArea, "parameters": Qt.DockWidgetArea.RightDockWidgetArea}


class Layouts:
    """Arranges the panels of a window, by name; ``settings`` remember how."""

    def __init__(
        self,
        window: QMainWindow,
        docks: Mapping[str, QDockWidget],
        settings: Settings,
        themes: ThemeSource,
        strip: PanelStrip,
    ) -> None:
        self._strip = strip
        self._window = window
        self._docks = docks
        self._settings = settings
        self._themes = themes
        self._points = QApplication.font().pointSizeF()

    def arrange(self, layout: str, tuning: str = "histograms") -> None:
        """Arrange the panels: ``explore``, ``teach`` or ``tune``; ``tuning`` is the tab in front for the last."""
        window, docks = self._window, self._docks
        tabs = [dock for name, dock in docks.items() if name not in SIDES]
        self._bring_home(tabs)
        docks["gallery"].setVisible(layout == "explore")
        docks["parameters"].setVisible(layout != "teach")
        self.set_text_size(layout)
        for dock in tabs:
            dock.show()
        # Where pictures and panels have no room side by side, exploring is about the pictures.
        self._strip.set_open(layout != "explore" or window.height() >= LOW)
        if tabs:
            docks.get(FRONT.get(layout, tuning), tabs[0]).raise_()
            height = round(window.height() * HEIGHTS[layout])
            if self._strip.is_open:
                window.resizeDocks([tabs[0]], [height], Qt.Orientation.Vertical)
        window.resizeDocks([docks["parameters"]], [WIDTHS[layout]], Qt.Orientation.Horizontal)
        self._settings.values["layout"] = layout

    def _bring_home(self, tabs: list[QDockWidget]) -> None:
        """Put every dock that was dragged elsewhere where it belongs."""
        window = self._window
        for name, dock in self._docks.items():
            home = SIDES.get(name, Qt.DockWidgetArea.BottomDockWidgetArea)
            if dock.isFloating():
                dock.setFloating(False)
            if window.dockWidgetArea(dock) != home:
                window.addDockWidget(home, dock)
        if tabs and set(window.tabifiedDockWidgets(tabs[0])) != set(tabs[1:]):
            for dock in tabs[1:]:
                window.tabifyDockWidget(tabs[0], dock)

    def set_text_size(self, layout: str) -> None:
        """Enlarge all texts for teaching."""
        application = QApplication.instance()
        if isinstance(application, QApplication):
            points = self._points * (TEACH_FACTOR if layout == "teach" else 1.0)
            set_text_size(application, points, self._themes.theme)
