"""Read PNG files: the chunks that make the picture, and nothing of what else is in the file."""

from __future__ import annotations

import io
import struct
import zlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from texlab_core.images.formats.decoded import Decoded, oriented
from texlab_core.images.formats.exif import orientation
from texlab_core.images.formats.headers import png_header
from texlab_core.images.formats.png_text import SIGNATURE, chunk, inflate

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.images.formats.decoded import Gate
    from texlab_core.images.formats.headers import Header

_PICTURE = (b"IHDR", b"PLTE", b"tRNS", b"IDAT")
_ASIDE = (b"iCCP", b"gAMA", b"sRGB", b"cHRM", b"eXIf", b"acTL", b"cICP")
_MAX_ASIDE = 16 * 2**20
_MAX_CHUNKS = 200_000
# Top, left, and the steps down and right of each pass of an interlaced image (PNG specification, 8.2).
_ADAM7 = ((0, 0, 8, 8), (0, 4, 8, 8), (4, 0, 8, 4), (0, 2, 4, 4), (2, 0, 4, 2), (0, 1, 2, 2), (1, 0, 2, 1))
# White, red, green, blue as the cHRM chunk has them (PNG specification, 11.3.2.1).
_SRGB_CORNERS = (31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000)


@dataclass(slots=True)
class _Parts:
    """The chunks that make the picture, in order, and those beside it by name."""

    picture: list[tuple[bytes, bytes]] = field(default_factory=list)
    aside: dict[bytes, bytes] = field(default_factory=dict)
    too_large: set[bytes] = field(default_factory=set)

    def whole(self) -> bytes:
        """Return a PNG file of the picture alone."""
        return b"".join([SIGNATURE, *(chunk(*each) for each in self.picture), chunk(b"IEND", b"")])


def read_png(file: BinaryIO, gate: Gate) -> Decoded:
    """Read a PNG file of any colour type and depth; texts are skipped, whatever their size."""
    header = png_header(file.read(64))
    file.seek(28)
    # libpng writes to standard error whatever it finds odd about interlacing.
    talks = header.bits == 16 and file.read(1) != b"\0"
    gate.admit(
        header.width,
        header.height,
        bytes_each=16 if header.bits == 16 else 4,
        effort=float("inf") if talks else 1.0,
    )
    file.seek(len(SIGNATURE))
    parts = _parts(file)
    notes: list[str] = []
    frames = parts.aside.get(b"acTL", b"")
    if len(frames) >= 4 and (count := int.from_bytes(frames[:4], "big")) > 1:
        notes.append(f"The file has {count} frames; the first one was used.")
    values = _deep(parts, header) if header.bits == 16 else _shallow(parts.whole(), header.bits)
    values = _in_srgb(values.reshape(*values.shape[:2], -1), parts, notes)
    values = oriented(values, orientation(parts.aside.get(b"eXIf", b"")), notes)
    stored = 16 if header.bits == 16 else 8
    return Decoded(values, int(np.iinfo(values.dtype).max), tuple(notes), stored=stored)  # type: ignore[arg-type]


def _parts(file: BinaryIO) -> _Parts:
    found = _Parts()
    ended = seen = False
    once: set[bytes] = set()
    for _ in range(_MAX_CHUNKS):
        head = file.read(8)
        length, kind = int.from_bytes(head[:4], "big"), head[4:]
        if len(head) < 8:
            break
        # What follows the picture is of no use to it.
        ended = ended or kind == b"IEND"
        if ended:
            break
        if kind in _PICTURE:
            body = file.read(length + 4)
            if len(body) < length + 4:
                raise ValueError(f"the chunk {kind.decode()} is cut off")
            if zlib.crc32(body[:-4], zlib.crc32(kind)) != int.from_bytes(body[-4:], "big"):
                raise ValueError(f"the chunk {kind.decode()} has a wrong checksum")
            if kind == b"IDAT" or kind not in once:
                found.picture.append((kind, body[:-4]))
            once.add(kind)
            seen = seen or kind == b"IDAT"
        elif kind in _ASIDE and kind not in found.aside and length <= _MAX_ASIDE:
            found.aside[kind] = file.read(length)
            file.seek(4, 1)
        else:
            if kind in _ASIDE:
                found.too_large.add(kind)
            file.seek(length + 4, 1)
    if not seen:
        raise ValueError("it has no image data")
    if not ended:
        raise ValueError("its end is missing")
    return found


