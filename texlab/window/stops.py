"""Where Tab goes: through what is seen, in the order of the eye, with a ring around what has the keyboard."""

from __future__ import annotations

from typing import TYPE_CHECKING

import shiboken6
from PySide6.QtCore import QEvent, QObject, QPoint, QRect, Qt
from PySide6.QtGui import QColor, QPainter, QPen
from PySide6.QtWidgets import QDockWidget, QScrollArea, QTabBar, QWidget

from texlab.widgets.once import Once

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from PySide6.QtGui import QPaintEvent


_BY_TAB = Qt.FocusPolicy.TabFocus.value


def is_seen(widget: QWidget) -> bool:
    """Return whether any part of a widget can be seen, if need be after scrolling.

    Qt calls a dock behind another tab visible, too; nothing of it is painted.
    """
    if not widget.isVisible():
        return False
    if not widget.visibleRegion().isEmpty():
        return True
    area = _area_around(widget)
    if area is None:
        return False
    viewport = area.viewport()
    # What lies in the part that is scrolled to and is not painted has something else over it.
    inside = viewport.rect().intersects(QRect(widget.mapTo(viewport, QPoint()), widget.size()))
    return not inside and is_seen(area)


def is_stop(widget: QWidget) -> bool:
    """Return whether Tab may stop at a widget."""
    # Many are asked: what is quickly known comes first.
    if not (widget.isVisible() and widget.focusPolicy().value & _BY_TAB and widget.isEnabled()):
        return False
    # The arrows of a tab bar are for the mouse: the keyboard has the bar itself.
    return widget.focusProxy() is None and not isinstance(widget.parentWidget(), QTabBar) and is_seen(widget)


def stops(window: QWidget, order: Sequence[QWidget]) -> list[QWidget]:
    """Return where Tab stops in a window: part after part in this order, then what lies in none of them."""

    def place(widget: QWidget) -> int:
        return next((k for k, part in enumerate(order) if part is widget or part.isAncestorOf(widget)), len(order))

    # Asking Qt for its chain of focus, widget by widget, makes Python take living objects for deleted ones.
    return sorted(filter(is_stop, _shown_within(window)), key=place)


def _shown_within(widget: QWidget) -> Iterator[QWidget]:
    """Yield what a widget shows, also after scrolling, and nothing of tabs behind another one."""
    for child in widget.findChildren(QWidget, options=Qt.FindChildOption.FindDirectChildrenOnly):
        if child.isVisible() and not child.isWindow():
            yield child
            if not (isinstance(child, QDockWidget) and child.visibleRegion().isEmpty()):
                yield from _shown_within(child)


def next_stop(window: QWidget, order: Sequence[QWidget], *, forward: bool) -> QWidget | None:
    """Return the stop after (or before) what has the keyboard, scrolled into sight."""
    found = stops(window, order)
    if not found:
        return None
    here = window.focusWidget()
    if here in found:
        wanted = found[(found.index(here) + (1 if forward else -1)) % len(found)]
    else:
        wanted = found[0 if forward else -1]
    area = _area_around(wanted)
    while area is not None:
        area.ensureWidgetVisible(wanted)
        area = _area_around(area)
    return wanted


def _area_around(widget: QWidget) -> QScrollArea | None:
    parent = widget.parentWidget()
    while parent is not None:
        if isinstance(parent, QScrollArea):
            return parent
        parent = parent.parentWidget()
    return None


class FocusRing(QWidget):
    """A frame around what Tab has reached, whatever it paints itself."""

    def __init__(self, window: QWidget) -> None:
        super().__init__(window)
        self.setObjectName("focus-ring")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.colour = QColor("#0b62b0")
        self.around: QWidget | None = None
        self._wanted: QWidget | None = None
        self._soon = Once(self, 0, self._show_wanted)
        self.hide()

    def show_around(self, widget: QWidget) -> None:
        """Frame a widget until it loses the keyboard, as soon as the events of now are over.

        Qt hands the keyboard on also while it hides a window part by part: nothing may be raised then.
        """
        self._wanted = widget
        self._soon.start()

    def _show_wanted(self) -> None:
        widget, self._wanted = self._wanted, None
        self._let_go()
        if widget is None or not shiboken6.isValid(widget) or not (widget.isVisible() and widget.hasFocus()):
            return
        self.around = widget
        widget.installEventFilter(self)
        self._place()
        self.show()
        self.raise_()

    def _let_go(self) -> None:
        if self.around is not None and shiboken6.isValid(self.around):
            self.around.removeEventFilter(self)
        self.around = None
        self.hide()

    def _place(self) -> None:
        if self.around is not None:
            corner = self.around.mapTo(self.window(), QPoint(0, 0))
            self.setGeometry(QRect(corner, self.around.size()).adjusted(-2, -2, 2, 2))

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Follow the widget, and go when the keyboard or the mouse goes elsewhere."""
        if event.type() in (QEvent.Type.FocusOut, QEvent.Type.Hide, QEvent.Type.MouseButtonPress):
            self._let_go()
        elif event.type() in (QEvent.Type.Move, QEvent.Type.Resize):
            self._place()
        return super().eventFilter(watched, event)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the frame."""
        painter = QPainter(self)
        painter.setPen(QPen(self.colour, 2))
        painter.drawRoundedRect(self.rect().adjusted(1, 1, -1, -1), 3, 3)
