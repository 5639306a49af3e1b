"""A heading over a view."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSize
from PySide6.QtWidgets import QSizePolicy, QVBoxLayout, QWidget

from texlab.style.text_size import is_teaching

if TYPE_CHECKING:
    from PySide6.QtGui import QResizeEvent

    from texlab.widgets.plain import Label

SLACK = 4
GAP = 1


class Headed(QWidget):
    """Has a heading over a view, and room for all of both.

    Parameters
    ----------
    title
        The heading, which takes several lines where it is wider than the view.
    views
        What is under it, side by side.
    """

    def __init__(self, title: Label, *views: QWidget) -> None:
        super().__init__()
        # The heading changes with what is shown; the view has a name of its own from the beginning.
        self.setAccessibleName(next(filter(None, (each.accessibleName() for each in views)), title.text()))
        self._title = title
        self._views = views
        self._lines = 0

    def minimumSizeHint(self) -> QSize:
        """Have room for the widest word of the heading: none is broken; in Teach for all its lines."""
        metrics = self._title.fontMetrics()
        widest = max((metrics.horizontalAdvance(word) for word in self._title.text().split()), default=0)
        needed = super().minimumSizeHint().expandedTo(QSize(widest + SLACK, 0))
        if is_teaching():
            # As for Qt, a least size that was given counts instead of what a view says.
            least = (each.minimumHeight() or each.minimumSizeHint().height() for each in self._views)
            lines = self._title.heightForWidth(max(self.width(), needed.width()))
            needed = needed.expandedTo(QSize(0, lines + GAP + max(least, default=0)))
        return needed

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Ask for other room where the heading takes other lines."""
        super().resizeEvent(event)
        lines = self._title.heightForWidth(self.width())
        if is_teaching() and lines != self._lines:
            self._lines = lines
            self.updateGeometry()


def headed(title: Label, view: QWidget) -> QWidget:
    """Put a heading over a view; it takes more lines where it is wider than the view."""
    title.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Minimum)
    title.setWordWrap(True)
    part = Headed(title, view)
    column = QVBoxLayout(part)
    column.setContentsMargins(0, 0, 0, 0)
    column.setSpacing(GAP)
    column.addWidget(title)
    column.addWidget(view, 1)
    return part
