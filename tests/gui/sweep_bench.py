"""The sweeps dock wired as in the window, and hands for it."""

from __future__ import annotations

import pytest
from bench import DockBench
from PySide6.QtCore import Qt

from texlab.docks.sweeps.dock import SweepsDock
from texlab_core.sheets.sweep import Vary
from texlab_core.sheets.sweep_recipes import SweepRecipe

LEFT = Qt.MouseButton.LeftButton
PATIENCE_MS = 20_000
RECIPE = SweepRecipe(
    name="stub-levels",
    method="stub",
    axes=(Vary("level", (0.5, 1.0, 2.0, 4.0)), Vary("exact", (False, True))),
    parameters={"grain": 10.0},
    note="Levels, doubled.",
    size=(64, 64),
)


@pytest.fixture(name="bench")
def make_bench(qtbot, monkeypatch):
    monkeypatch.setattr(
        "texlab.docks.sweeps.dock.bundled_sweeps", lambda method: (RECIPE,) if method == "stub" else ()
    )
    made = []

    def make(*columns):
        here = DockBench(qtbot, SweepsDock(), 900, 300, columns)
        made.append(here)
        here.begin()
        # The ready-made sweeps come from the dock's own worker.
        qtbot.waitUntil(lambda: here.dock.start_button.isEnabled() and not here.host.busy)
        return here

    yield make
    for each in made:
        each.close()


def choose(qtbot, box, text):
    """Choose an entry of a list with the keyboard, as a user does."""
    place = box.findText(text)
    assert place >= 0, text
    box.setFocus()
    qtbot.keyClick(box, Qt.Key.Key_Home)
    for _ in range(place):
        qtbot.keyClick(box, Qt.Key.Key_Down)
    assert box.currentText() == text


def enter(qtbot, box, text):
    """Type a number into a box."""
    box.setFocus()
    box.selectAll()
    qtbot.keyClicks(box, text)
    qtbot.keyClick(box, Qt.Key.Key_Tab)


def start(qtbot, dock):
    qtbot.mouseClick(dock.start_button, LEFT)


def complete(qtbot, dock):
    before = dock.shown.number
    start(qtbot, dock)
    qtbot.waitUntil(lambda: dock.shown.number > before and dock.shown.status == "finished", timeout=PATIENCE_MS)
    assert dock.panel.error.text() == ""
    assert len(dock.cells) == len(dock.sweep.jobs)


def click_cell(qtbot, dock, index):
    canvas = dock.sheet.canvas
    place = canvas.rect_of(index).center()
    dock.sheet.ensureVisible(place.x(), place.y())
    qtbot.mouseClick(canvas, LEFT, pos=place)


def set_range(qtbot, axis, knob, first, last, count):
    choose(qtbot, axis.knob, knob)
    enter(qtbot, axis.first, first)
    enter(qtbot, axis.last, last)
    enter(qtbot, axis.count, count)
