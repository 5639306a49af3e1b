"""Read files from outside: regular ones only, up to a limit, and never waiting for one that gives nothing."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from typing import TYPE_CHECKING, BinaryIO, TextIO

if TYPE_CHECKING:
    from collections.abc import Iterator

_BLOCK = 2**20
# A pipe without a writer answers at once, and no terminal becomes the program's own.
_FLAGS = (
    os.O_RDONLY
    | getattr(os, "O_NONBLOCK", 0)
    | getattr(os, "O_NOCTTY", 0)
    | getattr(os, "O_CLOEXEC", 0)
    | getattr(os, "O_BINARY", 0)
)


class TooLongError(OSError):
    """A file that is longer than what is read of it.

    Parameters
    ----------
    limit
        Most bytes that are read.
    """

    def __init__(self, limit: int) -> None:
        super().__init__(errno.EFBIG, f"it is longer than {megabytes(limit)}, the most that is read")
        self.limit = limit


def open_descriptor(path: str | os.PathLike[str]) -> int:
    """Open a regular file for reading and return its descriptor.

    What is opened is what was looked at: the kind is asked of the descriptor, not of the name.

    Raises
    ------
    OSError
        When it is missing, cannot be opened, or is a folder, a pipe, a device or a socket; ``strerror`` says so.
    ValueError
        When the name holds a null character.
    """
    # Opening some devices has effects of its own, so that the name is asked first.
    _check_kind(os.stat(path).st_mode, path)
    descriptor = os.open(path, _FLAGS)
    try:
        _check_kind(os.fstat(descriptor).st_mode, path)
    except BaseException:
        os.close(descriptor)
        raise
    return descriptor


def _check_kind(mode: int, path: str | os.PathLike[str]) -> None:
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, "it is a folder", os.fspath(path))
    if not stat.S_ISREG(mode):
        raise OSError(errno.EINVAL, "it is no regular file", os.fspath(path))


@contextlib.contextmanager
def open_regular(path: str | os.PathLike[str]) -> Iterator[BinaryIO]:
    """Open a regular file for reading within the block; raises as :func:`open_descriptor` does.

    Whoever reads it bounds what is read: a regular file may grow while it is read.
    """
    with os.fdopen(open_descriptor(path), "rb") as file:
        yield file


def read_regular(path: str | os.PathLike[str], max_bytes: int) -> bytes:
    """Return the content of a regular file.

    Parameters
    ----------
    path
        Where it is; links are followed.
    max_bytes
        Longest file that is read; of a longer one nothing is kept.

    Raises
    ------
    TooLongError
        When it is longer.
    OSError, ValueError
        As for :func:`open_descriptor`.
    """
    descriptor = open_descriptor(path)
    try:
        if os.fstat(descriptor).st_size > max_bytes:
            raise TooLongError(max_bytes)
        found = bytearray()
        # Files of the system say 0 and go on without end.
        while len(found) <= max_bytes:
            block = os.read(descriptor, min(_BLOCK, max_bytes + 1 - len(found)))
            if not block:
                return bytes(found)
            found += block
        raise TooLongError(max_bytes)
    finally:
        os.close(descriptor)


def open_appending(path: str | os.PathLike[str]) -> TextIO:
    """Open a log for writing at its end, made if need be.

    Raises
    ------
    OSError
        When it cannot be opened, or is a folder, a pipe, a device or a socket.
    """
    with contextlib.suppress(FileNotFoundError):
        _check_kind(os.stat(path).st_mode, path)
    descriptor = os.open(path, os.O_WRONLY | os.O_APPEND | os.O_CREAT | _FLAGS, 0o666)
    try:
        _check_kind(os.fstat(descriptor).st_mode, path)
    except BaseException:
        os.close(descriptor)
        raise
    return os.fdopen(descriptor, "a", encoding="utf-8", errors="backslashreplace", newline="")


def reason(error: BaseException) -> str:
    """Return why something could not be read or written, as a clause."""
    return str(getattr(error, "strerror", None) or error).rstrip(".")


def megabytes(count: int) -> str:
    """Return a number of bytes for people."""
    return f"{count} bytes" if count < 10_000 else f"{count / 2**20:.3g} MB"
