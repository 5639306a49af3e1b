"""Read BMP, GIF, TGA and PSD files, and the Radiance format of light."""

from __future__ import annotations

import re
import struct
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import Decoded

if TYPE_CHECKING:
    from texlab_core.images.formats.decoded import Gate

_TGA_KINDS = (1, 2, 3, 9, 10, 11)
_MAX_GIF_BLOCKS = 300_000
_TGA_BITS = (8, 15, 16, 24, 32)
_TGA_FOOTER = b"TRUEVISION-XFILE.\0"


def read_bmp(file: BinaryIO, gate: Gate) -> Decoded:
    """Read a Windows bitmap."""
    from PIL import BmpImagePlugin

    return _by_pillow(BmpImagePlugin.BmpImageFile(file), gate)


def read_gif(file: BinaryIO, gate: Gate) -> Decoded:
    """Read the first frame of a GIF file."""
    head = file.read(13)
    gate.admit(*struct.unpack_from("<HH", head, 6))
    file.seek(0)
    from PIL import GifImagePlugin

    image: Any = GifImagePlugin.GifImageFile(file)
    notes = _frames(head, file)
    file.seek(0)
    return _by_pillow(image, gate, notes)


def _frames(head: bytes, file: BinaryIO) -> tuple[str, ...]:
    """Say that there is more than one frame; counted by the blocks of the file (GIF89a, appendix B)."""
    table = 3 << (1 + (head[10] & 7)) if head[10] & 0x80 else 0
    file.seek(13 + table)
    count, inside = 0, False
    for _ in range(_MAX_GIF_BLOCKS):
        kind = file.read(1)
        if inside:
            # Parts of a block: each begins with its length, and the last has none.
            inside = kind not in (b"", b"\0")
            file.seek(kind[0] if inside else 0, 1)
            continue
        if kind == b"!":
            file.seek(1, 1)
        elif kind == b",":
            count += 1
            flags = file.read(9)[-1:]
            file.seek((3 << (1 + (flags[0] & 7)) if flags and flags[0] & 0x80 else 0) + 1, 1)
        else:
            break
        inside = True
    else:
        return (f"The file has {count} frames or more; the first one was used.",)
    return (f"The file has {count} frames; the first one was used.",) if count > 1 else ()


def is_tga(head: bytes, tail: bytes) -> bool:
    """Return whether a file is a TGA image, which has no signature: by its footer, or a sound header."""
    if len(head) < 18:
        return False
    _, maps, kind = struct.unpack_from("<BBB", head)
    width, height, bits, flags = struct.unpack_from("<HHBB", head, 12)
    sound = maps in (0, 1) and kind in _TGA_KINDS and bits in _TGA_BITS and width > 0 and height > 0
    # Without a footer also what nearly no other file has: no map where none is used, no reserved bits.
    table = head[3:8] == bytes(5) if maps == 0 else head[7] in (15, 16, 24, 32)
    return sound and (
        tail.endswith(_TGA_FOOTER) or (table and not flags & 0xC0 and (kind in (1, 9)) == (maps == 1))
    )


def read_tga(file: BinaryIO, gate: Gate) -> Decoded:
    """Read a TGA file."""
    head = file.read(18)
    gate.admit(*struct.unpack_from("<HH", head, 12))
    file.seek(0)
    from PIL import TgaImagePlugin

    return _by_pillow(TgaImagePlugin.TgaImageFile(file), gate)


def read_psd(file: BinaryIO, gate: Gate) -> Decoded:
    """Read the flattened picture of a Photoshop file of 8 bits."""
    channels, height, width, bits, mode = struct.unpack(">HIIHH", file.read(26)[12:])
    if bits != 8 or mode not in (1, 3, 4) or channels > 56:
        raise ImageError(
            f"{gate.name}: is a Photoshop file of {bits} bits in mode {mode}; gray, RGB and CMYK of 8 bits are "
            "read."
        )
    gate.admit(width, height)
    file.seek(0)
    from PIL import PsdImagePlugin

    image: Any = PsdImagePlugin.PsdImageFile(file)
    return _by_pillow(image, gate, ("The flattened picture of the Photoshop file was used.",))


def _by_pillow(image: Any, gate: Gate, notes: tuple[str, ...] = ()) -> Decoded:
    gate.admit(*image.size)
    transparent = "transparency" in image.info
    profile = image.info.get("icc_profile")
    image.load()
    if image.mode in ("L", "1"):
        image = image.convert("LA" if transparent else "L")
    elif image.mode not in ("LA", "RGBA", "CMYK"):
        image = image.convert("RGBA" if transparent or image.mode == "PA" else "RGB")
    values = np.asarray(image)
    values = values.reshape(*values.shape[:2], -1)
    said = list(notes)
    if profile or image.mode == "CMYK":
        from texlab_core.images.formats.profiles import to_srgb

        values = to_srgb(values, profile, cmyk=image.mode == "CMYK", notes=said)
    return Decoded(values, 255, tuple(said))


def read_radiance(file: BinaryIO, gate: Gate) -> Decoded:
    """Read a Radiance picture: light without a limit, brought into [0, 1] and given the curve of sRGB."""
    data = file.read()
    match = re.search(rb"\n\n[-+]Y (\d{1,9}) \+X (\d{1,9})\n", data[: 2**16])
    if match is None:
        raise ImageError(f"{gate.name}: is a Radiance picture whose rows TexLab does not read (-Y H +X W).")
    gate.admit(int(match[2]), int(match[1]), bytes_each=32, effort=2.0)
    import imagecodecs

    light = imagecodecs.rgbe_decode(data).astype(np.float32, copy=False)
    if not np.isfinite(light).all():
        raise ValueError("it has values that are not finite")
    from texlab_core.images.formats.profiles import from_light

    notes: list[str] = []
    return Decoded(from_light(light, notes), None, tuple(notes), stored="float")
