"""Small pictures side by side with captions, frames and a choice; for mouse and keyboard."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from PySide6.QtCore import QEvent, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QImage, QPainter, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PySide6.QtGui import QKeyEvent, QMouseEvent, QPaintEvent

    from texlab.scene import Picture
    from texlab.theme import Theme

Frame = Literal["window", "chosen", "match", "other"]
GAP = 8


@dataclass(frozen=True, slots=True, eq=False)
class Patch:
    """One small picture, (h, w, 3) uint8, with what is written below it, its frame, and its name in words."""

    picture: Picture
    caption: str
    frame: Frame
    title: str


class PatchGrid(QWidget):
    """Shows a large patch and others in rows beside it, as large as they fit.

    ``chosen(index)`` and ``hovered(index)`` tell a patch, -1 for none.
    """

    chosen = Signal(int)
    hovered = Signal(int)

    def __init__(self, name: str, label: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(label)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(160, 80)
        self._theme: Theme | None = None
        self._patches: tuple[Patch, ...] = ()
        self._selected = -1

    @property
    def patches(self) -> tuple[Patch, ...]:
        """What is shown."""
        return self._patches

    @property
    def selected(self) -> int:
        """Index of the chosen patch, -1 for none."""
        return self._selected

    def show_patches(self, patches: Sequence[Patch]) -> None:
        """Show patches; the first one stands for itself, the others are compared with it."""
        self._patches = tuple(patches)
        self.select(self._selected)

    def select(self, index: int) -> None:
        """Mark a patch without telling anyone."""
        self._selected = index if 0 <= index < len(self._patches) else -1
        self.setAccessibleDescription(self._patches[self._selected].title if self._selected >= 0 else "")
        self.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.update()

    def sizeHint(self) -> QSize:
        """Ask for two rows of patches."""
        return QSize(480, 190)

    def patch_rect(self, index: int) -> QRectF:
        """Return where a picture is painted: the first one as high as all rows of the others."""
        across, side = self._arrangement()
        rows = -(-(len(self._patches) - 1) // across)
        large = max(rows, 1) * (side + GAP + self._words()) - GAP - self._words()
        if index == 0:
            return QRectF(GAP, GAP, large, large)
        row, column = divmod(index - 1, across)
        left = 3 * GAP + large + column * (side + GAP)
        return QRectF(left, GAP + row * (side + GAP + self._words()), side, side)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint pictures, frames and captions."""
        if self._theme is None or not self._patches:
            return
        theme, metrics = self._theme, self.fontMetrics()
        painter = QPainter(self)
        pens = {
            "window": QPen(QColor(theme.third), 2),
            "chosen": QPen(QColor(theme.result), 4),
            "match": QPen(QColor(theme.exemplar), 2),
            # Too far away to be a candidate.
            "other": QPen(QColor(theme.muted), 1, Qt.PenStyle.DotLine),
        }
        for index, patch in enumerate(self._patches):
            area = self.patch_rect(index)
            pixels = np.ascontiguousarray(patch.picture)
            height, width = pixels.shape[:2]
            painter.drawImage(area, QImage(pixels.data, width, height, 3 * width, QImage.Format.Format_RGB888))
            # The pixel in the middle is what the comparison is for.
            cell = area.width() / width
            painter.setPen(QPen(QColor(theme.text), 1))
            centre = QRectF(area.left() + width // 2 * cell, area.top() + height // 2 * cell, cell, cell)
            painter.drawRect(centre.adjusted(-1, -1, 1, 1))
            painter.setPen(pens[patch.frame])
            painter.drawRect(area.adjusted(-2, -2, 2, 2))
            if index == self._selected:
                painter.setPen(QPen(QColor(theme.accent), 2, Qt.PenStyle.DashLine))
                painter.drawRect(area.adjusted(-5, -5, 5, 5))
            painter.setPen(QColor(theme.text if patch.frame in ("window", "chosen") else theme.muted))
            below = QRectF(area.left() - GAP / 2, area.bottom() + 3, area.width() + GAP, self._words() - 3)
            words = metrics.elidedText(patch.caption, Qt.TextElideMode.ElideRight, round(below.width()))
            painter.drawText(below, Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignTop, words)
        painter.end()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Tell which patch is under the cursor."""
        self.hovered.emit(self._at(event))

    def leaveEvent(self, event: QEvent) -> None:
        """Tell that the cursor has left."""
        self.hovered.emit(-1)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose the patch under the cursor."""
        if (index := self._at(event)) >= 0:
            self._choose(index)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Move with the arrow keys."""
        across, last, here = self._arrangement()[0], len(self._patches) - 1, max(self._selected, 0)
        wanted = {
            Qt.Key.Key_Left: here - 1,
            Qt.Key.Key_Right: here + 1,
            # The large patch stands beside all rows.
            Qt.Key.Key_Up: here - across if here > across else here,
            Qt.Key.Key_Down: here + across if 0 < here <= last - across else here,
            Qt.Key.Key_Home: 0,
            Qt.Key.Key_End: last,
        }.get(Qt.Key(event.key()))
        if wanted is None or last < 0:
            super().keyPressEvent(event)
        else:
            self._choose(min(max(wanted, 0), last))

    def _choose(self, index: int) -> None:
        self.select(index)
        self.chosen.emit(index)

    def _at(self, event: QMouseEvent) -> int:
        point = event.position()
        areas = (self.patch_rect(index) for index in range(len(self._patches)))
        return next((index for index, area in enumerate(areas) if area.contains(point)), -1)

    def _words(self) -> float:
        return self.fontMetrics().height() + 4.0

    def _arrangement(self) -> tuple[int, float]:
        """Return how many of the small patches stand side by side, and the side at which all of them fit."""
        count = max(1, len(self._patches) - 1)

        def side(across: int) -> float:
            rows = -(-count // across)
            below = GAP + self._words()
            wide = (self.width() - (across + 4) * GAP - (rows - 1) * below) / (rows + across)
            high = (self.height() - GAP) / rows - below
            return max(6.0, min(wide, high))

        across = max(range(1, count + 1), key=lambda number: (round(side(number), 3), -number))
        return across, side(across)
