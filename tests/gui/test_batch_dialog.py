"""Run for many: what the fields say becomes a plan, the batch runs beside the window, and can be stopped."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mouse import on_screen
from PySide6.QtCore import Qt

from texlab.window.batch_desk import plan_data
from texlab.window.batch_dialog import BatchDialog, BatchRequest
from texlab_core.batch.plan import plan_from_json
from texlab_core.batch.running import BatchResult, Progress
from texlab_core.engine.registry import find_method
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.formats.writing import write_image

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def photos(tmp_path: Path) -> Path:
    folder = tmp_path / "photos"
    folder.mkdir()
    for number in range(2):
        rng = np.random.Generator(np.random.PCG64(number))
        write_image(folder / f"{number}.png", rng.random((20, 24, 3)))
    return folder


@pytest.fixture
def dialog(qtbot: Any) -> BatchDialog:
    made = BatchDialog()
    qtbot.addWidget(made)
    made.show()
    return on_screen(qtbot, made)


def test_it_runs_only_when_everything_is_said(dialog: BatchDialog, qtbot: Any) -> None:
    assert not dialog.run_button.isEnabled()
    dialog.inputs.setPlainText("a.png\n\n gallery:letters \n")
    assert not dialog.run_button.isEnabled()
    dialog.out.setText("out")
    assert dialog.run_button.isEnabled()
    dialog.sizes.setText(" ")
    assert not dialog.run_button.isEnabled()
    dialog.plan.setText("gallery:de-bonet-800")
    assert dialog.run_button.isEnabled()
    assert not dialog.inputs.isEnabled()
    dialog.plan.clear()
    dialog.sizes.setText("1x, 64x32")
    dialog.seeds.setValue(3)
    dialog.methods.setCurrentIndex(1)
    dialog.processes.setValue(2)
    with qtbot.waitSignal(dialog.asked) as asked:
        qtbot.mouseClick(dialog.run_button, Qt.MouseButton.LeftButton)
    wanted = BatchRequest("", ("a.png", "gallery:letters"), True, 3, ("1x", "64x32"), "out", 2)
    assert asked.args == [wanted]


def test_it_shows_how_far_it_is(dialog: BatchDialog) -> None:
    dialog.out.setText("out")
    dialog.plan.setText("plan.json")
    dialog.show_running()
    assert dialog.stop_button.isEnabled()
    assert not dialog.run_button.isEnabled()
    assert not dialog.out.isEnabled()
    dialog.show_progress(Progress(7, 1, 16, 125.0, "<b>a.png</b>: is no image."))
    assert dialog.bar.value() == dialog.bar.maximum() // 2
    assert dialog.message.text().startswith("8 of 16, 1 failed, ")
    assert dialog.message.text().endswith("<b>a.png</b>: is no image.")
    dialog.show_result(BatchResult(15, 0, 1, 0, (), "/out/index.html", "/out/report.csv", 20.0))
    assert dialog.message.text().startswith("15 textures in ")
    assert "1 failed" in dialog.message.text()
    assert dialog.page_button.isEnabled()
    assert dialog.run_button.isEnabled()


def test_every_field_has_a_name_and_a_tip(dialog: BatchDialog) -> None:
    for widget in (
        *(dialog.plan, dialog.inputs, dialog.methods, dialog.seeds),
        *(dialog.sizes, dialog.out, dialog.processes),
    ):
        assert widget.accessibleName()
        assert widget.toolTip()
        assert widget.objectName().startswith("batch-")


def test_the_columns_become_the_methods_of_the_plan(explorer: Any) -> None:
    asked = BatchRequest("", ("in",), True, 2, ("1x",), "out", 1)
    data = plan_data(asked, explorer.session)
    assert [each["name"] for each in data["methods"]] == ["heeger-bergen", "heeger-bergen 2"]
    assert [each["set"]["iterations"] for each in data["methods"]] == [2, 1]
    assert data["seeds"] == {"from": explorer.session.state.seed, "count": 2}
    one = plan_data(BatchRequest("", ("in",), False, 1, ("1x",), "out", 1), explorer.session)
    chosen = explorer.session.selected_column
    assert [each["set"] for each in one["methods"]] == [chosen.params.to_json()]


def test_the_further_inputs_of_columns_come_along(explorer: Any, tmp_path: Path, photos: Path) -> None:
    second = as_exemplar("gallery:stochastic-rock", scale=0.25)
    session = explorer.session
    session.set_method(session.state.columns[0].id, "mixture", find_method("mixture").params())
    session.set_inputs(session.state.columns[0].id, (("second", second),), "another")
    data = plan_data(BatchRequest("", (str(photos),), True, 1, ("1x",), "out", 1), session)
    plan = plan_from_json(data, folder=tmp_path)
    assert plan.variants[0].inputs == (("second", second),)


def test_a_batch_runs_beside_the_window(explorer: Any, qtbot: Any, photos: Path, tmp_path: Path) -> None:
    explorer.window.actions_by_name["batch"].trigger()
    dialog = on_screen(qtbot, explorer.handlers.batches.dialog)
    dialog.inputs.setPlainText(str(photos))
    dialog.out.setText(str(tmp_path / "out"))
    dialog.sizes.setText("16x12")
    dialog.processes.setValue(1)
    qtbot.mouseClick(dialog.run_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dialog.page_button.isEnabled())
    assert dialog.message.text().startswith("2 textures in ")
    assert len(list((tmp_path / "out" / "pictures").iterdir())) == 2
    qtbot.waitUntil(lambda: not explorer.handlers.batches.busy)
    # What cannot be done is said in the dialog.
    dialog.inputs.setPlainText(str(photos / "missing.png"))
    qtbot.mouseClick(dialog.run_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: "there is no file or folder" in dialog.message.text())
    assert dialog.run_button.isEnabled()


def test_a_batch_is_stopped_and_goes_on(explorer: Any, qtbot: Any, photos: Path, tmp_path: Path) -> None:
    explorer.window.actions_by_name["batch"].trigger()
    dialog = on_screen(qtbot, explorer.handlers.batches.dialog)
    dialog.inputs.setPlainText(str(photos))
    dialog.out.setText(str(tmp_path / "out"))
    dialog.sizes.setText("16x12")
    dialog.seeds.setValue(2000)
    dialog.processes.setValue(1)
    qtbot.mouseClick(dialog.run_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dialog.bar.value() > 0)
    qtbot.mouseClick(dialog.stop_button, Qt.MouseButton.LeftButton)
    assert dialog.message.text() == "Stopped; run it again to go on."
    qtbot.waitUntil(lambda: not explorer.handlers.batches.busy)
    made = len(list((tmp_path / "out" / "records").iterdir()))
    assert 0 < made < 4000
    dialog.seeds.setValue(1)
    qtbot.mouseClick(dialog.run_button, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: dialog.page_button.isEnabled())
    assert "were done already" in dialog.message.text()
