"""What the menus, the tool bar and the columns' menus do."""

from __future__ import annotations

import secrets
import sys
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QPoint, QProcess, Qt
from PySide6.QtWidgets import QMenu

from texlab.columns.history_popup import HistoryPopup
from texlab.storage.projects import is_handed_on, take_away
from texlab.widgets.name_field import NameField
from texlab.widgets.once import Once
from texlab.widgets.plain import set_tip
from texlab.widgets.settling import settle_all
from texlab.window.batch_desk import BatchDesk
from texlab.window.export_desk import ExportDesk
from texlab.window.popout_desk import PopoutDesk
from texlab.window.project_desk import ProjectDesk
from texlab.window.toolbar import LAYOUTS
from texlab_core.engine.job import MAX_SEED
from texlab_core.engine.params import describe
from texlab_core.engine.registry import methods
from texlab_core.findings.failures import examples
from texlab_core.methods.de_bonet.thresholds import ThresholdTable
from texlab_core.sheets.comparison import FIG_8, FIRST_SIGHT

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.columns.workspace import Workspace
    from texlab.runs.controller import Controller
    from texlab.window.exchange import Exchange
    from texlab.window.help_desk import HelpDesk
    from texlab.window.main_window import MainWindow
    from texlab.window.opener import Opener
    from texlab.window.tuning import Tuning

TURN_MS = 600
# Their handlers take whether they are on.
SWITCHES = ("tile", "link")


