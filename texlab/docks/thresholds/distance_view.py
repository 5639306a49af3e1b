"""The histogram of a feature's distances with the threshold as a line that can be dragged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from texlab.docks.thresholds.table import SoftLog, cell_text, rounded
from texlab.form.knobs import SETTLE_MS
from texlab.style.theme import DARK, LIGHT
from texlab.widgets.own_keys import OwnKeys, is_plain
from texlab.widgets.plain import set_tip
from texlab.widgets.settling import Settling
from texlab_core.methods.de_bonet.distances import feature_distances, passing_share

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtGui import QPaintEvent

    from texlab.style.theme import Theme
    from texlab_core.methods.de_bonet.analysis import Analysis

SCALE = SoftLog(0.005, 16.0)
BINS = 96
TICKS = (0.0, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0)
STEPS = {
    Qt.Key.Key_Left: -0.01,
    Qt.Key.Key_Down: -0.01,
    Qt.Key.Key_Right: 0.01,
    Qt.Key.Key_Up: 0.01,
    Qt.Key.Key_PageDown: -0.1,
    Qt.Key.Key_PageUp: 0.1,
}


@dataclass(frozen=True, eq=False)
class Distances:
    """Distances of one cell of the table.

    Parameters
    ----------
    values
        (n,) float32, sorted.
    shares
        (BINS,) float64: share of the distances in every bin of ``SCALE``; the last one holds what lies beyond.
    """

    values: NDArray[np.float32]
    shares: NDArray[np.float64]

    @classmethod
    def of(cls, model: Analysis, k: int, feature: int) -> Distances:
        """Measure a cell of the table (in a background thread: it sorts)."""
        values = feature_distances(model, k, feature)
        edges = np.array([SCALE.value(place) for place in np.linspace(0, 1, BINS + 1)[1:-1]], np.float32)
        counts = np.diff(np.r_[0, np.searchsorted(values, edges, side="right"), values.size])
        return cls(values, counts / max(values.size, 1))

    def passing(self, threshold: float) -> float:
        """Return the share that a threshold lets through."""
        return passing_share(self.values, threshold)


class DistanceView(OwnKeys, QWidget):
    """Shows the distances of one cell; ``edited(threshold, final)`` while the line is dragged or moved by keys."""

    edited = Signal(float, bool)

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName("Distances of the chosen feature, with its threshold")
        set_tip(
            self,
            "How different this feature is between places of the exemplar: the filled part is what the threshold "
            "lets through. Drag the line, or use the arrow keys, to change the threshold of the chosen cell.",
        )
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self._theme: Theme = DARK if self.palette().window().color().lightness() < 128 else LIGHT
        self._distances: Distances | None = None
        self._threshold = 0.0
        self._dragging = False
        self._settle = Settling(self, SETTLE_MS, self.settle)

    @property
    def threshold(self) -> float:
        """Where the line stands."""
        return self._threshold

    @property
    def share(self) -> float | None:
        """The share that the threshold lets through, None while the distances are unknown."""
        return None if self._distances is None else self._distances.passing(self._threshold)

    def show_distances(self, distances: Distances | None) -> None:
        """Show the distances of a cell."""
        self._distances = distances
        self.update()

    def show_threshold(self, threshold: float) -> None:
        """Put the line at a threshold, unless it is being dragged."""
        if not self._dragging and threshold != self._threshold:
            self._threshold = threshold
            self.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.update()

    def sizeHint(self) -> QSize:
        """Ask for little: docks are low."""
        return QSize(230, 90)

    def minimumSizeHint(self) -> QSize:
        """Return what a histogram needs."""
        return QSize(120, 48)

    def line_x(self) -> float:
        """Return where the line stands, in pixels."""
        area = self._area()
        return area.left() + float(SCALE.place(self._threshold)) * area.width()

    def _area(self) -> QRectF:
        return QRectF(8, 4, max(self.width() - 16, 1), max(self.height() - self.fontMetrics().height() - 6, 1))

    # Editing.

    def settle(self) -> None:
        """End what goes on, a drag or keys: it is told as final."""
        self._dragging = False
        self._settle.stop()
        self.edited.emit(self._threshold, True)

    @property
    def busy(self) -> bool:
        """Whether an edit is under way."""
        return self._dragging or self._settle.isActive()

    def _drag_to(self, x: float) -> None:
        area = self._area()
        value = rounded(SCALE.value((x - area.left()) / area.width()))
        if value != self._threshold:
            self._threshold = value
            self.update()
            self.edited.emit(value, False)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take the line."""
        if event.button() == Qt.MouseButton.LeftButton:
            self._dragging = True
            self._drag_to(event.position().x())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Drag the line."""
        if self._dragging:
            self._drag_to(event.position().x())
        else:
            near = abs(event.position().x() - self.line_x()) < 6
            self.setCursor(Qt.CursorShape.SizeHorCursor if near else Qt.CursorShape.ArrowCursor)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let the line go: the drag is one step."""
        if self._dragging:
            self.settle()

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it moves the line."""
        return is_plain(event) and event.key() in STEPS

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move the line."""
        step = STEPS.get(Qt.Key(event.key()))
        if step is None or not self.wants_key(event):
            super().keyPressEvent(event)
            return
        place = float(SCALE.place(self._threshold)) + step
        value = rounded(SCALE.value(place))
        if value != self._threshold:
            self._threshold = value
            self.update()
            self.edited.emit(value, False)
        self._settle.start()

    # Painting.

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint axis, histogram and line."""
        painter = QPainter(self)
        area = self._area()
        painter.fillRect(area, QColor(self._theme.base))
        self._paint_axis(painter, area)
        if self._distances is not None:
            self._paint_shares(painter, area, self._distances)
        x = self.line_x()
        colour = QColor(self._theme.error)
        painter.setPen(QPen(colour, 4 if self.hasFocus() else 2))
        painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()))
        painter.setBrush(colour)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.drawEllipse(QPointF(x, area.top() + 5), 5, 5)
        painter.end()

    def _paint_axis(self, painter: QPainter, area: QRectF) -> None:
        metrics = self.fontMetrics()
        free = -1e9
        for tick in TICKS:
            x = area.left() + float(SCALE.place(tick)) * area.width()
            painter.setPen(QColor(self._theme.border))
            painter.drawLine(QPointF(x, area.bottom()), QPointF(x, area.bottom() + 3))
            words = cell_text(tick)
            half = metrics.horizontalAdvance(words) / 2
            x = min(max(x, half), self.width() - half)
            if x - half > free:
                painter.setPen(QColor(self._theme.muted))
                painter.drawText(QPointF(x - half, self.height() - metrics.descent() - 1), words)
                free = x + half + 6

    def _paint_shares(self, painter: QPainter, area: QRectF, distances: Distances) -> None:
        # Roots of the shares: the long tail stays visible beside the peak at zero.
        heights = np.sqrt(distances.shares / max(float(distances.shares.max()), 1e-12)) * (area.height() - 2)
        width = area.width() / BINS
        x = self.line_x()
        points = [QPointF(area.left(), area.bottom())]
        for place, height in enumerate(heights.tolist()):
            left, top = area.left() + place * width, area.bottom() - height
            points += [QPointF(left, top), QPointF(left + width, top)]
        points.append(QPointF(area.right(), area.bottom()))
        shape = QPolygonF(points)
        colour = QColor(self._theme.exemplar)
        wash = QColor(colour)
        wash.setAlpha(50)
        painter.setPen(QPen(colour, 1))
        painter.setBrush(wash)
        painter.drawPolygon(shape)
        painter.save()
        painter.setClipRect(QRectF(area.left(), area.top(), x - area.left(), area.height() + 1))
        wash.setAlpha(170)
        painter.setBrush(wash)
        painter.drawPolygon(shape)
        painter.restore()
