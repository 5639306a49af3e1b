"""Lessons in the window: given with the keys of a clicker, instant, and the user's own session comes back."""

from __future__ import annotations

import dataclasses
import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import feed, scene_of
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QWidget

from tests.gui.conftest import ids, result_image, wait_idle
from texlab.docks import dock_classes
from texlab.docks.lessons.dock import LessonsDock
from texlab.runs import column_run
from texlab.runs.column_run import MeasureRun
from texlab.state.intentions import GoToStep, LeaveLesson, NewLesson, OpenLesson, SaveStep
from texlab.state.lesson_scene import LessonScene
from texlab.storage.paths import config_dir
from texlab.window import teacher
from texlab.window.tabs_ahead import PAUSE_MS
from texlab_core.documents.lessons import read_lesson
from texlab_core.engine.inputs import Crop
from texlab_core.engine.run import run
from texlab_core.lessons.running import jobs
from texlab_core.lessons.shelf import bundled

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtWidgets import QTreeWidgetItem

    from texlab.app.explorer import Explorer
    from texlab_core.documents.lessons import Lesson, LessonStep

SMALL: dict[str, Any] = {
    "format": "texlab-lesson",
    "version": 1,
    "title": "Small",
    "chapter": "",
    "papers": [],
    "summary": "",
    "steps": [
        {
            "sentence": "One.",
            "note": "The first.",
            "question": "Why?",
            "answer": "So.",
            "exemplar": {
                "source": "gallery:stochastic-lava",
                "crop": {"top": 0, "left": 0, "height": 32, "width": 32},
            },
            "size": {"width": 40, "height": 40},
            "seed": 3,
            "columns": [
                {"method": "heeger-bergen", "parameters": {"scales": 2, "iterations": 1}},
                {"method": "tiling"},
            ],
            "chosen": 1,
            "series": {"column": 0, "parameter": "iterations", "values": [0, 1, 2]},
            "drawing": {"kind": "histograms", "settings": {"levels": 1}},
            "tab": {"name": "pyramid", "settings": {"kind": "laplacian"}},
            "pixel": {"column": 1, "x": 5, "y": 6},
            "view": {"zoom": 3.0, "x": 10.0, "y": 12.0, "tile": True},
            "marks": [{"top": 1, "left": 2, "height": 5, "width": 6}],
        },
        {
            "sentence": "Two.",
            "note": "The second.",
            "exemplar": "gallery:stochastic-sea",
            "size": {"width": 32, "height": 48},
            "seed": 1,
            "columns": [{"method": "pixels"}],
        },
        {"sentence": "Three.", "note": "A drawing alone.", "seed": 1, "drawing": {"kind": "circles"}},
    ],
}


@pytest.fixture
def small() -> str:
    folder = config_dir() / "lessons"
    folder.mkdir(parents=True)
    (folder / "small.json").write_text(json.dumps(SMALL))
    return "small"


def give(qtbot: Any, explorer: Explorer, name: str, *, own: bool = True) -> None:
    explorer.carrier.carry_out(OpenLesson(name, own))
    qtbot.waitUntil(lambda: explorer.teacher.scene.name == name)


def wait_ready(qtbot: Any, explorer: Explorer) -> None:
    qtbot.waitUntil(lambda: all(explorer.teacher.scene.ready))
    wait_idle(qtbot, explorer)


def item_of(dock: LessonsDock, name: str) -> QTreeWidgetItem:
    for heading in dock.list.findItems("", Qt.MatchFlag.MatchContains):
        for place in range(heading.childCount()):
            item = heading.child(place)
            if item is not None and item.data(0, Qt.ItemDataRole.UserRole)[0] == name:
                return item
    raise AssertionError(name)


def test_steps_come_with_what_explains_them(qtbot: Any, explorer: Explorer, small: str) -> None:
    give(qtbot, explorer, small)
    wait_ready(qtbot, explorer)
    teacher, kept = explorer.teacher, explorer.controller.shared.kept
    keys = set(teacher.runner._keys[0])
    for key in keys:
        end = kept.get(key)
        assert end is not None
        kept.put(key, dataclasses.replace(end, stored=True))
    teacher.runner._keys.clear()
    teacher.runner.prepare_from(0)
    qtbot.waitUntil(lambda: all((end := kept.get(key)) is not None and not end.stored for key in keys))


