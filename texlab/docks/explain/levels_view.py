"""The exemplar's pyramid, level beside level, with places marked in each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QImage, QPainter, QPen, QPixmap
from PySide6.QtWidgets import QSizePolicy, QWidget

from texlab.style.text_size import MORE, whole_words
from texlab.style.theme import DARK, LIGHT
from texlab.widgets.image_pane import MARK_COLOURS
from texlab.widgets.own_keys import OwnKeys, is_plain
from texlab.widgets.plain import set_tip

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtCore import QEvent
    from PySide6.QtGui import QFontMetrics, QKeyEvent, QMouseEvent, QPaintEvent, QResizeEvent

    from texlab.style.pictures import Picture
    from texlab.style.theme import Theme

GAP = 8.0
SMALLEST_MARK = 4.0
REACH = 12.0
STEPS = {Qt.Key.Key_Left: (-1, 0), Qt.Key.Key_Right: (1, 0), Qt.Key.Key_Up: (0, -1), Qt.Key.Key_Down: (0, 1)}


@dataclass(frozen=True, eq=False)
class Tile:
    """One level.

    Parameters
    ----------
    title, note
        Two lines above the picture.
    picture
        (h, w, 3) uint8.
    places
        (n, 2) int32 rows and columns to mark.
    chosen
        Index of the place that was taken.
    """

    title: str
    note: str
    picture: Picture
    places: NDArray[np.int32]
    chosen: int


class LevelsView(OwnKeys, QWidget):
    """Shows tiles, one of them selected, and one place of it.

    ``selected(tile, place)``: clicked, or reached with the arrow keys. ``pointed(tile, place)``: the place under
    the pointer, (-1, -1) when there is none.
    """

    selected = Signal(int, int)
    pointed = Signal(int, int)

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName("Candidates in the levels of the exemplar's pyramid")
        set_tip(
            self,
            "The exemplar's pyramid, coarsest level first: yellow are the candidates, pink is the one that was "
            "taken. Arrows left and right choose a level, up and down a candidate.",
        )
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self._theme: Theme = DARK if self.palette().window().color().lightness() < 128 else LIGHT
        self._tiles: tuple[Tile, ...] = ()
        self._tile, self._place = 0, 0
        self._pointed = (-1, -1)
        self._scaled: dict[int, tuple[Picture, QPixmap]] = {}

    @property
    def current(self) -> tuple[int, int]:
        """The selected tile and the selected place in it."""
        return self._tile, self._place

    def show_tiles(self, tiles: tuple[Tile, ...], tile: int, place: int) -> None:
        """Show tiles, and select one with one of its places."""
        if len(tiles) != len(self._tiles):
            self._scaled.clear()
        self._tiles = tiles
        self._pointed = (-1, -1)
        self.select(tile, place)

    def select(self, tile: int, place: int) -> None:
        """Select a tile and one of its places without telling anyone."""
        self._tile, self._place = tile, place
        words = ""
        if self._tiles:
            each = self._tiles[tile]
            words = f"{each.title}: {each.note}, place {place + 1} of {len(each.places)}"
        self.setAccessibleDescription(words)
        self.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.update()

    def sizeHint(self) -> QSize:
        """Ask for little: docks are low."""
        return QSize(420, 120)

    def minimumSizeHint(self) -> QSize:
        """Return what can still be seen."""
        return QSize(200, max(80, round(4.5 * self.fontMetrics().height())))

    # Where things are.

    def tile_rect(self, tile: int) -> QRectF:
        """Return where the picture of a tile is painted."""
        count = max(len(self._tiles), 1)
        top = 2.0 * self.fontMetrics().height() + 4
        pitch = (self.width() - GAP) / count
        height, width = self._tiles[tile].picture.shape[:2]
        scale = max(min((pitch - GAP) / width, (self.height() - top - 4) / height), 0.01)
        left = GAP + tile * pitch + (pitch - GAP - scale * width) / 2
        return QRectF(left, top, scale * width, scale * height)

    def place_rect(self, tile: int, place: int) -> QRectF:
        """Return where a place is marked."""
        row, column = (int(part) for part in self._tiles[tile].places[place])
        return self._rect(tile, row, column)

    def _rect(self, tile: int, row: int, column: int) -> QRectF:
        area = self.tile_rect(tile)
        scale = area.width() / self._tiles[tile].picture.shape[1]
        found = QRectF(area.left() + column * scale, area.top() + row * scale, scale, scale)
        if scale < SMALLEST_MARK:
            centre = found.center()
            found = QRectF(0, 0, SMALLEST_MARK, SMALLEST_MARK)
            found.moveCenter(centre)
        return found

    def _at(self, point: QPointF) -> tuple[int, int]:
        """Return the tile at a point and the place nearest to it, -1 for none."""
        for tile, each in enumerate(self._tiles):
            area = self.tile_rect(tile)
            column = area.adjusted(-GAP / 2, -area.top(), GAP / 2, self.height())
            if column.contains(point):
                scale = area.width() / each.picture.shape[1]
                where = np.array([point.y() - area.top(), point.x() - area.left()])
                distances = np.hypot(*((each.places + 0.5) * scale - where).T)
                nearest = int(distances.argmin()) if distances.size else -1
                return tile, nearest if nearest >= 0 and distances[nearest] <= max(REACH, scale) else -1
        return -1, -1

    # Mouse and keyboard.

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Tell which place is under the pointer."""
        self._point(self._at(event.position()))

    def leaveEvent(self, event: QEvent) -> None:
        """Tell that the pointer has left."""
        super().leaveEvent(event)
        self._point((-1, -1))

    def _point(self, pointed: tuple[int, int]) -> None:
        pointed = pointed if pointed[1] >= 0 else (-1, -1)
        if pointed != self._pointed:
            self._pointed = pointed
            self.update()
            self.pointed.emit(*pointed)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Select the tile, and the place, under the pointer."""
        tile, place = self._at(event.position())
        if tile >= 0:
            self._select(tile, place if place >= 0 else self._tiles[tile].chosen)

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it selects another tile or place."""
        key = Qt.Key(event.key())
        return is_plain(event) and bool(self._tiles) and (key in STEPS or key == Qt.Key.Key_Home)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Select another tile or another place; Home goes back to the one that was taken."""
        key = Qt.Key(event.key())
        if not self.wants_key(event):
            super().keyPressEvent(event)
        elif key == Qt.Key.Key_Home:
            self._select(self._tile, self._tiles[self._tile].chosen)
        else:
            along, across = STEPS[key]
            if along:
                tile = min(max(self._tile + along, 0), len(self._tiles) - 1)
                self._select(tile, self._tiles[tile].chosen)
            else:
                self._select(self._tile, (self._place + across) % len(self._tiles[self._tile].places))

    def _select(self, tile: int, place: int) -> None:
        if (tile, place) != self.current:
            self.select(tile, place)
            self.selected.emit(tile, place)

    # Painting.

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Scale the pictures anew."""
        super().resizeEvent(event)
        self._scaled.clear()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the levels, and the places over them."""
        painter = QPainter(self)
        for tile, each in enumerate(self._tiles):
            self._paint_tile(painter, tile, each)
        painter.end()

    def _paint_tile(self, painter: QPainter, tile: int, each: Tile) -> None:
        area = self.tile_rect(tile)
        painter.drawPixmap(area.topLeft(), self._pixmap(tile, area))
        metrics = self.fontMetrics()
        pitch = (self.width() - GAP) / len(self._tiles)
        head = QRectF(area.center().x() - pitch / 2, 0, pitch, metrics.height())
        for words, colour in ((each.title, self._theme.text), (each.note, self._theme.muted)):
            painter.setPen(QColor(colour))
            painter.drawText(head, Qt.AlignmentFlag.AlignCenter, _fitting(words, metrics, pitch))
            head.translate(0, metrics.height())
        painter.setBrush(Qt.BrushStyle.NoBrush)
        if tile == self._tile:
            painter.setPen(QPen(QColor(self._theme.accent), 3 if self.hasFocus() else 2))
            painter.drawRect(area.adjusted(-3, -3, 3, 3))
        self._paint_places(painter, tile, each)

    def _paint_places(self, painter: QPainter, tile: int, each: Tile) -> None:
        others = [self._rect(tile, row, column) for row, column in each.places.tolist()]
        _outline(painter, others, MARK_COLOURS["candidate"], 1)
        if each.places.size:
            _outline(painter, [others[each.chosen]], MARK_COLOURS["chosen"], 2)
        for which in ((self._tile, self._place), self._pointed):
            if which[0] == tile and 0 <= which[1] < len(others) and which[1] != each.chosen:
                _outline(painter, [others[which[1]].adjusted(-1, -1, 1, 1)], MARK_COLOURS["window"], 2)

    def _pixmap(self, tile: int, area: QRectF) -> QPixmap:
        picture = self._tiles[tile].picture
        kept = self._scaled.get(tile)
        if kept is None or kept[0] is not picture:
            height, width = picture.shape[:2]
            image = QImage(picture.data, width, height, 3 * width, QImage.Format.Format_RGB888)
            size = area.size().toSize()
            mode = Qt.TransformationMode.FastTransformation
            if size.width() < width:
                mode = Qt.TransformationMode.SmoothTransformation
            scaled = image.scaled(size, Qt.AspectRatioMode.IgnoreAspectRatio, mode)
            kept = self._scaled[tile] = (picture, QPixmap.fromImage(scaled))
        return kept[1]


def _outline(painter: QPainter, places: list[QRectF], colour: str, width: int) -> None:
    """Outline places with a bright line over a dark one: seen on any picture."""
    for pen_colour, pen_width in (("#000000", width + 2), (colour, width)):
        painter.setPen(QPen(QColor(pen_colour), pen_width))
        painter.drawRects(places)


def _fitting(words: str, metrics: QFontMetrics, room: float) -> str:
    """Return a title that fits: of "level 4" the number says more than the word; of other titles whole words."""
    if metrics.horizontalAdvance(words) <= room:
        return words
    last = words.split(" ")[-1]
    found = last if last.isdecimal() else whole_words(words, metrics, room)
    return "" if MORE in found else found
