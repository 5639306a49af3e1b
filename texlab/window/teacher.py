"""Gives lessons: the user's session is set aside, steps are shown, and it comes back untouched."""

from __future__ import annotations

import dataclasses
from functools import partial
from typing import TYPE_CHECKING, Any, assert_never

from PySide6.QtCore import QObject, Signal

from texlab.runs.lesson_runner import LessonRunner
from texlab.state.intentions import (
    ChangeLesson,
    CopyLesson,
    GoToStep,
    LeaveLesson,
    NewLesson,
    OpenLesson,
    SaveStep,
    UndoLesson,
)
from texlab.state.lesson_edits import Version, Versions, shown_alike
from texlab.state.lesson_scene import LessonScene
from texlab.state.lessons import state_of
from texlab.state.scene import Probe
from texlab.style.pictures import Mark
from texlab.widgets.settling import settle_all
from texlab.window.lesson_desk import LessonDesk, read, tab_of
from texlab.window.same_size import SameSize
from texlab.window.tabs_ahead import TabsAhead
from texlab_core.documents.lesson_parts import LessonError
from texlab_core.documents.lessons import MAX_STEPS
from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from texlab.columns.workspace import Workspace
    from texlab.docks.host import DockHost
    from texlab.runs.controller import Controller
    from texlab.runs.lesson_runner import Opened
    from texlab.state.session import Aside
    from texlab.storage.autosave import Autosave
    from texlab.widgets.control_settings import Setting
    from texlab.window.main_window import MainWindow
    from texlab.window.presenter import Presenter
    from texlab_core.documents.lessons import Lesson, LessonStep

Teaching = OpenLesson | GoToStep | LeaveLesson | SaveStep | NewLesson | ChangeLesson | UndoLesson | CopyLesson