def test_a_step_sets_everything_and_leaving_brings_everything_back(
    qtbot: Any, explorer: Explorer, small: str
) -> None:
    session = explorer.session
    session.set_seed(9)
    wait_idle(qtbot, explorer)
    before, mine, undo = session.state, result_image(explorer, ids(explorer)[0]), session.undo_text
    give(qtbot, explorer, small)
    wait_ready(qtbot, explorer)
    lesson = explorer.teacher.scene.lesson
    assert lesson is not None
    for column, job in zip(ids(explorer), jobs(lesson, lesson.steps[0]), strict=False):
        assert np.array_equal(result_image(explorer, column), run(job).image)
    assert set(ids(explorer)).isdisjoint(column.id for column in before.columns)
    assert session.selected_id == ids(explorer)[1]
    probe = explorer.controller.pointing.probe
    assert probe is not None
    assert (probe.column_id, probe.row, probe.column, probe.pinned) == (ids(explorer)[1], 6, 5, True)
    assert explorer.window.front_dock() == "pyramid"
    assert explorer.hosts["pyramid"].dock.settings()["kind"] == "laplacian"
    assert explorer.window.actions_by_name["tile"].isChecked()
    assert explorer.workspace.exemplar.pane._marks
    bar = explorer.window.lesson_bar
    assert bar.isVisible()
    assert (bar.count.text(), bar.sentence.text(), bar.readiness.text()) == ("1 of 3", "One.", "ready")
    # What students do at a step is theirs to undo, and ends with it.
    session.set_seed(77)
    assert session.undo_text == "seed 77"
    explorer.carrier.carry_out(GoToStep(2))
    assert session.undo_text is None
    assert ids(explorer) == []
    explorer.carrier.carry_out(LeaveLesson())
    wait_idle(qtbot, explorer)
    assert session.state is before
    assert session.undo_text == undo
    assert not bar.isVisible()
    assert np.array_equal(result_image(explorer, ids(explorer)[0]), mine)
    session.undo()
    assert session.state.seed == 5


def test_what_is_saved_during_a_lesson_is_the_users_session(qtbot: Any, explorer: Explorer, small: str) -> None:
    saved = explorer.autosave.to_json()
    give(qtbot, explorer, small)
    wait_ready(qtbot, explorer)
    assert explorer.autosave.to_json() == saved
    explorer.window.close()
    assert json.loads(explorer.own.path.read_text()) == saved


