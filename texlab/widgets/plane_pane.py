"""Panes for pictures with coordinates of their own: frequencies, or shifts of the autocorrelation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QPainter, QPen, QPolygonF

from texlab.style.text_size import line_scale
from texlab.widgets.pane import Link, Pane

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PySide6.QtWidgets import QWidget

    from texlab.style.pictures import Picture

Tint = Literal["exemplar", "result", "centre", "chosen"]
Shape = Literal["circle", "square", "cross", "dot"]
# Bright enough for any picture, over a dark edge; the shapes tell them apart without colour.
TINTS: dict[Tint, str] = {"exemplar": "#6fc8ff", "result": "#ffb347", "centre": "#8ce99a", "chosen": "#ff5fb0"}
MARK_PX = 5


@dataclass(frozen=True)
class Ring:
    """A circle in the coordinates of the plane."""

    x: float
    y: float
    radius: float
    tint: Tint = "centre"
    dashed: bool = False


@dataclass(frozen=True)
class Spot:
    """A mark of a few pixels."""

    x: float
    y: float
    tint: Tint
    shape: Shape = "circle"


@dataclass(frozen=True)
class Arrow:
    """A line from one place to another with a head at its end."""

    x: float
    y: float
    to_x: float
    to_y: float
    tint: Tint
    dashed: bool = False


@dataclass(frozen=True)
class Path:
    """A line through several places."""

    places: tuple[tuple[float, float], ...]
    tint: Tint
    dashed: bool = False


Drawn = Ring | Spot | Arrow | Path


class PlaneLink(Link["PlanePane"]):
    """One rectangle of coordinates that all panes of a link show."""

    def __init__(self) -> None:
        super().__init__()
        self._fitted = True

    def moved(self, source: PlanePane) -> None:
        """Show in all panes what the user made one show."""
        self._fitted = False
        rectangle = source.view_rect()
        for pane in self._panes:
            if pane is not source:
                pane.show_rect(rectangle)

    def resized(self, only: PlanePane | None = None) -> None:
        """Fit again unless the user has zoomed: one pane, or all."""
        if self._fitted:
            self._fit(only)

    def fit(self) -> None:
        """Show everything."""
        self._fitted = True
        self._fit()

    def _fit(self, only: PlanePane | None = None) -> None:
        whole = QRectF()
        for pane in self._panes:
            whole = whole.united(pane.area)
        if not whole.isEmpty():
            for pane in self._those(only):
                pane.show_rect(whole)


class PlanePane(Pane):
    """Shows an (h, w, 3) uint8 picture of a plane with marks over it.

    ``hovered(x, y)``, ``clicked(x, y)`` and ``left()`` are in the coordinates of the plane; y points down.
    """

    hovered = Signal(float, float)
    clicked = Signal(float, float)
    left = Signal()
    area = QRectF()

    def __init__(self, name: str, label: str, link: PlaneLink | None = None) -> None:
        super().__init__(link or PlaneLink())
        self.setObjectName(name)
        self.setAccessibleName(label)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.picture: Picture | None = None
        self.marks = MarksOverPlane()
        self.view.addItem(self.marks, ignoreBounds=True)

    def show_picture(self, picture: Picture | None, area: QRectF) -> None:
        """Show a picture over a rectangle of coordinates, or nothing."""
        self.picture = picture
        if picture is None:
            self.item.clear()
            area = QRectF()
        else:
            self.item.setImage(picture, autoLevels=False, levels=None)
            self.item.setRect(area)
        if area != self.area:
            self.area = area
            if self._link is not None:
                self._link.resized()

    def show_nothing(self) -> None:
        """Let go of the picture and of the marks."""
        self.show_picture(None, QRectF())
        self.show_marks(())

    def show_marks(self, marks: Sequence[Drawn]) -> None:
        """Draw these marks over the picture."""
        self.marks.show_marks(marks)

    def to_widget(self, x: float, y: float) -> QPointF:
        """Return where a place is painted, in the viewport."""
        return self.widget_place(x, y)

    def point_at(self, place: QPointF) -> None:
        """Tell where the pointer is, or that it is beside the picture."""
        if self.area.contains(place):
            self.hovered.emit(place.x(), place.y())
        else:
            self.left.emit()

    def point_nowhere(self) -> None:
        """Tell that the pointer has left."""
        self.left.emit()

    def click_at(self, place: QPointF) -> None:
        """Tell where a click was."""
        self.clicked.emit(place.x(), place.y())


class MarksOverPlane(pg.GraphicsObject):  # type: ignore[misc]  # pyqtgraph has no types
    """Circles, marks and arrows, painted with lines of the same width at any zoom."""

    def __init__(self) -> None:
        super().__init__()
        self.shown: tuple[Drawn, ...] = ()
        self._bounds = QRectF()
        self.setZValue(20)

    def show_marks(self, marks: Sequence[Drawn]) -> None:
        """Draw these."""
        self.prepareGeometryChange()
        self.shown = tuple(marks)
        self._bounds = QRectF()
        for mark in self.shown:
            if isinstance(mark, Path):
                self._bounds = self._bounds.united(
                    QPolygonF([QPointF(*each) for each in mark.places]).boundingRect()
                )
                continue
            reach = mark.radius if isinstance(mark, Ring) else 1e-6
            self._bounds = self._bounds.united(QRectF(mark.x - reach, mark.y - reach, 2 * reach, 2 * reach))
            if isinstance(mark, Arrow):
                self._bounds = self._bounds.united(QRectF(mark.to_x - reach, mark.to_y - reach, 2e-6, 2e-6))
        self.update()

    def boundingRect(self) -> QRectF:
        """Return what the marks cover, with room for those of a fixed size."""
        more = 0.1 * max(self._bounds.width(), self._bounds.height()) + 1e-3
        return self._bounds.adjusted(-more, -more, more, more)

    def paint(self, painter: QPainter, _: object, view: QWidget | None = None) -> None:
        """Paint a dark line under a bright one: seen on any picture."""
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        thickness = 1.0 if view is None else line_scale(view)
        scale = abs(painter.worldTransform().m11()) or 1.0
        # Hundreds of marks share a few pens.
        pens: dict[tuple[str, float, bool], QPen] = {}
        for mark in self.shown:
            thin = isinstance(mark, Ring) and mark.tint == "centre"
            for colour, width in (("#000000", 2.2 if thin else 3.5), (TINTS[mark.tint], 1.0 if thin else 1.6)):
                dashed = not isinstance(mark, Spot) and mark.dashed
                pen = pens.get((colour, width, dashed))
                if pen is None:
                    pen = pens[colour, width, dashed] = pg.mkPen(colour, width=width * thickness)
                    pen.setCosmetic(True)
                    if dashed:
                        # Dashes are counted in widths of the line.
                        pen.setDashPattern([4 / width, 3 / width])
                painter.setPen(pen)
                painter.setBrush(Qt.BrushStyle.NoBrush)
                _draw(painter, mark, thickness / scale)


def _draw(painter: QPainter, mark: Drawn, pixel: float) -> None:
    if isinstance(mark, Path):
        painter.drawPolyline([QPointF(*each) for each in mark.places])
        return
    here = QPointF(mark.x, mark.y)
    if isinstance(mark, Ring):
        painter.drawEllipse(here, mark.radius, mark.radius)
    elif isinstance(mark, Arrow):
        _draw_arrow(painter, here, QPointF(mark.to_x, mark.to_y), pixel)
    else:
        reach = MARK_PX * pixel
        if mark.shape == "circle":
            painter.drawEllipse(here, reach, reach)
        elif mark.shape == "dot":
            painter.drawEllipse(here, reach / 4, reach / 4)
        elif mark.shape == "square":
            painter.drawRect(QRectF(mark.x - reach, mark.y - reach, 2 * reach, 2 * reach))
        else:
            for sign in (1, -1):
                step = QPointF(reach, sign * reach)
                painter.drawLine(here - step, here + step)


def _draw_arrow(painter: QPainter, here: QPointF, there: QPointF, pixel: float) -> None:
    way = there - here
    length = (way.x() ** 2 + way.y() ** 2) ** 0.5
    # Shorter than its head there is nothing to point at.
    if length < 3 * pixel:
        return
    painter.drawLine(here, there)
    along = way / length
    across = QPointF(-along.y(), along.x())
    back = there - along * (6 * pixel)
    for side in (1, -1):
        painter.drawLine(there, back + across * (side * 4 * pixel))
