"""The dock of solids: cross-hairs by mouse, wheel and keys, objects that turn, sizes, files."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import check_controls, feed, image_input, scene_of, shown
from mouse import drag, move
from PIL import Image
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QApplication, QFileDialog

from texlab.columns.status import status_parts
from texlab.docks.solids.dock import SAVED, SolidsDock
from texlab.state.intentions import AskOnce, EditSize, Tell
from texlab.state.scene import ColumnScene, Scene
from texlab.style.theme import DARK
from texlab_core.documents.reading import read_recipe
from texlab_core.engine.estimate import estimate_of, in_words
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.images.formats.volumes import read_volume
from texlab_core.solids.pictures import slice_at

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer
    from texlab_core.engine.result import Result

EXEMPLAR = np.random.default_rng(4).random((20, 24, 3), np.float32)
LEFT = Qt.MouseButton.LeftButton


@pytest.fixture(scope="module")
def result() -> Result:
    return run(Job(method="solid", inputs={"exemplar": image_input(EXEMPLAR)}, size=(10, 12, 16), seed=3))


def column(result: Result | None, **changes: Any) -> ColumnScene:
    base = ColumnScene(1, "solid", "Solid texture", find_method("solid").params(), "finished", size=(10, 12, 16))
    return dataclasses.replace(base, result=result, **changes)


def scene(result: Result | None, **changes: Any) -> Scene:
    return scene_of(column(result, **changes), exemplar=EXEMPLAR)


@pytest.fixture
def dock(qtbot: Any, result: Result) -> SolidsDock:
    made: SolidsDock = shown(qtbot, SolidsDock(), 1000, 300)
    feed(made, scene(result))
    # The panes have their places.
    qtbot.waitUntil(lambda: len({area.width() for area in made.areas}) <= 2)
    feed(made, scene(result))
    return made


def wheel(widget: Any, notches: int) -> None:
    middle = QPointF(widget.rect().center())
    event = QWheelEvent(
        middle,
        QPointF(widget.mapToGlobal(middle.toPoint())),
        QPoint(),
        QPoint(0, 120 * notches),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(widget, event)


def test_it_shows_three_slices_the_exemplar_and_two_objects(dock: SolidsDock, result: Result) -> None:
    assert dock.message is None
    assert dock.place == (5, 6, 8)
    for cut, pane in dock.panes.items():
        wanted = np.rint(slice_at(result.volume, cut, (5, 6, 8)) * 255)  # type: ignore[arg-type]
        np.testing.assert_array_equal(pane.picture, wanted)
    assert dock.panes["xz"].caption == "Slice xz, y 6"
    assert dock.exemplar.picture.shape == (20, 24, 3)  # type: ignore[union-attr]
    assert dock.object.picture is not None
    assert dock.wrapped.picture is not None
    assert (dock.object.picture != dock.wrapped.picture).any()
    assert [dock.sides[each].value() for each in ("width", "height", "depth")] == [16, 12, 10]
    check_controls(dock)


def test_a_cross_hair_that_is_dragged_moves_the_other_slices(qtbot: Any, dock: SolidsDock, result: Result) -> None:
    pane, asked = dock.panes["xy"], []
    dock.asks.connect(lambda: asked.append(True))
    drag(qtbot, pane, [pane.place_of(3, 4), pane.place_of(7, 9), pane.place_of(2, 11)])
    assert dock.place == (5, 2, 11)
    assert dock.panes["yz"].cross == (2, 5)
    assert asked
    answer = feed(dock, scene(result))
    np.testing.assert_array_equal(answer.slices["yz"][:, 0, :], np.rint(result.volume[0, :, 11] * 255))  # type: ignore[index]
    assert "x 11, y 2, z 5" in dock.values.text()
    other = dock.panes["yz"]
    qtbot.mouseClick(other, LEFT, pos=other.place_of(8, 1))
    assert dock.place == (1, 8, 11)
    third = dock.panes["xz"]
    qtbot.mouseClick(third, LEFT, pos=third.place_of(9, 15))
    assert dock.place == (9, 8, 15)


def test_what_a_solid_takes_is_said_before_it_is_made(
    qtbot: Any, dock: SolidsDock, monkeypatch: pytest.MonkeyPatch
) -> None:
    def words(side: int) -> str:
        method = find_method("solid")
        return in_words(estimate_of(method, {"exemplar": image_input(EXEMPLAR)}, method.params(), (10, 12, side)))

    assert dock.needs.text() == f"needs {words(16)}"
    intentions: list[Any] = []
    dock.intention.connect(intentions.append)
    box = dock.sides["width"]
    box.lineEdit().selectAll()
    qtbot.keyClicks(box.lineEdit(), "200")
    assert dock.needs.text() == f"needs {words(200)}"
    qtbot.keyClicks(box.lineEdit(), "x")
    assert dock.needs.text() == ""
    assert intentions == []
    monkeypatch.setattr("texlab_core.engine.estimate.machine_bytes", lambda: 10**6)
    qtbot.keyClick(box.lineEdit(), Qt.Key.Key_Backspace)
    assert "of memory, and this machine has 0.0 GB" in dock.needs.text()


def test_wheel_and_keys_go_through_the_slices(qtbot: Any, dock: SolidsDock) -> None:
    pane = dock.panes["xy"]
    wheel(pane, -2)
    assert dock.place == (7, 6, 8)
    wheel(pane, 1)
    assert dock.place == (6, 6, 8)
    qtbot.keyClick(pane, Qt.Key.Key_Left)
    qtbot.keyClick(pane, Qt.Key.Key_Down)
    assert dock.place == (6, 7, 7)
    for _ in range(20):
        qtbot.keyClick(pane, Qt.Key.Key_PageDown)
    assert dock.place == (9, 7, 7)
    qtbot.keyClick(dock.panes["yz"], Qt.Key.Key_PageUp)
    assert dock.place == (9, 7, 6)
    qtbot.keyClick(pane, Qt.Key.Key_Home)
    assert dock.place == (9, 6, 8)
    qtbot.keyClick(pane, Qt.Key.Key_A)
    assert dock.place == (9, 6, 8)


def test_the_object_is_turned_brought_nearer_and_back(qtbot: Any, dock: SolidsDock, result: Result) -> None:
    before = feed(dock, scene(result)).drawn
    pane, middle = dock.object, dock.object.rect().center()
    qtbot.mousePress(pane, LEFT, pos=middle)
    move(qtbot, pane, middle + QPoint(40, -10))
    assert dock.object.dragging
    live = feed(dock, scene(result))
    assert live.drawn.shape[0] <= 400
    qtbot.mouseRelease(pane, LEFT, pos=middle + QPoint(40, -10))
    assert not dock.object.dragging
    assert (dock.view.yaw, dock.view.pitch) == (-10.0, 19.0)
    after = feed(dock, scene(result)).drawn
    assert (after != before).any()
    wheel(pane, 1)
    assert dock.view.zoom == pytest.approx(1.1)
    qtbot.keyClick(dock.wrapped, Qt.Key.Key_Right)
    assert dock.view.yaw == 0
    qtbot.keyClick(pane, Qt.Key.Key_Minus)
    assert dock.view.zoom == pytest.approx(1)
    qtbot.keyClick(pane, Qt.Key.Key_Home)
    np.testing.assert_array_equal(feed(dock, scene(result)).drawn, before)


def test_shape_and_comparison_are_chosen(qtbot: Any, dock: SolidsDock, result: Result) -> None:
    before = feed(dock, scene(result)).drawn
    dock.shape_box.setFocus()
    qtbot.keyClick(dock.shape_box, Qt.Key.Key_Down)
    dock.shape_box.activated.emit(dock.shape_box.currentIndex())
    assert (feed(dock, scene(result)).drawn != before).any()
    qtbot.mouseClick(dock.beside, LEFT, pos=QPoint(8, dock.beside.height() // 2))
    assert not dock.beside.isChecked()
    assert not dock.wrapped.isVisible()
    assert feed(dock, scene(result)).wrapped is None


def test_panes_stand_in_one_row_or_two(qtbot: Any, dock: SolidsDock) -> None:
    def rows() -> int:
        return len({area.y() for area in dock.areas})

    qtbot.waitUntil(lambda: rows() == 1)
    dock.resize(500, 700)
    qtbot.waitUntil(lambda: rows() == 2)


def test_making_it_opens_no_window_beside(qtbot: Any) -> None:
    before = set(QApplication.topLevelWidgets())
    made = SolidsDock()
    qtbot.addWidget(made)
    shown_now = {each for each in set(QApplication.topLevelWidgets()) - before if each.isVisible()}
    assert not shown_now


def test_both_themes_paint_the_objects_ground(dock: SolidsDock, result: Result) -> None:
    light = feed(dock, scene(result)).drawn[0, 0].copy()
    dock.set_theme(DARK)
    dark = feed(dock, scene(result)).drawn[0, 0]
    assert light.mean() > 128 > dark.mean()


def test_another_size_is_an_intention(qtbot: Any, dock: SolidsDock) -> None:
    with qtbot.waitSignal(dock.intention) as told:
        dock.sides["depth"].setFocus()
        dock.sides["depth"].selectAll()
        qtbot.keyClicks(dock.sides["depth"], "24")
        qtbot.keyClick(dock.sides["depth"], Qt.Key.Key_Return)
    assert told.args == [EditSize(1, (24, 12, 16))]


def test_the_last_solid_stays_while_a_new_one_is_made(dock: SolidsDock, result: Result) -> None:
    assert feed(dock, scene(None, status="running")).result is result
    assert feed(dock, scene(None, status="failed", message="No.")) is None
    assert dock.message == "No."
    assert feed(dock, scene_of(dataclasses.replace(column(None), id=2, status="running"), selected=2)) is None
    assert "appears when" in (dock.message or "")
    other = ColumnScene(3, "heeger-bergen", "Heeger-Bergen", find_method("heeger-bergen").params())
    assert feed(dock, scene_of(other, selected=3)) is None
    assert "add the method Solid" in (dock.message or "")
    assert not dock.controls.isVisible()


@pytest.mark.parametrize("what", SAVED)
def test_views_are_saved_with_their_recipe(
    qtbot: Any, dock: SolidsDock, result: Result, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    told: list[Any] = []
    dock.intention.connect(told.append)
    suffix = SAVED[what][2]
    monkeypatch.setattr(QFileDialog, "getSaveFileName", staticmethod(lambda *_: (str(tmp_path / "view"), "")))
    action = next(each for each in dock.save_button.menu().actions() if each.text() == SAVED[what][0])
    action.trigger()
    (save,) = told
    assert isinstance(save, AskOnce)
    save.done(save.compute(lambda: False))
    assert told[-1] == Tell(f"Saved {tmp_path / 'view'}{suffix}.")
    with Image.open(tmp_path / f"view{suffix}") as picture:
        assert getattr(picture, "n_frames", 1) == {"turn": 60, "walk": 10}.get(what, 1)
    assert read_recipe(tmp_path / f"view{suffix}").size == (10, 12, 16)


def test_without_a_solid_there_is_nothing_to_save(qtbot: Any) -> None:
    dock: SolidsDock = shown(qtbot, SolidsDock())
    with qtbot.waitSignal(dock.intention) as told:
        dock.save_button.menu().actions()[0].trigger()
    assert told.args[0].problem


def test_a_solid_in_the_window(
    qtbot: Any,
    open_window: Callable[..., Explorer],
    texture: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from tests.gui.conftest import ids, wait_idle

    explorer = open_window(str(texture), [("solid", find_method("solid").params(iterations=1))])
    (column_id,) = ids(explorer)
    scene = explorer.controller.column_scene(column_id)
    assert scene is not None
    assert scene.result is not None
    assert scene.size == scene.result.job.size == (48, 48, 48)
    explorer.window.docks["solids"].raise_()
    dock = explorer.hosts["solids"].dock
    qtbot.waitUntil(lambda: dock.answer is not None)
    # The same bits as from Python.
    alone = run(scene.result.job)
    np.testing.assert_array_equal(dock.answer.volume, alone.volume)
    dock.sides["depth"].setFocus()
    dock.sides["depth"].selectAll()
    qtbot.keyClicks(dock.sides["depth"], "9")
    qtbot.keyClick(dock.sides["depth"], Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: dock.answer.volume.shape == (9, 48, 48, 3))
    wait_idle(qtbot, explorer)
    assert "48 x 48 x 9" in " ".join(status_parts(explorer.controller.column_scene(column_id)))
    path = tmp_path / "block.tif"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", staticmethod(lambda *_: (str(path), "")))
    explorer.window.actions_by_name["export"].trigger()
    qtbot.waitUntil(path.is_file)
    wait_idle(qtbot, explorer)
    assert read_volume(path).values.shape == (9, 48, 48, 3)
    explorer.session.undo()
    qtbot.waitUntil(lambda: dock.answer.volume.shape[0] == 48)
