"""Zip archives from outside: a few files of known names, bounded in number and size, and nothing else.

Reference: PKWARE's APPNOTE.TXT 6.3.10, 4.3 (general format).
"""

from __future__ import annotations

import io
import stat
import struct
import zipfile
import zlib
from typing import TYPE_CHECKING, BinaryIO

from texlab_core.errors import InputError
from texlab_core.files.regular import megabytes, open_regular, reason

if TYPE_CHECKING:
    import os
    import re
    from collections.abc import Mapping

SIGNATURE = b"PK\x03\x04"
_END = struct.Struct("<4s4H2IH")
_END_SIGNATURE = b"PK\x05\x06"
_PLAIN = (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED)
_ENCRYPTED = 0x1
_BLOCK = 2**20
# Packed already, so that packing again would only take time.
_STORED = (".png", ".jpg", ".webp")


def pack_archive(files: Mapping[str, bytes]) -> bytes:
    """Return a zip archive of these files, in their order; the same files give the same bytes."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, allowZip64=False) as archive:
        for name, data in files.items():
            info = zipfile.ZipInfo(name)
            info.external_attr = 0o644 << 16
            packed = zipfile.ZIP_STORED if name.endswith(_STORED) else zipfile.ZIP_DEFLATED
            archive.writestr(info, data, packed, 6)
    return out.getvalue()


def read_archive(
    path: str | os.PathLike[str],
    names: re.Pattern[str],
    *,
    max_files: int,
    max_bytes: int,
    error: type[InputError] = InputError,
) -> dict[str, bytes]:
    """Return the content of every file of an archive; nothing is ever written.

    Parameters
    ----------
    path
        A regular file.
    names
        What the whole name of a file must match; folders, paths that lead out and links match nothing.
    max_files, max_bytes
        Most files, and most bytes of the archive and of all files together.

    Raises
    ------
    InputError
        (or ``error``) when it is no such archive, or damaged; one sentence.
    """
    try:
        with open_regular(path) as file:
            return _read(file, names, max_files, max_bytes)
    except _RefusedError as refused:
        raise error(f"{path}: {refused}.") from refused
    except (OSError, ValueError) as bad:
        raise error(f"{path}: cannot be read ({reason(bad)}).") from bad


class _RefusedError(Exception):
    """Why; continues a sentence that starts with the file's name."""


def _read(file: BinaryIO, names: re.Pattern[str], max_files: int, max_bytes: int) -> dict[str, bytes]:
    size = file.seek(0, io.SEEK_END)
    if size > max_bytes:
        raise _RefusedError(f"is longer than {megabytes(max_bytes)}, the most that is read")
    _check_end(file, size, max_files)
    found: dict[str, bytes] = {}
    left = max_bytes
    try:
        with zipfile.ZipFile(file) as archive:
            for info in archive.infolist():
                _check_entry(info, names)
                if info.filename in found:
                    raise _RefusedError("is damaged (a file is there twice)")
                with archive.open(info) as entry:
                    # The size that it says is not believed.
                    data = bytearray()
                    while block := entry.read(min(_BLOCK, left + 1 - len(data))):
                        data += block
                        if len(data) > left:
                            raise _RefusedError(f"unpacks to more than {megabytes(max_bytes)}")
                left -= len(data)
                found[info.filename] = bytes(data)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, struct.error) as bad:
        raise _RefusedError("is damaged") from bad
    return found


def _check_end(file: BinaryIO, size: int, max_files: int) -> None:
    """Look at the end of the archive before its directory is read, whose length is not bounded otherwise."""
    file.seek(max(0, size - _END.size))
    end = file.read(_END.size)
    if len(end) < _END.size or not end.startswith(_END_SIGNATURE):
        raise _RefusedError("is damaged, or no archive of the program")
    _, disk, first, here, count, length, start, comment = _END.unpack(end)
    if disk or first or here != count or comment or start + length + _END.size != size:
        raise _RefusedError("is damaged, or no archive of the program")
    if count > max_files:
        raise _RefusedError(f"holds {count} files, and at most {max_files} are read")
    file.seek(0)


def _check_entry(info: zipfile.ZipInfo, names: re.Pattern[str]) -> None:
    mode = info.external_attr >> 16
    if not names.fullmatch(info.filename) or info.orig_filename != info.filename or "\\" in info.filename:
        raise _RefusedError(f"holds a file that does not belong there ({info.filename!r:.40})")
    if mode and not stat.S_ISREG(mode) and stat.S_IFMT(mode):
        raise _RefusedError(f"holds something that is no file ({info.filename!r:.40})")
    if info.flag_bits & _ENCRYPTED or info.compress_type not in _PLAIN:
        raise _RefusedError("is packed in a way that is not read")
