"""Bars above and below zero in groups, for what subbands add to a pixel; for mouse and keyboard."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from texlab.docks.explain.painted_choice import PaintedChoice
from texlab.style.numbers import number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PySide6.QtGui import QPaintEvent
    from PySide6.QtWidgets import QWidget

GAP = 14.0
TYPICAL = 2.0


@dataclass(frozen=True, slots=True)
class Bar:
    """One bar.

    Parameters
    ----------
    group
        Name below neighbouring bars of the same group.
    label
        Name below the bar.
    value
        Its height, of any sign.
    spread
        Standard deviation of such values: twice as far goes the light area behind the bar.
    title
        Its name in words.
    """

    group: str
    label: str
    value: float
    spread: float
    title: str


class BandBars(PaintedChoice):
    """Shows bars; ``chosen`` and ``hovered`` tell the index of one, -1 for none."""

    def __init__(self, name: str, label: str, parent: QWidget | None = None) -> None:
        super().__init__(name, label, parent)
        self._bars: tuple[Bar, ...] = ()
        self._limit = 1.0

    @property
    def bars(self) -> tuple[Bar, ...]:
        """What is shown."""
        return self._bars

    def show_bars(self, bars: Sequence[Bar]) -> None:
        """Show bars at one scale, in which the light areas stay as they are from pixel to pixel."""
        self._bars = tuple(bars)
        reach = [max(abs(bar.value), TYPICAL * bar.spread) for bar in self._bars]
        self._limit = max(reach, default=0.0) or 1.0
        self.select(self._selected)

    def descriptions(self) -> list[str]:
        """Return every bar in words."""
        return [f"{bar.title}: {number(bar.value)}" for bar in self._bars]

    def sizeHint(self) -> QSize:
        """Ask for bars that hold their names."""
        return QSize(40 * max(len(self._bars), 4), 160)

    def part_rect(self, index: int) -> QRectF:
        """Return the column in which a bar stands, above and below its name too."""
        return self.bar_rect(index).adjusted(0, 0, 0, self.height())

    def bar_rect(self, index: int) -> QRectF:
        """Return the column in which a bar stands, all of its height."""
        groups = self._groups()
        width = max(2.0, (self.width() - GAP * len(groups)) / max(1, len(self._bars)))
        before = next((place for place, (first, last) in enumerate(groups) if first <= index < last), 0)
        return QRectF(GAP / 2 + before * GAP + index * width, 0, width, self._floor())

    def value_y(self, value: float) -> float:
        """Return where a value lies on the screen, from the top."""
        return self._floor() / 2 * (1 - 0.94 * value / self._limit)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint areas, bars and names."""
        if self._theme is None or not self._bars:
            return
        theme, metrics = self._theme, self.fontMetrics()
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(theme.base))
        middle = self.value_y(0.0)
        for index, bar in enumerate(self._bars):
            column = self.bar_rect(index)
            wide = column.adjusted(1, 0, -1, 0)
            top, bottom = self.value_y(TYPICAL * bar.spread), self.value_y(-TYPICAL * bar.spread)
            painter.fillRect(QRectF(wide.left(), top, wide.width(), bottom - top), QColor(theme.raised))
            room = min(column.width() * 0.25, 8.0)
            end = self.value_y(bar.value)
            # The sign is said twice: by the side of the line and by the colour.
            colour = QColor(theme.result if bar.value >= 0 else theme.exemplar)
            area = QRectF(column.left() + room, min(middle, end), column.width() - 2 * room, abs(end - middle))
            painter.fillRect(area, colour)
            if index == self._selected:
                painter.setPen(QPen(QColor(theme.accent), 3 if self.hasFocus() else 2))
                painter.drawRect(wide.adjusted(1, 1, -1, -1))
            painter.setPen(QColor(theme.muted))
            if metrics.horizontalAdvance(bar.label) <= column.width():
                below = QRectF(column.left(), self._floor(), column.width(), metrics.height())
                painter.drawText(below, Qt.AlignmentFlag.AlignCenter, bar.label)
        painter.setPen(QColor(theme.text))
        painter.drawLine(0, round(middle), self.width(), round(middle))
        for first, last in self._groups():
            left, right = self.bar_rect(first).left(), self.bar_rect(last - 1).right()
            name = QRectF(left - GAP / 2, self._floor() + metrics.height(), right - left + GAP, metrics.height())
            words = metrics.elidedText(self._bars[first].group, Qt.TextElideMode.ElideRight, round(name.width()))
            painter.drawText(name, Qt.AlignmentFlag.AlignCenter, words)
        painter.end()

    def reached(self, key: Qt.Key) -> int | None:
        """Go to the next bar, the first or the last."""
        return {
            Qt.Key.Key_Left: self._selected - 1,
            Qt.Key.Key_Right: self._selected + 1,
            Qt.Key.Key_Home: 0,
            Qt.Key.Key_End: len(self._bars) - 1,
        }.get(key)

    def _floor(self) -> float:
        """Return where the names begin."""
        return max(20.0, self.height() - 2.0 * self.fontMetrics().height())

    def _groups(self) -> list[tuple[int, int]]:
        """Return first and last + 1 of the bars of each group."""
        bars = self._bars
        starts = [k for k in range(len(bars)) if k == 0 or bars[k].group != bars[k - 1].group]
        return list(zip(starts, [*starts[1:], len(bars)], strict=True))
