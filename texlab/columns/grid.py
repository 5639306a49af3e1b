"""Cells of equal size in as many rows as the arrangement says."""

from __future__ import annotations

from functools import reduce
from typing import TYPE_CHECKING, get_args

from PySide6.QtWidgets import QWidget

from texlab.columns.arrangement import Arrangement, Frame, Rows, Words, arrange

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PySide6.QtCore import QPoint

    from texlab.columns.column import ColumnView
    from texlab.columns.exemplar import ExemplarView

WORDS: tuple[Words, ...] = get_args(Words)


class Grid(QWidget):
    """Places its cells; the ones that are not shown are hidden."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("grid")
        self.setAccessibleName("Exemplar and columns")
        self.arrangement: Arrangement | None = None
        self._cells: tuple[ExemplarView | ColumnView, ...] = ()
        self.rows: Rows = "largest"
        self.aspect = 1.0

    @property
    def cells(self) -> tuple[ExemplarView | ColumnView, ...]:
        """What is shown, row by row."""
        return self._cells

    def show_cells(self, cells: Sequence[ExemplarView | ColumnView]) -> None:
        """Show these cells in this order, and hide what else there is."""
        for gone in self._cells:
            if gone not in cells and gone.parentWidget() is self:
                gone.hide()
        self._cells = tuple(cells)
        for cell in cells:
            if cell.parentWidget() is not self:
                cell.setParent(self)
            cell.show()

    def place(self, room: tuple[int, int], bar: int = 0) -> None:
        """Give every cell its place in a room of this width and height.

        Where the cells are higher than the room, but not wider, a bar of this width takes a part of it.
        """
        if not self._cells:
            return
        frames = self._frames()
        made = arrange(len(self._cells), room, frames, self.aspect, self.rows)
        if made.total[1] > room[1] >= 0 and made.total[0] <= room[0]:
            made = arrange(len(self._cells), (room[0] - bar, room[1]), frames, self.aspect, self.rows)
        self.arrangement = made
        # It is said once: bars that come and go between two sizes would never come to rest.
        self.setMinimumSize(*made.total)
        for place, cell in enumerate(self._cells):
            cell.set_words(made.words)
            cell.setGeometry(*made.cell(place))

    def least_height(self, width: int) -> int:
        """Return the height below which the cells scroll in a room of this width, whatever room there is now."""
        if not self._cells:
            return 0
        return arrange(len(self._cells), (width, 1), self._frames(), self.aspect, self.rows).total[1]

    def _frames(self) -> dict[Words, Frame]:
        return {words: reduce(Frame.joined, (cell.frame_of(words) for cell in self._cells)) for words in WORDS}

    def place_at(self, point: QPoint) -> int:
        """Return the place of the cell nearest to a point of the grid."""
        if self.arrangement is None:
            return 0
        return self.arrangement.place_at(point.x(), point.y(), len(self._cells))
