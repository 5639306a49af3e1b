"""Numbers in cells: upright, with as many digits as there is room for."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, NamedTuple

from PySide6.QtCore import Qt
from PySide6.QtGui import QFont, QFontMetricsF

from texlab.style.text_size import smaller

if TYPE_CHECKING:
    from PySide6.QtCore import QRectF
    from PySide6.QtGui import QPainter

NARROW = 0.82
# Of the usual width of letters, in per cent.
CONDENSED = 75
MOST_KEPT = 4096


class _Fitted(NamedTuple):
    words: str
    font: QFont


class NumberWriter:
    """Writes into cells with one font; what was found to fit is remembered."""

    def __init__(self, font: QFont) -> None:
        self.key = font.key()
        self._fonts = {
            bold: [
                _made(font, 1.0, bold=bold),
                _made(font, NARROW, bold=bold),
                # Condensed bold letters run together.
                _made(font, NARROW, bold=False, stretch=CONDENSED),
            ]
            for bold in (False, True)
        }
        self._known: dict[tuple[tuple[str, ...], bool, float, float], _Fitted | None] = {}

    def write(self, painter: QPainter, texts: tuple[str, ...], area: QRectF, *, bold: bool) -> None:
        """Write the first of several texts that fits, or none."""
        key = (texts, bold, round(area.width(), 1), round(area.height(), 1))
        if key not in self._known:
            if len(self._known) > MOST_KEPT:
                self._known.clear()
            self._known[key] = self._fit(texts, area, self._fonts[bold])
        fitted = self._known[key]
        if fitted is not None:
            painter.setFont(fitted.font)
            painter.drawText(area, Qt.AlignmentFlag.AlignCenter, fitted.words)

    @staticmethod
    def _fit(texts: tuple[str, ...], area: QRectF, fonts: list[tuple[QFont, QFontMetricsF]]) -> _Fitted | None:
        for words, (font, metrics) in product(texts, fonts):
            high = metrics.ascent() + metrics.descent() - 2
            if metrics.horizontalAdvance(words) <= area.width() - 1 and high <= area.height() + 2:
                return _Fitted(words, font)
        return None


def _made(font: QFont, size: float, *, bold: bool, stretch: int = 100) -> tuple[QFont, QFontMetricsF]:
    made = QFont(font)
    made.setStretch(stretch)
    made.setPointSizeF(smaller(font.pointSizeF(), size, 0.0))
    made.setBold(bold)
    return made, QFontMetricsF(made)
