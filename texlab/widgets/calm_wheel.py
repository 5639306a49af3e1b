"""Boxes and sliders that leave the wheel to what scrolls, unless they have the keyboard."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QSize, Qt
from PySide6.QtGui import QPainter, QPen
from PySide6.QtWidgets import QComboBox, QStyle, QStyleOptionComboBox, QStylePainter

from texlab.style.text_size import text_scale

if TYPE_CHECKING:
    from PySide6.QtGui import QPaintEvent, QWheelEvent
    from PySide6.QtWidgets import QWidget

# Pixels across the arrow of a list beside text of the usual size.
ARROW = 8


class CalmWheel:
    """Put before a widget's class: the wheel changes its value only while it has the keyboard.

    Whoever scrolls a panel with the pointer over a box would else change what the box says. Qt passes on what a
    widget ignores to those around it. The wheel does not give it the keyboard either: :meth:`keep_wheel_calm` is
    called once the widget is made.
    """

    def keep_wheel_calm(self) -> None:
        """Let clicks and Tab alone give the widget the keyboard."""
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)  # type: ignore[attr-defined]  # the widget's class follows

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Turn the value, or leave the wheel to what is around."""
        if self.hasFocus():  # type: ignore[attr-defined]  # the widget's class comes after this one
            super().wheelEvent(event)  # type: ignore[misc]
        else:
            event.ignore()


class ChoiceBox(CalmWheel, QComboBox):
    """A list to choose from; every one of the window is one. Its arrow is as large as its text."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.keep_wheel_calm()

    @property
    def shown_text(self) -> str:
        """What is written in the box, which has :attr:`text_room` pixels."""
        return self.currentText()

    @property
    def text_room(self) -> int:
        """Pixels for the text."""
        option = QStyleOptionComboBox()
        self.initStyleOption(option)
        field = self.style().subControlRect(
            QStyle.ComplexControl.CC_ComboBox, option, QStyle.SubControl.SC_ComboBoxEditField, self
        )
        return int(field.width()) - self._more

    @property
    def _more(self) -> int:
        """Pixels that the arrow takes beyond those that the style gives it."""
        return round((text_scale(self) - 1) * ARROW)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the box, its text, and the arrow."""
        painter = QStylePainter(self)
        option = QStyleOptionComboBox()
        self.initStyleOption(option)
        option.currentText = self.shown_text
        # The style's own arrow has one size, whatever the text has.
        option.subControls = option.subControls & ~QStyle.SubControl.SC_ComboBoxArrow
        painter.drawComplexControl(QStyle.ComplexControl.CC_ComboBox, option)
        arrow = self.style().subControlRect(
            QStyle.ComplexControl.CC_ComboBox, option, QStyle.SubControl.SC_ComboBoxArrow, self
        )
        half = ARROW * text_scale(self) / 2
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(option.palette.buttonText(), half / 2.5))
        at = QPointF(arrow.center().x() + 0.5 - self._more / 2, self.height() / 2)
        painter.drawPolyline([at + QPointF(x * half, y * half) for x, y in ((-1, -0.5), (0, 0.5), (1, -0.5))])
        rect = option.rect
        rect.setRight(rect.right() - self._more)
        option.rect = rect
        painter.drawControl(QStyle.ControlElement.CE_ComboBoxLabel, option)

    def sizeHint(self) -> QSize:
        """Return the size with the arrow."""
        return super().sizeHint() + QSize(self._more, 0)

    def minimumSizeHint(self) -> QSize:
        """Return the least size with the arrow."""
        return super().minimumSizeHint() + QSize(self._more, 0)
