"""A combo box that may be narrower than what it says."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSizePolicy

from texlab.style.text_size import MORE, is_teaching, whole_words
from texlab.widgets.calm_wheel import ChoiceBox

if TYPE_CHECKING:
    from PySide6.QtGui import QFontMetrics
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


def shortened(text: str, metrics: QFontMetrics, room: float) -> str:
    """Return a text that fits, with a sign where something is left out: whole words when it is read from afar."""
    if not is_teaching() or metrics.horizontalAdvance(text) <= room:
        return metrics.elidedText(text, Qt.TextElideMode.ElideRight, int(room))
    # Nobody in the back row can do anything with half a word.
    fit = whole_words(text, metrics, room - metrics.horizontalAdvance(f" {MORE}"))
    return fit if fit.endswith(MORE) else f"{fit} {MORE}"
