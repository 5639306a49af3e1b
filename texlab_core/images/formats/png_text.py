"""Text in PNG files: put in uncompressed, found again without decoding the image."""

from __future__ import annotations

import struct
import zlib
from typing import TYPE_CHECKING, BinaryIO

if TYPE_CHECKING:
    from collections.abc import Mapping

SIGNATURE = b"\x89PNG\r\n\x1a\n"
_AFTER_HEADER = 33
_MAX_KEY = 79
_MAX_CHUNKS = 200_000


def with_text(png: bytes, text: Mapping[str, str]) -> bytes:
    """Return the file with text chunks after its header, readable by any program.

    Parameters
    ----------
    png
        A PNG file.
    text
        Keys of 1 to 79 Latin-1 characters, and their texts (PNG specification, section 11.3.4).

    Raises
    ------
    ValueError
        When a key is too long or empty.
    """
    chunks = [_text_chunk(key, value) for key, value in text.items()]
    return b"".join([png[:_AFTER_HEADER], *chunks, png[_AFTER_HEADER:]])


def with_chunk(png: bytes, kind: bytes, body: bytes) -> bytes:
    """Return the file with a chunk after its header."""
    return b"".join([png[:_AFTER_HEADER], chunk(kind, body), png[_AFTER_HEADER:]])


def _text_chunk(key: str, value: str) -> bytes:
    name = key.encode("latin-1")
    if not 1 <= len(name) <= _MAX_KEY or b"\0" in name:
        raise ValueError(f"A PNG text key has 1 to {_MAX_KEY} characters, got {key!r}.")
    try:
        return chunk(b"tEXt", name + b"\0" + value.encode("latin-1"))
    except UnicodeEncodeError:
        # Uncompressed, without language and translated key.
        return chunk(b"iTXt", name + b"\0\0\0\0\0" + value.encode())


def chunk(kind: bytes, body: bytes) -> bytes:
    """Return a chunk with its length and checksum (PNG specification, section 5.3)."""
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def read_text(file: BinaryIO, key: str, limit: int) -> str | None:
    """Return the text with this key, or None when there is none.

    Parameters
    ----------
    file
        A PNG file, from its start.
    key
        The key of the text chunk.
    limit
        Longest text that is read, in bytes, compressed or not.

    Raises
    ------
    ValueError
        When the text is too long or damaged; the message continues a sentence about it.
    """
    file.seek(len(SIGNATURE))
    start = key.encode("latin-1") + b"\0"
    for _ in range(_MAX_CHUNKS):
        head = file.read(8)
        if len(head) < 8 or head[4:] == b"IEND":
            return None
        length, kind = int.from_bytes(head[:4], "big"), head[4:]
        if kind not in (b"tEXt", b"zTXt", b"iTXt"):
            file.seek(length + 4, 1)
            continue
        body = file.read(min(length, len(start)))
        if body != start:
            file.seek(length - len(body) + 4, 1)
            continue
        if length > limit:
            raise ValueError(f"is longer than {limit} bytes")
        body += file.read(length - len(body))
        if len(body) < length or file.read(4) != struct.pack(">I", zlib.crc32(kind + body)):
            raise ValueError("is damaged")
        return _decode(kind, body[len(start) :], limit)
    return None


def _decode(kind: bytes, body: bytes, limit: int) -> str:
    if kind == b"tEXt":
        return body.decode("latin-1")
    if kind == b"zTXt":
        return inflate(body[1:], limit).decode("latin-1")
    # Flag and method of compression, then language and translated key.
    parts = body[2:].split(b"\0", 2)
    if len(parts) < 3:
        raise ValueError("is damaged")
    text = inflate(parts[2], limit) if body[0] else parts[2]
    try:
        return text.decode()
    except UnicodeDecodeError as error:
        raise ValueError("is damaged") from error


def inflate(data: bytes, limit: int) -> bytes:
    """Return what zlib compressed, if it is whole and at most ``limit`` bytes; never makes more than that.

    Raises
    ------
    ValueError
        Otherwise; the message continues a sentence.
    """
    machine = zlib.decompressobj()
    try:
        found = machine.decompress(data, limit + 1)
    except zlib.error as error:
        raise ValueError("is damaged") from error
    if len(found) > limit:
        raise ValueError(f"is longer than {limit} bytes")
    if not machine.eof:
        raise ValueError("is damaged")
    return found
