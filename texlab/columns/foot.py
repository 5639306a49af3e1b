"""What is said about a picture: a few figures that can be read from afar, and a line."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, Qt, Signal
from PySide6.QtWidgets import QBoxLayout, QSizePolicy, QWidget

from texlab.columns.arrangement import Frame
from texlab.columns.status import MOST_NUMBERS, Figure, details, figures, numbers_of, shows_numbers, status_parts
from texlab.style.text_size import text_scale
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.status_line import StatusLine

if TYPE_CHECKING:
    from collections.abc import Mapping

    from PySide6.QtGui import QMouseEvent, QResizeEvent

    from texlab.columns.arrangement import Words
    from texlab.state.scene import ColumnScene

LINES_BESIDE = 7
# The longest figure, and what stands behind the figures on one line.
WIDEST = "laid down 100% ▲"
LINE = "256 x 256 · 1.23 s"
MARGIN = 2
GAP = 8
UNLIMITED = 16_777_215


class Foot(QWidget):
    """Figures with a line, below the picture or beside it.

    ``clicked()`` on the words, ``details_wanted()`` on the figures.
    """

    clicked = Signal()
    details_wanted = Signal()

    def __init__(self, name: str, parent: QWidget | None = None, *, has_figures: bool = True) -> None:
        super().__init__(parent)
        self.setAccessibleName("About the picture")
        self._words: Words = "below"
        self._shown: tuple[Figure, ...] = ()
        self.before: Mapping[str, float] = {}
        """The numbers that better and worse are about: of the result before."""
        self.line = StatusLine(lines=self._lines)
        self.line.setObjectName(name)
        self.figures = tuple(Label() for _ in range(MOST_NUMBERS))
        self.row = QBoxLayout(QBoxLayout.Direction.LeftToRight)
        for each in self.figures:
            each.setProperty("role", "figure")
            each.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
            each.setVisible(False)
            self.row.addWidget(each)
        self.row.addStretch(1)
        self.box = QBoxLayout(QBoxLayout.Direction.TopToBottom, self)
        self.box.setContentsMargins(MARGIN, 0, MARGIN, 0)
        self.box.setSpacing(0)
        self.box.addLayout(self.row)
        self.box.addWidget(self.line, 1)
        self.box.addStretch(0)
        if has_figures:
            self.setCursor(Qt.CursorShape.PointingHandCursor)
        self._take_room()

    def show_scene(self, scene: ColumnScene) -> None:
        """Show the figures and the state of a column."""
        found = tuple(figures(numbers_of(scene), self.before)) if shows_numbers(scene) else ()
        if found != self._shown:
            self._shown = found
            for label, figure in zip(self.figures, found, strict=False):
                label.setText(figure.text)
                set_tip(label, f"{figure.tip}\nClick: every number")
            self.line.set_lines(self._lines)
            self._fit()
        self.line.show_parts(status_parts(scene), details(scene))

    def set_words(self, words: Words) -> None:
        """Stand there."""
        if words == self._words:
            return
        self._words = words
        ways = QBoxLayout.Direction
        self.row.setDirection(ways.TopToBottom if words == "beside" else ways.LeftToRight)
        self.box.setDirection(ways.LeftToRight if words == "line" else ways.TopToBottom)
        # Beside a high picture the line stands under the figures, and what is left is below both.
        self.box.setStretch(2, 1 if words == "beside" else 0)
        self.box.setStretch(1, 0 if words == "beside" else 1)
        policy = QSizePolicy.Policy
        for each in self.figures:
            across = policy.Preferred if words == "beside" else policy.Fixed
            each.setSizePolicy(across, policy.Minimum if words == "beside" else policy.Fixed)
            # What is longer than the longest figure is broken into lines there; a new policy knows of none.
            each.setWordWrap(words == "beside")
        self.line.set_lines(self._lines)
        self.line.setVisible(True)
        self._take_room()
        self._fit()

    @property
    def _lines(self) -> int:
        if self._words == "beside":
            return LINES_BESIDE
        # A sentence has the line of the figures too, where there are none.
        return 2 if self._words == "below" and not self._shown else 1

    @property
    def _gap(self) -> int:
        """Pixels between figures; lines are apart already."""
        return GAP if self._words == "beside" else round(GAP * text_scale(self))

    def width_of(self, text: str) -> int:
        """Return the pixels of a text among the figures."""
        self.figures[0].ensurePolished()
        return self.figures[0].fontMetrics().horizontalAdvance(text)

    @property
    def heights(self) -> tuple[int, int]:
        """Pixels of the figures and of the line."""
        self.figures[0].ensurePolished()
        return self.figures[0].fontMetrics().lineSpacing() + 1, self.line.fontMetrics().lineSpacing() + 2

    def frame(self, words: Words) -> Frame:
        """Return what it takes there."""
        if words == "beside":
            return Frame(self.width_of(WIDEST) + 2 * MARGIN, 0)
        figure, line = self.heights
        if words == "line":
            least = 2 * self.width_of("D -0.00 ▲") + self.width_of(WIDEST) + self.width_of(LINE) + 4 * self._gap
            return Frame(0, max(self.heights), least)
        return Frame(0, figure + line)

    def _take_room(self) -> None:
        """Be as high as all feet, or as wide: pictures side by side stay at the same level."""
        self.row.setSpacing(self._gap)
        self.box.setSpacing(self._gap if self._words == "line" else 0)
        self.setMinimumSize(0, 0)
        self.setMaximumSize(UNLIMITED, UNLIMITED)
        frame = self.frame(self._words)
        if self._words == "beside":
            self.setFixedWidth(frame.width)
        else:
            self.setFixedHeight(frame.height)

    def _fit(self) -> None:
        """Show whole figures only, the first ones."""
        if self._words == "beside":
            self._fit_beside()
            return
        room = self.width() - 2 * MARGIN
        if self._words == "line":
            room -= self.width_of(LINE)
        for place, label in enumerate(self.figures):
            has = place < len(self._shown)
            if has:
                whole = self._shown[place].text
                # The first one is always there: its value, where the title has no room.
                first = not place and self.width_of(whole) > room and self.isVisible()
                label.setText(self._shown[place].short if first else whole)
                room -= self.width_of(self._shown[place].text) + (self._gap if place else 0)
            label.setVisible(has and (room >= 0 or place == 0))

    def _fit_beside(self) -> None:
        """Show the first figures that stand whole under each other, and as many lines as are left."""
        for label, figure in zip(self.figures, self._shown, strict=False):
            label.setText(figure.text)
        width, room = self.width() - 2 * MARGIN, self.height()
        for place, label in enumerate(self.figures):
            needed = 0
            if place < len(self._shown):
                needed = max(label.heightForWidth(width), label.sizeHint().height()) + (self._gap if place else 0)
            room -= needed
            label.setVisible(needed > 0 and room >= 0)
        lines = int((room - 2) // self.line.fontMetrics().lineSpacing())
        self.line.set_lines(min(max(lines, 0), LINES_BESIDE))
        self.line.setVisible(lines > 0)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Show what there is room for."""
        super().resizeEvent(event)
        self._fit()

    def changeEvent(self, event: QEvent) -> None:
        """Follow the font."""
        super().changeEvent(event)
        if event.type() in (QEvent.Type.FontChange, QEvent.Type.StyleChange):
            self._take_room()
            self._fit()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Ask for the details where the figures are."""
        self.clicked.emit()
        child = self.childAt(event.position().toPoint())
        if event.button() == Qt.MouseButton.LeftButton and child in self.figures:
            self.details_wanted.emit()
        event.accept()
