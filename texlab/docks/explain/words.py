"""Lines of text that change often: painted where they are, without a new layout of the window."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QSize
from PySide6.QtGui import QColor, QPainter
from PySide6.QtWidgets import QSizePolicy, QWidget

from texlab.style.text_size import is_teaching
from texlab.style.theme import DARK, LIGHT
from texlab.widgets.plain import set_tip

if TYPE_CHECKING:
    from PySide6.QtGui import QPaintEvent

    from texlab.style.theme import Theme

Part = tuple[str, str]
# What does not fit is in the tooltip.
MORE = " \u2026"


class Words(QWidget):
    """Shows parts of text, each in the colour of a role of the theme, in a fixed number of lines."""

    def __init__(self, name: str, label: str, lines: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(label)
        self._lines = lines
        self._parts: tuple[Part, ...] = ()
        self._theme: Theme = DARK if self.palette().window().color().lightness() < 128 else LIGHT
        # Large text leaves some of its lines to the pictures, where there is no room for all.
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Maximum)

    def text(self) -> str:
        """Return what is written."""
        return "".join(words for words, _ in self._parts)

    def show_parts(self, *parts: Part) -> None:
        """Write (text, role) parts, broken into lines where the width ends."""
        if parts != self._parts:
            self._parts = parts
            self.setAccessibleDescription(self.text())
            set_tip(self, self.text())
            self.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.update()

    def sizeHint(self) -> QSize:
        """Ask for the lines; large text is broken into twice as many."""
        lines = self._lines * (2 if is_teaching() else 1)
        return QSize(100, lines * self.fontMetrics().lineSpacing() + 2)

    def minimumSizeHint(self) -> QSize:
        """Return the height of the lines; large text may end with the sign that there is more."""
        return QSize(40, self._lines * self.fontMetrics().lineSpacing() + 2)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the parts one after the other, word by word; what has no room gives way to an ellipsis."""
        painter = QPainter(self)
        metrics = self.fontMetrics()
        pieces = [(piece, role) for words, role in self._parts for piece in re.findall(r"\s*\S+|\s+", words)]
        rows = max(1, self.height() // metrics.lineSpacing())
        left, row = 0.0, 1
        for place, (piece, role) in enumerate(pieces):
            painter.setPen(QColor(getattr(self._theme, role)))
            rest = metrics.horizontalAdvance("".join(each for each, _ in pieces[place:])) if row == rows else 0
            # In the last line there is room for the sign that something is left out, where it is needed.
            room = self.width() - (metrics.horizontalAdvance(MORE) if left + rest > self.width() else 0)
            if left and left + metrics.horizontalAdvance(piece) > room:
                if row == rows:
                    painter.drawText(QPointF(left, self._base(row)), MORE)
                    break
                left, row, piece = 0.0, row + 1, piece.lstrip()
            painter.drawText(QPointF(left, self._base(row)), piece)
            left += metrics.horizontalAdvance(piece)
        painter.end()

    def _base(self, row: int) -> float:
        return float(self.fontMetrics().ascent() + (row - 1) * self.fontMetrics().lineSpacing())
