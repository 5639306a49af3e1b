"""Several windows on one home: each has its own session, and none takes away what another one needs."""

from __future__ import annotations

import dataclasses
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PySide6.QtCore import QProcess

from tests.gui.conftest import ids, result_image, wait_idle
from tests.gui.test_storage import state
from texlab.state.chosen import Column, Sample, State
from texlab.state.session import Session
from texlab.storage import sessions
from texlab.storage.autosave import Autosave
from texlab.storage.kept_exemplar import Kept, load
from texlab.storage.paths import config_dir
from texlab.storage.projects import write_for_window
from texlab.storage.reading import last_exemplar
from texlab.storage.settings import Settings, columns_from_json, session_to_json
from texlab_core.documents.preset_store import PresetStore
from texlab_core.documents.presets import Preset
from texlab_core.engine.registry import methods
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer
    from texlab.presets.manager import PresetManager

OTHER = """
import sys
from texlab.storage import sessions
own = sessions.claim()
assert own.write({"seed": 77, "columns": []})
print(own.path.stem, flush=True)
sys.stdin.read()
"""


def write(own: sessions.OwnSession, kept: Any) -> None:
    autosave = Autosave(Session(), Settings(), own)
    try:
        values = dict(autosave._settings.values)
        autosave._write(values, session_to_json(kept, 1), kept.sample, kept)
    finally:
        autosave._own = None
        autosave.close()


def whole(own_file: Path, seed: int) -> bool:
    """Return whether exemplar and mask of a session are there, with their pixels."""
    saved = json.loads(own_file.read_text())
    (choice,) = last_exemplar(saved)
    assert isinstance(choice.source, Kept)
    wanted = state(seed)
    assert wanted.sample is not None
    mask = dict(columns_from_json(saved)[0][2])["mask"]
    same = np.array_equal(load(choice.source).pixels, wanted.sample.source.pixels)
    return same and mask.sha256 == dict(wanted.columns[0].inputs)["mask"].sha256


# Windows.


@pytest.mark.slow
def test_two_windows_have_two_sessions_and_both_come_back(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path
) -> None:
    pixels = ("pixels", methods()["pixels"].params())
    first = open_window(str(texture), [pixels, pixels])
    second = open_window("gallery:oriented-zebra", [pixels])
    first.session.set_seed(11)
    second.session.set_seed(22)
    for each in (first, second):
        wait_idle(qtbot, each)
    pictures = {each.session.state.seed: result_image(each, ids(each)[0]) for each in (first, second)}
    # The last to close is not the last to be changed.
    second.window.close()
    first.window.close()

    again = open_window(None)
    assert again.session.state.seed == 11
    assert again.session.state.sample.path == str(texture)
    assert len(ids(again)) == 2
    assert again.window.message_bar.label.text() == (
        "The session of another window is kept as well (gallery:oriented-zebra, 1 column): "
        "File, Another window brings it back."
    )
    other = open_window(None)
    assert other.session.state.seed == 22
    assert other.session.state.sample.source.name == "gallery:oriented-zebra"
    for each in (again, other):
        assert np.array_equal(result_image(each, ids(each)[0]), pictures[each.session.state.seed])
    other.window.close()
    again.window.close()


def kept_and_cell() -> tuple[sessions.OwnSession, State]:
    """Keep a session with a note, for the next window; return it, and a cell for another one."""
    kept = sessions.claim()
    write(kept, dataclasses.replace(state(1), notes="Mine."))
    kept.release()
    image = as_exemplar(np.zeros((16, 16, 3), np.float32), name="cell")
    return kept, State(Sample(image), (Column(1, "pixels", methods()["pixels"].params()),), 3, (16, 16), 2)


