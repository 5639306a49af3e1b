"""Lessons of one's own, edited in the window: words in place, steps moved, doubled and removed, and back again."""

from __future__ import annotations

import dataclasses
import json
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import feed, scene_of
from PySide6.QtCore import QObject, Qt

from tests.gui.conftest import ids, wait_idle
from tests.gui.test_lessons import SMALL, give, wait_ready
from texlab.docks.lessons.dock import LessonsDock
from texlab.docks.lessons.editor import ORDER_KEYS, LessonEditor
from texlab.runs import lesson_runner
from texlab.runs.controller import Controller
from texlab.state.chosen import Sample, State
from texlab.state.intentions import ChangeLesson, CopyLesson, GoToStep, LeaveLesson, SaveStep, UndoLesson
from texlab.state.lesson_edits import Version, Versions, doubled, moved, removed, shown_alike, with_steps
from texlab.state.lesson_scene import LessonScene
from texlab.state.lessons import Draft, file_of, state_of, step_of
from texlab.state.session import Session
from texlab.storage.paths import config_dir
from texlab.widgets.settling import settle_all
from texlab.window.lesson_desk import LessonDesk, save_picture
from texlab_core.documents.lessons import Lesson, LessonStep, lesson_from_json, read_lesson, write_lesson
from texlab_core.engine.inputs import Crop
from texlab_core.engine.levels import Levels
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from texlab.app.explorer import Explorer

CONTROL, ALT = Qt.KeyboardModifier.ControlModifier, Qt.KeyboardModifier.AltModifier


def lesson_of(*sentences: str) -> Lesson:
    return Lesson(title="Mine", steps=tuple(LessonStep(sentence=each, seed=ord(each[0])) for each in sentences))


def sentences(lesson: Lesson | None) -> str:
    return "" if lesson is None else "".join(step.sentence for step in lesson.steps)


@pytest.mark.parametrize(
    ("change", "order", "place"),
    [
        (moved(4, 1, 1), (0, 2, 1, 3), 2),
        (moved(4, 1, -1), (1, 0, 2, 3), 0),
        (moved(4, 0, -1), (0, 1, 2, 3), 0),
        (moved(4, 3, 1), (0, 1, 2, 3), 3),
        (doubled(3, 1), (0, 1, 1, 2), 2),
        (removed(3, 1), (0, 2), 1),
        (removed(3, 2), (0, 1), 1),
        (removed(1, 0), (0,), 0),
    ],
)
def test_orders(change: tuple[tuple[int, ...], int], order: tuple[int, ...], place: int) -> None:
    assert change == (order, place)


def test_what_shows_the_same_is_found_whatever_is_said() -> None:
    before = lesson_of("a", "b", "c")
    said = dataclasses.replace(before.steps[2], sentence="other", note="words")
    assert shown_alike(before, dataclasses.replace(before, steps=(said, *before.steps[:2]))) == (2, 0, 1)
    # Of two that show the same the one that stayed comes first.
    twice = with_steps(before, (0, 1, 1))
    assert shown_alike(twice, twice) == (0, 1, 2)
    assert shown_alike(before, lesson_of("a", "x")) == (0, None)


def test_versions_go_back_and_on_and_forget_what_was_undone() -> None:
    versions = Versions()
    one, two, three = (Version(lesson_of(each), 0) for each in "abc")
    assert versions.undo(one) is None
    versions.note(one)
    assert versions.undo(two) is one
    assert versions.redo(one) is two
    versions.undo(two)
    versions.note(one)
    assert not versions.can_redo
    assert versions.redo(three) is None


# The editor alone.


class Edited:
    """An editor that is shown what it wants, as the window does."""

    def __init__(self, qtbot: Any, lesson: Lesson, place: int = 0) -> None:
        self.editor = LessonEditor()
        for each in (self.editor, self.editor.words):
            qtbot.addWidget(each)
            each.resize(420, 400)
            each.show()
        self.changes = 0
        self.editor.changed.connect(self._take)
        self.editor.chosen.connect(lambda place: self.show(self.lesson, place))
        self.show(lesson, place)

    def _take(self, lesson: Lesson, place: int) -> None:
        self.changes += 1
        self.show(lesson, place)

    def show(self, lesson: Lesson, place: int) -> None:
        self.lesson, self.place = lesson, place
        self.editor.show_lesson(LessonScene(name="mine", lesson=lesson, own=True, place=place))


