"""The parameter panel: widgets made from ``describe()``, one row per knob."""

from __future__ import annotations

import html
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QEvent, QObject, QSignalBlocker, Qt, QTimer, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QGridLayout,
    QLabel,
    QSizePolicy,
    QSlider,
    QSpinBox,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from texlab.form.scales import Scale, box_step, decimals
from texlab_core.engine.params import describe
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    from texlab_core.engine.params import Field, Params

SETTLE_MS = 120

Editor = Callable[["Field", QWidget], "KnobWidget"]
_EDITORS: dict[type, Editor] = {}


def register_editor(value_type: type, editor: Editor) -> None:
    """Give every parameter of this type a special editor."""
    _EDITORS[value_type] = editor


class KnobWidget(QWidget):
    """Edits one value.

    ``edited(value, final)``: ``final`` is False while a drag goes on. ``dock_wanted(name)``: there is more to edit
    in a dock.
    """

    edited = Signal(object, bool)
    dock_wanted = Signal(str)

    def set_value(self, value: Any) -> None:
        """Show a value without emitting anything."""
        raise NotImplementedError

    def settle(self) -> None:
        """Emit what has not been emitted as final yet."""

    def set_context(self, context: Any) -> None:
        """Take what a special editor wants to show beside the value (the scene's chosen column)."""


