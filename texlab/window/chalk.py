"""A pane of glass over the window: a halo and a spotlight at the pointer, and lines drawn by hand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, QPoint, QPointF, Qt
from PySide6.QtGui import QColor, QCursor, QMouseEvent, QPainter, QPainterPath, QPen, QPolygonF
from PySide6.QtWidgets import QApplication, QWidget

if TYPE_CHECKING:
    from PySide6.QtGui import QPaintEvent

# Parts of the height of the glass.
HALO, SPOT, LINE = 1 / 24, 1 / 6, 1 / 160
# Seen on light and on dark pictures, and told apart from them by the colour-blind.
INK, EDGE = "#ffd400", "#000000"
SHADE = 150


class Chalk(QWidget):
    """Covers its parent; lets the mouse through unless one draws."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("chalk")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAttribute(Qt.WidgetAttribute.WA_NoSystemBackground)
        self.strokes: list[QPolygonF] = []
        self.halo = self.spotlight = False
        self.at = QPointF(-1, -1)
        self._drawing = self._following = False
        parent.installEventFilter(self)
        self.hide()

    @property
    def drawing(self) -> bool:
        """Whether the mouse draws."""
        return self._drawing

    def set_drawing(self, drawing: bool) -> None:
        """Let the mouse draw, or let it through."""
        self._drawing = drawing
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents, not drawing)
        self.setCursor(Qt.CursorShape.CrossCursor if drawing else Qt.CursorShape.ArrowCursor)
        self._refresh()

    def set_halo(self, halo: bool) -> None:
        """Show a ring around the pointer."""
        self.halo = halo
        self._refresh()

    def set_spotlight(self, spotlight: bool) -> None:
        """Darken everything but what is around the pointer."""
        self.spotlight = spotlight
        self._refresh()

    def undo(self) -> None:
        """Take the last line back."""
        if self.strokes:
            self.strokes.pop()
        self._refresh()

    def clear(self) -> None:
        """Wipe all lines away."""
        self.strokes.clear()
        self._refresh()

    def put_away(self) -> None:
        """Take everything off the window."""
        self.halo = self.spotlight = False
        self.strokes.clear()
        self.set_drawing(False)

    def _refresh(self) -> None:
        wanted = self._drawing or self.halo or self.spotlight or bool(self.strokes)
        follows = self.halo or self.spotlight
        application = QApplication.instance()
        if application is not None and follows != self._following:
            self._following = follows
            if follows:
                application.installEventFilter(self)
                self.at = QPointF(self.mapFromGlobal(QCursor.pos()))
            else:
                application.removeEventFilter(self)
        self._cover()
        self.setVisible(wanted)
        self.raise_()
        self.update()

    def _cover(self) -> None:
        parent = self.parentWidget()
        if parent is not None:
            self.setGeometry(parent.rect())

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Cover the parent at any size, and follow the pointer wherever it is."""
        if watched is self.parentWidget() and event.type() == QEvent.Type.Resize:
            self._cover()
        if self._following and isinstance(event, QMouseEvent) and event.type() == QEvent.Type.MouseMove:
            self.at = QPointF(self.mapFromGlobal(event.globalPosition().toPoint()))
            self.update()
        return False

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Begin a line."""
        self.strokes.append(QPolygonF([event.position(), event.position() + QPoint(0, 1)]))
        self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Go on with it."""
        if event.buttons() & Qt.MouseButton.LeftButton and self.strokes:
            self.strokes[-1].append(event.position())
            self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        """Paint shade, ring and lines."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        high = self.height()
        if self.spotlight:
            shade = QPainterPath()
            shade.addRect(self.rect())
            shade.addEllipse(self.at, high * SPOT, high * SPOT)
            painter.fillPath(shade, QColor(0, 0, 0, SHADE))
        for colour, width in ((EDGE, 1.8 * high * LINE), (INK, high * LINE)):
            pen = QPen(QColor(colour), width)
            pen.setCapStyle(Qt.PenCapStyle.RoundCap)
            pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
            painter.setPen(pen)
            for stroke in self.strokes:
                painter.drawPolyline(stroke)
            if self.halo:
                painter.drawEllipse(self.at, high * HALO, high * HALO)
        painter.end()
