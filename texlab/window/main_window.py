"""The main window: the shell that shows at once, and what is put into it a moment later."""

from __future__ import annotations

import base64
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QByteArray, QChildEvent, QEvent, Qt, QTimer, Signal
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import (
    QApplication,
    QDockWidget,
    QMainWindow,
    QMenu,
    QTabBar,
    QVBoxLayout,
    QWidget,
)

from texlab.form.panel import ParametersView
from texlab.style.icons import application_icon
from texlab.style.theme import apply_theme
from texlab.widgets.mime import brought_by, take_copy
from texlab.widgets.once import Once
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.title_bar import grow_title
from texlab.window.big_panel import BigPanel
from texlab.window.commands import COMMANDS, make_actions
from texlab.window.gallery import GalleryView
from texlab.window.layouts import SIDES, Layouts
from texlab.window.lesson_bar import LessonBar
from texlab.window.message_bar import MessageBar
from texlab.window.message_room import room_for_messages
from texlab.window.panel_strip import PanelStrip
from texlab.window.screen_fit import first_window, panel_sizes, within
from texlab.window.status_bar import StatusBar
from texlab.window.stops import FocusRing, next_stop
from texlab.window.toolbar import LAYOUTS, ToolBar

if TYPE_CHECKING:
    from collections.abc import Mapping

    from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDragMoveEvent, QDropEvent, QResizeEvent

    from texlab.columns.workspace import Workspace
    from texlab.docks.host import DockHost
    from texlab.state.session import Session
    from texlab.storage.settings import Settings
    from texlab.style.theme import Theme, ThemeSource
    from texlab.window.screen_fit import Rect


# Commands that need a chosen column, besides those of the tool bar.
OF_ONE = ("enlarge", "apart", "rename", "history", "pin", "own-seed", "new-seed")


