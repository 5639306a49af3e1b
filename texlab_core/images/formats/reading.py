"""Read image files into arrays of stored values: sizes are checked from the header, before anything is decoded."""

from __future__ import annotations

import os
import stat
import sys
import tempfile
from typing import TYPE_CHECKING, BinaryIO

from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import Decoded, Gate, HeavyError
from texlab_core.images.formats.kinds import READABLE_SUFFIXES, decode_open

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    Stop = Callable[[], bool] | None


MAX_FILE_BYTES = 2 * 2**30
_SHOWN = 3


def read_image(
    source: Path | bytes, name: str, *, scale: float = 1.0, reduced: bool = False, should_stop: Stop = None
) -> Decoded:
    """Read an image file.

    Parameters
    ----------
    source
        Path of the file, or its bytes.
    name
        How messages call it.
    scale, reduced
        The picture will be scaled by this factor, or cropped as well: one of up to 256 megapixels is decoded, and
        some decoders may reduce a larger one (see ``Decoded.full_size``).
    should_stop
        Asked while a large file is decoded, in a process of its own.

    Raises
    ------
    ImageError
        When it is missing, no regular file, not an image of a known format, damaged, empty, larger than 64
        megapixels, or takes far more time or memory than a picture of its size.
    Cancelled
        When ``should_stop`` said so.
    """
    if isinstance(source, bytes):
        import io

        gate = Gate(name, len(source), scale, reduced)
        return _decode(io.BytesIO(source), gate, should_stop)
    try:
        with open(source, "rb", opener=_open_at_once) as file:
            mode, length = os.fstat(file.fileno()).st_mode, os.fstat(file.fileno()).st_size
            if not stat.S_ISREG(mode):
                raise ImageError(f"{name}: is not a regular file.")
            if length > MAX_FILE_BYTES:
                raise ImageError(
                    f"{name}: has {length} bytes; files of at most {MAX_FILE_BYTES // 2**30} GB are read."
                )
            return _decode(file, Gate(name, length, scale, reduced), should_stop)
    except FileNotFoundError:
        raise ImageError(f"{name}: there is no such file.") from None
    except IsADirectoryError:
        raise ImageError(_folder(source, name)) from None
    except ImageError:
        raise
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise ImageError(f"{name}: cannot be opened ({reason}).") from error


def _open_at_once(path: str, flags: int) -> int:
    """Open without waiting for the other end of a pipe."""
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def _folder(path: Path, name: str) -> str:
    """Say that a folder is none, and which pictures it has."""
    try:
        names = sorted(each.name for each in os.scandir(path) if each.name.lower().endswith(READABLE_SUFFIXES))
    except OSError:
        names = []
    if not names:
        return f"{name}: is a folder, not an image, and there are no pictures in it."
    shown = ", ".join(names[:_SHOWN])
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return f"{name}: is a folder, not an image; its pictures: {shown}{more}."


def _decode(file: BinaryIO, gate: Gate, should_stop: Stop) -> Decoded:
    try:
        return decode_open(file, gate)
    except HeavyError as heavy:
        budget = heavy
    if getattr(sys, "frozen", False):
        # The program has no Python beside it that another process could run.
        gate.apart = True
        file.seek(0)
        return decode_open(file, gate)
    from texlab_core.images.formats.apart import decode_apart

    if not hasattr(file, "getbuffer"):
        return decode_apart(file, gate, budget, should_stop)
    with tempfile.TemporaryFile() as copy:
        copy.write(file.getbuffer())
        copy.flush()
        return decode_apart(copy, gate, budget, should_stop)


def display_name(path: str | os.PathLike[str]) -> str:
    """Return the last part of a path."""
    return os.path.basename(os.fspath(path)) or os.fspath(path)
