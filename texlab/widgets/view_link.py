"""What all panes show: the same place at the same scale."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from PySide6.QtCore import QPointF, QRectF

from texlab.widgets.pane import Link

if TYPE_CHECKING:
    from collections.abc import Callable

# What is thinner on the screen, in pixels, is enlarged to this, or to its own size.
LEAST = 8


class Linked(Protocol):
    """A pane that can follow others."""

    @property
    def tiled(self) -> bool:
        """Whether it shows its picture two by two."""
        ...

    @property
    def shown_scale(self) -> float:
        """Widget pixels per image pixel."""
        ...

    def devicePixelRatioF(self) -> float:
        """Return pixels of the screen per logical pixel."""
        ...

    def view_rect(self) -> QRectF:
        """Return what is shown, in image pixels."""
        ...

    def show_rect(self, rectangle: QRectF) -> None:
        """Show this, whole."""
        ...

    def show_around(self, centre: QPointF, scale: float) -> None:
        """Show a place in the middle, at so many widget pixels per image pixel."""
        ...


class ViewLink(Link[Linked]):
    """One place that every pane shows.

    ``setXLink`` before the first image breaks the automatic range, so the panes are told instead. As long as the
    user has not moved or zoomed, the largest picture is shown whole, or from its corner where another one would be
    too thin to be seen; afterwards the panes keep centre and scale when they are resized, and new ones take them
    over.
    """

    def __init__(self) -> None:
        super().__init__()
        # None as long as nobody knows how large the pictures are.
        self._known: tuple[int, int] | None = None
        self._thinnest = 0
        self._centre = QPointF()
        self._scale: float | None = None
        self._focus: QRectF | None = None
        self.rescaled: Callable[[], None] = lambda: None
        """Called after the panes show another place or scale."""

    @property
    def percent(self) -> float | None:
        """Pixels of the screen per hundred of the picture; None without a pane, or before any picture is known."""
        if not self._panes or self._known is None:
            return None
        first = self._panes[0]
        return 100 * first.shown_scale * first.devicePixelRatioF()

    @property
    def _extent(self) -> tuple[int, int]:
        return self._known or (1, 1)

    def set_percent(self, percent: float) -> None:
        """Show this many pixels of the screen per hundred of the picture, around the present centre."""
        if self._panes:
            self._rescale(percent / 100 / self._panes[0].devicePixelRatioF())

    def moved(self, source: Linked) -> None:
        """Show in all panes what the user made one show."""
        self._centre, self._scale = source.view_rect().center(), source.shown_scale
        for pane in self._panes:
            if pane is not source:
                pane.show_around(self._centre, self._scale)
        self.rescaled()

    def set_extent(self, height: int, width: int, thinnest: int = 0) -> None:
        """Say how large the largest picture is or will be (a draft may be smaller for a moment).

        ``thinnest`` is the shortest side of any picture, where that may be much less.
        """
        if (height, width, thinnest) != (*(self._known or ()), self._thinnest):
            self._known, self._thinnest = (height, width), thinnest
            if self._scale is None:
                self.fit()

    def set_focus(self, rectangle: QRectF | None) -> None:
        """Say which part, in image pixels, is shown whole; None for the largest picture."""
        if rectangle != self._focus:
            self._focus = rectangle
            self.fit()

    def resized(self, only: Linked | None = None) -> None:
        """Show the same again after a pane came, changed its size or was tiled; in one pane, or in all."""
        if self._scale is None:
            self._fit(only)
        else:
            for pane in self._those(only):
                pane.show_around(self._centre, self._scale)
        self.rescaled()

    def fit(self) -> None:
        """Show the largest picture whole, and the others at the same scale."""
        self._scale = None
        self._fit()
        self.rescaled()

    def _fit(self, only: Linked | None = None) -> None:
        factor = 2 if any(pane.tiled for pane in self._panes) else 1
        rectangle = self._focus or QRectF(0, 0, self._extent[1] * factor, self._extent[0] * factor)
        for pane in self._those(only):
            pane.show_rect(rectangle)
            if self._focus is None and pane.shown_scale * self._thinnest < min(LEAST, self._thinnest):
                self._show_corner(pane, rectangle, min(1.0, LEAST / self._thinnest))

    @staticmethod
    def _show_corner(pane: Linked, rectangle: QRectF, scale: float) -> None:
        """Show as much of a rectangle as there is room for at a scale, from its top left corner."""
        shown = pane.view_rect()
        room = pane.shown_scale / scale
        width, height = (
            min(rectangle.width(), room * shown.width()),
            min(rectangle.height(), room * shown.height()),
        )
        pane.show_around(QPointF(width / 2, height / 2), scale)

    def actual_size(self) -> None:
        """Show one image pixel per screen pixel around the present centre."""
        if self._panes:
            self._rescale(1 / self._panes[0].devicePixelRatioF())

    def show_at(self, x: float, y: float, scale: float) -> None:
        """Show this place in the middle, one image pixel as so many screen pixels."""
        if self._panes:
            self._centre, self._scale = QPointF(x, y), scale / self._panes[0].devicePixelRatioF()
            self.resized()

    def zoom(self, factor: float) -> None:
        """Enlarge around the centre."""
        if self._panes:
            self._rescale(self._panes[0].shown_scale * factor)

    def _rescale(self, scale: float) -> None:
        self._centre, self._scale = self._panes[0].view_rect().center(), scale
        self.resized()
