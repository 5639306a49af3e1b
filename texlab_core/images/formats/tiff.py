"""Read TIFF files: integers of any depth, floats, gray, RGB, palettes and inks, with or without alpha."""

from __future__ import annotations

import logging
import math
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from texlab_core.engine.job import MAX_PIXELS
from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import Decoded, check_pixels, oriented

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Photometric interpretations of TIFF 6.0.
_WHITE_IS_ZERO, _BLACK_IS_ZERO, _RGB, _PALETTE, _INKS, _YCBCR = 0, 1, 2, 3, 5, 6
_COLOURS = {_WHITE_IS_ZERO: 1, _BLACK_IS_ZERO: 1, _RGB: 3, _PALETTE: 1, _INKS: 4, _YCBCR: 3}
_JPEG = (6, 7, 34892, 33007)
_PREMULTIPLIED, _UNASSOCIATED = 1, 2
_MAX_SAMPLES = 16
# RGB and alpha in doubles, at the largest size.
_MAX_BYTES = 4 * 8 * MAX_PIXELS

# What tifffile finds odd about a file is told by this module's errors.
logging.getLogger("tifffile").addHandler(logging.NullHandler())


def read_tiff(file: BinaryIO, name: str) -> Decoded:
    """Read the first page of a TIFF file."""
    import tifffile

    notes: list[str] = []
    with tifffile.TiffFile(file, name="image.tif") as tiff:
        page: Any = tiff.pages[0]
        photometric = int(page.photometric)
        _check_page(page, photometric, name)
        _check_complete(page, file)
        if (count := len(tiff.pages)) > 1:
            notes.append(f"The file has {count} pages; the first one was used.")
        values = _samples(page)
        peak: int | None
        if photometric == _PALETTE:
            values, peak = _look_up(values[..., 0], page.colormap)
        else:
            values, peak = _stored(values, page)
        if photometric == _WHITE_IS_ZERO:
            values[..., 0] = (1 if peak is None else peak) - values[..., 0]
        values, premultiplied = _drop_extra(values, page, photometric, notes)
        profile = page.tags.get("InterColorProfile")
        values = _in_srgb(values, None if profile is None else profile.value, photometric, name, notes)
        orientation = page.tags.get("Orientation")
        values = oriented(values, 1 if orientation is None else int(orientation.value), notes)
    return Decoded(values, peak, tuple(notes), premultiplied)


def _check_page(page: Any, photometric: int, name: str) -> None:
    check_pixels(page.imagewidth, page.imagelength, name)
    samples = page.samplesperpixel
    known = photometric in _COLOURS and (photometric != _YCBCR or int(page.compression) in _JPEG)
    if not known or samples < _COLOURS[photometric]:
        raise ImageError(f"{name}: is a TIFF whose colours TexLab does not read (gray, RGB, palette or CMYK).")
    if page.dtype is None or page.dtype.kind not in "buif":
        raise ImageError(f"{name}: is a TIFF whose numbers TexLab does not read (integers or floats).")
    if page.imagedepth != 1 or samples > _MAX_SAMPLES:
        raise ImageError(f"{name}: is a TIFF volume or stack of {samples} channels, not an image.")
    # A few compressed megabytes may decode to very many.
    if page.imagewidth * page.imagelength * samples * page.dtype.itemsize > _MAX_BYTES:
        raise ImageError(
            f"{name}: has {samples} channels of {page.dtype} in {page.imagewidth} x {page.imagelength} pixels; "
            f"at most {_MAX_BYTES // 2**30} GB are decoded."
        )
    # A tile may be larger than its image, and is decoded whole.
    if np.prod([int(side) for side in page.chunks], dtype=np.float64) > 4 * MAX_PIXELS:
        raise ImageError(f"{name}: is a TIFF with tiles that are too large.")


def _check_complete(page: Any, file: BinaryIO) -> None:
    """Refuse a file that ends before its image; tifffile would fill in zeros."""
    end = file.seek(0, 2)
    last = max(
        (offset + size for offset, size in zip(page.dataoffsets, page.databytecounts, strict=False)), default=0
    )
    if not last or last > end:
        raise ValueError(f"{last} bytes expected, {end} found")
    if len(page.dataoffsets) < (parts := math.prod(page.chunked)):
        raise ValueError(f"{parts} strips or tiles expected, {len(page.dataoffsets)} found")


def _samples(page: Any) -> NDArray[Any]:
    """Return (H, W, S); planes and interleaved samples alike."""
    stored: NDArray[Any] = page.asarray(squeeze=False)
    planes, _, height, width, interleaved = stored.shape
    return np.moveaxis(stored[:, 0], 0, 2).reshape(height, width, planes * interleaved)


def _stored(values: NDArray[Any], page: Any) -> tuple[NDArray[Any], int | None]:
    if values.dtype.kind == "b":
        return values.astype(np.uint8), 1
    if values.dtype.kind == "u":
        bits = page.bitspersample
        return values.copy(), 2 ** (bits if isinstance(bits, int) else max(bits)) - 1
    return values.copy(), None


def _look_up(index: NDArray[Any], table: NDArray[np.uint16]) -> tuple[NDArray[Any], int]:
    colours = np.ascontiguousarray(table.T)
    # Tables made of 8-bit values, by repetition (TIFF 6.0) or by shifting (common).
    short = colours >> 8
    if (colours == short * 257).all() or (colours == short * 256).all():
        return short.astype(np.uint8)[index], 255
    return colours[index], 65535


def _drop_extra(values: NDArray[Any], page: Any, photometric: int, notes: list[str]) -> tuple[NDArray[Any], bool]:
    """Keep the colours and the first alpha."""
    colours = 3 if photometric == _PALETTE else _COLOURS[photometric]
    if values.shape[2] == colours:
        return values, False
    kind = int(page.extrasamples[0]) if page.extrasamples else 0
    alpha = kind in (_PREMULTIPLIED, _UNASSOCIATED) and photometric != _INKS
    kept = colours + alpha
    if values.shape[2] > kept:
        notes.append("Channels that are neither colour nor alpha were dropped.")
    return values[..., :kept], alpha and kind == _PREMULTIPLIED


def _in_srgb(
    values: NDArray[Any], profile: bytes | None, photometric: int, name: str, notes: list[str]
) -> NDArray[Any]:
    inks = photometric == _INKS
    if not inks and not profile:
        return values
    if values.dtype not in (np.uint8, np.uint16):
        if inks:
            raise ImageError(f"{name}: is a CMYK TIFF of {values.dtype}; 8 or 16 bits are read.")
        notes.append("The colour profile was ignored, because it is applied to 8 and 16 bits only.")
        return values
    from texlab_core.images.formats.profiles import to_srgb

    return to_srgb(values, profile, cmyk=inks, notes=notes)
