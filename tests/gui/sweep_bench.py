"""The sweeps dock wired as in the window, and hands for it."""

from __future__ import annotations

import pytest
from PySide6.QtCore import Qt

from tests.stub_method import StubParams, exemplar
from texlab.docks.host import DockHost
from texlab.docks.sweeps.dock import SweepsDock
from texlab.runs.controller import Controller
from texlab.runs.slots import Slots
from texlab.state.chosen import Column, Sample, State
from texlab.state.session import Session
from texlab.style.theme import LIGHT
from texlab.window.carrier import Carrier
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


class Bench:
    """A session, a controller and the dock, wired as in the window."""

    def __init__(self, qtbot, *columns):
        self.session = Session()
        self.controller = Controller(self.session)
        self.dock = SweepsDock()
        self.host = DockHost(self.dock, Slots(1))
        self.carrier = Carrier(
            self.controller,
            self.session.select,
            lambda source: None,
            lambda marks: None,
            lambda dock, how: None,
            print,
            lambda name, beside: None,
            lambda name, settings: None,
        )
        self.dock.intention.connect(self.carrier.carry_out)
        self.controller.scene_changed.connect(self.host.show_scene)
        self.problems = []
        self.controller.problem.connect(self.problems.append)
        qtbot.addWidget(self.dock)
        self.dock.set_theme(LIGHT)
        self.dock.resize(900, 300)
        self.dock.show()
        qtbot.waitExposed(self.dock)
        given = columns or (Column(1, "stub", StubParams()),)
        self.session.apply(State(None, given, 5, (24, 32), len(given) + 1), "start")
        self.session.select(given[0].id)
        self.session.set_sample(Sample(exemplar()))
        self.session.reset_history()
        qtbot.waitUntil(lambda: not self.controller.busy, timeout=PATIENCE_MS)
        qtbot.waitUntil(lambda: self.dock.start_button.isEnabled(), timeout=PATIENCE_MS)

    @property
    def params(self):
        return self.session.selected_column.params

    def close(self):
        self.host.close()
        self.controller.close()
        self.controller.deleteLater()


@pytest.fixture(name="bench")
def make_bench(qtbot, monkeypatch):
    monkeypatch.setattr(
        "texlab.docks.sweeps.dock.bundled_sweeps", lambda method: (RECIPE,) if method == "stub" else ()
    )
    made = []

    def make(*columns):
        made.append(Bench(qtbot, *columns))
        return made[-1]

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
