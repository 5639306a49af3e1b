"""The threshold editor: what it changes, under mouse and keyboard, alone and in the window."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from de_bonet_scenes import exemplar, finished, scene
from dock_scenes import check_controls, feed, shown
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QAction, QKeySequence
from threshold_hand import Hand

from tests.gui.conftest import drag, move, wait_idle
from texlab.docks.thresholds import knob
from texlab.docks.thresholds.distance_view import SCALE, Distances
from texlab.docks.thresholds.dock import ThresholdsDock
from texlab.docks.thresholds.selection import Selection
from texlab.docks.thresholds.table import (
    Axes,
    KnownAxes,
    SoftLog,
    cell_text,
    make_heads,
    make_view,
    mirrored,
    moved,
    table_field,
)
from texlab.form.form import ParameterForm
from texlab.state.intentions import EditField
from texlab.style.theme import DARK, LIGHT
from texlab_core.engine.registry import methods
from texlab_core.methods.de_bonet.distances import feature_distances
from texlab_core.methods.de_bonet.params import DeBonetParams
from texlab_core.methods.de_bonet.thresholds import ThresholdTable

CONTROL = Qt.KeyboardModifier.ControlModifier
SHIFT = Qt.KeyboardModifier.ShiftModifier
ALT = Qt.KeyboardModifier.AltModifier
LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def axes():
    return Axes.of(finished().result.model)


# Pure functions.


def test_numbers_in_cells_are_scientific_only_when_they_must_be():
    values = (0, 0.15, 0.0342, 0.001, 1.25, 12.345, 1234.0, 9999.0, 12345.0, 0.00034, 1e6, 0.5)
    assert [cell_text(value) for value in values] == [
        "0", "0.15", "0.0342", "0.001", "1.25", "12.3", "1234", "9999", "1.2e4", "3.4e-4", "1e6", "0.5",
    ]  # fmt: skip
    assert cell_text(0.0342, 1) == "0.03"
    assert cell_text(0.00034, 1) == "3e-4"


def test_a_drag_multiplies_and_zero_is_reached_and_left():
    assert moved(0.1, math.log(2)) == 0.2
    assert moved(2.0, -math.log(4)) == 0.5
    assert moved(0.1, -20) == 0
    assert moved(0, -1) == 0
    assert moved(0, 0.01) > 0
    assert moved(1e6, 5) == 1e6


def test_the_soft_logarithm_has_a_zero_and_an_inverse():
    scale = SoftLog(0.01, 4)
    assert scale.place([0, 4, 9]).tolist() == [0, 1, 1]
    for value in (0.0, 0.003, 0.2, 3.0):
        assert scale.value(float(scale.place(value))) == pytest.approx(value, abs=1e-12)


def test_columns_are_grouped_by_channel_or_by_kind(axes):
    each = make_heads(axes.features, "each")
    assert [head.group for head in each] == ["red"] * 9 + ["green"] * 9 + ["blue"] * 9
    assert {feature.name for head in each for feature in head.features} == {each.name for each in axes.features}
    together = make_heads(axes.features, "together")
    assert [head.group for head in together] == ["band"] + ["first derivatives"] * 4 + ["second derivatives"] * 4
    assert all([each.channel for each in head.features] == ["red", "green", "blue"] for head in together)


def test_a_view_holds_the_matrix_that_the_method_uses(axes):
    table = ThresholdTable((((1, "red/first-45"), 0.5), ((2, "blue/laplacian"), 0.0)))
    view = make_view(axes, "each", table, (0.3, 0.7))
    names = [head.first.name for head in view.heads]
    assert np.array_equal(view.values.astype(np.float32), table.matrix(0.3, 0.7, axes.depth, names))
    assert view.changed.sum() == 2
    assert view.changed[0, names.index("red/first-45")]
    together = make_view(axes, "together", table, (0.3, 0.7))
    assert together.mixed.sum() == 2


def test_mirroring_copies_theta_to_180_minus_theta(axes):
    table = ThresholdTable((((1, "red/first-45"), 0.5), ((1, "red/first-135"), 0.7)))
    view = make_view(axes, "each", table, (0.1, 0))
    assert mirrored(view, [(1, "red/first-45")]) == {(1, "red/first-135"): 0.5}
    assert mirrored(view, [(1, "red/first-135")]) == {(1, "red/first-45"): 0.7}
    both = [(1, "red/first-45"), (1, "red/first-135"), (1, "red/first-0"), (1, "red/laplacian")]
    assert mirrored(view, both) == {(1, "red/first-135"): 0.5}


def test_the_table_is_found_by_its_type():
    assert table_field(DeBonetParams()) == "thresholds"
    assert all(table_field(each.params()) is None for each in methods().values() if each.id != "de-bonet")


def test_axes_stay_known_while_a_column_runs():
    known, column = KnownAxes(), finished()
    assert known.of(dataclasses.replace(column, result=None)) is None
    axes = known.of(column)
    assert known.of(dataclasses.replace(column, result=None)) is axes
    assert axes.depth == column.result.model.depth


def test_shares_that_pass():
    model = finished().result.model
    distances = Distances.of(model, 1, 3)
    values = feature_distances(model, 1, 3)
    assert distances.shares.sum() == pytest.approx(1)
    for threshold in (0.0, 0.15, 1.0):
        assert distances.passing(threshold) == pytest.approx(np.mean(values <= np.float32(threshold)))
    middle = 40
    edge = np.float32(SCALE.value(middle / len(distances.shares)))
    assert distances.shares[:middle].sum() == pytest.approx(np.mean(values <= edge))


# The dock alone.


@pytest.fixture
def hand(qtbot):
    return Hand(qtbot)


def test_controls(hand):
    check_controls(hand.dock)
    for widget in (hand.editor, hand.dock.distances):
        assert widget.toolTip()
        assert widget.accessibleName()
        assert widget.focusPolicy() & Qt.FocusPolicy.TabFocus


def test_a_cell_is_dragged_up_and_to_the_side(hand):
    hand.drag(1, 2, 0, -60)
    name = hand.editor.view.heads[2].first.name
    assert hand.table.cells == (((2, name), pytest.approx(0.15 * math.e, rel=0.01)),)
    assert [final for _, final in hand.edits] == [False, False, True]
    hand.drag(1, 2, -60, 0)
    assert hand.table.get(2, name) == pytest.approx(0.15, rel=0.01)


def test_shift_drags_finely(hand, qtbot):
    from PySide6.QtCore import QEvent, QPointF
    from PySide6.QtGui import QMouseEvent
    from PySide6.QtWidgets import QApplication

    start = hand.at(0, 0)
    qtbot.mousePress(hand.editor, LEFT, SHIFT, start)
    end = QPointF(start - QPoint(0, 80))
    event = QMouseEvent(QEvent.Type.MouseMove, end, end, Qt.MouseButton.NoButton, LEFT, SHIFT)
    QApplication.sendEvent(hand.editor, event)
    qtbot.mouseRelease(hand.editor, LEFT, SHIFT, end.toPoint())
    assert hand.table.cells[0][1] == pytest.approx(0.15 * math.exp(10 / 60), rel=0.01)


def test_the_head_of_a_row_scales_the_row_and_keeps_its_ratios(hand):
    hand.editor.select(Selection.cell(0, 4))
    hand.editor.set_value(0.6)
    hand.drag(0, -1, 0, -60)
    values = hand.editor.view.values[0]
    assert values[4] / values[0] == pytest.approx(4, rel=0.02)
    assert values[0] == pytest.approx(0.15 * math.e, rel=0.01)
    assert len(hand.table.cells) == 27
    assert not hand.editor.view.changed[1:].any()


def test_the_head_of_a_column_scales_the_column(hand):
    hand.drag(-1, 3, 0, 60)
    view = hand.editor.view
    assert view.changed[:, 3].all()
    assert not np.delete(view.changed, 3, axis=1).any()
    assert view.values[:, 3] == pytest.approx(0.15 / math.e, rel=0.01)


def test_a_drag_that_comes_back_changes_nothing(hand, qtbot):
    start = hand.at(1, 1)
    drag(qtbot, hand.editor, [start, start - QPoint(0, 30), start])
    assert hand.table == ThresholdTable()


def test_a_scene_that_lags_behind_does_not_undo_a_drag(hand, qtbot):
    start = hand.at(1, 1)
    qtbot.mousePress(hand.editor, LEFT, pos=start)
    from tests.gui.conftest import move

    move(qtbot, hand.editor, start - QPoint(0, 60))
    dragged = hand.editor.view.values[1, 1]
    feed(hand.dock, scene(finished()))
    assert hand.editor.view.values[1, 1] == dragged > 0.3
    qtbot.mouseRelease(hand.editor, LEFT, pos=start - QPoint(0, 60))
    assert hand.table.cells[0][1] == dragged


def test_painting_over_cells_is_one_step(hand, qtbot):
    hand.key(Qt.Key.Key_P)
    assert hand.dock.paint.isChecked()
    hand.dock.value.setValue(0.42)
    assert hand.table == ThresholdTable()
    drag(qtbot, hand.editor, [hand.at(0, 0), hand.at(0, 1), hand.at(1, 2)])
    assert sorted(value for _, value in hand.table.cells) == [0.42] * 3
    assert [final for _, final in hand.edits] == [False, False, False, True]
    hand.click(0, 0, ALT)
    assert hand.dock.value.value() == 0.42
    hand.dock.paint.setChecked(False)
    assert not hand.editor.painting


def test_locked_cells_are_not_changed(hand):
    hand.click(0, 0)
    hand.key(Qt.Key.Key_L)
    hand.drag(0, -1, 0, -40)
    name = hand.editor.view.heads[0].first.name
    assert hand.table.get(1, name) is None
    assert len(hand.table.cells) == 26
    hand.click(0, 0)
    hand.key(Qt.Key.Key_Delete)
    hand.key(Qt.Key.Key_L)
    hand.key(Qt.Key.Key_Plus)
    hand.settle()
    assert hand.table.get(1, name) is not None


def test_locks_belong_to_the_column(hand):
    hand.key(Qt.Key.Key_L)
    assert hand.editor.locked
    feed(hand.dock, scene(finished(column_id=2)))
    assert not hand.editor.locked
    hand.feed()
    assert hand.editor.locked


@pytest.mark.parametrize("following", ["another table", "no table"])
@pytest.mark.parametrize("begun", ["keys", "drag", "keys of the line", "line"])
def test_what_was_begun_stays_with_its_own_column(hand, qtbot, begun, following):
    view = hand.dock.distances
    hand.feed()
    if begun == "keys":
        hand.key(Qt.Key.Key_Plus)
    elif begun == "drag":
        qtbot.mousePress(hand.editor, LEFT, pos=hand.at(1, 1))
        move(qtbot, hand.editor, hand.at(1, 1) - QPoint(0, 30))
    elif begun == "keys of the line":
        qtbot.keyClick(view, Qt.Key.Key_Right)
    else:
        qtbot.mousePress(view, LEFT, pos=QPoint(round(view.line_x()), 20))
        move(qtbot, view, QPoint(round(view.line_x()) + 30, 20))
    begun_table = hand.edits[-1][0]
    assert not any(final for _, final in hand.edits)
    hand.edits.clear()
    told = []
    hand.dock.intention.connect(told.append)
    other = finished(column_id=2)
    if following == "no table":
        other = dataclasses.replace(other, method="msg", params=methods()["msg"].params())
    hand.dock.question(scene(other))
    assert hand.edits == [(begun_table, True)]
    # What follows of the hand's movement is no edit of the other column.
    assert not hand.editor.busy
    assert not view.busy
    if following == "another table":
        assert hand.editor.view.table == other.params.thresholds
    assert told == [EditField(hand.column.id, "thresholds", begun_table, True)]


def test_reset_of_a_cell_a_row_and_everything(hand):
    hand.editor.select_all()
    hand.editor.set_value(0.3)
    rows, columns = hand.editor.view.values.shape
    assert len(hand.table.cells) == rows * columns
    hand.click(0, 0)
    hand.key(Qt.Key.Key_Delete)
    assert len(hand.table.cells) == rows * columns - 1
    hand.click(1, -1)
    hand.key(Qt.Key.Key_Backspace)
    assert len(hand.table.cells) == (rows - 1) * columns - 1
    hand.dock.findChild(object, "thresholds-reset-all").click()
    assert hand.table == ThresholdTable()


def test_mirror_key(hand):
    names = [head.first.name for head in hand.editor.view.heads]
    hand.editor.select(Selection.cell(1, names.index("green/second-45")))
    hand.editor.set_value(0.9)
    hand.key(Qt.Key.Key_M)
    assert hand.table.get(2, "green/second-135") == 0.9


def test_arrows_move_and_control_extends(hand):
    hand.click(0, 0)
    hand.key(Qt.Key.Key_Right)
    hand.key(Qt.Key.Key_Down)
    assert hand.editor.current == (1, 1)
    hand.key(Qt.Key.Key_Right, CONTROL)
    hand.key(Qt.Key.Key_Up, CONTROL)
    assert hand.editor.selection.places() == [(0, 1), (0, 2), (1, 1), (1, 2)]
    hand.key(Qt.Key.Key_End)
    assert hand.editor.selection.places() == [(0, 26)]
    for _ in range(9):
        hand.key(Qt.Key.Key_Up)
    assert hand.editor.current == (0, 26)
    hand.qtbot.keyClick(hand.editor, Qt.Key.Key_A, CONTROL)
    assert len(hand.editor.selected_cells()) == hand.editor.view.values.size


def test_keys_change_and_a_series_of_keys_is_one_step(hand):
    hand.click(1, 1)
    for key in (Qt.Key.Key_Plus, Qt.Key.Key_Plus, Qt.Key.Key_PageUp, Qt.Key.Key_Minus):
        hand.key(key)
    hand.settle()
    assert hand.table.cells[0][1] == pytest.approx(0.15 * math.exp(0.55), rel=0.01)
    assert [final for _, final in hand.edits].count(True) == 1


def test_digits_type_a_value(hand, qtbot):
    hand.click(1, 1)
    hand.qtbot.keyClicks(hand.editor, ".")
    entry = hand.editor.findChild(object, "thresholds-table-entry")
    assert entry.isVisible()
    qtbot.keyClicks(entry, "37")
    qtbot.keyClick(entry, Qt.Key.Key_Return)
    assert hand.table.cells[0][1] == 0.37
    assert not entry.isVisible()
    hand.key(Qt.Key.Key_2)
    qtbot.keyClick(entry, Qt.Key.Key_Escape)
    assert hand.table.cells[0][1] == 0.37
    hand.key(Qt.Key.Key_0)
    qtbot.keyClick(entry, Qt.Key.Key_Down)
    assert hand.table.cells[0][1] == 0
    assert hand.editor.current == (2, 1)


def test_a_double_click_types_too(hand, qtbot):
    qtbot.mouseDClick(hand.editor, LEFT, pos=hand.at(1, 1))
    entry = hand.editor.findChild(object, "thresholds-table-entry")
    assert entry.selectedText() == "0.15"


def test_the_value_box_sets_the_selection(hand):
    hand.click(0, 0)
    hand.click(1, 1, CONTROL)
    hand.dock.value.setValue(0.75)
    assert [value for _, value in hand.table.cells] == [0.75] * 4
    hand.click(2, 5)
    assert hand.dock.value.value() == pytest.approx(0.15)


def test_channels_together(hand):
    box = hand.dock.arrangement
    box.setCurrentIndex(1)
    box.activated.emit(1)
    hand.feed()
    assert hand.editor.view.values.shape[1] == 9
    hand.drag(0, 0, 0, -60)
    assert {name for (_, name), _ in hand.table.cells} == {f"{c}/laplacian" for c in ("red", "green", "blue")}


def test_gray_has_no_choice_of_channels(qtbot):
    hand = Hand(qtbot, channels=1)
    assert not hand.dock.arrangement.isVisible()
    assert [head.group for head in hand.editor.view.heads][:2] == ["band", "first derivatives"]


def test_the_line_on_the_histogram_edits_the_cell(hand, qtbot):
    hand.click(1, 1)
    answer = hand.feed()
    view = hand.dock.distances
    passing = answer.distances.passing
    assert view.share == pytest.approx(passing(0.15))
    assert hand.dock.passing.text() == f"lets {passing(0.15):.1%} of all pairs through"
    start = QPoint(round(view.line_x()), view.height() // 2)
    drag(qtbot, view, [start, start + QPoint(20, 0), start + QPoint(50, 0)])
    value = hand.table.cells[0][1]
    assert float(SCALE.place(value)) - float(SCALE.place(0.15)) == pytest.approx(
        50 / (view.width() - 16), abs=0.01
    )
    assert view.share == pytest.approx(passing(value))
    assert [final for _, final in hand.edits].count(True) == 1
    view.setFocus()
    qtbot.keyClick(view, Qt.Key.Key_Left)
    hand.settle()
    assert hand.table.cells[0][1] < value


def test_measures_of_the_newest_result(hand):
    measures = hand.column.result.measures
    text = hand.dock.measures.text()
    assert f"{measures['median-candidates']:.0f} candidate" in text
    assert f"{measures['copied-share']:.0%} copied" in text


def test_says_why_there_is_no_table(qtbot):
    dock = shown(qtbot, ThresholdsDock())
    waiting = dataclasses.replace(finished(), result=None, status="running")
    assert feed(dock, scene(waiting)) is None
    assert dock.message == "The levels and features of De Bonet are known when it has run once."
    other = dataclasses.replace(finished(), title="MSG", params=methods()["msg"].params())
    assert feed(dock, scene(other)) is None
    assert dock.message == "MSG has no threshold table."


@pytest.mark.parametrize("status", ["cancelled", "failed", "idle"])
def test_the_table_needs_no_result(qtbot, status):
    dock = shown(qtbot, ThresholdsDock())
    stopped = dataclasses.replace(finished(), result=None, status=status)
    with qtbot.waitSignal(dock.asks):
        feed(dock, scene(stopped))
    feed(dock, scene(stopped))
    assert dock.message is None
    expected = Axes.of(finished().result.model)
    assert dock.editor.view.axes.features == expected.features
    assert dock.editor.view.axes.sizes == expected.sizes
    assert dock.distances.share == pytest.approx(
        Distances.of(expected.model, 1, 0).passing(dock.editor.view.values[0, 0])
    )
    # Other features, or another exemplar, have another table: nothing of it is remembered.
    fewer = dataclasses.replace(stopped, params=stopped.params.replace(orientations=2))
    gray = dataclasses.replace(scene(stopped), exemplar=exemplar(1))
    for other in (scene(fewer), gray):
        with qtbot.waitSignal(dock.asks):
            feed(dock, other)
        feed(dock, other)
        assert len(dock.editor.view.axes.features) < len(expected.features)


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_cells_and_marks_are_painted(hand, theme):
    hand.dock.set_theme(theme)
    before = hand.editor.grab().toImage()
    hand.editor.select(Selection.cell(0, 2))
    hand.editor.set_value(3.0)
    hand.editor.select(Selection.cell(2, 20))
    after = hand.editor.grab().toImage()
    place = (hand.editor.cell_rect(0, 2).topLeft() + QPoint(3, 3)).toPoint()
    assert before.pixelColor(place) != after.pixelColor(place)
    corner = hand.editor.cell_rect(0, 2).topRight().toPoint() + QPoint(-3, 1)
    assert after.pixelColor(corner) != after.pixelColor(place)


# The form and the window.


@pytest.fixture
def form(qtbot):
    knob.register()
    made = ParameterForm(DeBonetParams)
    qtbot.addWidget(made)
    made.resize(260, 600)
    made.show()
    return made


def test_the_form_shows_the_table_small(form, qtbot):
    editor = form.knobs["thresholds"]
    assert "known after the first run" in editor.note.text()
    assert not editor.map.isVisible()
    form.set_context(finished())
    assert editor.map.isVisible()
    assert editor.map.view.values.shape == (finished().result.model.depth, 27)
    with qtbot.waitSignal(form.dock_wanted) as wanted:
        qtbot.mouseClick(editor.button, LEFT)
    assert wanted.args == ["thresholds"]
    with qtbot.waitSignal(form.dock_wanted):
        qtbot.mouseDClick(editor.map, LEFT)
    with qtbot.waitSignal(form.dock_wanted):
        qtbot.keyClick(editor.map, Qt.Key.Key_Return)
    form.set_params(DeBonetParams(thresholds=ThresholdTable((((1, "red/laplacian"), 0.5),))))
    assert editor.note.text() == "1 cell set by hand."
    assert editor.map.view.changed.sum() == 1
    # What the exemplar does not have is not counted with the others: a level too many, a gray one's channel.
    cells = ((1, "red/laplacian"), (24, "red/laplacian"), (1, "luminance/laplacian"))
    form.set_params(DeBonetParams(thresholds=ThresholdTable(tuple((cell, 0.5) for cell in cells))))
    assert editor.note.text() == ("1 cell set by hand; 2 for levels or features that this exemplar does not have.")
    form.set_params(DeBonetParams(thresholds=ThresholdTable(tuple((cell, 0.5) for cell in cells[1:]))))
    assert editor.note.text() == (
        "No cells set by hand; 2 for levels or features that this exemplar does not have."
    )


@pytest.fixture
def tuner(open_window, texture, qtbot):
    explorer = open_window(str(texture), [("de-bonet", DeBonetParams())])
    qtbot.mouseClick(explorer.window.parameters.form.knobs["thresholds"].button, LEFT)
    wait_idle(qtbot, explorer)
    return explorer


def dock_of(explorer, name="thresholds"):
    return explorer.hosts[name].dock


def test_the_button_opens_the_dock_and_a_drag_is_one_step(tuner, qtbot):
    dock = dock_of(tuner)
    assert dock.isVisible()
    editor = dock.editor
    column = tuner.session.state.columns[0]
    image = tuner.controller.column_scene(column.id).result.image
    start = editor.cell_rect(0, 1).center().toPoint()
    drag(qtbot, editor, [start] + [start - QPoint(0, step) for step in (20, 60, 100, 140)])
    wait_idle(qtbot, tuner)
    table = tuner.session.state.columns[0].params.thresholds
    assert table.cells[0][1] == pytest.approx(0.15 * math.exp(140 / 60), rel=0.01)
    shown_result = tuner.controller.column_scene(column.id).result
    assert shown_result.job.params.thresholds == table
    assert shown_result.image.shape == image.shape
    tuner.session.undo()
    assert tuner.session.state.columns[0].params.thresholds == ThresholdTable()
    assert tuner.session.undo_text is None
    tuner.session.redo()
    wait_idle(qtbot, tuner)
    assert editor.view.table == table


def test_keys_of_the_table_are_not_taken_by_the_window(tuner, qtbot):
    editor = dock_of(tuner).editor
    tuner.window.activateWindow()
    editor.setFocus()
    taken = []
    for action in tuner.window.findChildren(QAction):
        action.triggered.connect(lambda *_, action=action: taken.append(action.objectName()))
    for key in "+-1":
        qtbot.keyClicks(editor, key)
    assert taken == []
    assert editor.findChild(object, "thresholds-table-entry").isVisible()
    assert QKeySequence("1") in [action.shortcut() for action in tuner.window.actions()]


def test_alpha_moves_the_cells_that_follow_the_law(tuner, qtbot):
    dock = dock_of(tuner)
    dock.editor.select(Selection.cell(0, 0))
    dock.editor.set_value(0.7)
    form = tuner.window.parameters.form
    form.knobs["alpha"].box.setValue(0.3)
    wait_idle(qtbot, tuner)
    values = dock.editor.view.values
    assert values[0, 0] == 0.7
    assert np.delete(values.ravel(), 0) == pytest.approx(0.3)
    assert tuner.window.parameters.form.knobs["thresholds"].map.view.values[0, 0] == 0.7
