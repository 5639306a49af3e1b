"""Every number about one result, as a table that can be copied as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialog, QTableWidget, QTableWidgetItem, QVBoxLayout

from texlab.columns.status import numbers_of
from texlab.widgets.plain import Label, set_tip
from texlab.widgets.tables import make_quiet

if TYPE_CHECKING:
    from collections.abc import Mapping

    from PySide6.QtWidgets import QWidget

    from texlab.state.scene import ColumnScene

HEADS = ("Measure", "Now", "Before")


def rows_of(numbers: Mapping[str, float], before: Mapping[str, float]) -> list[tuple[str, str, str, str]]:
    """Return title, value, the value before, and the explanation of every number, in the registry's order."""
    from texlab_core.measures.registry import measures

    return [
        (
            each.title,
            each.text(numbers[each.id]),
            each.text(before[each.id]) if each.id in before else "",
            each.summary,
        )
        for each in measures().values()
        if each.id in numbers
    ]


class NumbersPopup(QDialog):
    """Goes with a click anywhere else; Ctrl+C copies the table."""

    def __init__(
        self, title: str, scene: ColumnScene, before: Mapping[str, float], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setObjectName("numbers-popup")
        self.setAccessibleName(f"Numbers of {title}")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        rows = rows_of(numbers_of(scene), before)
        self.table = QTableWidget(len(rows), len(HEADS), self)
        self.table.setObjectName("numbers-table")
        self.table.setAccessibleName(f"Numbers of {title}")
        self.table.setHorizontalHeaderLabels(HEADS)
        make_quiet(self.table)
        self.table.verticalHeader().hide()
        for row, (*texts, summary) in enumerate(rows):
            for column, text in enumerate(texts):
                item = QTableWidgetItem(text)
                set_tip(item, summary)
                self.table.setItem(row, column, item)
        self.table.horizontalHeader().setStretchLastSection(True)
        self.table.resizeRowsToContents()
        size = ""
        if scene.measured_size is not None:
            size = f", measured at {scene.measured_size[1]} x {scene.measured_size[0]}"
        heading = Label(f"{title}{size}" if rows else f"{title}: nothing has been measured yet.")
        heading.setProperty("role", "heading")
        hint = Label("Ctrl+C copies the table.", muted=True)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 8, 8)
        layout.addWidget(heading)
        layout.addWidget(self.table)
        layout.addWidget(hint)
        self.resize(420, min(520, 110 + self.table.verticalHeader().length()))
        self.table.setFocus()