def test_keys_of_the_list_move_double_and_remove(qtbot: Any) -> None:
    edited = Edited(qtbot, lesson_of("a", "b", "c"), 1)
    steps = edited.editor.steps
    qtbot.keyClick(steps, Qt.Key.Key_Up, ALT)
    assert (sentences(edited.lesson), edited.place) == ("bac", 0)
    qtbot.keyClick(steps, Qt.Key.Key_Down, ALT)
    qtbot.keyClick(steps, Qt.Key.Key_Down, ALT)
    assert (sentences(edited.lesson), edited.place) == ("acb", 2)
    changes = edited.changes
    qtbot.keyClick(steps, Qt.Key.Key_Down, ALT)
    assert edited.changes == changes
    qtbot.keyClick(steps, Qt.Key.Key_D, CONTROL)
    assert (sentences(edited.lesson), edited.place) == ("acbb", 3)
    for _ in range(5):
        qtbot.keyClick(steps, Qt.Key.Key_Delete)
    # Something is always left.
    assert sentences(edited.lesson) == "a"
    assert not edited.editor.buttons["remove"].isEnabled()
    undone = []
    edited.editor.undone.connect(undone.append)
    qtbot.keyClick(steps, Qt.Key.Key_Z, CONTROL)
    qtbot.keyClick(steps, Qt.Key.Key_Z, CONTROL | Qt.KeyboardModifier.ShiftModifier)
    assert undone == [False, True]
    assert len(ORDER_KEYS) == 6


def test_a_step_is_dragged_to_another_place(qtbot: Any) -> None:
    edited = Edited(qtbot, lesson_of("a", "b", "c", "d"), 1)
    steps = edited.editor.steps
    # What a drop does to a list in which entries are moved.
    steps.model().moveRow(steps.rootIndex(), 0, steps.rootIndex(), 3)
    assert (sentences(edited.lesson), edited.place) == ("bcad", 0)
    steps.model().moveRow(steps.rootIndex(), 3, steps.rootIndex(), 0)
    assert (sentences(edited.lesson), edited.place) == ("dbca", 1)
    assert [steps.item(row).text() for row in range(4)] == list("dbca")
    assert steps.currentRow() == 1


def test_words_are_taken_when_typing_rests_and_are_not_written_over(qtbot: Any) -> None:
    edited = Edited(qtbot, lesson_of("a", "b"))
    words = edited.editor.words
    note, sentence = words.fields["note"], words.fields["sentence"]
    qtbot.keyClicks(note, "One. ")
    assert edited.changes == 0
    settle_all(edited.editor)
    settle_all(words)
    assert edited.lesson.steps[0].note == "One."
    # The space that was typed last is still there to go on from.
    qtbot.keyClicks(note, "Two.")
    sentence.selectAll()
    qtbot.keyClicks(sentence, "A sentence")
    # Going on takes them along, and to the step where they were typed.
    edited.show(edited.lesson, 1)
    assert edited.lesson.steps[0].note == "One. Two."
    assert edited.lesson.steps[0].sentence == "A sentence"
    assert edited.lesson.steps[1] == lesson_of("a", "b").steps[1]


def test_what_a_lesson_cannot_hold_is_not_taken(qtbot: Any) -> None:
    edited = Edited(qtbot, lesson_of("a"))
    words = edited.editor.words
    words.fields["title"].clear()
    words.fields["sentence"].clear()
    words.fields["note"].setPlainText("tab\there\xa0and\x07there\nnext" + "x" * 5000)
    words.fields["answer"].setPlainText("An answer")
    words.settling.end_now()
    step = edited.lesson.steps[0]
    assert (edited.lesson.title, step.sentence) == ("Mine", "a")
    assert step.note.startswith("tab here and there\nnextxxx")
    # An answer waits for its question, and is not lost.
    assert step.answer == ""
    assert words.text("answer") == "An answer"
    words.fields["question"].setPlainText("Why?")
    words.settling.end_now()
    assert edited.lesson.steps[0].answer == "An answer"
    assert lesson_from_json(edited.lesson.to_json()).steps[0].note == step.note


