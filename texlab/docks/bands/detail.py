"""One subband large: exemplar and result, their distribution and its numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from texlab.docks.bands.comparison_view import HistogramPlot, NumbersTable
from texlab.docks.bands.pictures import BandLarge, band_table
from texlab.style.numbers import number
from texlab.style.text_size import is_teaching, text_scale
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.plots import ColourBar
from texlab.widgets.view_link import ViewLink

if TYPE_CHECKING:
    from PySide6.QtGui import QResizeEvent

    from texlab.style.theme import Theme

ROOM_FOR_TABLE = 720
ROOM_FOR_PLOT = 330


class BandDetail(QWidget):
    """Shows one band of exemplar and result; ``closed`` when the user has seen enough."""

    closed = Signal()
    told = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("pyramid-detail")
        self.setAccessibleName("Large band")
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self._shown: BandLarge | None = None
        self.title = Label(name="pyramid-detail-title")
        self.title.setProperty("role", "heading")
        self.close_button = QToolButton()
        self.close_button.setObjectName("pyramid-detail-close")
        self.close_button.setText("Close")
        self.close_button.setAutoRaise(True)
        self.close_button.setAccessibleName("Close the large band")
        set_tip(self.close_button, "Back to the mosaics alone (Esc)")
        self.close_button.clicked.connect(self.closed)
        self._link = ViewLink()
        self.panes = (
            PicturePane("pyramid-detail-exemplar", "Band of the exemplar", self._link),
            PicturePane("pyramid-detail-result", "Band of the result", self._link),
        )
        for index, pane in enumerate(self.panes):
            pane.hovered.connect(lambda row, column, index=index: self._hover(index, row, column))
        self.bar = ColourBar("pyramid-detail-bar")
        self.plot = HistogramPlot("pyramid-detail-histogram", "Distribution of the band")
        set_tip(self.plot, "Exemplar: solid and filled. Result: dashed.")
        self.plot.hovered.connect(self._hover_plot)
        self.plot.left.connect(lambda: self.told.emit(""))
        self.table = NumbersTable("pyramid-detail-numbers")
        heading = QHBoxLayout()
        heading.addWidget(self.title, 1)
        heading.addWidget(self.close_button)
        row = QHBoxLayout()
        row.setSpacing(4)
        for pane in self.panes:
            row.addWidget(pane, 3)
        row.addWidget(self.bar)
        row.addWidget(self.plot, 4)
        row.addWidget(self.table, 0, Qt.AlignmentFlag.AlignTop)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addLayout(heading)
        layout.addLayout(row, 1)

    def sizeHint(self) -> QSize:
        """Ask for room for pictures, plot and numbers."""
        return QSize(620, 120)

    def minimumSizeHint(self) -> QSize:
        """Accept a narrow place: plot and numbers step back."""
        title = self.title.fontMetrics().lineSpacing()
        return QSize(260, max(80, title + self.bar.minimumSizeHint().height() + 4) if is_teaching() else 80)

    def show_band(self, shown: BandLarge) -> None:
        """Show a band."""
        self._shown = shown
        self.title.setText(shown.band.title.capitalize())
        for pane, picture in zip(self.panes, shown.pictures, strict=True):
            pane.setVisible(picture is not None)
            pane.set_picture(picture)
        # Both at one scale, the smaller one whole: the larger one can be panned.
        sizes = [picture.shape for picture in shown.pictures if picture is not None]
        self._link.set_extent(min(size[0] for size in sizes), min(size[1] for size in sizes))
        ticks = [(place, number(value)) for place, value in shown.scale.ticks()]
        self.bar.show_scale(band_table(shown.band), ticks)
        self.plot.show_comparison(shown.comparison, log=True)
        self.plot.set_labels(shown.comparison.title, "share per bin")
        self.table.show_comparisons([shown.comparison])
        self._make_room()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        for pane in self.panes:
            pane.set_theme(theme)
        self.bar.set_theme(theme)
        self.plot.set_theme(theme)
        self.table.set_theme(theme)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Leave out what has no room."""
        super().resizeEvent(event)
        self._make_room()

    def _make_room(self) -> None:
        self.table.setVisible(self.width() >= ROOM_FOR_TABLE * text_scale(self))
        self.plot.setVisible(self.width() >= ROOM_FOR_PLOT * text_scale(self))

    def _hover(self, index: int, row: int, column: int) -> None:
        shown = self._shown
        band = None if shown is None else (shown.band, shown.other)[index]
        if shown is None or band is None or row < 0:
            self.bar.set_mark(None)
            self.told.emit("")
            return
        value = float(band.plane[row, column])
        self.bar.set_mark(float(shown.scale.place(value)))
        self.told.emit(f"{('exemplar', 'result')[index]}, {band.title}, {column}, {row}: {number(value)}")

    def _hover_plot(self, x: float, _: float) -> None:
        if self._shown is not None:
            self.told.emit(self.plot.describe(self._shown.comparison, x))
