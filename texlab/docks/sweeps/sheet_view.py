"""A contact sheet that fills while it is looked at: pictures in a grid with captions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QRect, Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QFrame, QScrollArea, QWidget

from texlab.docks.sweeps.canvas import SheetCanvas
from texlab.docks.sweeps.places import GAP, LARGEST, NARROWEST, USUAL

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from PySide6.QtGui import QResizeEvent

    from texlab.state.sweeps import ShownCell
    from texlab.style.theme import Theme


class ContactSheetView(QScrollArea):
    """Shows the cells of a sweep in their places.

    ``taken(index)``: a finished cell was clicked, or chosen with Return. ``opened(index)``: it is wanted as a
    column (N, the middle button, the menu), ``opened_here(index)``: as one whose texture all columns take.
    ``kept(index)``: it is to be kept, or let go (K, the menu).
    ``compared()``: the cells that are kept are to be seen side by side (C).
    ``zoom_wanted(steps)``: the wheel was turned with Ctrl held, or + or - was pressed.
    """

    taken = Signal(int)
    opened = Signal(int)
    opened_here = Signal(int)
    kept = Signal(int)
    compared = Signal()
    zoom_wanted = Signal(int)

    def __init__(self, name: str, empty: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName("Sheet of the sweep")
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.canvas = SheetCanvas(self, empty)
        for told, tells in (
            (self.canvas.taken, self.taken),
            (self.canvas.opened, self.opened),
            (self.canvas.opened_here, self.opened_here),
            (self.canvas.kept_turned, self.kept),
            (self.canvas.compared, self.compared),
            (self.canvas.zoom_wanted, self.zoom_wanted),
        ):
            told.connect(tells)
        self.canvas.setObjectName(f"{name}-canvas")
        self.setWidget(self.canvas)

    def show_grid(
        self,
        settings: Sequence[str],
        columns: int | None,
        shape: tuple[int, int],
        headings: tuple[Sequence[str], Sequence[str]] | None = None,
    ) -> None:
        """Start an empty sheet.

        Parameters
        ----------
        settings
            What was varied, one text for each cell, row by row.
        columns
            Cells in a row; None lets a series flow with the width of the window.
        shape
            Height and width of the pictures to come.
        headings
            Of the columns and of the rows of a grid: then no cell needs its setting as a caption.
        """
        self.canvas.settings = list(settings)
        self.canvas.order = list(range(len(settings)))
        self.canvas.fixed_columns = columns
        self.canvas.headings = headings
        self.canvas.kept = frozenset()
        self.canvas.shape = shape
        self.canvas.cells = {}
        self.canvas.pixmaps.clear()
        self.canvas.marked = None
        self.canvas.current = 0
        self.canvas.relayout()
        self.verticalScrollBar().setValue(0)
        self.horizontalScrollBar().setValue(0)

    def show_cells(self, cells: Mapping[int, ShownCell]) -> None:
        """Show the cells that have finished."""
        self.canvas.show_cells(cells)

    def show_order(self, order: Sequence[int] | None) -> None:
        """Show these cells in this order, as a series; None shows all in their places."""
        self.canvas.show_order(order)

    def show_kept(self, kept: Collection[int]) -> None:
        """Mark the cells that are kept with a star."""
        self.canvas.kept = frozenset(kept)
        self.canvas.update()

    def fitting_side(self, count: int, columns: int | None, largest: int, down: Sequence[str] = ()) -> int:
        """Return a size for square cells: all are in sight if that is possible, else the columns of a grid.

        Parameters
        ----------
        count, columns
            Number of cells, and of cells in a row; None for a series.
        largest
            Size beyond which the pictures would be enlarged.
        down
            Headings of the rows, which need room beside them.
        """
        width = self.width() - self.verticalScrollBar().sizeHint().width()
        width -= self.canvas.room_beside(down) - GAP
        caption = 4 + 3 * self.canvas.fontMetrics().lineSpacing()
        for side in range(min(largest, LARGEST), USUAL, -4):
            across = columns or max(1, (width - GAP) // (side + GAP))
            rows = -(-count // across)
            is_wide = GAP + across * (side + GAP) > width
            if not is_wide and GAP + rows * (side + caption + GAP) <= self.height():
                return side
        return USUAL if columns is None else min(max((width - GAP) // columns - GAP, NARROWEST), USUAL)

    def set_side(self, side: int) -> None:
        """Show the cells at another size: the longest side of a picture in pixels."""
        self.canvas.set_side(side)

    def show_words(self, taken: str) -> None:
        """Say what a click takes: "parameters"."""
        self.canvas.taken_words = taken

    def mark(self, index: int | None) -> None:
        """Mark the cell that has the parameters of the column."""
        if index != self.canvas.marked:
            self.canvas.marked = index
            self.canvas.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self.canvas.theme = theme
        palette = self.viewport().palette()
        palette.setColor(palette.ColorRole.Window, QColor(theme.canvas))
        self.viewport().setPalette(palette)
        self.canvas.update()

    def cell_rect(self, index: int) -> QRect:
        """Return where a cell (picture and caption) stands on the canvas."""
        return self.canvas.rect_of(index)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Let a series flow anew."""
        super().resizeEvent(event)
        self.canvas.relayout()
