"""Two cells of a sweep side by side: flicker, a line that divides them, their difference."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QHBoxLayout, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from texlab.style.text_size import grow_with_text
from texlab.widgets.image_pane import ImagePane
from texlab.widgets.own_keys import OwnKeys, is_bare
from texlab.widgets.pair_layer import GAINS, Mode, PairLayer
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.short_box import ShortBox
from texlab.widgets.view_link import ViewLink

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtGui import QKeyEvent

    from texlab.state.sweeps import ShownCell
    from texlab.style.theme import Theme

_MODES: tuple[tuple[Mode, str, str], ...] = (
    ("flicker", "Flicker", "B in the place of A; again shows A (B)"),
    ("swipe", "Swipe", "A left and B right of a line that can be moved"),
    ("difference", "Difference", "What differs in the left picture; black is equal"),
)


class PairView(OwnKeys, QWidget):
    """Shows cells A and B in panes that move together.

    ``closed()`` when the sheet is wanted again. ``compute`` as of :class:`PairLayer`.
    """

    closed = Signal()

    def __init__(
        self, name: str, compute: Callable[[Callable[[], Any], Callable[[Any], None]], None], parent: QWidget
    ) -> None:
        super().__init__(parent)
        self.setObjectName(f"{name}-pair")
        self.link = ViewLink()
        self.layer = PairLayer(compute, self)
        self.panes = (ImagePane(self.link), ImagePane(self.link))
        self.captions = (Label(), Label())
        self._buttons: dict[Mode, QToolButton] = {}
        line = QHBoxLayout()
        self.back = self._button(line, f"{name}-pair-back", "Back", "The sheet again (Esc)")
        self.back.clicked.connect(self.closed)
        for mode, text, tip in _MODES:
            button = self._button(line, f"{name}-pair-{mode}", text, tip)
            button.setCheckable(True)
            button.clicked.connect(lambda _, mode=mode: self.layer.set_mode(mode))
            self._buttons[mode] = button
        self.gain = ShortBox()
        self.gain.setObjectName(f"{name}-pair-gain")
        self.gain.setAccessibleName("Gain of the difference")
        set_tip(self.gain, "The difference is multiplied by this before it is shown")
        grow_with_text(self.gain, 70, self.gain.setFixedWidth)
        self.gain.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        for gain in GAINS:
            self.gain.addItem(f"× {gain}", gain)
        self.gain.setCurrentIndex(GAINS.index(self.layer.gain))
        self.gain.activated.connect(lambda _: self.layer.set_gain(self.gain.currentData()))
        line.addWidget(self.gain)
        line.addStretch(1)
        pair = QGridLayout()
        for column, (pane, caption, letter) in enumerate(zip(self.panes, self.captions, "AB", strict=True)):
            pane.setObjectName(f"{name}-pair-{letter.lower()}")
            pane.setAccessibleName(f"Cell {letter}")
            caption.setObjectName(f"{name}-pair-{letter.lower()}-words")
            caption.setWordWrap(True)
            caption.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
            caption.setAlignment(Qt.AlignmentFlag.AlignHCenter)
            pair.addWidget(caption, 0, column)
            pair.addWidget(pane, 1, column)
            pair.setColumnStretch(column, 1)
        pair.setRowStretch(1, 1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addLayout(line)
        layout.addLayout(pair, 1)
        self.layer.changed.connect(self._say)
        self.hide()

    def _button(self, line: QHBoxLayout, name: str, text: str, tip: str) -> QToolButton:
        button = QToolButton()
        button.setObjectName(name)
        button.setText(text)
        button.setAccessibleName(text)
        button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        set_tip(button, tip)
        line.addWidget(button)
        return button

    def show_pair(self, a: ShownCell, b: ShownCell) -> None:
        """Show two cells that have pictures."""
        for pane, caption, shown, letter in zip(self.panes, self.captions, (a, b), "AB", strict=True):
            pane.set_picture(shown.picture)
            caption.setText(f"{letter}: {shown.cell.label}")
        sizes = [shown.picture.shape[:2] for shown in (a, b) if shown.picture is not None]
        self.link.set_extent(*(max(sides) for sides in zip(*sizes, strict=True)))
        self.link.fit()
        self.layer.show_pair(self.panes[0], a.picture, b.picture)

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        for pane in self.panes:
            pane.set_theme(theme)

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it flickers or goes back."""
        return event.key() in (Qt.Key.Key_B, Qt.Key.Key_Escape) and is_bare(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Change between A and B with B; go back with Escape."""
        if not self.wants_key(event):
            super().keyPressEvent(event)
        elif event.key() == Qt.Key.Key_B:
            self.layer.set_mode("flicker")
        else:
            self.closed.emit()

    def _say(self) -> None:
        for mode, button in self._buttons.items():
            button.setChecked(mode == self.layer.mode)
