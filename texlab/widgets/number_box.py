"""The window's number boxes: both decimal signs are read, one is written; nothing becomes another number."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QLocale
from PySide6.QtGui import QValidator
from PySide6.QtWidgets import QAbstractSpinBox, QDoubleSpinBox, QSpinBox

from texlab.style.numbers import parse_number

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget

_Read = tuple[QValidator.State, str, int]


def _plain_locale() -> QLocale:
    locale = QLocale(QLocale.Language.C)
    locale.setNumberOptions(QLocale.NumberOption.OmitGroupSeparator)
    return locale


def _bare(box: QAbstractSpinBox, text: str, prefix: str, suffix: str) -> str:
    """Return what was typed, without what the box itself writes around it."""
    return text.strip().removeprefix(prefix.strip()).removesuffix(suffix.strip()).strip()


class NumberBox(QDoubleSpinBox):
    """A number box that takes 0.25 and 0,25 alike, whatever the language of the machine.

    What is no number, or lies outside the range, can be typed but is not taken: the box goes back to its value.
    """

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setLocale(_plain_locale())
        self.setCorrectionMode(QAbstractSpinBox.CorrectionMode.CorrectToPreviousValue)
        self.setKeyboardTracking(False)

    def validate(self, text: str, position: int) -> _Read:
        """Let anything be typed; only a number within the range is acceptable."""
        typed = _bare(self, text, self.prefix(), self.suffix())
        value = parse_number(typed)
        if value is not None and self.minimum() <= value <= self.maximum():
            state = QValidator.State.Acceptable
        else:
            # Never invalid: Qt would swallow the key, and "1.2.3" become 1.23.
            state = QValidator.State.Intermediate
        return state, text, position

    def valueFromText(self, text: str) -> float:
        """Return the number that was typed; the value of the box when it is none."""
        value = parse_number(_bare(self, text, self.prefix(), self.suffix()))
        return self.value() if value is None else value

    def fixup(self, text: str) -> str:
        """Leave what was typed: Qt would take a decimal comma out of it and make another number."""
        return text


class WholeBox(QSpinBox):
    """A box for whole numbers; what is none, or lies outside the range, is not taken."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setLocale(_plain_locale())
        self.setCorrectionMode(QAbstractSpinBox.CorrectionMode.CorrectToPreviousValue)
        self.setKeyboardTracking(False)

    def validate(self, text: str, position: int) -> _Read:
        """Let anything be typed; only a whole number within the range is acceptable."""
        typed = _bare(self, text, self.prefix(), self.suffix())
        value = parse_number(typed)
        if value is not None and value == round(value) and self.minimum() <= value <= self.maximum():
            state = QValidator.State.Acceptable
        else:
            # Never invalid: Qt would swallow the key, and "1.2.3" become 1.23.
            state = QValidator.State.Intermediate
        return state, text, position

    def valueFromText(self, text: str) -> int:
        """Return the number that was typed; the value of the box when it is none."""
        value = parse_number(_bare(self, text, self.prefix(), self.suffix()))
        return self.value() if value is None or value != round(value) else round(value)

    def fixup(self, text: str) -> str:
        """Leave what was typed: Qt would take a decimal comma out of it and make another number."""
        return text

    @property
    def typed(self) -> int | None:
        """The number that stands in the box, taken or not yet; None while it is none, or out of range."""
        text = self.lineEdit().text()
        acceptable = self.validate(text, 0)[0] == QValidator.State.Acceptable
        return self.valueFromText(text) if acceptable else None
