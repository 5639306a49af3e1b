"""The peaks of two spectra as a table: where each repeats, and where it went."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QAbstractItemView, QSizePolicy, QTableWidget, QTableWidgetItem

from texlab.widgets.plain import set_tip
from texlab.widgets.tables import make_quiet
from texlab_core.transforms.gabor_bank import channel_name

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget

    from texlab.docks.spectral.spectra import SpectraAnswer
    from texlab.style.theme import Theme
    from texlab_core.stats.peaks import Peak, Shift

COLUMNS = (
    ("peak", "Peak of the exemplar, and the nearest one of the result below it"),
    ("c/px", "Frequency in cycles per pixel"),
    ("period", "Pixels from one stripe to the next"),
    ("orientation", "Direction of the wave: 0° are vertical stripes, 90° horizontal ones"),
    ("share", "Share of the image's variance"),
    ("moves", "Exemplar: shift to the nearest centre of MSG. Result: shift that is found."),
)


@dataclass(frozen=True)
class PeakRow:
    """One line of the table.

    Parameters
    ----------
    side
        Whose peak it is.
    peak
        Where it is.
    number
        Number of the exemplar's peak that it belongs to, from 0; -1 for none.
    moves
        Shift in words.
    """

    side: Literal["exemplar", "result"]
    peak: Peak
    number: int
    moves: str

    def texts(self) -> tuple[str, ...]:
        """Return the cells."""
        arrow = "" if self.side == "exemplar" else "→ "
        name = f"{arrow}{self.number + 1}" if self.number >= 0 else "new"
        peak = self.peak
        return (
            name,
            f"{peak.frequency:.4f}",
            f"{peak.period:.1f} px",
            f"{peak.orientation:.1f}°",
            f"{peak.share:.1%}",
            self.moves,
        )


def shift_text(shift: Shift) -> str:
    """Return a shift in words."""
    # Rounded first: no minus before zero.
    return f"{round(shift.octaves, 2) + 0.0:+.2f} oct, {round(shift.degrees, 1) + 0.0:+.1f}°"


def peak_rows(answer: SpectraAnswer) -> tuple[PeakRow, ...]:
    """Return the exemplar's peaks, each followed by what became of it, then the result's others."""
    rows: list[PeakRow] = []
    met: set[Peak] = set()
    matches = answer.matches or (None,) * len(answer.exemplar.peaks)
    for number, (peak, snap, match) in enumerate(zip(answer.exemplar.peaks, answer.snaps, matches, strict=True)):
        moves = "below all centres" if snap is None else f"{channel_name(snap.channel)}: {shift_text(snap.shift)}"
        rows.append(PeakRow("exemplar", peak, number, moves))
        if match is not None:
            met.add(match[0])
            rows.append(PeakRow("result", match[0], number, shift_text(match[1])))
    if answer.result is not None:
        rows += [PeakRow("result", peak, -1, "") for peak in answer.result.peaks if peak not in met]
    return tuple(rows)


class PeaksTable(QTableWidget):
    """Lists peaks; ``currentCellChanged`` tells which line is chosen."""

    def __init__(self, name: str, parent: QWidget | None = None) -> None:
        super().__init__(0, len(COLUMNS), parent)
        self.setObjectName(name)
        self.setAccessibleName("Peaks of the spectra")
        set_tip(self, "Repetitions of exemplar and result; choose one to see it in the pictures")
        for column, (title, meaning) in enumerate(COLUMNS):
            heading = QTableWidgetItem(title)
            set_tip(heading, meaning)
            self.setHorizontalHeaderItem(column, heading)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        make_quiet(self)
        self.horizontalHeader().setMinimumSectionSize(30)
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(self.fontMetrics().height() + 5)
        self.setSizePolicy(QSizePolicy.Policy.Maximum, QSizePolicy.Policy.Expanding)
        self.rows: tuple[PeakRow, ...] = ()
        self._theme: Theme | None = None

    def show_rows(self, rows: tuple[PeakRow, ...]) -> None:
        """List peaks; the chosen line stays where it is."""
        if rows == self.rows:
            return
        chosen = self.currentRow()
        self.rows = rows
        blocked = self.blockSignals(True)
        self.setRowCount(len(rows))
        for line, row in enumerate(rows):
            for column, text in enumerate(row.texts()):
                item = QTableWidgetItem(text)
                side = Qt.AlignmentFlag.AlignLeft if column in (0, 5) else Qt.AlignmentFlag.AlignRight
                item.setTextAlignment(side | Qt.AlignmentFlag.AlignVCenter)
                self.setItem(line, column, item)
        if not 0 <= chosen < len(rows):
            self.setCurrentCell(-1, -1)
        self.blockSignals(blocked)
        self._paint_rows()
        self.resizeColumnsToContents()
        self.updateGeometry()

    @property
    def chosen(self) -> PeakRow | None:
        """The chosen line."""
        line = self.currentRow()
        return self.rows[line] if 0 <= line < len(self.rows) else None

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self._paint_rows()

    def sizeHint(self) -> QSize:
        """Ask for the room that all columns need."""
        width = self.horizontalHeader().length() + self.verticalScrollBar().sizeHint().width() + 4
        return QSize(max(width, 200), 120)

    def minimumSizeHint(self) -> QSize:
        """Accept little room: the table scrolls."""
        return QSize(150, 50)

    def _paint_rows(self) -> None:
        if self._theme is None:
            return
        for line, row in enumerate(self.rows):
            item = self.item(line, 0)
            if item is not None:
                item.setForeground(QColor(getattr(self._theme, row.side)))
