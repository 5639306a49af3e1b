"""A heading over a view."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QSizePolicy, QVBoxLayout, QWidget

if TYPE_CHECKING:
    from texlab.widgets.plain import Label


def headed(title: Label, view: QWidget) -> QWidget:
    """Put a heading over a view; it takes no width of its own, and more lines where it is wider than the view."""
    title.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Minimum)
    title.setWordWrap(True)
    part = QWidget()
    column = QVBoxLayout(part)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(1)
    column.addWidget(title)
    column.addWidget(view, 1)
    return part
