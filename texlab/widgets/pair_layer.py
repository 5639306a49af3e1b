"""Two pictures in one pane: one key changes between them, a line divides them, or their difference is shown."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QObject, Signal

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.style.pictures import Picture
    from texlab.widgets.image_pane import ImagePane

Mode = Literal["off", "flicker", "swipe", "difference"]
GAINS = (1, 2, 4, 8, 16, 32)
LINE = "#ffd54a"


def difference_picture(one: Picture, other: Picture, gain: float) -> Picture:
    """Return |one - other| times ``gain`` over the part that both have, (h, w, 3) uint8; black is equal.

    Parameters
    ----------
    one, other
        (H, W, 3) uint8.
    gain
        At least 0; what exceeds white stays white.
    """
    rows, columns = (min(sides) for sides in zip(one.shape[:2], other.shape[:2], strict=True))
    first, second = (each[:rows, :columns].astype(np.int16) for each in (one, other))
    found: Picture = np.minimum(np.abs(first - second) * gain, 255).astype(np.uint8)
    return found


class PairLayer(QObject):
    """Lays picture B over the pane of picture A.

    ``changed()`` when another way of comparing is in force. ``compute`` carries a function out in the background
    and hands what it returned to another one.
    """

    changed = Signal()

    def __init__(
        self, compute: Callable[[Callable[[], Any], Callable[[Any], None]], None], parent: QObject
    ) -> None:
        super().__init__(parent)
        self._compute = compute
        self._mode: Mode = "off"
        self.gain = 4
        self._pane: ImagePane | None = None
        self._pictures: tuple[Picture | None, Picture | None] = (None, None)
        self._layer: Any = None
        self._line: Any = None
        self._share = 0.5
        self._asked = 0

    @property
    def mode(self) -> Mode:
        """How the two are compared."""
        return self._mode

    @property
    def layer(self) -> Picture | None:
        """What lies over the picture of A now, (h, w, 3) uint8."""
        return None if self._layer is None or not self._layer.isVisible() else self._layer.image

    @property
    def share(self) -> float:
        """Where the dividing line stands, from 0 at the left edge to 1."""
        return self._share

    def set_mode(self, mode: Mode) -> None:
        """Compare in another way; the same one again ends it."""
        self._mode = "off" if mode == self._mode else mode
        self._update()
        self.changed.emit()

    def set_gain(self, gain: int) -> None:
        """Multiply the difference by this."""
        self.gain = gain
        self._update()

    def show_pair(self, pane: ImagePane | None, a: Picture | None, b: Picture | None) -> None:
        """Compare these pictures, (H, W, 3) uint8, in the pane of A."""
        if pane is self._pane and a is self._pictures[0] and b is self._pictures[1]:
            return
        if pane is not self._pane:
            self._clear()
            self._pane = pane
        self._pictures = a, b
        self._update()

    def forget(self, pane: ImagePane) -> None:
        """Let a pane go before it is deleted."""
        if pane is self._pane:
            self._clear()
            self._pane, self._pictures = None, (None, None)

    def _clear(self) -> None:
        if self._pane is not None and self._layer is not None:
            for item in (self._layer, self._line):
                self._pane.view.removeItem(item)
        self._layer = self._line = None

    def _update(self) -> None:
        self._asked += 1
        a, b = self._pictures
        if self._pane is None or b is None or a is None or self._mode == "off":
            if self._layer is not None:
                self._layer.hide()
                self._line.hide()
            return
        if self._layer is None:
            self._layer = pg.ImageItem(levels=None)
            self._layer.setZValue(5)
            self._line = pg.InfiniteLine(0, movable=True, pen=pg.mkPen(LINE, width=2))
            self._line.setZValue(15)
            self._line.sigPositionChanged.connect(self._slid)
            for item in (self._layer, self._line):
                self._pane.view.addItem(item, ignoreBounds=True)
        self._line.setVisible(self._mode == "swipe")
        if self._mode == "flicker":
            self._show(b, 0)
        elif self._mode == "swipe":
            self._line.setBounds((0, a.shape[1]))
            self._line.setValue(self._share * a.shape[1])
            self._divide()
        else:
            self._ask(a, b)

    def _show(self, picture: Picture, left: int) -> None:
        self._layer.setImage(picture, autoLevels=False, levels=None)
        self._layer.setPos(left, 0)
        self._layer.show()

    def _slid(self) -> None:
        a, _ = self._pictures
        if a is not None and self._mode == "swipe":
            self._share = float(self._line.value()) / a.shape[1]
            self._divide()

    def _divide(self) -> None:
        """Show B to the right of the line."""
        a, b = self._pictures
        assert a is not None
        assert b is not None
        left = round(self._share * a.shape[1])
        if left >= b.shape[1]:
            self._layer.hide()
        else:
            self._show(b[:, left:], left)

    def _ask(self, a: Picture, b: Picture) -> None:
        number, gain = self._asked, self.gain
        self._compute(lambda: (number, difference_picture(a, b, gain)), self._came)

    def _came(self, answer: tuple[int, Picture]) -> None:
        number, picture = answer
        if number == self._asked and self._layer is not None:
            self._show(picture, 0)
