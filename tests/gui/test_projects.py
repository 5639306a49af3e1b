"""Project files in the window: saved, opened, a copy for a student; the session comes back."""

from __future__ import annotations

import dataclasses
import json
import tempfile
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PySide6.QtCore import QProcess
from PySide6.QtWidgets import QFileDialog

from tests.gui.conftest import hb, ids, result_image, wait_idle
from texlab.columns.status import figures, numbers_of, shows_numbers
from texlab.state.changes import sample_of
from texlab.state.chosen import Column, Sample, State
from texlab.state.scene import Past
from texlab.state.session import Session
from texlab.storage import projects
from texlab.storage.paths import config_dir
from texlab.storage.projects import is_handed_on, open_project, project_of, write_for_window
from texlab_core.documents.preset_store import PresetStore
from texlab_core.documents.presets import Preset
from texlab_core.documents.project import save_project
from texlab_core.documents.project_reading import read_project
from texlab_core.engine.inputs import Crop
from texlab_core.engine.registry import find_method
from texlab_core.errors import InputError
from texlab_core.files.archive import pack_archive
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.app.explorer import Explorer


def saved(qtbot: Any, explorer: Explorer, path: Path) -> Path:
    explorer.handlers.projects.save_to(str(path))
    qtbot.waitUntil(lambda: explorer.idle and path.exists())
    return path


def test_a_session_is_saved_and_opened_again(
    qtbot: Any, explorer: Explorer, open_window: Callable[..., Explorer], tmp_path: Path
) -> None:
    explorer.session.select(ids(explorer)[1])
    explorer.session.set_column_seed(ids(explorer)[0], 41)
    explorer.session.rename_column(ids(explorer)[0], "Mine")
    explorer.controller.editing.crop(Crop(2, 4, 30, 32), True)
    wait_idle(qtbot, explorer)
    images = [result_image(explorer, each) for each in ids(explorer)]
    path = saved(qtbot, explorer, tmp_path / "a.texlab")
    # Without the picture that it was made from.
    (tmp_path / "waves.png").unlink()
    other = open_window("gallery:stochastic-grass", [hb(iterations=3)])
    before = ids(other)
    other.opener.open(str(path))
    qtbot.waitUntil(lambda: len(other.session.state.columns) == 2)
    wait_idle(qtbot, other)
    assert not set(ids(other)) & set(before)
    assert other.session.selected_id == ids(other)[1]
    assert other.session.state.sample.crop == Crop(2, 4, 30, 32)
    assert [(each.name, each.seed) for each in other.session.state.columns] == [("Mine", 41), ("", None)]
    for image, column_id in zip(images, ids(other), strict=True):
        np.testing.assert_array_equal(result_image(other, column_id), image)
    other.session.undo()
    assert ids(other) == before
    assert str(path) in other.settings.recent


def test_a_window_starts_with_a_project_or_says_why_not(
    qtbot: Any, explorer: Explorer, open_window: Callable[..., Explorer], tmp_path: Path
) -> None:
    path = saved(qtbot, explorer, tmp_path / "a.texlab")
    started = open_window(str(path), [hb()])
    assert len(started.session.state.columns) == 2
    path.write_bytes(b"PK")
    broken = open_window(str(path), [hb()])
    assert broken.session.state.sample is not None
    assert "a.texlab" in broken.window.message_bar.label.text()


