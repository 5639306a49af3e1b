"""Small pictures side by side with captions, frames and a choice; for mouse and keyboard."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen

from texlab.docks.explain.painted_choice import PaintedChoice

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PySide6.QtGui import QPaintEvent
    from PySide6.QtWidgets import QWidget

    from texlab.style.pictures import Picture

Frame = Literal["window", "chosen", "match", "other"]
GAP = 8


@dataclass(frozen=True, slots=True, eq=False)
class Patch:
    """One small picture, (h, w, 3) uint8, with what is written below it, its frame, and its name in words."""

    picture: Picture
    caption: str
    frame: Frame
    title: str


class PatchGrid(PaintedChoice):
    """Shows a large patch and others in rows beside it, as large as they fit.

    ``chosen(index)`` and ``hovered(index)`` tell a patch, -1 for none.
    """

    def __init__(self, name: str, label: str, parent: QWidget | None = None) -> None:
        super().__init__(name, label, parent)
        self._patches: tuple[Patch, ...] = ()

    @property
    def patches(self) -> tuple[Patch, ...]:
        """What is shown."""
        return self._patches

    def show_patches(self, patches: Sequence[Patch]) -> None:
        """Show patches; the first one stands for itself, the others are compared with it."""
        self._patches = tuple(patches)
        self.select(self._selected)

    def descriptions(self) -> list[str]:
        """Return every patch in words."""
        return [patch.title for patch in self._patches]

    def sizeHint(self) -> QSize:
        """Ask for two rows of patches."""
        return QSize(480, 190)

    def part_rect(self, index: int) -> QRectF:
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
            area = self.part_rect(index)
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

    def reached(self, key: Qt.Key) -> int | None:
        """Go to a neighbour, the first patch or the last."""
        across, last, here = self._arrangement()[0], len(self._patches) - 1, max(self._selected, 0)
        return {
            Qt.Key.Key_Left: here - 1,
            Qt.Key.Key_Right: here + 1,
            # The large patch stands beside all rows.
            Qt.Key.Key_Up: here - across if here > across else here,
            Qt.Key.Key_Down: here + across if 0 < here <= last - across else here,
            Qt.Key.Key_Home: 0,
            Qt.Key.Key_End: last,
        }.get(key)

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
