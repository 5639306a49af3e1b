"""A line over the pictures for errors and news; it never interrupts, and lies over no control."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from PySide6.QtCore import QEvent, QObject, QRect, Qt
from PySide6.QtWidgets import QFrame, QHBoxLayout, QToolButton, QWidget

from texlab.widgets.once import Once
from texlab.widgets.plain import Label, set_tip

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.style.theme import Theme

NEWS_MS = 6000
MARGIN = 6


class MessageBar(QFrame):
    """Shows one sentence; an error stays until it is closed, news go by themselves."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("message-bar")
        self.setAccessibleName("Message")
        self.label = Label(name="message", wraps=True)
        self.label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        close = QToolButton()
        close.setObjectName("message-close")
        close.setText("✕")
        close.setAutoRaise(True)
        close.setAccessibleName("Close the message")
        close.clicked.connect(self.hide)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(10, 4, 6, 4)
        layout.addWidget(self.label, 1)
        layout.addWidget(close)
        self._timer = Once(self, NEWS_MS, self.hide)
        self._kind: Literal["problem", "news"] = "news"
        self._colours = {"problem": "#b3261e", "news": "#0b62b0"}
        self._ground = "#e9e9e6"
        self.hide()
        self._room: Callable[[], QRect] | None = None
        self._sentence = ""
        self._below = parent
        if parent is not None:
            parent.installEventFilter(self)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._colours = {"problem": theme.error, "news": theme.accent}
        self._ground = theme.raised
        self._paint()

    def tell(self, sentence: str, kind: Literal["problem", "news"]) -> None:
        """Show a sentence."""
        self._kind = kind
        self._paint()
        self._sentence = sentence
        self._lie()
        self.show()
        self.raise_()
        if kind == "news":
            self._timer.start()
        else:
            self._timer.stop()

    def _paint(self) -> None:
        colour = self._colours[self._kind]
        self.setStyleSheet(
            f"MessageBar {{ border: 1px solid {colour}; border-left-width: 6px; background: {self._ground}; }}"
        )

    def keep_to(self, room: Callable[[], QRect]) -> None:
        """Lie in this part of what is below from now on: there is no control. Nothing ends lower than it does."""
        self._room = room
        self._lie()

    def lie_over(self, below: QWidget, within: QWidget) -> None:
        """Lie over the upper edge of another widget from now on, ``within`` one that is around it."""
        if self._below is not None:
            self._below.removeEventFilter(self)
        was_shown = self.isVisible()
        self._below = below
        self.setParent(within)
        below.installEventFilter(self)
        self._lie()
        self.setVisible(was_shown)

    def _lie(self) -> None:
        """Lie over the upper edge of what is below: nothing there has to move."""
        below, within = self._below, self.parentWidget()
        if below is None or within is None:
            return
        room = below.rect() if self._room is None else self._room()
        corner = below.mapTo(within, room.topLeft()) if below is not within else room.topLeft()
        width = room.width() - 2 * MARGIN
        self._write(width, room.height() - 2 * MARGIN)
        self.setGeometry(corner.x() + MARGIN, corner.y() + MARGIN, width, self._height(width))

    def _height(self, width: int) -> int:
        layout = self.layout()
        height = layout.heightForWidth(width) if layout is not None and layout.hasHeightForWidth() else -1
        return max(height, self.minimumSizeHint().height())

    def _write(self, width: int, most: int) -> None:
        """Write as many words of the sentence as there is room for; all of it is in the tip."""
        words = self._sentence.split(" ")
        self.label.setText(self._sentence)
        while len(words) > 1 and self._height(width) > most:
            words.pop()
            self.label.setText(" ".join(words) + " …")
        set_tip(self.label, self._sentence if self.label.text() != self._sentence else "")

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Follow the size of what is below."""
        if event.type() == QEvent.Type.Resize and watched is self._below:
            self._lie()
        return super().eventFilter(watched, event)

    def hideEvent(self, event: object) -> None:
        """Stop the clock."""
        self._timer.stop()
        super().hideEvent(event)  # type: ignore[arg-type]
