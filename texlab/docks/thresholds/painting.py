"""Colours and glyphs of threshold tables."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPen, QPolygonF

from texlab.docks.thresholds.table import SoftLog
from texlab.style.colouring import QUIET_TABLES, paint

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtGui import QPainter

    from texlab.style.theme import Theme
    from texlab_core.methods.de_bonet.features import Feature

# Thresholds of use lie between 0.01 and 4; what is larger lets everything through.
SCALE = SoftLog(0.02, 4.0)
ROOM_FOR_LOCK = 30.0
CHANNEL_COLOURS = {"red": "#d5453b", "green": "#2f9e52", "blue": "#3f7fe0"}


def colours(values: NDArray[np.float64], theme: Theme) -> NDArray[np.uint8]:
    """Return the colour of every threshold, (..., 3) uint8: what the theme's text can be read on."""
    return shades(SCALE.place(values), theme)


def shades(shares: NDArray[np.float64], theme: Theme) -> NDArray[np.uint8]:
    """Return the colours of shares 0 .. 1, (..., 3) uint8: what the theme's text can be read on."""
    return paint(shares.astype(np.float32), QUIET_TABLES[theme.name])


@lru_cache(maxsize=1024)
def cell_colour(red: int, green: int, blue: int) -> QColor:
    """Return the colour of a cell."""
    return QColor(red, green, blue)


def draw_glyph(painter: QPainter, feature: Feature, area: QRectF, colour: QColor) -> None:
    """Draw what a feature answers to: a ring for the band, an edge or a line across the derivative's direction."""
    side = min(area.width(), area.height())
    if side < 6:
        return
    disc = QRectF(0, 0, side, side)
    disc.moveCenter(area.center())
    painter.save()
    painter.setRenderHint(painter.RenderHint.Antialiasing)
    painter.setPen(QPen(colour, 1))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawEllipse(disc)
    # Qt's angles are counter-clockwise from the right too; an edge lies across the derivative.
    if feature.kind == "first":
        painter.setBrush(colour)
        painter.drawPie(disc, round(16 * (feature.angle - 90)), 16 * 180)
    elif feature.kind in ("second", "oriented"):
        painter.translate(disc.center())
        painter.rotate(-(feature.angle + 90))
        painter.fillRect(QRectF(-side / 2, -side / 8, side, side / 4), colour)
    else:
        inner = disc.adjusted(side / 3, side / 3, -side / 3, -side / 3)
        painter.setBrush(colour)
        painter.drawEllipse(inner)
    painter.restore()


def draw_corner(painter: QPainter, area: QRectF, colour: QColor) -> None:
    """Mark a cell that was set by hand: a triangle in its upper right corner."""
    side = min(7.0, area.width() / 2, area.height() / 2)
    corner = area.topRight()
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    painter.drawPolygon(QPolygonF([corner, corner - QPointF(side, 0), corner + QPointF(0, side)]))


def draw_lock(painter: QPainter, area: QRectF, colour: QColor) -> None:
    """Mark a locked cell: a padlock in its lower left corner, or a bar where that would hide the number."""
    if area.width() < ROOM_FOR_LOCK:
        painter.fillRect(QRectF(area.left(), area.bottom() - 3, area.width(), 3), colour)
        return
    body = QRectF(area.left() + 2, area.bottom() - 7, 7, 5)
    painter.fillRect(body, colour)
    painter.setPen(QPen(colour, 1.2))
    painter.drawArc(QRectF(body.left() + 1.2, body.top() - 3.5, 4.6, 7), 0, 16 * 180)
