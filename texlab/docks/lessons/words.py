"""What is said at a step: note, question with its answer behind a button, what to try, the slider of a series."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QScrollArea, QVBoxLayout, QWidget

from texlab.widgets.once import Once
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.slider import Slider

if TYPE_CHECKING:
    from texlab_core.documents.lessons import LessonStep


MARGIN = 9


class StepWords(QScrollArea):
    """Shows the words of a step; ``slid(parameter, value)`` when its slider is moved."""

    slid = Signal(str, object)

    def __init__(self) -> None:
        super().__init__()
        self._step: LessonStep | None = None
        self.note = words("lessons-note")
        self.question = words("lessons-question")
        self.answer = words("lessons-answer")
        self.try_this = words("lessons-try")
        self.reveal = QPushButton("Show the answer")
        self.reveal.setObjectName("lessons-reveal")
        self.reveal.setCheckable(True)
        self.reveal.toggled.connect(self._show_answer)
        # Words below grow first.
        self._into_sight = Once(self, 0, lambda: self.ensureWidgetVisible(self.answer, 0, 0))
        set_tip(self.reveal, "The answer to the question, once everybody has had a try")
        self.slider_label = Label(name="lessons-series-value")
        self.slider = Slider("Value of the step", self._said)
        self.slider.setObjectName("lessons-series")
        self.slider.valueChanged.connect(self._slid)
        self._slider_row = QWidget()
        row = QHBoxLayout(self._slider_row)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.slider, 1)
        row.addWidget(self.slider_label)
        inner = QWidget()
        column = QVBoxLayout(inner)
        column.setContentsMargins(MARGIN, 1, MARGIN, 1)
        for each in (self._slider_row, self.note, self.question, self.reveal, self.answer, self.try_this):
            column.addWidget(each)
        column.addStretch(1)
        self.setObjectName("lessons-words")
        self.setAccessibleName("Words of the step")
        self.setWidgetResizable(True)
        self.setWidget(inner)

    def least_height(self, width: int) -> int:
        """Return the height in which what students are asked need not be scrolled; a note alone gives way."""
        inner = self.widget()
        if self._step is None or inner is None or not (self._step.question or self._step.series):
            return self.minimumSizeHint().height()
        return max(inner.minimumSizeHint().height(), inner.heightForWidth(width))

    def show_step(self, step: LessonStep | None) -> None:
        """Show a step, its answer hidden; or what to do when there is none."""
        self._step = step
        if step is None:
            texts = ("Click a lesson to give it, or choose it and press Enter.", "", "", "")
        else:
            texts = (step.note, step.question, step.answer, f"Try: {step.try_this}" if step.try_this else "")
        for label, text in zip((self.note, self.question, self.answer, self.try_this), texts, strict=True):
            label.setText(text)
            label.setVisible(bool(text))
        self.reveal.setChecked(False)
        self.answer.setVisible(False)
        self.reveal.setVisible(bool(texts[2]))
        series = None if step is None else step.series
        self._slider_row.setVisible(series is not None)
        if series is not None and step is not None:
            own = step.columns[series.column].params().to_json().get(series.parameter)
            blocked = self.slider.blockSignals(True)
            self.slider.setRange(0, len(series.values) - 1)
            self.slider.setPageStep(1)
            self.slider.setValue(series.values.index(own) if own in series.values else 0)
            self.slider.blockSignals(blocked)
            self._tell_value(series.parameter, own)

    def _show_answer(self, shown: bool) -> None:
        self.answer.setVisible(shown)
        if shown:
            self._into_sight.start()

    def _said(self, _place: int) -> str:
        return self.slider_label.text()

    def _tell_value(self, parameter: str, value: Any) -> None:
        self.slider_label.setText(f"{parameter.replace('_', ' ')} {value}")
        self.slider.tell()

    def _slid(self, place: int) -> None:
        if self._step is not None and self._step.series is not None:
            series = self._step.series
            self._tell_value(series.parameter, series.values[place])
            self.slid.emit(series.parameter, series.values[place])


def words(name: str, *, muted: bool = False) -> Label:
    """Return a label of several lines whose text can be selected."""
    label = Label(name=name, wraps=True)
    label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    if muted:
        label.setProperty("role", "muted")
    return label