class NumberKnob(KnobWidget):
    """An integer slider and a number box that follow each other."""

    def __init__(self, field: Field, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._field = field
        self._scale = Scale.of(field)
        self._value: float = field.default
        self.slider = QSlider(Qt.Orientation.Horizontal)
        self.slider.setObjectName(f"slider-{field.name}")
        self.slider.setAccessibleName(field.label)
        self.slider.setRange(0, self._scale.positions)
        self.slider.setPageStep(max(1, self._scale.positions // 10))
        self.slider.setSingleStep(max(1, self._scale.positions // 100))
        self.slider.setMinimumWidth(60)
        self.box: QSpinBox | QDoubleSpinBox = self._make_box(field)
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.slider, 0, 0)
        layout.addWidget(self.box, 0, 1)
        layout.setColumnStretch(0, 1)
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(SETTLE_MS)
        self._rest.timeout.connect(self._settled)
        self.slider.actionTriggered.connect(self._step)
        self.slider.valueChanged.connect(self._slider_moved)
        self.slider.sliderReleased.connect(self._settled)
        self.box.valueChanged.connect(self._box_changed)
        self.setFocusProxy(self.slider)

    def _make_box(self, field: Field) -> QSpinBox | QDoubleSpinBox:
        box: QSpinBox | QDoubleSpinBox
        if field.kind == "int":
            box = QSpinBox()
            box.setRange(round(self._scale.low), round(self._scale.high))
            box.setSingleStep(round(field.knob.step or self._scale.step))
        else:
            box = QDoubleSpinBox()
            box.setDecimals(decimals(field))
            box.setRange(self._scale.low, self._scale.high)
            box.setSingleStep(box_step(field))
            if field.knob.log and field.knob.step is None:
                box.setStepType(QDoubleSpinBox.StepType.AdaptiveDecimalStepType)
        box.setKeyboardTracking(False)
        box.setObjectName(f"box-{field.name}")
        box.setAccessibleName(field.label)
        if field.knob.unit:
            box.setSuffix(f" {field.knob.unit}")
        box.setMinimumWidth(74)
        box.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        return box

    def set_value(self, value: Any) -> None:
        """Show a value without emitting anything."""
        self._value = value
        with QSignalBlocker(self.slider), QSignalBlocker(self.box):
            self.box.setValue(value)
            if not self.slider.isSliderDown():
                self.slider.setValue(self._scale.position(value))

    def _typed(self, value: float) -> int | float:
        return round(value) if self._field.kind == "int" else float(value)

    def _at(self, position: int) -> int | float:
        value = self._typed(self._scale.value(position))
        return value if self._field.kind == "int" else round(value, decimals(self._field))

    def _step(self, action: int) -> None:
        """Make a step of the keyboard change the value, however flat the scale is there."""
        steps = QSlider.SliderAction
        by = {
            steps.SliderSingleStepAdd.value: 1,
            steps.SliderPageStepAdd.value: 1,
            steps.SliderSingleStepSub.value: -1,
            steps.SliderPageStepSub.value: -1,
        }.get(action, 0)
        place = self.slider.sliderPosition()
        while by and 0 < place < self._scale.positions and self._at(place) == self._value:
            place += by
        self.slider.setSliderPosition(place)

    def _slider_moved(self, position: int) -> None:
        value = self._at(position)
        if value == self._value:
            return
        self._value = value
        with QSignalBlocker(self.box):
            self.box.setValue(value)  # type: ignore[arg-type]  # the box of an int knob gets an int
        self.edited.emit(value, False)
        if not self.slider.isSliderDown():
            # Keys and wheel have no release: they settle after a moment.
            self._rest.start()

    def settle(self) -> None:
        """Emit as final what was typed or changed by keys or the wheel a moment ago; end a drag."""
        self.box.interpretText()
        if self.slider.isSliderDown():
            self.slider.setSliderDown(False)
        elif self._rest.isActive():
            self._settled()

    def _settled(self) -> None:
        self._rest.stop()
        self.edited.emit(self._value, True)

    def _box_changed(self, shown: float) -> None:
        value = self._typed(shown)
        if self._field.knob.odd and value % 2 == 0:
            value = min(int(value) + 1, int(self._scale.high))
        self._value = value
        with QSignalBlocker(self.slider), QSignalBlocker(self.box):
            self.slider.setValue(self._scale.position(value))
            self.box.setValue(value)  # type: ignore[arg-type]
        self.edited.emit(value, True)


class ChoiceKnob(KnobWidget):
    """A list of choices with an explanation for each."""

    def __init__(self, field: Field, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._choices = field.choices
        self.box = QComboBox()
        self.box.setObjectName(f"choice-{field.name}")
        self.box.setAccessibleName(field.label)
        for place, choice in enumerate(field.choices):
            self.box.addItem(choice.replace("-", " "), choice)
            self.box.setItemData(place, field.knob.choices.get(choice, ""), Qt.ItemDataRole.ToolTipRole)
        self.box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.box)
        self.box.activated.connect(lambda place: self.edited.emit(self._choices[place], True))
        self.setFocusProxy(self.box)

    def set_value(self, value: Any) -> None:
        """Show a value without emitting anything."""
        with QSignalBlocker(self.box):
            self.box.setCurrentIndex(self._choices.index(value))


class SwitchKnob(KnobWidget):
    """A check box."""

    def __init__(self, field: Field, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.box = QCheckBox()
        self.box.setObjectName(f"switch-{field.name}")
        self.box.setAccessibleName(field.label)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.box)
        self.box.clicked.connect(lambda on: self.edited.emit(bool(on), True))
        self.setFocusProxy(self.box)

    def set_value(self, value: Any) -> None:
        """Show a value without emitting anything."""
        with QSignalBlocker(self.box):
            self.box.setChecked(bool(value))


def tooltip(field: Field) -> str:
    """Return what a knob does, its range and default, and where it stands in the paper, as rich text."""
    knob = field.knob
    default = field.default
    shown = "its own" if field.kind == "value" else default
    lines = [f"<b>{html.escape(field.label)}</b><br>{html.escape(knob.help)}"]
    if field.kind == "choice":
        for choice in field.choices:
            lines.append(f"<i>{html.escape(choice)}</i>: {html.escape(knob.choices.get(choice, ''))}")
    unit = f" {knob.unit}" if knob.unit else ""
    if field.kind in ("int", "float"):
        lines.append(f"{html.escape(field.allowed)}{html.escape(unit)}; default {shown}")
    elif field.kind != "value":
        lines.append(f"Default: {html.escape(str(shown))}")
    if knob.source:
        lines.append(f"<i>{html.escape(knob.source)}</i>")
    return "<qt>" + "<br>".join(lines) + "</qt>"


class WheelGuard(QObject):
    """Lets the wheel scroll the panel unless the control under it has the focus."""

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Pass wheel events on to the panel."""
        if event.type() == QEvent.Type.Wheel and isinstance(watched, QWidget) and not watched.hasFocus():
            event.ignore()
            return True
        return super().eventFilter(watched, event)


class ParameterForm(QWidget):
    """All knobs of one method.

    ``edited(params, name, final)``: checked parameters in which the knob ``name`` was changed.
    ``refused(sentence)``: a combination that the parameters do not accept.
    """

    edited = Signal(object, str, bool)
    refused = Signal(str)
    dock_wanted = Signal(str)

    def __init__(self, params_class: type[Params], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("parameter-form")
        self._params = params_class()
        self.fields = {field.name: field for field in describe(params_class)}
        self.knobs: dict[str, KnobWidget] = {}
        self._labels: dict[str, QLabel] = {}
        self._resets: dict[str, QToolButton] = {}
        self._error_rows: dict[str, int] = {}
        self._row = 0
        self._error = QLabel()
        self._error.setObjectName("form-error")
        self._error.setProperty("role", "error")
        self._error.setWordWrap(True)
        self._error.hide()
        self._guard = WheelGuard(self)
        self._layout = QGridLayout(self)
        self._layout.setContentsMargins(8, 4, 8, 8)
        self._layout.setVerticalSpacing(3)
        self._layout.setColumnStretch(0, 1)
        group = ""
        for field in self.fields.values():
            if field.knob.group and field.knob.group != group:
                group = field.knob.group
                heading = QLabel(group)
                heading.setProperty("role", "heading")
                heading.setContentsMargins(0, 8, 0, 0)
                self._layout.addWidget(heading, self._row, 0, 1, 2)
                self._row += 1
            self._add(field)
        self._layout.addWidget(self._error, self._row, 0, 1, 2)
        self._layout.setRowStretch(self._row + 1, 1)
        if not self.fields:
            self._layout.addWidget(QLabel("This method has no parameters."), 0, 0)
        self.set_params(self._params)

    @property
    def params(self) -> Params:
        """The parameters shown."""
        return self._params

    def set_params(self, params: Params) -> None:
        """Show parameters without emitting anything."""
        self._params = params
        self._error.hide()
        for name, knob in self.knobs.items():
            knob.set_value(getattr(params, name))
        self._update_state()

    def settle(self) -> None:
        """End what goes on, before another column is shown: it is emitted as final."""
        for knob in self.knobs.values():
            knob.settle()

    def set_context(self, context: Any) -> None:
        """Hand the chosen column's scene to the special editors."""
        for knob in self.knobs.values():
            knob.set_context(context)

    def _make_knob(self, field: Field) -> KnobWidget:
        if field.kind in ("int", "float"):
            return NumberKnob(field, self)
        if field.kind == "choice":
            return ChoiceKnob(field, self)
        if field.kind == "bool":
            return SwitchKnob(field, self)
        return _EDITORS[field.type](field, self)

    def _add(self, field: Field) -> None:
        if field.kind == "value" and field.type not in _EDITORS:
            return
        knob = self._make_knob(field)
        knob.setObjectName(f"knob-{field.name}")
        knob.setToolTip(tooltip(field))
        for child in knob.findChildren(QWidget):
            if isinstance(child, QSlider | QSpinBox | QDoubleSpinBox | QComboBox):
                child.installEventFilter(self._guard)
                child.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        label = QLabel(field.label)
        label.setToolTip(tooltip(field))
        label.setBuddy(knob)
        reset = QToolButton()
        reset.setObjectName(f"reset-{field.name}")
        reset.setText("↺")
        reset.setAutoRaise(True)
        reset.setToolTip(f"Reset {field.label} to its default")
        reset.setAccessibleName(f"Reset {field.label}")
        # A knob must not move when it leaves its default.
        policy = reset.sizePolicy()
        policy.setRetainSizeWhenHidden(True)
        reset.setSizePolicy(policy)
        reset.clicked.connect(lambda: self._edit(field.name, field.default, True))
        row = self._row
        if field.kind == "bool":
            line = QWidget()
            inner = QGridLayout(line)
            inner.setContentsMargins(0, 0, 0, 0)
            inner.addWidget(knob, 0, 0)
            inner.addWidget(label, 0, 1)
            inner.setColumnStretch(1, 1)
            self._layout.addWidget(line, row, 0)
            self._layout.addWidget(reset, row, 1)
        else:
            self._layout.addWidget(label, row, 0)
            self._layout.addWidget(reset, row, 1)
            self._layout.addWidget(knob, row + 1, 0, 1, 2)
        self._error_rows[field.name] = row + 2
        self._row = row + 3
        self.knobs[field.name] = knob
        self._labels[field.name] = label
        self._resets[field.name] = reset
        knob.edited.connect(lambda value, final: self._edit(field.name, value, final))
        knob.dock_wanted.connect(self.dock_wanted)

    def _edit(self, name: str, value: Any, final: bool) -> None:
        try:
            params = self._params.replace(**{name: value})
        except ParamError as error:
            self._show_error(name, str(error))
            self.refused.emit(str(error))
            self.knobs[name].set_value(getattr(self._params, name))
            return
        if params != self._params:
            # What was refused while dragging stays to be read after the release.
            self._error.hide()
        self._params = params
        if final:
            self.knobs[name].set_value(getattr(params, name))
        self._update_state()
        self.edited.emit(params, name, final)

    def _show_error(self, name: str, sentence: str) -> None:
        """Say below its knob why a value was refused."""
        self._layout.removeWidget(self._error)
        self._layout.addWidget(self._error, self._error_rows[name], 0, 1, 2)
        self._error.setText(sentence)
        self._error.show()

    def _update_state(self) -> None:
        for name, knob in self.knobs.items():
            field = self.fields[name]
            when = field.knob.when
            useful = when is None or getattr(self._params, when[0]) in when[1]
            knob.setEnabled(useful)
            self._labels[name].setEnabled(useful)
            self._resets[name].setVisible(getattr(self._params, name) != field.default)
