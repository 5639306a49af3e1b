"""What is dropped or given at the start: images, codes, presets, and files that are none of them."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QApplication, QMenu

from tests.gui.conftest import hb, ids, result_image, wait_idle
from texlab.runs.exemplar import prepare
from texlab.state.changes import restored
from texlab.state.chosen import Column, State
from texlab.state.intentions import Open
from texlab.state.session import Session
from texlab.storage.reading import open_source
from texlab_core.documents.record import save_result
from texlab_core.engine.job import Job
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.spectral.codefile import load_code_input, write_code

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer


@pytest.fixture
def code_file(tmp_path: Path) -> Path:
    """The code of gray noise."""
    pixels = np.random.default_rng(2).random((64, 64, 1), np.float32)
    model = run(Job(method="msg", inputs={"exemplar": as_exemplar(pixels)}, size=(8, 8))).model
    path = tmp_path / "noise.msg.json"
    write_code(model.code, path, "noise")
    return path


@pytest.fixture
def preset_file(tmp_path: Path) -> Path:
    """A preset for Heeger-Bergen."""
    from texlab_core.documents.preset_store import export_preset
    from texlab_core.documents.presets import Preset

    params = methods()["heeger-bergen"].params.from_json({"scales": 2, "iterations": 7})
    path = tmp_path / "seven.json"
    export_preset(Preset.of("seven rounds", "heeger-bergen", params), path)
    return path


def drop(qtbot: Any, explorer: Explorer, path: Path) -> None:
    """Drop a file on the window and wait until the window has said what it was."""
    explorer.window.message_bar.hide()
    mime = QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(path))])
    place, copy, left = QPoint(200, 200), Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton
    window, plain = explorer.window, Qt.KeyboardModifier.NoModifier
    enter = QDragEnterEvent(place, copy, mime, left, plain)
    QApplication.sendEvent(window, enter)
    assert enter.isAccepted()
    with qtbot.waitSignal(window.dropped):
        QApplication.sendEvent(window, QDropEvent(QPointF(place), copy, mime, left, plain))
    qtbot.waitUntil(explorer.window.message_bar.isVisible)
    wait_idle(qtbot, explorer)


def from_code(path: Path, size: tuple[int, int] = (48, 48), seed: int = 5) -> Any:
    return run(Job(method="msg", inputs={"code": load_code_input(path)}, size=size, seed=seed)).image


def test_a_dropped_code_goes_to_the_first_column_of_msg(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, code_file: Path
) -> None:
    plain = methods()["msg"].params()
    explorer = open_window(str(texture), [hb(), ("msg", plain), ("msg", plain)])
    _, second, third = ids(explorer)
    before = result_image(explorer, third)
    drop(qtbot, explorer, code_file)
    assert explorer.session.selected_id == second
    # The code is gray, the exemplar was not.
    assert np.array_equal(result_image(explorer, second), from_code(code_file))
    assert np.array_equal(result_image(explorer, third), before)
    assert "from a code, not the exemplar" in explorer.workspace.columns[second].line.text()
    assert "noise.msg.json" in explorer.window.message_bar.label.text()
    explorer.session.select(third)
    drop(qtbot, explorer, code_file)
    assert explorer.session.selected_id == third
    explorer.session.undo()
    wait_idle(qtbot, explorer)
    assert np.array_equal(result_image(explorer, third), before)


def test_without_a_column_of_msg_one_is_added(qtbot: Any, explorer: Explorer, code_file: Path) -> None:
    before = ids(explorer)
    drop(qtbot, explorer, code_file)
    assert ids(explorer)[:-1] == before
    assert explorer.session.selected_column.method == "msg"
    assert np.array_equal(result_image(explorer, ids(explorer)[-1]), from_code(code_file))


def test_a_code_given_at_the_start_waits_for_the_exemplar(
    qtbot: Any, open_window: Callable[..., Explorer], code_file: Path
) -> None:
    explorer = open_window(str(code_file), [hb(), ("msg", methods()["msg"].params())])
    wait_idle(qtbot, explorer)
    assert explorer.session.state.sample.source.name == "gallery:structured-pebbles"
    assert np.array_equal(result_image(explorer, ids(explorer)[1]), from_code(code_file))


def test_a_code_comes_back_with_the_session(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, code_file: Path
) -> None:
    first = open_window(str(texture), [("msg", methods()["msg"].params())])
    drop(qtbot, first, code_file)
    first.close()
    assert json.loads(first.own.path.read_text())["columns"][0]["inputs"]["code"]
    again = open_window(None)
    assert np.array_equal(result_image(again, ids(again)[0]), from_code(code_file))


def test_a_dropped_preset_is_imported_and_taken(qtbot: Any, explorer: Explorer, preset_file: Path) -> None:
    second = ids(explorer)[1]
    explorer.session.select(second)
    drop(qtbot, explorer, preset_file)
    assert "seven rounds was imported" in explorer.window.message_bar.label.text()
    assert explorer.session.state.column(second).params.iterations == 7
    wait_idle(qtbot, explorer)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ('{"format": "texlab-msg", "version": 1}', "The code bad.json cannot be used"),
        ('{"format": "texlab-msg", "version": 99}', "newer TexLab"),
        ('{"format": "something"}', "bad.json is neither a code of MSG nor a preset."),
        ("[1, 2]", "bad.json is neither a code of MSG nor a preset."),
        ("{", "bad.json"),
        ('{"format": "texlab-preset"}', "bad.json"),
    ],
)
def test_bad_documents_get_one_sentence_and_change_nothing(
    qtbot: Any, explorer: Explorer, tmp_path: Path, text: str, sentence: str
) -> None:
    path = tmp_path / "bad.json"
    path.write_text(text)
    before = explorer.session.state
    drop(qtbot, explorer, path)
    told = explorer.window.message_bar.label.text()
    assert sentence in told
    assert "Traceback" not in told
    assert explorer.session.state == before


@pytest.mark.parametrize(("shape", "scale"), [((300, 280, 1), 1.0), ((520, 600, 1), 0.5), ((64, 60, 3), 1.0)])
def test_a_restored_result_has_the_exemplar_and_the_size_that_made_it(
    tmp_path: Path, shape: tuple[int, ...], scale: float
) -> None:
    exemplar = as_exemplar(np.random.default_rng(4).random(shape, np.float32), scale=scale)
    job = Job(method="msg", inputs={"exemplar": exemplar}, size=(24, 28))
    save_result(run(job), tmp_path / "made.png")
    # A column that has filled something has a size of its own.
    filled = Column(1, "msg", job.params, (), (40, 50))
    state, column_id = restored(State(columns=(filled,)), open_source(str(tmp_path / "made.png")))
    assert column_id == 1
    assert prepare(state.sample, None).exemplar.sha256 == exemplar.sha256
    assert (state.column(1).size or state.size) == (24, 28)


def test_parameters_of_another_method_are_not_taken() -> None:
    session = Session()
    session.add_column("msg", methods()["msg"].params())
    before = session.state
    session.set_params(1, methods()["heeger-bergen"].params(), "late")
    assert session.state is before


def test_a_dock_can_have_a_texture_opened(qtbot: Any, explorer: Explorer) -> None:
    dock = explorer.hosts["pyramid"].dock
    dock.intention.emit(Open("gallery:oriented-zebra"))
    wait_idle(qtbot, explorer)
    assert explorer.session.state.sample.source.name == "gallery:oriented-zebra"


def test_an_example_of_the_failure_gallery_is_opened_from_the_menu(qtbot: Any, explorer: Explorer) -> None:
    explorer.window.actions_by_name["failures"].trigger()
    menu = explorer.window.findChild(QMenu, "failures-menu")
    assert menu is not None
    qtbot.waitUntil(menu.isVisible)
    groups = [action.menu() for action in menu.actions()]
    assert [group.title() for group in groups][:2] == ["Heeger-Bergen", "De Bonet"]
    chosen = next(each for group in groups for each in group.actions() if each.objectName() == "failure-letters")
    assert chosen.toolTip()
    chosen.trigger()
    menu.close()
    qtbot.waitUntil(lambda: explorer.session.undo_text == "failure letters", timeout=20_000)
    assert explorer.session.state.sample.source.name == "gallery:letters-scattered"
    wait_idle(qtbot, explorer)
    column = explorer.session.selected_column
    qtbot.waitUntil(lambda: bool(explorer.controller.column_scene(column.id).findings), timeout=20_000)
    assert "letters" in {each.id for each in explorer.controller.column_scene(column.id).findings}
    # The panel shows it as soon as it is looked at.
    explorer.window.actions_by_name["panel-findings"].trigger()
    dock = explorer.hosts["findings"].dock
    qtbot.waitUntil(lambda: dock.message is None, timeout=20_000)
    rows = [dock.list.item(row).text() for row in range(dock.list.count())]
    row = rows.index("? Letters or symbols")
    place = dock.list.visualItemRect(dock.list.item(row)).center()
    qtbot.mouseClick(dock.list.viewport(), Qt.MouseButton.LeftButton, pos=place)
    assert "two tones" in dock.text.text()
