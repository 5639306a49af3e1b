"""Reads what a window paints: every piece of text with its place and the height of its capitals."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QFontMetricsF, QPaintDevice, QPaintEngine, QPainter
from PySide6.QtWidgets import (
    QAbstractItemView,
    QAbstractScrollArea,
    QApplication,
    QGraphicsView,
    QHeaderView,
    QLabel,
    QTabBar,
    QToolButton,
    QWidget,
)

from texlab.widgets.plain import FittedLabel

if TYPE_CHECKING:
    from PySide6.QtGui import QPaintEngineState, QTextItem

FAR = 1e6
FAR_DOWN = 100_000


@dataclass(frozen=True)
class Painted:
    """A piece of text on one line: where it is in the window, and how high its capitals are, in pixels."""

    words: str
    capitals: float
    place: QRectF
    widget: QWidget

    @property
    def name(self) -> str:
        """Who painted it, and what."""
        widget = self.widget if self.widget.objectName() else self.widget.parentWidget() or self.widget
        return f"{type(widget).__name__} {widget.objectName()!r}: {self.words!r}"


class _Engine(QPaintEngine):
    def __init__(self, found: list[Painted], painting: list[QWidget]) -> None:
        super().__init__(QPaintEngine.PaintEngineFeature.AllFeatures)
        self._found = found
        self._painting = painting

    def begin(self, device: QPaintDevice) -> bool:
        self.setActive(True)
        return True

    def end(self) -> bool:
        self.setActive(False)
        return True

    def type(self) -> QPaintEngine.Type:
        return QPaintEngine.Type.User

    def updateState(self, state: QPaintEngineState) -> None:
        """What is painted is of no interest but for its text."""

    def drawPixmap(self, *_: Any) -> None: ...
    def drawImage(self, *_: Any) -> None: ...
    def drawPolygon(self, *_: Any) -> None: ...
    def drawPath(self, *_: Any) -> None: ...
    def drawRects(self, *_: Any) -> None: ...
    def drawLines(self, *_: Any) -> None: ...
    def drawPoints(self, *_: Any) -> None: ...

    def drawTextItem(self, at: QPointF, item: QTextItem) -> None:
        if not item.text().strip():
            return
        capitals = QFontMetricsF(item.font()).capHeight()
        moved = self.painter().deviceTransform()
        text = item.text()
        # A space at the end of a line is not seen.
        blank = len(text) - len(text.rstrip())
        width = item.width() - blank * QFontMetricsF(item.font()).horizontalAdvance(" ")
        place = moved.mapRect(QRectF(at.x(), at.y() - capitals, width, capitals))
        # Turned text is as high as it is wide on the screen.
        scale = (moved.m11() ** 2 + moved.m12() ** 2) ** 0.5
        self._found.append(Painted(item.text(), capitals * scale, place, self._painting[-1]))


class _Paper(QPaintDevice):
    def __init__(self, size: QSize, engine: _Engine) -> None:
        super().__init__()
        self._size = size
        self._engine = engine

    def paintEngine(self) -> QPaintEngine:
        return self._engine

    def metric(self, what: QPaintDevice.PaintDeviceMetric) -> int:
        metrics = QPaintDevice.PaintDeviceMetric
        known = {
            metrics.PdmWidth: self._size.width(),
            metrics.PdmHeight: self._size.height(),
            metrics.PdmNumColors: 1 << 24,
            metrics.PdmDepth: 32,
            metrics.PdmDevicePixelRatio: 1,
            metrics.PdmDevicePixelRatioScaled: 65536,
        }
        return known.get(what, 96)


class _Watch(QObject):
    def __init__(self, painting: list[QWidget]) -> None:
        super().__init__()
        self._painting = painting

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Paint and isinstance(watched, QWidget):
            self._painting.append(watched)
        return False


def painted(window: QWidget) -> list[Painted]:
    """Return every piece of text that a window paints."""
    found: list[Painted] = []
    painting: list[QWidget] = [window]
    engine = _Engine(found, painting)
    paper, watch = _Paper(window.size(), engine), _Watch(painting)
    application = QApplication.instance()
    assert application is not None
    application.installEventFilter(watch)
    painter = QPainter(paper)
    window.render(painter, QPoint(0, 0))
    painter.end()
    application.removeEventFilter(watch)
    return found


def room_of(widget: QWidget, window: QWidget) -> QRectF:
    """Return where in the window a widget can be seen; what can be scrolled to counts as seen."""
    sides = [-FAR, -FAR, FAR, FAR]
    scrolls = [False, False]
    at: QWidget | None = widget
    while at is not None:
        area = at.parentWidget()
        if isinstance(area, QAbstractScrollArea) and not isinstance(area, QGraphicsView) and area.viewport() is at:
            # The heads of a table go with the table.
            table = area.parentWidget()
            bars = table if isinstance(area, QHeaderView) and isinstance(table, QAbstractItemView) else area
            for way, bar in enumerate((bars.horizontalScrollBar(), bars.verticalScrollBar())):
                scrolls[way] = scrolls[way] or bar.maximum() > 0
        if isinstance(at, QTabBar) and any(each.isVisible() for each in at.findChildren(QToolButton)):
            # Its arrows go to the tabs that have no room.
            scrolls[0] = True
        corner = at.mapTo(window, QPoint(0, 0))
        own = corner.x(), corner.y(), corner.x() + at.width(), corner.y() + at.height()
        for side, value in enumerate(own):
            if not scrolls[side % 2]:
                sides[side] = max(sides[side], value) if side < 2 else min(sides[side], value)
        if at is window:
            break
        at = area
    return QRectF(QPointF(*sides[:2]), QPointF(*sides[2:]))


def too_small(window: QWidget, texts: list[Painted]) -> list[str]:
    """Return every text whose capitals are lower than a fortieth of the window's height."""
    least = window.height() / 40
    return [f"{each.capitals:.1f} < {least:.1f} {each.name}" for each in texts if each.capitals < least]


