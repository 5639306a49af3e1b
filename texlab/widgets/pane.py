"""What all panes share: a picture that is panned and zoomed, clicks, and the link that they follow."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, TypeVar

import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor

from texlab.style.theme import configure_pyqtgraph
from texlab.widgets.picture_item import PictureItem

if TYPE_CHECKING:
    from PySide6.QtCore import QEvent, QPoint
    from PySide6.QtGui import QContextMenuEvent, QResizeEvent
    from PySide6.QtWidgets import QWidget

    from texlab.style.theme import Theme

configure_pyqtgraph()

# A press and a release that are closer, in pixels, are a click.
CLICK_PX = 3
# Pixels a side.
LEAST = 68

PaneT = TypeVar("PaneT")


class Link(Generic[PaneT]):
    """What several panes show together."""

    def __init__(self) -> None:
        self._panes: list[PaneT] = []

    def join(self, pane: PaneT) -> None:
        """Make a pane follow the others."""
        self._panes.append(pane)

    def leave(self, pane: PaneT) -> None:
        """Let a pane go."""
        if pane in self._panes:
            self._panes.remove(pane)

    def _those(self, only: PaneT | None) -> list[PaneT]:
        """Return the panes that are meant: one, unless it has not joined yet, or all."""
        return [each for each in self._panes if only is None or each is only]

    def moved(self, source: PaneT) -> None:
        """Show in all panes what the user made one show."""
        raise NotImplementedError

    def resized(self, only: PaneT | None = None) -> None:
        """Show the same again after a pane came or changed: in one, where no other depends on it, or in all."""
        raise NotImplementedError

    def fit(self) -> None:
        """Show everything."""
        raise NotImplementedError


class Pane(pg.GraphicsView):  # type: ignore[misc]  # pyqtgraph has no types
    """A picture in coordinates of its own, y pointing down, panned and zoomed with those of its link.

    Subclasses are told in ``point_at`` where the pointer is, in ``point_nowhere`` that it has left, and in
    ``click_at`` of a click.
    """

    # The base class resizes itself while it is made.
    _link: Link[Any] | None = None

    def __init__(self, link: Link[Any], parent: QWidget | None = None) -> None:
        super().__init__(parent, background=None)
        self._link = link
        self._press: QPoint | None = None
        self.view = pg.ViewBox(lockAspect=True, invertY=True, enableMenu=False, defaultPadding=0)
        self.view.setMouseMode(pg.ViewBox.PanMode)
        self.setCentralItem(self.view)
        self.item = PictureItem()
        self.view.addItem(self.item, ignoreBounds=True)
        self.setMouseTracking(True)
        self.setMinimumSize(60, 60)
        self.view.sigRangeChangedManually.connect(self._moved)
        link.join(self)

    # For subclasses.

    def minimumSizeHint(self) -> QSize:
        """Return the same, however wide the bars are that a pane never shows."""
        return QSize(LEAST, LEAST)

    def point_at(self, place: QPointF) -> None:
        """Take note of where the pointer is."""

    def point_nowhere(self) -> None:
        """Take note that the pointer has left."""

    def click_at(self, place: QPointF) -> None:
        """Take a click."""

    def show_nothing(self) -> None:
        """Let go of every picture."""
        raise NotImplementedError

    # What is shown.

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self.setBackground(QColor(theme.canvas))

    def view_rect(self) -> QRectF:
        """Return the visible rectangle."""
        return QRectF(self.view.viewRect())

    def show_rect(self, rectangle: QRectF) -> None:
        """Make a rectangle visible."""
        self.view.setRange(rectangle, padding=0, disableAutoRange=True)

    def widget_place(self, x: float, y: float) -> QPointF:
        """Return where a place is painted, in the viewport."""
        return QPointF(self.mapFromScene(self.view.mapViewToScene(QPointF(x, y))))

    def view_place(self, position: QPoint) -> QPointF:
        """Return which place is painted at a position of the viewport."""
        return QPointF(self.view.mapSceneToView(self.mapToScene(position)))

    def detach(self) -> None:
        """Leave the link before the pane is deleted."""
        if self._link is not None:
            self._link.leave(self)

    def follow(self, link: Link[Any]) -> None:
        """Pan and zoom with the panes of another link."""
        if link is not self._link:
            self.detach()
            self._link = link
            link.join(self)
            link.resized()

    def _moved(self, *_: object) -> None:
        if self._link is not None:
            self._link.moved(self)

    # Events.

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit again when the user has not zoomed."""
        super().resizeEvent(event)
        if self._link is not None:
            self._link.resized(self)

    def mouseMoveEvent(self, event: Any) -> None:
        """Tell where the pointer is."""
        super().mouseMoveEvent(event)
        self.point_at(self.view_place(event.position().toPoint()))

    def leaveEvent(self, event: QEvent) -> None:
        """Tell that the pointer has left."""
        super().leaveEvent(event)
        self.point_nowhere()

    def mousePressEvent(self, event: Any) -> None:
        """Remember where the button went down."""
        self._press = event.position().toPoint()
        super().mousePressEvent(event)

    def mouseReleaseEvent(self, event: Any) -> None:
        """Take a press and release on one place as a click."""
        super().mouseReleaseEvent(event)
        here = event.position().toPoint()
        near = self._press is not None and (here - self._press).manhattanLength() <= CLICK_PX
        if event.button() == Qt.MouseButton.LeftButton and near:
            self.click_at(self.view_place(here))
        self._press = None

    def mouseDoubleClickEvent(self, event: Any) -> None:
        """Fit all panes."""
        super().mouseDoubleClickEvent(event)
        if self._link is not None:
            self._link.fit()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Leave context menus to what is around."""
        event.ignore()
