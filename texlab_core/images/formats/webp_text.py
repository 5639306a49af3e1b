"""Text in WebP files: in a chunk of its own behind the picture, which other programs skip (RFC 9649, 2.7)."""

from __future__ import annotations

import struct
from typing import BinaryIO

_KIND = b"TEXT"
_MAX_CHUNKS = 200_000
_ALPHA = 0x10


def is_webp(head: bytes) -> bool:
    """Return whether a file that starts like this is one."""
    return head[:4] == b"RIFF" and head[8:12] == b"WEBP"


def with_text(webp: bytes, key: str, text: str) -> bytes:
    """Return a WebP file with a text behind its picture.

    Parameters
    ----------
    webp
        A file with a VP8L or VP8 chunk, alone or with a header (VP8X) before it.
    key
        ASCII, without a null character.
    text
        At most 4 GB as UTF-8, together with the picture.

    Raises
    ------
    ValueError
        When the file is another, or the key is empty.
    """
    if not key or "\0" in key:
        raise ValueError(f"A WebP text key has at least one character and no null, got {key!r}.")
    body = webp[12:]
    if body.startswith(b"VP8L"):
        # Only a file with a header may hold more than its picture.
        bits = int.from_bytes(body[9:13], "little")
        flags = _ALPHA if bits >> 28 & 1 else 0
        sides = b"".join(each.to_bytes(3, "little") for each in (bits & 0x3FFF, bits >> 14 & 0x3FFF))
        body = _chunk(b"VP8X", bytes([flags, 0, 0, 0]) + sides) + body
    elif body.startswith(b"VP8 ") and body[11:14] == b"\x9d\x01*":
        # Sides of 14 bits follow the start code of a key frame (RFC 6386, 9.1).
        width, height = (int.from_bytes(body[at : at + 2], "little") & 0x3FFF for at in (14, 16))
        sides = b"".join((each - 1).to_bytes(3, "little") for each in (width, height))
        body = _chunk(b"VP8X", bytes(4) + sides) + body
    elif not body.startswith(b"VP8X"):
        raise ValueError("The text of a WebP file goes behind a picture.")
    body += _chunk(_KIND, key.encode("ascii") + b"\0" + text.encode())
    return b"RIFF" + struct.pack("<I", 4 + len(body)) + b"WEBP" + body


def _chunk(kind: bytes, body: bytes) -> bytes:
    return kind + struct.pack("<I", len(body)) + body + b"\0" * (len(body) % 2)


def read_text(file: BinaryIO, key: str, limit: int) -> bytes | None:
    """Return the text with this key as UTF-8, or None when there is none.

    Parameters
    ----------
    file
        A WebP file, from its start.
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
    file.seek(12)
    for _ in range(_MAX_CHUNKS):
        head = file.read(8)
        if len(head) < 8:
            return None
        length = int.from_bytes(head[4:], "little")
        skipped = length + length % 2
        if head[:4] == _KIND and length >= len(start):
            if file.read(len(start)) == start:
                length -= len(start)
                if length > limit:
                    raise ValueError(f"is longer than {limit} bytes")
                text = file.read(length)
                if len(text) < length:
                    raise ValueError("is damaged")
                return text
            skipped -= len(start)
        file.seek(skipped, 1)
    return None
