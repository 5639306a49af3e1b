"""OpenEXR: pictures of light in scan lines, written as 32-bit floats and read as 16- or 32-bit ones.

The layout of the file is that of "OpenEXR File Layout" and "Technical Introduction to OpenEXR" (openexr.com).
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import Decoded

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.images.formats.decoded import Gate

MAGIC = b"\x76\x2f\x31\x01"
_PLAIN = 2
_FLAGS = {0x200: "tiles", 0x800: "deep data", 0x1000: "several parts"}
_COMPRESSIONS = ("NONE", "RLE", "ZIPS", "ZIP", "PIZ", "PXR24", "B44", "B44A", "DWAA", "DWAB", "HTJ2K")
_LINES = {"NONE": 1, "ZIPS": 1, "ZIP": 16}
_KINDS: dict[int, np.dtype[Any]] = {1: np.dtype("<f2"), 2: np.dtype("<f4")}
_LONGEST_HEADER = 2**20
_NAMES = {1: ("Y",), 2: ("Y", "A"), 3: ("R", "G", "B"), 4: ("R", "G", "B", "A")}


def encode_exr(light: NDArray[np.float32]) -> bytes:
    """Return an OpenEXR file of light, (H, W, C) float32, deflated in blocks of 16 lines.

    C = 1 gray, 2 gray and alpha, 3 RGB, 4 RGB and alpha; colours are multiplied by alpha.
    """
    height, width, count = light.shape
    names = _NAMES[count]
    # Channels stand in the order of the alphabet.
    order = sorted(range(count), key=lambda place: names[place])
    listed = b"".join(names[k].encode() + b"\0" + struct.pack("<iB3xii", 2, 0, 1, 1) for k in order) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = MAGIC + struct.pack("<i", _PLAIN)
    for name, kind, value in (
        ("channels", "chlist", listed),
        ("compression", "compression", bytes([_COMPRESSIONS.index("ZIP")])),
        ("dataWindow", "box2i", window),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1)),
        ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
        ("screenWindowWidth", "float", struct.pack("<f", 1)),
        ("software", "string", b"TexLab"),
    ):
        header += name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    header += b"\0"
    # Line by line, channel by channel.
    rows = np.ascontiguousarray(light.transpose(0, 2, 1)[:, order], dtype="<f4")
    blocks = []
    for top in range(0, height, _LINES["ZIP"]):
        packed = _packed(rows[top : top + _LINES["ZIP"]].tobytes())
        blocks.append(struct.pack("<ii", top, len(packed)) + packed)
    sizes = [len(block) for block in blocks]
    first = len(header) + 8 * len(blocks)
    offsets = first + np.concatenate([[0], np.cumsum(sizes[:-1], dtype=np.int64)]).astype("<u8")
    return header + offsets.astype("<u8").tobytes() + b"".join(blocks)


def _packed(data: bytes) -> bytes:
    """Deflate a block: even bytes before odd ones, each as the difference from the one before, around 128."""
    given = np.frombuffer(data, np.uint8)
    halves = np.concatenate([given[::2], given[1::2]])
    steps = halves.copy()
    steps[1:] = halves[1:] - halves[:-1] + np.uint8(128)
    packed = zlib.compress(steps.tobytes())
    # What deflate makes longer is stored as it is.
    return packed if len(packed) < len(data) else data


def _unpacked(packed: bytes, length: int) -> bytes:
    """Return the ``length`` bytes of a deflated block; raises ``ValueError`` for other ones."""
    if len(packed) == length:
        return packed
    stream = zlib.decompressobj()
    made = stream.decompress(packed, length + 1)
    if len(made) != length or not stream.eof:
        raise ValueError("a block has not the length that the header states")
    steps = np.frombuffer(made, np.uint8).copy()
    steps[1:] -= np.uint8(128)
    halves = np.cumsum(steps, dtype=np.uint8)
    data = np.empty(length, np.uint8)
    data[::2], data[1::2] = halves[: (length + 1) // 2], halves[(length + 1) // 2 :]
    return data.tobytes()


@dataclass(frozen=True)
class _Header:
    """What the header of a file says: its channels in their order, and where its lines are."""

    channels: tuple[tuple[str, np.dtype[Any]], ...]
    compression: str
    top: int
    width: int
    height: int
    end: int


def read_exr(file: BinaryIO, gate: Gate) -> Decoded:
    """Read a picture of scan lines, not compressed or deflated: light, brought into [0, 1] by the curve of sRGB.

    Raises
    ------
    ImageError
        For tiles, several parts, other compressions, and channels that are no picture; it names them.
    """
    head = file.read(_LONGEST_HEADER)
    header = _header(head, gate.name)
    gate.admit(header.width, header.height, bytes_each=32, effort=3.0)
    data = head + file.read()
    known = dict(header.channels)
    names = next((each for each in reversed(_NAMES.values()) if set(each) <= set(known)), None)
    if names is None:
        found = ", ".join(name for name, _ in header.channels[:8])
        raise ImageError(f"{gate.name}: is an OpenEXR image of {found}; TexLab reads R, G and B, or Y.")
    from texlab_core.images.formats.profiles import from_light

    light = _lines(data, header, names)
    if not np.isfinite(light).all():
        raise ValueError("it has values that are not finite")
    notes: list[str] = []
    colours = light.shape[2] - (light.shape[2] in (2, 4))
    values = light.clip(0, 1)
    values[..., :colours] = from_light(light[..., :colours], notes)
    return Decoded(values, None, tuple(notes), premultiplied=colours < light.shape[2], stored="float")


def _header(head: bytes, name: str) -> _Header:
    version = struct.unpack_from("<I", head, 4)[0]
    for flag, words in _FLAGS.items():
        if version & flag:
            raise ImageError(f"{name}: is an OpenEXR image with {words}; TexLab reads scan lines of one part.")
    values, at = {}, 8
    while head[at : at + 1] != b"\0":
        key, kind = head.index(b"\0", at), head.index(b"\0", head.index(b"\0", at) + 1)
        (size,) = struct.unpack_from("<i", head, kind + 1)
        if size < 0 or kind + 5 + size >= len(head):
            raise ValueError("its header is broken")
        values[head[at:key]] = head[kind + 5 : kind + 5 + size]
        at = kind + 5 + size
    place = values[b"compression"][0]
    compression = _COMPRESSIONS[place] if place < len(_COMPRESSIONS) else str(place)
    if compression not in _LINES:
        raise ImageError(
            f"{name}: is an OpenEXR image compressed by {compression}; TexLab reads {', '.join(_LINES)}."
        )
    left, top, right, bottom = struct.unpack("<4i", values[b"dataWindow"])
    channels = tuple(_channels(values[b"channels"], name))
    return _Header(channels, compression, top, right - left + 1, bottom - top + 1, at + 1)


def _channels(listed: bytes, name: str) -> list[tuple[str, np.dtype[Any]]]:
    found: list[tuple[str, np.dtype[Any]]] = []
    at = 0
    while listed[at : at + 1] != b"\0":
        end = listed.index(b"\0", at)
        kind, _, across, down = struct.unpack_from("<iB3xii", listed, end + 1)
        if kind not in _KINDS or (across, down) != (1, 1):
            raise ImageError(
                f"{name}: is an OpenEXR image of whole numbers or reduced colours, which is not read."
            )
        found.append((listed[at:end].decode("latin-1"), _KINDS[kind]))
        at = end + 17
    return found


def _lines(data: bytes, header: _Header, names: tuple[str, ...]) -> NDArray[np.float32]:
    """Return the channels of these names, (H, W, C) float32."""
    step = _LINES[header.compression]
    count = -(-header.height // step)
    offsets = np.frombuffer(data, "<u8", count, header.end)
    line = np.dtype([(f"c{k}", kind, (header.width,)) for k, (_, kind) in enumerate(header.channels)])
    places = [next(k for k, (each, _) in enumerate(header.channels) if each == name) for name in names]
    light = np.zeros((header.height, header.width, len(names)), np.float32)
    for offset in offsets.tolist():
        if offset + 8 > len(data):
            raise ValueError("a block lies behind the end of the file")
        top, size = struct.unpack_from("<ii", data, offset)
        row = top - header.top
        if not 0 <= row < header.height or row % step or size < 0:
            raise ValueError("a block lies outside of the picture")
        rows = min(step, header.height - row)
        block = data[offset + 8 : offset + 8 + size]
        read = np.frombuffer(_unpacked(block, rows * line.itemsize), line)
        for channel, place in enumerate(places):
            light[row : row + rows, :, channel] = read[f"c{place}"]
    return light
