"""A heading over a view."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSize
from PySide6.QtWidgets import QSizePolicy, QVBoxLayout, QWidget

if TYPE_CHECKING:
    from texlab.widgets.plain import Label

SLACK = 4


class _Headed(QWidget):
    def __init__(self, title: Label) -> None:
        super().__init__()
        self._title = title

    def minimumSizeHint(self) -> QSize:
        """Have room for the widest word of the heading: words are not broken."""
        metrics = self._title.fontMetrics()
        widest = max((metrics.horizontalAdvance(word) for word in self._title.text().split()), default=0)
        return super().minimumSizeHint().expandedTo(QSize(widest + SLACK, 0))


def headed(title: Label, view: QWidget) -> QWidget:
    """Put a heading over a view; it takes more lines where it is wider than the view."""
    title.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Minimum)
    title.setWordWrap(True)
    part = _Headed(title)
    column = QVBoxLayout(part)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(1)
    column.addWidget(title)
    column.addWidget(view, 1)
    return part
