"""The main window: the shell that shows at once, and what is put into it a moment later."""

from __future__ import annotations

import base64
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QByteArray, QChildEvent, QEvent, QSignalBlocker, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QAction, QActionGroup, QIcon, QPixmap
from PySide6.QtWidgets import (
    QApplication,
    QDockWidget,
    QMainWindow,
    QMenu,
    QSpinBox,
    QTabBar,
    QToolBar,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from texlab.form.panel import ParametersView
from texlab.style.theme import apply_theme, set_text_size
from texlab.widgets.plain import Label, set_tip
from texlab.window.commands import COMMANDS, make_actions
from texlab.window.gallery import GalleryView
from texlab.window.message_bar import MessageBar
from texlab.window.mime import source_of
from texlab_core.engine.job import MAX_SEED

if TYPE_CHECKING:
    from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent

    from texlab.docks.base import Dock
    from texlab.state.session import Session
    from texlab.storage.settings import Settings
    from texlab.style.theme import Theme, ThemeSource

MAX_SIDE = 4096
TEACH_FACTOR = 1.35


class MainWindow(QMainWindow):
    """Menus, tool bar, gallery, parameters, docks and status bar.

    ``dropped(source)`` is a path or the bytes of an image; ``closing`` comes before the window goes.
    """

    dropped = Signal(object)
    closing = Signal()
    dock_shown = Signal()

    def __init__(self, settings: Settings, themes: ThemeSource) -> None:
        super().__init__()
        self.setObjectName("main-window")
        self.setWindowTitle("TexLab")
        self.setWindowIcon(application_icon())
        self.setAcceptDrops(True)
        self.setDockNestingEnabled(True)
        self.resize(1280, 800)
        self.settings = settings
        self.themes = themes
        self._points = QApplication.font().pointSizeF()
        self.actions_by_name = make_actions(self)
        self.docks: dict[str, QDockWidget] = {}
        self.message_bar = MessageBar()
        self._middle = QWidget()
        self._middle.setObjectName("middle")
        self._middle_layout = QVBoxLayout(self._middle)
        self._middle_layout.setContentsMargins(0, 0, 0, 0)
        self._middle_layout.setSpacing(0)
        self._middle_layout.addWidget(self.message_bar)
        self._loading = Label("")
        self._loading.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self._middle_layout.addWidget(self._loading, 1)
        self.setCentralWidget(self._middle)
        # Keys are commands until a field is clicked: the search field must not get them first.
        self._middle.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self._middle.setFocus()
        self.gallery = GalleryView()
        self.parameters = ParametersView()
        self._add_side("Gallery", self.gallery, Qt.DockWidgetArea.LeftDockWidgetArea, 190)
        self._add_side("Parameters", self.parameters, Qt.DockWidgetArea.RightDockWidgetArea, 270)
        self.setCorner(Qt.Corner.BottomLeftCorner, Qt.DockWidgetArea.LeftDockWidgetArea)
        self.setCorner(Qt.Corner.BottomRightCorner, Qt.DockWidgetArea.RightDockWidgetArea)
        self._make_menus()
        self._make_toolbar()
        self._make_status()
        self._restore_geometry()
        self.show_theme(themes.theme)
        if settings.text("layout") == "teach":
            self._set_text_size("teach")
        themes.changed.connect(self.show_theme)

    # Building.

    def _add_side(self, title: str, widget: QWidget, area: Qt.DockWidgetArea, width: int) -> None:
        dock = QDockWidget(title, self)
        dock.setObjectName(f"side-{title.lower()}")
        dock.setWidget(widget)
        widget.setMinimumWidth(150)
        self.addDockWidget(area, dock)
        self.resizeDocks([dock], [width], Qt.Orientation.Horizontal)
        self.docks[title.lower()] = dock

    def set_workspace(self, workspace: QWidget) -> None:
        """Put the images into the middle."""
        self._middle_layout.replaceWidget(self._loading, workspace)
        self._loading.deleteLater()
        self._middle_layout.setStretchFactor(workspace, 1)

    def add_docks(self, docks: list[Dock]) -> None:
        """Put the docks, as tabs, below the images."""
        first: QDockWidget | None = None
        for each in docks:
            dock = QDockWidget(each.title, self)
            dock.setObjectName(f"tab-{each.name}")
            dock.setWidget(each)
            set_tip(dock, each.help)
            set_tip(dock.toggleViewAction(), each.help)
            self.addDockWidget(Qt.DockWidgetArea.BottomDockWidgetArea, dock)
            if first is None:
                first = dock
            else:
                self.tabifyDockWidget(first, dock)
            self.docks[each.name] = dock
        for menu in QApplication.topLevelWidgets():
            if isinstance(menu, QMenu) and menu.parent() is None:
                # pyqtgraph makes its menus without a parent, and nobody would delete them.
                menu.setParent(self, menu.windowFlags())
        self._fill_docks_menu()
        if first is not None:
            self.resizeDocks([first], [260], Qt.Orientation.Vertical)
        state = self.settings.text("state")
        if not (state and self.restoreState(QByteArray(base64.b64decode(state)))) and first is not None:
            first.raise_()

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
        self.docks_menu = self.menus["&View"].addMenu("&Panels")
        self.docks_menu.setToolTipsVisible(True)

    def _fill_docks_menu(self) -> None:
        self.docks_menu.clear()
        for name, dock in self.docks.items():
            self.docks_menu.addAction(dock.toggleViewAction())
            # For the palette: the menu shows and hides, this one goes there.
            action = self.actions_by_name[f"panel-{name}"] = QAction(f"Panel {dock.windowTitle()}", self)
            action.setObjectName(f"action-panel-{name}")
            action.setStatusTip(dock.toolTip())
            action.triggered.connect(partial(self._go_to_panel, name))

    def _make_toolbar(self) -> None:
        bar = QToolBar("Tools")
        bar.setObjectName("toolbar")
        bar.setMovable(False)
        bar.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextOnly)
        self.addToolBar(bar)
        act = self.actions_by_name
        short = {
            "open": "Open", "dice": "⚄", "tile": "Tile 2×2", "run-all": "Run all", "stop-all": "Stop",
            "export": "Save", "add": "+ Column", "undo": "↶", "redo": "↷", "help": "?",
        }  # fmt: skip
        for name, text in short.items():
            act[name].setIconText(text)
        bar.addAction(act["open"])
        bar.addAction(act["export"])
        bar.addSeparator()
        bar.addAction(act["undo"])
        bar.addAction(act["redo"])
        bar.addSeparator()
        bar.addWidget(Label("Seed "))
        self.seed_box = QSpinBox()
        self.seed_box.setObjectName("seed-box")
        self.seed_box.setAccessibleName("Seed")
        self.seed_box.setRange(0, MAX_SEED)
        self.seed_box.setKeyboardTracking(False)
        set_tip(self.seed_box, "Seed of all columns: the same seed and parameters make the same bits")
        self.seed_box.setValue(1)
        bar.addWidget(self.seed_box)
        bar.addAction(act["dice"])
        bar.addSeparator()
        bar.addWidget(Label("Size "))
        self.width_box, self.height_box = QSpinBox(), QSpinBox()
        for box, name in ((self.width_box, "Width"), (self.height_box, "Height")):
            box.setObjectName(f"{name.lower()}-box")
            box.setAccessibleName(name)
            box.setRange(8, MAX_SIDE)
            box.setSingleStep(32)
            box.setKeyboardTracking(False)
            set_tip(box, f"{name} of the results, in pixels")
            box.setValue(256)
        bar.addWidget(self.width_box)
        bar.addWidget(Label(" × "))
        bar.addWidget(self.height_box)
        bar.addSeparator()
        for name in ("tile", "add", "run-all", "stop-all"):
            bar.addAction(act[name])
        spring = QWidget()
        spring.setSizePolicy(spring.sizePolicy().Policy.Expanding, spring.sizePolicy().Policy.Preferred)
        bar.addWidget(spring)
        layouts = QToolButton()
        layouts.setObjectName("layout-button")
        layouts.setText("Layout")
        set_tip(layouts, "Arrange the panels for exploring, teaching or tuning")
        layouts.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        menu = QMenu(layouts)
        for name in ("explore", "teach", "tune"):
            menu.addAction(act[f"layout-{name}"])
        layouts.setMenu(menu)
        bar.addWidget(layouts)
        bar.addAction(act["help"])
        self.toolbar = bar

    def _make_status(self) -> None:
        bar = self.statusBar()
        self.pixel_label = Label("")
        self.pixel_label.setObjectName("status-pixel")
        self.pixel_label.setContentsMargins(6, 0, 0, 0)
        self.jobs_label = Label("")
        self.jobs_label.setObjectName("status-jobs")
        self.jobs_label.setProperty("role", "muted")
        self.memory_label = Label("")
        self.memory_label.setObjectName("status-memory")
        self.memory_label.setProperty("role", "muted")
        set_tip(self.memory_label, "Memory used by the program")
        bar.addWidget(self.pixel_label, 1)
        bar.addPermanentWidget(self.jobs_label)
        bar.addPermanentWidget(self.memory_label)

    @property
    def size_shown(self) -> tuple[int, int]:
        """Height and width in the boxes."""
        return self.height_box.value(), self.width_box.value()

    # Showing.

    def show_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        application = QApplication.instance()
        if isinstance(application, QApplication):
            apply_theme(application, theme)
        self.message_bar.set_theme(theme)

    def show_session(self, session: Session) -> None:
        """Show seed, size and what undo and redo would do."""
        state = session.state
        for box, value in (
            (self.seed_box, state.seed),
            (self.width_box, state.size[1]),
            (self.height_box, state.size[0]),
        ):
            with QSignalBlocker(box):
                box.setValue(value)
        for name, text in (("undo", session.undo_text), ("redo", session.redo_text)):
            action = self.actions_by_name[name]
            action.setEnabled(text is not None)
            label = name.capitalize()
            action.setText(f"&{label} {text}" if text else f"&{label}")
            action.setIconText("↶" if name == "undo" else "↷")
        alone = session.selected_column is not None
        for name in ("duplicate", "remove", "left", "right", "previous", "next", "reset", "run"):
            self.actions_by_name[name].setEnabled(alone)

    def show_recent(self, paths: list[str], chosen: Any) -> None:
        """List the files opened lately."""
        self.recent_menu.clear()
        self.recent_menu.setEnabled(bool(paths))
        for path in paths:
            action = QAction(path, self.recent_menu)
            action.triggered.connect(partial(chosen, path))
            self.recent_menu.addAction(action)

    def arrange(self, layout: str, tuning: str = "histograms") -> None:
        """Arrange the panels: ``explore``, ``teach`` or ``tune``; ``tuning`` is the tab in front for the last."""
        gallery, parameters = self.docks["gallery"], self.docks["parameters"]
        tabs = [dock for name, dock in self.docks.items() if name not in ("gallery", "parameters")]
        self._bring_home(gallery, parameters, tabs)
        gallery.setVisible(layout == "explore")
        parameters.setVisible(layout != "teach")
        self._set_text_size(layout)
        for dock in tabs:
            dock.show()
        if tabs:
            front = {"explore": "pyramid", "teach": "pyramid", "tune": tuning}[layout]
            self.docks.get(front, tabs[0]).raise_()
            height = {"explore": 0.33, "teach": 0.45, "tune": 0.3}[layout]
            self.resizeDocks([tabs[0]], [round(self.height() * height)], Qt.Orientation.Vertical)
        width = {"explore": 270, "teach": 270, "tune": 420}[layout]
        self.resizeDocks([parameters], [width], Qt.Orientation.Horizontal)
        self.settings.values["layout"] = layout

    def _bring_home(self, gallery: QDockWidget, parameters: QDockWidget, tabs: list[QDockWidget]) -> None:
        """Put every dock that was dragged elsewhere where it belongs."""
        areas = Qt.DockWidgetArea
        homes = {gallery: areas.LeftDockWidgetArea, parameters: areas.RightDockWidgetArea}
        for dock in self.docks.values():
            home = homes.get(dock, areas.BottomDockWidgetArea)
            if dock.isFloating():
                dock.setFloating(False)
            if self.dockWidgetArea(dock) != home:
                self.addDockWidget(home, dock)
        if tabs and set(self.tabifiedDockWidgets(tabs[0])) != set(tabs[1:]):
            for dock in tabs[1:]:
                self.tabifyDockWidget(tabs[0], dock)

    def raise_dock(self, name: str) -> None:
        """Bring a dock to the front and give it the keyboard."""
        dock = self.docks.get(name)
        if dock is not None:
            dock.show()
            dock.raise_()
            dock.widget().setFocus()

    def _go_to_panel(self, name: str, _: bool = False) -> None:
        self.raise_dock(name)

    def _set_text_size(self, layout: str) -> None:
        application = QApplication.instance()
        if isinstance(application, QApplication):
            points = self._points * (TEACH_FACTOR if layout == "teach" else 1.0)
            set_text_size(application, points, self.themes.theme)

    def _choose_theme(self, choice: Any) -> None:
        self.settings.values["theme"] = choice
        self.themes.choose(choice)

    def _restore_geometry(self) -> None:
        geometry = self.settings.text("geometry")
        if geometry:
            self.restoreGeometry(QByteArray(base64.b64decode(geometry)))

    def remember_geometry(self) -> None:
        """Put geometry and docks into the settings."""
        self.settings.values["geometry"] = _base64(self.saveGeometry())
        self.settings.values["state"] = _base64(self.saveState())

    # Events.

    def event(self, event: QEvent) -> bool:
        """Let the tabs of the docks keep their names whole when they come."""
        if isinstance(event, QChildEvent) and event.type() == QEvent.Type.ChildPolished:
            tabs = event.child()
            if isinstance(tabs, QTabBar):
                tabs.setElideMode(Qt.TextElideMode.ElideNone)
                tabs.setUsesScrollButtons(True)
        return super().event(event)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Tell before the window goes."""
        self.closing.emit()
        super().closeEvent(event)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        """Take files and images."""
        mime = event.mimeData()
        if mime.hasImage() or any(url.isLocalFile() for url in mime.urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        """Open what was dropped."""
        source = source_of(event.mimeData())
        if source is not None:
            event.acceptProposedAction()
            # The answer to the drop must not wait for what follows from it.
            QTimer.singleShot(0, lambda: self.dropped.emit(source))


def application_icon() -> QIcon:
    """Return the program's icon."""
    from texlab_core.files.resources import resource

    pixmap = QPixmap()
    try:
        pixmap.loadFromData(resource("icons/texlab.png").read_bytes())
    except (OSError, ValueError):
        pixmap = QPixmap(QSize(32, 32))
        pixmap.fill(Qt.GlobalColor.darkCyan)
    return QIcon(pixmap)


def _base64(data: QByteArray) -> str:
    return base64.b64encode(data.data()).decode("ascii")
