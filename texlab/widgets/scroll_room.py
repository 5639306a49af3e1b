"""Room for what a tab shows: where large text leaves too little of it, what is shown can be scrolled."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QSize, Qt
from PySide6.QtWidgets import QFrame, QScrollArea, QSizePolicy, QStyle

from texlab.style.text_size import is_teaching

if TYPE_CHECKING:
    from PySide6.QtGui import QResizeEvent
    from PySide6.QtWidgets import QWidget

# Up to these parts of the window's width and height a tab has the room that it asks for, when one teaches.
MOST = (0.6, 0.3)


class ScrollRoom(QScrollArea):
    """Holds one widget, which is as large as the room; when one teaches, as it has to be at least, and scrolls."""

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
        needed = inner.minimumSizeHint().expandedTo(inner.minimumSize())
        bar = self.style().pixelMetric(QStyle.PixelMetric.PM_ScrollBarExtent)
        down = needed.height() > room.height()
        across = needed.width() > room.width() - bar * down
        down = down or needed.height() > room.height() - bar * across
        room -= QSize(bar * down, bar * across)
        layout = inner.layout()
        if layout is not None and layout.hasHeightForWidth():
            # Words take more lines than the least that they say they need.
            lines = layout.minimumHeightForWidth(max(needed.width(), room.width() - bar * (not down)))
            needed = needed.expandedTo(QSize(0, lines))
        if needed.height() > room.height() and not down:
            room -= QSize(bar, 0)
        inner.resize(needed.expandedTo(room))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Ask for other room when what is inside does."""
        if event.type() == QEvent.Type.LayoutRequest and watched is self.widget():
            self.updateGeometry()
            self._fit()
        return super().eventFilter(watched, event)
