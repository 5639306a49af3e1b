"""A picture on which a mask is painted: brush, rubber, rectangle, with undo."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent, QKeySequence, QMouseEvent

from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plots import pg

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtWidgets import QWidget

    from texlab.style.pictures import Picture

Tool = Literal["brush", "rubber", "rectangle"]
MOST_UNDO = 50
DEFAULT_RADIUS = 8
_WASH = np.array([255, 60, 120, 130], np.uint8)


class MaskCanvas(PicturePane):
    """Shows a picture with its mask; the left button paints, the wheel zooms.

    ``changed()`` after every stroke. The arrow keys move a cursor and the space bar paints there.
    """

    changed = Signal()

    def __init__(self, name: str, label: str, parent: QWidget | None = None) -> None:
        super().__init__(name, label)
        self.setParent(parent)
        self.tool: Tool = "brush"
        self.radius = DEFAULT_RADIUS
        self.mask: NDArray[np.bool_] = np.zeros((1, 1), np.bool_)
        self._undo: list[NDArray[np.bool_]] = []
        self._redo: list[NDArray[np.bool_]] = []
        self._last: tuple[float, float] | None = None
        self._corner: tuple[float, float] | None = None
        self._before: NDArray[np.bool_] | None = None
        self._cursor = (0, 0)
        self._wash = pg.ImageItem(levels=None)
        self._wash.setZValue(5)
        self.view.addItem(self._wash)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.viewport().installEventFilter(self)

    def show_image(self, picture: Picture) -> None:
        """Paint on another picture; the mask is kept when the size is the same."""
        self.set_picture(picture)
        if self.mask.shape != picture.shape[:2]:
            self.mask = np.zeros(picture.shape[:2], np.bool_)
            self._undo.clear()
            self._redo.clear()
            self._cursor = (picture.shape[0] // 2, picture.shape[1] // 2)
        self._show_mask()

    def set_mask(self, mask: NDArray[np.bool_]) -> None:
        """Take another mask of the same size, as one step."""
        self._remember(self.mask.copy())
        self.mask = mask.copy()
        self._show_mask()
        self.changed.emit()

    def undo(self) -> None:
        """Take the last stroke back."""
        if self._undo:
            self._redo.append(self.mask)
            self.mask = self._undo.pop()
            self._show_mask()
            self.changed.emit()

    def redo(self) -> None:
        """Paint the stroke again that was taken back last."""
        if self._redo:
            self._undo.append(self.mask)
            self.mask = self._redo.pop()
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

    def event(self, event: QEvent) -> bool:
        """Keep the keys of undo and redo: a stroke is taken back here before anything else is."""
        if isinstance(event, QKeyEvent) and event.type() == QEvent.Type.ShortcutOverride and _stroke_key(event):
            event.accept()
            return True
        return bool(super().event(event))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move with the arrow keys, paint with the space bar, take strokes back with the keys of undo."""
        back = _stroke_key(event)
        if back is not None:
            (self.undo if back == "undo" else self.redo)()
            return
        steps = {
            Qt.Key.Key_Left: (0, -1), Qt.Key.Key_Right: (0, 1), Qt.Key.Key_Up: (-1, 0), Qt.Key.Key_Down: (1, 0),
        }  # fmt: skip
        step = steps.get(Qt.Key(event.key()))
        if step is not None and self.picture is not None:
            height, width = self.mask.shape
            row, column = self._cursor[0] + step[0] * self.radius, self._cursor[1] + step[1] * self.radius
            self._cursor = (min(max(row, 0), height - 1), min(max(column, 0), width - 1))
        elif event.key() == Qt.Key.Key_Space and self.picture is not None:
            self._begin((self._cursor[0] + 0.5, self._cursor[1] + 0.5))
            self._end()
        else:
            super().keyPressEvent(event)

    def _place(self, event: QMouseEvent) -> tuple[float, float]:
        point = self.view_place(event.position().toPoint())
        return float(point.y()), float(point.x())

    def _begin(self, place: tuple[float, float]) -> None:
        self._before = self.mask.copy()
        self._last = self._corner = place
        self._go_on(place)

    def _go_on(self, place: tuple[float, float]) -> None:
        assert self._before is not None
        assert self._corner is not None
        assert self._last is not None
        if self.tool == "rectangle":
            self.mask = self._before.copy()
            (top, bottom), (left, right) = (
                sorted((round(a), round(b))) for a, b in zip(self._corner, place, strict=True)
            )
            self.mask[max(top, 0) : max(bottom, 0), max(left, 0) : max(right, 0)] = True
        else:
            paint_line(self.mask, self._last, place, self.radius, self.tool == "brush")
        self._last = place
        self._show_mask()

    def _end(self) -> None:
        before, self._before = self._before, None
        if before is not None and not np.array_equal(before, self.mask):
            self._remember(before)
            self.changed.emit()

    def _remember(self, before: NDArray[np.bool_]) -> None:
        self._undo = [*self._undo[1 - MOST_UNDO :], before]
        self._redo.clear()

    def _show_mask(self) -> None:
        wash = np.where(self.mask[..., None], _WASH, np.uint8(0)).astype(np.uint8)
        self._wash.setImage(wash, autoLevels=False, levels=None)


def _stroke_key(event: QKeyEvent) -> Literal["undo", "redo"] | None:
    """Return what a key does to the last stroke."""
    if event.matches(QKeySequence.StandardKey.Undo):
        return "undo"
    return "redo" if event.matches(QKeySequence.StandardKey.Redo) else None


def paint_line(
    mask: NDArray[np.bool_], first: tuple[float, float], last: tuple[float, float], radius: int, value: bool
) -> None:
    """Set all pixels whose centre lies within ``radius`` of the line between two places (row, column)."""
    height, width = mask.shape
    top = max(0, int(min(first[0], last[0]) - radius - 1))
    bottom = min(height, int(max(first[0], last[0]) + radius + 2))
    left = max(0, int(min(first[1], last[1]) - radius - 1))
    right = min(width, int(max(first[1], last[1]) + radius + 2))
    if top >= bottom or left >= right:
        return
    rows = np.arange(top, bottom)[:, None] + 0.5 - first[0]
    columns = np.arange(left, right)[None, :] + 0.5 - first[1]
    along = (last[0] - first[0], last[1] - first[1])
    length = along[0] ** 2 + along[1] ** 2
    share: Any = 0.0
    if length > 0:
        share = np.clip((rows * along[0] + columns * along[1]) / length, 0, 1)
    distance = (rows - share * along[0]) ** 2 + (columns - share * along[1]) ** 2
    mask[top:bottom, left:right][distance <= radius**2] = value
