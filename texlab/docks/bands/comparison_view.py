"""Two histograms over each other with their numbers beside them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QSizePolicy, QTableWidget, QTableWidgetItem

from texlab.style.numbers import number
from texlab.style.text_size import is_teaching, tight_line
from texlab.widgets.plain import set_tip
from texlab.widgets.plots import Plot
from texlab.widgets.tables import ROW_MARGIN, make_quiet

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray
    from PySide6.QtGui import QResizeEvent
    from PySide6.QtWidgets import QWidget

    from texlab.docks.bands.comparison import Comparison
    from texlab.style.theme import Theme
    from texlab.widgets.plots import Line, Role
    from texlab_core.stats.moments import Moments

ROWS = ("mean", "sd", "skewness", "kurtosis", "W1", "W1 / sd")
MEANINGS = (
    "Mean",
    "Standard deviation",
    "Skewness: 0 when symmetric",
    "Kurtosis: 3 for a normal distribution, more for sparse values",
    "Wasserstein-1 distance of the result from the exemplar, in the values' unit",
    "Wasserstein-1 distance in standard deviations of the exemplar",
)


class HistogramPlot(Plot):
    """Exemplar (solid, filled) and result (dashed) over the same bins."""

    def show_comparison(
        self, shown: Comparison, *, log: bool = False, cumulated: bool = False, named: bool = True
    ) -> None:
        """Draw the two distributions; ``named`` writes at the axes what they are."""
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
        self.set_log(log)
        self.set_labels(shown.title, ("share below" if cumulated else "share per bin") if named else "")
        span = (float(shown.edges[0]), float(shown.edges[-1]))
        self.fit(x=span, y=(floor, top + 0.06 * max(top - floor, 1e-6)))

    @staticmethod
    def describe(shown: Comparison, x: float, *, cumulated: bool = False) -> str:
        """Return the shares of the bin at ``x`` in words, or those of all values below ``x``."""
        bins = shown.exemplar.size
        place = int((x - shown.edges[0]) / (shown.edges[-1] - shown.edges[0]) * bins)
        if not 0 <= place < bins:
            return ""
        widths = np.diff(shown.edges)

        def share(density: NDArray[np.float64]) -> float:
            if not cumulated:
                return float(density[place] * widths[place])
            # As drawn: straight between the edges.
            below = np.concatenate([[0.0], np.cumsum(density * widths)])
            return float(np.interp(x, shown.edges, below))

        words = f"{'below ' if cumulated else ''}{number(x)}: exemplar {share(shown.exemplar):.3%}"
        return words if shown.result is None else f"{words}, result {share(shown.result):.3%}"


class NumbersTable(QTableWidget):
    """Moments of exemplar and result and the distance between them: a column for each, low and narrow."""

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(len(ROWS), 0, parent)
        self.setObjectName(name)
        self.setAccessibleName("Numbers of the distributions")
        set_tip(self, "Moments of exemplar and result, and the distance between them")
        for row, meaning in enumerate(MEANINGS):
            heading = QTableWidgetItem(ROWS[row])
            set_tip(heading, meaning)
            self.setVerticalHeaderItem(row, heading)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ContiguousSelection)
        make_quiet(self)
        self.horizontalHeader().setMinimumSectionSize(56)
        self.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        self.verticalHeader().setMinimumSectionSize(10)
        self.verticalHeader().setDefaultSectionSize(self.fontMetrics().lineSpacing() + ROW_MARGIN)
        self.verticalHeader().setHighlightSections(False)
        self.setSizePolicy(QSizePolicy.Policy.Maximum, QSizePolicy.Policy.Preferred)
        self._theme: Theme | None = None

    def show_comparisons(self, shown: Sequence[Comparison]) -> None:
        """Fill in a column for every distribution; with several comparisons, each is named."""
        columns: list[tuple[str, list[str], bool]] = []
        for each in shown:
            name = f"{each.title}\n" if len(shown) > 1 else ""
            columns.append((f"{name}exemplar", _moment_texts(each.exemplar_moments), False))
            if each.result_moments is not None and each.distance is not None:
                relative = each.relative_distance
                distances = [number(each.distance), "" if relative is None else number(relative)]
                columns.append((f"{name}result", _moment_texts(each.result_moments) + distances, True))
        self.setColumnCount(len(columns))
        for column, (name, texts, is_result) in enumerate(columns):
            heading = QTableWidgetItem(name)
            heading.setData(Qt.ItemDataRole.UserRole, is_result)
            self.setHorizontalHeaderItem(column, heading)
            for row in range(len(ROWS)):
                item = QTableWidgetItem(texts[row] if row < len(texts) else "")
                item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                self.setItem(row, column, item)
        self._paint_headings()
        self.resizeColumnsToContents()
        self.updateGeometry()

    def cell(self, row: str, column: int) -> str:
        """Return the text of a cell by the name of its row."""
        item = self.item(ROWS.index(row), column)
        return item.text() if item is not None else ""

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self._paint_headings()

    def sizeHint(self) -> QSize:
        """Ask for the room that all rows and columns need."""
        across, down = self.horizontalHeader(), self.verticalHeader()
        # Room for the scroll bar that a low dock needs.
        width = down.sizeHint().width() + across.length() + self.verticalScrollBar().sizeHint().width()
        return QSize(width, self._height(self.fontMetrics().lineSpacing() + ROW_MARGIN))

    def _height(self, row: int) -> int:
        return self.horizontalHeader().sizeHint().height() + len(ROWS) * row + 4

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Leave the gaps between rows out, when one teaches, before a row has to be scrolled."""
        super().resizeEvent(event)
        metrics = self.fontMetrics()
        usual, tight = metrics.lineSpacing() + ROW_MARGIN, tight_line(metrics)
        row = (self.height() - self._height(0)) // len(ROWS)
        self.verticalHeader().setDefaultSectionSize(min(max(row, tight), usual) if is_teaching() else usual)

    def minimumSizeHint(self) -> QSize:
        """Accept little room: the table scrolls; when one teaches, have room for all rows without gaps."""
        if is_teaching():
            return QSize(min(self.sizeHint().width(), 210), self._height(tight_line(self.fontMetrics())))
        return QSize(min(self.sizeHint().width(), 210), 50)

    def _paint_headings(self) -> None:
        for column in range(self.columnCount()):
            heading = self.horizontalHeaderItem(column)
            if heading is not None and self._theme is not None:
                is_result = bool(heading.data(Qt.ItemDataRole.UserRole))
                heading.setForeground(QColor(self._theme.result if is_result else self._theme.exemplar))


def _moment_texts(found: Moments) -> list[str]:
    return [number(value) for value in (found.mean, found.sd, found.skewness, found.kurtosis)]
