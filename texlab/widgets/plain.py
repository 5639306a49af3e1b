"""The only makers of labels and tooltips: text is shown as it is written, whoever wrote it.

Qt takes a text that looks like markup for rich text, which may load any file of this machine. Names, notes and
errors from files reach labels, tooltips and boxes; so nothing else in the window makes these (a test says so).
"""

from __future__ import annotations

import html
import textwrap
from functools import lru_cache
from typing import TYPE_CHECKING

from PySide6.QtCore import QMargins, QRect, QSize, Qt
from PySide6.QtGui import QPainter
from PySide6.QtWidgets import QLabel, QMessageBox, QSizePolicy, QToolTip, QTreeWidgetItem, QWidget

from texlab.style.text_size import MORE, is_teaching, shortened

if TYPE_CHECKING:
    from PySide6.QtCore import QPoint
    from PySide6.QtGui import QAction, QPaintEvent, QResizeEvent
    from PySide6.QtWidgets import QListWidgetItem, QTableWidgetItem

# Characters in a line of a tooltip.
TIP_WIDTH = 60
# Of what came from outside, no more than anybody would read.
LONGEST_TIP = 4000
FAR_DOWN = 100_000
WRAPPED = Qt.TextFlag.TextWordWrap.value


class Label(QLabel):
    """A label whose text is never markup.

    Parameters
    ----------
    text
        What it says at first.
    name
        Of the object.
    muted
        Whether it is written in the colour of what is less important.
    wraps
        Whether long text goes on in another line.
    """

    def __init__(
        self,
        text: str = "",
        parent: QWidget | None = None,
        *,
        name: str = "",
        muted: bool = False,
        wraps: bool = False,
    ) -> None:
        super().__init__(parent)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setText(text)
        self.setObjectName(name)
        self.setWordWrap(wraps)
        if muted:
            self.setProperty("role", "muted")


class ShortLabel(Label):
    """A line in the width that there is: what has no room gives way to an ellipsis, and the tip has all."""

    def __init__(
        self, text: str = "", parent: QWidget | None = None, *, name: str = "", muted: bool = False
    ) -> None:
        super().__init__(text, parent, name=name, muted=muted)
        # A long line must not widen the window.
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)

    def setText(self, text: str) -> None:
        """Show a text, and all of it in the tip."""
        super().setText(text)
        set_tip(self, text)

    def shown_text(self) -> str:
        """Return what is painted, with the ellipsis."""
        room = self.contentsRect().width() - 2 * self.margin()
        return shortened(self.text(), self.fontMetrics(), room)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint what there is room for."""
        painter = QPainter(self)
        inside = self.contentsRect().marginsRemoved(QMargins(*[self.margin()] * 4))
        self.style().drawItemText(
            painter,
            inside,
            int(self.alignment()) | (WRAPPED if self.wordWrap() else 0),
            self.palette(),
            self.isEnabled(),
            self.shown_text(),
            self.foregroundRole(),
        )
        painter.end()


class FittedLabel(ShortLabel):
    """Words in as many lines as there is room for, two at least; then an ellipsis, and the tip has all of them."""

    def __init__(self, text: str = "", parent: QWidget | None = None, *, name: str = "") -> None:
        super().__init__(text, parent, name=name)
        self.setWordWrap(True)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)

    def hasHeightForWidth(self) -> bool:
        """Return False: Qt gives what has one all of it, however little is left for the rest."""
        return False

    def sizeHint(self) -> QSize:
        """Return the room of all lines in the width that there is."""
        return QSize(super().sizeHint().width(), self.heightForWidth(max(self.width(), 1)))

    def minimumSizeHint(self) -> QSize:
        """Return the room of two lines where text is large, else that of all."""
        least, lines = super().minimumSizeHint().width(), self.sizeHint().height()
        return QSize(least, min(lines, 2 * self.fontMetrics().lineSpacing()) if is_teaching() else lines)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Ask for other room in another width."""
        super().resizeEvent(event)
        if event.size().width() != event.oldSize().width():
            self.updateGeometry()

    def shown_text(self) -> str:
        """Return what is painted, with the ellipsis."""
        words = self.text().split(" ")
        if self._fits(self.text()) or len(words) < 2:
            return self.text()
        few, many = 1, len(words)
        while many - few > 1:
            middle = (few + many) // 2
            few, many = (middle, many) if self._fits(f"{' '.join(words[:middle])} {MORE}") else (few, middle)
        return f"{' '.join(words[:few]).rstrip(',;:')} {MORE}"

    def _fits(self, text: str) -> bool:
        inside = self.contentsRect()
        room = QRect(0, 0, max(inside.width(), 1), FAR_DOWN)
        return self.fontMetrics().boundingRect(room, WRAPPED, text).height() <= inside.height()


class MarkupLabel(QLabel):
    """A label that the program itself gives markup; foreign parts of it go through :func:`escaped`."""

    def __init__(self, text: str = "", parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setTextFormat(Qt.TextFormat.RichText)
        self.setText(text)


def escaped(text: str) -> str:
    """Return a text as part of markup."""
    return html.escape(text)


def tip_text(text: str) -> str:
    """Return what shows as this text in a tooltip, in lines of at most 60 characters."""
    if len(text) > LONGEST_TIP:
        text = text[:LONGEST_TIP] + " …"
    shown = "\n".join(map(_wrapped, text.split("\n")))
    # Qt takes nothing for markup that has no tag.
    if "<" not in shown:
        return shown
    lines = shown.split("\n")
    return "<qt>" + "<br>".join(html.escape(line).replace(" ", "&nbsp;") for line in lines) + "</qt>"


@lru_cache(maxsize=1024)
def _wrapped(paragraph: str) -> str:
    # Numbers change with every picture while a control is dragged; the long sentences beside them stay.
    if len(paragraph) <= TIP_WIDTH and paragraph.isprintable():
        return paragraph.rstrip()
    return "\n".join(textwrap.wrap(paragraph, TIP_WIDTH, break_on_hyphens=False))


def set_tip(target: QWidget | QAction | QTreeWidgetItem | QListWidgetItem | QTableWidgetItem, text: str) -> None:
    """Give something a tooltip."""
    if isinstance(target, QTreeWidgetItem):
        target.setToolTip(0, tip_text(text))
    else:
        target.setToolTip(tip_text(text))


def show_tip(position: QPoint, text: str, widget: QWidget) -> None:
    """Show a tooltip now, at a place of the screen; nothing when the text is empty."""
    QToolTip.showText(position, tip_text(text), widget)


def message_box(parent: QWidget, title: str, text: str, details: str = "") -> QMessageBox:
    """Return a box whose texts are never markup; it deletes itself when it is closed."""
    box = QMessageBox(parent)
    box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    box.setTextFormat(Qt.TextFormat.PlainText)
    box.setWindowTitle(title)
    box.setText(text)
    box.setInformativeText(details)
    return box
