"""What coded images say about themselves before they are decoded: size, depth, scans."""

from __future__ import annotations

import re
import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

_MAX_BOXES = 1000
_MAX_MARKERS = 20_000
# The next marker in coded data: neither a stuffed byte, a restart marker nor a fill byte (T.81, B.1.1.5).
_MARKER = re.compile(rb"\xff[^\x00\xd0-\xd7\xff]")
_FRAMES = frozenset(range(0xC0, 0xD0)) - {0xC4, 0xC8, 0xCC}
_JXL_CONTAINER = b"\0\0\0\x0cJXL \r\n\x87\n"
_JP2 = b"\0\0\0\x0cjP  \r\n\x87\n"
_JXL_RATIOS = ((1, 1), (12, 10), (4, 3), (3, 2), (16, 9), (5, 4), (2, 1))


@dataclass(frozen=True, slots=True)
class Header:
    """Size and kind of a coded image.

    Parameters
    ----------
    width, height
        In pixels.
    bits
        Of a sample.
    samples
        Of a pixel; 0 where the header was not read that far.
    process
        Of JPEG: the number of its frame marker, 0 to 15 (T.81, table B.1).
    scans
        Of JPEG.
    signed
        Of JPEG 2000: some samples are signed.
    light
        Of JPEG XL: the curve of its values, for the primary colours of sRGB; "other" for all else.
    """

    width: int
    height: int
    bits: int = 8
    samples: int = 0
    process: int = 0
    scans: int = 1
    signed: bool = False
    light: Literal["srgb", "linear", "other"] = "srgb"


def jpeg_header(data: bytes) -> Header:
    """Read the markers of a JPEG file (ITU-T T.81, annex B); raises ``ValueError``."""
    found: tuple[int, int, int, int, int] | None = None
    scans, position = 0, 2
    for _ in range(_MAX_MARKERS):
        match = _MARKER.search(data, position)
        if match is None:
            break
        marker, position = data[match.start() + 1], match.end()
        if marker == 0xD9:
            break
        if marker in (0x01, 0xD8):
            continue
        length = int.from_bytes(data[position : position + 2], "big")
        if marker in _FRAMES and found is None:
            bits, height, width, samples = struct.unpack_from(">BHHB", data, position + 2)
            found = width, height, bits, samples, marker - 0xC0
        scans += marker == 0xDA
        position += max(length, 2)
    else:
        raise ValueError(f"more than {_MAX_MARKERS} markers")
    if found is None:
        raise ValueError("it has no frame")
    return Header(*found, max(1, scans))


def png_header(data: bytes) -> Header:
    """Read the first chunk of a PNG file; raises ``ValueError``."""
    if len(data) < 26 or not data.startswith(b"\x89PNG\r\n\x1a\n") or data[12:16] != b"IHDR":
        raise ValueError("it has no header")
    width, height, bits, kind = struct.unpack_from(">IIBB", data, 16)
    return Header(width, height, bits, {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}.get(kind, 0))


def webp_header(data: bytes) -> Header:
    """Read width and height of a WebP file (RFC 9649, sections 2.5 to 2.7); raises ``ValueError``."""
    kind = data[12:16]
    if len(data) < 30 or data[:4] != b"RIFF" or data[8:12] != b"WEBP":
        raise ValueError("it has no header")
    if kind == b"VP8X":
        return Header(1 + int.from_bytes(data[24:27], "little"), 1 + int.from_bytes(data[27:30], "little"))
    if kind == b"VP8L":
        bits = int.from_bytes(data[21:25], "little")
        return Header(1 + (bits & 0x3FFF), 1 + (bits >> 14 & 0x3FFF))
    if kind != b"VP8 ":
        raise ValueError("it has no header")
    return Header(int.from_bytes(data[26:28], "little") & 0x3FFF, int.from_bytes(data[28:30], "little") & 0x3FFF)


def jpeg2000_header(data: bytes) -> Header:
    """Read the SIZ marker of a JPEG 2000 codestream or file (ITU-T T.800, A.5.1); raises ``ValueError``."""
    if data.startswith(_JP2):
        data = next((body for kind, body in boxes(data) if kind == b"jp2c"), b"")
    if len(data) < 42 or data[:4] != b"\xff\x4f\xff\x51":
        raise ValueError("it has no header")
    right, bottom, left, top = struct.unpack_from(">4I", data, 8)
    (samples,) = struct.unpack_from(">H", data, 40)
    depths = [each & 0x7F for each in data[42 : 42 + 3 * samples : 3]]
    signed = any(each & 0x80 for each in data[42 : 42 + 3 * samples : 3])
    if not depths:
        raise ValueError("it has no samples")
    return Header(max(0, right - left), max(0, bottom - top), 1 + max(depths), samples, signed=signed)


