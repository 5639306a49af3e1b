"""Layouts of one's own: where panels and tabs are and how their controls stand, kept by name."""

from __future__ import annotations

import base64
import binascii
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QByteArray, QObject, Signal
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QDialog, QHBoxLayout, QLineEdit, QListWidget, QPushButton, QVBoxLayout, QWidget

from texlab.columns.apart import places_from_json, places_to_json
from texlab.widgets.plain import Label, set_tip
from texlab.window.toolbar import LAYOUTS

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from texlab.columns.workspace import Workspace
    from texlab.docks.host import DockHost
    from texlab.storage.settings import Settings
    from texlab.window.main_window import MainWindow

KEPT = "layouts"
MAX_NAME = 60
MAX_LAYOUTS = 50
MAX_STATE = 2**16
MAX_WINDOWS = 32
Controls = dict[str, dict[str, bool | int | float | str]]


@dataclass(frozen=True)
class OwnLayout:
    """How a window was arranged.

    Parameters
    ----------
    base
        The layout that it began with: ``explore``, ``teach`` or ``tune``.
    state
        Places and sizes of panels and tabs, also of those that were closed, as Qt writes them.
    front
        Name of the tab in front; "" for none.
    is_open
        Whether the panels below are seen, and not only their names.
    controls
        How the controls of every tab stood, by tab and by name.
    apart
        Which columns had windows of their own, and where those stood, as the settings have it.
    """

    base: str
    state: bytes
    front: str
    is_open: bool
    controls: Controls
    apart: tuple[Any, ...] = ()

    def to_json(self) -> dict[str, Any]:
        """Return it for the settings."""
        return {
            "base": self.base,
            "state": base64.b64encode(self.state).decode("ascii"),
            "front": self.front,
            "open": self.is_open,
            "controls": self.controls,
            "apart": list(self.apart),
        }


def layout_from_json(value: object) -> OwnLayout | None:
    """Return a layout from the settings; None where it is damaged."""
    if not isinstance(value, dict):
        return None
    base, state, front, is_open = (value.get(name) for name in ("base", "state", "front", "open"))
    if base not in LAYOUTS or not isinstance(state, str) or len(state) > MAX_STATE:
        return None
    if not isinstance(front, str) or not isinstance(is_open, bool):
        return None
    try:
        found = base64.b64decode(state, validate=True)
    except (binascii.Error, ValueError):
        return None
    apart = value.get("apart")
    # What is damaged in it is left out when it is used.
    windows = tuple(apart[:MAX_WINDOWS]) if isinstance(apart, list) else ()
    return OwnLayout(base, found, front, is_open, _controls(value.get("controls")), windows)


def _controls(value: object) -> Controls:
    found: Controls = {}
    for tab, controls in value.items() if isinstance(value, dict) else ():
        if isinstance(controls, dict):
            found[tab] = {
                name: each for name, each in controls.items() if isinstance(each, bool | int | float | str)
            }
    return found


def name_problem(name: str, taken: Collection[str]) -> str:
    """Return what is wrong with the name of a new layout, in one sentence; "" when nothing is."""
    wanted = name.strip()
    if not 0 < len(wanted) <= MAX_NAME or not wanted.isprintable():
        return f"A name has 1 to {MAX_NAME} characters in one line; this one has {len(wanted)}."
    if wanted.casefold() in map(str.casefold, LAYOUTS):
        return f"{wanted.capitalize()} is a layout of the program; take another name."
    if wanted not in taken and len(taken) >= MAX_LAYOUTS:
        return f"At most {MAX_LAYOUTS} layouts are kept; delete one first."
    return ""