class MainWindow(QMainWindow):
    """Menus, tool bar, gallery, parameters, docks and status bar.

    ``dropped(brought)`` is a :class:`Brought`; ``closing`` comes before the window goes.
    """

    dropped = Signal(object)
    closing = Signal()

    def __init__(self, settings: Settings, themes: ThemeSource) -> None:
        super().__init__()
        self.setObjectName("main-window")
        self.setWindowTitle("TexLab")
        self.setWindowIcon(application_icon())
        self.setAcceptDrops(True)
        self.setDockNestingEnabled(True)
        # While an edge is dragged, text waits.
        self._text = Once(self, 100, self._follow_height)
        self.setGeometry(*first_window(self._available()))
        self.settings = settings
        self.themes = themes
        self.actions_by_name = make_actions(self)
        self.docks: dict[str, QDockWidget] = {}
        self._hosts: Mapping[str, DockHost] = {}
        self.strip = PanelStrip(self, self.docks, settings)
        self.layouts = Layouts(self, self.docks, settings, themes, self.strip)
        self._workspace: Workspace | None = None
        self._middle = QWidget()
        self.message_bar = MessageBar(self._middle)
        self._middle.setObjectName("middle")
        self._middle_layout = QVBoxLayout(self._middle)
        self._middle_layout.setContentsMargins(0, 0, 0, 0)
        self._middle_layout.setSpacing(0)
        self.lesson_bar = LessonBar(self.actions_by_name)
        self._middle_layout.addWidget(self.lesson_bar)
        self.big_panel = BigPanel(self, self.docks, self.strip, self._middle, self.raise_dock, self.message_bar)
        self._middle_layout.addWidget(self.big_panel.bar)
        self._loading = Label("")
        self._loading.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._middle_layout.addWidget(self._loading, 1)
        self.setCentralWidget(self._middle)
        # Keys are commands until a field is clicked: the search field must not get them first.
        self._middle.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self._middle.setFocus()
        self.gallery = GalleryView()
        self.parameters = ParametersView()
        gallery, parameters, _ = panel_sizes(self.width(), self.height())
        self._add_side("Gallery", self.gallery, Qt.DockWidgetArea.LeftDockWidgetArea, gallery)
        self._add_side("Parameters", self.parameters, Qt.DockWidgetArea.RightDockWidgetArea, parameters)
        self.setCorner(Qt.Corner.BottomLeftCorner, Qt.DockWidgetArea.LeftDockWidgetArea)
        self.setCorner(Qt.Corner.BottomRightCorner, Qt.DockWidgetArea.RightDockWidgetArea)
        self._make_menus()
        self.toolbar = ToolBar(self.actions_by_name)
        self.addToolBar(self.toolbar)
        self.toolbar.layout_menu.aboutToShow.connect(self._mark_layout)
        self.status = StatusBar()
        self.setStatusBar(self.status)
        self._restore_geometry()
        self.show_theme(themes.theme)
        self.layouts.set_text_size()
        themes.changed.connect(self.show_theme)
        self._ring = FocusRing(self)

    # Building.

    def _add_side(self, title: str, widget: QWidget, area: Qt.DockWidgetArea, width: int) -> None:
        dock = QDockWidget(title, self)
        dock.setObjectName(f"side-{title.lower()}")
        dock.setWidget(widget)
        grow_title(dock)
        widget.setMinimumWidth(150)
        self.addDockWidget(area, dock)
        self.resizeDocks([dock], [width], Qt.Orientation.Horizontal)
        self.docks[title.lower()] = dock

    def set_workspace(self, workspace: Workspace) -> None:
        """Put the images into the middle, and their zoom into the status bar."""
        self._workspace = workspace
        self._middle_layout.replaceWidget(self._loading, workspace)
        self._loading.deleteLater()
        self._middle_layout.setStretchFactor(workspace, 1)
        self.big_panel.set_stage(workspace)
        self.message_bar.keep_to(partial(room_for_messages, self._middle, workspace, self.big_panel, self._front))
        self.message_bar.raise_()

    def add_docks(self, hosts: Mapping[str, DockHost]) -> None:
        """Put the docks, as tabs, below the images."""
        self._hosts = hosts
        first: QDockWidget | None = None
        for name, host in hosts.items():
            dock = QDockWidget(host.kind.title, self)
            dock.setObjectName(f"tab-{name}")
            grow_title(dock)
            set_tip(dock, host.kind.help)
            set_tip(dock.toggleViewAction(), host.kind.help)
            dock.toggleViewAction().triggered.connect(partial(self._shown_by_menu, name))
            host.set_frame(dock)
            host.made.connect(self._adopt_menus)
            self.addDockWidget(Qt.DockWidgetArea.BottomDockWidgetArea, dock)
            if first is None:
                first = dock
            else:
                self.tabifyDockWidget(first, dock)
            self.docks[name] = dock
        self._adopt_menus()
        self._fill_docks_menu()
        if first is not None:
            docks_height = panel_sizes(self.width(), self.height())[2]
            self.resizeDocks([first], [docks_height], Qt.Orientation.Vertical)
        state = self.settings.text("state")
        if not (state and self.restoreState(QByteArray(base64.b64decode(state)))) and first is not None:
            first.raise_()
        for dock in self.docks.values():
            self.strip.follow(dock)
        self.strip.start()

    def _adopt_menus(self) -> None:
        for menu in QApplication.topLevelWidgets():
            if isinstance(menu, QMenu) and menu.parent() is None:
                # pyqtgraph makes its menus without a parent, and nobody would delete them.
                menu.setParent(self, menu.windowFlags())

    def _make_menus(self) -> None:
        self.menus: dict[str, QMenu] = {}
        for command in COMMANDS:
            menu = self.menus.get(command.menu)
            if menu is None:
                menu = self.menus[command.menu] = self.menuBar().addMenu(command.menu)
                menu.setToolTipsVisible(True)
            if command.separator:
                menu.addSeparator()
            menu.addAction(self.actions_by_name[command.name])
            if command.name == "open":
                self.recent_menu = menu.addMenu("Open &recent")
                self.recent_menu.setObjectName("recent-menu")
        themes = QActionGroup(self)
        for choice in ("auto", "light", "dark"):
            action = self.actions_by_name[f"theme-{choice}"]
            action.setCheckable(True)
            action.setChecked(self.themes.choice == choice)
            themes.addAction(action)
            action.triggered.connect(partial(self._choose_theme, choice))
        layouts = QActionGroup(self)
        for name in LAYOUTS:
            layouts.addAction(self.actions_by_name[f"layout-{name}"]).setCheckable(True)
        # Own layouts, sessions and lessons change it too.
        self.menus["&View"].aboutToShow.connect(self._mark_layout)
        self.docks_menu = self.menus["&View"].addMenu("&Panels")
        self.docks_menu.setToolTipsVisible(True)

    def _mark_layout(self) -> None:
        self.actions_by_name[f"layout-{self.layouts.current or LAYOUTS[0]}"].setChecked(True)

    def _fill_docks_menu(self) -> None:
        self.docks_menu.clear()
        for name, dock in self.docks.items():
            self.docks_menu.addAction(dock.toggleViewAction())
            # For the palette: the menu shows and hides, this one goes there.
            action = self.actions_by_name[f"panel-{name}"] = QAction(f"Panel {dock.windowTitle()}", self)
            action.setObjectName(f"action-panel-{name}")
            action.setStatusTip(dock.toolTip())
            action.triggered.connect(partial(self._go_to_panel, name))

    # Showing.

    def show_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        application = QApplication.instance()
        if isinstance(application, QApplication):
            apply_theme(application, theme)
        self.message_bar.set_theme(theme)
        self.toolbar.set_theme(theme)

    def show_session(self, session: Session) -> None:
        """Show seed, size and what undo and redo would do."""
        state = session.state
        self.toolbar.show_values(state.seed, state.size)
        for name, text in (("undo", session.undo_text), ("redo", session.redo_text)):
            action = self.actions_by_name[name]
            action.setEnabled(text is not None)
            label = name.capitalize()
            action.setText(f"&{label} {text}" if text else f"&{label}")
            action.setIconText("↶" if name == "undo" else "↷")
        alone = session.selected_column is not None
        for name in ("duplicate", "remove", "left", "right", "previous", "next", "reset", "run", *OF_ONE):
            self.actions_by_name[name].setEnabled(alone)
        column = session.selected_column
        self.actions_by_name["pin"].setChecked(column is not None and column.pinned)
        self.actions_by_name["own-seed"].setChecked(column is not None and column.seed is not None)

    def show_recent(self, paths: list[str], chosen: Any) -> None:
        """List the files opened lately."""
        self.recent_menu.clear()
        self.recent_menu.setEnabled(bool(paths))
        for path in paths:
            action = QAction(path, self.recent_menu)
            action.triggered.connect(partial(chosen, path))
            self.recent_menu.addAction(action)

    def add_below(self, bar: QWidget) -> None:
        """Put a bar below the images."""
        self._middle_layout.addWidget(bar)

    def settle_middle(self) -> None:
        """Let what was shown or hidden in the middle count at once."""
        self._middle_layout.activate()

    def show_dock(self, name: str) -> bool:
        """Bring a dock to the front and leave the keyboard where it is; return whether there is such a dock."""
        dock = self.docks.get(name)
        if dock is not None:
            self.layouts.show_alone(name)
            dock.show()
            dock.raise_()
        return dock is not None

    def take_stage(self, name: str = "") -> None:
        """Let a panel take the whole stage (the one in front without a name), or give it back."""
        self.big_panel.toggle(name or self.front_dock() or next(each for each in self.docks if each not in SIDES))

    def front_dock(self) -> str:
        """Return the name of the tab that can be seen; "" when there is none."""
        for name, dock in self.docks.items():
            if name not in SIDES and dock.isVisible() and not dock.visibleRegion().isEmpty():
                return name
        return ""

    def _front(self) -> QWidget | None:
        dock = self.docks.get(self.front_dock())
        return None if dock is None else dock.widget()

    def raise_dock(self, name: str) -> None:
        """Bring a dock to the front and give it the keyboard."""
        dock = self.docks.get(name)
        if name in SIDES and self.layouts.current == "teach":
            self.actions_by_name[f"overlay-{name}"].trigger()
        elif dock is not None:
            if name not in SIDES:
                self.strip.set_open(True)
                self.layouts.show_alone(name)
            dock.show()
            dock.raise_()
            dock.widget().setFocus()

    def make_more(self) -> bool:
        """Make the next piece of the first tab that nobody has seen; return whether anything is left to make."""
        unmade = self.unmade
        if unmade:
            self._hosts[unmade[0]].make_more()
        return bool(self.unmade)

    @property
    def unmade(self) -> tuple[str, ...]:
        """Names of the tabs that nobody has seen or asked for."""
        return tuple(name for name, host in self._hosts.items() if not host.is_made)

    def _shown_by_menu(self, name: str, shown: bool) -> None:
        if shown:
            self.layouts.show_alone(name)

    def _go_to_panel(self, name: str, _: bool = False) -> None:
        self.raise_dock(name)

    def _choose_theme(self, choice: Any) -> None:
        self.settings.values["theme"] = choice
        self.themes.choose(choice)

    def _restore_geometry(self) -> None:
        geometry = self.settings.text("geometry")
        if geometry:
            self.restoreGeometry(QByteArray(base64.b64decode(geometry)))
            if not self.isMaximized() and not self.isFullScreen():
                place = self.geometry()
                was = place.x(), place.y(), place.width(), place.height()
                self.setGeometry(*within(was, self._available()))

    def _available(self) -> Rect:
        room = self.screen().availableGeometry()
        return room.x(), room.y(), room.width(), room.height()

    def remember_geometry(self) -> None:
        """Put geometry and docks into the settings."""
        self.settings.values["geometry"] = _base64(self.saveGeometry())
        self.settings.values["state"] = _base64(self.saveState())

    # Events.

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Let text follow the height, when teaching."""
        super().resizeEvent(event)
        if self.layouts.current == "teach":
            self._text.start()

    def _follow_height(self) -> None:
        self.layouts.follow_size()

    def event(self, event: QEvent) -> bool:
        """Let the tabs of the docks keep their names whole when they come."""
        if isinstance(event, QChildEvent) and event.type() == QEvent.Type.ChildPolished:
            tabs = event.child()
            if isinstance(tabs, QTabBar):
                tabs.setElideMode(Qt.TextElideMode.ElideNone)
                tabs.setUsesScrollButtons(True)
                tabs.setAccessibleName("Panels")
                self.strip.watch(tabs)
        return super().event(event)

    def tab_order(self) -> list[QWidget]:
        """Return the parts of the window in the order in which Tab goes through them."""
        docks = [dock for name, dock in self.docks.items() if name not in ("gallery", "parameters")]
        cells = () if self._workspace is None else self._workspace.grid.cells
        first = (self.toolbar, self.docks["gallery"], self.lesson_bar)
        return [*first, *cells, self._middle, self.docks["parameters"], *docks]

    def focusNextPrevChild(self, forward: bool) -> bool:
        """Go on to what is seen: never into a tab behind another one."""
        if not self.isVisible():
            return super().focusNextPrevChild(forward)
        wanted = next_stop(self, self.tab_order(), forward=forward)
        if wanted is None:
            return False
        reason = Qt.FocusReason.TabFocusReason if forward else Qt.FocusReason.BacktabFocusReason
        wanted.setFocus(reason)
        self._ring.show_around(wanted)
        return True

    def closeEvent(self, event: QCloseEvent) -> None:
        """Tell before the window goes."""
        self.big_panel.give_back()
        self.closing.emit()
        super().closeEvent(event)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take files and images."""
        take_copy(event)

    def dragMoveEvent(self, event: QDragMoveEvent) -> None:
        """Go on taking a copy, whatever key is held."""
        take_copy(event)

    def dropEvent(self, event: QDropEvent) -> None:
        """Open what was dropped."""
        if take_copy(event):
            brought = brought_by(event.mimeData())
            # The answer to the drop must not wait for what follows from it.
            QTimer.singleShot(0, lambda: self.dropped.emit(brought))


def _base64(data: QByteArray) -> str:
    return base64.b64encode(data.data()).decode("ascii")
