"""Painting a hole and filling it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog

from tests.gui.conftest import drag, ids, result_image, wait_idle
from texlab.docks.fill.dock import FillDock, mask_input, read_mask
from texlab.docks.fill.mask_canvas import paint_line
from texlab.storage import kept_inputs
from texlab.storage.kept_inputs import input_to_json, keep_inputs, load_input
from texlab_core.engine.inputs import ArraysInput, DataInput, ImageInput, hash_arrays
from texlab_core.engine.registry import methods
from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer

places = st.tuples(st.floats(-5, 35), st.floats(-5, 25))


@given(places, places, st.integers(1, 9))
def test_a_line_covers_what_is_near_it(first: Any, last: Any, radius: int) -> None:
    mask = np.zeros((30, 20), np.bool_)
    paint_line(mask, first, last, radius, True)
    for row in range(30):
        for column in range(20):
            shares = np.linspace(0, 1, 400)
            near = np.hypot(
                row + 0.5 - first[0] - shares * (last[0] - first[0]),
                column + 0.5 - first[1] - shares * (last[1] - first[1]),
            ).min()
            if abs(near - radius) > 0.1:
                assert mask[row, column] == (near < radius)


@pytest.fixture
def filling(qtbot: Any, open_window: Callable[..., Explorer], texture: Path) -> tuple[Explorer, FillDock]:
    params = methods()["efros-leung"].params.from_json({"window": 7})
    explorer = open_window(str(texture), [("efros-leung", params)])
    dock = next(dock for dock in explorer.docks if isinstance(dock, FillDock))
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
