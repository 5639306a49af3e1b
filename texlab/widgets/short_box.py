"""A combo box that may be narrower than what it says."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QSizePolicy

from texlab.style.text_size import shortened
from texlab.widgets.calm_wheel import ChoiceBox

if TYPE_CHECKING:
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

    @property
    def whole_width(self) -> int:
        """Pixels of the box with all of its label."""
        return self.fontMetrics().horizontalAdvance(self.label) + self.width() - self.text_room + 8

    def set_label(self, label: str) -> None:
        """Write this instead of what is chosen; "" writes what is chosen."""
        if label != self._label:
            self._label = label
            self.update()

    @property
    def shown_text(self) -> str:
        """The label, or its first words where there is no room for all."""
        return shortened(self.label, self.fontMetrics(), self.text_room - 4)

    def showPopup(self) -> None:
        """Make the list as wide as its longest entry."""
        widest = max(
            (self.fontMetrics().horizontalAdvance(self.itemText(k)) for k in range(self.count())), default=0
        )
        self.view().setMinimumWidth(widest + 32)
        super().showPopup()
