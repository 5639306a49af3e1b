"""What a widget paints, kept as lines and letters: painted later at any size, and written as SVG in any thread."""

from __future__ import annotations

import contextlib
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import escape

from PySide6.QtCore import QBuffer, QIODevice, QPoint, QRect, QSize
from PySide6.QtGui import QPainter, QPicture
from PySide6.QtWidgets import QGraphicsView, QWidget

from texlab.style.theme import configure_pyqtgraph

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

_SIDES = re.compile(rb'width="[^"]*" height="[^"]*"')


@dataclass(frozen=True, eq=False)
class Recording:
    """What a widget has painted.

    Parameters
    ----------
    picture
        Its strokes, letters and pictures, in pixels of the widget.
    size
        Of the widget, in pixels.
    dots
        Pixels of the widget to the inch: letters are measured in points.
    title
        What it is called.
    width
        How wide it is to be shown, in pixels.
    """

    picture: QPicture
    size: QSize
    dots: int
    title: str
    width: int

    def svg(self, texts: Mapping[str, str]) -> bytes:
        """Return it as the bytes of an SVG file: letters are text, pictures keep the pixels that they have.

        Parameters
        ----------
        texts
            By key; they become the file's metadata.
        """
        # Loaded when it is needed: few ever ask for it.
        from PySide6.QtSvg import QSvgGenerator

        from texlab_core.files.strict_json import packed

        into = QBuffer()
        into.open(QIODevice.OpenModeFlag.WriteOnly)
        # The first version of the standard that can cut off what lies outside of a plot.
        generator = QSvgGenerator(QSvgGenerator.SvgVersion.Svg11)
        generator.setOutputDevice(into)
        generator.setTitle(self.title)
        generator.setDescription("TexLab")
        generator.setResolution(self.dots)
        generator.setSize(self.size)
        generator.setViewBox(QRect(QPoint(0, 0), self.size))
        painter = QPainter(generator)
        painter.drawPicture(0, 0, self.picture)
        painter.end()
        height = max(round(self.size.height() * self.width / max(self.size.width(), 1)), 1)
        sides = f'width="{self.width}" height="{height}"'.encode()
        data = _SIDES.sub(sides, bytes(into.data().data()), count=1)
        metadata = f"<metadata>{escape(packed(dict(texts)))}</metadata>\n".encode()
        return data.replace(b"<title>", metadata + b"<title>", 1)


def recorded(widget: QWidget, title: str, width: int) -> Recording:
    """Return what a widget paints now, in its own thread; see :class:`Recording`."""
    picture = QPicture()
    painter = QPainter(picture)
    painter.fillRect(widget.rect(), widget.palette().window())
    with painted_anew(widget, 1.0):
        widget.render(painter, QPoint(0, 0))
    painter.end()
    return Recording(picture, widget.size(), widget.logicalDpiX(), title, width)


@contextlib.contextmanager
def painted_anew(widget: QWidget, factor: float) -> Iterator[None]:
    """Let plots paint everything again, where they otherwise put down pictures made for the screen.

    Parameters
    ----------
    widget
        With plots inside.
    factor
        How many times as large as on the screen it is painted.
    """
    pg = configure_pyqtgraph()
    views = widget.findChildren(QGraphicsView)
    modes = [view.cacheMode() for view in views]
    items: list[Any] = [item for view in views for item in view.scene().items()]
    points = [item for item in items if isinstance(item, pg.ScatterPlotItem)]
    try:
        for view in views:
            view.setCacheMode(QGraphicsView.CacheModeFlag.CacheNone)
        for item in points:
            item.setExportMode(True, {"resolutionScale": factor})
        yield
    finally:
        for item in points:
            item.setExportMode(False)
        for view, mode in zip(views, modes, strict=True):
            view.setCacheMode(mode)