def test_the_dock_edits_lessons_of_ones_own_and_copies_others(qtbot: Any) -> None:
    dock = LessonsDock()
    qtbot.addWidget(dock)
    dock.resize(1000, 320)
    dock.show()
    sent: list[Any] = []
    dock.intention.connect(sent.append)

    def give_it(own: bool, name: str) -> None:
        scene = scene_of()
        object.__setattr__(scene, "lesson", LessonScene(None, 0, name, lesson_of("a", "b"), own))
        feed(dock, scene)

    give_it(False, "bundled")
    dock.edit_button.click()
    assert sent == [CopyLesson()]
    assert not dock.editor.isVisible()
    give_it(True, "copy")
    assert dock.edit_button.isChecked()
    for each in (dock.editor, dock.editor.words):
        assert each.isVisible()
    assert not dock.list.isVisible()
    dock.editor.buttons["down"].click()
    assert isinstance(sent[-1], ChangeLesson)
    assert sentences(sent[-1].lesson) == "ba"
    dock.editor.undone.emit(True)
    assert sent[-1] == UndoLesson(redo=True)
    dock.editor.chosen.emit(0)
    assert sent[-1] == GoToStep(0, stay=True)
    # Another lesson is shown, not edited.
    give_it(True, "other")
    assert not dock.edit_button.isChecked()
    assert dock.list.isVisible()


# Two windows with one lesson.


@pytest.fixture
def desks(qtbot: Any, qapp: Any, tmp_path: Path) -> Iterator[tuple[tuple[LessonDesk, LessonDesk], list[str]]]:
    """The desks of two windows with one folder, and what both said."""
    said: list[str] = []
    parent: Any = QObject()
    made = []
    controllers = [Controller(Session(parent), parent) for _ in range(2)]
    for controller in controllers:
        controller.problem.connect(said.append)
        made.append(LessonDesk(parent, controller, {}, tmp_path / "lessons"))
    yield (made[0], made[1]), said
    for desk, controller in zip(made, controllers, strict=True):
        desk.close()
        controller.close()


def keep(qtbot: Any, desk: LessonDesk, name: str, lesson: Lesson) -> None:
    with qtbot.waitCallback() as written:
        desk.write(name, lesson, written)


def test_what_another_window_has_changed_is_not_written_over(qtbot: Any, desks: Any) -> None:
    (here, there), said = desks
    moves: list[tuple[str, str]] = []
    there.moved = lambda *each: moves.append(each)
    first = lesson_from_json(SMALL)
    keep(qtbot, here, "small", first)
    file = here.folder / "small.json"
    for desk in (here, there):
        desk.note("small", read_lesson(file))
    ours, theirs = (dataclasses.replace(first, title=title) for title in ("Ours", "Theirs"))
    keep(qtbot, here, "small", ours)
    assert said == []
    keep(qtbot, there, "small", theirs)
    assert moves == [("small", "small-2")]
    assert [each.split(";")[1] for each in said] == [" what is changed here is kept in small-2."]
    # Each goes on with its own, and nothing is said twice.
    keep(qtbot, here, "small", dataclasses.replace(ours, summary="More."))
    keep(qtbot, there, there.current("small"), dataclasses.replace(theirs, summary="Other."))
    keep(qtbot, there, "small", dataclasses.replace(theirs, summary="Another."))
    kept = {path.stem: read_lesson(path) for path in here.folder.glob("*.json")}
    assert {name: (each.title, each.summary) for name, each in kept.items()} == {
        "small": ("Ours", "More."),
        "small-2": ("Theirs", "Another."),
    }
    assert len(said) == 1
    # Whoever opens it again has seen what is there.
    there.note("small", read_lesson(file))
    keep(qtbot, there, "small", theirs)
    assert read_lesson(file).title == "Theirs"
    assert len(said) == 1