class Teacher(QObject):
    """Opens, gives, changes and leaves lessons.

    Parameters
    ----------
    folder
        Where the user's own lessons are; made when the first is written.

    ``told(lesson)`` with a :class:`LessonScene`, whenever there is something new about the lesson.
    """

    told = Signal(object)

    def __init__(
        self,
        window: MainWindow,
        workspace: Workspace,
        controller: Controller,
        presenter: Presenter,
        autosave: Autosave,
        hosts: Mapping[str, DockHost],
        folder: Path,
    ) -> None:
        super().__init__(window)
        self._window = window
        self._workspace = workspace
        self._controller = controller
        self._session = controller.session
        self._presenter = presenter
        self._autosave = autosave
        self._hosts = hosts
        self._aside: Aside | None = None
        self._opened: Opened | None = None
        self._wanted = OpenLesson("")
        # Counts how often another lesson was opened, or one was left.
        self._asked = 0
        self._first_place = 0
        self._to_show: LessonStep | None = None
        # How results were shown, and how the controls of tabs stood, before a step set them.
        self._tiled = False
        self._controls: dict[str, dict[str, Setting]] = {}
        self._scene = LessonScene(folder=folder)
        self.desk = LessonDesk(window, controller, hosts, folder)
        self.desk.moved = self._moved
        self._versions = Versions()
        self.runner = LessonRunner(controller.shared, self)
        self.runner.opened.connect(self._begin)
        self.runner.advanced.connect(self._tell)
        self.runner.failed.connect(controller.problem)
        self._sizing = SameSize(window)
        self.tabs = TabsAhead(hosts, self)
        self.tabs.advanced.connect(self._tell)
        presenter.painted.connect(self._painted)
        actions = window.actions_by_name
        actions["lessons"].triggered.connect(lambda: window.raise_dock("lessons"))
        actions["lesson-next"].triggered.connect(lambda: self._step(1))
        actions["lesson-back"].triggered.connect(lambda: self._step(-1))
        actions["lesson-leave"].triggered.connect(lambda: self.carry_out(LeaveLesson()))
        self._tell()

    @property
    def scene(self) -> LessonScene:
        """What there is to see of the lesson."""
        return self._scene

    @property
    def _first_id(self) -> int:
        """Id of the lesson's first column: its columns are none of the user's."""
        return 1 if self._aside is None else self._aside.state.next_id

    def carry_out(self, intention: Any) -> None:
        """Do what is intended; what cannot be done is said."""
        wanted: Teaching = intention
        if not isinstance(wanted, ChangeLesson):
            # Words that are still being typed belong to the step that is left.
            settle_all(self._window)
        try:
            match wanted:
                case OpenLesson():
                    self._open(wanted)
                case GoToStep(place, stay):
                    self._go(place, stay=stay)
                case LeaveLesson():
                    self._leave()
                case SaveStep(sentence):
                    self._save(sentence)
                case NewLesson(title):
                    self._new(title)
                case ChangeLesson(lesson, place):
                    self._change(lesson, place)
                case UndoLesson(redo):
                    self._undo(redo=redo)
                case CopyLesson():
                    self._copy()
                case _:
                    assert_never(wanted)
        except InputError as bad:
            self._controller.problem.emit(str(bad))

    def leave_threads(self) -> None:
        """Ask the thread to end, without waiting."""
        self.runner.leave()

    def close(self) -> None:
        """Stop the thread and wait for its end."""
        self.runner.close()
        self.desk.close()

    # Giving a lesson.

    def _open(self, wanted: OpenLesson, place: int = 0) -> None:
        self._asked += 1
        self._wanted, self._first_place = wanted, place
        self.runner.open(wanted.name, partial(read, wanted, self._scene.folder))

    def _begin(self, opened: Opened) -> None:
        if self._aside is None:
            self._aside = self._session.set_aside()
            self._tiled = self._window.actions_by_name["tile"].isChecked()
            self._autosave.hold(self._aside.state, self._aside.selected_id)
        self._opened = opened
        if self._wanted.own:
            self.desk.note(opened.name, opened.lesson)
        if (opened.name, self._wanted.own) != (self._scene.name, self._scene.own):
            self._versions.clear()
        self._scene = dataclasses.replace(
            self._scene, name=opened.name, lesson=opened.lesson, own=self._wanted.own, place=0, drawn=None
        )
        self._go(min(self._first_place, len(opened.lesson.steps) - 1))

    def _step(self, by: int) -> None:
        self.carry_out(GoToStep(self._scene.place + by))

    def _go(self, place: int, *, stay: bool = False) -> None:
        opened = self._opened
        if opened is None or not 0 <= place < len(opened.lesson.steps):
            return
        step, pictures = opened.lesson.steps[place], opened.pictures[place]
        self._sizing.keep()
        column_id = self._first_id + (step.series.column if step.series is not None else 0)
        self._scene = dataclasses.replace(self._scene, place=place, column_id=column_id)
        session = self._session
        session.apply(state_of(step, pictures, session.state, self._first_id), f"step {place + 1}")
        # What students tried at a step is undone there, not across steps.
        session.reset_history()
        if step.columns:
            session.select(self._first_id + step.chosen)
        self._controller.pointing.ask_about(self._probe(step))
        self._to_show = step
        if not stay:
            self._show_tab(step)
        self._prepare(opened.lesson, place)
        self._tell()

    def _prepare(self, lesson: Lesson, place: int) -> None:
        """Make everything ready, from this step on."""
        self.runner.prepare_from(place)
        self.tabs.want((*lesson.steps[place:], *lesson.steps[:place]))

    def _probe(self, step: LessonStep) -> Probe | None:
        pixel = step.pixel
        return None if pixel is None else Probe(self._first_id + pixel.column, pixel.row, pixel.x, pinned=True)

    def _show_tab(self, step: LessonStep) -> None:
        name = tab_of(step)
        # The keyboard stays where it is: Page Down goes on, whatever is in front.
        if not self._window.show_dock(name):
            self._controller.problem.emit(f"The window has no tab called {name}.")
        elif step.tab is not None:
            dock = self._hosts[name].dock
            self._controls.setdefault(name, dock.settings())
            if problems := dock.take_settings(step.tab.settings):
                self._controller.problem.emit(f"Tab {dock.title}: {'; '.join(problems)}.")

    def _painted(self) -> None:
        """Show zoom, place and marks once the pictures of the step are there."""
        step, prepared, sample = self._to_show, self._controller.prepared, self._session.state.sample
        if step is None or prepared is None or sample is None or self._controller.preparing:
            return
        self._to_show = None
        tile = self._window.actions_by_name["tile"]
        tile.setChecked(step.view.tile)
        self._workspace.set_tiled(step.view.tile)
        link = self._workspace.link
        if step.view.zoom is None:
            link.fit()
        else:
            link.show_at(step.view.x, step.view.y, step.view.zoom)
        self._presenter.show_marks(tuple(Mark(*each) for each in step.marks))

    def _tell(self) -> None:
        """Tell everybody where the lesson is."""
        steps = () if self._scene.lesson is None else self._scene.lesson.steps
        count = len(steps)
        ready = tuple(self.runner.ready(place) and self.tabs.ready(step) for place, step in enumerate(steps))
        self._scene = dataclasses.replace(
            self._scene,
            ready=ready,
            drawn=self.runner.drawn(self._scene.place),
            can_undo=self._versions.can_undo,
            can_redo=self._versions.can_redo,
        )
        actions = self._window.actions_by_name
        actions["lesson-next"].setEnabled(self._scene.place + 1 < count)
        actions["lesson-back"].setEnabled(count > 0 and self._scene.place > 0)
        actions["lesson-leave"].setEnabled(count > 0)
        self._window.lesson_bar.show_lesson(self._scene)
        self._controller.show_lesson(self._scene)
        self.told.emit(self._scene)

    def _leave(self) -> None:
        """Bring the user's own session back, with everything that undo and redo know."""
        if self._aside is None:
            return
        self._asked += 1
        self.runner.leave_lesson()
        self.tabs.want(())
        self._versions.clear()
        aside, self._aside, self._opened, self._to_show = self._aside, None, None, None
        self._scene = LessonScene(folder=self._scene.folder, shelf=self._scene.shelf)
        self._controller.pointing.ask_about(None)
        self._session.bring_back(aside)
        for name, controls in self._controls.items():
            self._hosts[name].dock.take_settings(controls)
        self._controls.clear()
        self._window.actions_by_name["tile"].setChecked(self._tiled)
        self._workspace.set_tiled(self._tiled)
        self._autosave.release()
        self._presenter.show_marks(())
        self._tell()

    # The user's own lessons.

    def _save(self, sentence: str) -> None:
        """Add what the window shows to the user's own lesson, or begin one with it."""
        lesson = self._scene.lesson
        if lesson is None or not self._scene.own:
            self._new("My lesson", sentence)
            return
        step = self.desk.step(self._scene.name, sentence)
        place = self._scene.place + 1
        self._change(
            dataclasses.replace(lesson, steps=(*lesson.steps[:place], step, *lesson.steps[place:])), place
        )

    def _new(self, title: str, sentence: str = "The first step.") -> None:
        from texlab_core.documents.lessons import Lesson

        name = self.desk.free_name(title)
        self._write(name, Lesson(title=title, steps=(self.desk.step(name, sentence),), folder=self.desk.folder))

    def _copy(self) -> None:
        """Make a lesson that is given the user's own."""
        lesson = self._scene.lesson
        if lesson is not None:
            self._write(self.desk.free_name(self._scene.name), lesson, self._scene.place)

    def _change(self, lesson: Lesson, place: int, *, remember: bool = True) -> None:
        """Let the lesson be this one from now on; what a step shows already stays as it is."""
        opened, scene = self._opened, self._scene
        if opened is None or not scene.own:
            raise LessonError("Only lessons of your own can be changed.")
        check_steps(lesson)
        if remember:
            self._versions.note(Version(opened.lesson, scene.place))
        order = shown_alike(opened.lesson, lesson)
        known = tuple(each for each in order if each is not None)
        if len(known) < len(order):
            # A step whose pictures are still to be read.
            self._write(scene.name, lesson, place)
            return
        self._opened = self.runner.rearrange(lesson, known)
        self._scene = dataclasses.replace(scene, lesson=lesson)
        self.desk.write(scene.name, lesson, partial(self._written, lesson))
        if known[place] != scene.place:
            # Who edits wants to go on with that.
            self._go(place, stay=True)
            return
        self._scene = dataclasses.replace(self._scene, place=place)
        self._prepare(lesson, place)
        self._tell()

    def _undo(self, *, redo: bool) -> None:
        opened = self._opened
        if opened is None or not self._scene.own:
            return
        now = Version(opened.lesson, self._scene.place)
        version = self._versions.redo(now) if redo else self._versions.undo(now)
        if version is not None:
            self._change(version.lesson, version.place, remember=False)

    def _write(self, name: str, lesson: Lesson, place: int = 0) -> None:
        """Write a lesson with the exemplar of the window beside it, and open it."""
        asked = self._asked

        def done() -> None:
            self._written(lesson)
            # Who has gone elsewhere since stays there.
            if asked == self._asked:
                self._open(OpenLesson(self.desk.current(name), own=True), place)

        self.desk.write(name, lesson, done, pictures=True)

    def _moved(self, name: str, free: str) -> None:
        """Go on with the lesson under the name that its file has got."""
        if self._scene.own and self._scene.name == name:
            self._scene = dataclasses.replace(self._scene, name=free)

    def _written(self, lesson: Lesson) -> None:
        self._scene = dataclasses.replace(self._scene, shelf=self._scene.shelf + 1)
        count = len(lesson.steps)
        self._controller.said.emit(f"Kept in the lesson {lesson.title}, {count} step{'s' * (count > 1)}.")
        self._tell()


def check_steps(lesson: Lesson) -> None:
    """Refuse what could not be read again; raises ``LessonError`` with one sentence."""
    if not 1 <= len(lesson.steps) <= MAX_STEPS:
        raise LessonError(f"A lesson has 1 to {MAX_STEPS} steps; this one would have {len(lesson.steps)}.")
