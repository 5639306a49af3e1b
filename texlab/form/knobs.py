"""One widget for each kind of parameter, and a place for editors of other types."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QGridLayout,
    QSizePolicy,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from texlab.form.scales import Scale, box_step, decimals
from texlab.style.text_size import grow_with_text
from texlab.widgets.calm_wheel import ChoiceBox
from texlab.widgets.number_box import NumberBox, WholeBox
from texlab.widgets.plain import tip_text
from texlab.widgets.settling import Settling
from texlab.widgets.slider import Slider

if TYPE_CHECKING:
    from texlab_core.engine.params import Field

SETTLE_MS = 120
Editor = Callable[["Field", QWidget], "KnobWidget"]
_EDITORS: dict[type, Editor] = {}


def register_editor(value_type: type, editor: Editor) -> None:
    """Give every parameter of this type a special editor."""
    _EDITORS[value_type] = editor


def editor_of(value_type: type) -> Editor | None:
    """Return the special editor of parameters of this type, or None."""
    return _EDITORS.get(value_type)


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
        self._value: Any = field.default
        self.box: WholeBox | NumberBox = self._make_box(field)
        self.slider = Slider(field.label, self._said)
        self.slider.setObjectName(f"slider-{field.name}")
        self.slider.setRange(0, self._scale.positions)
        self.slider.setPageStep(max(1, self._scale.positions // 10))
        self.slider.setSingleStep(max(1, self._scale.positions // 100))
        self.slider.setMinimumWidth(60)
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.slider, 0, 0)
        layout.addWidget(self.box, 0, 1)
        layout.setColumnStretch(0, 1)
        self._rest = Settling(self, SETTLE_MS, self._settled)
        self.slider.actionTriggered.connect(self._step)
        self.slider.valueChanged.connect(self._slider_moved)
        self.slider.sliderReleased.connect(self._settled)
        self.box.valueChanged.connect(self._box_changed)
        self.setFocusProxy(self.slider)

    def _make_box(self, field: Field) -> WholeBox | NumberBox:
        box: WholeBox | NumberBox
        if field.kind == "int":
            box = WholeBox()
            box.setRange(round(self._scale.low), round(self._scale.high))
            box.setSingleStep(round(field.knob.step or self._scale.step))
        else:
            box = NumberBox()
            box.setDecimals(decimals(field))
            box.setRange(self._scale.low, self._scale.high)
            box.setSingleStep(box_step(field))
            if field.knob.log and field.knob.step is None:
                box.setStepType(NumberBox.StepType.AdaptiveDecimalStepType)
        box.setObjectName(f"box-{field.name}")
        box.setAccessibleName(field.label)
        if field.knob.unit:
            box.setSuffix(f" {field.knob.unit}")
        grow_with_text(box, 74, box.setMinimumWidth)
        box.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        return box

    def set_value(self, value: Any) -> None:
        """Show a value without emitting anything."""
        self._take(value)
        with QSignalBlocker(self.slider), QSignalBlocker(self.box):
            self.box.setValue(value)
            if not self.slider.isSliderDown():
                self.slider.setValue(self._scale.position(value))

    def _take(self, value: Any) -> None:
        self._value = value
        self.slider.tell()

    def _said(self, _place: int) -> str:
        unit = f" {self._field.knob.unit}" if self._field.knob.unit else ""
        return f"{self.box.textFromValue(self._value)}{unit}"

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
        self._take(value)
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
        self._take(value)
        with QSignalBlocker(self.slider), QSignalBlocker(self.box):
            self.slider.setValue(self._scale.position(value))
            self.box.setValue(value)  # type: ignore[arg-type]
        self.edited.emit(value, True)


class ChoiceKnob(KnobWidget):
    """A list of choices with an explanation for each."""

    def __init__(self, field: Field, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._choices = field.choices
        self.box = ChoiceBox()
        self.box.setObjectName(f"choice-{field.name}")
        self.box.setAccessibleName(field.label)
        for place, choice in enumerate(field.choices):
            self.box.addItem(choice.replace("-", " "), choice)
            self.box.setItemData(place, tip_text(field.knob.choices.get(choice, "")), Qt.ItemDataRole.ToolTipRole)
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
