"""What the exemplar and the columns share: a row of controls, a picture, and words below or beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QBoxLayout, QFrame, QHBoxLayout, QVBoxLayout

from texlab.columns.arrangement import Frame
from texlab.widgets.image_pane import ImagePane
from texlab.widgets.status_line import strut

if TYPE_CHECKING:
    from PySide6.QtWidgets import QWidget

    from texlab.columns.arrangement import Words
    from texlab.columns.foot import Foot
    from texlab.style.theme import Theme
    from texlab.widgets.view_link import ViewLink

# Between the picture and the words.
GAP = 2


class Cell(QFrame):
    """A picture with a row over it and words about it; whoever makes one fills ``head`` and calls ``lay_out``."""

    def __init__(self, foot: Foot, link: ViewLink, spacing: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("column")
        self.foot = foot
        self.line = foot.line
        self.pane = ImagePane(link, self)
        self.head = QHBoxLayout()
        self.head.setSpacing(spacing)

    def lay_out(self, *models: QWidget) -> None:
        """Put the parts together; the row is high enough for such widgets too, so that all rows are alike."""
        for model in models:
            self.head.addWidget(strut(model))
        self.body = QBoxLayout(QBoxLayout.Direction.TopToBottom)
        self.body.setSpacing(GAP)
        self.body.addWidget(self.pane, 1)
        self.body.addWidget(self.foot)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(1, 1, 1, 1)
        layout.setSpacing(1)
        layout.addLayout(self.head)
        layout.addLayout(self.body, 1)

    def frame_of(self, words: Words) -> Frame:
        """Return what is around the picture when the words stand there."""
        layout = self.layout()
        assert layout is not None
        margins = layout.contentsMargins()
        border = self.contentsMargins()
        width = margins.left() + margins.right() + border.left() + border.right()
        height = margins.top() + margins.bottom() + border.top() + border.bottom()
        height += max(self.head.sizeHint().height(), self.head.minimumSize().height()) + layout.spacing()
        needed = self.foot.frame(words)
        if words == "beside":
            return Frame(width + needed.width + GAP, height)
        return Frame(width, height + needed.height + GAP, needed.least)

    def set_words(self, words: Words) -> None:
        """Show the words there."""
        self.foot.set_words(words)
        ways = QBoxLayout.Direction
        self.body.setDirection(ways.LeftToRight if words == "beside" else ways.TopToBottom)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self.pane.set_theme(theme)
