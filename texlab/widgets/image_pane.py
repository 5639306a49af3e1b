"""A pane that shows one image; all panes share pan and zoom through :class:`ViewLink`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QPainter

from texlab.widgets.pane import Pane
from texlab.widgets.picture_item import PictureItem
from texlab.widgets.plain import Label

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray
    from PySide6.QtGui import QResizeEvent
    from PySide6.QtWidgets import QWidget

    from texlab.style.pictures import Mark, Picture
    from texlab.widgets.view_link import ViewLink


NOTE_MARGIN = 8
SMALLEST_MARK = 5.0
# Lines of marks are made for text of this size.
USUAL_POINTS = 12.0
MARK_COLOURS = {"candidate": "#ffd54a", "window": "#4ac8ff", "chosen": "#ff4fa3"}


class MarksItem(pg.GraphicsObject):  # type: ignore[misc]  # pyqtgraph has no types
    """Outlines of places, painted with lines of the same width at any zoom."""

    def __init__(self) -> None:
        super().__init__()
        self._lines: dict[tuple[str, bool], list[QRectF]] = {}
        self._bounds = QRectF()
        self.thickness = 1.0
        self.setZValue(20)

    def show_marks(self, marks: tuple[Mark, ...], offset: tuple[float, float]) -> None:
        """Outline these places."""
        self.prepareGeometryChange()
        self._lines = {(role, dotted): [] for role in MARK_COLOURS for dotted in (False, True)}
        self._bounds = QRectF()
        for mark in marks:
            place = QRectF(mark.left + offset[1], mark.top + offset[0], mark.width, mark.height)
            self._lines[mark.role, mark.dotted].append(place)
            self._bounds = self._bounds.united(place)
        self.update()

    def boundingRect(self) -> QRectF:
        """Return what the outlines cover."""
        # Marks of single pixels are painted larger when the picture is small.
        return self._bounds.adjusted(-8, -8, 8, 8)

    def paint(self, painter: QPainter, *_: object) -> None:
        """Paint a dark line under a bright one: seen on any picture, and never smaller than a few pixels."""
        painter.setBrush(Qt.BrushStyle.NoBrush)
        least = SMALLEST_MARK / max(abs(painter.worldTransform().m11()), 1e-6)
        for (role, dotted), outlined in self._lines.items():
            places = [_enlarged(place, least) for place in outlined]
            if places:
                line = Qt.PenStyle.DotLine if dotted else Qt.PenStyle.SolidLine
                lines = ("#000000", 3, Qt.PenStyle.SolidLine), (MARK_COLOURS[role], 1 + (role == "chosen"), line)
                for colour, width, style in lines:
                    painter.setPen(pg.mkPen(colour, width=width * self.thickness, style=style))
                    painter.drawRects(places)


def _enlarged(place: QRectF, least: float) -> QRectF:
    """Return a rectangle with the same centre whose sides are not shorter than ``least``."""
    grow = max(least - place.width(), 0.0) / 2, max(least - place.height(), 0.0) / 2
    return place.adjusted(-grow[0], -grow[1], *grow)


class ImagePane(Pane):
    """Shows an (H, W, 3) uint8 picture with nearest-neighbour enlargement.

    ``hovered(row, column)`` gives the image pixel under the cursor (modulo the image when tiled), (-1, -1)
    outside; ``clicked(row, column)`` likewise; ``double_clicked()`` wherever that is.
    """

    hovered = Signal(int, int)
    clicked = Signal(int, int)
    painted = Signal()
    double_clicked = Signal()
    # The base class resizes itself while it is made.
    _picture: Picture | None = None
    _note: Label | None = None
    _copies: Sequence[PictureItem] = ()
    _overlay: PictureItem | None = None
    _light: PictureItem | None = None

    def __init__(self, link: ViewLink, parent: QWidget | None = None) -> None:
        self._tiled = False
        self._look: NDArray[np.uint8] | None = None
        super().__init__(link, parent)
        self._marks: MarksItem | None = None
        self.view.sigResized.connect(lambda _: self._link.resized(self) if self._link is not None else None)

    @property
    def picture(self) -> Picture | None:
        """What is shown."""
        return self._picture

    @property
    def tiled(self) -> bool:
        """Whether the picture is shown 2 x 2."""
        return self._tiled

    @property
    def extent(self) -> tuple[int, int] | None:
        """Height and width of what is shown, with its copies when tiled."""
        if self._picture is None:
            return None
        factor = 2 if self._tiled else 1
        return self._picture.shape[0] * factor, self._picture.shape[1] * factor

    def set_picture(self, picture: Picture | None) -> None:
        """Show a picture, or nothing."""
        if picture is not self._picture:
            # What lit up were pixels of another picture.
            self.set_light(None)
        self._picture = picture
        self._place_copies()
        for item in (self.item, *self._copies):
            item.show_picture(picture, *self._seen(item), self._look)
        self._choose_filter()
        self.painted.emit()

    def show_nothing(self) -> None:
        """Let go of the picture, and of what lies over it."""
        self.set_overlay(None)
        self.set_marks(())
        self.set_picture(None)

    def set_look(self, table: NDArray[np.uint8] | None) -> None:
        """Paint every gray level as another one, (256,) uint8; None paints them as they are."""
        if table is not None or self._look is not None:
            self._look = table
            self.set_picture(self._picture)

    def _seen(self, item: PictureItem) -> tuple[QRectF, float]:
        """Return what can be seen of an item, and how many of its pixels make one of the screen."""
        pixel = 1 / max(self.shown_scale * self.devicePixelRatioF(), 1e-9)
        return self.view_rect().translated(-item.pos().x(), -item.pos().y()), pixel

    def _prepare(self) -> None:
        """Prepare for painting what can be seen of large pictures."""
        laid_over = (each for each in (self._overlay, self._light) if each is not None)
        for item in (self.item, *self._copies, *laid_over):
            item.look(*self._seen(item))

    def set_surround(self, colour: str) -> None:
        """Paint this around the picture; "" leaves what the theme says."""
        if colour:
            self.setBackground(QColor(colour))

    def set_note(self, text: str) -> None:
        """Say something in the place of the picture; nothing with an empty text."""
        if self._note is None and text:
            self._note = Label(parent=self)
            self._note.setObjectName("pane-note")
            self._note.setProperty("role", "error")
            self._note.setWordWrap(True)
            self._note.setAlignment(Qt.AlignmentFlag.AlignCenter)
            self._note.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        if self._note is not None:
            self._note.setText(text)
            self._note.setVisible(bool(text))
            self._place_note()

    def _place_note(self) -> None:
        if self._note is not None:
            self._note.setGeometry(self.rect().adjusted(NOTE_MARGIN, NOTE_MARGIN, -NOTE_MARGIN, -NOTE_MARGIN))

    def set_tiled(self, tiled: bool) -> None:
        """Show the picture 2 x 2 so that seams are seen."""
        if tiled == self._tiled:
            return
        self._tiled = tiled
        for copy in self._copies:
            self.view.removeItem(copy)
        self._copies = [PictureItem() for _ in range(3)] if tiled else []
        for copy in self._copies:
            self.view.addItem(copy)
        self.set_picture(self._picture)
        link = self._link
        if link is not None:
            link.resized()

    def set_overlay(self, picture: Picture | None, opacity: float = 0.6) -> None:
        """Lay a coloured map of the same size over the picture, or take it away."""
        if picture is None:
            if self._overlay is not None:
                self.view.removeItem(self._overlay)
                self._overlay = None
            return
        if self._overlay is None:
            self._overlay = PictureItem()
            self._overlay.setZValue(10)
            self.view.addItem(self._overlay)
        self._overlay.setOpacity(opacity)
        self._overlay.show_picture(picture, *self._seen(self._overlay))

    @property
    def light(self) -> NDArray[np.uint8] | None:
        """What lights up, or nothing."""
        return None if self._light is None else self._light.whole

    def set_light(self, veil: NDArray[np.uint8] | None, offset: tuple[int, int] = (0, 0)) -> None:
        """Lay a veil (H, W, 4) over the picture, so far down and across, until the picture is another one."""
        if self._light is not None:
            self.view.removeItem(self._light)
            self._light = None
        if veil is None:
            return
        height, width = offset[0] + veil.shape[0], offset[1] + veil.shape[1]
        if any(offset):
            placed = np.zeros((height, width, 4), np.uint8)
            placed[offset[0] :, offset[1] :] = veil
            veil = placed
        self._light = PictureItem()
        self._light.setZValue(11)
        self.view.addItem(self._light)
        self._light.show_picture(veil, *self._seen(self._light))

    def set_marks(self, marks: tuple[Mark, ...], offset: tuple[float, float] = (0.0, 0.0)) -> None:
        """Outline places of the picture; ``offset`` (row, column) is added to them."""
        if not marks and self._marks is None:
            return
        if self._marks is None:
            self._marks = MarksItem()
            self.view.addItem(self._marks, ignoreBounds=True)
        # Lines are as thick as the strokes of the letters around them.
        self._marks.thickness = max(1.0, self.font().pointSizeF() / USUAL_POINTS)
        self._marks.show_marks(marks, offset)

    def show_rect(self, rectangle: QRectF) -> None:
        """Make a rectangle of image coordinates visible."""
        super().show_rect(rectangle)
        self._choose_filter()

    @property
    def shown_scale(self) -> float:
        """Widget pixels per image pixel."""
        return float(self.view.width() / max(self.view_rect().width(), 1e-9))

    def show_around(self, centre: QPointF, scale: float) -> None:
        """Show a place in the middle, at so many widget pixels per image pixel."""
        width, height = self.view.width() / scale, self.view.height() / scale
        self.show_rect(QRectF(centre.x() - width / 2, centre.y() - height / 2, width, height))

    def to_widget(self, row: float, column: float) -> QPointF:
        """Return where an image position is painted, in widget coordinates."""
        return self.widget_place(column, row)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Fit again when the user has not zoomed."""
        super().resizeEvent(event)
        self._place_note()

    def _place_copies(self) -> None:
        if self._picture is None:
            return
        height, width = self._picture.shape[:2]
        for copy, (row, column) in zip(self._copies, ((0, 1), (1, 0), (1, 1)), strict=False):
            copy.setPos(column * width, row * height)

    def _moved(self, *_: object) -> None:
        self._choose_filter()
        super()._moved()

    def _choose_filter(self) -> None:
        self._prepare()
        # Enlarged pixels stay squares; reduced images are smoothed, or the window would show aliases.
        # Asking the view brings its matrix up to date: else it would be when painting, and painted a second time.
        pixel = self.view.viewPixelSize()[0] * self.devicePixelRatioF() if self._picture is not None else 0.0
        self.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, pixel > 1.001)

    def _pixel(self, place: QPointF) -> tuple[int, int]:
        extent = self.extent
        if extent is None or self._picture is None:
            return -1, -1
        row, column = int(np.floor(place.y())), int(np.floor(place.x()))
        if not (0 <= row < extent[0] and 0 <= column < extent[1]):
            return -1, -1
        return row % self._picture.shape[0], column % self._picture.shape[1]

    def point_at(self, place: QPointF) -> None:
        """Tell which pixel is under the pointer."""
        self.hovered.emit(*self._pixel(place))

    def point_nowhere(self) -> None:
        """Tell that the pointer has left."""
        self.hovered.emit(-1, -1)

    def mouseDoubleClickEvent(self, event: Any) -> None:
        """Tell of it: what is around decides."""
        event.accept()
        if event.button() == Qt.MouseButton.LeftButton:
            self.double_clicked.emit()

    def click_at(self, place: QPointF) -> None:
        """Tell which pixel was clicked."""
        self.clicked.emit(*self._pixel(place))
