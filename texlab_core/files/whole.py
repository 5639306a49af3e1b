"""Write files whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping


def write_whole(path: str | os.PathLike[str], data: bytes) -> None:
    """Write a file under a temporary name in its folder, then rename it: readers see the old file or the new one.

    Raises
    ------
    InputError
        When it cannot be written; what was there before stays as it was.
    """
    write_together({Path(path): data})


def write_together(contents: Mapping[Path, bytes]) -> None:
    """Write files that belong together; none is renamed before all of them are on the disk.

    Parameters
    ----------
    contents
        What each file holds, by its path. A file that is there already keeps its permissions.

    Raises
    ------
    InputError
        When one cannot be written, or is there and write-protected or no file; then all stay as they were.
    """
    made: list[tuple[Path, Path]] = []
    name = ""
    try:
        for path, data in contents.items():
            name = str(path)
            # A link keeps pointing to its file, which is replaced.
            target = Path(os.path.realpath(path))
            temporary = target.with_name(f".texlab-{secrets.token_hex(8)}.tmp")
            made.append((temporary, target))
            _write(temporary, target, data)
        for temporary, target in made:
            name = str(target)
            os.replace(temporary, target)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"{name}: cannot be written ({reason}).") from error
    finally:
        for temporary, _ in made:
            with contextlib.suppress(OSError):
                temporary.unlink(missing_ok=True)


def _write(temporary: Path, target: Path, data: bytes) -> None:
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, "it is a folder")
    # The rename would put a file in the place of a device or a pipe.
    if target.exists() and not target.is_file():
        raise OSError(errno.EINVAL, "it is no regular file")
    # The rename itself would not ask.
    if target.exists() and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, "it is write-protected")
    with open(temporary, "xb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    if target.is_file():
        shutil.copymode(target, temporary)
