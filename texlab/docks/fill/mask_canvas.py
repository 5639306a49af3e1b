"""A picture on which a soft mask is painted: brush, rubber, box, lasso, with undo per stroke."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from PySide6.QtCore import QEvent, QObject, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor, QImage, QKeyEvent, QKeySequence, QMouseEvent, QPainter, QPolygonF

from texlab.docks.fill.strokes import Box, marked_box, stroke_box, stroke_lasso, stroke_line, united
from texlab.widgets.own_keys import OwnKeys, is_plain
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plots import pg

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtGui import QContextMenuEvent
    from PySide6.QtWidgets import QWidget

    from texlab.style.pictures import Picture

Tool = Literal["brush", "rubber", "rectangle", "lasso"]
MOST_UNDO = 50
DEFAULT_RADIUS = 8
ARROWS = {
    Qt.Key.Key_Left: (0, -1),
    Qt.Key.Key_Right: (0, 1),
    Qt.Key.Key_Up: (-1, 0),
    Qt.Key.Key_Down: (1, 0),
}
_WASH = QColor(255, 60, 120)
_WASH_ALPHA = 150


class WashItem(pg.GraphicsObject):  # type: ignore[misc]  # pyqtgraph has no types
    """The mask as a wash over the picture; only what is seen is painted, at the screen's resolution."""

    def __init__(self) -> None:
        super().__init__()
        self.shares: NDArray[np.uint8] = np.zeros((1, 1), np.uint8)
        self.outline: tuple[tuple[float, float], ...] = ()
        self.setZValue(5)

    def show_shares(self, shares: NDArray[np.uint8]) -> None:
        """Show this mask, (H, W) uint8."""
        if shares.shape != self.shares.shape:
            self.prepareGeometryChange()
        self.shares = shares
        self.update()

    def boundingRect(self) -> QRectF:
        """Return what the mask covers."""
        return QRectF(0, 0, self.shares.shape[1], self.shares.shape[0])

    def paint(self, painter: QPainter, *_: object) -> None:
        """Paint what is seen, skipping pixels that are smaller than those of the screen."""
        view = self.getViewBox()
        seen = self.boundingRect() if view is None else self.boundingRect().intersected(view.viewRect())
        if seen.isEmpty():
            return
        scale = max(abs(painter.worldTransform().m11()), 1e-6)
        step = max(1, int(1 / scale))
        top, left = int(seen.top()) // step * step, int(seen.left()) // step * step
        part = self.shares[top : int(seen.bottom()) + 1 : step, left : int(seen.right()) + 1 : step]
        if part.any():
            rows, columns = part.shape
            colours = np.empty((rows, columns, 4), np.uint8)
            colours[..., :3] = (_WASH.red(), _WASH.green(), _WASH.blue())
            colours[..., 3] = part.astype(np.uint16) * _WASH_ALPHA // 255
            image = QImage(colours.data, columns, rows, 4 * columns, QImage.Format.Format_RGBA8888)
            painter.drawImage(QRectF(left, top, columns * step, rows * step), image)
        if len(self.outline) > 1:
            painter.setPen(pg.mkPen(_WASH, width=2))
            painter.drawPolyline(QPolygonF([QPointF(column, row) for row, column in self.outline]))


