"""Write files whole or not at all, and sets of files so that no half of two sets is ever taken for one."""

from __future__ import annotations

import errno
import os
import shutil
import stat
from pathlib import Path
from typing import TYPE_CHECKING

from texlab_core.errors import InputError
from texlab_core.files.leftovers import release, reserve, sweep
from texlab_core.files.regular import reason

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_NEW = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_CLOEXEC", 0) | getattr(os, "O_BINARY", 0)


def write_whole(path: str | os.PathLike[str], data: bytes) -> None:
    """Write a file under a temporary name in its folder, then rename it: readers see the old file or the new one.

    Raises
    ------
    InputError
        When it cannot be written; what was there before stays as it was.
    """
    write_together({Path(path): data})


def write_pieces(path: str | os.PathLike[str], pieces: Iterable[bytes]) -> None:
    """Write a file like :func:`write_whole`, from pieces that are made as they are written.

    Raises
    ------
    InputError
        When it cannot be written; what was there before stays as it was.
    """
    temporary: Path | None = None
    try:
        target = _target(Path(path))
        sweep(target.parent)
        temporary = reserve(target.parent)
        _stage(temporary, target, pieces)
        _commit([(temporary, target)])
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be written ({reason(error)}).") from error
    finally:
        if temporary is not None:
            release(temporary)


def write_together(
    contents: Mapping[Path, bytes], *, manifest: tuple[Path, bytes] | None = None, clears: bool = True
) -> None:
    """Write files that belong together; none is renamed before all of them are on the disk.

    A file that is there already keeps its permissions. What dead processes have left in the folders is cleared.

    Parameters
    ----------
    contents
        What each file holds, by its path.
    manifest
        The one among them that names the others, and what it holds while they are replaced. It is replaced first
        and last: whenever the program ends, and be it by force, the files that it names are those of one set.
    clears
        False where the caller has cleared the folders, which takes as long as they have files.

    Raises
    ------
    InputError
        When one cannot be written, or is there and write-protected or no file; then all stay as they were.
    """
    name = ""
    staged: list[tuple[Path, Path]] = []
    try:
        targets: dict[Path, bytes] = {}
        for path, data in contents.items():
            name = str(path)
            target = _target(path)
            if target in targets:
                raise OSError(errno.EEXIST, "two files would be written under this name")
            targets[target] = data
        for folder in {target.parent for target in targets} if clears else ():
            sweep(folder)
        for target, data in targets.items():
            name = str(target)
            staged.append((reserve(target.parent), target))
            _stage(*staged[-1], (data,))
        if manifest is not None:
            name, last = str(manifest[0]), _target(manifest[0])
            staged.sort(key=lambda pair: pair[1] == last)
            staged.insert(0, (reserve(last.parent), last))
            _stage(*staged[0], (manifest[1],))
        name = ", ".join(str(target) for _, target in staged)
        _commit(staged)
    except (OSError, ValueError) as error:
        raise InputError(f"{name}: cannot be written ({reason(error)}).") from error
    finally:
        for temporary, _ in staged:
            release(temporary)


def check_target(path: str | os.PathLike[str]) -> Path:
    """Return the path of a file that can be written, as far as can be told beforehand.

    Raises
    ------
    InputError
        When the name is empty, or what it names is a folder, a pipe, a device, a link that leads nowhere or
        write-protected, or when its folder does not exist.
    """
    text = os.fspath(path)
    if not text:
        raise InputError("The name of the file to write is empty.")
    try:
        target = _target(Path(path))
    except IsADirectoryError:
        raise InputError(f"{text} is a folder, and a file is wanted.") from None
    except (OSError, ValueError) as error:
        raise InputError(f"{text}: cannot be written ({reason(error)}).") from error
    if not target.parent.is_dir():
        raise InputError(
            f"The folder {target.parent if Path(path).is_symlink() else Path(path).parent} does not exist."
        )
    return Path(path)


def _target(path: Path) -> Path:
    """Return what a path stands for: a link keeps pointing to its file, which is replaced."""
    target = Path(os.path.realpath(path))
    try:
        mode = os.stat(path).st_mode
    except FileNotFoundError:
        if path.is_symlink():
            # Whoever made the link did not mean to make the file.
            raise OSError(errno.ENOENT, "it is a link to a file that does not exist") from None
        return target
    if stat.S_ISDIR(mode):
        raise IsADirectoryError(errno.EISDIR, "it is a folder")
    # The rename would put a file in the place of a device or a pipe.
    if not stat.S_ISREG(mode):
        raise OSError(errno.EINVAL, "it is no regular file")
    # The rename itself would not ask.
    if not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, "it is write-protected")
    return target


def _stage(temporary: Path, target: Path, pieces: Iterable[bytes]) -> None:
    descriptor = os.open(temporary, _NEW, 0o666)
    try:
        for piece in pieces:
            rest = memoryview(piece)
            while rest:
                rest = rest[os.write(descriptor, rest) :]
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
    if target.is_file():
        shutil.copymode(target, temporary)


def _commit(staged: list[tuple[Path, Path]]) -> None:
    """Rename all, or bring back what was there."""
    if len(staged) == 1:
        os.replace(*staged[0])
        return
    kept: dict[Path, Path | None] = {}
    try:
        for temporary, target in staged:
            if target not in kept:
                kept[target] = _keep(target)
            os.replace(temporary, target)
    except BaseException:
        # The manifest was the first to go and is the last to return.
        for target, old in reversed(kept.items()):
            if old is None:
                target.unlink(missing_ok=True)
            else:
                os.replace(old, target)
        raise
    finally:
        for old in kept.values():
            if old is not None:
                release(old)


def _keep(target: Path) -> Path | None:
    """Return a second name of what is there, or None where nothing is."""
    if not target.exists():
        return None
    old = reserve(target.parent, ".old")
    try:
        os.link(target, old)
    except OSError:
        # Some file systems know one name only.
        shutil.copy2(target, old)
    return old
