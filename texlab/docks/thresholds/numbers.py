"""Numbers in cells: as large as there is room, upwards where a cell is narrow."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, NamedTuple

from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFont, QFontMetricsF

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PySide6.QtGui import QPainter

NARROW = 0.82
MOST_KEPT = 4096


class _Fitted(NamedTuple):
    words: str
    font: QFont
    upwards: bool


class NumberWriter:
    """Writes into cells of one size; what was found to fit is remembered."""

    def __init__(self, font: QFont, width: float, height: float) -> None:
        self.key = (font.key(), width, height)
        self._width, self._height = width, height
        self._fonts = {bold: [_scaled(font, size, bold=bold) for size in (1.0, NARROW)] for bold in (False, True)}
        self._known: dict[tuple[Sequence[str], bool], _Fitted | None] = {}

    def write(self, painter: QPainter, texts: tuple[str, ...], area: QRectF, *, bold: bool) -> None:
        """Write the first of several texts that fits, or none."""
        key = (texts, bold)
        if key not in self._known:
            if len(self._known) > MOST_KEPT:
                self._known.clear()
            self._known[key] = self._fit(texts, self._fonts[bold])
        fitted = self._known[key]
        if fitted is None:
            return
        painter.setFont(fitted.font)
        if not fitted.upwards:
            painter.drawText(area, Qt.AlignmentFlag.AlignCenter, fitted.words)
            return
        transform = painter.transform()
        painter.translate(area.center())
        painter.rotate(-90)
        turned = QRectF(-area.height() / 2, -area.width() / 2, area.height(), area.width())
        painter.drawText(turned, Qt.AlignmentFlag.AlignCenter, fitted.words)
        painter.setTransform(transform)

    def _fit(self, texts: tuple[str, ...], fonts: list[tuple[QFont, QFontMetricsF]]) -> _Fitted | None:
        for words, (font, metrics) in product(texts, fonts):
            long, high = metrics.horizontalAdvance(words), metrics.ascent() + metrics.descent() - 2
            if long <= self._width - 2 and high <= self._height + 2:
                return _Fitted(words, font, upwards=False)
            if long <= self._height - 2 and high <= self._width + 2:
                return _Fitted(words, font, upwards=True)
        return None


def _scaled(font: QFont, size: float, *, bold: bool) -> tuple[QFont, QFontMetricsF]:
    made = QFont(font)
    made.setPointSizeF(font.pointSizeF() * size)
    made.setBold(bold)
    return made, QFontMetricsF(made)
