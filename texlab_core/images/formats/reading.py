"""Read image files into arrays of stored values: sizes are checked from the header, before anything is decoded."""

from __future__ import annotations

import io
import os
import stat
import struct
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import Decoded, check_pixels, oriented

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


READABLE = "PNG, JPEG, TIFF, WebP, BMP, PGM or PPM"
READABLE_SUFFIXES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".bmp", ".pgm", ".ppm", ".pbm", ".pnm")
_ORIENTATION = 0x0112


def read_image(source: Path | bytes, name: str) -> Decoded:
    """Read an image file.

    Parameters
    ----------
    source
        Path of the file, or its bytes.
    name
        How messages call it.

    Raises
    ------
    ImageError
        When it is missing, no regular file, not an image of a known format, damaged, empty, or larger than 64
        megapixels.
    """
    if isinstance(source, bytes):
        return _decode(io.BytesIO(source), name)
    try:
        mode = source.stat().st_mode
        if stat.S_ISDIR(mode):
            raise ImageError(f"{name}: is a folder, not an image.")
        if not stat.S_ISREG(mode):
            raise ImageError(f"{name}: is not a regular file.")
        with open(source, "rb") as file:
            return _decode(file, name)
    except FileNotFoundError:
        raise ImageError(f"{name}: there is no such file.") from None
    except ImageError:
        raise
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ImageError(f"{name}: cannot be opened ({reason}).") from error


def _decode(file: BinaryIO, name: str) -> Decoded:
    head = file.read(16)
    file.seek(0)
    if not head:
        raise ImageError(f"{name}: the file is empty.")
    reader = _reader(head)
    if reader is None:
        raise ImageError(f"{name}: is not an image that TexLab reads ({READABLE}).")
    try:
        return reader(file, name)
    except ImageError:
        raise
    except MemoryError as error:
        raise ImageError(f"{name}: there is not enough memory to read it.") from error
    except Exception as error:
        # Decoders raise all kinds of errors on damaged files; none of them is the program's fault.
        reason = " ".join(str(error).split()).rstrip(".")[:120] or type(error).__name__
        raise ImageError(f"{name}: the image is truncated or damaged ({reason}).") from error


def _reader(head: bytes) -> Callable[[BinaryIO, str], Decoded] | None:
    if head.startswith((b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")):
        from texlab_core.images.formats.tiff import read_tiff

        return read_tiff
    if head[:1] == b"P" and head[1:2] in b"123456" and head[2:3] in b" \t\r\n#":
        from texlab_core.images.formats.pnm import read_pnm

        return read_pnm
    known = (b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff", b"BM")
    if head.startswith(known) or (head[:4] == b"RIFF" and head[8:12] == b"WEBP"):
        return _read_with_pillow
    return None


def _read_with_pillow(file: BinaryIO, name: str) -> Decoded:
    image = _open(file, name)
    width, height = image.size
    check_pixels(width, height, name)
    notes: list[str] = []
    if (frames := getattr(image, "n_frames", 1)) > 1:
        notes.append(f"The file has {frames} frames; the first one was used.")
    if image.format == "PNG" and _png_depth(file) == 16:
        # Pillow keeps 8 of the 16 bits of colour and alpha.
        import imagecodecs

        file.seek(0)
        values = imagecodecs.png_decode(file.read())
    else:
        values = np.asarray(_plain(image))
    values = values.reshape(values.shape[0], values.shape[1], -1)
    if image.mode == "CMYK" or image.info.get("icc_profile"):
        from texlab_core.images.formats.profiles import to_srgb

        values = to_srgb(values, image.info.get("icc_profile"), cmyk=image.mode == "CMYK", notes=notes)
    values = oriented(values, _orientation(image), notes)
    return Decoded(values, int(np.iinfo(values.dtype).max), tuple(notes))


def _open(file: BinaryIO, name: str) -> Any:
    """Read the header; the plugins are called directly because ``Image.open`` warns on its own, global, limit."""
    from PIL import BmpImagePlugin, JpegImagePlugin, PngImagePlugin, WebPImagePlugin

    head = file.read(32)
    file.seek(0)
    if head.startswith(b"\x89PNG"):
        return PngImagePlugin.PngImageFile(file)
    if head.startswith(b"RIFF"):
        # This plugin applies the global limit even so.
        check_pixels(*_webp_size(head), name)
        return WebPImagePlugin.WebPImageFile(file)
    if head.startswith(b"BM"):
        return BmpImagePlugin.BmpImageFile(file)
    return JpegImagePlugin.JpegImageFile(file)


def _webp_size(head: bytes) -> tuple[int, int]:
    """Return width and height (RFC 9649, sections 2.5 to 2.7)."""
    kind = head[12:16]
    if kind == b"VP8X":
        return 1 + int.from_bytes(head[24:27], "little"), 1 + int.from_bytes(head[27:30], "little")
    if kind == b"VP8L":
        bits = int.from_bytes(head[21:25], "little")
        return 1 + (bits & 0x3FFF), 1 + (bits >> 14 & 0x3FFF)
    return int.from_bytes(head[26:28], "little") & 0x3FFF, int.from_bytes(head[28:30], "little") & 0x3FFF


def _png_depth(file: BinaryIO) -> int:
    file.seek(24)
    return int(struct.unpack("B", file.read(1))[0])


def _plain(image: Any) -> Any:
    """Return the image with 8 bits for each of gray, gray and alpha, RGB, RGBA or CMYK."""
    transparent = "transparency" in image.info
    image.load()
    if image.mode in ("L", "1"):
        return image.convert("LA" if transparent else "L")
    if image.mode in ("LA", "RGBA", "CMYK"):
        return image
    return image.convert("RGBA" if transparent or image.mode == "PA" else "RGB")


def _orientation(image: Any) -> int:
    try:
        return int(image.getexif().get(_ORIENTATION, 1))
    except Exception:
        # Damaged metadata is no reason to refuse a picture.
        return 1


def display_name(path: str | os.PathLike[str]) -> str:
    """Return the last part of a path."""
    return os.path.basename(os.fspath(path)) or os.fspath(path)