class OwnLayouts(QObject):
    """Keeps layouts in the settings, and arranges the window so again.

    Parameters
    ----------
    window, hosts
        What is arranged.
    settings
        Where they are kept.
    arrange
        Arranges one of the program's layouts by its name.
    workspace
        Whose columns may have windows of their own.
    """

    changed = Signal()

    def __init__(
        self,
        window: MainWindow,
        hosts: Mapping[str, DockHost],
        settings: Settings,
        arrange: Callable[[str], None],
        workspace: Workspace,
    ) -> None:
        super().__init__(window)
        self._window = window
        self._hosts = hosts
        self._settings = settings
        self._arrange = arrange
        self._workspace = workspace
        self._actions: list[QAction] = []
        self._offer()

    @property
    def layouts(self) -> dict[str, OwnLayout]:
        """All of them by name, in the order in which they were kept; what is damaged is left out."""
        kept = self._settings.values.get(KEPT)
        read = {name: layout_from_json(each) for name, each in kept.items()} if isinstance(kept, dict) else {}
        return {name: each for name, each in read.items() if each is not None and not name_problem(name, read)}

    def now(self) -> OwnLayout:
        """Return how the window is arranged at present."""
        window = self._window
        base = self._settings.text("layout", "explore")
        front = next((name for name, host in self._hosts.items() if host.seen), "")
        controls = {name: host.settings() for name, host in self._hosts.items()}
        state = bytes(window.saveState().data())
        apart = tuple(places_to_json(self._workspace.apart.places, self._workspace.order))
        base = base if base in LAYOUTS else "explore"
        return OwnLayout(base, state, front, window.strip.is_open, controls, apart)

    def keep(self, name: str, layout: OwnLayout | None = None) -> None:
        """Keep a layout, or the present one, under a name; one of the same name is replaced."""
        self._set({**self.layouts, name.strip(): layout or self.now()})

    def forget(self, name: str) -> None:
        """Forget a layout."""
        self._set({each: layout for each, layout in self.layouts.items() if each != name})

    def take(self, name: str) -> None:
        """Arrange the window as it was kept."""
        layout = self.layouts.get(name)
        if layout is None:
            return
        self._arrange(layout.base)
        window = self._window
        window.strip.set_open(True)
        window.restoreState(QByteArray(layout.state))
        for name, host in self._hosts.items():
            # What another exemplar or method does not offer stays as it is.
            if name in layout.controls:
                host.take_settings(layout.controls[name])
        front = window.docks.get(layout.front)
        if front is not None and not front.isHidden():
            front.raise_()
        window.strip.set_open(layout.is_open)
        self._workspace.take_apart(places_from_json(list(layout.apart), self._workspace.order))

    def _set(self, layouts: dict[str, OwnLayout]) -> None:
        self._settings.values[KEPT] = {name: layout.to_json() for name, layout in layouts.items()}
        self._offer()
        self.changed.emit()

    def _offer(self) -> None:
        """Let menu, toolbar and palette offer what there is."""
        window = self._window
        for action in self._actions:
            del window.actions_by_name[action.objectName().removeprefix("action-")]
            window.toolbar.layout_menu.removeAction(action)
            action.deleteLater()
        self._actions = []
        for index, name in enumerate(self.layouts):
            # A name is no place for a mnemonic.
            action = QAction(f"Layout {name.replace('&', '&&')}", window)
            action.setObjectName(f"action-own-layout-{index}")
            action.triggered.connect(partial(self._taken, name))
            window.actions_by_name[f"own-layout-{index}"] = action
            window.toolbar.layout_menu.insertAction(window.actions_by_name["own-layouts"], action)
            self._actions.append(action)

    def _taken(self, name: str, _: bool = False) -> None:
        self.take(name)

    def ask(self) -> None:
        """Open the dialog."""
        LayoutsDialog(self, self._window).open()


