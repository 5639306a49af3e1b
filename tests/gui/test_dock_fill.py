"""Painting a hole and filling it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QMenu

from tests.gui.conftest import drag, ids, result_image, wait_idle
from texlab.docks.fill.masks import mask_input, read_mask
from texlab.docks.fill.strokes import marked_box, stroke_box, stroke_lasso, stroke_line
from texlab.storage import kept_inputs
from texlab.storage.kept_inputs import input_to_json, keep_inputs, load_input
from texlab_core.documents.reading import read_recipe
from texlab_core.engine.inputs import ArraysInput, DataInput, ImageInput, hash_arrays
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.reading import read_image
from texlab_core.images.formats.writing import write_image

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer
    from texlab.docks.fill.dock import FillDock

places = st.tuples(st.floats(-5, 35), st.floats(-5, 25))


@given(places, places, st.integers(1, 9))
def test_a_line_covers_what_is_near_it(first: Any, last: Any, radius: int) -> None:
    mask = np.zeros((30, 20), np.uint8)
    stroke_line(mask, first, last, radius, 1.0)
    for row in range(30):
        for column in range(20):
            shares = np.linspace(0, 1, 400)
            near = np.hypot(
                row + 0.5 - first[0] - shares * (last[0] - first[0]),
                column + 0.5 - first[1] - shares * (last[1] - first[1]),
            ).min()
            if abs(near - radius) > 0.1:
                assert mask[row, column] == (255 if near < radius else 0)


@given(places, places, st.integers(1, 9), st.floats(0, 0.9))
def test_a_soft_brush_fades_from_its_hard_part_to_its_edge(
    first: Any, last: Any, radius: int, hard: float
) -> None:
    shares = np.zeros((30, 20), np.uint8)
    box = stroke_line(shares, first, last, radius, hard)
    for row, column in ((0, 0), (7, 12), (15, 3), (29, 19)):
        ends = np.linspace(0, 1, 400)
        near = np.hypot(
            row + 0.5 - first[0] - ends * (last[0] - first[0]),
            column + 0.5 - first[1] - ends * (last[1] - first[1]),
        ).min()
        wanted = 255 * np.clip((radius - near) / (radius * (1 - hard)), 0, 1)
        slope = 255 / (radius * (1 - hard))
        assert abs(float(shares[row, column]) - wanted) <= 1 + 0.1 * slope
    marked = marked_box(shares)
    if marked is not None:
        assert box is not None
        for inner, outer in zip(marked, box, strict=True):
            assert outer.start <= inner.start <= inner.stop <= outer.stop
        stroke_line(shares, first, last, radius, 1.0, erase=True)
        assert shares.max() == 0


def test_a_lasso_marks_the_pixels_whose_centres_lie_inside() -> None:
    shares = np.zeros((20, 20), np.uint8)
    stroke_lasso(shares, [(2, 2), (2, 12), (12, 12), (12, 2)])
    assert shares.sum() == 255 * 100
    assert (shares[2:12, 2:12] == 255).all()
    shares[:] = 0
    stroke_lasso(shares, [(0, 0), (0, 16.5), (16.5, 0)])
    rows, columns = np.indices((20, 20)) + 0.5
    assert np.array_equal(shares > 0, rows + columns < 16.5)
    assert stroke_lasso(shares, [(1, 1), (2, 2)]) is None
    assert stroke_box(shares, (5, 5), (5, 9)) is None
    assert stroke_box(shares, (-4, 3), (2, 40)) == (slice(0, 2), slice(3, 20))


@pytest.fixture
def filling(qtbot: Any, open_window: Callable[..., Explorer], texture: Path) -> tuple[Explorer, FillDock]:
    params = methods()["efros-leung"].params.from_json({"window": 7})
    explorer = open_window(str(texture), [("efros-leung", params)])
    dock = explorer.hosts["fill"].dock
    assert dock.take_settings({"where": "exemplar"}) == ()
    explorer.window.docks["fill"].raise_()
    qtbot.waitUntil(lambda: dock.canvas.picture is not None, timeout=20_000)
    return explorer, dock


def test_a_painted_hole_is_filled(qtbot: Any, filling: tuple[Explorer, FillDock]) -> None:
    explorer, dock = filling
    canvas = dock.canvas
    dock.radius.setValue(3)
    assert not dock.fill_button.isEnabled()
    at = [canvas.to_widget(20, column).toPoint() for column in (18, 22, 28)]
    drag(qtbot, canvas.viewport(), at)
    assert canvas.mask[20, 18:28].all()
    assert 40 < canvas.mask.sum() < 140
    qtbot.mouseClick(dock.fill_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: len(ids(explorer)) == 2, timeout=10_000)
    wait_idle(qtbot, explorer)
    new = ids(explorer)[1]
    image, original = result_image(explorer, new), explorer.controller.exemplar.pixels
    assert image.shape == original.shape
    assert np.array_equal(image[~canvas.mask], original[~canvas.mask])
    assert not np.array_equal(image[canvas.mask], original[canvas.mask])
    source = explorer.controller.column_scene(new).result.maps["source"].data
    rows, columns = source[canvas.mask].T
    assert np.allclose(image[canvas.mask], original[rows, columns], atol=1 / 255)


def test_strokes_are_undone_cleared_and_inverted(qtbot: Any, filling: tuple[Explorer, FillDock]) -> None:
    _, dock = filling
    canvas = dock.canvas
    dock.tool.setCurrentIndex(2)
    dock._tool_changed()
    corners = [
        canvas.to_widget(10, 10).toPoint(),
        canvas.to_widget(15, 20).toPoint(),
        canvas.to_widget(20, 30).toPoint(),
    ]
    drag(qtbot, canvas.viewport(), corners)
    assert canvas.mask.sum() == 200
    assert canvas.mask[10:20, 10:30].all()
    canvas.setFocus()
    qtbot.keyClick(canvas, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert not canvas.mask.any()
    canvas.redo()
    assert canvas.mask.sum() == 200
    dock.findChild(type(dock.fill_button), "fill-invert").click()
    assert canvas.mask.sum() == 40 * 48 - 200
    dock.findChild(type(dock.fill_button), "fill-clear").click()
    assert not canvas.mask.any()


def test_undo_takes_back_strokes_on_the_picture_and_changes_elsewhere(
    qtbot: Any, filling: tuple[Explorer, FillDock]
) -> None:
    explorer, dock = filling
    canvas = dock.canvas
    explorer.session.set_seed(77)
    drag(qtbot, canvas.viewport(), [canvas.to_widget(20, column).toPoint() for column in (18, 22, 28)])
    canvas.setFocus()
    for key in (Qt.Key.Key_Z, Qt.Key.Key_Z):
        qtbot.keyClick(canvas, key, Qt.KeyboardModifier.ControlModifier)
    assert not canvas.mask.any()
    assert explorer.session.state.seed == 77
    both = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
    qtbot.keyClick(canvas, Qt.Key.Key_Z, both)
    assert canvas.mask.any()
    dock.fill_button.setFocus()
    qtbot.keyClick(dock.fill_button, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert explorer.session.state.seed != 77
    assert canvas.mask.any()
    wait_idle(qtbot, explorer)


def test_a_new_filled_column_is_in_sight(qtbot: Any, filling: tuple[Explorer, FillDock]) -> None:
    explorer, dock = filling
    for _ in range(14):
        explorer.session.duplicate_column(ids(explorer)[0])
    wait_idle(qtbot, explorer)
    count = len(ids(explorer))
    canvas = dock.canvas
    drag(qtbot, canvas.viewport(), [canvas.to_widget(20, column).toPoint() for column in (18, 22, 28)])
    qtbot.mouseClick(dock.fill_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: len(ids(explorer)) == count + 1, timeout=10_000)
    wait_idle(qtbot, explorer)
    view = explorer.workspace.columns[ids(explorer)[-1]]
    assert explorer.workspace.verticalScrollBar().maximum() > 0
    qtbot.waitUntil(lambda: view.visibleRegion().boundingRect().width() == view.width())


def test_the_keyboard_paints(qtbot: Any, filling: tuple[Explorer, FillDock]) -> None:
    _, dock = filling
    dock.radius.setValue(2)
    qtbot.keyClick(dock.canvas, Qt.Key.Key_Right)
    qtbot.keyClick(dock.canvas, Qt.Key.Key_Space)
    assert dock.canvas.mask[20, 26]
    assert not dock.canvas.mask[20, 30]


def test_masks_are_read_from_transparency_or_brightness(tmp_path: Path) -> None:
    pixels = np.full((12, 16, 4), 200, np.uint8)
    pixels[3:6, 4:9, 3] = 0
    Image.fromarray(pixels).save(tmp_path / "hole.png")
    marked = np.zeros((12, 16), np.bool_)
    marked[3:6, 4:9] = True
    assert np.array_equal(read_mask(str(tmp_path / "hole.png"), (12, 16)), marked)
    Image.fromarray(np.where(marked, 255, 0).astype(np.uint8)).save(tmp_path / "white.png")
    assert np.array_equal(read_mask(str(tmp_path / "white.png"), (12, 16)), marked)
    with pytest.raises(InputError, match="mask: must have the size of the picture, 20 x 12 pixels, got 16 x 12"):
        read_mask(str(tmp_path / "white.png"), (12, 20))


def test_a_loaded_mask_of_the_wrong_size_changes_nothing(
    qtbot: Any, filling: tuple[Explorer, FillDock], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    explorer, dock = filling
    Image.fromarray(np.zeros((5, 5), np.uint8)).save(tmp_path / "small.png")
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *args, **more: (str(tmp_path / "small.png"), ""))
    dock._load()
    bar = explorer.window.message_bar
    qtbot.waitUntil(bar.isVisible, timeout=10_000)
    assert "48 x 40" in bar.label.text()
    assert not dock.canvas.mask.any()
    wait_idle(qtbot, explorer)


def test_a_mask_that_comes_after_another_picture_changes_nothing(
    qtbot: Any, filling: tuple[Explorer, FillDock], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    explorer, dock = filling
    Image.fromarray(np.full((40, 48), 255, np.uint8)).save(tmp_path / "mask.png")
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *args, **more: (str(tmp_path / "mask.png"), ""))
    dock._load()
    # The file is being read.
    dock.canvas.show_image(np.zeros((30, 20, 3), np.uint8))
    bar = explorer.window.message_bar
    qtbot.waitUntil(bar.isVisible, timeout=10_000)
    assert "another picture" in bar.label.text() or "20 x 30" in bar.label.text()
    assert dock.canvas.mask.shape == (30, 20)
    assert not dock.canvas.mask.any()
    wait_idle(qtbot, explorer)


def test_a_picture_grows_outward(qtbot: Any, filling: tuple[Explorer, FillDock]) -> None:
    explorer, dock = filling
    explorer.session.set_size((56, 60))
    qtbot.mouseClick(dock.grow_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: len(ids(explorer)) == 2, timeout=10_000)
    wait_idle(qtbot, explorer)
    image, original = result_image(explorer, ids(explorer)[1]), explorer.controller.exemplar.pixels
    assert image.shape == (56, 60, 3)
    inner = [
        (row, column)
        for row in range(17)
        for column in range(13)
        if np.array_equal(image[row : row + 40, column : column + 48], original)
    ]
    assert len(inner) == 1


# A whole picture, at its own resolution.


@pytest.fixture
def retouching(
    qtbot: Any, open_window: Callable[..., Explorer], tmp_path: Path
) -> tuple[Explorer, FillDock, np.ndarray]:
    """A window with a picture of 16 bits that is larger than what the columns see, and its values."""
    random = np.random.default_rng(3)
    rows, columns = np.indices((200, 280))
    waves = 22000 + 15000 * np.sin(columns / 3.0) * np.cos(rows / 4.0)
    values = (waves[..., None] + random.integers(0, 900, (200, 280, 3))).astype(np.uint16)
    write_image(tmp_path / "deep.png", values / np.float32(65535), bits=16)
    explorer = open_window(
        str(tmp_path / "deep.png"), [("efros-leung", methods()["efros-leung"].params(window=5))]
    )
    dock = explorer.hosts["fill"].dock
    dock.reach.setValue(16)
    explorer.window.docks["fill"].raise_()
    qtbot.waitUntil(lambda: dock.canvas.picture is not None, timeout=20_000)
    return explorer, dock, read_image(tmp_path / "deep.png", "deep").values


def stroke(qtbot: Any, dock: FillDock, places: list[tuple[int, int]]) -> None:
    canvas = dock.canvas
    drag(qtbot, canvas.viewport(), [canvas.to_widget(row + 0.5, column + 0.5).toPoint() for row, column in places])


def fill_it(qtbot: Any, explorer: Explorer, dock: FillDock) -> None:
    count = len(dock._work.made)
    qtbot.mouseClick(dock.fill_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: len(dock._work.made) > count, timeout=60_000)
    wait_idle(qtbot, explorer)


def save(
    qtbot: Any, explorer: Explorer, dock: FillDock, path: Path, monkeypatch: pytest.MonkeyPatch
) -> np.ndarray:
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *args, **more: (str(path), "PNG (*.png)"))
    qtbot.mouseClick(dock.save_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(path.exists, timeout=20_000)
    wait_idle(qtbot, explorer)
    return read_image(path, "saved").values


def test_a_whole_picture_is_filled_at_its_own_resolution_and_depth(
    qtbot: Any,
    retouching: tuple[Explorer, FillDock, np.ndarray],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    explorer, dock, values = retouching
    assert dock.canvas.picture.shape == (200, 280, 3)
    columns = ids(explorer)
    dock.radius.setValue(4)
    stroke(qtbot, dock, [(60, 60), (60, 66), (62, 72)])
    first_hole = dock.canvas.mask
    fill_it(qtbot, explorer, dock)
    # It is filled here: no column has come.
    assert ids(explorer) == columns
    assert not dock.canvas.mask.any()
    assert "pixels were filled, each from one of about" in explorer.window.message_bar.label.text()
    first = save(qtbot, explorer, dock, tmp_path / "first.png", monkeypatch)
    assert first.dtype == np.uint16
    assert np.array_equal(first[~first_hole], values[~first_hole])
    assert (first[first_hole] != values[first_hole]).any()
    # The next hole, with a soft edge and another tool.
    dock.hardness.setValue(50)
    dock.tool.setCurrentIndex(dock.tool.findData("brush"))
    stroke(qtbot, dock, [(62, 70), (70, 74)])
    second_hole = dock.canvas.mask
    assert ((dock.canvas.shares > 0) & (dock.canvas.shares < 255)).any()
    fill_it(qtbot, explorer, dock)
    second = save(qtbot, explorer, dock, tmp_path / "second.png", monkeypatch)
    assert np.array_equal(second[~second_hole], first[~second_hole])
    # Both fills come from the file alone.
    again = run(read_recipe(tmp_path / "second.png").job())
    assert np.array_equal(np.rint(again.image.astype(float) * 65535).astype(np.uint16), second)
    # The last fill is taken back, with the hole that was painted for it.
    qtbot.mouseClick(dock.undo_button, Qt.MouseButton.LeftButton)
    assert np.array_equal(dock.canvas.mask, second_hole)
    assert np.array_equal(save(qtbot, explorer, dock, tmp_path / "back.png", monkeypatch), first)
    # Another try has another seed.
    fill_it(qtbot, explorer, dock)
    qtbot.mouseClick(dock.again_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: len(dock._work.made) == 2, timeout=60_000)
    wait_idle(qtbot, explorer)
    assert dock._work.made[1].seed == explorer.session.state.seed + 1
    other = save(qtbot, explorer, dock, tmp_path / "other.png", monkeypatch)
    assert (other[second_hole] != second[second_hole]).any()
    assert np.array_equal(other[~second_hole], first[~second_hole])
    # Another picture and back: what was painted and filled is still there.
    stroke(qtbot, dock, [(150, 150), (152, 156)])
    painted = dock.canvas.mask
    explorer.opener.open("gallery:structured-pebbles")
    qtbot.waitUntil(lambda: dock._work.picture.name.startswith("gallery"), timeout=20_000)
    assert not dock.canvas.mask.any()
    explorer.session.undo()
    qtbot.waitUntil(lambda: dock._work.picture.name == "deep.png", timeout=20_000)
    assert len(dock._work.made) == 2
    assert np.array_equal(dock.canvas.mask, painted)
    wait_idle(qtbot, explorer)


def test_a_whole_picture_grows_by_margins_and_becomes_the_exemplar(
    qtbot: Any, retouching: tuple[Explorer, FillDock, np.ndarray]
) -> None:
    explorer, dock, values = retouching
    for box, margin in zip(dock.margins.boxes, (3, 0, 5, 2), strict=True):
        box.setValue(margin)
    dock.margins.button.click()
    qtbot.waitUntil(lambda: dock._work.picture.size == (202, 288), timeout=60_000)
    wait_idle(qtbot, explorer)
    grown = np.rint(dock._work.picture.pixels.astype(float) * 65535).astype(np.uint16)
    assert np.array_equal(grown[:200, 3:283], values)
    assert dock._work.picture.depth == 16
    qtbot.mouseClick(dock.use_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: explorer.session.state.sample.source.size == (202, 288), timeout=20_000)
    assert explorer.session.state.sample.source.depth == 16
    wait_idle(qtbot, explorer)


def test_a_hole_is_filled_from_another_image_and_can_be_stopped(
    qtbot: Any, retouching: tuple[Explorer, FillDock, np.ndarray], texture: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    explorer, dock, _ = retouching
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *args, **more: (str(texture), ""))
    qtbot.mouseClick(dock.other_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dock.source.currentData() == "other", timeout=10_000)
    assert not dock.reach.isEnabled()
    dock.tool.setCurrentIndex(dock.tool.findData("lasso"))
    dock._tool_changed()
    stroke(qtbot, dock, [(40, 40), (40, 52), (50, 52), (50, 40)])
    fill_it(qtbot, explorer, dock)
    made = dock._work.made[0]
    allowed = {tuple(pixel) for pixel in as_exemplar(texture).pixels.reshape(-1, 3)}
    marked = made.patch[1]
    assert {tuple(pixel) for pixel in made.found.result.image[marked]} <= allowed
    # A hole of nearly everything takes long; it stops at once.
    dock.canvas.set_mask(np.pad(np.ones((180, 260), bool), 10))
    qtbot.mouseClick(dock.fill_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dock._filling.preview is not None, timeout=60_000)
    assert dock.stop_button.isVisible()
    qtbot.mouseClick(dock.stop_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dock._filling.status == "stopped", timeout=10_000)
    assert len(dock._work.made) == 1
    assert dock.canvas.mask.any()
    wait_idle(qtbot, explorer)


def test_the_panel_takes_the_stage_and_gives_it_back(
    qtbot: Any, retouching: tuple[Explorer, FillDock, np.ndarray]
) -> None:
    explorer, dock, _ = retouching
    window, stage = explorer.window, explorer.workspace
    before = dock.canvas.height()
    qtbot.mouseClick(dock.stage_switch, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dock.canvas.height() > before + 100, timeout=5_000)
    assert not stage.isVisible()
    window.message_bar.tell("A sentence.", "news")
    assert window.message_bar.isVisible()
    assert window.message_bar.parentWidget() is window
    qtbot.mouseClick(window.big_panel.button, Qt.MouseButton.LeftButton)
    assert stage.isVisible()
    assert window.message_bar.parentWidget() is not window
    window.actions_by_name["big-panel"].trigger()
    assert not stage.isVisible()
    window.actions_by_name["layout-explore"].trigger()
    assert stage.isVisible()


def test_the_right_button_offers_what_can_be_done(
    qtbot: Any, retouching: tuple[Explorer, FillDock, np.ndarray]
) -> None:
    _, dock, _ = retouching
    stroke(qtbot, dock, [(40, 40), (40, 52)])
    dock.canvas.menu_wanted.emit(dock.mapToGlobal(dock.rect().center()))
    menu = dock.findChild(QMenu, "fill-menu")
    actions = {action.text(): action for action in menu.actions()}
    assert actions["Fill"].isEnabled()
    assert not actions["Save picture ..."].isEnabled()
    actions["Invert"].trigger()
    assert dock.canvas.mask.mean() > 0.9
    menu.close()


# What is kept with the session.


@pytest.fixture
def filled(qtbot: Any, filling: tuple[Explorer, FillDock]) -> tuple[Explorer, int]:
    """A window in which a hole was painted and filled, and the column that did."""
    explorer, dock = filling
    canvas = dock.canvas
    dock.radius.setValue(3)
    drag(qtbot, canvas.viewport(), [canvas.to_widget(20, column).toPoint() for column in (18, 22, 28)])
    qtbot.mouseClick(dock.fill_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: len(ids(explorer)) == 2, timeout=10_000)
    wait_idle(qtbot, explorer)
    return explorer, ids(explorer)[1]


def kept_files(home: Path) -> list[Path]:
    return sorted((home / "config" / "inputs").glob("*"))


def test_a_filled_hole_comes_back(
    filled: tuple[Explorer, int], open_window: Callable[..., Explorer], texlab_home: Path
) -> None:
    explorer, column_id = filled
    column = explorer.session.state.column(column_id)
    image = result_image(explorer, column_id)
    explorer.window.close()
    assert [path.stem for path in kept_files(texlab_home)] == [dict(column.inputs)["mask"].sha256]
    again = open_window(None)
    back = again.session.state.columns[1]
    assert back.size == column.size == (40, 48)
    assert np.array_equal(dict(back.inputs)["mask"].pixels, dict(column.inputs)["mask"].pixels)
    assert dict(back.inputs)["mask"].name == "painted hole"
    assert np.array_equal(result_image(again, back.id), image)
    assert not again.window.message_bar.isVisible()
    # What no column has any more is not kept.
    again.session.remove_column(back.id)
    again.window.close()
    assert kept_files(texlab_home) == []


@pytest.mark.parametrize("damage", ["cut", "flipped", "gone", "other"])
def test_a_damaged_mask_is_left_out_and_said(
    filled: tuple[Explorer, int],
    open_window: Callable[..., Explorer],
    texlab_home: Path,
    damage: str,
) -> None:
    explorer, _ = filled
    explorer.window.close()
    (path,) = kept_files(texlab_home)
    data = path.read_bytes()
    if damage == "cut":
        path.write_bytes(data[: len(data) // 2])
    elif damage == "flipped":
        path.write_bytes(data[:200] + bytes([data[200] ^ 1]) + data[201:])
    elif damage == "gone":
        path.unlink()
    else:
        np.savez(path, pixels=np.zeros((40, 48, 1), np.uint8))
    again = open_window(None)
    back = again.session.state.columns[1]
    assert back.inputs == ()
    bar = again.window.message_bar
    assert bar.isVisible()
    assert bar.label.text() == "The mask of Efros-Leung could not be brought back; the column starts without it."


def test_inputs_beyond_the_limit_are_not_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    small, large = (mask_input(np.ones(size, np.bool_), "mask") for size in ((8, 8), (100, 100)))
    monkeypatch.setattr(kept_inputs, "MAX_BYTES", 2000)
    keep_inputs([large, small], tmp_path)
    assert [path.stem for path in tmp_path.iterdir()] == [small.sha256]
    monkeypatch.setattr(kept_inputs, "MAX_BYTES", 10)
    with pytest.raises(InputError, match="too large"):
        load_input(input_to_json(small), "image", tmp_path)


def test_every_kind_of_input_is_kept_exactly(tmp_path: Path) -> None:
    random = np.random.default_rng(4)
    fine = random.random((9, 7, 3)).astype(np.float32)
    start = ImageInput(fine, "result", hash_arrays({"pixels": fine}))
    state = ArraysInput({"known": np.eye(4, dtype=np.bool_), "at": np.arange(3)}, "state")
    code = DataInput({"numbers": [1, 2.5]}, "code")
    keep_inputs([start, state, code], tmp_path)
    back = load_input(input_to_json(start), "image", tmp_path)
    assert isinstance(back, ImageInput)
    assert np.array_equal(back.pixels, fine)
    assert load_input(input_to_json(state), "arrays", tmp_path).sha256 == state.sha256
    assert load_input(input_to_json(code), "data", tmp_path).sha256 == code.sha256
    # A file is data: it is found by its hash alone, and names no other place.
    for saved in ({"name": "x"}, {"name": "x", "sha256": "../x"}, {"sha256": start.sha256}, [], None):
        with pytest.raises(InputError):
            load_input(saved, "image", tmp_path)
