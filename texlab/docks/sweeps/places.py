"""Where the cells of a contact sheet stand: rows and columns, headings and captions."""

from __future__ import annotations

import bisect
from typing import TYPE_CHECKING

from PySide6.QtCore import QPoint, QRect, QSize
from PySide6.QtWidgets import QScrollArea, QWidget

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from PySide6.QtGui import QFontMetrics, QPixmap

    from texlab.state.sweeps import ShownCell

SMALLEST, USUAL, LARGEST = 48, 112, 384
GAP = 10
NARROWEST = 76


class CellPlaces(QWidget):
    """Places the cells in a scroll area; what is painted of them is another's business."""

    def __init__(self, area: QScrollArea) -> None:
        super().__init__()
        self._area = area
        self.settings: list[str] = []
        # Indices of the cells in the order in which they stand; another order, or a part, has no rows and columns.
        self.order: list[int] = []
        self.is_grid = True
        self.headings: tuple[Sequence[str], Sequence[str]] | None = None
        self.kept: frozenset[int] = frozenset()
        self.fixed_columns: int | None = None
        self.shape = (1, 1)
        self.cells: dict[int, ShownCell] = {}
        self.pixmaps: dict[int, QPixmap] = {}
        self.marked: int | None = None
        self.current = 0
        self._side = USUAL
        self._columns = 1
        self._left = GAP
        self._places: dict[int, int] = {}
        self._tops = [GAP]
        self._lines: list[int] = []

    @property
    def columns(self) -> int:
        """Cells in a row."""
        return self._columns

    @property
    def picture_size(self) -> QSize:
        """Size at which the pictures are painted."""
        height, width = self.shape
        scale = self._side / max(height, width)
        return QSize(max(1, round(width * scale)), max(1, round(height * scale)))

    @property
    def _cell_width(self) -> int:
        return max(self.picture_size.width(), NARROWEST)

    def rect_of(self, index: int) -> QRect:
        """Return the rectangle of a cell; an empty one for a cell that is not shown."""
        if index not in self._places:
            return QRect()
        row, column = divmod(self._places[index], self._columns)
        x = self._left + column * (self._cell_width + GAP)
        return QRect(x, self._tops[row], self._cell_width, self._tops[row + 1] - GAP - self._tops[row])

    def index_at(self, place: QPoint) -> int | None:
        """Return the cell at a place."""
        half = GAP // 2
        column = (place.x() - self._left + half) // (self._cell_width + GAP)
        row = bisect.bisect_right(self._tops, place.y() + half) - 1
        at = row * self._columns + column
        inside = 0 <= column < self._columns and row >= 0
        return self.order[at] if inside and at < len(self.order) else None

    def relayout(self) -> None:
        """Place the cells anew; a row is as high as its longest caption."""
        viewport = self._area.viewport().size()
        width = self._cell_width
        fitting = max(1, (viewport.width() - GAP) // (width + GAP))
        fixed = self.fixed_columns if self.is_grid else None
        self._columns = fixed or min(fitting, max(len(self.order), 1))
        self._places = {index: place for place, index in enumerate(self.order)}
        line, picture = self.fontMetrics().lineSpacing(), self.picture_size.height()
        self._left = self.room_beside(self._heads[1])
        self._tops, self._lines = [GAP + (line + GAP // 2 if self._heads[0] else 0)], []
        for first in range(0, len(self.order), self._columns):
            self._lines.append(self._caption_lines(first))
            self._tops.append(self._tops[-1] + picture + 4 + self._lines[-1] * line + GAP)
        wanted = QSize(self._left + self._columns * (width + GAP), self._tops[-1]) if self.order else QSize(0, 0)
        # As large as the view where that is larger, but never so large that a scroll bar comes for nothing.
        self.resize(wanted.expandedTo(viewport))
        self.update()

    def room_beside(self, down: Sequence[str]) -> int:
        """Return where the first column begins, beside the headings of the rows."""
        widest = max(map(self.fontMetrics().horizontalAdvance, down), default=0)
        return GAP + (min(widest, NARROWEST) + GAP if down else 0)

    def _caption_lines(self, first: int) -> int:
        """Return how many lines the captions of the row that starts with this cell need."""
        metrics, width = self.fontMetrics(), self._cell_width
        row = self.order[first : first + self._columns]
        count = max(len(packed(self._caption(index), width, metrics)) for index in row)
        found = [len(packed(self.cells[each].cell.evidence, width, metrics)) for each in row if each in self.cells]
        return count + max(found, default=self._evidence_lines)

    @property
    def _heads(self) -> tuple[Sequence[str], Sequence[str]]:
        """Headings of the columns and of the rows, as long as the cells stand in them."""
        return self.headings if self.headings is not None and self.is_grid else ((), ())

    def _caption(self, index: int) -> str:
        """Return what is varied in a cell, where no heading says it."""
        return "" if self._heads[0] else self.settings[index]

    def show_order(self, order: Sequence[int] | None) -> None:
        """Show these cells in this order; None shows all in their places."""
        wanted = list(range(len(self.settings)) if order is None else order)
        if (wanted, order is None) == (self.order, self.is_grid):
            return
        self.order, self.is_grid = wanted, order is None
        if self.current not in wanted:
            self.current = wanted[0] if wanted else 0
        self.relayout()

    @property
    def _evidence_lines(self) -> int:
        """Lines of evidence below a cell that has not finished: as many as below the others."""
        metrics = self.fontMetrics()
        some = list(self.cells.values())[:20]
        return max((len(packed(each.cell.evidence, self._cell_width, metrics)) for each in some), default=0)

    def set_side(self, side: int) -> None:
        """Show the cells at another size, keeping the one in the middle in sight."""
        if side == self._side:
            return
        self._side = side
        self.pixmaps.clear()
        self.relayout()
        self._reveal(self.current)

    def show_cells(self, cells: Mapping[int, ShownCell]) -> None:
        """Show the cells that have finished."""
        fresh = [index for index, cell in cells.items() if self.cells.get(index) is not cell]
        self.cells = dict(cells)
        if not fresh:
            return
        for index in fresh:
            self.pixmaps.pop(index, None)
        rows = range(0, len(self.order), self._columns)
        if [self._caption_lines(first) for first in rows] != self._lines:
            self.relayout()
        for index in fresh:
            self.update(self.rect_of(index).adjusted(-4, -4, 4, 4))

    def _reveal(self, index: int) -> None:
        if index in self._places:
            area = self.rect_of(index)
            middle = area.center()
            self._area.ensureVisible(middle.x(), middle.y(), area.width() // 2 + GAP, area.height() // 2 + GAP)


def packed(text: str, width: int, metrics: QFontMetrics) -> list[str]:
    """Break a text at its commas into lines that fit ``width`` pixels; what is still too wide, at its spaces."""
    lines: list[str] = []
    for part in text.split(", ") if text else []:
        joined = f"{lines[-1]}, {part}" if lines else part
        if lines and metrics.horizontalAdvance(joined) <= width:
            lines[-1] = joined
            continue
        words = part.split()
        lines.append(words[0])
        for word in words[1:]:
            if metrics.horizontalAdvance(f"{lines[-1]} {word}") <= width:
                lines[-1] += f" {word}"
            else:
                lines.append(word)
    return lines
