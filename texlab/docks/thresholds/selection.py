"""A rectangle of selected cells."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Selection:
    """Where it began and where it ends; the end is the chosen cell."""

    row: int
    column: int
    to_row: int
    to_column: int

    @classmethod
    def cell(cls, row: int, column: int) -> Selection:
        """Return the selection of one cell."""
        return cls(row, column, row, column)

    def extended(self, row: int, column: int) -> Selection:
        """Return the rectangle from where it began to a cell."""
        return Selection(self.row, self.column, row, column)

    def within(self, rows: int, columns: int) -> Selection:
        """Return what is left of it in a table of this size."""
        last_row, last_column = rows - 1, columns - 1
        return Selection(
            min(self.row, last_row),
            min(self.column, last_column),
            min(self.to_row, last_row),
            min(self.to_column, last_column),
        )

    def places(self) -> list[tuple[int, int]]:
        """Return rows and columns of its cells."""
        rows = range(min(self.row, self.to_row), max(self.row, self.to_row) + 1)
        columns = range(min(self.column, self.to_column), max(self.column, self.to_column) + 1)
        return [(row, column) for row in rows for column in columns]
