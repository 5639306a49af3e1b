"""The parameter form, driven by real events: every kind of knob, drags, keys, refusals, resets."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

import pytest
from mouse import drag, handle_point, move, on_screen
from PySide6.QtCore import QPoint, QPointF, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import (
    QAbstractButton,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QLabel,
    QPushButton,
    QSlider,
)

from texlab.form import knobs
from texlab.form.form import ParameterForm
from texlab.form.knobs import ChoiceKnob, KnobWidget, NumberKnob, SwitchKnob, register_editor
from texlab.form.panel import ParametersView
from texlab.form.scales import Scale
from texlab.state.intentions import EditParams
from texlab_core.engine.params import Knob, Params
from texlab_core.engine.registry import methods
from texlab_core.errors import ParamError

LEFT = Qt.MouseButton.LeftButton


@dataclass(frozen=True, kw_only=True)
class EveryParams(Params):
    alpha: Annotated[
        float, Knob(help="Threshold", low=0, high=4, linear_to=0.5, source="eq. 13", group="Thresholds")
    ] = 0.15
    grain: Annotated[float, Knob(help="Decades", low=0.001, high=1000, log=True, unit="px")] = 1.0
    window: Annotated[int, Knob(help="Odd", low=3, high=41, odd=True, group="Search")] = 15
    rounds: Annotated[int, Knob(help="Steps", low=1, high=50)] = 5
    side: Annotated[int, Knob(help="Over octaves", low=1, high=64, log=True)] = 8
    border: Annotated[
        Literal["reflect", "as-it-is"], Knob(help="Border", choices={"reflect": "mirrored", "as-it-is": "<none>"})
    ] = "reflect"
    depth: Annotated[
        int, Knob(help="Only of use when reflecting", low=0, high=9, when=("border", ("reflect",)))
    ] = 3
    exact: Annotated[bool, Knob(help="Exactly")] = True

    def check(self) -> None:
        if self.rounds > 40 and self.window > 20:
            raise ParamError("rounds", "at most 40 with windows above 20", self.rounds)


@dataclass(frozen=True)
class Pair:
    a: int = 1
    b: int = 2

    @classmethod
    def from_json(cls, data: Any) -> Pair:
        return cls(*data)

    def to_json(self) -> list[int]:
        return [self.a, self.b]


@dataclass(frozen=True, kw_only=True)
class PairParams(Params):
    pair: Annotated[Pair, Knob(help="Two numbers")] = Pair()
    size: Annotated[int, Knob(help="Size", low=1, high=9)] = 2


@dataclass(frozen=True, kw_only=True)
class NoParams(Params):
    pass


class Edits(list):
    """What a form has emitted: (name, value, final)."""

    def __init__(self, form):
        super().__init__()
        self.refused = []
        form.edited.connect(lambda params, name, final: self.append((name, getattr(params, name), final)))
        form.refused.connect(self.refused.append)


def shown(qtbot, widget, width=280, height=640):
    qtbot.addWidget(widget)
    widget.resize(width, height)
    widget.show()
    on_screen(qtbot, widget)
    return widget


@pytest.fixture
def form(qtbot):
    return shown(qtbot, ParameterForm(EveryParams))


@pytest.fixture
def edits(form):
    return Edits(form)


def displayed(knob):
    """What a knob shows, read from its widgets."""
    if isinstance(knob, NumberKnob):
        return knob.box.value()
    if isinstance(knob, ChoiceKnob):
        return knob.box.currentData()
    assert isinstance(knob, SwitchKnob)
    return knob.box.isChecked()


def settled(qtbot, form):
    """Wait until the keys have been let alone for long enough."""
    with qtbot.waitSignal(form.edited, timeout=5000, check_params_cb=lambda params, name, final: final):
        pass


# What is shown


@pytest.mark.parametrize("params", [EveryParams, *(each.params for each in methods().values())])
def test_defaults_of_the_form_are_the_defaults_of_the_parameters(qtbot, params):
    form = ParameterForm(params)
    qtbot.addWidget(form)
    assert form.params == params()
    for name, knob in form.knobs.items():
        if isinstance(knob, NumberKnob | ChoiceKnob | SwitchKnob):
            assert displayed(knob) == getattr(params(), name)
        if isinstance(knob, NumberKnob):
            assert knob.slider.value() == Scale.of(form.fields[name]).position(getattr(params(), name))


def test_every_control_has_a_name_a_tooltip_and_the_keyboard(form):
    kinds = (QAbstractButton, QAbstractSpinBox, QComboBox, QSlider)
    controls = [each for kind in kinds for each in form.findChildren(kind)]
    names = [each.objectName() for each in controls]
    assert len(set(names)) == len(names) == 8 + 5 + 8 + 1
    for each in controls:
        assert each.accessibleName(), each.objectName()
        assert each.focusPolicy() & Qt.FocusPolicy.TabFocus, each.objectName()
        assert each.toolTip() or each.parentWidget().toolTip(), each.objectName()
    assert "eq. 13" in form.knobs["alpha"].toolTip()
    assert "default 0.15" in form.knobs["alpha"].toolTip()
    assert "1000 px" in form.knobs["grain"].toolTip()
    assert "&lt;none&gt;" in form.knobs["border"].toolTip()
    for label in form.findChildren(QLabel):
        if label.text() in form.fields:
            assert label.buddy() is form.knobs[label.text()]


def test_groups_are_headings_in_order(form):
    texts = [label.text() for label in form.findChildren(QLabel) if label.property("role") == "heading"]
    assert texts == ["Thresholds", "Search"]


def test_a_method_without_parameters(qtbot):
    form = shown(qtbot, ParameterForm(NoParams))
    assert [label.text() for label in form.findChildren(QLabel) if label.isVisible()] == [
        "This method has no parameters."
    ]


def test_showing_parameters_emits_nothing(form, edits):
    other = EveryParams(
        alpha=2.5, grain=0.0123, window=41, rounds=50 - 20, side=64, border="as-it-is", depth=0, exact=False
    )
    form.set_params(other)
    assert edits == []
    assert form.params == other
    for name, knob in form.knobs.items():
        assert displayed(knob) == getattr(other, name)
    assert not form.knobs["depth"].isEnabled()


# Sliders


def test_a_drag_emits_drafts_and_one_end(qtbot, form, edits):
    knob = form.knobs["alpha"]
    slider = knob.slider
    places = [handle_point(slider)] + [handle_point(slider, share) for share in (0.3, 0.4, 0.5, 0.6, 0.75)]
    drag(qtbot, slider, places)
    assert [final for _, _, final in edits] == [False] * 5 + [True]
    values = [value for _, value, _ in edits]
    assert values == sorted(values)
    assert values[-1] == values[-2] == form.params.alpha
    assert values[-1] == pytest.approx(0.5, abs=0.02)
    assert knob.box.value() == form.params.alpha
    assert {name for name, _, _ in edits} == {"alpha"}


def test_the_box_follows_during_a_drag(qtbot, form):
    knob = form.knobs["grain"]
    slider = knob.slider
    qtbot.mousePress(slider, LEFT, pos=handle_point(slider))
    move(qtbot, slider, handle_point(slider, 1.0))
    assert knob.box.value() == form.params.grain == 1000
    # What comes from elsewhere does not tear the handle from the finger.
    at = slider.value()
    form.set_params(EveryParams())
    assert slider.value() == at
    qtbot.mouseRelease(slider, LEFT, pos=handle_point(slider, 1.0))


def test_the_logarithmic_tail_under_the_mouse(qtbot, form):
    slider = form.knobs["alpha"].slider
    drag(qtbot, slider, [handle_point(slider), handle_point(slider, 1.0)])
    assert form.params.alpha == 4
    drag(qtbot, slider, [handle_point(slider), handle_point(slider, 0.875)])
    # The geometric mean of 0.5 and 4, to a pixel of the slider.
    assert form.params.alpha == pytest.approx(2**0.5, rel=0.05)
    drag(qtbot, slider, [handle_point(slider), handle_point(slider, 0.0)])
    assert form.params.alpha == 0


def test_odd_windows_only(qtbot, form, edits):
    slider = form.knobs["window"].slider
    drag(qtbot, slider, [handle_point(slider)] + [handle_point(slider, share / 20) for share in range(21)])
    assert {value % 2 for _, value, _ in edits} == {1}
    assert {value for _, value, _ in edits} >= {3, 41}
    box = form.knobs["window"].box
    for typed, taken in (("10", 11), ("40", 41), ("7", 7)):
        box.setFocus()
        box.selectAll()
        qtbot.keyClicks(box, typed)
        qtbot.keyClick(box, Qt.Key.Key_Return)
        assert form.params.window == box.value() == taken
    qtbot.keyClick(box, Qt.Key.Key_Up)
    assert form.params.window == 9


# The keyboard


def test_keys_settle_after_the_last(qtbot, form, edits):
    slider = form.knobs["alpha"].slider
    slider.setFocus()
    before = form.params.alpha
    for _ in range(4):
        qtbot.keyClick(slider, Qt.Key.Key_Right)
    assert [final for _, _, final in edits] == [False] * 4
    assert form.params.alpha > before
    settled(qtbot, form)
    assert edits[4:] == [("alpha", form.params.alpha, True)]


@pytest.mark.parametrize("name", ["rounds", "side", "window", "alpha", "grain"])
def test_every_step_of_the_keyboard_changes_the_value(qtbot, form, edits, name):
    slider = form.knobs[name].slider
    slider.setFocus()
    qtbot.keyClick(slider, Qt.Key.Key_Home)
    low = getattr(form.params, name)
    assert low == form.fields[name].knob.low
    seen = [low]
    for _ in range(5):
        qtbot.keyClick(slider, Qt.Key.Key_Right)
        seen.append(getattr(form.params, name))
    assert len(set(seen)) == 6
    assert seen == sorted(seen)
    for expected in seen[-2::-1]:
        qtbot.keyClick(slider, Qt.Key.Key_Left)
        assert getattr(form.params, name) <= expected
    qtbot.keyClick(slider, Qt.Key.Key_End)
    assert getattr(form.params, name) == form.fields[name].knob.high
    qtbot.keyClick(slider, Qt.Key.Key_PageDown)
    assert getattr(form.params, name) < form.fields[name].knob.high
    settled(qtbot, form)


def test_whole_numbers_go_one_by_one(qtbot, form):
    slider = form.knobs["side"].slider
    slider.setFocus()
    qtbot.keyClick(slider, Qt.Key.Key_Home)
    for expected in (2, 3, 4, 5):
        qtbot.keyClick(slider, Qt.Key.Key_Right)
        assert form.params.side == expected
    settled(qtbot, form)


def test_a_typed_number_is_one_final_edit(qtbot, form, edits):
    box = form.knobs["alpha"].box
    box.setFocus()
    box.selectAll()
    qtbot.keyClicks(box, "0.25")
    assert edits == []
    qtbot.keyClick(box, Qt.Key.Key_Return)
    assert edits == [("alpha", 0.25, True)]
    assert form.knobs["alpha"].slider.value() == Scale.of(form.fields["alpha"]).position(0.25)
    qtbot.keyClick(box, Qt.Key.Key_Up)
    assert edits[1:] == [("alpha", 0.255, True)]


def test_the_lowest_value_can_be_typed(qtbot, form):
    box = form.knobs["grain"].box
    box.setFocus()
    box.selectAll()
    qtbot.keyClicks(box, "0.001")
    qtbot.keyClick(box, Qt.Key.Key_Return)
    assert form.params.grain == 0.001
    assert box.value() == 0.001
    assert not form._error.isVisible()


def test_choices_and_switches(qtbot, form, edits):
    box = form.knobs["border"].box
    assert box.itemText(1) == "as it is"
    assert box.itemData(0, Qt.ItemDataRole.ToolTipRole) == "mirrored"
    box.setFocus()
    qtbot.keyClick(box, Qt.Key.Key_Down)
    assert edits == [("border", "as-it-is", True)]
    assert not form.knobs["depth"].isEnabled()
    qtbot.keyClick(box, Qt.Key.Key_Up)
    assert form.knobs["depth"].isEnabled()
    switch = form.knobs["exact"].box
    qtbot.mouseClick(switch, LEFT, pos=QPoint(6, switch.height() // 2))
    qtbot.keyClick(switch, Qt.Key.Key_Space)
    assert edits[2:] == [("exact", False, True), ("exact", True, True)]


# The wheel


def wheel(widget, steps):
    window = widget.window()
    place = QPointF(widget.mapTo(window, widget.rect().center()))
    QTest.wheelEvent(window.windowHandle(), place, QPoint(0, 120 * steps))
    QApplication.processEvents()


def test_the_wheel_scrolls_the_panel_unless_a_control_has_the_focus(qtbot):
    view = shown(qtbot, ParametersView(), 270, 300)
    view.show_column(1, STUB_METHOD, EveryParams())
    view.form.complete()
    QApplication.processEvents()
    bar = view.scroll_area.verticalScrollBar()
    assert bar.maximum() > 0
    view.reset_button.setFocus()
    knob = view.form.knobs["alpha"]
    for control in (knob.slider, knob.box):
        bar.setValue(0)
        QApplication.processEvents()
        wheel(control, -1)
        assert bar.value() > 0
    assert view.form.params == EveryParams()
    bar.setValue(0)
    QApplication.processEvents()
    knob.slider.setFocus()
    wheel(knob.slider, 1)
    assert view.form.params.alpha > 0.15
    settled(qtbot, view.form)


class _Method:
    """As much of a method as the panel needs."""

    id = "every"
    title = "Every"
    summary = "All kinds of knobs."
    params = EveryParams


STUB_METHOD: Any = _Method()


# Refusals


def test_a_refused_value_is_said_below_its_knob(qtbot, form, edits):
    form.set_params(EveryParams(window=31))
    slider = form.knobs["rounds"].slider
    drag(qtbot, slider, [handle_point(slider), handle_point(slider, 0.5), handle_point(slider, 1.0)])
    error = form._error
    assert error.isVisible()
    assert error.text() == "rounds: must be at most 40 with windows above 20, got 50."
    assert form._error.property("role") == "error"
    assert edits.refused[-1] == error.text()
    assert form.params.rounds <= 40
    assert all(value <= 40 for _, value, _ in edits)
    assert edits[-1] == ("rounds", form.params.rounds, True)
    # The handle is back where the value is.
    assert form.knobs["rounds"].box.value() == form.params.rounds
    assert slider.value() == Scale.of(form.fields["rounds"]).position(form.params.rounds)
    QApplication.processEvents()
    label = next(each for each in form.findChildren(QLabel) if each.text() == "side")
    below, top = form.knobs["rounds"].geometry().bottom(), error.geometry().top()
    assert below < top < label.geometry().top()
    # The next value that is accepted takes the sentence away.
    box = form.knobs["rounds"].box
    box.setFocus()
    box.selectAll()
    qtbot.keyClicks(box, "12")
    qtbot.keyClick(box, Qt.Key.Key_Return)
    assert not error.isVisible()


def test_a_refused_typed_value_goes_back(qtbot, form, edits):
    form.set_params(EveryParams(window=31))
    box = form.knobs["rounds"].box
    box.setFocus()
    box.selectAll()
    qtbot.keyClicks(box, "45")
    qtbot.keyClick(box, Qt.Key.Key_Return)
    assert edits == []
    assert len(edits.refused) == 1
    assert box.value() == 5
    assert form.params.rounds == 5
    form.set_params(EveryParams())
    assert not form._error.isVisible()


# Resets


def test_reset_of_one_knob(qtbot, form, edits):
    reset = form.findChild(QAbstractButton, "reset-rounds")
    assert not reset.isVisible()
    places = {name: knob.pos() for name, knob in form.knobs.items()}
    form.set_params(EveryParams(rounds=9, alpha=1.0))
    QApplication.processEvents()
    assert reset.isVisible()
    assert {name: knob.pos() for name, knob in form.knobs.items()} == places
    qtbot.mouseClick(reset, LEFT)
    assert edits == [("rounds", 5, True)]
    assert not reset.isVisible()
    assert displayed(form.knobs["rounds"]) == 5
    assert form.params.alpha == 1.0
    alpha = form.findChild(QAbstractButton, "reset-alpha")
    alpha.setFocus()
    qtbot.keyClick(alpha, Qt.Key.Key_Space)
    assert form.params == EveryParams()


# Special editors


class PairKnob(KnobWidget):
    """Shows a pair on a button that counts up."""

    def __init__(self, field, parent=None):
        super().__init__(parent)
        self.button = QPushButton("count", self)
        self.button.clicked.connect(lambda: self.edited.emit(Pair(self.value.a + 1, self.value.b), True))
        self.value = field.default
        self.context = None

    def set_value(self, value):
        self.value = value

    def set_context(self, context):
        self.context = context


def test_an_editor_is_chosen_by_the_type(qtbot, monkeypatch):
    monkeypatch.setattr(knobs, "_EDITORS", {})
    without = ParameterForm(PairParams)
    qtbot.addWidget(without)
    assert list(without.knobs) == ["size"]
    register_editor(Pair, PairKnob)
    form = shown(qtbot, ParameterForm(PairParams))
    edits = Edits(form)
    knob = form.knobs["pair"]
    qtbot.mouseClick(knob.button, LEFT)
    assert edits == [("pair", Pair(2, 2), True)]
    assert knob.value == Pair(2, 2)
    form.set_context("scene")
    assert knob.context == "scene"
    qtbot.mouseClick(form.findChild(QAbstractButton, "reset-pair"), LEFT)
    assert form.params == PairParams()


# The panel


def test_keys_are_settled_for_their_own_column(qtbot):
    view = shown(qtbot, ParametersView())
    heard = []
    view.intention.connect(heard.append)
    view.show_column(1, STUB_METHOD, EveryParams())
    slider = view.form.knobs["rounds"].slider
    slider.setFocus()
    qtbot.keyClick(slider, Qt.Key.Key_Right)
    view.show_column(2, STUB_METHOD, EveryParams(rounds=30))
    assert heard == [EditParams(1, EveryParams(rounds=6), "rounds", final) for final in (False, True)]
    assert not [timer for timer in view.form.findChildren(QTimer) if timer.isActive()]
    assert view.form.params.rounds == 30


@pytest.mark.parametrize("following", [STUB_METHOD, methods()["msg"], None])
def test_what_was_begun_stays_with_its_own_column(qtbot, following):
    view = shown(qtbot, ParametersView())
    heard = []
    view.intention.connect(heard.append)
    params = None if following is None else following.params()
    view.show_column(1, STUB_METHOD, EveryParams())
    knob = view.form.knobs["rounds"]
    knob.box.setFocus()
    knob.box.selectAll()
    # Typed, but not entered.
    QTest.keyClicks(knob.box, "7")
    view.show_column(2, following, params)
    QApplication.processEvents()
    assert heard == [EditParams(1, EveryParams(rounds=7), "rounds", True)]
    heard.clear()
    view.show_column(1, STUB_METHOD, EveryParams())
    slider = view.form.knobs["rounds"].slider
    qtbot.mousePress(slider, LEFT, pos=handle_point(slider))
    move(qtbot, slider, handle_point(slider, 0.6))
    view.show_column(2, following, params)
    QApplication.processEvents()
    dragged = heard[0].params
    assert dragged.rounds > 5
    # The drag has ended there, or the column would keep its draft.
    assert heard == [EditParams(1, dragged, "rounds", final) for final in (False, True)]


def test_reset_gives_the_column_the_defaults(qtbot):
    view = shown(qtbot, ParametersView())
    heard = []
    view.intention.connect(heard.append)
    view.show_column(4, STUB_METHOD, EveryParams(rounds=7))
    qtbot.mouseClick(view.reset_button, LEFT)
    assert heard == [EditParams(4, EveryParams(), "reset all")]


def test_a_form_that_is_gone_tells_nothing(qtbot):
    view = shown(qtbot, ParametersView())
    heard = []
    view.intention.connect(heard.append)
    view.show_column(1, STUB_METHOD, EveryParams())
    knob = view.form.knobs["rounds"]
    knob.box.setFocus()
    knob.box.selectAll()
    QTest.keyClicks(knob.box, "7")
    # Another method in the same column: what is typed is no parameter of it.
    view.show_column(1, methods()["msg"], methods()["msg"].params())
    knob.edited.emit(9, True)
    QApplication.processEvents()
    assert heard == []


def test_a_form_comes_in_pieces_once_and_shows_what_it_was_handed(qtbot):
    view = shown(qtbot, ParametersView())
    view.show_column(1, STUB_METHOD, EveryParams(rounds=7))
    form = view.form
    view.show_scene("result")
    assert not form.findChildren(KnobWidget)
    # What could not be made in time is made when it is asked for.
    qtbot.waitUntil(lambda: len(form.findChildren(KnobWidget)) == len(form.fields))
    assert displayed(form.knobs["rounds"]) == 7
    qtbot.waitUntil(lambda: all(knob.isVisible() for knob in form.knobs.values()))
    seen = []
    for knob in form.knobs.values():
        knob.set_context = seen.append
    view.show_column(2, methods()["msg"], methods()["msg"].params())
    # A hidden form holds no result.
    assert seen == [None] * len(form.knobs)
    assert not form.isVisible()
    assert view.form is not form
    view.show_column(1, STUB_METHOD, EveryParams(rounds=8))
    view.show_scene("result")
    assert view.form is form
    assert seen[len(form.knobs) :] == ["result"] * len(form.knobs)
    assert displayed(form.knobs["rounds"]) == 8


def test_another_column_of_the_same_method_keeps_the_form(qtbot):
    view = shown(qtbot, ParametersView())
    view.show_column(1, STUB_METHOD, EveryParams())
    form = view.form
    view.show_column(2, STUB_METHOD, EveryParams(rounds=7))
    assert view.form is form
    assert displayed(form.knobs["rounds"]) == 7
    view.show_column(0, None, None)
    assert view.form is None
    assert not view.reset_button.isEnabled()
    assert view.title.text() == "There is no column"


def test_a_summary_has_room_for_its_lines_before_anything_is_painted(qtbot):
    view = shown(qtbot, ParametersView(), 270, 500)
    for name in ("heeger-bergen", "de-bonet", "mixture"):
        method = methods()[name]
        view.show_column(1, method, method.params())
        assert view.summary.height() == view.summary.heightForWidth(view.summary.width())
        assert view.summary.height() > 1.5 * view.summary.fontMetrics().lineSpacing()
