"""How tables of numbers look and behave; every one of them can be copied as text."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QAbstractItemView, QApplication, QFrame, QHeaderView, QListWidget, QTableWidget

from texlab.widgets.own_keys import CopyKey

if TYPE_CHECKING:
    from collections.abc import Callable

    from PySide6.QtWidgets import QWidget

ROW_MARGIN = 2


def make_quiet(table: QTableWidget) -> None:
    """Make a table that is only read: no frame, no grid, columns as wide as their numbers; Tab leaves it."""
    table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    table.setFrameShape(QFrame.Shape.NoFrame)
    table.setShowGrid(False)
    table.setWordWrap(False)
    table.setTabKeyNavigation(False)
    table.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
    table.horizontalHeader().setHighlightSections(False)
    make_copyable(table)


def make_copyable(table: QTableWidget) -> None:
    """Let the table be copied as text, by its context menu and, while it has the keyboard, by its key."""
    add_copying(table, lambda: table_text(table))


def add_copying(widget: QWidget, text: Callable[[], str]) -> None:
    """Let what a widget shows be copied as text: by its context menu, and by its key while it has the keyboard."""
    action = QAction("Copy table as text", widget)
    action.setObjectName("copy-table")
    action.setShortcut(QKeySequence.StandardKey.Copy)
    action.setShortcutContext(Qt.ShortcutContext.WidgetShortcut)
    action.triggered.connect(lambda: QApplication.clipboard().setText(text()))
    widget.addAction(action)
    CopyKey(widget, action)
    widget.setContextMenuPolicy(Qt.ContextMenuPolicy.ActionsContextMenu)


def list_text(listed: QListWidget) -> str:
    """Return the entries that are seen, a line for each; of several selected ones these alone."""
    items = [listed.item(place) for place in range(listed.count())]
    chosen = [item for item in items if item.isSelected()]
    shown = chosen if len(chosen) > 1 else [item for item in items if not item.isHidden()]
    return "".join(f"{' '.join(item.text().split())}\n" for item in shown)


def fit_rows(root: QWidget) -> None:
    """Give the rows of all tables the height of their text: they keep the one that they were made with."""
    for table in root.findChildren(QTableWidget):
        head = table.verticalHeader()
        head.setMinimumSectionSize(0)
        head.setDefaultSectionSize(table.fontMetrics().lineSpacing() + ROW_MARGIN)


def table_text(table: QTableWidget) -> str:
    """Return the cells that are seen with their heads: tabs between columns, a line for each row.

    Where cells are selected (more than one), only their rows are taken.
    """
    columns = [place for place in range(table.columnCount()) if not table.isColumnHidden(place)]
    rows = [place for place in range(table.rowCount()) if not table.isRowHidden(place)]
    selected = {index.row() for index in table.selectedIndexes()}
    if len(selected) > 1:
        rows = [row for row in rows if row in selected]
    named = not table.verticalHeader().isHidden()
    heads = [_text(table.horizontalHeaderItem(column)) for column in columns]
    lines = [["", *heads] if named else heads]
    for row in rows:
        cells = [_text(table.item(row, column)) for column in columns]
        lines.append([_text(table.verticalHeaderItem(row)), *cells] if named else cells)
    return "\n".join("\t".join(line) for line in lines) + "\n"


def _text(item: object) -> str:
    text = getattr(item, "text", None)
    return " ".join(str(text()).split()) if callable(text) else ""
