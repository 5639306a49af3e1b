"""Themed plots and colour bars for docks: pyqtgraph ignores the palette, so every item takes its colours here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from PySide6.QtCore import QEvent, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QImage, QMouseEvent, QPainter
from PySide6.QtWidgets import QSizePolicy, QVBoxLayout, QWidget

from texlab.style.numbers import even_ticks, log_ticks
from texlab.style.text_size import line_scale, text_scale
from texlab.style.theme import configure_pyqtgraph
from texlab.widgets.label_places import Label, place_labels
from texlab.widgets.plain import escaped, set_tip

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray
    from PySide6.QtCore import QObject
    from PySide6.QtGui import QFontMetrics, QPaintEvent, QResizeEvent

    from texlab.style.theme import Theme

pg = configure_pyqtgraph()

Role = Literal["exemplar", "result", "third", "good", "warning", "error", "muted", "text", "accent"]
Line = Literal["solid", "dash", "dot"]
ROOM_FOR_LABELS = 170
BEHIND_WORDS = 200
LEAST = (60, 50)
LINES = {"solid": Qt.PenStyle.SolidLine, "dash": Qt.PenStyle.DashLine, "dot": Qt.PenStyle.DotLine}
# Colours and line styles for any number of series: no two of the first nine look alike without colour either.
SERIES: tuple[tuple[Role, Line], ...] = (
    ("exemplar", "solid"),
    ("result", "dash"),
    ("third", "dot"),
    ("warning", "solid"),
    ("muted", "dash"),
    ("error", "dot"),
    ("good", "dash"),
    ("accent", "dot"),
    ("text", "solid"),
)


@dataclass
class _Series:
    item: Any
    role: Role
    line: Line
    width: float
    filled: bool


class Plot(QWidget):
    """One pair of axes with curves that follow the theme.

    ``hovered(x, y)`` is in the coordinates of the axes.
    """

    hovered = Signal(float, float)
    left = Signal()
    clicked = Signal()

    def __init__(self, name: str, label: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(label)
        self._theme: Theme | None = None
        self._series: list[_Series] = []
        self._texts: list[tuple[Any, Role, tuple[float, float]]] = []
        self._labels = ("", "")
        self._log = False
        self.graph: Any = pg.GraphicsView(self, background=None)
        self.graph.setObjectName(f"{name}-graph")
        self.graph.setAccessibleName(label)
        self.graph.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.graph.setMinimumSize(*LEAST)
        # A view and two axes: pyqtgraph's PlotItem brings seven menus and a hidden form with it.
        grid = pg.GraphicsLayout()
        grid.setContentsMargins(0, 4, 6, 0)
        grid.setSpacing(0)
        self.graph.setCentralItem(grid)
        self.view: Any = pg.ViewBox(enableMenu=False)
        grid.addItem(self.view, 0, 1)
        self.axes: dict[str, Any] = {}
        for side, row, column in (("left", 0, 0), ("bottom", 1, 1)):
            axis = self.axes[side] = pg.AxisItem(side)
            axis.enableAutoSIPrefix(False)
            axis.linkToView(self.view)
            grid.addItem(axis, row, column)
        self._grid = grid
        for moved in (self.view.sigRangeChanged, self.view.sigResized):
            moved.connect(self._place_ticks)
            moved.connect(self._keep_texts_inside)
        self.graph.setMouseTracking(True)
        # The scene drops moves that follow each other quickly, even the last one; the viewport drops none.
        self.graph.viewport().installEventFilter(self)
        self.graph.scene().sigMouseClicked.connect(self._clicked)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.graph)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)

    def sizeHint(self) -> QSize:
        """Ask for little: docks are low."""
        return QSize(200, 120)

    def minimumSizeHint(self) -> QSize:
        """Return room for an axis with a few numbers."""
        scale = text_scale(self)
        return QSize(int(LEAST[0] * scale), int(LEAST[1] * scale))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Leave the names of the axes out where there is no room for them."""
        super().resizeEvent(event)
        self._show_labels()

    def _show_labels(self) -> None:
        metrics = self.fontMetrics()
        is_low = self.height() < ROOM_FOR_LABELS * text_scale(self)
        # An axis is as long as the plot without the numbers of the other one.
        rooms = self.width() - 7 * metrics.averageCharWidth(), self.height() - 2 * metrics.height()
        for side, words, room in zip(("bottom", "left"), self._labels, rooms, strict=True):
            self.axes[side].showLabel(bool(words) and not is_low and metrics.horizontalAdvance(words) <= room)

    def clear(self) -> None:
        """Take all curves and texts away."""
        for series in self._series:
            self.view.removeItem(series.item)
        for item, *_ in self._texts:
            self.view.removeItem(item)
        self._series.clear()
        self._texts.clear()

    def curve(
        self,
        x: ArrayLike,
        y: ArrayLike,
        role: Role,
        *,
        line: Line = "solid",
        width: float = 2,
        steps: bool = False,
        filled: bool = False,
        floor: float = 0.0,
    ) -> Any:
        """Add a curve.

        Parameters
        ----------
        x
            Places; with ``steps`` the edges, one more than ``y``.
        y
            Values.
        role, line, width
            Colour by role, style and width in pixels.
        steps
            Draw a histogram's steps.
        filled
            Fill the area down to ``floor``.
        """
        item = pg.PlotCurveItem(
            x=np.asarray(x, np.float64),
            y=np.asarray(y, np.float64),
            stepMode="center" if steps else None,
            fillLevel=floor if filled else None,
        )
        self._series.append(_Series(item, role, line, width, filled))
        self.view.addItem(item)
        if self._theme is not None:
            self._paint(self._series[-1], self._theme)
        return item

    def points(self, x: ArrayLike, y: ArrayLike, role: Role, size: float = 8, *, faint: bool = False) -> Any:
        """Add points of ``size`` pixels; faint ones are a cloud behind others, without outlines."""
        item = pg.ScatterPlotItem(x=np.asarray(x, np.float64), y=np.asarray(y, np.float64), size=size)
        # Words lie over a cloud, and beside other points: what is behind words hides none of these.
        item.setZValue(-1 if faint else 1)
        self._series.append(_Series(item, role, "solid", 0 if faint else 1, filled=True))
        self.view.addItem(item)
        if self._theme is not None:
            self._paint(self._series[-1], self._theme)
        return item

    def text(self, x: float, y: float, words: str, role: Role, anchor: tuple[float, float] = (0, 1)) -> Any:
        """Write words at a place of the axes; they do not change the range."""
        item = pg.TextItem(words, anchor=anchor)
        item.setPos(x, y)
        self._texts.append((item, role, anchor))
        self.view.addItem(item, ignoreBounds=True)
        if self._theme is not None:
            self._paint_text(item, role, self._theme)
        self._keep_texts_inside()
        return item

    def set_labels(self, x: str, y: str) -> None:
        """Name the axes."""
        self._labels = (x, y)
        if self._theme is not None:
            self._paint_axes(self._theme)

    def set_log(self, on: bool) -> None:
        """Write the ticks of the left axis for values that are given as log10 already."""
        self._log = on
        self._place_ticks()

    def _place_ticks(self, *_: object) -> None:
        """Choose the numbers at the axes for the room that there is."""
        metrics = self.fontMetrics()
        across, up = self.view.viewRange()
        self.axes["bottom"].setTicks([_ticks_apart(across, self.view.width(), metrics)])
        low, high = up
        height = max(self.view.height(), 1.0)
        room = 1.25 * metrics.height()
        if self._log:
            ticks = log_ticks(low, high, room * (high - low) / height)
        else:
            ticks = even_ticks(low, high, max(1, int(height / (1.6 * room))))
        self.axes["left"].setTicks([ticks])

    def _keep_texts_inside(self, *_: object) -> None:
        """Write words beside their places: inside of the axes, and not over other words."""
        (left, right), (low, high) = self.view.viewRange()
        room = max(self.view.width(), 1.0), max(self.view.height(), 1.0)
        labels = []
        for item, _role, wanted in self._texts:
            size = item.textItem.boundingRect().size()
            x = (item.pos().x() - left) / max(right - left, 1e-300) * room[0]
            y = (high - item.pos().y()) / max(high - low, 1e-300) * room[1]
            labels.append(Label(x, y, size.width(), size.height(), wanted))
        places = place_labels(labels, room)
        for (item, _role, _wanted), label, place in zip(self._texts, labels, places, strict=True):
            # What would lie over other words is left out until there is room.
            item.setVisible(place is not None)
            if place is not None:
                inside = label.x - place[0], label.y - place[1]
                item.setAnchor((inside[0] / max(label.width, 1.0), inside[1] / max(label.height, 1.0)))

    def fit(self, x: tuple[float, float] | None = None, y: tuple[float, float] | None = None) -> None:
        """Show a range, or everything where it is left out."""
        self.view.disableAutoRange()
        bounds = self.view.childrenBounds(items=[series.item for series in self._series])
        if x is not None or bounds[0] is not None:
            self.view.setXRange(*(x or bounds[0]), padding=0 if x else 0.02)
        if y is not None or bounds[1] is not None:
            self.view.setYRange(*(y or bounds[1]), padding=0 if y else 0.06)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.graph.setBackground(QColor(theme.base))
        self._paint_axes(theme)
        for series in self._series:
            self._paint(series, theme)
        for item, role, _ in self._texts:
            self._paint_text(item, role, theme)
        self._keep_texts_inside()

    def changeEvent(self, event: QEvent) -> None:
        """Let axes and texts follow the size of the program's text."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange and self._theme is not None:
            self.set_theme(self._theme)
            self._place_ticks()

    def _paint_axes(self, theme: Theme) -> None:
        size = f"{self.font().pointSizeF():.1f}pt"
        for side, words in zip(("bottom", "left"), self._labels, strict=True):
            axis = self.axes[side]
            axis.setPen(pg.mkPen(theme.border))
            axis.setTextPen(pg.mkPen(theme.muted))
            axis.setStyle(tickLength=-4, maxTickLevel=0)
            axis.setTickFont(self.font())
            # pyqtgraph writes labels as markup.
            axis.setLabel(escaped(words) or None, **{"color": theme.muted, "font-size": size})
        self._show_labels()
        # The first and the last number stand half beyond their axis.
        metrics = self.fontMetrics()
        self._grid.setContentsMargins(0, metrics.height() // 2 + 1, metrics.horizontalAdvance("0.0"), 0)

    def _paint(self, series: _Series, theme: Theme) -> None:
        colour = QColor(getattr(theme, series.role))
        pen = pg.mkPen(colour, width=series.width * line_scale(self), style=LINES[series.line])
        series.item.setPen(pen if series.width else None)
        if series.filled:
            wash = QColor(colour)
            wash.setAlpha(60 if series.width else 110)
            series.item.setBrush(pg.mkBrush(wash))

    def _paint_text(self, item: Any, role: Role, theme: Theme) -> None:
        item.setColor(QColor(getattr(theme, role)))
        item.setFont(self.font())
        # Curves and points behind words are seen, and the words are read.
        behind = QColor(theme.base)
        behind.setAlpha(BEHIND_WORDS)
        item.fill = pg.mkBrush(behind)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Tell where the cursor is."""
        if event.type() == QEvent.Type.Leave:
            self.left.emit()
        elif isinstance(event, QMouseEvent) and event.type() == QEvent.Type.MouseMove:
            where = self.graph.mapToScene(event.position().toPoint())
            if self.view.sceneBoundingRect().contains(where):
                point = self.view.mapSceneToView(where)
                self.hovered.emit(float(point.x()), float(point.y()))
            else:
                self.left.emit()
        return super().eventFilter(watched, event)

    def _clicked(self, event: Any) -> None:
        if event.double():
            self.fit()
        else:
            self.clicked.emit()