class LayoutsDialog(QDialog):
    """Lists the layouts: keep the present one, take another, delete one and bring it back."""

    def __init__(self, own: OwnLayouts, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("layouts-dialog")
        self.setWindowTitle("Own layouts")
        self.finished.connect(self.deleteLater)
        self._own = own
        self._gone: tuple[str, OwnLayout] | None = None
        self.name = QLineEdit()
        self.name.setMaxLength(2 * MAX_NAME)
        self.name.setPlaceholderText("Name of the present layout")
        self.keep = QPushButton("Keep")
        self.list = QListWidget()
        self.take = QPushButton("Arrange so")
        self.delete = QPushButton("Delete")
        self.back = QPushButton("Bring back")
        self.done_button = QPushButton("Close")
        self.message = Label(
            "Panels, tabs and how their controls stand are kept.", name="layouts-message", muted=True, wraps=True
        )
        for widget, part, label, tip in (
            (self.name, "name", "Name", f"1 to {MAX_NAME} characters; one of the same name is replaced"),
            (self.keep, "keep", "Keep", "Keep how the window is arranged now"),
            (self.list, "list", "Layouts", "Layouts that were kept; Enter arranges the window so"),
            (self.take, "take", "Arrange so", "Arrange the window as it was kept"),
            (self.delete, "delete", "Delete", "Forget the chosen layout"),
            (self.back, "back", "Bring back", "Keep again what was deleted last"),
            (self.done_button, "close", "Close", "Close this box"),
        ):
            widget.setObjectName(f"layouts-{part}")
            widget.setAccessibleName(label)
            set_tip(widget, tip)
        for button in (self.keep, self.take, self.delete, self.back, self.done_button):
            button.setAutoDefault(False)
        first = QHBoxLayout()
        first.addWidget(self.name, 1)
        first.addWidget(self.keep)
        last = QHBoxLayout()
        for button in (self.take, self.delete, self.back):
            last.addWidget(button)
        last.addStretch(1)
        last.addWidget(self.done_button)
        layout = QVBoxLayout(self)
        layout.addLayout(first)
        layout.addWidget(self.list, 1)
        layout.addWidget(self.message)
        layout.addLayout(last)
        self.name.textChanged.connect(self._check)
        self.name.returnPressed.connect(self._keep)
        self.keep.clicked.connect(self._keep)
        self.list.currentRowChanged.connect(lambda _: self._follow())
        self.list.itemActivated.connect(lambda _: self._take())
        self.take.clicked.connect(self._take)
        self.delete.clicked.connect(self._delete)
        self.back.clicked.connect(self._bring_back)
        self.done_button.clicked.connect(self.accept)
        self._fill()
        self._check()

    def _fill(self, chosen: str = "") -> None:
        self.list.clear()
        self.list.addItems(list(self._own.layouts))
        names = [self.list.item(row).text() for row in range(self.list.count())]
        self.list.setCurrentRow(names.index(chosen) if chosen in names else min(0, len(names) - 1))
        self._follow()

    def _follow(self) -> None:
        chosen = self.list.currentItem() is not None
        self.take.setEnabled(chosen)
        self.delete.setEnabled(chosen)
        self.back.setEnabled(self._gone is not None)

    def _check(self) -> None:
        typed = self.name.text()
        problem = name_problem(typed, self._own.layouts)
        self.keep.setEnabled(not problem)
        if typed.strip():
            exists = typed.strip() in self._own.layouts
            self.message.setText(problem or ("This replaces the one of the same name." if exists else ""))

    def _keep(self) -> None:
        name = self.name.text().strip()
        if name_problem(name, self._own.layouts):
            return
        self._own.keep(name)
        self._fill(name)
        self.name.clear()
        self.message.setText(f"“{name}” is kept; the Layout button offers it.")

    def _take(self) -> None:
        item = self.list.currentItem()
        if item is not None:
            self.accept()
            self._own.take(item.text())

    def _delete(self) -> None:
        item = self.list.currentItem()
        if item is not None:
            name = item.text()
            self._gone = (name, self._own.layouts[name])
            self._own.forget(name)
            self._fill()
            self.message.setText(f"“{name}” is deleted; Bring back keeps it again.")

    def _bring_back(self) -> None:
        if self._gone is None:
            return
        (name, layout), self._gone = self._gone, None
        self._own.keep(name, layout)
        self._fill(name)
        self.message.setText(f"“{name}” is back.")
