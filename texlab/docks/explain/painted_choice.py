"""A painted widget of which one part is chosen: what all such widgets have in common."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QPointF, QRectF, Qt, Signal
from PySide6.QtWidgets import QSizePolicy, QWidget

from texlab.widgets.own_keys import OwnKeys, is_plain

if TYPE_CHECKING:
    from PySide6.QtGui import QKeyEvent, QMouseEvent

    from texlab.style.theme import Theme


class PaintedChoice(OwnKeys, QWidget):
    """Parts that are pointed at and chosen by mouse and keyboard.

    ``chosen(index)`` and ``hovered(index)`` tell a part, -1 for none.
    """

    chosen = Signal(int)
    hovered = Signal(int)

    def __init__(self, name: str, label: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(name)
        self.setAccessibleName(label)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMinimumSize(160, 80)
        self._theme: Theme | None = None
        self._selected = -1

    @abstractmethod
    def descriptions(self) -> list[str]:
        """Return every part in words."""

    @abstractmethod
    def part_rect(self, index: int) -> QRectF:
        """Return where a part is pointed at."""

    @abstractmethod
    def reached(self, key: Qt.Key) -> int | None:
        """Return the index that a key leads to, which may lie beyond the parts; None for any other key."""

    @property
    def selected(self) -> int:
        """Index of the chosen part, -1 for none."""
        return self._selected

    def select(self, index: int) -> None:
        """Mark a part without telling anyone."""
        descriptions = self.descriptions()
        self._selected = index if 0 <= index < len(descriptions) else -1
        self.setAccessibleDescription(descriptions[self._selected] if self._selected >= 0 else "")
        self.update()

    def set_theme(self, theme: Theme) -> None:
        """Repaint in another theme."""
        self._theme = theme
        self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Tell which part is under the cursor."""
        self.hovered.emit(self._at(event.position()))

    def leaveEvent(self, event: QEvent) -> None:
        """Tell that the cursor has left."""
        self.hovered.emit(-1)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Choose the part under the cursor."""
        if (index := self._at(event.position())) >= 0:
            self._choose(index)

    def wants_key(self, event: QKeyEvent) -> bool:
        """Return whether it leads to another part."""
        return is_plain(event) and bool(self.descriptions()) and self.reached(Qt.Key(event.key())) is not None

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Choose another part."""
        wanted = self.reached(Qt.Key(event.key()))
        if wanted is None or not self.wants_key(event):
            super().keyPressEvent(event)
        else:
            self._choose(min(max(wanted, 0), len(self.descriptions()) - 1))

    def _choose(self, index: int) -> None:
        self.select(index)
        self.chosen.emit(index)

    def _at(self, point: QPointF) -> int:
        areas = (self.part_rect(index) for index in range(len(self.descriptions())))
        return next((index for index, area in enumerate(areas) if area.contains(point)), -1)
