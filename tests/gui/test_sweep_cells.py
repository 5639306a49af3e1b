"""Cells of a sweep: taken, kept, sorted, opened as columns."""

from __future__ import annotations

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QContextMenuEvent
from PySide6.QtWidgets import QApplication, QMenu
from sweep_bench import LEFT, PATIENCE_MS, choose, click_cell, complete, make_bench, set_range  # noqa: F401

from tests.stub_method import StubParams, stub  # noqa: F401
from texlab.docks.sweeps.places import NARROWEST
from texlab.docks.sweeps.words import arranged, sortings
from texlab.state.changes import with_cell
from texlab.state.chosen import Column, State
from texlab.style.theme import LIGHT
from texlab_core.engine.registry import find_method
from texlab_core.measures.registry import measures
from texlab_core.sheets.sweep import Cell, Vary

pytestmark = pytest.mark.usefixtures("stub")


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


def take_seed_3_and_wrap(qtbot, dock):
    """Vary the seed and the border, and click the cell of the third seed and the other border."""
    set_range(qtbot, dock.panel.across, "seed", "1", "4", "4")
    choose(qtbot, dock.panel.down.knob, "border")
    complete(qtbot, dock)
    click_cell(qtbot, dock, 6)


def test_a_varied_seed_is_taken_in_the_same_step(qtbot, bench):
    here = bench()
    dock = here.dock
    take_seed_3_and_wrap(qtbot, dock)
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
    take_seed_3_and_wrap(qtbot, dock)
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
    assert dock.kept == [2]
    assert canvas.describe(2).startswith("Kept: ")
    qtbot.mouseClick(dock.only_kept, LEFT, pos=QPoint(8, dock.only_kept.height() // 2))
    assert canvas.order == [2]
    assert canvas.rect_of(0).isEmpty()
    qtbot.keyClick(canvas, Qt.Key.Key_K)
    assert dock.kept == []
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
    assert dock.kept == [canvas.current]
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
    qtbot.waitUntil(lambda: dock.scene.selected_id == 3)
    click_cell(qtbot, dock, 1)
    assert session.state.column(3).params.level == 0.8
    assert session.state.column(1).params.level == 0.5
    # Beside another method, the column that the sweep was started for takes them.
    session.select(2)
    qtbot.waitUntil(lambda: dock.scene.selected_id == 2)
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
