"""A combo box that may be narrower than what it says."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSizePolicy, QStyle, QStyleOptionComboBox, QStylePainter

from texlab.style.text_size import is_teaching, whole_words
from texlab.widgets.calm_wheel import ChoiceBox

if TYPE_CHECKING:
    from PySide6.QtGui import QPaintEvent
    from PySide6.QtWidgets import QWidget


class ShortBox(ChoiceBox):
    """Shortens what is chosen to the room there is, with an ellipsis; the list keeps its full width."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self._label = ""

    @property
    def label(self) -> str:
        """What is written in the box while its list is closed."""
        return self._label or self.currentText()

    def set_label(self, label: str) -> None:
        """Write this instead of what is chosen; "" writes what is chosen."""
        if label != self._label:
            self._label = label
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the box with a text that fits."""
        painter = QStylePainter(self)
        option = QStyleOptionComboBox()
        self.initStyleOption(option)
        field = self.style().subControlRect(
            QStyle.ComplexControl.CC_ComboBox, option, QStyle.SubControl.SC_ComboBoxEditField, self
        )
        room = field.width() - 4
        metrics = self.fontMetrics()
        # Nobody in the back row can do anything with half a word.
        fit = whole_words(self.label, metrics, room) if is_teaching() else None
        option.currentText = fit or metrics.elidedText(self.label, Qt.TextElideMode.ElideRight, room)
        painter.drawComplexControl(QStyle.ComplexControl.CC_ComboBox, option)
        painter.drawControl(QStyle.ControlElement.CE_ComboBoxLabel, option)

    def showPopup(self) -> None:
        """Make the list as wide as its longest entry."""
        widest = max(
            (self.fontMetrics().horizontalAdvance(self.itemText(k)) for k in range(self.count())), default=0
        )
        self.view().setMinimumWidth(widest + 32)
        super().showPopup()
