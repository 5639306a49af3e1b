"""Read image files into arrays of stored values: sizes are checked from the header, before anything is decoded."""

from __future__ import annotations

import os
import stat
import sys
import tempfile
from typing import TYPE_CHECKING, BinaryIO

from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import Decoded, Gate, HeavyError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    Reader = Callable[[BinaryIO, Gate], Decoded]
    Stop = Callable[[], bool] | None


READABLE = (
    "PNG, JPEG, TIFF, WebP, AVIF, JPEG XL, JPEG 2000, GIF, BMP, TGA, PSD, QOI, Radiance HDR, PBM, PGM or PPM"
)
READABLE_SUFFIXES = (
    *(".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".avif", ".jxl", ".jp2", ".j2k", ".gif", ".bmp"),
    *(".tga", ".psd", ".qoi", ".hdr", ".pgm", ".ppm", ".pbm", ".pnm"),
)
MAX_FILE_BYTES = 2 * 2**30
_HEAD = 64
_TAIL = 18
_SHOWN = 3
_HEIC = (b"heic", b"heix", b"hevc", b"heim", b"heis", b"mif1", b"msf1")


def read_image(
    source: Path | bytes, name: str, *, scale: float = 1.0, reduced: bool = False, should_stop: Stop = None
) -> Decoded:
    """Read an image file.

    Parameters
    ----------
    source
        Path of the file, or its bytes.
    name
        How messages call it.
    scale, reduced
        The picture will be scaled by this factor, or cropped as well: one of up to 256 megapixels is decoded, and
        some decoders may reduce a larger one (see ``Decoded.full_size``).
    should_stop
        Asked while a large file is decoded, in a process of its own.

    Raises
    ------
    ImageError
        When it is missing, no regular file, not an image of a known format, damaged, empty, larger than 64
        megapixels, or takes far more time or memory than a picture of its size.
    Cancelled
        When ``should_stop`` said so.
    """
    if isinstance(source, bytes):
        import io

        gate = Gate(name, len(source), scale, reduced)
        return _decode(io.BytesIO(source), gate, should_stop)
    try:
        with open(source, "rb", opener=_open_at_once) as file:
            mode, length = os.fstat(file.fileno()).st_mode, os.fstat(file.fileno()).st_size
            if not stat.S_ISREG(mode):
                raise ImageError(f"{name}: is not a regular file.")
            if length > MAX_FILE_BYTES:
                raise ImageError(
                    f"{name}: has {length} bytes; files of at most {MAX_FILE_BYTES // 2**30} GB are read."
                )
            return _decode(file, Gate(name, length, scale, reduced), should_stop)
    except FileNotFoundError:
        raise ImageError(f"{name}: there is no such file.") from None
    except IsADirectoryError:
        raise ImageError(_folder(source, name)) from None
    except ImageError:
        raise
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ImageError(f"{name}: cannot be opened ({reason}).") from error


def _open_at_once(path: str, flags: int) -> int:
    """Open without waiting for the other end of a pipe."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _folder(path: Path, name: str) -> str:
    """Say that a folder is none, and which pictures it has."""
    try:
        names = sorted(each.name for each in os.scandir(path) if each.name.lower().endswith(READABLE_SUFFIXES))
    except OSError:
        names = []
    if not names:
        return f"{name}: is a folder, not an image, and there are no pictures in it."
    shown = ", ".join(names[:_SHOWN])
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return f"{name}: is a folder, not an image; its pictures: {shown}{more}."


def _decode(file: BinaryIO, gate: Gate, should_stop: Stop) -> Decoded:
    try:
        return decode_open(file, gate)
    except HeavyError as heavy:
        budget = heavy
    if getattr(sys, "frozen", False):
        # The program has no Python beside it that another process could run.
        gate.apart = True
        file.seek(0)
        return decode_open(file, gate)
    from texlab_core.images.formats.apart import decode_apart

    if not hasattr(file, "getbuffer"):
        return decode_apart(file, gate, budget, should_stop)
    with tempfile.TemporaryFile() as copy:
        copy.write(file.getbuffer())
        copy.flush()
        return decode_apart(copy, gate, budget, should_stop)


def decode_open(file: BinaryIO, gate: Gate) -> Decoded:
    """Decode an open file from its start; see :func:`read_image`.

    Raises
    ------
    ImageError
        When it is refused.
    HeavyError
        When it should be decoded in a process of its own, and the gate does not say that this is one.
    """
    name = gate.name
    head = file.read(_HEAD)
    if not head:
        raise ImageError(f"{name}: the file is empty.")
    file.seek(max(0, gate.length - _TAIL))
    reader = _reader(head, file.read(_TAIL))
    if reader is None:
        raise ImageError(f"{name}: is not an image that TexLab reads ({READABLE}).")
    file.seek(0)
    try:
        return reader(file, gate)
    except (ImageError, HeavyError):
        raise
    except MemoryError as error:
        raise ImageError(f"{name}: there is not enough memory to read it.") from error
    except Exception as error:
        # Decoders raise all kinds of errors on damaged files; none of them is the program's fault.
        reason = " ".join(str(error).split()).rstrip(".")[:120] or type(error).__name__
        raise ImageError(f"{name}: the image is truncated or damaged ({reason}).") from error


def _reader(head: bytes, tail: bytes) -> Reader | None:
    if head.startswith((b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")):
        from texlab_core.images.formats.tiff import read_tiff

        return read_tiff
    if head[:1] == b"P" and head[1:2] in b"123456" and head[2:3] in b" \t\r\n#":
        from texlab_core.images.formats.pnm import read_pnm

        return read_pnm
    if head.startswith(b"\x89PNG\r\n\x1a\n"):
        from texlab_core.images.formats.png import read_png

        return read_png
    if head.startswith(b"\xff\xd8\xff"):
        from texlab_core.images.formats.jpeg import read_jpeg

        return read_jpeg
    return _coded(head) or _older(head, tail)


def _coded(head: bytes) -> Reader | None:
    from texlab_core.images.formats import coded

    if head[:4] == b"RIFF" and head[8:12] == b"WEBP":
        return coded.read_webp
    if head[4:8] == b"ftyp":
        brand = head[8:12]
        # Of the general brands, the list of compatible ones tells.
        if brand in (b"avif", b"avis") or (brand in (b"mif1", b"msf1") and b"avif" in head[16:]):
            return coded.read_avif
        return coded.refuse_heic if brand in _HEIC else None
    if head.startswith((b"\xff\x0a", b"\0\0\0\x0cJXL ")):
        return coded.read_jpegxl
    if head.startswith((b"\xff\x4f\xff\x51", b"\0\0\0\x0cjP  ")):
        return coded.read_jpeg2000
    if head.startswith(b"qoif"):
        return coded.read_qoi
    return coded.refuse_exr if head.startswith(b"\x76\x2f\x31\x01") else None


def _older(head: bytes, tail: bytes) -> Reader | None:
    from texlab_core.images.formats import older

    if head.startswith(b"BM"):
        return older.read_bmp
    if head.startswith((b"GIF87a", b"GIF89a")):
        return older.read_gif
    if head.startswith(b"8BPS\0\x01"):
        return older.read_psd
    if head.startswith((b"#?RADIANCE", b"#?RGBE")):
        return older.read_radiance
    return older.read_tga if older.is_tga(head, tail) else None


def display_name(path: str | os.PathLike[str]) -> str:
    """Return the last part of a path."""
    return os.path.basename(os.fspath(path)) or os.fspath(path)
