"""Which reader an image file needs, by its first bytes; and what becomes of a reader's errors."""

from __future__ import annotations

from typing import TYPE_CHECKING, BinaryIO

from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import Decoded, Gate, HeavyError

if TYPE_CHECKING:
    from collections.abc import Callable

    Reader = Callable[[BinaryIO, Gate], Decoded]

READABLE = (
    "PNG, JPEG, TIFF, WebP, AVIF, JPEG XL, JPEG 2000, GIF, BMP, TGA, PSD, QOI, OpenEXR, Radiance HDR, PBM, PGM "
    "or PPM"
)
READABLE_SUFFIXES = (
    *(".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".avif", ".jxl", ".jp2", ".j2k", ".gif", ".bmp"),
    *(".tga", ".psd", ".qoi", ".exr", ".hdr", ".pgm", ".ppm", ".pbm", ".pnm"),
)
_HEAD = 64
_TAIL = 18
# Canon, Fujifilm, Olympus, Panasonic, Sigma, Minolta: the others' raw files are TIFF files.
_RAW = (b"FUJIFILMCCD-RAW", b"IIRO", b"IIRS", b"MMOR", b"IIU\0", b"FOVb", b"\0MRM")
_HEIC = (b"heic", b"heix", b"hevc", b"heim", b"heis", b"mif1", b"msf1")


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
        if brand == b"crx ":
            return coded.refuse_raw
        return coded.refuse_heic if brand in _HEIC else None
    if head.startswith((b"\xff\x0a", b"\0\0\0\x0cJXL ")):
        return coded.read_jpegxl
    if head.startswith((b"\xff\x4f\xff\x51", b"\0\0\0\x0cjP  ")):
        return coded.read_jpeg2000
    if head.startswith(b"qoif"):
        return coded.read_qoi
    if head.startswith(b"\x76\x2f\x31\x01"):
        from texlab_core.images.formats.exr import read_exr

        return read_exr
    return coded.refuse_raw if head.startswith(_RAW) else None


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
