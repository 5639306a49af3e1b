"""Text in JPEG files: in application segments that other programs skip, found again without decoding the image."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, BinaryIO

if TYPE_CHECKING:
    from collections.abc import Iterator

SIGNATURE = b"\xff\xd8\xff"
# APP15: no other program is known to write there (ITU-T T.81, table B.1).
_MARKER = 0xEF
_MOST = 65533
_MAX_KEY = 79
_MAX_SEGMENTS = 200_000
_STANDALONE = (0x01, *range(0xD0, 0xD8))
_START_OF_SCAN, _END_OF_IMAGE = 0xDA, 0xD9
_FRAMES = (*range(0xC0, 0xC4), *range(0xC5, 0xC8), *range(0xC9, 0xCC), *range(0xCD, 0xD0))


def with_text(jpeg: bytes, key: str, text: str) -> bytes:
    """Return the file with a text before its first scan, in as many segments as it needs.

    Each begins with the key, a null byte, its number and how many there are (two bytes each, the first is 1).

    Parameters
    ----------
    jpeg
        A JPEG file.
    key
        1 to 79 ASCII characters.
    text
        At most 4 GB as UTF-8.

    Raises
    ------
    ValueError
        When the key is too long or empty.
    """
    if not 1 <= len(key) <= _MAX_KEY or "\0" in key:
        raise ValueError(f"A JPEG text key has 1 to {_MAX_KEY} characters, got {key!r}.")
    body = text.encode()
    start = key.encode("ascii") + b"\0"
    room = _MOST - len(start) - 4
    count = max(-(-len(body) // room), 1)
    segments = [
        start + struct.pack(">HH", number + 1, count) + body[number * room : (number + 1) * room]
        for number in range(count)
    ]
    at = _after_leading_segments(jpeg)
    marked = [struct.pack(">BBH", 0xFF, _MARKER, len(each) + 2) + each for each in segments]
    return b"".join([jpeg[:at], *marked, jpeg[at:]])


def _after_leading_segments(jpeg: bytes) -> int:
    """Return where to insert: behind the JFIF and Exif segments, which want to be the first."""
    at = 2
    while jpeg[at : at + 1] == b"\xff" and jpeg[at + 1] in (0xE0, 0xE1):
        at += 2 + int.from_bytes(jpeg[at + 2 : at + 4], "big")
    return at


def read_text(file: BinaryIO, key: str, limit: int) -> bytes | None:
    """Return the text with this key as UTF-8, or None when there is none.

    Parameters
    ----------
    file
        A JPEG file, from its start.
    key
        ASCII.
    limit
        Longest text that is read, in bytes.

    Raises
    ------
    ValueError
        When the text is too long or damaged; the message continues a sentence about it.
    """
    start = key.encode("ascii") + b"\0"
    found: list[bytes] = []
    total = expected = 0
    for marker, length in _segments(file):
        if marker != _MARKER or length < len(start) + 4:
            file.seek(length, 1)
            continue
        body = file.read(length)
        if not body.startswith(start):
            continue
        number, count = struct.unpack_from(">HH", body, len(start))
        found.append(body[len(start) + 4 :])
        total += len(found[-1])
        if total > limit:
            raise ValueError(f"is longer than {limit} bytes")
        expected = expected or count
        if len(body) < length or number != len(found) or count != expected:
            raise ValueError("is damaged")
    if len(found) != expected:
        raise ValueError("is damaged")
    return b"".join(found) if found else None


def read_size(file: BinaryIO) -> tuple[int, int] | None:
    """Return height and width from the frame header, or None where there is none."""
    for marker, length in _segments(file):
        if marker in _FRAMES:
            head = file.read(5)
            return (int.from_bytes(head[1:3], "big"), int.from_bytes(head[3:5], "big")) if len(head) == 5 else None
        file.seek(length, 1)
    return None


def _segments(file: BinaryIO) -> Iterator[tuple[int, int]]:
    """Yield marker and length of each segment before the first scan; the reader moves on by that length."""
    file.seek(2)
    for _ in range(_MAX_SEGMENTS):
        head = file.read(2)
        while len(head) == 2 and head == b"\xff\xff":
            head = head[1:] + file.read(1)
        if len(head) < 2 or head[0] != 0xFF or head[1] in (_START_OF_SCAN, _END_OF_IMAGE):
            return
        if head[1] in _STANDALONE:
            continue
        size = file.read(2)
        if len(size) < 2 or (length := int.from_bytes(size, "big")) < 2:
            return
        yield head[1], length - 2
