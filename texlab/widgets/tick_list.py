"""A list in which things are ticked."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtWidgets import QListWidget, QListWidgetItem

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable

    from PySide6.QtWidgets import QWidget


class TickList(QListWidget):
    """Things by number and title, each ticked or not; ``itemChanged`` tells that the user has ticked one."""

    def __init__(self, lines: int, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setFixedHeight(lines * self.fontMetrics().lineSpacing())

    def offer(self, things: Iterable[tuple[int, str]], ticked: Collection[int]) -> None:
        """List other things, those of ``ticked`` ticked, without telling anyone."""
        with QSignalBlocker(self):
            self.clear()
            for number, title in things:
                item = QListWidgetItem(title, self)
                item.setData(Qt.ItemDataRole.UserRole, number)
                item.setFlags(
                    Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsUserCheckable | Qt.ItemFlag.ItemIsSelectable
                )
                checked = Qt.CheckState.Checked if number in ticked else Qt.CheckState.Unchecked
                item.setCheckState(checked)

    def tick(self, ticked: Collection[int]) -> None:
        """Tick these and no others, without telling anyone."""
        with QSignalBlocker(self):
            for row, (number, _) in enumerate(self.things):
                state = Qt.CheckState.Checked if number in ticked else Qt.CheckState.Unchecked
                self.item(row).setCheckState(state)
        self.viewport().update()

    @property
    def things(self) -> list[tuple[int, str]]:
        """Number and title of everything that is listed."""
        items = (self.item(row) for row in range(self.count()))
        return [(int(item.data(Qt.ItemDataRole.UserRole)), item.text()) for item in items]

    @property
    def ticked(self) -> tuple[int, ...]:
        """Numbers of what is ticked, in the order of the list."""
        items = (self.item(row) for row in range(self.count()))
        return tuple(
            int(item.data(Qt.ItemDataRole.UserRole))
            for item in items
            if item.checkState() == Qt.CheckState.Checked
        )
