"""What every reader of image files returns, and the gate that each passes before it decodes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

from texlab_core.engine.job import MAX_PIXELS
from texlab_core.errors import ImageError, TooLargeError

if TYPE_CHECKING:
    from numpy.typing import NDArray

Depth = Literal[8, 16, "float"]
MAX_REDUCED = 4 * MAX_PIXELS
"""Most pixels of a picture that is decoded in order to be scaled down or cropped."""
LIGHT_PIXELS = 4 * 2**20
"""Pictures up to this size are decoded where they are asked for, larger ones in a process of their own."""
# One bit for each pixel, packed by deflate as far as it goes, holds 8256 pixels in a byte.
_MAX_PIXELS_PER_BYTE = 4096
_DENSE_PIXELS = 16 * 2**20
_LIBRARIES = 512 * 2**20


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
    stored
        Bits of a sample in the file, where the values have others; None where they say it themselves.
    full_size
        Height and width of the picture, where the decoder has reduced it.
    """

    values: NDArray[Any]
    peak: int | None
    notes: tuple[str, ...] = ()
    premultiplied: bool = False
    stored: Depth | None = None
    full_size: tuple[int, int] | None = None

    @property
    def depth(self) -> Depth:
        """The depth at which a result loses nothing: 8 bits, 16 bits or floats."""
        if self.stored is not None:
            return self.stored
        if self.peak is None or self.peak > 65535:
            return "float"
        return 8 if self.peak <= 255 else 16

    @property
    def size(self) -> tuple[int, int]:
        """Height and width of the whole picture."""
        return self.full_size or (self.values.shape[0], self.values.shape[1])


class HeavyError(Exception):
    """The file is better decoded in a process of its own, with this much memory in bytes and time in seconds."""

    def __init__(self, memory: int, seconds: float) -> None:
        super().__init__("heavy")
        self.memory = memory
        self.seconds = seconds


@dataclass(slots=True)
class Gate:
    """What a reader asks before it decodes.

    Parameters
    ----------
    name
        How messages call the image.
    length
        Bytes of the file.
    scale
        The picture will be scaled by this factor; readers that can may decode a smaller one, but no smaller.
    reduced
        The picture will be scaled down or cropped, so that it may be larger than 64 megapixels.
    apart
        This is a process of its own.
    """

    name: str
    length: int
    scale: float = 1.0
    reduced: bool = False
    apart: bool = False
    notes: list[str] = field(default_factory=list)

    def admit(
        self,
        width: int,
        height: int,
        *,
        bytes_each: int = 4,
        effort: float = 1.0,
        decoded: int | None = None,
        memory: int = 0,
    ) -> None:
        """Let a picture through, or not.

        Parameters
        ----------
        width, height
            As its header states them.
        bytes_each
            Of a decoded pixel.
        effort
            How much longer it takes to decode than a plain JPEG of this size; infinite for codecs that are never
            run in this process.
        decoded
            Pixels that are decoded, where the decoder reduces the picture.
        memory
            Bytes beside them.

        Raises
        ------
        ImageError
            When it is empty, too large, or no picture by the few bytes that hold it.
        HeavyError
            When it should be decoded in a process of its own.
        """
        made = width * height if decoded is None else decoded
        check_pixels(width, height, self.name, reduced=self.reduced, decoded=made)
        if made > _DENSE_PIXELS and width * height > self.length * _MAX_PIXELS_PER_BYTE:
            raise ImageError(
                f"{self.name}: {width} x {height} pixels in a file of {self.length} bytes hold nothing but flat "
                f"areas; above {_DENSE_PIXELS // 2**20} megapixels a byte may stand for at most "
                f"{_MAX_PIXELS_PER_BYTE} pixels."
            )
        if not self.apart and made * effort > LIGHT_PIXELS:
            steady = effort if effort < float("inf") else 4.0
            memory += _LIBRARIES + 6 * made * bytes_each + 4 * self.length
            raise HeavyError(memory, 10 + made / 2**20 * (0.5 + steady))


def check_pixels(width: int, height: int, name: str, *, reduced: bool = False, decoded: int | None = None) -> None:
    """Refuse what is empty or larger than 64 megapixels (four times that, where it is reduced afterwards)."""
    if width < 1 or height < 1:
        raise ImageError(f"{name}: the image is empty ({width} x {height} pixels).")
    count = width * height if decoded is None else decoded
    if reduced and count > MAX_REDUCED:
        raise ImageError(
            f"{name}: the image has {width} x {height} pixels; at most {MAX_REDUCED // 2**20} megapixels are "
            "scaled down or cropped."
        )
    if not reduced and count > MAX_PIXELS:
        raise TooLargeError(
            f"{name}: the image has {width} x {height} pixels; at most {MAX_PIXELS // 2**20} megapixels are read, "
            "as in 8192 x 8192; a scale or a crop makes a larger one fit.",
            width,
            height,
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
