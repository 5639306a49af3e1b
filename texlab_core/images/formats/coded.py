"""Read WebP, AVIF, JPEG XL, JPEG 2000 and QOI files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from texlab_core.errors import ImageError
from texlab_core.images.formats import headers
from texlab_core.images.formats.decoded import Decoded, oriented
from texlab_core.images.formats.exif import orientation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.images.formats.decoded import Gate

_HEAVY = float("inf")
_HEAD = 2**20


def read_webp(file: BinaryIO, gate: Gate) -> Decoded:
    """Read the first frame of a WebP file."""
    header = headers.webp_header(file.read(64))
    gate.admit(header.width, header.height, effort=3.0)
    file.seek(0)
    from PIL import WebPImagePlugin

    # Pillow's own limit for all images was applied above, with a sentence.
    image: Any = WebPImagePlugin.WebPImageFile(file)
    notes = _frames(int(getattr(image, "n_frames", 1)))
    profile, exif = image.info.get("icc_profile"), image.info.get("exif", b"")
    image.load()
    values = np.asarray(image if image.mode in ("RGB", "RGBA") else image.convert("RGBA"))
    return _finish(values, 255, profile, orientation(exif), notes, bits=8)


def read_avif(file: BinaryIO, gate: Gate) -> Decoded:
    """Read the first image of an AVIF file, of 8, 10 or 12 bits."""
    data = file.read()
    header = headers.avif_header(data)
    gate.admit(header.width, header.height, bytes_each=8, effort=_HEAVY)
    import io

    import imagecodecs
    from PIL import AvifImagePlugin

    image: Any = AvifImagePlugin.AvifImageFile(io.BytesIO(data))
    gate.admit(*image.size, bytes_each=8, effort=_HEAVY)
    notes = _frames(int(getattr(image, "n_frames", 1)))
    profile, exif = image.info.get("icc_profile"), image.info.get("exif", b"")
    bits = _avif_bits(data)
    if bits == 8:
        # Pillow turns the picture as the file says, and tells what is left to do by EXIF.
        values = np.asarray(image if image.mode in ("L", "RGB", "RGBA") else image.convert("RGB"))
    else:
        values = imagecodecs.avif_decode(data, index=0)
    return _finish(values, 2**bits - 1, profile, orientation(exif), notes, bits=bits)


def _avif_bits(data: bytes) -> int:
    """Return the depth of an AVIF image by its configuration record (AV1-ISOBMFF, section 2.3.3)."""
    place = data.find(b"av1C", 0, _HEAD)
    flags = data[place + 6] if 0 <= place < len(data) - 6 else 0
    return 8 if not flags & 0x40 else 12 if flags & 0x20 else 10


def read_jpegxl(file: BinaryIO, gate: Gate) -> Decoded:
    """Read the first frame of a JPEG XL file, of integers or floats; the decoder turns it upright."""
    data = file.read()
    header = headers.jpegxl_header(data)
    gate.admit(header.width, header.height, bytes_each=16, effort=_HEAVY)
    if header.bits == 0:
        raise ImageError(f"{gate.name}: is a JPEG XL with a preview, which TexLab does not read.")
    import imagecodecs

    values: NDArray[Any] = imagecodecs.jpegxl_decode(data, index=0)
    notes = []
    peak = None if values.dtype.kind == "f" else 2**header.bits - 1
    if header.light == "other":
        notes.append("The colours of the JPEG XL file were taken as sRGB.")
    if header.light == "linear":
        from texlab_core.images.formats.profiles import from_gamma, from_light

        values = values.reshape(*values.shape[:2], -1)
        colours = values.shape[2] - 1 + values.shape[2] % 2
        if peak is not None:
            values = from_gamma(values, 1.0, notes, peak)
            peak = int(np.iinfo(values.dtype).max)
        elif np.isfinite(values).all():
            values = np.dstack([from_light(values[..., :colours], notes), values[..., colours:]])
    return _finish(values, peak, None, 1, notes, bits=header.bits)


def read_jpeg2000(file: BinaryIO, gate: Gate) -> Decoded:
    """Read a JPEG 2000 file or codestream."""
    data = file.read()
    header = headers.jpeg2000_header(data)
    if header.samples > 4 or header.signed or header.bits > 16:
        raise ImageError(
            f"{gate.name}: is a JPEG 2000 of {header.samples} channels of {header.bits} bits"
            f"{' with sign' if header.signed else ''}; up to 4 of 16 bits without sign are read."
        )
    gate.admit(header.width, header.height, bytes_each=4 * max(header.samples, 1), effort=_HEAVY)
    import imagecodecs

    values: NDArray[Any] = imagecodecs.jpeg2k_decode(data)
    profile = _jp2_profile(data)
    return _finish(values, 2**header.bits - 1, profile, 1, [], bits=header.bits)


def _jp2_profile(data: bytes) -> bytes | None:
    """Return the profile of a JP2 file (ITU-T T.800, I.5.3.3: method 2)."""
    if data[:4] == b"\xff\x4f\xff\x51":
        return None
    for kind, body in headers.boxes(data):
        if kind == b"jp2h":
            for inner, content in headers.boxes(body):
                if inner == b"colr" and content[:1] == b"\x02":
                    return content[3:]
    return None


def read_qoi(file: BinaryIO, gate: Gate) -> Decoded:
    """Read a QOI file."""
    data = file.read()
    header = headers.qoi_header(data)
    gate.admit(header.width, header.height)
    import imagecodecs

    return _finish(imagecodecs.qoi_decode(data), 255, None, 1, [], bits=8)


def refuse_heic(file: BinaryIO, gate: Gate) -> Decoded:
    """Say that HEIC files are not read."""
    raise ImageError(f"{gate.name}: is a HEIC image, which TexLab does not read; save it as JPEG, PNG or AVIF.")


def refuse_raw(file: BinaryIO, gate: Gate) -> Decoded:
    """Say that raw photographs are not developed; for those that are no TIFF files."""
    raise ImageError(f"{gate.name}: is a raw photograph, which TexLab does not develop; export it as TIFF or PNG.")


def _frames(count: int) -> list[str]:
    return [f"The file has {count} frames; the first one was used."] if count > 1 else []


def _finish(
    values: NDArray[Any], peak: int | None, profile: bytes | None, turn: int, notes: list[str], *, bits: int
) -> Decoded:
    values = values.reshape(*values.shape[:2], -1)
    if profile and peak is not None:
        from texlab_core.images.formats.profiles import to_srgb, whole_range

        values = to_srgb(whole_range(values, peak), profile, cmyk=False, notes=notes)
        peak = int(np.iinfo(values.dtype).max)
    values = oriented(values, turn, notes)
    stored = "float" if peak is None else 8 if bits <= 8 else 16
    return Decoded(values, peak, tuple(notes), stored=stored)  # type: ignore[arg-type]
