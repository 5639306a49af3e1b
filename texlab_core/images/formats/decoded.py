"""What every reader of image files returns, and what all of them do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from texlab_core.engine.job import MAX_PIXELS
from texlab_core.errors import ImageError

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Decoded:
    """An image as its file has it, upright and in sRGB.

    Parameters
    ----------
    values
        (H, W, C), C = 1 gray, 2 gray and alpha, 3 RGB, 4 RGB and alpha; unsigned integers or floats.
    peak
        The integer that means 1; None for floats and signed integers, whose range means nothing by itself.
    notes
        What was converted, one sentence each.
    premultiplied
        Colours are multiplied by alpha already.
    """

    values: NDArray[Any]
    peak: int | None
    notes: tuple[str, ...] = ()
    premultiplied: bool = False


def check_pixels(width: int, height: int, name: str) -> None:
    """Refuse what is empty or larger than 64 megapixels."""
    if width < 1 or height < 1:
        raise ImageError(f"{name}: the image is empty ({width} x {height} pixels).")
    if width * height > MAX_PIXELS:
        raise ImageError(
            f"{name}: the image has {width} x {height} pixels; at most {MAX_PIXELS // 2**20} megapixels are read, "
            "as in 8192 x 8192."
        )


def oriented(values: NDArray[Any], orientation: int, notes: list[str]) -> NDArray[Any]:
    """Turn an image upright: TIFF 6.0, tag 274; values that the standard does not know change nothing."""
    if orientation not in range(2, 9):
        return values
    notes.append(f"The image was turned upright (EXIF orientation {orientation}).")
    if orientation >= 5:
        values = values.swapaxes(0, 1)
    # Rows of the file start at the visual bottom in 3, 4, 7, 8 and at the visual right in 2, 3, 6, 7.
    rows = slice(None, None, -1) if orientation in (3, 4, 7, 8) else slice(None)
    columns = slice(None, None, -1) if orientation in (2, 3, 6, 7) else slice(None)
    return values[rows, columns]
