"""Parent structures as bars: the pixel's, a candidate's, and the limits that the thresholds set."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QHelpEvent, QPainter, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from texlab.docks.thresholds.painting import CHANNEL_COLOURS, draw_glyph
from texlab.style.theme import DARK, LIGHT
from texlab.widgets.plain import set_tip, show_tip

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtGui import QPaintEvent

    from texlab.docks.thresholds.table import Head
    from texlab.style.theme import Theme

# Normalized features have a standard deviation of 1.
LEAST_RANGE, MOST_RANGE = 2.5, 8.0
GROUP_GAP = 5.0
ROOM_FOR_GLYPH = 9.0


@dataclass(frozen=True, eq=False)
class Structure:
    """What the bars show, all (rows, columns) float32: normalized features, rows coarsest first.

    Parameters
    ----------
    heads
        What the columns are.
    names
        What the rows are.
    pixel, candidate
        Parent structures of the pixel and of the candidate beside it.
    lowest, highest
        Of all candidates.
    thresholds
        T: the limits are the pixel's value plus and minus its square root.
    """

    heads: tuple[Head, ...]
    names: tuple[str, ...]
    pixel: NDArray[np.float32]
    candidate: NDArray[np.float32]
    lowest: NDArray[np.float32]
    highest: NDArray[np.float32]
    thresholds: NDArray[np.float32]

    def describe(self, row: int, column: int) -> str:
        """Return one bar in words."""
        value, other = float(self.pixel[row, column]), float(self.candidate[row, column])
        difference, threshold = (other - value) ** 2, float(self.thresholds[row, column])
        return (
            f"{self.heads[column].title}, {self.names[row]}: pixel {value:.2f}, candidate {other:.2f}, "
            f"D = {difference:.3g}, T = {threshold:.3g}"
        )


class StructureView(QWidget):
    """Draws a :class:`Structure`."""

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName("Parent structure of the pixel and of a candidate")
        set_tip(
            self,
            "The parent structure: one bar for each feature of each coarser level. Wide bars: the pixel. "
            "Lines: the candidate. Shaded: what the thresholds allow. Thin lines: all candidates. The heights are "
            "square roots of the normalized features.",
        )
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self._theme: Theme = DARK if self.palette().window().color().lightness() < 128 else LIGHT
        self._shown: Structure | None = None

    @property
    def shown(self) -> Structure | None:
        """What is shown."""
        return self._shown

    def show_structure(self, structure: Structure | None) -> None:
        """Show bars, or nothing where a level has no parents."""
        self._shown = structure
        self.updateGeometry()
        self.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.update()

    def sizeHint(self) -> QSize:
        """Ask for little: docks are low."""
        return QSize(320, 120)

    def minimumSizeHint(self) -> QSize:
        """Return what can still be seen."""
        rows = 2 if self._shown is None else len(self._shown.names)
        metrics = self.fontMetrics()
        return QSize(160, max(70, round(metrics.ascent() + 5 + rows * (metrics.capHeight() + 1))))

    def cell_rect(self, row: int, column: int) -> QRectF:
        """Return where a bar with its limits is painted."""
        left, top, width, height = self._geometry()
        return QRectF(left + column * width + self._gap(column), top + row * height, width, height)

    def _gap(self, column: int) -> float:
        assert self._shown is not None
        heads = self._shown.heads
        return GROUP_GAP * sum(heads[k].group != heads[k + 1].group for k in range(column))

    def _geometry(self) -> tuple[float, float, float, float]:
        assert self._shown is not None
        metrics = self.fontMetrics()
        rows, columns = self._shown.pixel.shape
        left = max((metrics.horizontalAdvance(name) for name in self._shown.names), default=0) + 6.0
        width = max((self.width() - left - 1 - self._gap(columns - 1)) / columns, 1.0)
        top = metrics.ascent() + 4.0 if width >= ROOM_FOR_GLYPH else 5.0
        return left, top, width, max((self.height() - top - 1) / max(rows, 1), 4.0)

    def event(self, event: QEvent) -> bool:
        """Say what is under the cursor."""
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent) and self._shown is not None:
            rows, columns = self._shown.pixel.shape
            for row, column in np.ndindex(rows, columns):
                if self.cell_rect(row, column).contains(QPointF(event.pos())):
                    show_tip(event.globalPos(), self._shown.describe(row, column), self)
                    return True
        return super().event(event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint rows of bars."""
        shown = self._shown
        if shown is None or not shown.pixel.size:
            return
        painter = QPainter(self)
        left, top, width, height = self._geometry()
        lefts = np.array([left + column * width + self._gap(column) for column in range(shown.pixel.shape[1])])
        self._paint_heads(painter, lefts, top, width)
        reach = np.sqrt(np.minimum(shown.thresholds, MOST_RANGE**2))
        largest = float(np.max([np.abs(shown.pixel), np.abs(shown.candidate)])) * 1.1
        limit = min(max(largest, LEAST_RANGE), MOST_RANGE)
        for row, name in enumerate(shown.names):
            area = QRectF(left, top + row * height, self.width() - left, height)
            painter.setPen(QColor(self._theme.muted))
            flags = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
            painter.drawText(QRectF(0, area.top(), left - 6, height), flags, name)
            self._paint_row(painter, row, lefts, area, width, limit, reach[row])
        painter.end()

    def _paint_heads(self, painter: QPainter, lefts: NDArray[np.float64], top: float, width: float) -> None:
        assert self._shown is not None
        for head, left in zip(self._shown.heads, lefts.tolist(), strict=True):
            colour = QColor(CHANNEL_COLOURS.get(head.group, self._theme.text))
            if width >= ROOM_FOR_GLYPH:
                draw_glyph(painter, head.first, QRectF(left + 1, 1, width - 2, top - 3), colour)
            else:
                painter.fillRect(QRectF(left, 0, width, 3), colour)

    def _paint_row(
        self,
        painter: QPainter,
        row: int,
        lefts: NDArray[np.float64],
        area: QRectF,
        width: float,
        limit: float,
        reach: NDArray[np.float32],
    ) -> None:
        shown = self._shown
        assert shown is not None
        half = area.height() / 2 - 2
        middle = area.center().y()

        def heights(values: NDArray[np.float32]) -> list[float]:
            # On a scale of roots the limits can be seen beside large values too.
            shares = np.sign(values) * np.sqrt(np.minimum(np.abs(values) / limit, 1))
            places: list[float] = (middle - shares * half).tolist()
            return places

        pixel, candidate = shown.pixel[row], shown.candidate[row]
        tops, bottoms = heights(pixel + reach), heights(pixel - reach)
        values, others = heights(pixel), heights(candidate)
        lows, highs = heights(shown.lowest[row]), heights(shown.highest[row])
        wash = QColor(self._theme.exemplar)
        wash.setAlpha(60)
        bar, line = QColor(self._theme.exemplar), QColor(self._theme.result)
        thin = QColor(self._theme.text)
        inner = max(width - 2, 1.0)
        for column, left in enumerate(lefts.tolist()):
            x = left + 1
            painter.fillRect(QRectF(x, tops[column], inner, bottoms[column] - tops[column]), wash)
            first, last = sorted((middle, values[column]))
            painter.fillRect(QRectF(x + inner * 0.25, first, inner * 0.5, max(last - first, 1.0)), bar)
            centre = x + inner / 2
            painter.fillRect(QRectF(centre - 0.5, highs[column], 1, max(lows[column] - highs[column], 1.0)), thin)
            painter.fillRect(QRectF(x, others[column] - 1.25, inner, 2.5), line)
        painter.setPen(QPen(QColor(self._theme.border), 1))
        painter.drawLine(QPointF(area.left(), middle), QPointF(area.right(), middle))
