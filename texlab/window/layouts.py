"""Where the panels are: for exploring, teaching and tuning."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication

from texlab.style.text_size import ZOOMS, capitals_of, set_least, teach_points
from texlab.style.theme import set_text_size
from texlab.widgets.tables import fit_rows
from texlab.window.panel_strip import LOW

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from PySide6.QtCore import QByteArray
    from PySide6.QtWidgets import QDockWidget, QMainWindow

    from texlab.storage.settings import Settings
    from texlab.style.theme import ThemeSource
    from texlab.window.panel_strip import PanelStrip

# What is in front, and the share of the height and the width of the parameters in pixels.
FRONT = {"explore": "pyramid", "teach": "pyramid"}
HEIGHTS = {"explore": 0.33, "teach": 0.45, "tune": 0.3}
WIDTHS = {"explore": 250, "teach": 270, "tune": 320}
SIDES = {"gallery": Qt.DockWidgetArea.LeftDockWidgetArea, "parameters": Qt.DockWidgetArea.RightDockWidgetArea}


@dataclass(frozen=True)
class _Left:
    """A layout as the user left it."""

    layout: str
    state: QByteArray
    is_open: bool


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
        self._shown_points = self._points
        self._share = HEIGHTS["teach"]
        self._before: _Left | None = None
        self.leaving: Callable[[], None] = lambda: None
        """Called before every change of the layout."""
        self.changed: Callable[[], None] = lambda: None
        """Called after it."""
        self.resized: Callable[[], None] = lambda: None
        """Called when text has followed the height of the window."""

    def arrange(self, layout: str, tuning: str = "histograms") -> None:
        """Arrange the panels: ``explore``, ``teach`` or ``tune``; ``tuning`` is the tab in front for the last.

        Who goes from Teach to the layout that was before finds it as it was left.
        """
        self.leaving()
        before, self._before = self._before, None
        if layout == "teach":
            self._before = before or (None if self.current == "teach" else self._as_it_is())
        self._settings.values["layout"] = layout
        self.set_text_size()
        if before is not None and before.layout == layout:
            self._bring_back(before)
        else:
            self._place(layout, tuning)
        self.changed()

    def _place(self, layout: str, tuning: str) -> None:
        window, docks = self._window, self._docks
        tabs = [dock for name, dock in docks.items() if name not in SIDES]
        seen = [dock for dock in tabs if not dock.visibleRegion().isEmpty()]
        self._bring_home(tabs)
        docks["gallery"].setVisible(layout == "explore")
        docks["parameters"].setVisible(layout != "teach")
        for dock in tabs:
            dock.show()
        # Where pictures and panels have no room side by side, exploring is about the pictures.
        self._strip.set_open(layout != "explore" or window.height() >= LOW)
        if tabs:
            front = docks.get(FRONT.get(layout, tuning), tabs[0])
            if layout == "teach":
                # What was looked at is what is shown to others.
                front = seen[0] if seen else front
                for dock in tabs:
                    dock.setVisible(dock is front)
            front.raise_()
            if self._strip.is_open:
                self.share_height(HEIGHTS[layout])
        window.resizeDocks([docks["parameters"]], [WIDTHS[layout]], Qt.Orientation.Horizontal)

    def follow_size(self) -> None:
        """Let text and tab keep their share of a window of another height, when teaching."""
        self.set_text_size()
        if self.current == "teach" and self._strip.is_open:
            self.share_height(self._share)
        self.resized()

    def share_height(self, share: float) -> None:
        """Give the open tab this share of the window's height."""
        self._share = share
        tabs = [dock for name, dock in self._docks.items() if name not in SIDES and dock.isVisible()]
        if tabs:
            self._window.resizeDocks(tabs[:1], [round(self._window.height() * share)], Qt.Orientation.Vertical)

    def _as_it_is(self) -> _Left:
        return _Left(self.current, self._window.saveState(), self._strip.is_open)

    def _bring_back(self, left: _Left) -> None:
        self._strip.set_open(left.is_open)
        self._window.restoreState(left.state)
        self._strip.refresh()

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

    @property
    def current(self) -> str:
        """Name of the layout."""
        return self._settings.text("layout")

    def show_alone(self, name: str) -> None:
        """When teaching, hide all tabs but this one."""
        if self.current == "teach" and name not in SIDES:
            for other, dock in self._docks.items():
                if other not in SIDES:
                    dock.setVisible(other == name)

    @property
    def usual_points(self) -> float:
        """Size of text, in points, without zoom and when nobody teaches."""
        return self._points

    @property
    def zoom(self) -> float:
        """The user's factor for all texts."""
        kept = self._settings.values.get("text-zoom")
        return kept if isinstance(kept, float) and ZOOMS[0] <= kept <= ZOOMS[-1] else 1.0

    def set_zoom(self, zoom: float) -> None:
        """Make all texts larger or smaller."""
        self._settings.values["text-zoom"] = zoom
        self.set_text_size()

    def set_text_size(self) -> None:
        """Give all texts their size: when teaching, that of the window's height."""
        application = QApplication.instance()
        if not isinstance(application, QApplication):
            return
        points = self._points * self.zoom
        teaches = self.current == "teach"
        if teaches:
            points = teach_points(self._window.height(), self.zoom, capitals_of(application.font()))
        set_least(points if teaches else 0.0)
        if points != self._shown_points:
            self._shown_points = points
            set_text_size(application, points, self._themes.theme)
            fit_rows(self._window)
