"""Read the portable formats PBM, PGM and PPM: text or binary, any maximum up to 65535."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import Decoded, check_pixels

if TYPE_CHECKING:
    from numpy.typing import NDArray

_HEADER = 4096
# White space and comments come before each number of the header; one white space ends it.
_NUMBER = rb"(?:\s|#[^\r\n]*[\r\n])+(\d{1,9})"


def read_pnm(file: BinaryIO, name: str) -> Decoded:
    """Read the first image of a file (Netpbm formats P1 to P6)."""
    head = file.read(_HEADER)
    kind = head[1:2]
    bitmap = kind in b"14"
    match = re.match(rb"P\d" + _NUMBER * (2 if bitmap else 3) + rb"\s", head)
    if match is None:
        raise ImageError(f"{name}: the header of the image is damaged.")
    width, height, peak = (int(number) for number in (*match.groups(), b"1")[:3])
    check_pixels(width, height, name)
    if not 1 <= peak <= 65535:
        raise ImageError(f"{name}: the maximum of the image must be from 1 to 65535, got {peak}.")
    file.seek(match.end())
    channels = 3 if kind in b"36" else 1
    shape = (height, width, channels)
    values: NDArray[Any]
    if kind == b"4":
        values = _bits(file, height, width)
    elif kind in b"56":
        values = _binary(file, shape, peak)
    else:
        values = _text(file, shape, bitmap=bitmap)
    if values.min() < 0 or values.max() > peak:
        raise ImageError(f"{name}: values go from {values.min()} to {values.max()}, and must be from 0 to {peak}.")
    values = values.astype(np.uint8 if peak < 256 else np.uint16, copy=False)
    # In bitmaps 1 is black.
    return Decoded(1 - values if bitmap else values, peak)


def _bits(file: BinaryIO, height: int, width: int) -> NDArray[np.uint8]:
    row = (width + 7) // 8
    packed = np.frombuffer(_exactly(file, height * row), np.uint8).reshape(height, row)
    return np.unpackbits(packed, axis=1)[:, :width, None]


def _binary(file: BinaryIO, shape: tuple[int, int, int], peak: int) -> NDArray[Any]:
    count = shape[0] * shape[1] * shape[2]
    if peak < 256:
        return np.frombuffer(_exactly(file, count), np.uint8).reshape(shape)
    return np.frombuffer(_exactly(file, 2 * count), ">u2").astype(np.uint16).reshape(shape)


def _text(file: BinaryIO, shape: tuple[int, int, int], *, bitmap: bool) -> NDArray[np.int64]:
    count = shape[0] * shape[1] * shape[2]
    # A value takes at most some 16 bytes with its white space; more than that is not read.
    body = re.sub(rb"#[^\r\n]*", b"", file.read(16 * count + _HEADER))
    words = list(re.sub(rb"\s", b"", body).decode("ascii")) if bitmap else body.split()
    if len(words) < count:
        raise ValueError(f"{count} values expected, {len(words)} found")
    return np.array(words[:count], dtype=np.int64).reshape(shape)


def _exactly(file: BinaryIO, count: int) -> bytes:
    data = file.read(count)
    if len(data) < count:
        raise ValueError(f"{count} bytes expected, {len(data)} found")
    return data
