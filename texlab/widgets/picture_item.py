"""A picture in a view, of which no more is prepared for painting than can be seen."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QRectF

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab.style.pictures import Picture

# Pictures with no more pixels are prepared whole.
SMALL = 2**21
# Around what is seen, in shares of its sides: small moves need nothing new.
MARGIN = 0.5

Part = tuple[int, int, int, int, int]


class PictureItem(pg.ImageItem):  # type: ignore[misc]  # pyqtgraph has no types
    """Shows an (H, W, 3 or 4) uint8 picture in its own pixels, whatever part and reduction of it is prepared."""

    def __init__(self) -> None:
        super().__init__(levels=None)
        self._whole: Picture | None = None
        self._part: Part | None = None
        self._table: NDArray[np.uint8] | None = None

    @property
    def part(self) -> Part | None:
        """Top, left, bottom, right and step of what is prepared; None for all of a small picture, or none."""
        return self._part

    @property
    def whole(self) -> Picture | None:
        """All of what is shown."""
        return self._whole

    def show_picture(
        self, picture: Picture | None, seen: QRectF, pixel: float, table: NDArray[np.uint8] | None = None
    ) -> None:
        """Show a picture, or nothing.

        Parameters
        ----------
        picture
            (H, W, 3) uint8, or (H, W, 4) with how much it covers, or None.
        seen
            What can be seen, in pixels of the picture.
        pixel
            Pixels of the picture to one of the screen.
        table
            As which level every level is painted, (256,) uint8; None paints them as they are.
        """
        self._whole, self._part, self._table = picture, None, table
        self.resetTransform()
        if picture is None:
            self.clear()
            # What was rendered is as large as what is shown.
            self.qimage = None
        elif picture.shape[0] * picture.shape[1] <= SMALL:
            self._prepare(picture)
        else:
            self.look(seen, pixel)

    def look(self, seen: QRectF, pixel: float) -> None:
        """Prepare what is seen now, unless it is prepared already."""
        picture = self._whole
        if picture is None or picture.shape[0] * picture.shape[1] <= SMALL:
            return
        height, width = picture.shape[:2]
        # Two samples to a pixel of the screen: the painter smooths what is reduced.
        step = 1 << max(0, int(np.floor(np.log2(max(pixel, 1.0)))) - 1)
        whole = QRectF(0, 0, width, height)
        wanted = seen.intersected(whole)
        if wanted.isEmpty():
            wanted = QRectF(0, 0, 1, 1)
        if self._part is not None and self._part[4] == step:
            top, left, bottom, right, _ = self._part
            if QRectF(left, top, right - left, bottom - top).contains(wanted):
                return
        down, across = wanted.height() * MARGIN, wanted.width() * MARGIN
        around = wanted.adjusted(-across, -down, across, down).intersected(whole)
        top, left = (int(around.top()) // step * step, int(around.left()) // step * step)
        bottom = min(height, -(-int(np.ceil(around.bottom())) // step) * step)
        right = min(width, -(-int(np.ceil(around.right())) // step) * step)
        self._part = top, left, bottom, right, step
        shown = np.ascontiguousarray(picture[top:bottom:step, left:right:step])
        self._prepare(shown)
        # The last sample of a row stands for as many pixels as the others.
        self.setRect(QRectF(left, top, shown.shape[1] * step, shown.shape[0] * step))

    def _prepare(self, shown: Picture) -> None:
        self.setImage(shown if self._table is None else self._table[shown], autoLevels=False, levels=None)
