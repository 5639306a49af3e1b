"""How the stage is shown: rows, surround, zoom. Remembered between two starts."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtGui import QActionGroup

from texlab.widgets.zoom_box import ZoomBox

if TYPE_CHECKING:
    from texlab.columns.workspace import Workspace
    from texlab.storage.settings import Settings
    from texlab.window.main_window import MainWindow

# Lightness 50 of CIELAB: as far from black as from white.
SURROUNDS = {"grey": "#777777", "theme": "", "black": "#000000", "white": "#ffffff"}
ROWS = ("largest", "one", "two")


class StageSettings(QObject):
    """Connects the commands about the stage with it, and keeps what was chosen."""

    def __init__(self, window: MainWindow, workspace: Workspace, settings: Settings) -> None:
        super().__init__(window)
        self._window = window
        self._workspace = workspace
        self._settings = settings
        self.exemplar_zoom = ZoomBox(
            "zoom-exemplar", "Zoom of the exemplar", "Zoom of the exemplar; type a number", workspace.exemplar_link
        )
        self.zoom = ZoomBox(
            "zoom-results",
            "Zoom of the results",
            "Zoom of the results (1: 100 %, F: whole pictures); type a number",
            workspace.link,
        )
        window.status.add_zoom("Results", self.zoom)
        window.status.add_zoom("Exemplar", self.exemplar_zoom)
        self._group("rows", ROWS, "largest")
        self._group("surround", tuple(SURROUNDS), "grey")
        linked = settings.values.get("linked") is True
        link = window.actions_by_name["link"]
        link.setChecked(linked)
        workspace.set_linked(linked)
        link.toggled.connect(self._keep_linked)
        self.exemplar_zoom.setEnabled(not linked)

    def _group(self, what: str, names: tuple[str, ...], default: str) -> None:
        kept = self._settings.text(what)
        chosen = kept if kept in names else default
        group = QActionGroup(self)
        for name in names:
            action = self._window.actions_by_name[f"{what}-{name}"]
            action.setCheckable(True)
            action.setChecked(name == chosen)
            group.addAction(action)
            action.triggered.connect(partial(self._choose, what, name))
        self._show(what, chosen)

    def _choose(self, what: str, name: str, _: bool = False) -> None:
        self._settings.values[what] = name
        self._show(what, name)

    def _show(self, what: str, name: str) -> None:
        if what == "surround":
            self._workspace.set_surround(SURROUNDS[name])
        else:
            self._workspace.set_rows(name)  # type: ignore[arg-type]  # one of ROWS

    def _keep_linked(self, linked: bool) -> None:
        self._settings.values["linked"] = linked
        self.exemplar_zoom.setEnabled(not linked)
