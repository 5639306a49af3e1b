"""One axis of a sweep: which knob is varied, and over which values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QGridLayout,
    QHBoxLayout,
    QLineEdit,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from texlab.docks.sweeps.textures import TextureChoice
from texlab.form.scales import box_step, decimals
from texlab.style.numbers import parse_list
from texlab.style.text_size import grow_with_text
from texlab.widgets.calm_wheel import ChoiceBox
from texlab.widgets.flow_layout import FlowLayout
from texlab.widgets.number_box import NumberBox, WholeBox
from texlab.widgets.plain import Label, set_tip, tip_text
from texlab_core.engine.params import describe
from texlab_core.errors import ParamError
from texlab_core.sheets.sweep import MAX_CELLS, TEXTURE, Vary, check_knob, spread

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.state.sweeps import Textures
    from texlab_core.engine.params import Field, Params

Spacing = Literal["even", "log", "list"]
SPACINGS: tuple[tuple[Spacing, str, str], ...] = (
    ("even", "even", "Steps of equal size"),
    ("log", "log", "Steps of equal ratio"),
    ("list", "list", "The values that are written below"),
)
COUNT = 6
SEEDS = 12


@dataclass(frozen=True)
class AxisChoice:
    """What an editor is set to, whether or not it makes sense."""

    knob: str
    spacing: Spacing
    first: float
    last: float
    count: int
    listed: str
    choices: tuple[Any, ...]
    textures: tuple[str, tuple[str, ...]] = ("", ())


class AxisEditor(QWidget):
    """Chooses a knob (or ``seed``) of a method and the values it takes.

    Parameters
    ----------
    name
        Prefix of the object names.
    title
        "Across" or "Down".
    optional
        Whether "nothing" may be chosen.
    has_textures
        Whether many textures may stand in the place of a knob.
    """

    changed = Signal()

    def __init__(
        self,
        name: str,
        title: str,
        *,
        optional: bool,
        has_textures: bool = False,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(f"What is varied {title.lower()}")
        self._title = title
        self._optional = optional
        self._params: type[Params] | None = None
        self._fields: dict[str, Field] = {}
        self.knob = ChoiceBox()
        self.knob.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.spacing = ChoiceBox()
        for place, (value, text, tip) in enumerate(SPACINGS):
            self.spacing.addItem(text, value)
            self.spacing.setItemData(place, tip_text(tip), Qt.ItemDataRole.ToolTipRole)
        self.first, self.last = NumberBox(), NumberBox()
        self.count = WholeBox()
        self.count.setRange(1, MAX_CELLS)
        self.count.setValue(COUNT)
        self.count.setPrefix("× ")
        self.listed = QLineEdit()
        self.listed.setPlaceholderText("0.1; 0.2; 0.4")
        self.boxes: list[QCheckBox] = []
        self._range = QWidget()
        self._choices = QWidget()
        self._flow = FlowLayout(self._choices)
        self._flow.setContentsMargins(0, 0, 0, 0)
        self.texture_choice = TextureChoice(name, title) if has_textures else None
        self._arrange()
        self._name_controls()
        self.knob.activated.connect(lambda _: self._knob_chosen())
        self.spacing.activated.connect(lambda _: self._spacing_chosen())
        for box in (self.first, self.last, self.count):
            box.valueChanged.connect(lambda _: self.changed.emit())
        self.listed.textEdited.connect(lambda _: self.changed.emit())
        if self.texture_choice is not None:
            self.texture_choice.changed.connect(self.changed)
        self.setFocusProxy(self.knob)

    def _arrange(self) -> None:
        label = Label(self._title)
        label.setBuddy(self.knob)
        label.setMinimumWidth(46)
        inner = QGridLayout(self._range)
        inner.setContentsMargins(0, 0, 0, 0)
        inner.setSpacing(4)
        inner.addWidget(self.first, 0, 0)
        inner.addWidget(Label("to"), 0, 1)
        inner.addWidget(self.last, 0, 2)
        inner.addWidget(self.count, 0, 3)
        for column, stretch in ((0, 3), (2, 3), (3, 2)):
            inner.setColumnStretch(column, stretch)
        for box in (self.first, self.last, self.count):
            grow_with_text(box, 58, box.setMinimumWidth)
            box.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        values = QVBoxLayout()
        values.setContentsMargins(0, 0, 0, 0)
        for widget in (self._range, self.listed, self._choices, self.texture_choice):
            if widget is not None:
                values.addWidget(widget)
        head = QHBoxLayout()
        head.setContentsMargins(0, 0, 0, 0)
        head.addWidget(label)
        head.addWidget(self.knob, 1)
        head.addWidget(self.spacing)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        for each in (head, layout):
            each.setSpacing(4)
        layout.addLayout(head)
        layout.addLayout(values)

    def _name_controls(self) -> None:
        for control, name, label, tip in (
            (self.knob, "knob", "parameter", "Which parameter is varied; seed makes variations"),
            (self.spacing, "spacing", "spacing", "Even steps, steps of equal ratio, or a list"),
            (self.first, "from", "first value", "Value of the first cell"),
            (self.last, "to", "last value", "Value of the last cell"),
            (self.count, "count", "number of values", f"How many values, 1 to {MAX_CELLS}"),
            (self.listed, "values", "list of values", "The values, separated by semicolons or spaces"),
        ):
            control.setObjectName(f"{self.objectName()}-{name}")
            control.setAccessibleName(f"{self._title}: {label}")
            set_tip(control, tip)

    # What is chosen.

    def show_method(self, params: type[Params], choice: AxisChoice | None = None) -> None:
        """Offer the knobs of a method; ``choice`` sets the editor as it was left."""
        self._params = params
        self._fields = {each.name: each for each in describe(params) if each.kind != "value"}
        self._fields["seed"] = check_knob("seed", params)
        with QSignalBlocker(self.knob):
            self.knob.clear()
            if self._optional:
                self.knob.addItem("nothing", "")
            for field in self._fields.values():
                self.knob.addItem(field.label, field.name)
                tip = field.knob.help
                self.knob.setItemData(self.knob.count() - 1, tip_text(tip), Qt.ItemDataRole.ToolTipRole)
            if self.texture_choice is not None:
                self.knob.addItem("texture", TEXTURE)
                tip = "The same parameters on many textures: a class of the gallery, a folder, or files"
                self.knob.setItemData(self.knob.count() - 1, tip_text(tip), Qt.ItemDataRole.ToolTipRole)
        if choice is not None:
            self._restore(choice)
            return
        numbers = [name for name, field in self._fields.items() if field.kind in ("float", "int")]
        self.choose_knob("" if self._optional else numbers[0])

    def choose_knob(self, name: str) -> None:
        """Vary this knob over a range that suits it; "" varies nothing."""
        with QSignalBlocker(self.knob):
            self.knob.setCurrentIndex(self.knob.findData(name))
        self._knob_chosen()

    @property
    def field(self) -> Field | None:
        """The knob that is varied."""
        return self._fields.get(self.knob.currentData() or "")

    def show_opened(self, paths: tuple[str, ...]) -> None:
        """Offer the open files as textures."""
        if self.texture_choice is not None:
            self.texture_choice.show_opened(paths)

    @property
    def textures(self) -> Textures | None:
        """The textures that run along this axis, None for a knob; raises ``ParamError`` when there are none."""
        if self.texture_choice is None or self.knob.currentData() != TEXTURE:
            return None
        return self.texture_choice.textures()

    def vary(self) -> Vary | None:
        """Return the axis, or None when nothing is varied.

        Raises
        ------
        ParamError
            When the values are out of range or no values.
        """
        field = self.field
        if field is None or self._params is None:
            return None
        if field.kind in ("bool", "choice"):
            chosen = [box.property("value") for box in self.boxes if box.isChecked()]
            if not chosen:
                raise ParamError("vary", f"at least one choice of {field.label}", "none")
            return Vary.of(field.name, chosen, self._params)
        spacing = self.spacing.currentData()
        if spacing == "list":
            return Vary.parse(f"{field.name}={','.join(parse_list(self.listed.text()))}", self._params)
        first, last = field.check(self.first.value()), field.check(self.last.value())
        return Vary(field.name, spread(field, first, last, self.count.value(), log=spacing == "log"))

    def show_vary(self, vary: Vary) -> None:
        """Set the editor to an axis: as a range where it is one."""
        self.choose_knob(vary.name)
        field = self.field
        if field is None:
            return
        if field.kind in ("bool", "choice"):
            self._check_boxes(vary.values)
            return
        self.listed.setText(written(vary.values))
        for spacing in ("even", "log", "list"):
            self._set_numbers(spacing, float(vary.values[0]), float(vary.values[-1]), len(vary.values))
            if self._makes(vary):
                break
        self._show_rows()

    def _makes(self, vary: Vary) -> bool:
        try:
            return self.vary() == vary
        except ParamError:
            return False

    @property
    def choice(self) -> AxisChoice:
        """What the editor is set to, to set it again later."""
        return AxisChoice(
            self.knob.currentData() or "",
            self.spacing.currentData(),
            self.first.value(),
            self.last.value(),
            self.count.value(),
            self.listed.text(),
            tuple(box.property("value") for box in self.boxes if box.isChecked()),
            ("", ()) if self.texture_choice is None else self.texture_choice.choice,
        )

    def _restore(self, choice: AxisChoice) -> None:
        self.choose_knob(choice.knob)
        self._set_numbers(choice.spacing, choice.first, choice.last, choice.count)
        self.listed.setText(choice.listed)
        self._check_boxes(choice.choices)
        if self.texture_choice is not None and choice.textures[0]:
            self.texture_choice.choose(*choice.textures)
        self._show_rows()

    # Reactions.

    def _knob_chosen(self) -> None:
        field = self.field
        for box in self.boxes:
            self._flow.removeWidget(box)
            box.deleteLater()
        self.boxes = []
        if field is not None and field.kind in ("bool", "choice"):
            self._make_boxes(field)
        elif field is not None:
            self._limit(field)
            first, last, spacing = usual_range(field)
            self._set_numbers(spacing, first, last, SEEDS if field.name == "seed" else COUNT)
        self._show_rows()
        self.changed.emit()

    def _spacing_chosen(self) -> None:
        field = self.field
        if field is not None and self.spacing.currentData() == "list":
            try:
                values = spread(field, self.first.value(), self.last.value(), self.count.value())
            except ParamError:
                values = ()
            self.listed.setText(written(values))
        self._show_rows()
        self.changed.emit()

    def _limit(self, field: Field) -> None:
        low = 0.0 if field.knob.low is None else float(field.knob.low)
        high = low + 100.0 if field.knob.high is None else float(field.knob.high)
        for box in (self.first, self.last):
            with QSignalBlocker(box):
                box.setDecimals(decimals(field) if field.kind == "float" else 0)
                box.setRange(low, high)
                box.setSingleStep((2 if field.knob.odd else 1) if field.kind == "int" else box_step(field))
                set_tip(box, f"{field.label}: {field.allowed}")

    def _set_numbers(self, spacing: Spacing, first: float, last: float, count: int) -> None:
        self.spacing.setCurrentIndex(self.spacing.findData(spacing))
        settings: tuple[tuple[WholeBox | NumberBox, Callable[[], None]], ...] = (
            (self.first, lambda: self.first.setValue(first)),
            (self.last, lambda: self.last.setValue(last)),
            (self.count, lambda: self.count.setValue(count)),
        )
        for box, put in settings:
            with QSignalBlocker(box):
                put()

    def _make_boxes(self, field: Field) -> None:
        values: tuple[Any, ...] = (False, True) if field.kind == "bool" else field.choices
        for value in values:
            text = ("yes" if value else "no") if field.kind == "bool" else str(value).replace("-", " ")
            box = QCheckBox(text)
            box.setObjectName(f"{self.objectName()}-choice-{text.replace(' ', '-')}")
            box.setAccessibleName(f"{self._title}: {field.label} {text}")
            set_tip(box, field.knob.choices.get(str(value), f"Whether {field.label} {text} is in the sweep"))
            box.setProperty("value", value)
            box.setChecked(True)
            box.toggled.connect(lambda _: self.changed.emit())
            self._flow.addWidget(box)
            self.boxes.append(box)

    def _check_boxes(self, values: tuple[Any, ...]) -> None:
        for box in self.boxes:
            with QSignalBlocker(box):
                box.setChecked(box.property("value") in values)

    def _show_rows(self) -> None:
        field = self.field
        is_number = field is not None and field.kind in ("float", "int")
        is_list = self.spacing.currentData() == "list"
        self.spacing.setVisible(is_number)
        self._range.setVisible(is_number and not is_list)
        self.listed.setVisible(is_number and is_list)
        self._choices.setVisible(field is not None and not is_number)
        if self.texture_choice is not None:
            self.texture_choice.setVisible(self.knob.currentData() == TEXTURE)


def usual_range(field: Field) -> tuple[float, float, Spacing]:
    """Return a range that is worth looking at: the linear part of the knob, or all of it."""
    if field.name == "seed":
        return 1.0, float(SEEDS), "even"
    low = 0.0 if field.knob.low is None else float(field.knob.low)
    high = low + 100.0 if field.knob.high is None else float(field.knob.high)
    if field.knob.linear_to is not None:
        return low, float(field.knob.linear_to), "even"
    return low, high, "log" if field.knob.log else "even"


def written(values: tuple[Any, ...]) -> str:
    """Return numbers as a list that can be read again."""
    texts = ((f"{value:.12g}", value) for value in values)
    return "; ".join(text if float(text) == value else repr(value) for text, value in texts)