def _ticks_apart(limits: list[float], room: float, metrics: QFontMetrics) -> list[tuple[float, str]]:
    """Return as many ticks of an axis across as can stand side by side."""
    for count in range(8, 1, -1):
        ticks = even_ticks(limits[0], limits[1], count)
        widest = max((metrics.horizontalAdvance(words) for _, words in ticks), default=0)
        if len(ticks) < 2 or (widest + metrics.averageCharWidth()) * len(ticks) <= room:
            return ticks
    return even_ticks(limits[0], limits[1], 1)


class ColourBar(QWidget):
    """A vertical bar of colours with numbers beside it and a mark at the value under the cursor."""

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName("Colour scale")
        set_tip(self, "Which colour stands for which value")
        self._theme: Theme | None = None
        self._table: NDArray[np.uint8] = np.zeros((2, 3), np.uint8)
        self._ticks: list[tuple[float, str]] = []
        self._mark: float | None = None
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Expanding)

    @property
    def ticks(self) -> list[tuple[float, str]]:
        """Places (0 at the bottom, 1 at the top) and words of the numbers."""
        return self._ticks

    @property
    def mark(self) -> float | None:
        """Place of the mark."""
        return self._mark

    def show_scale(self, table: NDArray[np.uint8], ticks: Sequence[tuple[float, str]]) -> None:
        """Show colours, (size, 3) uint8 from bottom to top, and numbers at places 0 .. 1."""
        self._table = np.ascontiguousarray(table[::-1])
        self._ticks = list(ticks)
        self._mark = None
        self.updateGeometry()
        self.update()

    def set_mark(self, place: float | None) -> None:
        """Mark a place of the bar."""
        self._mark = None if place is None or not np.isfinite(place) else float(np.clip(place, 0, 1))
        self.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.update()

    def sizeHint(self) -> QSize:
        """Return room for the bar and its widest number."""
        metrics = self.fontMetrics()
        widest = max((metrics.horizontalAdvance(words) for _, words in self._ticks), default=0)
        return QSize(34 + widest, 80)

    def minimumSizeHint(self) -> QSize:
        """Return the width of the hint."""
        return QSize(self.sizeHint().width(), max(40, 2 * self.fontMetrics().height() + 4))

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the bar."""
        if self._theme is None:
            return
        painter = QPainter(self)
        metrics = self.fontMetrics()
        half = metrics.height() / 2
        bar = QRectF(6, half + 2, 14, max(self.height() - 2 * half - 4, 1))
        size = len(self._table)
        painter.drawImage(bar, QImage(self._table.data, 1, size, 3, QImage.Format.Format_RGB888))
        painter.setPen(QColor(self._theme.border))
        painter.drawRect(bar)
        painter.setPen(QColor(self._theme.text))
        lowest = self.height() + half
        for place, words in sorted(self._ticks):
            y = bar.bottom() - place * bar.height()
            if y + half <= lowest:
                painter.drawText(round(bar.right()) + 6, round(y + half - metrics.descent()), words)
                lowest = y - half
        if self._mark is not None:
            y = bar.bottom() - self._mark * bar.height()
            painter.fillRect(QRectF(bar.left() - 5, y - 1.5, bar.width() + 10, 3), QColor(self._theme.text))
        painter.end()