def _shallow(picture: bytes, bits: int) -> NDArray[np.uint8]:
    """Return gray, gray and alpha, RGB or RGBA of 8 bits."""
    from PIL import PngImagePlugin

    image = PngImagePlugin.PngImageFile(io.BytesIO(picture))
    key = image.info.get("transparency")
    if bits in (2, 4) and isinstance(key, int):
        # Pillow stretches the pixels to 8 bits, and not the key (PNG specification, 11.3.2.1).
        image.info["transparency"] = key * (255 // (2**bits - 1))
    image.load()
    if image.mode in ("L", "1"):
        return np.asarray(image.convert("L" if key is None else "LA"))
    if image.mode in ("LA", "RGBA"):
        return np.asarray(image)
    return np.asarray(image.convert("RGB" if key is None else "RGBA"))


def _deep(parts: _Parts, header: Header) -> NDArray[Any]:
    """Return gray, gray and alpha, RGB or RGBA of 16 bits; Pillow keeps 8 of them."""
    import imagecodecs

    # libpng writes to standard error what it finds odd: it gets a file in which there is nothing odd.
    packed = b"".join(body for kind, body in parts.picture if kind == b"IDAT")
    rows = _inflate_exactly(packed, _filtered_bytes(header, interlaced=parts.picture[0][1][12:13] == b"\1"))
    key = {1: 2, 3: 6}.get(header.samples, 0)
    kept = [each for each in parts.picture if each[0] == b"IHDR" or (each[0] == b"tRNS" and len(each[1]) == key)]
    parts.picture = [*kept, (b"IDAT", zlib.compress(rows, 0))]
    values: NDArray[Any] = imagecodecs.png_decode(parts.whole())
    if values.dtype != np.uint16:
        raise ValueError("its 16 bits were not found")
    return values


def _filtered_bytes(header: Header, *, interlaced: bool) -> int:
    """Return the bytes of all rows of 16-bit samples with their filter bytes (PNG specification, 8.1 and 9.2)."""
    passes = _ADAM7 if interlaced else ((0, 0, 1, 1),)
    total = 0
    for top, left, down, right in passes:
        rows, columns = -(-(header.height - top) // down), -(-(header.width - left) // right)
        if rows > 0 and columns > 0:
            total += rows * (1 + 2 * header.samples * columns)
    return total


def _inflate_exactly(packed: bytes, size: int) -> bytes:
    machine = zlib.decompressobj()
    rows = machine.decompress(packed, size)
    if len(rows) == size and not machine.eof:
        # The checksum comes after the last byte; further rows are of no use.
        machine.decompress(machine.unconsumed_tail, 1)
    if len(rows) < size:
        raise ValueError(f"{size} bytes of pixels expected, {len(rows)} found")
    return rows


def _in_srgb(values: NDArray[Any], parts: _Parts, notes: list[str]) -> NDArray[Any]:
    """Convert by the profile; without one, and unless the file says sRGB, by its gamma."""
    from texlab_core.images.formats.profiles import MAX_PROFILE, from_gamma, to_srgb

    if b"iCCP" in parts.too_large:
        notes.append("The colour profile is too large and was ignored.")
        return values
    if (packed := parts.aside.get(b"iCCP")) is not None:
        _, _, body = packed.partition(b"\0")
        try:
            profile = inflate(body[1:], MAX_PROFILE)
        except ValueError as error:
            shown = "too large" if "longer" in str(error) else "damaged"
            notes.append(f"The colour profile is {shown} and was ignored.")
            return values
        return to_srgb(values, profile, cmyk=False, notes=notes)
    gamma = parts.aside.get(b"gAMA", b"")
    if b"sRGB" in parts.aside or b"cICP" in parts.aside or len(gamma) != 4:
        return values
    corners = parts.aside.get(b"cHRM", b"")
    if len(corners) == 32 and values.shape[2] >= 3:
        points = struct.unpack(">8I", corners)
        if any(abs(one - other) > 1000 for one, other in zip(points, _SRGB_CORNERS, strict=True)):
            notes.append("The file's primary colours are not those of sRGB; they were ignored.")
    return from_gamma(values, int.from_bytes(gamma, "big") / 100_000, notes)
