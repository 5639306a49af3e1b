"""Gives lessons: the user's session is set aside, steps are shown, and it comes back untouched."""

from __future__ import annotations

import dataclasses
from functools import partial
from typing import TYPE_CHECKING, Any, assert_never

from PySide6.QtCore import QObject, Signal

from texlab.runs.lesson_runner import LessonRunner
from texlab.state.intentions import ChangeSteps, GoToStep, LeaveLesson, NewLesson, OpenLesson, SaveStep
from texlab.state.lesson_scene import LessonScene
from texlab.state.lessons import Draft, source_of, state_of, step_of
from texlab.state.scene import Probe
from texlab.style.pictures import Mark
from texlab_core.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    from texlab.columns.workspace import Workspace
    from texlab.docks.base import Dock
    from texlab.runs.controller import Controller
    from texlab.runs.lesson_runner import Opened
    from texlab.state.session import Aside
    from texlab.storage.autosave import Autosave
    from texlab.window.main_window import MainWindow
    from texlab.window.presenter import Presenter
    from texlab_core.documents.lessons import Lesson, LessonStep

Teaching = OpenLesson | GoToStep | LeaveLesson | SaveStep | NewLesson | ChangeSteps


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
        docks: list[Dock],
        folder: Path,
    ) -> None:
        super().__init__(window)
        self._window = window
        self._workspace = workspace
        self._controller = controller
        self._session = controller.session
        self._presenter = presenter
        self._autosave = autosave
        self._docks = {each.name: each for each in docks}
        self._aside: Aside | None = None
        self._first_id = 1
        self._opened: Opened | None = None
        self._wanted = OpenLesson("")
        self._first_place = 0
        self._to_show: LessonStep | None = None
        self._scene = LessonScene(folder=folder)
        self.runner = LessonRunner(controller.shared, self)
        self.runner.opened.connect(self._begin)
        self.runner.advanced.connect(self._tell)
        self.runner.failed.connect(controller.problem)
        presenter.painted.connect(self._painted)
        actions = window.actions_by_name
        actions["lessons"].triggered.connect(lambda: window.raise_dock("lessons"))
        actions["lesson-next"].triggered.connect(lambda: self._go(self._scene.place + 1))
        actions["lesson-back"].triggered.connect(lambda: self._go(self._scene.place - 1))
        actions["lesson-leave"].triggered.connect(self._leave)
        self._tell()

    @property
    def scene(self) -> LessonScene:
        """What there is to see of the lesson."""
        return self._scene

    def carry_out(self, intention: Any) -> None:
        """Do what is intended; what cannot be done is said."""
        wanted: Teaching = intention
        try:
            match wanted:
                case OpenLesson():
                    self._open(wanted)
                case GoToStep(place):
                    self._go(place)
                case LeaveLesson():
                    self._leave()
                case SaveStep(sentence):
                    self._save(sentence)
                case NewLesson(title):
                    self._new(title)
                case ChangeSteps(steps, place):
                    self._change(steps, place)
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

    # Giving a lesson.

    def _open(self, wanted: OpenLesson, place: int = 0) -> None:
        self._wanted, self._first_place = wanted, place
        self.runner.open(wanted.name, partial(read, wanted, self._scene.folder))

    def _begin(self, opened: Opened) -> None:
        if self._aside is None:
            self._aside = self._session.set_aside()
            self._autosave.hold(self._aside.state, self._aside.selected_id)
            # Columns of the lesson are none of the user's.
            self._first_id = self._aside.state.next_id
        self._opened = opened
        self._scene = dataclasses.replace(
            self._scene, name=opened.name, lesson=opened.lesson, own=self._wanted.own, place=0, drawn=None
        )
        self._go(min(self._first_place, len(opened.lesson.steps) - 1))

    def _go(self, place: int) -> None:
        opened = self._opened
        if opened is None or not 0 <= place < len(opened.lesson.steps):
            return
        step, pictures = opened.lesson.steps[place], opened.pictures[place]
        column_id = self._first_id + (step.series.column if step.series is not None else 0)
        self._scene = dataclasses.replace(self._scene, place=place, column_id=column_id)
        session = self._session
        session.apply(state_of(step, pictures, session.state, self._first_id), f"step {place + 1}")
        # What students tried at a step is undone there, not across steps.
        session.reset_history()
        if step.columns:
            session.select(self._first_id + step.chosen)
        self._controller.ask_about(self._probe(step))
        self._to_show = step
        self._show_tab(step)
        self.runner.prepare_from(place)
        self._tell()

    def _probe(self, step: LessonStep) -> Probe | None:
        pixel = step.pixel
        return None if pixel is None else Probe(self._first_id + pixel.column, pixel.row, pixel.x, pinned=True)

    def _show_tab(self, step: LessonStep) -> None:
        name = step.tab.name if step.tab is not None else "lessons"
        # The keyboard stays where it is: Page Down goes on, whatever is in front.
        if not self._window.show_dock(name):
            self._controller.problem.emit(f"The window has no tab called {name}.")
        elif step.tab is not None and (problems := self._docks[name].take_settings(step.tab.settings)):
            self._controller.problem.emit(f"Tab {self._docks[name].title}: {'; '.join(problems)}.")

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
        count = 0 if self._scene.lesson is None else len(self._scene.lesson.steps)
        ready = tuple(self.runner.ready(place) for place in range(count))
        self._scene = dataclasses.replace(self._scene, ready=ready, drawn=self.runner.drawn(self._scene.place))
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
        self.runner.leave_lesson()
        aside, self._aside, self._opened, self._to_show = self._aside, None, None, None
        self._scene = LessonScene(folder=self._scene.folder, shelf=self._scene.shelf)
        self._controller.ask_about(None)
        self._session.bring_back(aside)
        self._autosave.release()
        self._presenter.show_marks(())
        self._tell()

    # The user's own lessons.

    def _draft(self) -> Draft:
        name = self._window.front_dock()
        dock = self._docks.get(name)
        controller, session = self._controller, self._session
        probe = controller.probe
        kept = probe is not None and probe.pinned
        return Draft(
            session.state,
            session.selected_id,
            (probe.column_id, probe.row, probe.column) if probe is not None and kept else None,
            name if dock is not None and name != "lessons" else "",
            {} if dock is None else dock.settings(),
            self._window.actions_by_name["tile"].isChecked(),
        )

    def _save(self, sentence: str) -> None:
        """Add what the window shows to the user's own lesson, or begin one with it."""
        lesson = self._scene.lesson
        if lesson is None or not self._scene.own:
            self._new("My lesson", sentence)
            return
        step = self._make_step(self._scene.name, sentence)
        place = self._scene.place + 1
        self._change((*lesson.steps[:place], step, *lesson.steps[place:]), place)

    def _new(self, title: str, sentence: str = "The first step.") -> None:
        from texlab_core.documents.lessons import Lesson

        folder = self._scene.folder
        assert folder is not None
        stem = title.lower().replace(" ", "-")
        names = (stem, *(f"{stem}-{number}" for number in range(2, 1000)))
        name = next(each for each in names if not (folder / f"{each}.json").exists())
        self._write(name, Lesson(title=title, steps=(self._make_step(name, sentence),), folder=folder), 0)

    def _make_step(self, name: str, sentence: str) -> LessonStep:
        sample = self._session.state.sample
        file = "" if sample is None else f"{name}/{sample.source.sha256[:16]}.png"
        return step_of(self._draft(), sentence, file)

    def _change(self, steps: tuple[LessonStep, ...], place: int) -> None:
        lesson = self._scene.lesson
        if lesson is None or not self._scene.own:
            self._controller.problem.emit("Only lessons of your own can be changed.")
            return
        self._write(self._scene.name, dataclasses.replace(lesson, steps=steps), place)

    def _write(self, name: str, lesson: Lesson, place: int) -> None:
        folder = self._scene.folder
        assert folder is not None
        sample = self._session.state.sample
        image = None if sample is None else sample.source

        def work(task: Any) -> None:
            from texlab_core.documents.lessons import write_lesson

            folder.mkdir(parents=True, exist_ok=True)
            if image is not None and source_of(image, "") == "":
                save_picture(image.pixels, folder / name / f"{image.sha256[:16]}.png")
            write_lesson(lesson, folder / f"{name}.json")

        def done(_: Any) -> None:
            self._scene = dataclasses.replace(self._scene, shelf=self._scene.shelf + 1)
            self._controller.said.emit(f"Kept in the lesson {lesson.title}, {len(lesson.steps)} steps.")
            self._open(OpenLesson(name, own=True), place)

        self._controller.once("lesson", work, done)


def read(wanted: OpenLesson, folder: Path | None) -> Lesson:
    """Read a lesson (in the background)."""
    from texlab_core.documents.lessons import read_lesson
    from texlab_core.lessons.shelf import find

    return read_lesson(folder / f"{wanted.name}.json") if wanted.own and folder is not None else find(wanted.name)


def save_picture(pixels: Any, path: Path) -> None:
    """Write the exemplar of a step beside its lesson, unless it is there (in the background)."""
    import numpy as np

    from texlab_core.files.whole import write_whole
    from texlab_core.images.formats.writing import encode_png

    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, encode_png(np.rint(pixels * 255).astype(np.uint8)))
