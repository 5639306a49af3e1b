"""A mosaic of subbands with labels, a mark around the chosen one, and arrow keys."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QEvent, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QFontMetricsF
from PySide6.QtWidgets import QGraphicsRectItem, QSizePolicy, QVBoxLayout, QWidget

from texlab.style.text_size import smaller
from texlab.widgets.own_keys import OwnKeys, is_plain
from texlab.widgets.picture_pane import PicturePane
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.plots import pg

if TYPE_CHECKING:
    from collections.abc import Mapping

    from PySide6.QtGui import QFocusEvent, QKeyEvent

    from texlab.docks.bands.mosaic import Direction
    from texlab.docks.bands.pictures import MosaicPicture
    from texlab.style.theme import Theme
    from texlab_core.transforms.steerable import BandKey

ARROWS: dict[Qt.Key, Direction] = {
    Qt.Key.Key_Left: "left",
    Qt.Key.Key_Right: "right",
    Qt.Key.Key_Up: "up",
    Qt.Key.Key_Down: "down",
}


class MosaicView(OwnKeys, QWidget):
    """Shows one mosaic.

    ``chosen(index)``: a band was clicked or reached with the arrow keys.
    ``hovered(index, row, column)``: the place in that band under the cursor, (-1, -1, -1) outside.
    """

    chosen = Signal(int)
    hovered = Signal(int, int, int)

    def __init__(self, name: str, title: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(f"Subbands of the {title}")
        set_tip(self, f"Subbands of the {title}: click one, or use the arrow keys, to see it large")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.name = title
        self.title = Label(title)
        self.title.setContentsMargins(2, 0, 0, 0)
        self.pane = PicturePane(f"{name}-pane", title)
        self.pane.hovered.connect(self._hover)
        self.pane.clicked.connect(self._click)
        self.pane.view.sigTransformChanged.connect(self._choose_labels)
        self._frame = QGraphicsRectItem()
        self._frame.setZValue(20)
        self._frame.hide()
        self.pane.view.addItem(self._frame, ignoreBounds=True)
        self._labels: list[Any] = []
        self._words: list[tuple[str, str]] = []
        self._shown: MosaicPicture | None = None
        self._selected = -1
        self._theme: Theme | None = None
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(1)
        layout.addWidget(self.title)
        layout.addWidget(self.pane, 1)

    def sizeHint(self) -> QSize:
        """Ask for little: docks are low."""
        return QSize(240, 90)

    @property
    def shown(self) -> MosaicPicture | None:
        """What is shown."""
        return self._shown

    @property
    def selected(self) -> int:
        """Index of the chosen band, -1 for none."""
        return self._selected

    def label_texts(self) -> list[str]:
        """Return what the labels say, in the order of the bands; "" where a tile has no room for words."""
        return [label.toPlainText() if label.isVisible() else "" for label in self._labels]

    def show_mosaic(self, shown: MosaicPicture, gains: Mapping[BandKey, float]) -> None:
        """Show a mosaic; bands with a gain other than 1 say so."""
        if self._shown is None or shown.picture is not self._shown.picture:
            self.pane.set_picture(shown.picture)
        self._shown = shown
        self.title.setText(f"{self.name}: {shown.part}" if shown.part else self.name)
        self._make_labels(len(shown.bands))
        self._words = []
        for label, band, cell in zip(self._labels, shown.bands, shown.layout.cells, strict=True):
            gain = gains.get(band.key, 1.0)
            changed = "off" if gain == 0 else "" if gain == 1 else f"×{gain:g}"
            # Where a tile has no room for both, the gain is what must be seen.
            self._words.append((f"{band.label} {changed}".strip(), changed))
            label.setPos(cell.left, cell.top)
        self.select(self._selected)
        self._choose_labels()

    def forget(self) -> None:
        """Show nothing any more."""
        self._shown, self._words = None, []
        self._make_labels(0)
        self.select(-1)
        self.pane.set_picture(None)

    def select(self, index: int) -> None:
        """Mark a band, -1 for none, without telling anyone."""
        bands = self._shown.bands if self._shown is not None else ()
        self._selected = index if 0 <= index < len(bands) else -1
        self._frame.setVisible(self._selected >= 0)
        if self._shown is not None and self._selected >= 0:
            cell = self._shown.layout.cells[self._selected]
            self._frame.setRect(QRectF(cell.left, cell.top, cell.width, cell.height))
            self.setAccessibleDescription(self._shown.bands[self._selected].title)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.pane.set_theme(theme)
        for label in self._labels:
            self._paint_label(label)
        self._paint_frame()

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it leads to another band."""
        key = Qt.Key(event.key())
        leads = key in ARROWS or key in (Qt.Key.Key_Home, Qt.Key.Key_End)
        return is_plain(event) and leads and self._shown is not None

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Go to the next band in the direction of an arrow key, to the first or to the last."""
        key = Qt.Key(event.key())
        if self._shown is None or not self.wants_key(event):
            super().keyPressEvent(event)
            return
        last = len(self._shown.bands) - 1
        if key in ARROWS and self._selected >= 0:
            index = self._shown.layout.neighbour(self._selected, ARROWS[key])
        else:
            index = last if key == Qt.Key.Key_End else 0
        if index != self._selected:
            self.select(index)
            self.chosen.emit(index)

    def focusInEvent(self, event: QFocusEvent) -> None:
        """Show the focus at the frame."""
        super().focusInEvent(event)
        self._paint_frame()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """Show the focus at the frame."""
        super().focusOutEvent(event)
        self._paint_frame()

    def changeEvent(self, event: QEvent) -> None:
        """Let the labels follow the size of the program's text."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            for label in self._labels:
                label.setFont(self._label_font())
            self._choose_labels()

    def _make_labels(self, count: int) -> None:
        while len(self._labels) > count:
            self.pane.view.removeItem(self._labels.pop())
        while len(self._labels) < count:
            label = pg.TextItem("", anchor=(0, 0))
            label.textItem.document().setDocumentMargin(1)
            label.setFont(self._label_font())
            label.setZValue(10)
            self.pane.view.addItem(label, ignoreBounds=True)
            self._labels.append(label)
            self._paint_label(label)

    def _label_font(self) -> QFont:
        font = QFont(self.font())
        font.setPointSizeF(smaller(self.font().pointSizeF(), 0.8))
        return font

    def _paint_label(self, label: Any) -> None:
        if self._theme is not None:
            wash = QColor(self._theme.base)
            wash.setAlpha(205)
            label.setColor(QColor(self._theme.text))
            label.fill = pg.mkBrush(wash)
            label.update()

    def _paint_frame(self) -> None:
        if self._theme is not None:
            pen = pg.mkPen(self._theme.accent, width=4 if self.hasFocus() else 2.5)
            pen.setCosmetic(True)
            self._frame.setPen(pen)

    def _choose_labels(self, *_: object) -> None:
        """Hide the labels of tiles that are too small on the screen for them."""
        if self._shown is None:
            return
        pixel = self.pane.view.viewPixelSize()[0] or 1.0
        metrics = QFontMetricsF(self._label_font())
        for label, cell, choices in zip(self._labels, self._shown.layout.cells, self._words, strict=False):
            room = cell.width / pixel - 3 if cell.height / pixel >= metrics.height() else 0.0
            fitting = [words for words in choices if words and metrics.horizontalAdvance(words) <= room]
            label.setVisible(bool(fitting))
            if fitting and label.toPlainText() != fitting[0]:
                label.setText(fitting[0])

    def _hover(self, row: int, column: int) -> None:
        found = None
        if self._shown is not None and row >= 0:
            found = self._shown.layout.locate(row, column)
        self.hovered.emit(*(found or (-1, -1, -1)))

    def _click(self, row: int, column: int) -> None:
        self.setFocus(Qt.FocusReason.MouseFocusReason)
        if self._shown is None or row < 0:
            return
        found = self._shown.layout.locate(row, column)
        if found is not None:
            self.select(found[0])
            self.chosen.emit(found[0])