class Handlers(QObject):
    """Turns the user's commands into changes of the session and orders to the controller."""

    def __init__(
        self,
        window: MainWindow,
        workspace: Workspace,
        controller: Controller,
        opener: Opener,
        exchange: Exchange,
        desk: HelpDesk,
        tuning: Tuning,
    ) -> None:
        super().__init__(window)
        self._window = window
        self._workspace = workspace
        self._controller = controller
        self._session = controller.session
        self._opener = opener
        self._exchange = exchange
        self._desk = desk
        self._tuning = tuning
        self.batches = BatchDesk(window, controller.session)
        self.exports = ExportDesk(window, exchange.settings, controller)
        self.popouts = PopoutDesk(window, exchange.settings, controller)
        self.projects = ProjectDesk(window, exchange.settings, controller)
        self._turned = ""
        self._turning = Once(self, TURN_MS, lambda: self._session.finish_merge(self._turned))
        self._to_column = self._by_column()
        for name, handler in self._by_action().items():
            # An edit that its last key has not ended yet would come back after an undo.
            window.actions_by_name[name].triggered.connect(lambda _: settle_all(window))
            window.actions_by_name[name].triggered.connect(handler)

    def close(self) -> None:
        """Wait for nothing any more."""
        self._turning.stop()
        self.batches.close()
        self.exports.close()
        self.popouts.close()

    def _by_column(self) -> dict[str, Callable[[int], Any]]:
        """Return what every command of ``COLUMN_COMMANDS`` does to a column."""
        session, controller, exchange = self._session, self._controller, self._exchange
        return {
            "go-on": controller.go_on,
            "duplicate": lambda column_id: self.select(session.duplicate_column(column_id)),
            "left": lambda column_id: session.move_column(column_id, -1),
            "right": lambda column_id: session.move_column(column_id, 1),
            "export": exchange.export,
            "copy": exchange.copy,
            "use": self._use,
            "enlarge": self._workspace.enlarge,
            "apart": self._workspace.turn_apart,
            "rename": self.ask_name,
            "history": self._show_history,
            "pin": self._pin,
            "own-seed": self._lock_seed,
            "new-seed": lambda column_id: session.set_column_seed(column_id, _any_seed()),
            "remove": session.remove_column,
            "run": controller.run_column,
            "stop": controller.stop_column,
            "reset": controller.editing.reset_params,
        }

    def _by_action(self) -> dict[str, Any]:
        session, controller, stage = self._session, self._controller, self._workspace
        exchange, desk = self._exchange, self._desk
        handlers: dict[str, Any] = {
            "open": exchange.ask_open,
            "paste": exchange.paste,
            "batch": self.batches.open,
            "export-many": self.exports.open,
            "save-project": self.projects.save,
            "student-copy": partial(self.projects.save, for_student=True),
            "another-window": lambda: self.open_another_window(),
            "forget-results": self.forget_results,
            "quit": self._window.close,
            "undo": session.undo,
            "redo": session.redo,
            "dice": lambda: session.set_seed(_any_seed()),
            "palette": desk.show_palette,
            "add": self.choose_new_column,
            "four": lambda: self.lay_out(FIRST_SIGHT, "the four methods"),
            "spectra": lambda: self.lay_out(FIG_8, "compare spectra"),
            "previous": lambda: self._step_column(-1),
            "next": lambda: self._step_column(1),
            "run-all": controller.run_all,
            "stop-all": controller.stop_all,
            "fit": stage.fit,
            "actual": stage.actual_size,
            "zoom-in": lambda: stage.zoom(1.5),
            "zoom-out": lambda: stage.zoom(1 / 1.5),
            "tile": stage.set_tiled,
            "link": stage.set_linked,
            "panels": self._window.strip.toggle,
            "big-panel": self._window.take_stage,
            "crop": lambda: self._workspace.exemplar.crop_button.click(),
            "help": lambda: desk.show_help(self._chosen_method()),
            "help-window": lambda: desk.show_help("window"),
            "shortcuts": lambda: desk.show_help("shortcuts"),
            "failures": self.choose_failure,
            "popout": self.popouts.open,
            "about": desk.show_about,
        }
        for name in self._to_column:
            handlers[name] = lambda name=name: self.column_command(session.selected_id, name)
        for layout in LAYOUTS:
            handlers[f"layout-{layout}"] = partial(self._arrange, layout)
        return {name: call if name in SWITCHES else _without_argument(call) for name, call in handlers.items()}

    def _arrange(self, layout: str) -> None:
        column = self._session.selected_column
        fields = describe(type(column.params)) if column is not None else ()
        table = any(field.type is ThresholdTable for field in fields)
        self._window.big_panel.give_back()
        self._tuning.set_active(layout == "tune", self._session.selected_id)
        self._window.layouts.arrange(layout, tuning="thresholds" if table else "histograms")
        self._workspace.fit()

    def forget_results(self) -> None:
        """Remove the finished results that are kept, and say how much that was."""
        kept = self._controller.shared.kept

        def done(found: tuple[int, int]) -> None:
            count, size = found
            what = "1 finished result" if count == 1 else f"{count} finished results"
            self._controller.said.emit(f"{what} ({size / 2**20:.1f} MB) removed from the disk.")

        self._controller.once("forget", lambda task: kept.forget(), done)

    def open_another_window(self, source: str = "") -> None:
        """Start the program once more: it takes a session that no window has, or a new one for a project."""
        frozen = getattr(sys, "frozen", False)
        command = ["gui"] if frozen else ["-m", "texlab", "gui"]
        started, _ = QProcess.startDetached(sys.executable, [*command, source] if source else command)
        if not started:
            self._window.message_bar.tell("Another window could not be started.", "problem")
            if is_handed_on(source):
                self._controller.once("leftover", lambda task: take_away(source))

    def turn(self, what: str, change: Any) -> None:
        """Make ``change(merge=what)``: turns of a number box without a pause are one step of the history."""
        if what != self._turned:
            self._session.finish_merge(self._turned)
        self._turned = what
        change(merge=what)
        self._turning.start()

    def choose_method(self, column_id: int, method: str) -> None:
        """Run another method in a column."""
        self._session.set_method(column_id, method, methods()[method].params())
        self._session.select(column_id)

    def column_command(self, column_id: int, name: str) -> None:
        """Do a command of ``COLUMN_COMMANDS`` to a column."""
        self._to_column[name](column_id)

    def ask_name(self, column_id: int) -> None:
        """Let a name for a column be typed over its title."""
        view = self._workspace.columns.get(column_id)
        column = self._session.state.column(column_id)
        if view is None or column is None or view.isHidden():
            return
        field = NameField(view.method_box, column.name)
        field.taken.connect(partial(self._session.rename_column, column_id))

    def _show_history(self, column_id: int) -> None:
        view = self._workspace.columns.get(column_id)
        if view is None or view.scene is None or view.isHidden():
            return
        exemplar = self._controller.exemplar
        session = self._session
        popup = HistoryPopup(view.scene, exemplar.sha256 if exemplar is not None else "", view)
        popup.chosen.connect(partial(session.take_past, column_id))
        popup.compared.connect(lambda past: self.select(session.compare_past(column_id, past)))
        popup.show_at(view.pane)

    def _pin(self, column_id: int) -> None:
        column = self._session.state.column(column_id)
        if column is not None:
            self._session.pin_column(column_id, not column.pinned)

    def _lock_seed(self, column_id: int) -> None:
        column = self._session.state.column(column_id)
        if column is not None:
            seed = self._session.state.seed if column.seed is None else None
            self._session.set_column_seed(column_id, seed)

    def _use(self, column_id: int) -> None:
        scene = self._controller.column_scene(column_id)
        if scene is not None and scene.result is not None:
            self._opener.use_as_exemplar(scene.result)

    def select(self, column_id: int) -> None:
        """Choose a column and bring it into view."""
        if column_id:
            self._session.select(column_id)
            self._workspace.reveal(column_id)

    def _step_column(self, by: int) -> None:
        places = [column.id for column in self._session.state.columns]
        if places:
            here = places.index(self._session.selected_id)
            self.select(places[(here + by) % len(places)])

    def lay_out(self, wanted: tuple[str, ...], text: str) -> None:
        """Show these methods with their defaults, all with the session's seed: the spectral ones share a phase."""
        self._session.set_columns([(name, methods()[name].params()) for name in wanted], text)

    def choose_new_column(self) -> None:
        """Offer the methods, then add the chosen one."""
        menu = QMenu(self._window)
        menu.setObjectName("new-column-menu")
        for method in methods().values():
            action = menu.addAction(method.title)
            set_tip(action, method.summary)
            action.triggered.connect(partial(self._add_column, method.id))
        button = self._window.toolbar.widgetForAction(self._window.actions_by_name["add"])
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(button.mapToGlobal(button.rect().bottomLeft()))

    def _add_column(self, method: str, _: bool = False) -> None:
        self.select(self._session.add_column(method, methods()[method].params()))

    def choose_failure(self) -> None:
        """Offer the failures that the papers name, by method, then open the chosen one."""
        menu = QMenu(self._window)
        menu.setObjectName("failures-menu")
        groups: dict[str, QMenu] = {}
        for example in examples().values():
            if example.method not in groups:
                group = groups[example.method] = menu.addMenu(methods()[example.method].title)
                group.setToolTipsVisible(True)
            action = groups[example.method].addAction(example.title)
            action.setObjectName(f"failure-{example.name}")
            set_tip(action, f"{example.look} {example.why}")
            action.triggered.connect(partial(self._open_failure, example.name))
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.popup(self._window.mapToGlobal(QPoint(self._window.width() // 3, 60)))

    def _open_failure(self, name: str, _: bool = False) -> None:
        self._opener.open_failure(name)

    def _chosen_method(self) -> str:
        column = self._session.selected_column
        return column.method if column is not None else "index"


def _any_seed() -> int:
    return secrets.randbelow(MAX_SEED + 1)


def _without_argument(call: Any) -> Any:
    return lambda _=False: call()
