"""Read the portable formats PBM, PGM and PPM: text or binary, any maximum up to 65535."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import Decoded

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from texlab_core.images.formats.decoded import Gate

_BLOCK = 2**20
_MAX_HEADER = 2**20
_MAX_DIGITS = 9
_COMMENT = re.compile(rb"#[^\r\n]*")
# White space and comments come before each number of the header; one white space ends it.
_NUMBER = rb"(?:\s|#[^\r\n]*+[\r\n])++(\d{1,9})"


def read_pnm(file: BinaryIO, gate: Gate) -> Decoded:
    """Read the first image of a file (Netpbm formats P1 to P6)."""
    name = gate.name
    head = file.read(_MAX_HEADER)
    kind = head[1:2]
    bitmap = kind in b"14"
    match = re.match(rb"P\d" + _NUMBER * (2 if bitmap else 3) + rb"\s", head)
    if match is None:
        raise ImageError(f"{name}: the header of the image is damaged.")
    width, height, peak = (int(number) for number in (*match.groups(), b"1")[:3])
    channels = 3 if kind in b"36" else 1
    plain = kind in b"123"
    # A number of a plain file takes about as long to read as ten of the others.
    gate.admit(width, height, bytes_each=8 * channels, effort=10.0 if plain else 1.0)
    if not 1 <= peak <= 65535:
        raise ImageError(f"{name}: the maximum of the image must be from 1 to 65535, got {peak}.")
    file.seek(match.end())
    shape = (height, width, channels)
    # Plain bitmaps need no white space between their numbers.
    least = (
        -(-width // 8) * height if kind == b"4" else width * height * channels * (1 + (peak > 255 and not plain))
    )
    if gate.length - match.end() < least:
        raise ValueError(f"{least} bytes expected, {gate.length - match.end()} found")
    values: NDArray[Any]
    if kind == b"4":
        values = _bits(file, height, width)
    elif kind in b"56":
        values = _binary(file, shape, peak)
    else:
        values = (_digits if bitmap else _numbers)(file, shape)
    if values.max() > peak:
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


def _texts(file: BinaryIO) -> Iterator[NDArray[np.uint8]]:
    """Yield the text in blocks that end with white space, comments made into spaces."""
    rest = b""
    while True:
        block = file.read(_BLOCK)
        text = rest + block
        # A block ends where neither a number nor a comment can go on.
        end = len(text) if not block else 1 + max(text.rfind(b"\n"), text.rfind(b"\r"))
        if block and end == 0 and b"#" not in text:
            end = 1 + max(text.rfind(space) for space in (b" ", b"\t"))
        rest = text[end:]
        if len(rest) > _MAX_HEADER + _BLOCK:
            raise ValueError("a line is too long")
        if end:
            yield np.frombuffer(_COMMENT.sub(b" ", text[:end]) + b" ", np.uint8)
        if not block:
            return


def _digits(file: BinaryIO, shape: tuple[int, int, int]) -> NDArray[np.uint8]:
    """Read single digits 0 and 1, with or without white space between them."""
    values = np.empty(math.prod(shape), np.uint8)
    done = 0
    for text in _texts(file):
        # Tab to carriage return, and the space.
        found = text[(text != 32) & ((text < 9) | (text > 13))][: values.size - done] - 48
        if (found > 1).any():
            raise ValueError("a bitmap holds digits other than 0 and 1")
        values[done : done + found.size] = found
        done += found.size
        if done == values.size:
            return values.reshape(shape)
    raise ValueError(f"{values.size} values expected, {done} found")


def _numbers(file: BinaryIO, shape: tuple[int, int, int]) -> NDArray[np.uint32]:
    """Read decimal numbers between white space, a block of text at a time."""
    values = np.empty(math.prod(shape), np.uint32)
    done = 0
    for text in _texts(file):
        ink = (text != 32) & ((text < 9) | (text > 13))
        edges = np.flatnonzero(np.diff(ink, prepend=False))
        starts, ends = edges[0::2], edges[1::2]
        lengths = (ends - starts)[: values.size - done]
        starts = starts[: lengths.size]
        if lengths.size == 0:
            continue
        digits = text[: int(ends[lengths.size - 1])][ink[: int(ends[lengths.size - 1])]]
        if ((digits < 48) | (digits > 57)).any() or lengths.max() > _MAX_DIGITS:
            raise ValueError(f"what is no whole number from 0 to {10**_MAX_DIGITS - 1} stands among the values")
        firsts = np.cumsum(lengths) - lengths
        # The place of every digit in its number, counted from the end.
        places = np.repeat(firsts + lengths, lengths) - np.arange(digits.size) - 1
        weighted = (digits - 48).astype(np.uint32) * (10 ** np.arange(_MAX_DIGITS, dtype=np.uint32))[places]
        values[done : done + lengths.size] = np.add.reduceat(weighted, firsts)
        done += lengths.size
        if done == values.size:
            return values.reshape(shape)
    raise ValueError(f"{values.size} values expected, {done} found")


def _exactly(file: BinaryIO, count: int) -> bytes:
    data = file.read(count)
    if len(data) < count:
        raise ValueError(f"{count} bytes expected, {len(data)} found")
    return data
