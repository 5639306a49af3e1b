"""The sweeps dock: axes, ready-made sweeps, and what makes no sense."""

from __future__ import annotations

import pytest
from dock_scenes import check_controls
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication
from sweep_bench import LEFT, PATIENCE_MS, RECIPE, choose, complete, enter, make_bench, set_range, start  # noqa: F401

from tests.stub_method import StubParams, exemplar, stub  # noqa: F401
from texlab.docks.sweeps.axis import AxisEditor
from texlab.runs.sweep_run import sweep_of
from texlab.state.chosen import Column
from texlab.state.sweeps import SweepPlan
from texlab_core.engine.registry import find_method
from texlab_core.errors import InputError
from texlab_core.sheets.sweep import Vary
from texlab_core.sheets.sweep_sources import bundled_sweeps

pytestmark = pytest.mark.usefixtures("stub")


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
        "level", "grain", "window", "rounds", "border", "exact", "detail", "seed", "texture",
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


def test_a_ready_made_sweep_is_chosen_by_name_now_or_when_it_is_offered(qtbot, bench):
    other = find_method("heeger-bergen").params(scales=1, iterations=1)
    here = bench(Column(1, "heeger-bergen", other), Column(2, "stub", StubParams()))
    dock, panel = here.dock, here.dock.panel
    assert dock.take_settings({"ready-made": RECIPE.name}) == ()
    assert panel.chosen_sweep is None
    here.session.select(2)
    qtbot.waitUntil(lambda: panel.chosen_sweep == RECIPE, timeout=PATIENCE_MS)
    assert panel.plan().axes == RECIPE.axes
    assert panel.plan().params == RECIPE.params
    # At once, where it is offered; what the user chooses meanwhile stays.
    choose(qtbot, panel.ready_box, "own choice")
    dock.take_settings({"ready-made": RECIPE.name})
    assert panel.chosen_sweep == RECIPE
    dock.take_settings({"ready-made": "of-another-method"})
    choose(qtbot, panel.ready_box, "own choice")
    panel.show_sweeps((RECIPE,))
    assert panel.chosen_sweep is None


def test_own_choice_after_a_recipe(qtbot, bench):
    dock = bench().dock
    choose(qtbot, dock.panel.ready_box, "levels")
    choose(qtbot, dock.panel.ready_box, "own choice")
    assert dock.panel.plan().params is None
    assert not dock.panel.base_box.isEnabled()
