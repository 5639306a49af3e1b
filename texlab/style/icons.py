"""Icons of the tools: drawn once as SVG, painted in the colours of the theme, sharp at any scale of the screen."""

from __future__ import annotations

import functools
from typing import TYPE_CHECKING

from PySide6.QtCore import QByteArray, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QIcon, QImage, QPainter, QPixmap

from texlab_core.files.resources import resource

if TYPE_CHECKING:
    from texlab.style.theme import Theme

# Pixels of the screen per logical pixel for which there are pictures; those between are made smaller.
RATIOS = (1, 2, 3)
# Share of its colour that a tool has while it cannot be used.
PALE = 0.35
# The largest side of which icons are kept.
MOST_KEPT = 32
_ROLES = {"run-all": "good", "stop-all": "error"}


def tool_icon(name: str, theme: Theme, side: int) -> QIcon:
    """Return the icon of a tool.

    Parameters
    ----------
    name
        A file of the resources ``icons/tools`` without its suffix.
    theme
        Gives the colour.
    side
        Width and height in logical pixels.

    Raises
    ------
    OSError
        When there is no such file.
    """
    drawing = resource(f"icons/tools/{name}.svg").read_text(encoding="utf-8")
    colour = QColor(getattr(theme, _ROLES.get(name, "text"))).name()
    icon = QIcon()
    # Large ones are rare, and one takes as much as ten others.
    paint = _painted if side <= MOST_KEPT else _painted.__wrapped__
    for mode, share in ((QIcon.Mode.Normal, 1.0), (QIcon.Mode.Disabled, PALE)):
        for ratio in RATIOS:
            icon.addPixmap(QPixmap.fromImage(paint(drawing, colour, side, ratio, share)), mode)
    return icon


# Every window paints the same ones; images, since pixmaps must not outlive the application.
@functools.lru_cache(maxsize=128)
def _painted(drawing: str, colour: str, side: int, ratio: int, share: float) -> QImage:
    from PySide6.QtSvg import QSvgRenderer

    renderer = QSvgRenderer(QByteArray(drawing.replace("currentColor", colour).encode()))
    image = QImage(QSize(side, side) * ratio, QImage.Format.Format_ARGB32_Premultiplied)
    image.fill(Qt.GlobalColor.transparent)
    painter = QPainter(image)
    painter.setOpacity(share)
    renderer.render(painter, QRectF(image.rect()))
    painter.end()
    image.setDevicePixelRatio(ratio)
    return image


def application_icon() -> QIcon:
    """Return the program's icon."""
    pixmap = QPixmap()
    try:
        pixmap.loadFromData(resource("icons/texlab.png").read_bytes())
    except (OSError, ValueError):
        pixmap = QPixmap(QSize(32, 32))
        pixmap.fill(Qt.GlobalColor.darkCyan)
    return QIcon(pixmap)
