"""The contact sheet of a sweep: its size, its flow, its file."""

from __future__ import annotations

import pytest
from PIL import Image
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QApplication, QFileDialog, QWidget
from sweep_bench import LEFT, PATIENCE_MS, RECIPE, choose, complete, make_bench  # noqa: F401

from tests.stub_method import StubParams, stub  # noqa: F401
from texlab.docks.sweeps.places import packed
from texlab.style.theme import DARK, LIGHT
from texlab_core.sheets.sweep_sources import find_sweep

pytestmark = pytest.mark.usefixtures("stub")


def test_zoom_with_slider_wheel_and_keys(qtbot, bench):
    dock = bench().dock
    complete(qtbot, dock)
    canvas = dock.sheet.canvas
    before = dock.zoom.value()
    assert canvas.picture_size.width() == before
    qtbot.keyClick(dock.zoom, Qt.Key.Key_Right)
    assert canvas.picture_size.width() == before + 16
    place = QPointF(20, 20)
    for delta, modifier, change in (
        (120, Qt.KeyboardModifier.ControlModifier, 32),
        (-120, Qt.KeyboardModifier.ControlModifier, 16),
        (120, Qt.KeyboardModifier.NoModifier, 16),
    ):
        event = QWheelEvent(
            place, QPointF(canvas.mapToGlobal(place.toPoint())), QPoint(), QPoint(0, delta),
            Qt.MouseButton.NoButton, modifier, Qt.ScrollPhase.NoScrollPhase, False,
        )  # fmt: skip
        QApplication.sendEvent(canvas, event)
        assert canvas.picture_size.width() == before + change
    qtbot.keyClick(canvas, Qt.Key.Key_Minus)
    qtbot.keyClick(canvas, Qt.Key.Key_Minus)
    assert canvas.picture_size.width() == before - 16
    # A size that the user chose stays.
    complete(qtbot, dock)
    assert dock.zoom.value() == before - 16


def test_a_series_flows_and_a_grid_scrolls(qtbot, bench):
    dock = bench().dock
    complete(qtbot, dock)
    canvas = dock.sheet.canvas
    assert canvas.columns > 1
    dock.resize(500, 300)
    QApplication.processEvents()
    assert canvas.width() <= dock.sheet.viewport().width()
    dock.zoom.setValue(dock.zoom.maximum())
    assert canvas.columns == 1
    assert dock.sheet.verticalScrollBar().maximum() > 0
    places = [canvas.rect_of(index) for index in range(6)]
    for index, place in enumerate(places):
        assert canvas.index_at(place.center()) == index
        assert not any(place.intersects(later) for later in places[index + 1 :])
    assert canvas.index_at(QPoint(-5, -5)) is None
    choose(qtbot, dock.panel.down.knob, "border")
    complete(qtbot, dock)
    assert canvas.columns == 6
    assert dock.sheet.horizontalScrollBar().maximum() > 0


def test_a_grid_fits_the_width_at_first(qtbot, bench):
    dock = bench().dock
    choose(qtbot, dock.panel.down.knob, "border")
    complete(qtbot, dock)
    assert dock.sheet.horizontalScrollBar().maximum() == 0


def test_themes(qtbot, bench):
    dock = bench().dock
    complete(qtbot, dock)
    canvas = dock.sheet.canvas
    for theme in (DARK, LIGHT):
        dock.set_theme(theme)
        image = dock.grab().toImage()
        gap = canvas.mapTo(dock, QPoint(1, 1))
        assert image.pixelColor(gap).name() == theme.canvas
        level = image.pixelColor(canvas.mapTo(dock, canvas.rect_of(5).topLeft() + QPoint(20, 20)))
        assert level.lightness() > 230


def test_captions_break_at_commas_then_at_spaces(bench):
    metrics = bench().dock.sheet.canvas.fontMetrics()
    wide = metrics.horizontalAdvance("literal levels 2, beta 1") + 1
    assert packed("literal levels 2, beta 1", wide, metrics) == ["literal levels 2, beta 1"]
    middle = metrics.horizontalAdvance("literal levels 2") + 1
    assert packed("literal levels 2, beta 1", middle, metrics) == ["literal levels 2", "beta 1"]
    narrow = metrics.horizontalAdvance("literal") + 1
    assert packed("literal levels 2", narrow, metrics) == ["literal", "levels", "2"]
    assert packed("", 10, metrics) == []


def test_the_sheet_is_saved_with_its_recipe(qtbot, bench, tmp_path):
    here = bench()
    dock = here.dock
    choose(qtbot, dock.panel.ready_box, "levels")
    complete(qtbot, dock)
    qtbot.mouseClick(dock.save_button, LEFT)
    dialog = dock.findChild(QFileDialog, "sweeps-save-dialog")
    assert dialog.selectedFiles()[0].endswith("noise-stub-level-exact.png")
    path = tmp_path / "sheet"
    dialog.selectFile(str(path))
    with qtbot.waitSignal(here.controller.said, timeout=PATIENCE_MS) as said:
        dialog.accept()
    path = path.with_suffix(".png")
    assert said.args == [f"Saved {path} with its sweep."]
    again = find_sweep(str(path))
    assert again.axes == RECIPE.axes
    assert again.name == "stub-levels"
    assert again.size == (64, 64)
    assert again.params == StubParams(grain=10.0)
    with Image.open(path) as sheet:
        assert sheet.width > 4 * 64
        assert sheet.height > 2 * 64
    qtbot.waitUntil(lambda: not here.controller.busy, timeout=PATIENCE_MS)


def test_a_sheet_that_cannot_be_written_is_one_sentence(qtbot, bench, tmp_path):
    here = bench()
    complete(qtbot, here.dock)
    with qtbot.waitSignal(here.controller.problem, timeout=PATIENCE_MS):
        here.dock.save(str(tmp_path / "missing" / "sheet.png"))
    assert len(here.problems) == 1
    assert "\n" not in here.problems[0]
    assert list(tmp_path.iterdir()) == []
    qtbot.waitUntil(lambda: not here.controller.busy, timeout=PATIENCE_MS)


def test_no_column_is_chosen(qtbot, bench):
    here = bench()
    here.session.remove_column(1)
    qtbot.waitUntil(lambda: here.dock.message is not None)
    assert isinstance(here.dock, QWidget)