def test_a_ready_step_shows_what_was_kept_without_running_anything(
    qtbot: Any, explorer: Explorer, small: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    give(qtbot, explorer, small)
    wait_ready(qtbot, explorer)
    # The numbers under the pictures come last.
    qtbot.waitUntil(lambda: not explorer.teacher.runner.busy)
    started: list[str] = []

    def noted(what: str, usual: Any) -> Any:
        return lambda *args, **more: (started.append(what), usual(*args, **more))[1]

    monkeypatch.setattr("texlab.runs.column_run.run", noted("a method", column_run.run))
    monkeypatch.setattr(MeasureRun, "__call__", noted("measures", MeasureRun.__call__))
    for place in (1, 0, 1):
        explorer.carrier.carry_out(GoToStep(place))
        wait_idle(qtbot, explorer)
        columns = explorer.controller.scene().columns
        assert [each.status for each in columns] == ["finished"] * len(ids(explorer))
        assert all(each.measures and each.findings is not None for each in columns)
    assert started == []
    explorer.carrier.carry_out(GoToStep(0))
    wait_idle(qtbot, explorer)
    # The slider too: its values were made ahead.
    dock = explorer.hosts["lessons"].dock
    explorer.window.raise_dock("lessons")
    wait_idle(qtbot, explorer)
    qtbot.keyClick(dock.words.slider, Qt.Key.Key_Right)
    wait_idle(qtbot, explorer)
    assert explorer.session.state.columns[0].params.to_json()["iterations"] == 2
    assert explorer.controller.scene().columns[0].status == "finished"
    assert started == []


def test_a_step_with_the_same_methods_keeps_every_widget(
    qtbot: Any, explorer: Explorer, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = config_dir() / "lessons"
    folder.mkdir(parents=True)
    methods = ["pixels", "tiling"]
    steps = [
        {
            "sentence": f"Step {seed}.",
            "exemplar": f"gallery:stochastic-{name}",
            "size": {"width": 32, "height": 32},
            "seed": seed,
            "columns": [{"method": each} for each in methods],
            "chosen": 1,
            "tab": {"name": "histograms"},
        }
        for seed, name in enumerate(("lava", "sea", "lava"), 1)
    ]
    (folder / "stays.json").write_text(json.dumps({**SMALL, "steps": steps}))
    give(qtbot, explorer, "stays")
    wait_ready(qtbot, explorer)
    widgets = set(explorer.window.findChildren(QWidget))
    made: list[type] = []
    for place in (1, 2, 1, 0):
        explorer.carrier.carry_out(GoToStep(place))
        wait_idle(qtbot, explorer)
        assert explorer.session.state.seed == place + 1
        made += [type(each) for each in set(explorer.window.findChildren(QWidget)) - widgets]
    assert made == []


def small_pictures(lesson: Lesson) -> Lesson:
    """The lesson with all that it says and sets, on 32 pixels a side."""
    crop, size = Crop(0, 0, 32, 32), (32, 32)

    def reduced(step: LessonStep) -> LessonStep:
        taken = None if step.exemplar is None else dataclasses.replace(step.exemplar, crop=crop)
        columns = tuple(
            dataclasses.replace(
                each,
                size=None if each.size is None else tuple(16 for _ in each.size),
                inputs={name: dataclasses.replace(other, crop=crop) for name, other in each.inputs.items()},
            )
            for each in step.columns
        )
        return dataclasses.replace(step, exemplar=taken, columns=columns, size=size, marks=())

    return dataclasses.replace(lesson, steps=tuple(map(reduced, lesson.steps)))


def press(qtbot: Any, window: Any, key: Qt.Key, modifier: Any = Qt.KeyboardModifier.NoModifier) -> None:
    """Press a key where the keyboard is."""
    qtbot.keyClick(window.focusWidget() or window, key, modifier)


@pytest.mark.slow
def test_from_the_first_start_the_bundled_lesson_is_given_with_keys_alone(
    qtbot: Any, qapp: Any, open_new: Callable[..., Explorer], monkeypatch: pytest.MonkeyPatch
) -> None:
    usual = teacher.read
    monkeypatch.setattr(teacher, "read", lambda *args: small_pictures(usual(*args)))
    # Nothing is kept from before, and nobody waits for the four methods of the first sight.
    explorer = open_new(None, None, (1280, 800))
    window, session = explorer.window, explorer.session
    mine = session.state
    press(qtbot, window, Qt.Key.Key_L, Qt.KeyboardModifier.ControlModifier)
    dock = explorer.hosts["lessons"].dock
    qtbot.waitUntil(lambda: dock.list.topLevelItemCount() > 0 and window.focusWidget() is dock.list)
    wanted = item_of(dock, "heeger-bergen")
    while dock.list.currentItem() is not wanted:
        press(qtbot, window, Qt.Key.Key_Down)
    press(qtbot, window, Qt.Key.Key_Return)
    steps = bundled()["heeger-bergen"].steps
    qtbot.waitUntil(lambda: explorer.teacher.scene.lesson is not None)
    for place, step in enumerate(steps):
        wait_idle(qtbot, explorer)
        assert window.lesson_bar.count.text() == f"{place + 1} of {len(steps)}"
        assert window.lesson_bar.sentence.text() == step.sentence
        columns = explorer.controller.scene().columns
        assert [each.method for each in columns] == [each.method for each in step.columns]
        assert all(each.result is not None and each.result.job.seed == step.seed for each in columns)
        assert step.tab is not None
        assert window.front_dock() == step.tab.name
        press(qtbot, window, Qt.Key.Key_PageDown)
    # The last step stays; back again with Page Up.
    assert explorer.teacher.scene.place == len(steps) - 1
    press(qtbot, window, Qt.Key.Key_PageUp)
    assert explorer.teacher.scene.place == len(steps) - 2
    press(qtbot, window, Qt.Key.Key_L, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    assert explorer.teacher.scene.lesson is None
    assert session.state is mine


def test_one_click_gives_a_lesson(qtbot: Any, explorer: Explorer, small: str) -> None:
    explorer.window.raise_dock("lessons")
    dock = explorer.hosts["lessons"].dock
    qtbot.waitUntil(lambda: dock.list.topLevelItemCount() > 0)
    item = item_of(dock, small)
    dock.list.scrollToItem(item)
    where = dock.list.visualItemRect(item)
    qtbot.mouseClick(
        dock.list.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(where.left() + 5, where.center().y())
    )
    qtbot.waitUntil(lambda: explorer.teacher.scene.name == small)
    wait_idle(qtbot, explorer)


def test_page_down_means_nothing_without_a_lesson(qtbot: Any, explorer: Explorer) -> None:
    assert not explorer.window.actions_by_name["lesson-next"].isEnabled()
    before = explorer.session.state
    qtbot.keyClick(explorer.window, Qt.Key.Key_PageDown)
    assert explorer.session.state is before


def test_a_lesson_that_cannot_be_read_leaves_the_session_alone(qtbot: Any, explorer: Explorer) -> None:
    before = explorer.session.state
    with qtbot.waitSignal(explorer.controller.problem) as told:
        explorer.carrier.carry_out(OpenLesson("custard"))
    assert "There is no lesson called" in told.args[0]
    assert explorer.session.state is before


def test_what_the_window_shows_becomes_a_lesson_of_ones_own(qtbot: Any, explorer: Explorer) -> None:
    window, session = explorer.window, explorer.session
    window.raise_dock("histograms")
    wait_idle(qtbot, explorer)
    wanted, image = session.state, result_image(explorer, ids(explorer)[0])
    explorer.carrier.carry_out(NewLesson("My lesson"))
    qtbot.waitUntil(lambda: explorer.teacher.scene.name == "my-lesson")
    wait_ready(qtbot, explorer)
    assert explorer.teacher.scene.own
    assert window.front_dock() == "histograms"
    shown = session.state
    assert (shown.seed, shown.size) == (wanted.seed, wanted.size)
    assert [each.params for each in shown.columns] == [each.params for each in wanted.columns]
    assert np.array_equal(result_image(explorer, ids(explorer)[0]), image)
    session.set_seed(12)
    wait_idle(qtbot, explorer)
    # From the tab with the button, what was looked at before it is kept.
    window.raise_dock("lessons")
    wait_idle(qtbot, explorer)
    qtbot.mouseClick(explorer.hosts["lessons"].dock.save_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: explorer.teacher.scene.lesson is not None and explorer.teacher.scene.place == 1)
    wait_ready(qtbot, explorer)
    lesson = read_lesson(config_dir() / "lessons" / "my-lesson.json")
    assert [each.seed for each in lesson.steps] == [5, 12]
    assert [each.tab.name for each in lesson.steps] == ["histograms"] * 2
    explorer.carrier.carry_out(LeaveLesson())
    wait_idle(qtbot, explorer)
    assert session.state is wanted


def test_every_tab_and_setting_of_the_bundled_lessons_is_one_of_the_window(qtbot: Any) -> None:
    docks = {each.name: each() for each in dock_classes()}
    for dock in docks.values():
        qtbot.addWidget(dock)
    for name, lesson in bundled().items():
        for step in lesson.steps:
            if step.tab is not None:
                assert step.tab.name in docks, f"{name}: {step.sentence}"
                assert docks[step.tab.name].take_settings(step.tab.settings) == (), f"{name}: {step.sentence}"
                # All of them, so that nothing of the step before is left over.
                assert docks[step.tab.name].settings().items() <= step.tab.settings.items(), step.sentence


def test_without_a_lesson_the_dock_says_what_to_do_and_offers_nothing_of_a_step(qtbot: Any) -> None:
    dock = LessonsDock()
    qtbot.addWidget(dock)
    dock.show()
    feed(dock, scene_of())
    assert dock.words.note.isVisible()
    assert dock.words.note.text() == "Click a lesson to give it, or choose it and press Enter."
    for each in (
        dock.words.slider,
        dock.words.reveal,
        dock.pane,
        dock.words.question,
        dock.words.answer,
        dock.words.try_this,
    ):
        assert not each.isVisible()


def test_the_dock_says_what_belongs_to_a_step_and_hides_the_answer(qtbot: Any, small: str) -> None:
    dock = LessonsDock()
    qtbot.addWidget(dock)
    dock.resize(900, 300)
    dock.show()
    lesson = read_lesson(config_dir() / "lessons" / f"{small}.json")
    sent: list[Any] = []
    dock.intention.connect(sent.append)
    folder = config_dir() / "lessons"
    (folder / "bad.json").write_text("[]")
    given = LessonScene(folder, 0, small, lesson, True, 0, (True, False, False))
    scene = scene_of()
    object.__setattr__(scene, "lesson", given)
    feed(dock, scene)
    assert dock.words.note.text() == "The first."
    assert not dock.words.answer.isVisible()
    dock.words.reveal.click()
    assert dock.words.answer.isVisible()
    assert dock.words.answer.text() == "So."
    assert dock.jump.count() == 3
    assert dock.list.findItems("bad.json", Qt.MatchFlag.MatchContains)
    dock.jump.activated.emit(2)
    dock.leave_button.click()
    dock.save_button.click()
    dock.new_button.click()
    assert [type(each) for each in sent] == [GoToStep, LeaveLesson, SaveStep, NewLesson]
    headings = [dock.list.topLevelItem(place).text(0) for place in range(dock.list.topLevelItemCount())]
    assert headings[0].startswith("Chapter 11.1")
    assert headings[-3:-1] == ["Beside the chapter", "Your own"]
    # A foreign name is text, whatever it looks like.
    assert item_of(dock, small).text(0) == "Small (3)"


def test_ready_steps_find_every_tab_made(qtbot: Any, explorer: Explorer) -> None:
    steps = [
        {"sentence": "Laboratory.", "tab": {"name": "lab", "settings": {"experiments": page}}}
        for page in ("lab-plane", "lab-keys")
    ]
    (config_dir() / "lessons").mkdir(parents=True)
    tabs = [{"sentence": f"{name}.", "tab": {"name": name}} for name in ("spectrum", "pyramid", "maps")]
    data = {**SMALL, "steps": [{"sentence": "Words alone."}, *tabs, *steps]}
    (config_dir() / "lessons" / "tabs.json").write_text(json.dumps(data))
    hosts = explorer.hosts
    wanted = {"lessons", "lab", "spectrum", "pyramid", "maps"}
    assert any(not hosts[name].is_made for name in wanted)
    made: list[str] = []
    for name, host in hosts.items():
        host.made.connect(lambda _, name=name: made.append(name))
    give(qtbot, explorer, "tabs")
    assert not all(explorer.teacher.scene.ready)
    wait_ready(qtbot, explorer)
    assert all(hosts[name].is_made for name in wanted)
    # Nobody makes more than the lesson shows.
    assert set(made) <= wanted
    lab = hosts["lab"].dock
    pages, count = set(lab._pages), len(made)
    assert {"lab-plane", "lab-keys"} <= pages
    for place, step in enumerate(data["steps"]):
        explorer.carrier.carry_out(GoToStep(place))
        wait_idle(qtbot, explorer)
        assert step.get("tab", {"name": "lessons"})["name"] == explorer.window.front_dock()
    assert len(made) == count
    assert set(lab._pages) == pages


def test_a_lesson_that_is_left_makes_no_more_tabs(qtbot: Any, explorer: Explorer, small: str) -> None:
    give(qtbot, explorer, small)
    explorer.carrier.carry_out(LeaveLesson())
    before = [name for name, host in explorer.hosts.items() if host.is_made]
    qtbot.wait(5 * PAUSE_MS)
    assert [name for name, host in explorer.hosts.items() if host.is_made] == before


def test_columns_of_a_step_are_called_and_seeded_as_it_says(qtbot: Any, explorer: Explorer) -> None:
    folder = config_dir() / "lessons"
    folder.mkdir(parents=True)
    columns = [{"method": "pixels", "title": "at random"}, {"method": "tiling"}, {"method": "pixels", "seed": 9}]
    step = {**SMALL["steps"][1], "columns": columns}
    (folder / "names.json").write_text(json.dumps({**SMALL, "steps": [step]}))
    give(qtbot, explorer, "names", own=True)
    wait_ready(qtbot, explorer)
    views = [explorer.workspace.columns[each] for each in ids(explorer)]
    assert [view.method_box.label for view in views][:2] == ["at random", "Tiling"]
    assert [each.result.job.seed for each in explorer.controller.scene().columns] == [1, 1, 9]
    # And what is kept of it says the same.
    explorer.carrier.carry_out(SaveStep("Again."))
    qtbot.waitUntil(lambda: len(explorer.teacher.scene.lesson.steps) == 2)
    wait_ready(qtbot, explorer)
    kept = explorer.teacher.scene.lesson.steps[1].columns
    assert [(each.title, each.seed) for each in kept] == [("at random", None), ("", None), ("", 9)]
