"""The sweeps dock: axes, recipes, a sheet that fills, cells that are taken, the sheet as a file."""

from __future__ import annotations

import os
import threading
from types import SimpleNamespace

import numpy as np
import pytest
from dock_scenes import check_controls
from PIL import Image
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QContextMenuEvent, QWheelEvent
from PySide6.QtWidgets import QApplication, QFileDialog, QMenu, QWidget

from tests import stub_method
from tests.stub_method import StubParams, exemplar, running, stub  # noqa: F401
from texlab.docks.host import DockHost
from texlab.docks.sweeps.axis import AxisEditor
from texlab.docks.sweeps.dock import SweepsDock, arranged, sortings
from texlab.docks.sweeps.sheet_view import NARROWEST, packed
from texlab.runs.controller import Controller
from texlab.runs.slots import Slots
from texlab.runs.sweep_run import sweep_of
from texlab.state.changes import with_cell
from texlab.state.session import Column, Sample, Session, State
from texlab.state.sweeps import SweepPlan
from texlab.style.theme import DARK, LIGHT
from texlab.window.carrier import Carrier
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.measures.registry import measures
from texlab_core.sheets.sweep import Cell, Vary
from texlab_core.sheets.sweep_recipes import SweepRecipe, bundled_sweeps, find_sweep

pytestmark = pytest.mark.usefixtures("stub")
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


@pytest.fixture
def bench(qtbot, monkeypatch):
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


# Controls


def test_controls_and_widths(bench):
    dock = bench().dock
    check_controls(dock)
    for width in (500, 900, 1900):
        dock.resize(width, 300)
        QApplication.processEvents()
        assert dock.width() == width
        for widget in (dock.start_button, dock.save_button, dock.zoom, dock.panel, dock.sheet):
            corner = widget.mapTo(dock, widget.rect().bottomRight())
            assert corner.x() < width, widget.objectName()
        assert dock.sheet.width() >= 200


def test_the_keyboard_reaches_everything(qtbot, bench):
    dock = bench().dock
    seen = []
    dock.recipe = dock.panel.ready_box
    dock.start_button.setFocus()
    for _ in range(60):
        widget = QApplication.focusWidget()
        seen.append(widget.objectName())
        qtbot.keyClick(widget, Qt.Key.Key_Tab)
        if QApplication.focusWidget() is dock.start_button:
            break
    for name in ("ready", "across-knob", "across-from", "across-to", "across-count", "down-knob", "side", "zoom"):
        assert f"sweeps-{name}" in seen
    assert "sweeps-sheet-canvas" in seen


