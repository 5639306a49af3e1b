"""What came of a pop-out test: a table of scores, and the pictures with piece, click and the machine's click."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QHBoxLayout, QListWidget, QTableWidget, QTableWidgetItem, QVBoxLayout, QWidget

from texlab.style.numbers import duration
from texlab.widgets.picture_area import PictureArea
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.tables import make_quiet

if TYPE_CHECKING:
    from collections.abc import Sequence

    from texlab.style.pictures import Picture
    from texlab_core.popout.record import Record
    from texlab_core.popout.scoring import Answer, Score

HEADS = ("Method", "Found", "Share", "95 % interval", "Guessing", "Time", "Machine", "So")
NOTE = (
    "Time is the median of the hits. The machine clicks where the local D is largest, without the exemplar. In a"
    " picture + is your click, × the machine's."
)


def cells_of(found: Score) -> tuple[str, ...]:
    """Return a line of the table of scores."""
    if not found.answers:
        return (found.name, "0 of 0", "", "", f"{found.chance:.0%}", "", "", found.verdict)
    return (
        found.name,
        f"{found.hits} of {found.answers}",
        f"{found.share:.0%}",
        f"{found.low:.0%} to {found.high:.0%}",
        f"{found.chance:.0%}",
        "" if found.seconds is None else duration(found.seconds),
        "" if found.machine is None else f"{found.machine} of {found.answers}",
        found.verdict,
    )


def line_of(record: Record, number: int) -> str:
    """Return what is said of one picture in the list."""
    answer = next((each for each in record.answers if each.trial == number), None)
    name = record.names[record.trial(number).setting]
    if answer is None:
        return f"{number}. {name}: not answered"
    said = "could not tell" if answer.row is None else ("found" if record.hit(answer) else "missed")
    return f"{number}. {name}: {said}"


class ReviewPicture(PictureArea):
    """A picture of the test with the piece outlined, the viewer's click and the machine's."""

    def __init__(self) -> None:
        super().__init__("popout-review-picture", "", "The piece is outlined; + is your click, x the machine's")
        self.piece = QRectF()
        self.clicks: tuple[tuple[Answer, str], ...] = ()

    def paint_marks(self, painter: QPainter, area: QRectF) -> None:
        """Paint outline and clicks, dark with a light rim, so that they are seen on any texture."""
        if self.picture is None:
            return
        scale = area.width() / self.picture.shape[1]
        outline = QRectF(
            area.left() + self.piece.left() * scale,
            area.top() + self.piece.top() * scale,
            self.piece.width() * scale,
            self.piece.height() * scale,
        )
        for colour, width in ((QColor("white"), 4), (QColor("black"), 2)):
            painter.setPen(QPen(colour, width))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRect(outline)
            for answer, sign in self.clicks:
                if answer.row is None or answer.column is None:
                    continue
                middle = area.topLeft() + QPointF(answer.column + 0.5, answer.row + 0.5) * scale
                arms = (QPointF(8, 0), QPointF(0, 8)) if sign == "+" else (QPointF(6, 6), QPointF(6, -6))
                for arm in arms:
                    painter.drawLine(middle - arm, middle + arm)


class PopoutReview(QWidget):
    """Scores and pictures of a test that is over, or was left."""

    def __init__(self) -> None:
        super().__init__()
        self.setAccessibleName("Scores and pictures")
        self._record: Record | None = None
        self._pictures: Sequence[Picture] = ()
        self.table = QTableWidget(0, len(HEADS))
        self.table.setObjectName("popout-scores")
        self.table.setAccessibleName("Scores")
        self.table.setHorizontalHeaderLabels(HEADS)
        self.table.verticalHeader().hide()
        make_quiet(self.table)
        note = Label(NOTE, name="popout-note", muted=True, wraps=True)
        self.list = QListWidget()
        self.list.setObjectName("popout-trials")
        self.list.setAccessibleName("Pictures of the test")
        set_tip(self.list, "Choose a picture to see where the piece was")
        self.list.currentRowChanged.connect(self._show_trial)
        self.picture = ReviewPicture()
        below = QHBoxLayout()
        below.addWidget(self.list, 1)
        below.addWidget(self.picture, 2)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.table, 1)
        layout.addWidget(note)
        layout.addLayout(below, 3)

    def clear(self) -> None:
        """Let go of record and pictures."""
        self._record, self._pictures = None, ()
        self.table.setRowCount(0)
        self.list.clear()
        self.picture.set_picture(None)

    def show_record(self, record: Record, pictures: Sequence[Picture]) -> None:
        """Show scores, and the pictures that were answered."""
        self._record, self._pictures = record, pictures
        scores = record.scores()
        self.table.setRowCount(len(scores))
        for row, found in enumerate(scores):
            for column, text in enumerate(cells_of(found)):
                self.table.setItem(row, column, QTableWidgetItem(text))
        self.list.clear()
        self.list.addItems([line_of(record, each.number) for each in record.trials])
        self.list.setCurrentRow(0)

    def _show_trial(self, row: int) -> None:
        record = self._record
        if record is None or not 0 <= row < len(self._pictures):
            self.picture.set_picture(None)
            return
        trial, (height, width) = record.trials[row], record.piece
        self.picture.piece = QRectF(trial.left, trial.top, width, height)
        listed = ((record.answers, "+"), (record.machine, "x"))
        self.picture.clicks = tuple(
            (each, sign) for answers, sign in listed for each in answers if each.trial == trial.number
        )
        self.picture.caption = line_of(record, trial.number)
        self.picture.set_picture(self._pictures[row])