def jpegxl_header(data: bytes) -> Header:
    """Read size, depth and colours of a JPEG XL codestream or file (ISO/IEC 18181-1, D.2 and D.3).

    The depth is 0 where it lies behind a preview.

    Raises
    ------
    ValueError
        When there is no header.
    """
    if data.startswith(_JXL_CONTAINER):
        data = next(
            (body[4:] if kind == b"jxlp" else body for kind, body in boxes(data) if kind in (b"jxlc", b"jxlp")),
            b"",
        )
    if len(data) < 12 or data[:2] != b"\xff\x0a":
        raise ValueError("it has no header")
    take = _bits(data[2:128])
    width, height = _jxl_size(take)
    if take(1):
        return Header(width, height)
    if take(1):
        take(3)
        if take(1):
            _jxl_size(take)
        if take(1):
            return Header(width, height, 0)
        if take(1):
            take((0, 0, 10, 30)[take(2)])
            take((0, 0, 8, 10)[take(2)])
            take((0, 3, 16, 32)[take(2)])
            take(1)
    bits = _jxl_bits(take)
    take(1)
    extra = (0, 1, 2, 1)[kind] + (0 if kind < 2 else take((4, 12)[kind - 2])) if (kind := take(2)) else 0
    known = extra <= 1 and (extra == 0 or _skip_alpha(take))
    take(1)
    return Header(width, height, bits, light=_jxl_light(take) if known else "other")


def _jxl_bits(take: Callable[[int], int]) -> int:
    if take(1):
        # Floats, and the bits of their exponent.
        bits = (32, 16, 24)[kind] if (kind := take(2)) < 3 else 1 + take(6)
        take(4)
        return bits
    return (8, 10, 12)[kind] if (kind := take(2)) < 3 else 1 + take(6)


def _skip_alpha(take: Callable[[int], int]) -> bool:
    """Pass by the description of a channel; return whether it was alpha's."""
    if take(1):
        return True
    if _jxl_enum(take) != 0:
        return False
    _jxl_bits(take)
    if take(2) == 3:
        take(3)
    length = (
        (0, take(4) if kind == 1 else 0, 16 + take(5) if kind == 2 else 0, 0)[kind] if (kind := take(2)) else 0
    )
    take(8 * length)
    take(1)
    return True


def _jxl_enum(take: Callable[[int], int]) -> int:
    kind = take(2)
    return (0, 1, 2 + take(4) if kind == 2 else 0, 18 + take(6) if kind == 3 else 0)[kind]


def _jxl_light(take: Callable[[int], int]) -> Literal["srgb", "linear", "other"]:
    if take(1):
        return "srgb"
    if take(1):
        return "other"
    space = _jxl_enum(take)
    # Gray has no primary colours; white is D65, and sRGB's primaries are the first kind.
    if space > 1 or _jxl_enum(take) != 1 or (space == 0 and _jxl_enum(take) != 1) or take(1):
        return "other"
    curve = _jxl_enum(take)
    return "srgb" if curve == 13 else "linear" if curve == 8 else "other"


def _jxl_size(take: Callable[[int], int]) -> tuple[int, int]:
    small = take(1)

    def side() -> int:
        return 8 * (1 + take(5)) if small else 1 + take((9, 13, 18, 30)[take(2)])

    height = side()
    ratio = take(3)
    if ratio == 0:
        return side(), height
    above, below = _JXL_RATIOS[ratio - 1]
    return height * above // below, height


def _bits(data: bytes) -> Callable[[int], int]:
    """Return what takes the next bits, least significant first."""
    number, position = int.from_bytes(data, "little"), 0

    def take(count: int) -> int:
        nonlocal position
        value = number >> position & ((1 << count) - 1)
        position += count
        return value

    return take


def avif_header(data: bytes) -> Header:
    """Return the largest size that an AVIF file states (ISO/IEC 23008-12, 6.5.3); raises ``ValueError``."""
    sizes = [
        struct.unpack_from(">II", data, match.end() + 4)
        for match in re.finditer(rb"\0\0\0\x14ispe", data[: 2**20])
        if match.end() + 12 <= len(data)
    ]
    if not sizes:
        raise ValueError("it states no size")
    width, height = max(sizes, key=lambda size: int(size[0]) * int(size[1]))
    return Header(width, height)


def qoi_header(data: bytes) -> Header:
    """Read the header of a QOI file; raises ``ValueError``."""
    if len(data) < 14:
        raise ValueError("it has no header")
    width, height, samples = struct.unpack_from(">IIB", data, 4)
    return Header(width, height, 8, samples)


def boxes(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield type and body of the boxes of a file (ISO/IEC 14496-12, 4.2)."""
    position = 0
    for _ in range(_MAX_BOXES):
        if position + 8 > len(data):
            return
        length, head = int.from_bytes(data[position : position + 4], "big"), 8
        if length == 1:
            length, head = int.from_bytes(data[position + 8 : position + 16], "big"), 16
        end = len(data) if length == 0 else position + length
        if end < position + head:
            return
        yield data[position + 4 : position + 8], data[position + head : end]
        position = end