def test_a_new_lesson_takes_no_name_that_is_taken_meanwhile(qtbot: Any, desks: Any) -> None:
    (here, there), said = desks
    assert here.free_name("Mine") == there.free_name("Mine") == "mine"
    keep(qtbot, here, "mine", lesson_from_json(SMALL))
    keep(qtbot, there, "mine", dataclasses.replace(lesson_from_json(SMALL), title="There"))
    assert read_lesson(here.folder / "mine.json").title == SMALL["title"]
    assert read_lesson(here.folder / "mine-2.json").title == "There"
    assert len(said) == 1
    # What somebody writes by hand stays, even half written.
    (here.folder / "mine.json").write_text("{")
    keep(qtbot, here, "mine", lesson_from_json(SMALL))
    assert (here.folder / "mine.json").read_text() == "{"
    assert read_lesson(here.folder / "mine-3.json").title == SMALL["title"]


# In the window.


@pytest.fixture
def small() -> Path:
    folder = config_dir() / "lessons"
    folder.mkdir(parents=True)
    (folder / "small.json").write_text(json.dumps(SMALL))
    return folder / "small.json"


def test_a_lesson_is_edited_while_it_is_given(
    qtbot: Any, explorer: Explorer, small: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    teacher, window = explorer.teacher, explorer.window
    mine = explorer.session.state
    give(qtbot, explorer, "small")
    wait_ready(qtbot, explorer)
    made, read = [], []
    usual_make, usual_open = lesson_runner._make, lesson_runner._opened
    monkeypatch.setattr(lesson_runner, "_make", lambda *args: (made.append(args[2]), usual_make(*args))[1])
    monkeypatch.setattr(lesson_runner, "_opened", lambda *args: (read.append(args[0]), usual_open(*args))[1])
    window.raise_dock("lessons")
    wait_idle(qtbot, explorer)
    dock = explorer.hosts["lessons"].dock
    dock.edit_button.click()
    editor = dock.editor

    def written() -> Lesson:
        return read_lesson(small)

    # What the user has turned at the step stays while its words are changed.
    explorer.session.set_seed(77)
    wait_idle(qtbot, explorer)
    note = editor.words.fields["note"]
    note.setFocus()
    note.selectAll()
    qtbot.keyClicks(note, "Other words.")
    qtbot.keyClick(note, Qt.Key.Key_PageDown, CONTROL)
    settle_all(window)
    qtbot.waitUntil(lambda: written().steps[0].note == "Other words.")
    assert explorer.session.state.seed == 77
    # Steps change places; each keeps what is ready of it, and the one that is shown is shown on.
    qtbot.mouseClick(editor.buttons["down"], Qt.MouseButton.LeftButton)
    assert teacher.scene.place == 1
    assert all(teacher.scene.ready)
    wait_idle(qtbot, explorer)
    assert [each.method for each in explorer.controller.scene().columns] == ["heeger-bergen", "tiling"]
    assert explorer.session.state.seed == 77
    qtbot.mouseClick(editor.buttons["double"], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: [each.sentence for each in written().steps] == ["Two.", "One.", "One.", "Three."])
    qtbot.mouseClick(editor.buttons["undo"], Qt.MouseButton.LeftButton)
    qtbot.mouseClick(editor.buttons["undo"], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: [each.sentence for each in written().steps] == ["One.", "Two.", "Three."])
    # Who edits is not taken to the tab of the step.
    assert window.front_dock() == "lessons"
    qtbot.waitUntil(editor.buttons["redo"].isEnabled)
    qtbot.mouseClick(editor.buttons["redo"], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: [each.sentence for each in written().steps] == ["Two.", "One.", "Three."])
    assert teacher.scene.can_redo
    # Nothing was computed or read anew for all that.
    assert (made, read) == ([], [])
    # Words that are still being typed are kept when the lesson is left, and it stays left.
    title = editor.words.fields["title"]
    title.selectAll()
    qtbot.keyClicks(title, "Renamed")
    window.actions_by_name["lesson-leave"].trigger()
    qtbot.waitUntil(lambda: written().title == "Renamed")
    wait_idle(qtbot, explorer)
    assert explorer.session.state is mine
    assert teacher.scene.lesson is None


def test_words_typed_just_before_the_window_closes_are_written(
    qtbot: Any, explorer: Explorer, small: Path
) -> None:
    give(qtbot, explorer, "small")
    explorer.window.raise_dock("lessons")
    wait_idle(qtbot, explorer)
    dock = explorer.hosts["lessons"].dock
    dock.edit_button.click()
    note = dock.editor.words.fields["note"]
    note.selectAll()
    qtbot.keyClicks(note, "At the last moment.")
    explorer.window.close()
    assert read_lesson(small).steps[0].note == "At the last moment."


def test_a_bundled_lesson_becomes_ones_own_and_the_palette_finds_it(qtbot: Any, explorer: Explorer) -> None:
    explorer.carrier.carry_out(ChangeLesson(lesson_of("a"), 0))
    give(qtbot, explorer, "histograms", own=False)
    with qtbot.waitSignal(explorer.controller.problem) as told:
        explorer.carrier.carry_out(ChangeLesson(lesson_of("a"), 0))
    assert told.args == ["Only lessons of your own can be changed."]
    explorer.carrier.carry_out(GoToStep(1))
    explorer.carrier.carry_out(CopyLesson())
    qtbot.waitUntil(lambda: explorer.teacher.scene.own)
    assert (explorer.teacher.scene.name, explorer.teacher.scene.place) == ("histograms", 1)
    explorer.carrier.carry_out(SaveStep("Mine."))
    qtbot.waitUntil(lambda: explorer.teacher.scene.place == 2 and explorer.teacher.scene.step.sentence == "Mine.")
    explorer.carrier.carry_out(UndoLesson())
    assert explorer.teacher.scene.step.sentence != "Mine."
    explorer.carrier.carry_out(LeaveLesson())
    wait_idle(qtbot, explorer)
    assert ids(explorer)
    explorer.desk.show_palette()
    palette = explorer.desk._palette
    qtbot.waitUntil(lambda: any(each.kind == "lesson" for each in palette._entries))
    found = [each for each in palette._entries if each.kind == "lesson" and "of your own" in each.help]
    assert len(found) == 1
    palette.close()
    found[0].run()
    qtbot.waitUntil(lambda: explorer.teacher.scene.own and explorer.teacher.scene.lesson is not None)
    explorer.carrier.carry_out(LeaveLesson())
    wait_idle(qtbot, explorer)


def test_a_step_that_is_saved_has_levels_and_transparency(tmp_path: Path) -> None:
    pixels = np.random.default_rng(8).integers(0, 256, (24, 20, 4)).astype(np.uint8)
    whole = as_exemplar(pixels, name="glass.png", alpha="keep")
    sample = Sample(whole, 1.0, Crop(2, 3, 16, 12), alpha="keep", levels=Levels(0.1, 0.8, 1.3))
    file = file_of(whole)
    step = step_of(Draft(State(sample, (), 1, (16, 16), 1)), "Glass.", file)
    save_picture(whole, tmp_path / file)
    write_lesson(Lesson(title="Glass", steps=(step,), folder=tmp_path), tmp_path / "glass.json")
    opened = lesson_runner._opened("glass", lambda: read_lesson(tmp_path / "glass.json"))
    (pictures,) = opened.pictures
    assert pictures.sample is not None
    assert pictures.exemplar is not None
    shown = state_of(opened.lesson.steps[0], pictures, State(), 1).sample
    assert shown is not None
    assert (shown.levels, shown.alpha, shown.crop) == (sample.levels, "keep", sample.crop)
    used = as_exemplar(whole, crop=sample.crop, levels=sample.levels)
    assert np.array_equal(pictures.exemplar.pixels, used.pixels)
    assert used.alpha is not None
    assert np.array_equal(pictures.exemplar.alpha, used.alpha)
    # Levels for the eye alone are none of the picture's.
    look = step_of(Draft(State(replace(sample, look_only=True), (), 1, (16, 16), 1)), "Glass.", file)
    assert look.exemplar is not None
    assert look.exemplar.levels is None
