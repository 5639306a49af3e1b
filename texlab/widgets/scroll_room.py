"""Room for what a tab shows: where large text leaves too little of it, what is shown can be scrolled."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QSize, Qt, Signal
from PySide6.QtWidgets import QBoxLayout, QFrame, QScrollArea, QSizePolicy, QStyle

from texlab.style.text_size import is_teaching
from texlab.widgets.plain import Label, MarkupLabel, ShortLabel

if TYPE_CHECKING:
    from PySide6.QtGui import QResizeEvent
    from PySide6.QtWidgets import QLayoutItem, QWidget

# Up to these parts of the window's width and height a tab has the room that it asks for, when one teaches.
MOST = (0.6, 0.3)


class ScrollRoom(QScrollArea):
    """Holds one widget, which is as large as the room; when one teaches, as it has to be at least, and scrolls.

    ``asked()`` when what is inside asks for other room.
    """

    asked = Signal()

    def __init__(self, inner: QWidget, name: str) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setFrameShape(QFrame.Shape.NoFrame)
        # The parts inside have the keyboard.
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.viewport().setAutoFillBackground(False)
        self.setWidget(inner)
        inner.setAutoFillBackground(False)
        inner.installEventFilter(self)

    def sizeHint(self) -> QSize:
        """Return what is asked for inside."""
        inner = self.widget()
        return super().sizeHint() if inner is None else inner.sizeHint()

    def minimumSizeHint(self) -> QSize:
        """Return what is needed inside; when one teaches, no more than a part of the window."""
        inner = self.widget()
        if inner is None:
            return super().minimumSizeHint()
        needed = inner.minimumSizeHint().expandedTo(inner.minimumSize())
        if not is_teaching():
            return needed
        window = self.window().size()
        return needed.boundedTo(QSize(int(MOST[0] * window.width()), int(MOST[1] * window.height())))

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Give what is inside the room."""
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        # Qt's own way would give words that take several lines the height that they like best.
        inner = self.widget()
        if inner is None:
            return
        room = self.maximumViewportSize()
        if not is_teaching():
            inner.resize(room)
            return
        bar = self.style().pixelMetric(QStyle.PixelMetric.PM_ScrollBarExtent)
        needed = self.needed(room.width())
        across = needed.width() > room.width()
        if needed.height() > room.height() - bar * across:
            room -= QSize(bar, 0)
            # Narrower words take more lines.
            needed = self.needed(room.width())
            across = needed.width() > room.width()
        room -= QSize(0, bar * across)
        inner.resize(needed.expandedTo(room))

    def needed(self, width: int) -> QSize:
        """Return what is needed inside so that nothing scrolls in a room of this width; it may be wider."""
        inner = self.widget()
        if inner is None:
            return QSize()
        needed = inner.minimumSizeHint().expandedTo(inner.minimumSize())
        layout = inner.layout()
        if layout is not None and layout.hasHeightForWidth():
            # Words take more lines than the least that they say they need.
            needed = needed.expandedTo(QSize(0, least_height(layout, max(needed.width(), width))))
        return needed

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Ask for other room when what is inside does."""
        if event.type() == QEvent.Type.LayoutRequest and watched is self.widget():
            self.updateGeometry()
            self._fit()
            self.asked.emit()
        return super().eventFilter(watched, event)


def least_height(item: QLayoutItem, width: int) -> int:
    """Return the least height at which all words of a part have their lines; pictures and plots take the least.

    Qt has only ``QLayout.minimumHeightForWidth``, which gives pictures the height that they like best.
    """
    if item.isEmpty():
        return 0
    least = item.minimumSize().height()
    widget = item.widget()
    if widget is not None:
        inner = widget.layout()
        if inner is not None and inner.hasHeightForWidth():
            return max(least, least_height(inner, width))
        has_lines = isinstance(widget, Label | MarkupLabel) and not isinstance(widget, ShortLabel)
        return max(least, item.heightForWidth(width) if has_lines else 0)
    if not isinstance(item, QBoxLayout):
        return least
    margins = item.contentsMargins()
    width -= margins.left() + margins.right()
    parts = [each for place in range(item.count()) if (each := item.itemAt(place)) is not None]
    shown = [each for each in parts if not each.isEmpty()]
    if item.direction() == QBoxLayout.Direction.TopToBottom:
        needed = _least_below_each_other(shown, width) + item.spacing() * (len(shown) - 1)
    else:
        # Side by side each has the width that it was given last.
        widths = (min(each.geometry().width() or width, width) for each in shown)
        needed = max(map(least_height, shown, widths), default=0)
    return max(least, needed + margins.top() + margins.bottom())


def _least_below_each_other(items: list[QLayoutItem], width: int) -> int:
    leasts = [least_height(each, width) for each in items]
    wanted = [each.heightForWidth(width) if each.hasHeightForWidth() else 0 for each in items]
    # Where Qt has too little it cuts the highest parts down to one height, which must leave all words whole.
    whole = max((least for least, want in zip(leasts, wanted, strict=True) if want <= least), default=0)
    return sum(max(least, min(want, whole)) for least, want in zip(leasts, wanted, strict=True))