class MaskCanvas(OwnKeys, PicturePane):
    """Shows a picture with its mask; the left button paints, the wheel zooms, the middle button moves.

    ``changed()`` after every stroke; ``menu_wanted(place)`` for the menu of the right button. The arrow keys move
    a cursor and the space bar paints there.
    """

    changed = Signal()
    menu_wanted = Signal(object)

    def __init__(self, name: str, label: str, parent: QWidget | None = None) -> None:
        super().__init__(name, label)
        self.setParent(parent)
        self.tool: Tool = "brush"
        self.radius = DEFAULT_RADIUS
        self.hardness = 1.0
        self.shares: NDArray[np.uint8] = np.zeros((1, 1), np.uint8)
        self._undo: list[tuple[Box, NDArray[np.uint8]]] = []
        self._redo: list[tuple[Box, NDArray[np.uint8]]] = []
        self._line: list[tuple[float, float]] = []
        self._before: NDArray[np.uint8] | None = None
        self._touched: Box | None = None
        self._cursor = (0, 0)
        self._wash = WashItem()
        self.view.addItem(self._wash, ignoreBounds=True)
        self._patches: list[Any] = []
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.viewport().installEventFilter(self)

    @property
    def mask(self) -> NDArray[np.bool_]:
        """What is marked at all, (H, W)."""
        marked: NDArray[np.bool_] = self.shares > 0
        return marked

    @property
    def can_undo(self) -> bool:
        """Whether there is a stroke to take back."""
        return bool(self._undo)

    def show_image(self, picture: Picture) -> None:
        """Paint on another picture; the mask is kept when the size is the same."""
        self.show_patches(())
        self.set_picture(picture)
        if self.shares.shape != picture.shape[:2]:
            self.set_shares(np.zeros(picture.shape[:2], np.uint8))
            self._cursor = (picture.shape[0] // 2, picture.shape[1] // 2)
        self._show_mask()

    def show_patches(self, patches: tuple[tuple[Box, Picture], ...]) -> None:
        """Lay these pictures, (h, w, 3 or 4) uint8, over their boxes of the picture."""
        for item in self._patches:
            self.view.removeItem(item)
        self._patches = []
        for (rows, columns), picture in patches:
            item = pg.ImageItem(picture, levels=None, autoLevels=False)
            item.setPos(columns.start, rows.start)
            item.setZValue(2)
            self.view.addItem(item, ignoreBounds=True)
            self._patches.append(item)

    def set_mask(self, mask: NDArray[np.bool_]) -> None:
        """Take another mask of the same size, as one step."""
        everything = slice(0, self.shares.shape[0]), slice(0, self.shares.shape[1])
        self._remember(everything, self.shares)
        self.shares = np.where(mask, np.uint8(255), np.uint8(0))
        self._show_mask()
        self.changed.emit()

    def set_shares(self, shares: NDArray[np.uint8]) -> None:
        """Take another mask, (H, W) uint8, and forget the strokes that led to the one before."""
        self.shares = shares
        self._undo.clear()
        self._redo.clear()
        self._show_mask()

    def undo(self) -> None:
        """Take the last stroke back."""
        self._step(self._undo, self._redo)

    def redo(self) -> None:
        """Paint the stroke again that was taken back last."""
        self._step(self._redo, self._undo)

    def _step(self, one: list[Any], other: list[Any]) -> None:
        if one:
            box, before = one.pop()
            other.append((box, self.shares[box].copy()))
            self.shares[box] = before
            self._show_mask()
            self.changed.emit()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Paint with the left button; everything else is the pane's."""
        if watched is self.viewport() and isinstance(event, QMouseEvent) and self.picture is not None:
            kind, left = event.type(), Qt.MouseButton.LeftButton
            if kind == QEvent.Type.MouseButtonPress and event.button() == left:
                self._begin(self._place(event))
                return True
            if kind == QEvent.Type.MouseMove and event.buttons() & left and self._before is not None:
                self._go_on(self._place(event))
                return True
            if kind == QEvent.Type.MouseButtonRelease and event.button() == left and self._before is not None:
                self._go_on(self._place(event))
                self._end()
                return True
            if kind == QEvent.Type.MouseButtonDblClick:
                return True
        return bool(super().eventFilter(watched, event))

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Ask for the menu."""
        self.menu_wanted.emit(event.globalPos())
        event.accept()

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it moves the brush, paints, or takes a stroke back (before anything else is)."""
        moves = event.key() in ARROWS or event.key() == Qt.Key.Key_Space
        return _stroke_key(event) is not None or (is_plain(event) and moves and self.picture is not None)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move with the arrow keys, paint with the space bar, take strokes back with the keys of undo."""
        back = _stroke_key(event)
        step = ARROWS.get(Qt.Key(event.key()))
        if not self.wants_key(event):
            super().keyPressEvent(event)
        elif back is not None:
            (self.undo if back == "undo" else self.redo)()
        elif step is not None:
            height, width = self.shares.shape
            row, column = self._cursor[0] + step[0] * self.radius, self._cursor[1] + step[1] * self.radius
            self._cursor = (min(max(row, 0), height - 1), min(max(column, 0), width - 1))
        else:
            self._begin((self._cursor[0] + 0.5, self._cursor[1] + 0.5))
            self._end()

    def _place(self, event: QMouseEvent) -> tuple[float, float]:
        point = self.view_place(event.position().toPoint())
        return float(point.y()), float(point.x())

    def _begin(self, place: tuple[float, float]) -> None:
        self._before = self.shares.copy()
        self._touched = None
        self._line = [place]
        self._go_on(place)

    def _go_on(self, place: tuple[float, float]) -> None:
        assert self._before is not None
        self._line.append(place)
        if self.tool in ("brush", "rubber"):
            *_, last, here = self._line
            erase = self.tool == "rubber"
            box = stroke_line(self.shares, last, here, self.radius, self.hardness, erase=erase)
            self._touched = united(self._touched, box)
        elif self.tool == "rectangle":
            if self._touched is not None:
                self.shares[self._touched] = self._before[self._touched]
            self._touched = stroke_box(self.shares, self._line[0], place)
        else:
            self._wash.outline = tuple(self._line)
        self._show_mask()

    def _end(self) -> None:
        before, self._before = self._before, None
        if self.tool == "lasso":
            self._touched = stroke_lasso(self.shares, self._line)
        self._wash.outline = ()
        self._show_mask()
        box = self._touched
        if before is not None and box is not None and not np.array_equal(before[box], self.shares[box]):
            self._remember(box, before)
            self.changed.emit()

    def _remember(self, box: Box, before: NDArray[np.uint8]) -> None:
        # Of a large picture only what the stroke has touched.
        self._undo = [*self._undo[1 - MOST_UNDO :], (box, before[box].copy())]
        self._redo.clear()

    def _show_mask(self) -> None:
        self._wash.show_shares(self.shares)

    def marked_box(self) -> Box | None:
        """Return the smallest box around what is marked, or None."""
        return marked_box(self.shares)


def _stroke_key(event: QKeyEvent) -> Literal["undo", "redo"] | None:
    """Return what a key does to the last stroke."""
    if event.matches(QKeySequence.StandardKey.Undo):
        return "undo"
    return "redo" if event.matches(QKeySequence.StandardKey.Redo) else None