def test_the_pictures_of_a_project_are_there_before_its_columns_run(
    qtbot: Any, explorer: Explorer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = saved(qtbot, explorer, tmp_path / "a.texlab")
    opened = open_project(str(path))
    assert set(opened.pictures) == {1, 2}
    for number, column_id in enumerate(ids(explorer), 1):
        wanted = np.rint(result_image(explorer, column_id).astype(np.float64) * 255)
        np.testing.assert_array_equal(opened.pictures[number], wanted)
    seen: list[Any] = []
    show = explorer.controller.show_stored
    known = [explorer.controller.column_scene(each).measures for each in ids(explorer)]

    def spy(column_id: int, picture: Any, measures: Any) -> None:
        show(column_id, picture, measures)
        seen.append(explorer.controller.column_scene(column_id))

    monkeypatch.setattr(explorer.controller, "show_stored", spy)
    explorer.opener.open(str(path))
    qtbot.waitUntil(lambda: bool(seen))
    for number, scene in enumerate(seen, 1):
        assert scene.status != "finished"
        # The numbers come with them, and nothing was measured for that.
        assert scene.measures == known[number - 1]
        assert len(figures(numbers_of(scene))) == 3
        assert shows_numbers(dataclasses.replace(scene, status="waiting"))
        np.testing.assert_array_equal(scene.picture, opened.pictures[number])
    wait_idle(qtbot, explorer)


def test_the_menus_ask_for_a_name(
    qtbot: Any, explorer: Explorer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    answers = [
        (str(tmp_path / "one"), ""),
        (str(tmp_path / "two.texlab"), ""),
        ("", ""),
        (str(tmp_path / "one"), ""),
    ]
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: answers.pop(0))
    for action, name in (("save-project", "one.texlab"), ("student-copy", "two.texlab")):
        explorer.window.actions_by_name[action].trigger()
        qtbot.waitUntil((tmp_path / name).exists)
    qtbot.waitUntil(lambda: explorer.idle)
    explorer.window.actions_by_name["save-project"].trigger()
    explorer.window.actions_by_name["save-project"].trigger()
    assert "one.texlab is already there" in explorer.window.message_bar.label.text()
    assert answers == []


def test_earlier_results_and_notes_come_back(
    qtbot: Any, explorer: Explorer, open_window: Callable[..., Explorer], tmp_path: Path
) -> None:
    first, _ = ids(explorer)
    column = explorer.session.state.column(first)
    explorer.controller.editing.params(first, column.params.replace(iterations=1), "iterations", final=True)
    wait_idle(qtbot, explorer)
    notes = explorer.hosts["notes"].dock
    explorer.window.raise_dock("notes")
    qtbot.keyClicks(notes.field, "Too soft at 1 iteration.")
    # Saving takes what is being typed.
    explorer.window.actions_by_name["run-all"].trigger()
    history = explorer.controller.column_scene(first).history
    assert len(history) == 2
    path = saved(qtbot, explorer, tmp_path / "a.texlab")
    other = open_window("gallery:stochastic-grass", [hb(iterations=3)])
    other.opener.open(str(path))
    qtbot.waitUntil(lambda: len(other.session.state.columns) == 2)
    wait_idle(qtbot, other)
    assert other.session.state.notes == "Too soft at 1 iteration."
    found = other.controller.column_scene(ids(other)[0]).history
    # What runs again is the same job: it is there once.
    assert [each.key for each in found] == [each.key for each in history]
    for one, again in zip(history, found, strict=True):
        np.testing.assert_array_equal(one.thumbnail, again.thumbnail)
        assert again.exemplar == other.controller.exemplar.sha256
    other.session.take_past(ids(other)[0], found[0])
    assert other.session.state.column(ids(other)[0]).params == column.params
    wait_idle(qtbot, other)
    other.session.undo()
    other.session.undo()
    assert other.session.state.notes == ""
    wait_idle(qtbot, other)


def test_no_history_goes_with_an_exemplar_that_is_still_being_prepared(
    qtbot: Any, explorer: Explorer, tmp_path: Path
) -> None:
    first = ids(explorer)[0]
    assert read_project(saved(qtbot, explorer, tmp_path / "before.texlab")).columns[0].history
    other = as_exemplar(np.random.default_rng(3).random((24, 28, 3)).astype(np.float32), name="other")
    explorer.session.set_sample(sample_of(other, None))
    assert explorer.controller.preparing
    assert explorer.controller.column_scene(first).history
    made = read_project(saved(qtbot, explorer, tmp_path / "during.texlab"))
    assert made.exemplar is not None
    assert made.exemplar.sha256 == other.sha256
    assert [each.history for each in made.columns] == [(), ()]
    wait_idle(qtbot, explorer)


def test_what_is_left_out_of_a_history_is_said(texlab_home: Path, tmp_path: Path) -> None:
    method = find_method("heeger-bergen")
    image = as_exemplar(np.zeros((8, 8, 3), np.float32), name="a")
    past = Past((), "", method.id, method.params(), (), (4, 4), 1, np.zeros((4, 4, 3), np.uint8))
    state = State(Sample(image), (Column(1, method.id, method.params()),))
    path = tmp_path / "a.texlab"
    save_project(path, project_of(state, 1, {}, "", histories={1: [past] * 3}))
    with zipfile.ZipFile(path) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    data = json.loads(files["project.json"])
    for number, words in ((1, "1 earlier result is"), (2, "2 earlier results are")):
        data["columns"][0]["history"][number]["method"] = "none"
        path.write_bytes(pack_archive(files | {"project.json": json.dumps(data).encode()}))
        opened = open_project(str(path))
        assert opened.notes == (
            f"Opened {path}: 1 column (Heeger-Bergen).",
            f"{words} left out, whose methods or parameters are not known here.",
        )
        assert len(opened.histories.get(1, ())) == 3 - number


@pytest.fixture
def handed_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[], str]:
    """Return what leaves a cell for another window; the folder of temporary files is the test's."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "temporary"))
    (tmp_path / "temporary").mkdir()
    image = as_exemplar(np.zeros((8, 8, 3), np.float32), name="wall.png")
    state = State(Sample(image), (Column(1, "tiling", find_method("tiling").params()),))
    return lambda: write_for_window(state)


def test_nothing_stays_of_what_one_window_leaves_for_another(
    texlab_home: Path, handed_on: Callable[[], str], monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = Path(tempfile.gettempdir())
    path = handed_on()
    assert is_handed_on(path)
    assert open_project(path).notes == ("Opened wall: 1 column (Tiling).",)
    assert not list(folder.iterdir())
    path = handed_on()
    Path(path).write_bytes(b"PK")
    # What it was called is said, not where it lay.
    with pytest.raises(InputError, match=r"^wall: is damaged") as caught:
        open_project(path)
    assert str(folder) not in str(caught.value)
    assert not list(folder.iterdir())
    monkeypatch.setattr("texlab_core.documents.project.MAX_INPUT", 10)
    with pytest.raises(InputError):
        handed_on()
    assert not list(folder.iterdir())


def test_a_cell_that_cannot_be_left_for_another_window_is_called_by_its_name(
    handed_on: Callable[[], str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(path: Path, project: object) -> None:
        raise InputError(f"{path}: cannot be written (No space left on device).")

    monkeypatch.setattr(projects, "save_project", full)
    with pytest.raises(InputError, match=r"^wall: cannot be written \(No space left on device\)\.$"):
        handed_on()


def test_nothing_stays_when_the_other_window_does_not_start(
    qtbot: Any, explorer: Explorer, handed_on: Callable[[], str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(QProcess, "startDetached", lambda *_: (False, 0))
    path = handed_on()
    explorer.handlers.open_another_window(path)
    assert "could not be started" in explorer.window.message_bar.label.text()
    qtbot.waitUntil(lambda: explorer.idle)
    assert not Path(path).parent.exists()


def test_a_copy_for_a_student_tells_nothing_of_this_computer(tmp_path: Path) -> None:
    pixels = np.random.default_rng(0).random((16, 16, 3)).astype(np.float32)
    image = as_exemplar(pixels, name="/home/someone/secret/wall.png")
    mask = as_exemplar(pixels[:4, :4, :1], name="C:\\someone\\mask.png", crop=Crop(0, 0, 3, 3))
    params = find_method("efros-leung").params()
    given = (("mask", mask),)
    state = State(Sample(image, path="/home/someone/secret/wall.png"), (Column(1, "efros-leung", params, given),))
    past = Past((), "", "efros-leung", params, given, (4, 4), 1, np.zeros((4, 4, 3), np.uint8))
    path = tmp_path / "a.texlab"
    save_project(path, project_of(state, 0, {}, "", histories={1: [past]}, for_student=True))
    with zipfile.ZipFile(path) as archive:
        text = b"".join(archive.read(name) for name in archive.namelist())
    assert b"someone" not in text
    made = read_project(path)
    assert made.exemplar is not None
    assert made.exemplar.name == "wall.png"
    for inputs in (made.columns[0].inputs, made.columns[0].history[0].inputs):
        assert (inputs["mask"].name, inputs["mask"].sha256) == ("mask.png", mask.sha256)


def test_presets_of_the_methods_come_along(qtbot: Any, explorer: Explorer, tmp_path: Path) -> None:
    store = PresetStore(config_dir() / "presets")
    mine = Preset(name="soft", method="heeger-bergen", parameters={"iterations": 2})
    store.save(mine)
    store.save(Preset(name="other", method="msg"))
    path = saved(qtbot, explorer, tmp_path / "a.texlab")
    assert read_project(path).presets == (mine,)
    store.delete("soft", "heeger-bergen")
    assert "New presets: soft." in open_project(str(path)).notes
    assert mine in store.presets()
    assert len(open_project(str(path)).notes) == 1


def test_a_deep_source_of_a_restored_result_is_kept(tmp_path: Path) -> None:
    deep = np.random.default_rng(1).integers(0, 65536, (20, 24, 3), np.uint16)
    from texlab.state.changes import sample_as_used

    sample = sample_as_used(as_exemplar(deep, name="deep.tif", crop=Crop(1, 1, 16, 16)))
    path = tmp_path / "a.texlab"
    save_project(path, project_of(State(sample, (), 1, (16, 16), 1), 0, {}, "tune"))
    opened = open_project(str(path))
    assert opened.state.sample is not None
    np.testing.assert_array_equal(opened.state.sample.source.pixels, sample.source.pixels)
    assert (opened.state.sample.crop, opened.state.sample.source.depth) == (Crop(1, 1, 16, 16), 16)
    assert opened.layout == "tune"


def test_a_large_picture_comes_after_the_columns(
    qtbot: Any, explorer: Explorer, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("texlab_core.documents.project.LARGE", 1000)
    explorer.controller.editing.crop(Crop(2, 4, 30, 32), True)
    wait_idle(qtbot, explorer)
    session, opener = explorer.session, explorer.opener
    before = ids(explorer)
    used = explorer.controller.exemplar.sha256
    images = [result_image(explorer, each) for each in before]
    path = saved(qtbot, explorer, tmp_path / "a.texlab")
    first: list[Any] = []
    whole = open_project(str(path), first.append)
    assert first[0].state.sample.source.size == (30, 32)
    assert first[0].pictures.keys() == whole.pictures.keys() == {1, 2}
    seen: list[Any] = []
    session.changed.connect(lambda _, state: seen.append(state.sample))
    opener.open(str(path))
    qtbot.waitUntil(lambda: bool(seen) and seen[-1].crop == Crop(2, 4, 30, 32))
    wait_idle(qtbot, explorer)
    # The part, and then the whole; one step of the history, on the very same pixels.
    assert [each.source.size for each in seen] == [(30, 32), (40, 48)]
    assert session.undo_text == "project a.texlab"
    assert explorer.controller.exemplar.sha256 == used
    for image, column_id in zip(images, ids(explorer), strict=True):
        np.testing.assert_array_equal(result_image(explorer, column_id), image)
    session.undo()
    assert ids(explorer) == before
    wait_idle(qtbot, explorer)


def test_a_sample_is_replaced_in_the_whole_history() -> None:
    pixels = np.zeros((8, 8, 1), np.float32)
    one, other = (Sample(as_exemplar(pixels, name=name)) for name in ("one", "other"))
    session = Session()
    session.apply(State(one), "project")
    session.set_seed(3)
    assert session.replace_sample(one, other)
    session.undo()
    assert session.state.sample is other
    cropped = dataclasses.replace(other, crop=Crop(0, 0, 4, 4))
    session.apply(State(cropped), "crop")
    assert not session.replace_sample(other, one)
    assert session.state.sample.crop == cropped.crop
    session.undo()
    assert session.state.sample is one
