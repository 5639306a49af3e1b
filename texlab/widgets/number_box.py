"""The window's number boxes: both decimal signs are read, one is written; nothing becomes another number."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QLocale
from PySide6.QtGui import QValidator
from PySide6.QtWidgets import QAbstractSpinBox, QDoubleSpinBox, QSpinBox

from texlab.style.numbers import parse_number
from texlab.widgets.calm_wheel import CalmWheel

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget

_Read = tuple[QValidator.State, str, int]


def _prepare(box: NumberBox | WholeBox) -> None:
    box.keep_wheel_calm()
    locale = QLocale(QLocale.Language.C)
    locale.setNumberOptions(QLocale.NumberOption.OmitGroupSeparator)
    box.setLocale(locale)
    box.setCorrectionMode(QAbstractSpinBox.CorrectionMode.CorrectToPreviousValue)
    box.setKeyboardTracking(False)


def _typed(box: QSpinBox | QDoubleSpinBox, text: str) -> float | None:
    """Return the number that was typed, without what the box itself writes around it; None for no number."""
    bare = text.strip().removeprefix(box.prefix().strip()).removesuffix(box.suffix().strip()).strip()
    return parse_number(bare)


def _judged(box: QSpinBox | QDoubleSpinBox, value: float | None, text: str, position: int) -> _Read:
    """Let anything be typed; only a number within the range is acceptable."""
    if value is not None and box.minimum() <= value <= box.maximum():
        return QValidator.State.Acceptable, text, position
    # Never invalid: Qt would swallow the key, and "1.2.3" become 1.23.
    return QValidator.State.Intermediate, text, position


def _shows(box: QSpinBox | QDoubleSpinBox, written: str) -> bool:
    """Whether the box shows this number: Qt would repaint it all the same, at every event of a drag."""
    return box.text() == f"{box.prefix()}{written}{box.suffix()}"


class NumberBox(CalmWheel, QDoubleSpinBox):
    """A number box that takes 0.25 and 0,25 alike, whatever the language of the machine.

    What is no number, or lies outside the range, can be typed but is not taken: the box goes back to its value.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        _prepare(self)

    def setValue(self, value: float) -> None:
        """Take and show a value."""
        if value != self.value() or not _shows(self, self.textFromValue(value)):
            super().setValue(value)

    def validate(self, text: str, position: int) -> _Read:
        """Let anything be typed; only a number within the range is acceptable."""
        return _judged(self, self._read(text), text, position)

    def valueFromText(self, text: str) -> float:
        """Return the number that was typed; the value of the box when it is none."""
        value = self._read(text)
        return self.value() if value is None else value

    def _read(self, text: str) -> float | None:
        return _typed(self, text)

    def fixup(self, text: str) -> str:
        """Leave what was typed: Qt would take a decimal comma out of it and make another number."""
        return text


class ShareBox(NumberBox):
    """A number box for a share up to 1, written in percent: ``50``, ``50 %``, ``0.5``, ``×0.5`` are a half."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        # No suffix of Qt's: that would stay behind a factor, too.
        self.setDecimals(5)

    def textFromValue(self, value: float) -> str:
        """Return the share in percent."""
        return f"{100 * value:.4g} %"

    def _read(self, text: str) -> float | None:
        bare = text.strip()
        factor = bare.lstrip("×xX*")
        value = parse_number(factor.removesuffix("%").strip())
        if value is None:
            return None
        # No picture is reduced to less than one percent.
        return value if factor != bare or (value < 1 and "%" not in factor) else value / 100


class WholeBox(CalmWheel, QSpinBox):
    """A box for whole numbers; what is none, or lies outside the range, is not taken."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        _prepare(self)

    def setValue(self, value: int) -> None:
        """Take and show a value."""
        if value != self.value() or not _shows(self, self.textFromValue(value)):
            super().setValue(value)

    def validate(self, text: str, position: int) -> _Read:
        """Let anything be typed; only a whole number within the range is acceptable."""
        return _judged(self, self._whole(text), text, position)

    def valueFromText(self, text: str) -> int:
        """Return the number that was typed; the value of the box when it is none."""
        value = self._whole(text)
        return self.value() if value is None else value

    def _whole(self, text: str) -> int | None:
        value = _typed(self, text)
        return None if value is None or value != round(value) else round(value)

    def fixup(self, text: str) -> str:
        """Leave what was typed: Qt would take a decimal comma out of it and make another number."""
        return text

    @property
    def typed(self) -> int | None:
        """The number that stands in the box, taken or not yet; None while it is none, or out of range."""
        text = self.lineEdit().text()
        acceptable = self.validate(text, 0)[0] == QValidator.State.Acceptable
        return self.valueFromText(text) if acceptable else None
