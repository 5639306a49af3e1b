"""Temporary files: named by the process that writes them, so that those of dead processes can be cleared away."""

from __future__ import annotations

import contextlib
import functools
import hashlib
import os
import platform
import re
import secrets
import sys
import threading
import time
from pathlib import Path

_DAY_S = 86_400
_OURS = re.compile(r"\.texlab-(?P<host>[0-9a-f]{8})-(?P<process>[0-9]{1,10})-[0-9a-f]{16}\.(?:tmp|old)")
_NAMELESS = re.compile(r"\.texlab-[0-9a-f]{16}\.tmp")

_live: set[str] = set()
_lock = threading.Lock()


def reserve(folder: Path, suffix: str = ".tmp") -> Path:
    """Return a name for a temporary file in a folder; it counts as in use until :func:`release` is called."""
    name = f".texlab-{_host()}-{os.getpid()}-{secrets.token_hex(8)}{suffix}"
    with _lock:
        _live.add(name)
    return folder / name


def release(path: Path) -> None:
    """Remove a temporary file, where it still is, and give its name back."""
    with contextlib.suppress(OSError):
        path.unlink(missing_ok=True)
    with _lock:
        _live.discard(path.name)


def is_leftover(name: str) -> bool:
    """Return whether a file is called as temporary ones are."""
    return bool(_OURS.fullmatch(name) or _NAMELESS.fullmatch(name))


def sweep(folder: Path) -> tuple[Path, ...]:
    """Remove what processes that are dead by now have left in a folder.

    Files of other machines, and those that do not say whose they are, are dead after a day: no file takes so long
    to be written.

    Parameters
    ----------
    folder
        It may be missing.

    Returns
    -------
    tuple of Path
        What was removed.
    """
    removed = []
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        for entry in entries:
            if not entry.name.startswith(".texlab-"):
                continue
            with contextlib.suppress(OSError):
                if entry.is_file(follow_symlinks=False) and _is_dead(entry):
                    os.unlink(entry.path)
                    removed.append(Path(entry.path))
    return tuple(removed)


def _is_dead(entry: os.DirEntry[str]) -> bool:
    if not is_leftover(entry.name):
        return False
    found = _OURS.fullmatch(entry.name)
    if found is not None and found["host"] == _host():
        process = int(found["process"])
        if process == os.getpid():
            with _lock:
                return entry.name not in _live
        if not _is_running(process):
            return True
    # Numbers of processes are used again.
    return time.time() - entry.stat(follow_symlinks=False).st_mtime > _DAY_S


@functools.cache
def _host() -> str:
    return hashlib.blake2b(platform.node().encode(), digest_size=4).hexdigest()


if sys.platform == "win32":

    def _is_running(process: int) -> bool:
        import ctypes

        still_active, may_query = 259, 0x1000
        kernel = ctypes.windll.kernel32
        handle = kernel.OpenProcess(may_query, False, process)
        if not handle:
            return False
        code = ctypes.c_ulong()
        known = kernel.GetExitCodeProcess(handle, ctypes.byref(code))
        kernel.CloseHandle(handle)
        return not known or code.value == still_active

else:

    def _is_running(process: int) -> bool:
        try:
            os.kill(process, 0)
        except (ProcessLookupError, OverflowError):
            return False
        except PermissionError:
            return True
        return True
