"""The few lines under a picture: as many whole parts as fit, never half a line."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QRect, QSize, Qt
from PySide6.QtWidgets import QSizePolicy

from texlab.style.text_size import MORE, whole_words
from texlab.widgets.plain import Label, set_tip

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PySide6.QtGui import QResizeEvent
    from PySide6.QtWidgets import QWidget

LINES = 3
SEPARATOR = " · "
_TALL = 10_000


def strut(model: QWidget) -> QWidget:
    """Return ``model`` as something unseen that keeps a row as high as itself, whatever the font."""
    policy = model.sizePolicy()
    policy.setRetainSizeWhenHidden(True)
    model.setSizePolicy(policy)
    model.setObjectName("strut")
    model.setFixedWidth(1)
    model.setFocusPolicy(Qt.FocusPolicy.NoFocus)
    model.hide()
    return model


class StatusLine(Label):
    """Shows parts of a sentence on a fixed number of lines; what does not fit is in the tool tip.

    The height is the same whatever is shown: pictures side by side stay at the same level.
    """

    def __init__(self, parent: QWidget | None = None, lines: int = LINES) -> None:
        super().__init__(parent=parent)
        self._lines = lines
        self._parts: tuple[str, ...] = ()
        self._details: tuple[str, ...] = ()
        self.setProperty("role", "muted")
        self.setWordWrap(True)
        self.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)

    def show_parts(self, parts: Sequence[str], details: Sequence[str] = ()) -> None:
        """Show these parts, the most important first; the tool tip has them all, and the details line by line."""
        if (tuple(parts), tuple(details)) != (self._parts, self._details):
            self._details = tuple(details)
            set_tip(self, "\n".join([SEPARATOR.join(parts), *self._details]))
        if tuple(parts) != self._parts:
            self._parts = tuple(parts)
            self._fit()

    def set_lines(self, lines: int) -> None:
        """Use this many lines."""
        if lines != self._lines:
            self._lines = lines
            self.updateGeometry()
            self._fit()

    def sizeHint(self) -> QSize:
        """Return the size of all lines."""
        return QSize(0, self.fontMetrics().lineSpacing() * self._lines + 2)

    def minimumSizeHint(self) -> QSize:
        """Return the size of all lines."""
        return self.sizeHint()

    def heightForWidth(self, width: int) -> int:
        """Return the height of all lines."""
        return self.sizeHint().height()

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Use the room there is."""
        super().resizeEvent(event)
        self._fit()

    def changeEvent(self, event: QEvent) -> None:
        """Follow the font."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self.updateGeometry()
            self._fit()

    def _fit(self) -> None:
        shown = list(self._parts)
        text = self._wrapped(shown)
        while len(shown) > 1 and not self._fits(text):
            shown.pop()
            text = f"{self._wrapped(shown)} {MORE}"
        words = text.split(" ")
        while len(words) > 1 and not self._fits(text):
            words.pop()
            text = f"{' '.join(words).rstrip(' ' + MORE)} {MORE}"
        if not self._fits(text):
            # A single word, or a part of it.
            text = whole_words(f"{words[0]}{MORE}", self.fontMetrics(), self.width())
        self.setText(text)

    def _wrapped(self, parts: Sequence[str]) -> str:
        """Join parts, with a new line before one that would be broken."""
        lines: list[str] = []
        for part in parts:
            longer = f"{lines[-1]}{SEPARATOR}{part}" if lines else part
            if lines and self.fontMetrics().horizontalAdvance(longer) < self.width() - 1:
                lines[-1] = longer
            else:
                lines.append(part)
        return "\n".join(lines)

    def _fits(self, text: str) -> bool:
        room = QRect(0, 0, max(self.width(), 1), _TALL)
        flags = int(Qt.TextFlag.TextWordWrap.value)
        # Beside a low picture there may be less room than for all lines.
        high = min(self.sizeHint().height(), max(self.height(), self.fontMetrics().lineSpacing()))
        return self.fontMetrics().boundingRect(room, flags, text).height() <= high