def cut(window: QWidget, texts: list[Painted]) -> list[str]:
    """Return every text of which a part is left out or lies outside of what can be seen."""
    found = []
    for each in texts:
        room = room_of(each.widget, window)
        inside = room.adjusted(-1, -1, 1, 1).contains(each.place)
        if "…" in each.words and not told(each):
            found.append(f"left out: {each.name}")
        elif not inside and room.intersects(each.place):
            found.append(f"outside: {each.name}, {each.place} of {room}")
    for label in window.findChildren(QLabel):
        seen = label.isVisible() and not label.visibleRegion().isEmpty() and not isinstance(label, FittedLabel)
        if seen and label.wordWrap() and lines_of(label) > label.height() + 1:
            found.append(f"lines left out: {label.objectName()} {label.text()!r}")
    return found


def told(each: Painted) -> bool:
    """Return whether whole words stand before the sign, or a part of a single one, and all of them in the tip."""
    shown, tip = each.words.removesuffix("…"), " ".join(each.widget.toolTip().split())
    whole = shown.endswith(" ") or (shown and " " not in shown)
    return bool(whole) and "…" not in shown and shown.split(" · ")[0].strip() in tip


def lines_of(label: QLabel) -> int:
    """Return the height that the words of a label need when they are wrapped."""
    if label.textFormat() == Qt.TextFormat.RichText:
        return label.heightForWidth(label.width())
    room = QRect(0, 0, label.contentsRect().width() - 2 * label.margin(), FAR_DOWN)
    flags = int(Qt.TextFlag.TextWordWrap.value)
    return label.fontMetrics().boundingRect(room, flags, label.text()).height()


def overlapping(texts: list[Painted]) -> list[str]:
    """Return every pair of texts of one widget that lie over each other."""
    found = []
    for place, one in enumerate(texts):
        for other in texts[place + 1 :]:
            shared = one.place.adjusted(1, 1, -1, -1) & other.place
            if other.widget is one.widget and not shared.isEmpty():
                found.append(f"{one.name} over {other.words!r}")
    return found
