"""The title of a panel beside large text: the style's own has buttons of one size, whatever its text has."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, QSize, Qt
from PySide6.QtGui import QPainter, QPalette, QPen
from PySide6.QtWidgets import QAbstractButton, QDockWidget, QHBoxLayout, QSizePolicy, QWidget

from texlab.style.text_size import follow_text, text_scale
from texlab.widgets.once import Once
from texlab.widgets.plain import ShortLabel, set_tip

if TYPE_CHECKING:
    from PySide6.QtGui import QPaintEvent

# Pixels across a button beside text of the usual size, and the scale from which it is larger than the style's own.
SIDE, FROM = 14, 1.3
# Around the title: large text has room enough above and below by itself.
MARGINS = (8, 0, 4, 0)
# The lines of the signs in a square of 16.
CLOSE = (((4, 4), (12, 12)), ((12, 4), (4, 12)))
FLOAT = (((3, 6), (10, 6), (10, 13), (3, 13), (3, 6)), ((6, 6), (6, 3), (13, 3), (13, 10), (10, 10)))


class SignButton(QAbstractButton):
    """A button with a sign, as large as the text beside it."""

    def __init__(self, name: str, tip: str, sign: tuple[tuple[tuple[int, int], ...], ...]) -> None:
        super().__init__()
        self.setObjectName(name)
        self.setAccessibleName(tip)
        set_tip(self, tip)
        self._sign = sign
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)

    def sizeHint(self) -> QSize:
        """Return a square."""
        side = round(SIDE * text_scale(self))
        return QSize(side, side)

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint the sign."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.underMouse() or self.isDown():
            painter.fillRect(self.rect(), self.palette().color(QPalette.ColorRole.Button))
        painter.scale(self.width() / 16, self.height() / 16)
        painter.setPen(QPen(self.palette().color(QPalette.ColorRole.WindowText), 1.4))
        for line in self._sign:
            painter.drawPolyline([QPointF(*each) for each in line])
        painter.end()


class TitleBar(QWidget):
    """A dock's title with buttons that let it float and close it; the rest is what the dock is dragged by."""

    def __init__(self, dock: QDockWidget) -> None:
        super().__init__(dock)
        self.setAccessibleName(f"Title of {dock.windowTitle()}")
        self.title = ShortLabel(dock.windowTitle())
        dock.windowTitleChanged.connect(self.title.setText)
        self.float_button = SignButton("title-float", "Let this panel float, or put it back", FLOAT)
        self.float_button.clicked.connect(lambda: dock.setFloating(not dock.isFloating()))
        self.close_button = SignButton("title-close", "Close this panel", CLOSE)
        self.close_button.clicked.connect(dock.close)
        row = QHBoxLayout(self)
        row.setContentsMargins(*MARGINS)
        row.addWidget(self.title, 1)
        row.addWidget(self.float_button)
        row.addWidget(self.close_button)


def grow_title(dock: QDockWidget) -> None:
    """Give a dock a title with larger buttons while its text is large."""

    def choose() -> None:
        bar, wanted = dock.titleBarWidget(), text_scale(dock) >= FROM
        if wanted == (bar is not None):
            return
        dock.setTitleBarWidget(TitleBar(dock) if wanted else None)  # type: ignore[arg-type]  # None is the style's
        if bar is not None:
            bar.deleteLater()

    # Text changes while widgets are walked: none must come or go then.
    soon = Once(dock, 0, choose)
    follow_text(dock, soon.start)