def test_knobs_and_their_usual_ranges(qtbot, bench):
    axis = bench().dock.panel.across
    assert [axis.knob.itemText(k) for k in range(axis.knob.count())] == [
        "level", "grain", "window", "rounds", "border", "exact", "detail", "seed",
    ]  # fmt: skip
    assert axis.vary() == Vary("level", (0.0, 0.8, 1.6, 2.4, 3.2, 4.0))
    choose(qtbot, axis.knob, "grain")
    assert axis.spacing.currentText() == "log"
    assert axis.vary().values[0] == 0.001
    assert axis.vary().values[-1] == 1000
    choose(qtbot, axis.knob, "window")
    assert all(value % 2 for value in axis.vary().values)
    choose(qtbot, axis.knob, "border")
    assert axis.vary() == Vary("border", ("reflect", "wrap"))
    qtbot.mouseClick(axis.boxes[0], LEFT, pos=QPoint(8, axis.boxes[0].height() // 2))
    assert axis.vary() == Vary("border", ("wrap",))
    choose(qtbot, axis.knob, "exact")
    assert axis.vary() == Vary("exact", (False, True))
    choose(qtbot, axis.knob, "seed")
    assert axis.vary() == Vary("seed", tuple(range(1, 13)))


def test_a_range_becomes_a_list_that_can_be_edited(qtbot, bench):
    axis = bench().dock.panel.across
    set_range(qtbot, axis, "level", "0", "1", "3")
    choose(qtbot, axis.spacing, "list")
    assert axis.listed.isVisible()
    assert not axis.first.isVisible()
    assert axis.listed.text() == "0; 0.5; 1"
    axis.listed.setFocus()
    axis.listed.selectAll()
    qtbot.keyClicks(axis.listed, "2, 0.25,4")
    assert axis.vary() == Vary("level", (2.0, 0.25, 4.0))


@pytest.mark.parametrize("recipe", bundled_sweeps(), ids=lambda recipe: recipe.name)
def test_editors_show_every_bundled_axis(qtbot, recipe):
    editor = AxisEditor("axis", "Across", optional=False)
    qtbot.addWidget(editor)
    editor.show_method(find_method(recipe.method).params)
    for axis in recipe.axes:
        editor.show_vary(axis)
        assert editor.vary() == axis
        left = editor.choice
        editor.choose_knob("seed")
        editor.show_method(find_method(recipe.method).params, left)
        assert editor.vary() == axis


@pytest.mark.parametrize(
    ("values", "spacing"),
    [
        ((0.0, 0.5, 1.0), "even"),
        ((0.1, 0.2, 0.4, 0.8), "log"),
        ((1.0, 0.25, 3.0), "list"),
        ((0.12345, 0.24691), "list"),
        ((1 / 3, 2 / 3), "list"),
        ((2.0,), "even"),
    ],
)
def test_axes_are_shown_in_the_simplest_way(qtbot, values, spacing):
    editor = AxisEditor("axis", "Down", optional=True)
    qtbot.addWidget(editor)
    editor.show_method(StubParams)
    assert editor.vary() is None
    editor.show_vary(Vary("level", values))
    assert editor.spacing.currentData() == spacing
    assert editor.vary() == Vary("level", values)


@pytest.mark.parametrize(
    ("knob", "spacing", "text", "says"),
    [
        ("level", "log", None, "a range above 0 for level"),
        ("level", "list", "a, b", "level: must be a number from 0 to 4"),
        ("level", "list", "9", "level: must be a number from 0 to 4, got 9"),
        ("level", "list", "", "vary: must be NAME"),
        ("window", "list", "4", "an odd whole number"),
    ],
)
def test_what_makes_no_sense_is_said_in_place(qtbot, bench, knob, spacing, text, says):
    dock = bench().dock
    axis = dock.panel.across
    choose(qtbot, axis.knob, knob)
    choose(qtbot, axis.spacing, spacing)
    if text is not None:
        axis.listed.setFocus()
        axis.listed.selectAll()
        qtbot.keyClick(axis.listed, Qt.Key.Key_Delete)
        qtbot.keyClicks(axis.listed, text)
    start(qtbot, dock)
    qtbot.waitUntil(lambda: says in dock.panel.error.text())
    assert dock.panel.error.isVisible()
    assert dock.sweep is None
    choose(qtbot, axis.knob, "exact")
    assert not dock.panel.error.isVisible()


def test_the_same_knob_twice_and_no_choice(qtbot, bench):
    dock = bench().dock
    choose(qtbot, dock.panel.down.knob, "level")
    start(qtbot, dock)
    qtbot.waitUntil(lambda: "got level twice" in dock.panel.error.text())
    choose(qtbot, dock.panel.down.knob, "border")
    for box in dock.panel.down.boxes:
        qtbot.keyClick(box, Qt.Key.Key_Space)
    start(qtbot, dock)
    qtbot.waitUntil(lambda: "at least one choice of border" in dock.panel.error.text())


def test_too_many_pixels_are_refused(bench):
    here = bench()
    state, column = here.session.state, here.session.selected_column
    plan = SweepPlan((Vary("seed", tuple(range(400))),), 512)
    with pytest.raises(InputError, match="400 cells of 512 x 512 are more than 32 megapixels"):
        sweep_of(plan, state, column, exemplar())


# Runs


def test_every_cell_is_what_the_core_makes(qtbot, bench):
    here = bench()
    dock = here.dock
    set_range(qtbot, dock.panel.across, "level", "0", "2", "3")
    choose(qtbot, dock.panel.down.knob, "border")
    choose(qtbot, dock.panel.side_box, "64 x 64")
    complete(qtbot, dock)
    assert dock.heading.text() == "Stub: level across, border down · noise, 64 x 64, seed 5"
    assert dock.sheet.canvas.columns == 3
    assert [dock.cells[k].cell.label for k in (0, 5)] == [
        "level 0, border reflect, V 0.68, copied 0%, candidates 7",
        "level 2, border wrap, V 0.68, copied 50%, candidates 7",
    ]
    for index, shown in dock.cells.items():
        job = dock.sweep.jobs[index]
        assert job.params == StubParams(level=(0, 1, 2)[index % 3], border=("reflect", "wrap")[index // 3])
        alone = run(job).image
        assert np.array_equal(shown.cell.result.image, alone)
        assert shown.picture.shape == (64, 64, 3)
    assert dock.status.text().startswith("6 of 6")
    assert dock.save_button.isEnabled()
    assert not dock.stop_button.isEnabled()
    # Nothing of the session has changed.
    assert here.session.undo_text is None


def test_the_size_of_the_columns(qtbot, bench):
    dock = bench().dock
    choose(qtbot, dock.panel.side_box, "as the columns")
    complete(qtbot, dock)
    assert dock.sweep.base.size == (24, 32)
    size = dock.sheet.canvas.picture_size
    assert size.width() * 3 == pytest.approx(size.height() * 4, abs=3)


class Gate:
    """Lets so many cells of the stub finish, and holds those that begin later until it is opened."""

    def __init__(self, monkeypatch, count):
        self._opened, self._count = threading.Event(), count
        monkeypatch.setattr(stub_method, "time", SimpleNamespace(sleep=self._nap))

    def _nap(self, _):
        here = threading.get_ident()
        # Threads are used again: the cell at work is the last one that this thread has begun.
        if max(place for place, thread in enumerate(running) if thread == here) >= self._count:
            self._opened.wait(PATIENCE_MS / 1000)

    def open(self):
        self._opened.set()


def sweep_threads():
    return [each.name for each in threading.enumerate() if each.name.startswith("sweep")]


def test_the_sheet_fills_while_it_runs_and_stops_at_once(qtbot, bench, monkeypatch):
    # The first three cells finish; those after them wait for as long as the test likes.
    here = bench(Column(1, "stub", StubParams(rounds=100)))
    dock = here.dock
    set_range(qtbot, dock.panel.across, "seed", "1", "40", "40")
    running.clear()
    gate = Gate(monkeypatch, 3)
    start(qtbot, dock)
    qtbot.waitUntil(dock.stop_button.isEnabled)
    assert dock.progress.isVisible()
    qtbot.waitUntil(lambda: len(dock.cells) == 3, timeout=PATIENCE_MS)
    assert dock.sheet.canvas.describe(39) == "seed 40: not finished yet"
    qtbot.waitUntil(lambda: "left" in dock.status.text(), timeout=PATIENCE_MS)
    qtbot.mouseClick(dock.stop_button, LEFT)
    qtbot.waitUntil(lambda: "stopped" in dock.status.text())
    gate.open()
    qtbot.waitUntil(lambda: not dock.running, timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: not sweep_threads(), timeout=PATIENCE_MS)
    # Nothing begins any more: what is counted stays so.
    begun = len(running)
    assert len(dock.cells) == 3 <= begun < 40
    assert not dock.progress.isVisible()
    qtbot.waitUntil(lambda: not dock.stop_button.isEnabled())
    # What is there can be used, and another sweep can be started.
    assert dock.save_button.isEnabled()
    enter(qtbot, dock.panel.across.count, "2")
    complete(qtbot, dock)
    assert len(running) == begun + 2


def test_keys_start_and_stop(qtbot, bench):
    dock = bench(Column(1, "stub", StubParams(rounds=200))).dock
    dock.panel.across.knob.setFocus()
    qtbot.keyClick(dock.panel.across.knob, Qt.Key.Key_Return, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: dock.running)
    qtbot.keyClick(dock.panel.across.knob, Qt.Key.Key_Escape)
    qtbot.waitUntil(lambda: not dock.running, timeout=PATIENCE_MS)
    assert "stopped" in dock.status.text()


def test_a_second_start_replaces_the_first(qtbot, bench):
    dock = bench(Column(1, "stub", StubParams(rounds=200))).dock
    start(qtbot, dock)
    qtbot.waitUntil(lambda: dock.running)
    first = dock.sweep
    choose(qtbot, dock.panel.across.knob, "border")
    start(qtbot, dock)
    qtbot.waitUntil(lambda: dock.sweep is not first)
    qtbot.waitUntil(lambda: not dock.running, timeout=PATIENCE_MS)
    assert [dock.cells[k].cell.values["border"] for k in (0, 1)] == ["reflect", "wrap"]


def test_cells_wait_for_the_places_of_the_columns(qtbot, bench):
    here = bench()
    slots = here.controller.slots
    count = max(1, os.cpu_count() or 1)
    assert all(slots.acquire(lambda: False) for _ in range(count))
    running.clear()
    start(qtbot, here.dock)
    qtbot.waitUntil(lambda: here.dock.running)
    qtbot.wait(50)
    assert running == []
    slots.release()
    qtbot.waitUntil(lambda: not here.dock.running, timeout=PATIENCE_MS)
    # The thread that loads methods in advance may have come by; it needs no place.
    warming = {each.ident for each in threading.enumerate() if each.name == "texlab-warming"}
    assert len([each for each in running if each not in warming]) == 6
    # A sweep that waits can be stopped as well.
    assert slots.acquire(lambda: False)
    start(qtbot, here.dock)
    qtbot.waitUntil(lambda: here.dock.running)
    here.dock.stop()
    qtbot.waitUntil(lambda: not here.dock.running, timeout=PATIENCE_MS)
    for _ in range(count):
        slots.release()


def test_closing_joins_a_sweep_that_runs(qtbot, bench):
    here = bench(Column(1, "stub", StubParams(rounds=500)))
    start(qtbot, here.dock)
    qtbot.waitUntil(lambda: here.dock.running)
    here.host.close()
    here.controller.close()
    assert not [each for each in threading.enumerate() if each.name.startswith(("sweep", "texlab-sweep"))]


def test_without_an_exemplar_nothing_starts(qtbot, bench):
    here = bench()
    here.controller._preparation.prepared = None
    start(qtbot, here.dock)
    qtbot.waitUntil(lambda: here.dock.panel.error.text() == "There is no exemplar yet.")


# Cells


def test_a_click_takes_a_cell_as_one_step(qtbot, bench):
    here = bench()
    dock, session = here.dock, here.session
    set_range(qtbot, dock.panel.across, "level", "0", "2", "3")
    choose(qtbot, dock.panel.down.knob, "exact")
    complete(qtbot, dock)
    click_cell(qtbot, dock, 2)
    assert here.params == StubParams(level=2.0, exact=False)
    assert session.undo_text == "sweep level 2, exact no"
    qtbot.waitUntil(lambda: dock.sheet.canvas.marked == 2)
    qtbot.waitUntil(lambda: not here.controller.busy, timeout=PATIENCE_MS)
    session.undo()
    assert here.params == StubParams()
    assert session.undo_text is None
    session.redo()
    qtbot.waitUntil(lambda: dock.sheet.canvas.marked == 2, timeout=PATIENCE_MS)
    # Another knob is turned: no cell is like this.
    session.set_params(1, here.params.replace(grain=7.0), "grain")
    qtbot.waitUntil(lambda: dock.sheet.canvas.marked is None, timeout=PATIENCE_MS)


def test_a_varied_seed_is_taken_in_the_same_step(qtbot, bench):
    here = bench()
    dock = here.dock
    set_range(qtbot, dock.panel.across, "seed", "1", "4", "4")
    choose(qtbot, dock.panel.down.knob, "border")
    complete(qtbot, dock)
    click_cell(qtbot, dock, 6)
    assert here.session.state.seed == 3
    assert here.params.border == "wrap"
    qtbot.waitUntil(lambda: not here.controller.busy, timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: dock.sheet.canvas.marked == 6, timeout=PATIENCE_MS)
    here.session.undo()
    assert here.session.state.seed == 5
    assert here.params == StubParams()


def test_a_varied_seed_is_that_of_a_column_with_its_own(qtbot, bench):
    here = bench()
    dock = here.dock
    here.session.set_column_seed(1, 9)
    set_range(qtbot, dock.panel.across, "seed", "1", "4", "4")
    choose(qtbot, dock.panel.down.knob, "border")
    complete(qtbot, dock)
    click_cell(qtbot, dock, 6)
    assert (here.session.state.seed, here.session.state.column(1).seed) == (5, 3)
    qtbot.waitUntil(lambda: dock.sheet.canvas.marked == 6, timeout=PATIENCE_MS)


def test_the_keyboard_takes_a_cell(qtbot, bench):
    here = bench()
    dock = here.dock
    set_range(qtbot, dock.panel.across, "level", "0", "2", "3")
    choose(qtbot, dock.panel.down.knob, "border")
    complete(qtbot, dock)
    canvas = dock.sheet.canvas
    canvas.setFocus()
    for key in (Qt.Key.Key_Right, Qt.Key.Key_Down, Qt.Key.Key_Down, Qt.Key.Key_Left, Qt.Key.Key_Right):
        qtbot.keyClick(canvas, key)
    assert canvas.current == 4
    assert (
        canvas.accessibleDescription()
        == "level 1, border wrap, V 0.68, copied 25%, candidates 7. Click to take the parameters."
    )
    qtbot.keyClick(canvas, Qt.Key.Key_Return)
    assert here.params == StubParams(level=1.0, border="wrap")
    qtbot.keyClick(canvas, Qt.Key.Key_End)
    assert canvas.current == 5
    qtbot.keyClick(canvas, Qt.Key.Key_Home)
    qtbot.keyClick(canvas, Qt.Key.Key_Space)
    assert here.params == StubParams(level=0.0)


def test_a_grid_has_headings_and_a_series_captions(qtbot, bench):
    here = bench()
    dock = here.dock
    canvas = dock.sheet.canvas
    set_range(qtbot, dock.panel.across, "level", "0", "2", "3")
    complete(qtbot, dock)
    assert canvas.headings is None
    assert canvas._caption(1) == "level 1"
    first = canvas.rect_of(0)
    choose(qtbot, dock.panel.down.knob, "border")
    complete(qtbot, dock)
    assert canvas.headings == (["level 0", "level 1", "level 2"], ["border reflect", "border wrap"])
    assert canvas._caption(1) == ""
    widest = max(canvas.fontMetrics().horizontalAdvance(text) for text in canvas.headings[1])
    assert canvas.rect_of(0).left() >= min(widest, NARROWEST)
    assert canvas.rect_of(0).top() >= first.top() + canvas.fontMetrics().lineSpacing()
    for index in range(6):
        assert canvas.index_at(canvas.rect_of(index).center()) == index
    assert canvas.index_at(QPoint(2, canvas.rect_of(0).center().y())) is None


def test_cells_become_columns_and_are_kept(qtbot, bench):
    here = bench()
    dock, session, canvas = here.dock, here.session, here.dock.sheet.canvas
    set_range(qtbot, dock.panel.across, "seed", "3", "5", "3")
    complete(qtbot, dock)
    middle = Qt.MouseButton.MiddleButton
    qtbot.mouseClick(canvas, middle, pos=canvas.rect_of(0).center())
    assert [(each.id, each.method, each.seed) for each in session.state.columns] == [
        (1, "stub", None),
        (2, "stub", 3),
    ]
    assert here.params == StubParams()
    assert session.undo_text == "column of a sweep"
    # The seed of all columns needs no lock.
    canvas.setFocus()
    qtbot.keyClick(canvas, Qt.Key.Key_End)
    qtbot.keyClick(canvas, Qt.Key.Key_N)
    assert [each.seed for each in session.state.columns] == [None, None, 3]
    qtbot.keyClick(canvas, Qt.Key.Key_K)
    assert dock.kept == {2}
    assert canvas.describe(2).startswith("Kept: ")
    qtbot.mouseClick(dock.only_kept, LEFT, pos=QPoint(8, dock.only_kept.height() // 2))
    assert canvas.order == [2]
    assert canvas.rect_of(0).isEmpty()
    qtbot.keyClick(canvas, Qt.Key.Key_K)
    assert dock.kept == set()
    assert canvas.order == []
    assert dock.only_kept.isEnabled()
    qtbot.mouseClick(dock.only_kept, LEFT, pos=QPoint(8, dock.only_kept.height() // 2))
    assert canvas.order == [0, 1, 2]
    assert not dock.only_kept.isEnabled()
    # The menu of a cell, opened from the keyboard.
    event = QContextMenuEvent(QContextMenuEvent.Reason.Keyboard, QPoint(), canvas.mapToGlobal(QPoint()))
    QApplication.sendEvent(canvas, event)
    menu = canvas.findChild(QMenu, "sweeps-cell-menu")
    assert [each.text().partition("\t")[0] for each in menu.actions()] == [
        "&Take the parameters", "Open as a &new column", "&Keep",
    ]  # fmt: skip
    menu.actions()[2].trigger()
    assert dock.kept == {canvas.current}
    menu.close()
    qtbot.waitUntil(lambda: not here.controller.busy, timeout=PATIENCE_MS)


def test_cells_are_sorted_by_a_measure(qtbot, bench):
    here = bench()
    dock, canvas = here.dock, here.dock.sheet.canvas
    set_range(qtbot, dock.panel.across, "level", "0", "2", "3")
    choose(qtbot, dock.panel.down.knob, "border")
    complete(qtbot, dock)
    title = measures()["visual-difference"].title
    choose(qtbot, dock.sorting, f"by {title}")
    dock.sorting.activated.emit(dock.sorting.currentIndex())
    values = [dock.cells[index].cell.measures["visual-difference"] for index in canvas.order]
    assert sorted(canvas.order) == list(range(6))
    assert values == sorted(values, reverse=True)
    assert not canvas._heads[0]
    last = canvas.order[-1]
    click_cell(qtbot, dock, last)
    assert here.params == dock.sweep.jobs[last].params
    choose(qtbot, dock.sorting, "as varied")
    dock.sorting.activated.emit(0)
    assert canvas.order == list(range(6))
    qtbot.waitUntil(lambda: not here.controller.busy, timeout=PATIENCE_MS)


def test_the_order_of_cells() -> None:
    def cell(**measures):
        return Cell(index=0, job=None, values={}, measures=measures)

    lower = next(id for id, each in measures().items() if each.better == "lower")
    higher = next(id for id, each in measures().items() if each.better == "higher")
    values = {0: 0.3, 1: 0.1, 3: 0.2}
    cells = {index: cell(**{lower: value, higher: value}) for index, value in values.items()}
    assert arranged(5, cells, None, None) is None
    assert arranged(5, cells, lower, None) == [1, 3, 0, 2, 4]
    assert arranged(5, cells, higher, None) == [0, 3, 1, 2, 4]
    assert arranged(5, cells, higher, {1, 2, 3}) == [3, 1, 2]
    assert arranged(5, cells, None, {3, 1}) == [1, 3]
    assert arranged(5, cells, None, ()) == []
    assert [id for _, id in sortings(cells.values())] == [id for id in measures() if id in (lower, higher)]


def test_a_failed_cell_says_why_and_is_not_taken(qtbot, bench):
    here = bench()
    dock = here.dock
    set_range(qtbot, dock.panel.across, "level", "2", "4", "3")
    complete(qtbot, dock)
    assert dock.status.text().startswith("3 of 3 · 1 failed")
    assert dock.cells[1].picture is None
    assert dock.sheet.canvas.describe(1) == "level 3: level: 3 is what this stub fails at."
    plain = dock.grab().toImage()
    area = dock.sheet.canvas.rect_of(1)
    where = dock.sheet.canvas.mapTo(dock, area.topLeft())
    found = {
        plain.pixelColor(where.x() + x, where.y() + y).name()
        for x in range(area.width())
        for y in range(dock.sheet.canvas.picture_size.height())
    }
    assert LIGHT.error in found
    click_cell(qtbot, dock, 1)
    assert here.session.undo_text is None
    click_cell(qtbot, dock, 2)
    assert here.params.level == 4.0


def test_other_columns_take_the_cells(qtbot, bench):
    other = find_method("heeger-bergen").params(scales=1, iterations=1)
    here = bench(
        Column(1, "stub", StubParams()), Column(2, "heeger-bergen", other), Column(3, "stub", StubParams())
    )
    dock, session = here.dock, here.session
    complete(qtbot, dock)
    session.select(3)
    qtbot.waitUntil(lambda: dock._column.id == 3)
    click_cell(qtbot, dock, 1)
    assert session.state.column(3).params.level == 0.8
    assert session.state.column(1).params.level == 0.5
    # Beside another method, the column that the sweep was started for takes them.
    session.select(2)
    qtbot.waitUntil(lambda: dock._column.id == 2)
    assert dock.sheet.canvas.marked is None
    click_cell(qtbot, dock, 2)
    assert session.state.column(1).params.level == 1.6
    assert session.selected_id == 1
    for column in (1, 3):
        session.remove_column(column)
    qtbot.waitUntil(lambda: not here.controller.busy, timeout=PATIENCE_MS)
    click_cell(qtbot, dock, 3)
    assert here.problems == ["No column runs Stub any more; add one to take the parameters."]


def test_what_was_chosen_for_a_method_comes_back(qtbot, bench):
    other = find_method("heeger-bergen").params(scales=1, iterations=1)
    here = bench(Column(1, "stub", StubParams()), Column(2, "heeger-bergen", other))
    panel = here.dock.panel
    set_range(qtbot, panel.across, "level", "1", "3", "5")
    choose(qtbot, panel.down.knob, "border")
    qtbot.keyClick(panel.down.boxes[1], Qt.Key.Key_Space)
    wanted = panel.plan().axes
    here.session.select(2)
    qtbot.waitUntil(lambda: panel.across.knob.findText("iterations") >= 0)
    assert panel.ready_box.currentText() == "none for this method"
    here.session.select(1)
    qtbot.waitUntil(lambda: panel.across.knob.findText("grain") >= 0)
    assert panel.plan().axes == wanted == (Vary("level", (1.0, 1.5, 2.0, 2.5, 3.0)), Vary("border", ("reflect",)))


def test_with_cell_finds_a_column(bench, qtbot):
    here = bench()
    complete(qtbot, here.dock)
    cell = here.dock.cells[2].cell
    state = here.session.state
    changed, column = with_cell(state, cell, (99, 1))
    assert column == 1
    assert changed.column(1).params == cell.job.params
    assert changed.seed == state.seed
    assert with_cell(State(), cell, (1,)) is None


# Recipes


def test_a_recipe_sets_knobs_and_offers_its_parameters(qtbot, bench):
    here = bench(Column(1, "stub", StubParams(rounds=3, grain=2.0)))
    dock = here.dock
    choose(qtbot, dock.panel.ready_box, "levels")
    plan = dock.panel.plan()
    assert plan.axes == RECIPE.axes
    assert plan.side == 64
    assert plan.params == StubParams(grain=10.0)
    assert dock.panel.across.spacing.currentText() == "log"
    assert [dock.panel.base_box.itemText(k) for k in range(2)] == ["as in the column", "defaults, grain 10"]
    complete(qtbot, dock)
    assert dock.sweep.jobs[1].params == StubParams(grain=10.0, level=1.0, exact=False)
    choose(qtbot, dock.panel.base_box, "as in the column")
    complete(qtbot, dock)
    assert dock.sweep.jobs[1].params == StubParams(rounds=3, grain=2.0, level=1.0, exact=False)
    # Own values: no longer the recipe, but its parameters stay on offer.
    enter(qtbot, dock.panel.across.count, "2")
    assert dock.panel.ready_box.currentText() == "own choice"
    assert dock.panel.base_box.count() == 2
    choose(qtbot, dock.panel.ready_box, "levels")
    assert dock.panel.plan().axes == RECIPE.axes


def test_own_choice_after_a_recipe(qtbot, bench):
    dock = bench().dock
    choose(qtbot, dock.panel.ready_box, "levels")
    choose(qtbot, dock.panel.ready_box, "own choice")
    assert dock.panel.plan().params is None
    assert not dock.panel.base_box.isEnabled()


# The sheet


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