@pytest.mark.parametrize("kind", ["handed on", "project", "image"])
def test_a_project_takes_no_session_away_that_is_kept(
    qtbot: Any,
    open_window: Callable[..., Explorer],
    texlab_home: Path,
    texture: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    kind: str,
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    kept, cell = kept_and_cell()
    before = kept.path.read_bytes()
    source = str(texture) if kind == "image" else write_for_window(cell)
    if kind == "project":
        source = str(shutil.copy(source, tmp_path / "cell.texlab"))
    opened = open_window(source, wait=False)
    qtbot.waitUntil(lambda: opened.session.state.sample is not None)
    # An image goes into the last session; a project is one of its own.
    anew = kind != "image"
    assert (opened.session.state.notes == "") == anew
    assert (opened.own is not None and opened.own.path != kept.path) == anew
    opened.window.close()
    assert (kept.path.read_bytes() == before) == anew
    if anew:
        assert opened.own is not None
        assert json.loads(opened.own.path.read_text())["seed"] == 3
        # The next start says what waits.
        again = sessions.claim()
        assert again.path == opened.own.path
        assert [each.number for each in again.others] == [int(kept.path.stem)]
        assert "is kept as well" in sessions.told_of_others(again.others, Settings().values)
        again.release()


@pytest.mark.parametrize("cut", [0.0, 0.5])
def test_a_damaged_project_loses_nothing(
    qtbot: Any, open_window: Callable[..., Explorer], texlab_home: Path, tmp_path: Path, cut: float
) -> None:
    kept, cell = kept_and_cell()
    before = kept.path.read_bytes()
    project = tmp_path / "work.texlab"
    shutil.move(write_for_window(cell), project)
    whole = project.read_bytes()
    project.write_bytes(whole[: int(cut * len(whole))])
    damaged = project.read_bytes()
    opened = open_window(str(project), [("pixels", methods()["pixels"].params())], wait=False)
    qtbot.waitUntil(lambda: opened.session.state.sample is not None)
    # It says which file, and shows something; neither the file nor what was kept is touched.
    assert "work.texlab" in opened.window.message_bar.label.text()
    assert opened.session.state.sample.source.name.startswith("gallery:")
    opened.window.close()
    assert project.read_bytes() == damaged
    assert kept.path.read_bytes() == before
    again = sessions.claim()
    assert [each.number for each in again.others] == [int(kept.path.stem)]
    again.release()


def test_another_window_is_another_process_of_the_same_program(
    explorer: Explorer, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[tuple[str, list[str]]] = []
    monkeypatch.setattr(QProcess, "startDetached", lambda *given: (started.append(given), (True, 1))[1])
    explorer.window.actions_by_name["another-window"].trigger()
    explorer.handlers.open_another_window("cell.texlab")
    ours = ["-m", "texlab", "gui"]
    assert started == [(sys.executable, ours), (sys.executable, [*ours, "cell.texlab"])]
    monkeypatch.setattr(sys, "frozen", True, raising=False)
    monkeypatch.setattr(QProcess, "startDetached", lambda *given: (started.append(given), (False, 0))[1])
    explorer.window.actions_by_name["another-window"].trigger()
    assert started[2] == (sys.executable, ["gui"])
    assert "could not be started" in explorer.window.message_bar.label.text()


def test_a_window_that_keeps_nothing_changes_nothing(qtbot: Any, texlab_home: Path, tmp_path: Path) -> None:
    from texlab.app.screenshot import screenshot

    (texlab_home / "config").mkdir(parents=True)
    (texlab_home / "config" / "settings.json").write_text('{"theme": "dark"}')
    before = sorted(texlab_home.rglob("*"))
    screenshot(tmp_path / "window.png", size=(900, 600), columns=["pixels"])
    assert [path for path in sorted(texlab_home.rglob("*")) if "log" not in path.parts] == before
    assert (texlab_home / "config" / "settings.json").read_text() == '{"theme": "dark"}'


# Locks.


def test_another_process_has_its_own_and_a_killed_one_leaves_it(texlab_home: Path) -> None:
    with subprocess.Popen(
        [sys.executable, "-c", OTHER],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout is not None
        theirs = process.stdout.readline().strip()
        own = sessions.claim()
        assert {theirs, own.path.stem} == {"1", "2"}
        assert own.saved is None
        assert own.others == ()
        own.release()
        process.send_signal(signal.SIGKILL)
    # Its lock is still there.
    assert (sessions.folder() / f"{theirs}.lock").exists()
    inherited = sessions.claim()
    assert inherited.path.stem == theirs
    assert inherited.saved["seed"] == 77
    inherited.release()


def test_the_newest_free_session_comes_first_and_the_others_are_told_once(texlab_home: Path) -> None:
    owned = [sessions.claim() for _ in range(3)]
    assert [each.path.stem for each in owned] == ["1", "2", "3"]
    for place, each in enumerate(owned):
        assert each.write({"seed": place, "sample": {"name": f"{place}.png"}, "columns": [{}] * (place + 1)})
        os.utime(each.path, ns=(10**18, 10**18 + [2, 3, 1][place]))
    owned[0].release()
    owned[1].release()
    own = sessions.claim()
    assert own.saved["seed"] == 1
    assert [(each.number, each.words) for each in own.others] == [(1, "0.png, 1 column")]
    values: dict[str, Any] = {}
    assert "(0.png, 1 column)" in sessions.told_of_others(own.others, values)
    assert sessions.told_of_others(own.others, json.loads(json.dumps(values))) == ""
    for each in (own, owned[2]):
        each.release()


def test_a_new_session_leaves_those_that_are_kept(texlab_home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    old = {"seed": 9, "columns": []}
    first = sessions.claim(old, fresh=True)
    # That of one for all windows still waits to be the first.
    assert (first.path.stem, first.saved) == ("2", None)
    own = sessions.claim(fresh=True)
    for place, each in enumerate((first, own)):
        assert each.write({"seed": place, "columns": []})
        os.utime(each.path, ns=(10**18, 10**18 + place))
        each.release()
    third = sessions.claim(fresh=True)
    assert third.path not in (first.path, own.path)
    assert [each.number for each in third.others] == [int(own.path.stem), 2]
    third.release()
    # They do not grow for ever: what is not looked at would be lost.
    monkeypatch.setattr(sessions, "MOST", 2)
    last = sessions.claim(fresh=True)
    assert (last.path, last.saved) == (first.path, None)
    assert [each.number for each in last.others] == [int(own.path.stem)]
    assert last.write({"seed": 5, "columns": []})
    # It has no other place while all are in use.
    held = sessions.claim()
    assert held.path == own.path
    assert sessions.claim(fresh=True).path not in (first.path, own.path)
    for each in (last, held):
        each.release()


@pytest.mark.parametrize("content", [b"", b"[1]", b"{", b"\xff", b'{"a": ' * 100])
def test_a_damaged_session_is_put_aside_and_said(texlab_home: Path, content: bytes) -> None:
    sessions.folder().mkdir(parents=True)
    path = sessions.folder() / "4.json"
    path.write_bytes(content)
    assert sessions.references() is None
    own = sessions.claim()
    assert own.saved is None
    assert own.problem == (
        f"A session is damaged and was left out. The file was kept as {sessions.folder() / '4.broken.json'}."
    )
    assert (sessions.folder() / "4.broken.json").read_bytes() == content
    assert sessions.references() == sessions.References()
    own.release()


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes here")
def test_pipes_in_the_place_of_sessions_and_locks_stop_nobody(texlab_home: Path) -> None:
    sessions.folder().mkdir(parents=True)
    for name in ("1.json", "2.lock", "writing.lock"):
        os.mkfifo(sessions.folder() / name)
    own = sessions.claim()
    assert own.path.stem in ("1", "3")
    with sessions.writing() as alone:
        assert not alone
    own.release()


def test_the_session_of_one_for_all_windows_becomes_that_of_the_first(texlab_home: Path) -> None:
    old = {"seed": 9, "columns": []}
    config_dir().mkdir(parents=True)
    (config_dir() / "settings.json").write_text(json.dumps({"session": old, "theme": "dark"}))
    first, second = sessions.claim(old), sessions.claim(old)
    assert (first.saved, second.saved) == (old, None)
    write(second, state(2))
    assert json.loads((config_dir() / "settings.json").read_text())["session"] == old
    write(first, state(1))
    assert json.loads((config_dir() / "settings.json").read_text()) == {"theme": "dark"}
    for each in (first, second):
        each.release()


# What all windows share.


def test_what_another_window_needs_is_not_removed(texlab_home: Path) -> None:
    first, second = sessions.claim(), sessions.claim()
    write(first, state(1))
    write(second, state(2))
    assert whole(first.path, 1)
    assert whole(second.path, 2)
    # Also of one that is closed; what nobody needs any more goes.
    first.release()
    write(second, state(3))
    assert whole(first.path, 1)
    assert whole(second.path, 3)
    assert len(list(config_dir().glob("exemplar-*.npz"))) == 2
    assert len(list((config_dir() / "inputs").iterdir())) == 2
    # What is damaged may need anything.
    first.path.write_bytes(b"{")
    write(second, state(4))
    assert len(list(config_dir().glob("exemplar-*.npz"))) == 3
    second.release()


def test_nothing_is_removed_while_another_window_writes(
    texlab_home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own = sessions.claim()
    write(own, state(1))
    monkeypatch.setattr(sessions, "WAIT_MS", 0)
    with sessions.writing() as alone:
        assert alone
        write(own, state(2))
    assert len(list(config_dir().glob("exemplar-*.npz"))) == 2
    assert whole(own.path, 2)
    own.release()


def test_settings_of_two_windows_are_merged(texlab_home: Path) -> None:
    first, second = Settings(), Settings()
    first.values["theme"] = "dark"
    first.add_recent("/a.png")
    first.save()
    second.values["layout"] = "tune"
    second.add_recent("/b.png")
    second.save()
    assert Settings().values == {"theme": "dark", "layout": "tune", "recent": ["/b.png", "/a.png"]}
    del first.values["theme"]
    first.save()
    assert Settings().values == {"layout": "tune", "recent": ["/b.png", "/a.png"]}


def test_a_preset_that_another_window_has_made_is_not_overwritten(
    qtbot: Any, explorer: Explorer, texlab_home: Path
) -> None:
    manager: PresetManager = explorer.presets
    params = methods()["heeger-bergen"].params
    theirs = Preset.of("coarse", "heeger-bergen", params(iterations=3))
    PresetStore(config_dir() / "presets").save(theirs)
    dialogs: list[Any] = []
    manager._ask = lambda dialog, done: dialogs.append((dialog, done))  # type: ignore[method-assign]
    for _ in range(2):
        manager._save()
        dialog, done = dialogs.pop()
        done("coarse", "", False)
        dialog.deleteLater()
        qtbot.waitUntil(lambda: explorer.idle)
        if not (text := explorer.window.message_bar.label.text()).startswith("Saved"):
            assert text == "There is a preset of heeger-bergen called coarse already."
            assert PresetStore(config_dir() / "presets").load("coarse") == theirs
    # Now it is seen, and whoever replaces it knows.
    assert PresetStore(config_dir() / "presets").load("coarse") != theirs
