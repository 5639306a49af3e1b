"""Puts the parts of the running program together: session, controller, window."""

from __future__ import annotations

import logging
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QTimer

from texlab.app.crash import CrashHandler
from texlab.app.memory import Thrift, memory_bytes, memory_text
from texlab.columns.apart import places_from_json, places_to_json
from texlab.columns.overlays import Overlays
from texlab.columns.workspace import Workspace
from texlab.docks import dock_classes
from texlab.docks.editors import register_editors
from texlab.docks.host import DockHost
from texlab.presets.manager import PresetManager
from texlab.runs.controller import Controller
from texlab.runs.slots import Slots
from texlab.state.changes import as_a_whole, at_full_size
from texlab.state.chosen import Column, State
from texlab.state.intentions import OpenLesson
from texlab.state.session import Session
from texlab.storage.autosave import Autosave
from texlab.storage.paths import lessons_dir, results_dir
from texlab.storage.projects import is_project
from texlab.storage.reading import Choice, is_document, last_exemplar
from texlab.storage.sessions import claim, told_of_others
from texlab.storage.settings import OLD_SESSION, columns_from_json, has_kept_inputs, notes_of, seed_and_size
from texlab.storage.stored_results import StoredResults
from texlab.widgets.settling import settle_all
from texlab.window.carrier import Carrier
from texlab.window.exchange import Exchange
from texlab.window.gallery_thumbnails import Thumbnails
from texlab.window.handlers import Handlers
from texlab.window.help_desk import HelpDesk
from texlab.window.opener import Opener
from texlab.window.own_layouts import OwnLayouts
from texlab.window.presenter import Presenter
from texlab.window.stage_settings import StageSettings
from texlab.window.tab_pictures import TabPictures
from texlab.window.tabs_ahead import TabsAtRest
from texlab.window.teach_mode import TeachMode
from texlab.window.teacher import Teacher
from texlab.window.tuning import Tuning
from texlab_core.engine.inputs import Crop
from texlab_core.engine.registry import failures, methods
from texlab_core.sheets.comparison import FIRST_SIGHT

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from texlab.columns.column import ColumnView
    from texlab.docks.base import Dock
    from texlab.runs.worker import Task
    from texlab.storage.reading import Source
    from texlab.storage.settings import Settings
    from texlab.style.theme import Theme, ThemeSource
    from texlab.window.main_window import MainWindow

log = logging.getLogger(__name__)

# Where the settings keep which columns had windows of their own.
APART = "apart"
FIRST_TEXTURE = "gallery:structured-pebbles"
FIRST_CROP = Crop(16, 16, 128, 128)
MEMORY_MS = 2000


