"""Write images: PNG of 8 or 16 bits, TIFF of 8 or 16 bits or floats, JPEG; whole or not at all."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from texlab_core.errors import ImageError
from texlab_core.files.whole import write_whole
from texlab_core.images.formats.png_text import with_text

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

Bits = Literal[8, 16, "float"]
WRITABLE_SUFFIXES = (".png", ".tif", ".tiff", ".jpg", ".jpeg")
_BITS: dict[str, tuple[Bits, ...]] = {
    ".png": (8, 16),
    ".tif": (8, 16, "float"),
    ".tiff": (8, 16, "float"),
    ".jpg": (8,),
    ".jpeg": (8,),
}
_ROWS = 256
_JPEG_QUALITY = 95


def write_image(
    path: str | os.PathLike[str],
    pixels: NDArray[np.floating[Any]],
    *,
    bits: Bits = 8,
    text: Mapping[str, str] | None = None,
) -> None:
    """Write an image; the suffix of the path chooses the format. See :func:`encode_image`.

    Raises
    ------
    ImageError
        When the format is unknown or cannot hold what is asked, or the values are not finite.
    InputError
        When the file cannot be written; what was there before stays as it was.
    """
    write_whole(path, encode_image(path, pixels, bits=bits, text=text))


def encode_image(
    path: str | os.PathLike[str],
    pixels: NDArray[np.floating[Any]],
    *,
    bits: Bits = 8,
    text: Mapping[str, str] | None = None,
) -> bytes:
    """Return the bytes of an image file.

    Parameters
    ----------
    path
        Ends in .png, .tif, .tiff, .jpg or .jpeg, which chooses the format.
    pixels
        (H, W) or (H, W, 1 | 3) floats in [0, 1]; integers of a file are rounded to the nearest, and values outside
        are clipped. Floats are written as float32, as they are.
    bits
        8, 16 or "float" for each sample.
    text
        Texts by key, for PNG; a TIFF takes one ASCII text, its description.

    Raises
    ------
    ImageError
        When the format is unknown or cannot hold what is asked, or the values are not finite.
    """
    suffix = check_format(path, bits)
    name = os.fspath(path)
    image = np.asarray(pixels)
    if (
        image.dtype.kind != "f"
        or image.ndim not in (2, 3)
        or image.size == 0
        or image.shape[2:] not in ((), (1,), (3,))
    ):
        raise ImageError(
            f"{name}: an image to write is (H, W), (H, W, 1) or (H, W, 3) of floats, got {image.shape}."
        )
    if not np.isfinite(image).all():
        raise ImageError(f"{name}: the image has values that are not finite, and cannot be written.")
    image = image[..., 0] if image.shape[2:] == (1,) else image
    values = image.astype(np.float32) if bits == "float" else quantize(image, 2**bits - 1)
    if suffix == ".png":
        return encode_png(values, text)
    if suffix in (".tif", ".tiff"):
        return _encode_tiff(values, text)
    return _encode_jpeg(values, text)


def check_format(path: str | os.PathLike[str], bits: Bits = 8) -> str:
    """Return the suffix in lower case.

    Raises
    ------
    ImageError
        When no image can be written under this name, or not with these bits.
    """
    suffix = Path(path).suffix.lower()
    if not os.fspath(path):
        raise ImageError("The name of the file to write is empty.")
    if suffix not in _BITS:
        raise ImageError(
            f"{os.fspath(path)}: images are written as {', '.join(WRITABLE_SUFFIXES)}, got {suffix!r}."
        )
    if bits not in _BITS[suffix]:
        allowed = " or ".join(str(each) for each in _BITS[suffix])
        raise ImageError(f"{os.fspath(path)}: the bits of a {suffix} file must be {allowed}, got {bits!r}.")
    return suffix


def quantize(pixels: NDArray[np.floating[Any]], peak: int) -> NDArray[Any]:
    """Return the nearest of 0 .. ``peak`` as uint8 or uint16; values are clipped to [0, 1]."""
    values = np.empty(pixels.shape, np.uint8 if peak <= 255 else np.uint16)
    for top in range(0, pixels.shape[0], _ROWS):
        rows = slice(top, top + _ROWS)
        # The product is exact in float64, so that it is rounded once.
        values[rows] = np.rint(pixels[rows].clip(0, 1).astype(np.float64) * peak)
    return values


def encode_png(values: NDArray[Any], text: Mapping[str, str] | None = None) -> bytes:
    """Return a PNG file of (H, W) or (H, W, 1 | 3) uint8 or uint16."""
    import imagecodecs

    plane = values[..., 0] if values.shape[2:] == (1,) else values
    png = bytes(imagecodecs.png_encode(np.ascontiguousarray(plane)))
    return with_text(png, text) if text else png


def _encode_tiff(values: NDArray[Any], text: Mapping[str, str] | None) -> bytes:
    import tifffile

    if text and len(text) > 1:
        raise ValueError(f"A TIFF file takes one text, got {len(text)}.")
    out = io.BytesIO()
    tifffile.imwrite(
        out,
        values,
        photometric="rgb" if values.ndim == 3 else "minisblack",
        compression="zlib",
        predictor=values.dtype.kind == "u",
        metadata=None,
        software="TexLab",
        description=next(iter(text.values())) if text else None,
    )
    return out.getvalue()


def _encode_jpeg(values: NDArray[Any], text: Mapping[str, str] | None) -> bytes:
    from PIL import Image

    if text:
        raise ValueError("A JPEG file takes no text.")
    out = io.BytesIO()
    # Colour at full resolution: textures have fine colour.
    Image.fromarray(values).save(out, "JPEG", quality=_JPEG_QUALITY, subsampling=0)
    return out.getvalue()
