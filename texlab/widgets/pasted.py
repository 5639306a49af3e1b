"""A picture that another program handed over: shared at once, made an array of in the background."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PySide6.QtGui import QImage

# Qt keeps Python's lock while it converts: that must be short.
_BAND_PIXELS = 2**18


@dataclass(frozen=True, eq=False)
class Pasted:
    """A picture of the clipboard or of a drop; its pixels are shared with whoever made it, not copied."""

    image: QImage
    name: str = "pasted image"


def pixels_of(image: QImage) -> NDArray[Any]:
    """Return the pixels of a picture, band by band; meant for a worker's thread.

    Returns
    -------
    (H, W, 3) or with transparency (H, W, 4); uint16 where the picture has more than 8 bits, else uint8.
    """
    from PySide6.QtGui import QImage

    kinds = QImage.Format
    fine = {kinds.Format_Grayscale16, kinds.Format_RGB30, kinds.Format_BGR30}
    fine |= {kinds.Format_A2RGB30_Premultiplied, kinds.Format_A2BGR30_Premultiplied}
    is_deep = image.depth() > 32 or image.format() in fine
    kind, dtype = (kinds.Format_RGBA64, np.uint16) if is_deep else (kinds.Format_RGBA8888, np.uint8)
    height, width = image.height(), image.width()
    samples = 4 if image.hasAlphaChannel() else 3
    pixels = np.empty((height, width, samples), dtype)
    rows = max(1, _BAND_PIXELS // max(width, 1))
    for top in range(0, height, rows):
        band = image.copy(0, top, width, min(rows, height - top)).convertToFormat(kind)
        lines = np.frombuffer(band.constBits(), np.uint8).reshape(band.height(), band.bytesPerLine())
        used = np.ascontiguousarray(lines[:, : width * 4 * np.dtype(dtype).itemsize]).view(dtype)
        pixels[top : top + rows] = used.reshape(-1, width, 4)[..., :samples]
    return pixels
