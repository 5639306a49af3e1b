"""Read TIFF files: integers of any depth, floats, gray, RGB, palettes and inks, with or without alpha."""

from __future__ import annotations

import logging
import math
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from texlab_core.engine.job import MAX_PIXELS
from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import Decoded, oriented
from texlab_core.images.formats.tiff_pages import check_cost, choose_page
from texlab_core.images.formats.tiff_reducing import reduced_samples, reducing_factor

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.images.formats.decoded import Gate

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


def read_tiff(file: BinaryIO, gate: Gate) -> Decoded:
    """Read the picture of a TIFF file: its largest page that is no preview."""
    import tifffile

    notes: list[str] = []
    with tifffile.TiffFile(file, name="image.tif") as tiff:
        page = choose_page(tiff, gate.name, notes)
        photometric = int(page.photometric)
        width, height = int(page.imagewidth), int(page.imagelength)
        factor = reducing_factor(page, gate)
        made = -(-width // factor) * -(-height // factor)
        gate.admit(width, height, effort=0.0, decoded=made)
        _check_page(page, photometric, made, gate.name)
        check_cost(page, file, gate, made)
        _check_complete(page, file)
        peak: int | None
        if factor > 1:
            values, peak = reduced_samples(page, factor), 65535
        elif photometric == _PALETTE:
            values, peak = _look_up(_samples(page)[..., 0], page.colormap)
        else:
            values, peak = _stored(_samples(page), page, notes)
        if photometric == _WHITE_IS_ZERO:
            values[..., 0] = (1 if peak is None else peak) - values[..., 0]
        values, premultiplied = _drop_extra(values, page, photometric, notes)
        stored = Decoded(values, peak).depth if factor == 1 or page.bitspersample == 16 else 8
        profile = page.tags.get("InterColorProfile")
        values, peak = _in_srgb(values, peak, None if profile is None else profile.value, photometric, gate, notes)
        orientation = page.tags.get("Orientation")
        turn = 1 if orientation is None else int(orientation.value)
        values = oriented(values, turn, notes)
        whole = (width, height) if turn in range(5, 9) else (height, width)
    return Decoded(values, peak, tuple(notes), premultiplied, stored, whole if factor > 1 else None)


def _check_page(page: Any, photometric: int, made: int, name: str) -> None:
    samples = page.samplesperpixel
    known = photometric in _COLOURS and (photometric != _YCBCR or int(page.compression) in _JPEG)
    ink_set = page.tags.get("InkSet")
    if photometric == _INKS and ink_set is not None and ink_set.value != 1:
        known = False
    if not known or samples < _COLOURS[photometric]:
        raise ImageError(f"{name}: is a TIFF whose colours TexLab does not read (gray, RGB, palette or CMYK).")
    if page.dtype is None or page.dtype.kind not in "buif":
        raise ImageError(f"{name}: is a TIFF whose numbers TexLab does not read (integers or floats).")
    if page.imagedepth != 1 or samples > _MAX_SAMPLES:
        raise ImageError(f"{name}: is a TIFF volume or stack of {samples} channels, not an image.")
    # A few compressed megabytes may decode to very many.
    if made * samples * page.dtype.itemsize > _MAX_BYTES:
        raise ImageError(
            f"{name}: has {samples} channels of {page.dtype} in {page.imagewidth} x {page.imagelength} pixels; "
            f"at most {_MAX_BYTES // 2**30} GB are decoded."
        )


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


def _stored(values: NDArray[Any], page: Any, notes: list[str]) -> tuple[NDArray[Any], int | None]:
    if values.dtype.kind == "b":
        return values.astype(np.uint8), 1
    if values.dtype.kind != "u":
        return values.copy(), None
    bits = page.bitspersample
    peak = 2 ** (bits if isinstance(bits, int) else max(bits)) - 1
    declared = page.tags.get("MaxSampleValue")
    largest = np.max(declared.value) if declared is not None and np.size(declared.value) else peak
    # A declaration that the values go beyond is none.
    if 1 <= largest < peak and int(values.max()) <= largest:
        notes.append(f"The file declares {int(largest)} as its largest value, which is taken for white.")
        return values.copy(), int(largest)
    return values.copy(), peak


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
    values: NDArray[Any],
    peak: int | None,
    profile: bytes | None,
    photometric: int,
    gate: Gate,
    notes: list[str],
) -> tuple[NDArray[Any], int | None]:
    inks = photometric == _INKS
    if not inks and not profile:
        return values, peak
    if peak is None:
        if inks:
            raise ImageError(f"{gate.name}: is a CMYK TIFF of {values.dtype}; integers without sign are read.")
        notes.append("The colour profile was ignored, because it is applied to integers without sign only.")
        return values, peak
    from texlab_core.images.formats.profiles import MAX_PROFILE, to_srgb, whole_range

    if profile is not None and len(profile) > MAX_PROFILE:
        notes.append("The colour profile is too large and was ignored.")
        profile = None
    if not inks and profile is None:
        return values, peak
    converted = to_srgb(whole_range(values, peak), profile, cmyk=inks, notes=notes)
    return converted, int(np.iinfo(converted.dtype).max)
