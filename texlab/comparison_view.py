"""Two histograms over each other with their numbers beside them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QSizePolicy, QTableWidget, QTableWidgetItem

from texlab.plots import Plot, number

if TYPE_CHECKING:
    from collections.abc import Sequence

    from PySide6.QtWidgets import QWidget

    from texlab.comparison import Comparison
    from texlab.plots import Line, Role
    from texlab.theme import Theme

COLUMNS = ("mean", "sd", "skew", "kurt", "W1", "W1 / sd")
MEANINGS = (
    "Mean",
    "Standard deviation",
    "Skewness: 0 when symmetric",
    "Kurtosis: 3 for a normal distribution, more for sparse values",
    "Wasserstein-1 distance from the exemplar, in the values' unit",
    "Wasserstein-1 distance in standard deviations of the exemplar",
)


class HistogramPlot(Plot):
    """Exemplar (solid, filled) and result (dashed) over the same bins."""

    def show_comparison(self, shown: Comparison, *, log: bool = False, cumulated: bool = False) -> None:
        """Draw the two distributions."""
        self.clear()
        widths = np.diff(shown.edges)
        # Shares per bin: their height does not depend on the unit of the axis.
        series = [shares * widths for shares in (shown.exemplar, shown.result) if shares is not None]
        if cumulated:
            series = [np.concatenate([[0.0], np.cumsum(shares)]) for shares in series]
        top, floor = max(float(values.max()) for values in series), 0.0
        if log:
            # Below the smallest share that occurs there is nothing to show.
            floor = float(np.log10(min(values[values > 0].min(initial=1.0) for values in series))) - 0.15
            series = [np.log10(np.maximum(values, 10.0**floor)) for values in series]
            top = float(np.log10(top)) if top > 0 else 0.0
        styles: tuple[tuple[Role, Line], ...] = (("exemplar", "solid"), ("result", "dash"))
        for values, (role, line) in zip(series, styles, strict=False):
            filled = role == "exemplar" and not cumulated
            self.curve(shown.edges, values, role, line=line, steps=not cumulated, filled=filled, floor=floor)
        self.set_log(y=log)
        self.set_labels(shown.title, "share below" if cumulated else "share per bin")
        span = (float(shown.edges[0]), float(shown.edges[-1]))
        self.fit(x=span, y=(floor, max(top, floor + 0.1) + 0.05 * abs(top - floor)))

    @staticmethod
    def describe(shown: Comparison, x: float) -> str:
        """Return the shares of the bin at ``x`` in words."""
        bins = shown.exemplar.size
        place = int((x - shown.edges[0]) / (shown.edges[-1] - shown.edges[0]) * bins)
        if not 0 <= place < bins:
            return ""
        width = shown.edges[1] - shown.edges[0]
        words = f"{number(x)}: exemplar {shown.exemplar[place] * width:.3%}"
        return words if shown.result is None else f"{words}, result {shown.result[place] * width:.3%}"


class NumbersTable(QTableWidget):
    """Moments of exemplar and result and the distance between them."""

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(0, len(COLUMNS), parent)
        self.setObjectName(name)
        self.setAccessibleName("Numbers of the distributions")
        self.setToolTip("Moments of exemplar and result, and the distance between them")
        for column, meaning in enumerate(MEANINGS):
            heading = QTableWidgetItem(COLUMNS[column])
            heading.setToolTip(meaning)
            self.setHorizontalHeaderItem(column, heading)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ContiguousSelection)
        self.setShowGrid(False)
        self.setWordWrap(False)
        self.setTabKeyNavigation(False)
        self.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        self.horizontalHeader().setHighlightSections(False)
        self.horizontalHeader().setMinimumSectionSize(30)
        self.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        self.verticalHeader().setDefaultSectionSize(self.fontMetrics().height() + 6)
        self.verticalHeader().setHighlightSections(False)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Preferred)
        self._theme: Theme | None = None

    def show_comparisons(self, shown: Sequence[Comparison]) -> None:
        """Fill in two rows for each comparison; with several, each is named."""
        rows: list[tuple[str, list[str], bool]] = []
        for each in shown:
            name = f"{each.title}, " if len(shown) > 1 else ""
            first, second = each.exemplar_moments, each.result_moments
            numbers = (first.mean, first.sd, first.skewness, first.kurtosis)
            rows.append((f"{name}exemplar", [number(value) for value in numbers] + ["", ""], False))
            if second is not None and each.distance is not None:
                numbers = (second.mean, second.sd, second.skewness, second.kurtosis)
                relative = each.relative_distance
                distances = [number(each.distance), "" if relative is None else number(relative)]
                rows.append((f"{name}result", [number(value) for value in numbers] + distances, True))
        self.setRowCount(len(rows))
        self.setVerticalHeaderLabels([name for name, _, _ in rows])
        for row, (_, texts, is_result) in enumerate(rows):
            for column, text in enumerate(texts):
                item = QTableWidgetItem(text)
                item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                item.setData(Qt.ItemDataRole.UserRole, is_result)
                self.setItem(row, column, item)
        self._paint_rows()
        self.updateGeometry()

    def cell(self, row: int, column: str) -> str:
        """Return the text of a cell by the name of its column."""
        item = self.item(row, COLUMNS.index(column))
        return item.text() if item is not None else ""

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self._paint_rows()

    def sizeHint(self) -> QSize:
        """Ask for the room that all rows and columns need."""
        header = self.horizontalHeader()
        width = self.verticalHeader().sizeHint().width() + sum(
            header.sectionSizeHint(column) for column in range(self.columnCount())
        )
        width = max(width, self.verticalHeader().sizeHint().width() + header.length())
        height = header.sizeHint().height() + self.verticalHeader().length()
        return QSize(width + 6, height + 6)

    def minimumSizeHint(self) -> QSize:
        """Accept little room: the table scrolls."""
        return QSize(120, 50)

    def _paint_rows(self) -> None:
        if self._theme is None:
            return
        for row in range(self.rowCount()):
            item = self.item(row, 0)
            is_result = item is not None and bool(item.data(Qt.ItemDataRole.UserRole))
            colour = QColor(self._theme.result if is_result else self._theme.exemplar)
            self.verticalHeaderItem(row).setForeground(colour)