class Explorer(QObject):
    """The running program behind the window.

    A ``fresh`` one leaves every kept session as it is, for a source that replaces the whole session.
    """

    def __init__(
        self, window: MainWindow, settings: Settings, themes: ThemeSource, *, fresh: bool = False
    ) -> None:
        super().__init__(window)
        self.window = window
        self.settings = settings
        self.themes = themes
        self.session = Session(self)
        self.controller = Controller(self.session, self)
        self.controller.shared.kept.disk = StoredResults(results_dir()) if settings.kept else None
        self.opener = Opener(
            self.session,
            self.controller,
            settings,
            lambda preset: self.presets.import_preset(preset),
            self._show_several,
        )
        self.presets = PresetManager(window, window.parameters.presets)
        self.own = claim(settings.values.get(OLD_SESSION), fresh=fresh) if settings.kept else None
        self.saved: Any = None if self.own is None else self.own.saved
        """The session of the last time."""
        self.autosave = Autosave(self.session, settings, self.own, self)
        self.crash = CrashHandler(self)
        self.workspace = Workspace([(each.id, each.title) for each in methods().values()])
        self.overlays = Overlays(self.workspace.columns, self)
        register_editors()
        dock_slots = Slots(1)
        self.hosts = {kind.name: DockHost(kind, dock_slots, self) for kind in dock_classes()}
        """The docks by name, each made when it is first seen or asked for."""
        self.exchange = Exchange(window, settings, self.controller, self.opener)
        self.opener.locate_wanted = self.exchange.ask_locate
        self.desk = HelpDesk(window, self.session, lessons_dir())
        self.desk.read_wanted = lambda read, done: self.controller.once("palette", lambda task: read(), done)
        self.tabs = TabPictures(window, settings, self.controller)
        self.tuning = Tuning(window, self.workspace)
        window.add_below(self.tuning.bar)
        self.handlers = Handlers(
            window, self.workspace, self.controller, self.opener, self.exchange, self.desk, self.tuning
        )
        self.opener.layout_wanted = lambda layout: window.actions_by_name[f"layout-{layout}"].trigger()
        self.presenter = Presenter(
            window,
            self.workspace,
            self.controller,
            settings,
            self.presets,
            self.overlays,
            tuple(self.hosts.values()),
        )
        self.teacher = Teacher(
            window,
            self.workspace,
            self.controller,
            self.presenter,
            self.autosave,
            self.hosts,
            lessons_dir(),
        )
        self.carrier = Carrier(
            self.controller,
            self.handlers.select,
            self.opener.open,
            self.presenter.show_marks,
            self.tabs.take,
            self.teacher.carry_out,
            self.opener.open_failure,
            self._open_tab,
            window.take_stage,
            self.presenter.light_up,
            self.handlers.open_another_window,
        )
        self._closed = False
        self._memory = QTimer(self)
        self._memory.setInterval(MEMORY_MS)
        self._memory.timeout.connect(self._look_at_memory)
        self._thrift = Thrift(self)
        window.set_workspace(self.workspace)
        self.stage = StageSettings(window, self.workspace, settings)
        window.add_docks(self.hosts)
        self.teacher.desk.watch_tabs()
        self.own_layouts = OwnLayouts(window, self.hosts, settings, self.opener.layout_wanted, self.workspace)
        window.actions_by_name["own-layouts"].triggered.connect(lambda _: self.own_layouts.ask())
        self.teach_mode = TeachMode(window, self.workspace, self.session, self.hosts)
        self.teacher.told.connect(self.teach_mode.show_lesson)
        self.teach_mode.show_lesson(self.teacher.scene)
        self.tabs_at_rest = TabsAtRest(window, lambda: self.idle, self)
        self.presenter.show_theme(themes.theme)
        self._connect()
        self.thumbnails = Thumbnails(window.gallery, self)
        self.crash.install()
        if problem := " ".join(filter(None, (settings.problem, self.own.problem if self.own is not None else ""))):
            log.warning(problem)
            window.message_bar.tell(problem, "problem")
        # At a fresh start what is opened speaks; the next start tells of the sessions that wait.
        elif not fresh and self.own is not None and (news := told_of_others(self.own.others, settings.values)):
            window.message_bar.tell(news, "news")
        self._memory.start()

    # Start.

    def start(self, source: str | None, *, columns: Sequence[tuple[Any, ...]] | None = None) -> None:
        """Fill the window: the given image, or the last session, or the first texture."""
        saved = self.saved
        if columns or not has_kept_inputs(saved):
            self._fill(source, saved, columns or columns_from_json(saved))
            return
        said: list[str] = []

        def work(task: Task) -> Sequence[tuple[Any, ...]]:
            return columns_from_json(saved, said.append)

        def done(found: Sequence[tuple[Any, ...]]) -> None:
            self._fill(source, saved, found)
            if said:
                self.window.message_bar.tell(" ".join(said), "problem")

        self.controller.once("session", work, done, lambda: self._fill(source, saved, ()))

    def _fill(self, source: str | None, saved: Any, columns: Sequence[tuple[Any, ...]]) -> None:
        chosen = columns or first_columns()
        seed, size = seed_and_size(saved)
        made = tuple(Column(place + 1, *each) for place, each in enumerate(chosen))
        self.session.apply(State(None, made, seed, size, len(made) + 1, notes_of(saved)), "start")
        place = saved.get("selected", 0) if isinstance(saved, dict) else 0
        place = place if isinstance(place, int) and 0 <= place < len(made) else 0
        self.handlers.select(made[place].id)
        self.session.reset_history()
        ids = [column.id for column in made]
        self.workspace.apart.want(places_from_json(self.settings.values.get(APART), ids))
        self.tuning.set_active(self.settings.text("layout") == "tune")
        if broken := " ".join(each.sentence for each in failures()):
            log.warning(broken)
            self.window.message_bar.tell(broken, "problem")
        self._open_first(source, saved)

    def _open_first(self, source: str | None, saved: Any) -> None:
        choices = [*last_exemplar(saved), Choice(FIRST_TEXTURE, FIRST_CROP, 1.0)]
        if source is not None and is_project(source):
            self.opener.open_project(source, choices)
            return
        if source is not None and is_document(source):
            # A code or a preset goes into a column; the exemplar is the last one.
            self.opener.open(source)
        elif source is not None and source.startswith("gallery:"):
            choices.insert(0, Choice(source, FIRST_CROP, 1.0))
        elif source is not None:
            choices.insert(0, Choice(source))
        self.opener.open_first_of(choices)

    def close(self) -> None:
        """Remember the session and stop every thread."""
        if self._closed:
            return
        self._closed = True
        # What is being typed is taken while it can still be written.
        settle_all(self.window)
        self._memory.stop()
        self.tabs_at_rest.stop()
        self._thrift.leave()
        self.handlers.close()
        self.teach_mode.close()
        self.window.remember_geometry()
        self.settings.values[APART] = places_to_json(self.workspace.apart.places, self.workspace.order)
        self.workspace.apart.close_all()
        # Nobody has to watch the threads come to their end.
        self.window.hide()
        self.controller.leave()
        self.teacher.leave_threads()
        for host in self.hosts.values():
            host.leave()
        self.autosave.close()
        for host in self.hosts.values():
            host.close()
        self.thumbnails.close()
        self.tuning.close()
        self.overlays.close()
        self.teacher.close()
        self.controller.close()
        self._thrift.close()
        self.crash.remove()
        self.desk.close()
        self.tabs.close()

    def _look_at_memory(self) -> None:
        used = memory_bytes()
        self.window.status.memory.setText(memory_text(used))
        self._thrift.look(used, idle=self.idle)

    @property
    def docks(self) -> list[Dock]:
        """All docks; those that nobody has seen are made now."""
        return [host.dock for host in self.hosts.values()]

    @property
    def idle(self) -> bool:
        """Whether nothing is computed and every visible dock has its answer."""
        waiting = (
            self.controller.busy or self.controller.measuring or any(host.busy for host in self.hosts.values())
        )
        return not waiting and self.session.state.sample is not None

    def _show_several(self, sources: Sequence[Source]) -> None:
        self.window.docks["gallery"].show()
        self.thumbnails.show_several(sources)

    def _show_theme(self, theme: Theme) -> None:
        self.presenter.show_theme(theme)

    def _show_whole(self, whole: bool) -> None:
        sample = self.session.state.sample
        if sample is not None:
            self.session.set_sample(as_a_whole(sample) if whole else at_full_size(sample))

    # Wiring.

    def _connect(self) -> None:
        window, session, controller, presenter = self.window, self.session, self.controller, self.presenter
        window.dropped.connect(self.exchange.take)
        window.closing.connect(self.close)
        window.gallery.chosen.connect(self.opener.open)
        window.gallery.strip.chosen.connect(self.opener.open)
        self._connect_controls()
        # It comes with every change, and also when only the history is another one.
        session.history_changed.connect(presenter.show_session)
        session.changed.connect(self._thrift.stir)
        session.selected.connect(lambda _: presenter.show_session())
        controller.scene_changed.connect(presenter.show_scene)
        controller.scene_changed.connect(self.tuning.show_scene)
        self.tuning.compared.connect(controller.tell_compared)
        controller.exemplar_ready.connect(presenter.show_exemplar)
        controller.errands_changed.connect(window.status.show_errands)
        controller.problem.connect(lambda text: window.message_bar.tell(text, "problem"))
        controller.said.connect(lambda text: window.message_bar.tell(text, "news"))
        for how in ("copy", "save"):
            window.actions_by_name[f"{how}-tab"].triggered.connect(partial(self._take_tab, how))
        presenter.recent_chosen.connect(self.opener.open)
        self.crash.crashed.connect(lambda text: window.message_bar.tell(text, "problem"))
        # The themes outlive the window; a function that knows the window would keep it.
        self.themes.changed.connect(self._show_theme)
        self.workspace.column_made.connect(self._connect_column)
        # Its commands have their keys there too.
        self.workspace.apart.made.connect(lambda made: made.addActions([*window.actions_by_name.values()]))
        self.workspace.column_moved.connect(session.move_column)
        for host in self.hosts.values():
            host.made.connect(self._connect_dock)
        self.presets.intention.connect(self.carrier.carry_out)

    def _take_tab(self, how: str, _: bool = False) -> None:
        self.tabs.take_front(how)

    def _open_tab(self, name: str, wanted: Mapping[str, Any]) -> None:
        self.window.raise_dock(name)
        dock = self.hosts[name].dock if name in self.hosts else None
        if dock is not None and (problems := dock.take_settings(wanted)):
            self.controller.problem.emit(f"Tab {dock.title}: {'; '.join(problems)}.")

    def _connect_dock(self, dock: Dock) -> None:
        dock.intention.connect(self.carrier.carry_out)

    def _connect_controls(self) -> None:
        """Connect what the user turns and drags."""
        window, session, controller, turn = self.window, self.session, self.controller, self.handlers.turn
        window.toolbar.seed_turned.connect(lambda seed: turn("seed", partial(session.set_seed, seed)))
        window.toolbar.size_turned.connect(lambda size: turn("size", partial(session.set_size, size)))
        parameters = window.parameters
        parameters.intention.connect(self.carrier.carry_out)
        parameters.help_wanted.connect(self.desk.show_help)
        self.desk.lesson_wanted.connect(lambda name, own: self.teacher.carry_out(OpenLesson(name, own)))
        self.desk.tab_wanted.connect(self._open_tab)
        parameters.dock_wanted.connect(window.raise_dock)
        exemplar = self.workspace.exemplar
        exemplar.crop_changed.connect(controller.editing.crop)
        exemplar.scale_changed.connect(lambda scale: turn("scale", partial(controller.editing.scale, scale)))
        exemplar.levels_changed.connect(
            lambda levels, look: turn("levels", partial(controller.editing.levels, levels, look))
        )
        exemplar.whole_wanted.connect(self._show_whole)
        exemplar.transparency_wanted.connect(self.opener.read_transparency)
        exemplar.hovered.connect(self.presenter.say_exemplar_pixel)

    def _connect_column(self, view: ColumnView) -> None:
        controller = self.controller
        view.chosen.connect(self.session.select)
        view.method_chosen.connect(self.handlers.choose_method)
        view.command.connect(self.handlers.column_command)
        view.hovered.connect(self.presenter.say_column_pixel)
        view.hovered.connect(controller.pointing.point_at)
        view.pixel_clicked.connect(controller.pointing.pin)
        view.map_chosen.connect(self.overlays.choose)


def first_columns() -> list[tuple[str, Any]]:
    """Return the columns of a first start."""
    known = methods()
    return [(name, known[name].params()) for name in FIRST_SIGHT]
