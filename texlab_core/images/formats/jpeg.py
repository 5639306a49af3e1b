"""Read JPEG files: baseline, progressive and arithmetic ones of 8 bits, and those of 12 bits or without loss."""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import MAX_REDUCED, Decoded, oriented
from texlab_core.images.formats.exif import orientation
from texlab_core.images.formats.headers import jpeg_header

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.images.formats.decoded import Gate

MAX_SCANS = 64
"""Progressive files have about ten scans; every scan goes through the whole picture."""
MAX_SCANNED = 1024 * 2**20
"""Most pixels that all scans together go through."""
_ICC = b"ICC_PROFILE\0"
_LOSSLESS = 3
# One for each component, without any refinement.
_PLAIN_SCANS = 4
_BY_PILLOW = (0, 1, 2, 9, 10)


def read_jpeg(file: BinaryIO, gate: Gate) -> Decoded:
    """Read a JPEG file (ITU-T T.81)."""
    data = file.read()
    header = jpeg_header(data)
    if header.process not in (*_BY_PILLOW, _LOSSLESS) or header.bits not in range(2, 17):
        raise ImageError(f"{gate.name}: is a JPEG of a kind (frame {header.process}) that TexLab does not read.")
    shrunk = _shrunk(header.width, header.height, gate)
    deep = header.process == _LOSSLESS or header.bits != 8
    gate.admit(
        header.width,
        header.height,
        bytes_each=8,
        effort=max(1.0, 0.7 * header.scans) if header.scans <= MAX_SCANS else 0.0,
        decoded=header.width * header.height if shrunk is None or deep else shrunk[0] * shrunk[1],
        # All coefficients of a picture in several scans are kept.
        memory=8 * header.width * header.height * (header.scans > 1),
    )
    check_scans(header.scans, header.width, header.height, gate.name)
    picture = _picture(data)
    notes: list[str] = []
    values: NDArray[Any]
    peak, cmyk, icc = 255, False, picture.profile
    full_size = None
    if deep:
        values, peak = _deep(picture.data, header.bits)
    else:
        from PIL import JpegImagePlugin

        image: Any = JpegImagePlugin.JpegImageFile(io.BytesIO(picture.data))
        if shrunk is not None:
            image.draft(None, shrunk)
            full_size = header.height, header.width
        image.load()
        cmyk = image.mode == "CMYK"
        values = np.asarray(image if image.mode in ("L", "CMYK") else image.convert("RGB"))
    values = values.reshape(*values.shape[:2], -1)
    if cmyk or icc:
        from texlab_core.images.formats.profiles import to_srgb, whole_range

        values = to_srgb(whole_range(values, peak), icc, cmyk=cmyk, notes=notes)
        peak = int(np.iinfo(values.dtype).max)
    turn = orientation(picture.exif)
    values = oriented(values, turn, notes)
    if full_size is not None and turn >= 5:
        full_size = full_size[1], full_size[0]
    stored = 8 if header.bits <= 8 else 16
    return Decoded(values, peak, tuple(notes), stored=stored, full_size=full_size)  # type: ignore[arg-type]


def check_scans(scans: int, width: int, height: int, name: str) -> None:
    """Refuse a JPEG whose scans make a small file costly."""
    if scans > MAX_SCANS or (scans > _PLAIN_SCANS and scans * width * height > MAX_SCANNED):
        raise ImageError(
            f"{name}: is a JPEG of {scans} scans over {width} x {height} pixels; at most {MAX_SCANS} scans, and "
            f"{MAX_SCANNED // 2**20} megapixels in all of them, are read."
        )


def _shrunk(width: int, height: int, gate: Gate) -> tuple[int, int] | None:
    """Return a size for the decoder to come down to, for pictures that are too large to be decoded whole."""
    if width * height <= MAX_REDUCED or gate.scale > 0.5:
        return None
    for factor in (2, 4, 8):
        smaller = -(-width // factor), -(-height // factor)
        if gate.scale * factor > 1:
            return None
        if smaller[0] * smaller[1] <= MAX_REDUCED:
            return smaller
    return None


def _deep(data: bytes, bits: int) -> tuple[NDArray[Any], int]:
    import imagecodecs

    return imagecodecs.jpeg8_decode(data), 2**bits - 1


@dataclass(slots=True)
class _Picture:
    data: bytes
    exif: bytes = b""
    profile: bytes | None = None


def _picture(data: bytes) -> _Picture:
    """Leave out of a file what decoders read beside the picture: previews, texts, camera data."""
    kept, parts = [data[:2]], {}
    exif, position = b"", 2
    while position + 4 <= len(data) and data[position] == 0xFF:
        marker = data[position + 1]
        if marker == 0xFF:
            position += 1
            continue
        length = int.from_bytes(data[position + 2 : position + 4], "big")
        end = position + 2 + max(length, 2)
        body = data[position + 4 : end]
        if marker == 0xDA:
            break
        if marker == 0xE1 and body.startswith(b"Exif\0\0") and not exif:
            exif = body
        elif marker == 0xE2 and body.startswith(_ICC) and len(body) > len(_ICC) + 2:
            parts[body[len(_ICC)]] = body[len(_ICC) + 2 :]
        elif marker != 0xFE and (not 0xE1 <= marker <= 0xEF or marker == 0xEE):
            kept.append(data[position:end])
        position = end
    profile = b"".join(parts[number] for number in sorted(parts)) or None
    return _Picture(b"".join([*kept, data[position:]]), exif, profile)
