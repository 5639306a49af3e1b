"""The code dock: numbers as in the code, dragged and typed with the texture following, saved, opened, undone."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import check_controls, column_of, feed, image_input, noise, scene_of, shown
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication, QFileDialog

from tests.gui.conftest import drag, ids, result_image, wait_idle
from texlab.docks.spectral.code import EDITED, CodeDock
from texlab.docks.spectral.code_answer import encoded
from texlab.docks.spectral.code_numbers import Number, differs, dragged, limits, value, values, with_value
from texlab.state.intentions import EditInputs
from texlab.style.theme import DARK, LIGHT
from texlab_core.engine.inputs import DataInput
from texlab_core.engine.job import Job
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.methods.spectral.codefile import code_from_json, code_input, code_to_json, read_code
from texlab_core.methods.spectral.synthesis import design
from texlab_core.transforms.gabor_bank import WIDTHS

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer

GROUPS = ("energy", "u", "v", "residual", "histogram")


@pytest.fixture
def dock(qtbot: Any) -> CodeDock:
    return shown(qtbot, CodeDock(), 900, 220)


@pytest.fixture
def image() -> Any:
    return noise(96, 128, 1)


def msg_scene(exemplar: Any, result: Any = None, code: Any = None, column_id: int = 1) -> Any:
    inputs = () if code is None else (("code", code_input(code, "some code")),)
    params = methods()["msg"].params()
    column = column_of(result, method="msg", title="MSG", params=params, inputs=inputs, column_id=column_id)
    return scene_of(column, exemplar=exemplar, selected=column_id)


def cell(grid: Any, row: int, column: int) -> QPoint:
    return grid.cell_rect(row, column).center().toPoint()


def drag_cell(qtbot: Any, grid: Any, row: int, column: int, *, up: int) -> None:
    start = cell(grid, row, column)
    steps = [start - QPoint(0, round(up * share)) for share in np.linspace(0, 1, 6)]
    drag(qtbot, grid, steps)


def sent(dock: CodeDock) -> list[tuple[int, Any, bool]]:
    """Collect the edits that the dock intends: (column, code, final)."""
    told: list[tuple[int, Any, bool]] = []

    def take(intention: Any) -> None:
        assert isinstance(intention, EditInputs)
        inputs = intention.inputs
        code = code_from_json(inputs[0][1].data).code if inputs else None
        told.append((intention.column_id, code, intention.final))

    dock.intention.connect(take)
    return told


# The numbers.


def test_numbers_are_those_of_the_code(image: Any) -> None:
    code = encoded(image, "participation")
    assert values(code, "energy") == pytest.approx(code.rms_table().reshape(-1))
    assert values(code, "u") == pytest.approx(100 * np.array(code.bandwidths_u) / WIDTHS)
    # White noise has 1 / sqrt(2) of the filter's width.
    assert values(code, "v").mean() == pytest.approx(70.7, rel=0.1)
    assert values(code, "residual")[0] == pytest.approx(255 * image.mean(), rel=1e-5)
    assert values(code, "histogram").sum() == pytest.approx(100, rel=0.05)
    assert sum(len(values(code, group)) for group in GROUPS) == code.parameters == 69


@pytest.mark.parametrize("group", GROUPS)
def test_one_number_changes_and_no_other(image: Any, group: Any) -> None:
    code = encoded(image, "participation")
    number = Number(group, 3)
    wanted = 1.5 * value(code, number)
    changed = with_value(code, number, wanted)
    assert value(changed, number) == pytest.approx(wanted, rel=1e-6)
    for other in GROUPS:
        places = np.flatnonzero(differs(changed, code, other)).tolist()
        assert places == ([3] if other == group else [])
    # What is shown can be a file, whatever is asked for.
    for extreme in (-1e300, 1e300, *limits(code, number), float("nan")):
        code_from_json(code_to_json(with_value(code, number, extreme)))


def test_a_histogram_keeps_a_number_above_zero(image: Any) -> None:
    code = encoded(np.full_like(image, 0.5), "participation")
    for place in range(16):
        code = with_value(code, Number("histogram", place), 0.0)
    assert max(code.tone.histogram.values) > 0
    code_from_json(code_to_json(code))


def test_dragging_is_by_ratios_and_starts_from_zero(image: Any) -> None:
    code = encoded(image, "participation")
    number = Number("energy", 5)
    assert dragged(code, number, 10) == pytest.approx(2 * value(code, number))
    assert dragged(code, number, -20) == pytest.approx(value(code, number) / 4)
    assert dragged(with_value(code, number, 0.0), number, 10) > 0
    assert dragged(code, Number("residual", 0), 3) == pytest.approx(code.residual.mean + 6)


# The dock alone.


def test_controls(dock: CodeDock) -> None:
    check_controls(dock)
    for view in (*dock.grids.values(), dock.bars):
        assert view.accessibleName()
        assert view.toolTip()
        assert view.focusPolicy() & Qt.FocusPolicy.TabFocus


def test_cells_show_table_2(dock: CodeDock, image: Any) -> None:
    feed(dock, msg_scene(image))
    code = encoded(image, "participation")
    table = code.rms_table()
    for row in range(4):
        for column in range(4):
            assert float(dock.grids["energy"].text(row, column)) == pytest.approx(table[row, column], rel=0.02)
    assert dock.grids["u"].text(3, 0) == f"{100 * code.bandwidths_u[12] / WIDTHS[12]:.0f}"
    assert float(dock.grids["residual"].text(0, 0)) == pytest.approx(code.residual.mean, rel=0.01)
    assert dock.state.text() == "69 numbers of the exemplar"
    assert not dock.back.isEnabled()


def test_what_the_result_reaches_is_told(dock: CodeDock, image: Any, qtbot: Any) -> None:
    result = run(Job(method="msg", inputs={"exemplar": image_input(image)}, size=(128, 128), seed=2)).image
    answer = feed(dock, msg_scene(image, result))
    assert answer.reached == pytest.approx(encoded(result, "participation").rms_table().reshape(-1))
    QApplication.processEvents()
    qtbot.mouseMove(dock.grids["energy"], cell(dock.grids["energy"], 2, 1))
    text = dock.readout.text()
    assert text.startswith("energy 1/8, 45°: ")
    assert f"result {answer.reached[9]:.4g}" in text
    qtbot.mouseMove(dock.grids["u"], cell(dock.grids["u"], 1, 1))
    assert "c/px" in dock.readout.text()


def test_a_drag_sends_drafts_and_ends_with_one_final(dock: CodeDock, image: Any, qtbot: Any) -> None:
    feed(dock, msg_scene(image))
    QApplication.processEvents()
    told = sent(dock)
    before = encoded(image, "participation")
    drag_cell(qtbot, dock.grids["energy"], 1, 2, up=40)
    assert [final for *_, final in told] == [False] * (len(told) - 1) + [True]
    assert told[-1][1] == told[-2][1]
    # Forty pixels are ten steps of a tenth octave.
    assert value(told[-1][1], Number("energy", 6)) == pytest.approx(2 * value(before, Number("energy", 6)))
    assert dock.state.text() == "69 edited numbers, not the exemplar's"
    assert dock.box.value() == pytest.approx(value(told[-1][1], Number("energy", 6)), abs=1e-3)


def test_an_answer_from_before_does_not_take_a_drag_back(dock: CodeDock, image: Any, qtbot: Any) -> None:
    scene = msg_scene(image)
    answer = feed(dock, scene)
    QApplication.processEvents()
    grid = dock.grids["energy"]
    start = cell(grid, 0, 0)
    qtbot.mousePress(grid, Qt.MouseButton.LeftButton, pos=start)
    from tests.gui.conftest import move

    move(qtbot, grid, start - QPoint(0, 20))
    shown_now = grid.text(0, 0)
    dock.present(answer)
    assert grid.text(0, 0) == shown_now
    qtbot.mouseRelease(grid, Qt.MouseButton.LeftButton, pos=start - QPoint(0, 20))
    dock.present(answer)
    assert grid.text(0, 0) == shown_now
    # An undo brings the old key back, and that is believed.
    feed(dock, scene)
    assert float(grid.text(0, 0)) == pytest.approx(answer.code.rms_table()[0, 0], rel=0.02)


def test_typing_into_a_cell(dock: CodeDock, image: Any, qtbot: Any) -> None:
    feed(dock, msg_scene(image))
    QApplication.processEvents()
    told = sent(dock)
    grid = dock.grids["v"]
    qtbot.mouseClick(grid, Qt.MouseButton.LeftButton, pos=cell(grid, 2, 3))
    assert dock.box.prefix() == "bandwidth v 1/8, 135°: "
    qtbot.keyClick(grid, Qt.Key.Key_Left)
    assert dock.box.prefix() == "bandwidth v 1/8, 90°: "
    assert told == []
    qtbot.keyClicks(grid, "2")
    assert dock.box.hasFocus()
    qtbot.keyClicks(dock.box, "5")
    qtbot.keyClick(dock.box, Qt.Key.Key_Return)
    ((column_id, code, final),) = told
    assert (column_id, final) == (1, True)
    assert code.bandwidths_v[10] == pytest.approx(0.25 * WIDTHS[10], rel=1e-6)


def test_keys_change_the_chosen_cell(dock: CodeDock, image: Any, qtbot: Any) -> None:
    feed(dock, msg_scene(image))
    told = sent(dock)
    grid = dock.grids["energy"]
    grid.setFocus()
    start = value(encoded(image, "participation"), Number("energy", 0))
    qtbot.keyClick(grid, Qt.Key.Key_Plus)
    assert value(told[-1][1], Number("energy", 0)) == pytest.approx(start * 2**0.1)
    qtbot.keyClick(grid, Qt.Key.Key_Minus)
    assert value(told[-1][1], Number("energy", 0)) == pytest.approx(start)
    qtbot.keyClick(grid, Qt.Key.Key_Delete)
    assert told[-1][1].energies[0] == 0
    bars = dock.bars
    bars.setFocus()
    qtbot.keyClick(bars, Qt.Key.Key_Right)
    qtbot.keyClick(bars, Qt.Key.Key_Right)
    qtbot.keyClick(bars, Qt.Key.Key_Delete)
    assert told[-1][1].tone.histogram.values[1] == 0
    assert dock.box.prefix() == "histogram 2: "


def test_the_histogram_is_drawn_with_the_mouse(dock: CodeDock, image: Any, qtbot: Any) -> None:
    feed(dock, msg_scene(image))
    QApplication.processEvents()
    told = sent(dock)
    bars = dock.bars
    heights = values(encoded(image, "participation"), "histogram")
    first = bars.bar_point(4, heights[4]).toPoint()
    wanted = [bars.bar_point(place, 2.0).toPoint() for place in range(4, 9)]
    # One large step over four bars draws all of them.
    drag(qtbot, bars, [first, wanted[0], wanted[-1]])
    code = told[-1][1]
    assert values(code, "histogram")[4:9] == pytest.approx(2.0, abs=0.2)
    assert np.flatnonzero(differs(code, encoded(image, "participation"), "histogram")).tolist() == [4, 5, 6, 7, 8]
    assert told[-1][2]


def test_a_given_code_is_shown_and_said_to_be_one(dock: CodeDock, image: Any) -> None:
    code = with_value(encoded(noise(64, 64, 1, seed=9), "participation"), Number("energy", 0), 50.0)
    feed(dock, msg_scene(image, code=code))
    assert float(dock.grids["energy"].text(0, 0)) == pytest.approx(50, abs=0.1)
    assert dock.state.text() == "69 numbers of some code, not the exemplar's"
    assert dock.back.isEnabled()
    assert dock.grids["energy"]._changed.all()


def test_other_methods_have_no_code(dock: CodeDock, image: Any) -> None:
    assert feed(dock, scene_of(column_of(image), exemplar=image)) is None
    assert dock.message == "Only MSG works from a code: choose a column of MSG, or open a code."
    assert dock.open_button.isEnabled()
    assert not dock.save_button.isEnabled()


def test_both_themes_and_tiny_images(dock: CodeDock) -> None:
    painted = []
    for theme in (DARK, LIGHT):
        dock.set_theme(theme)
        code = feed(dock, msg_scene(noise(2, 3, 3)))
        assert dock.message is None
        assert code is not None
        painted.append(dock.grab().toImage())
    assert painted[0] != painted[1]
    assert feed(dock, msg_scene(np.zeros((5, 4, 1), np.float32))) is not None
    assert dock.message is None
    assert dock.grab().toImage() != painted[1]


# In the window.


@pytest.fixture
def open_code(qtbot: Any, open_window: Callable[..., Explorer], texture: Path) -> tuple[Explorer, CodeDock]:
    explorer = open_window(str(texture), [("msg", methods()["msg"].params())], size=128)
    panel = explorer.window.docks["code"]
    panel.show()
    panel.raise_()
    dock = explorer.hosts["code"].dock
    assert isinstance(dock, CodeDock)
    qtbot.waitUntil(dock.isVisible)
    wait_idle(qtbot, explorer)
    return explorer, dock


def code_of(explorer: Explorer) -> Any:
    given = dict(explorer.session.state.columns[0].inputs)["code"]
    assert isinstance(given, DataInput)
    return code_from_json(given.data).code


def test_the_result_follows_an_energy(qtbot: Any, open_code: tuple[Explorer, CodeDock]) -> None:
    explorer, dock = open_code
    (column,) = ids(explorer)
    before = encoded(result_image(explorer, column), "participation")
    measured = dock._code
    assert measured is not None
    drag_cell(qtbot, dock.grids["energy"], 2, 1, up=60)
    wait_idle(qtbot, explorer)
    code = code_of(explorer)
    assert np.array(code.energies)[9] == pytest.approx(8 * measured.energies[9], rel=1e-5)
    # What the core alone makes of this code, bit for bit; the code wins over the exemplar.
    job = Job(method="msg", inputs={"code": code_input(code)}, size=(128, 128), seed=5)
    assert np.array_equal(result_image(explorer, column), run(job).image)
    # The plan reaches the code; the picture has the proportions once the histogram's common gain is removed.
    plan = design(code, (128, 128))
    assert plan.achieved[9] == pytest.approx(code.energies[9], rel=5e-3)
    after = encoded(result_image(explorer, column), "participation")
    gains = np.array(after.energies) / np.array(before.energies)
    far = [k for k in range(16) if k not in (4, 5, 6, 8, 9, 10, 12, 13, 14)]
    assert gains[9] / np.median(gains[far]) == pytest.approx(8, rel=0.25)
    assert explorer.controller.column_scene(column).draft is False


def test_a_drag_is_one_step_and_back_to_the_exemplar_another(
    qtbot: Any, open_code: tuple[Explorer, CodeDock]
) -> None:
    explorer, dock = open_code
    (column,) = ids(explorer)
    before = result_image(explorer, column)
    drag_cell(qtbot, dock.grids["energy"], 0, 0, up=40)
    drag_cell(qtbot, dock.grids["u"], 1, 1, up=-20)
    wait_idle(qtbot, explorer)
    assert dock.state.text() == "113 edited numbers, not the exemplar's"
    assert "from a code, not the exemplar" in explorer.workspace.columns[column].line.text()
    edited = result_image(explorer, column)
    qtbot.mouseClick(dock.back, Qt.MouseButton.LeftButton)
    wait_idle(qtbot, explorer)
    assert np.array_equal(result_image(explorer, column), before)
    assert dock.state.text() == "113 numbers of the exemplar"
    assert not dock.grids["energy"]._changed.any()
    explorer.session.undo()
    wait_idle(qtbot, explorer)
    assert np.array_equal(result_image(explorer, column), edited)
    explorer.session.undo()
    explorer.session.undo()
    wait_idle(qtbot, explorer)
    assert explorer.session.undo_text is None
    assert np.array_equal(result_image(explorer, column), before)
    assert dock.state.text() == "113 numbers of the exemplar"


def test_saved_codes_can_be_opened(
    qtbot: Any, open_code: tuple[Explorer, CodeDock], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    explorer, dock = open_code
    (column,) = ids(explorer)
    drag_cell(qtbot, dock.grids["energy"], 3, 0, up=40)
    wait_idle(qtbot, explorer)
    edited, code = result_image(explorer, column), code_of(explorer)
    path = tmp_path / "waves.msg.json"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(path), ""))
    qtbot.mouseClick(dock.save_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(path.exists)
    wait_idle(qtbot, explorer)
    saved = read_code(path)
    assert saved.code == code
    assert saved.exemplar == "waves.png"
    qtbot.mouseClick(dock.back, Qt.MouseButton.LeftButton)
    wait_idle(qtbot, explorer)
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *_: (str(path), ""))
    qtbot.mouseClick(dock.open_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: bool(explorer.session.state.columns[0].inputs))
    wait_idle(qtbot, explorer)
    assert np.array_equal(result_image(explorer, column), edited)
    assert dock.state.text() == "113 numbers of waves.msg.json, not the exemplar's"
    assert EDITED not in dock.state.text()
