"""The sessions of all windows: each in a file of its own, locked while its window is open."""

from __future__ import annotations

import contextlib
import json
import logging
import os
import re
import stat
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QLockFile

from texlab.storage.kept_exemplar import FIRST_NAME
from texlab.storage.paths import config_dir
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.regular import read_regular, reason
from texlab_core.files.whole import write_whole

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path

log = logging.getLogger(__name__)

FOLDER = "sessions"
# Where the settings note which sessions of other windows have been told of.
TOLD = "told-sessions"
MAX_BYTES = 2**25
MAX_DEPTH = 64
# Nobody has more windows open; a folder full of files must not be looked through for ever.
MOST = 64
WAIT_MS = 10_000
MAX_SHOWN = 40

_NAME = re.compile(r"[1-9][0-9]{0,3}\.json")


@dataclass
class OwnSession:
    """The session of one window.

    Parameters
    ----------
    path
        Its file.
    lock
        Held until :meth:`release`; what a killed process held counts as free.
    saved
        What the file held when the window was opened; None where there was nothing.
    others
        Sessions that no window has now, the newest first.
    problem
        One sentence when a file was damaged.
    """

    path: Path
    lock: QLockFile
    saved: Any = None
    others: tuple[OtherSession, ...] = ()
    problem: str = ""

    @property
    def is_first(self) -> bool:
        """Whether the session of versions that had one for all windows went into this one."""
        return self.path.stem == "1"

    def write(self, session: Mapping[str, Any]) -> bool:
        """Write the session, and return whether that could be done; may be called in any thread."""
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            write_whole(self.path, json.dumps(session, indent=1).encode())
        except (OSError, InputError) as error:
            log.warning("The session could not be saved: %s", error)
            return False
        return True

    def release(self) -> None:
        """Let another window have it."""
        self.lock.unlock()


@dataclass(frozen=True)
class OtherSession:
    """A session that no window has: its number, when it was saved (ns), and what there is to say of it."""

    number: int
    saved_ns: int
    words: str


@dataclass(frozen=True)
class References:
    """Which kept files the sessions of all windows need."""

    exemplars: frozenset[str] = field(default_factory=frozenset)
    inputs: frozenset[str] = field(default_factory=frozenset)


def folder() -> Path:
    """Return where the sessions are (it may not exist)."""
    return config_dir() / FOLDER


def claim(of_old: Any = None, *, fresh: bool = False) -> OwnSession:
    """Return the session that was saved last and that no window has, or a new one.

    Parameters
    ----------
    of_old
        The session that versions with one session for all windows left in the settings; it stands for the first.
    fresh
        Return a new one: those that are kept stay as they are. Only where as many are kept as are ever looked at,
        the oldest one that no window has gives its place.
    """
    found = _saved()
    problems: list[str] = []
    own: OwnSession | None = None
    others: list[OtherSession] = []
    for _, path in sorted(found, reverse=True):
        lock = _lock(path)
        if not _take(lock):
            continue
        try:
            saved = _read(path)
        except (InputError, OSError) as error:
            problems.append(_put_aside(path, error))
            lock.unlock()
            continue
        if own is None and not fresh:
            own = OwnSession(path, lock, saved)
        else:
            others.append(OtherSession(int(path.stem), path.stat().st_mtime_ns, in_words(saved)))
            lock.unlock()
    if fresh and len(found) >= MOST and others:
        own = _in_place_of(others)
    if own is None:
        own = _new(of_old, first=2 if fresh and of_old is not None else 1)
    own.others, own.problem = tuple(others), " ".join(problems)
    return own


def _in_place_of(others: list[OtherSession]) -> OwnSession | None:
    """Return a new session in the file of the oldest of these, which is taken from the list."""
    path = folder() / f"{others[-1].number}.json"
    lock = _lock(path)
    if not _take(lock):
        return None
    others.pop()
    return OwnSession(path, lock)


def _new(of_old: Any, first: int = 1) -> OwnSession:
    for number in range(first, 10_000):
        path = folder() / f"{number}.json"
        if path.exists():
            continue
        lock = _lock(path)
        if _take(lock):
            return OwnSession(path, lock, of_old if number == 1 else None)
    raise InputError("There are more sessions than numbers for them.")


def references(of_old: Any = None) -> References | None:
    """Return what all sessions need; None when one cannot be read: then nothing may be removed."""
    try:
        listed = [_read(path) for _, path in _saved()]
    except (InputError, OSError) as error:
        log.warning("A session cannot be read, and every kept file stays: %s", error)
        return None
    exemplars, inputs = set(), set()
    for saved in (*listed, of_old):
        if not isinstance(saved, dict):
            continue
        sample = saved.get("sample")
        if isinstance(sample, dict):
            nameless = FIRST_NAME if sample.get("path") is None else ""
            exemplars.add(str(sample.get("kept", nameless)))
        columns = saved.get("columns")
        for column in columns if isinstance(columns, list) else []:
            given = column.get("inputs") if isinstance(column, dict) else None
            for each in given.values() if isinstance(given, dict) else ():
                if isinstance(each, dict):
                    inputs.add(str(each.get("sha256", "")))
    return References(frozenset(exemplars), frozenset(inputs))


@contextlib.contextmanager
def writing(name: str = "writing") -> Iterator[bool]:
    """Keep other windows from writing or removing kept files within the block; False when that takes too long."""
    with contextlib.suppress(OSError):
        folder().mkdir(parents=True, exist_ok=True)
    lock = QLockFile(str(folder() / f"{name}.lock"))
    held = _is_free_or_file(lock) and lock.tryLock(WAIT_MS)
    try:
        yield held
    finally:
        if held:
            lock.unlock()


def told_of_others(others: Sequence[OtherSession], values: dict[str, Any]) -> str:
    """Return one sentence about sessions that wait for another window, once for each; empty when all are known.

    What was said is noted in the settings' ``values``.
    """
    known = values.get(TOLD)
    told = known if isinstance(known, dict) else {}
    new = [each for each in others if told.get(str(each.number)) != each.saved_ns]
    values[TOLD] = {str(each.number): each.saved_ns for each in others}
    if not new:
        return ""
    if len(new) == 1:
        return (
            f"The session of another window is kept as well ({new[0].words}): File, Another window brings it back."
        )
    words = "; ".join(each.words for each in new)
    return (
        f"{len(new)} sessions of other windows are kept as well ({words}): File, Another window brings one back."
    )


def in_words(saved: Any) -> str:
    """Return what a session is, for people: "waves.png, 2 columns"."""
    data = saved if isinstance(saved, dict) else {}
    sample = data.get("sample")
    name = str(sample.get("name", "")) if isinstance(sample, dict) else ""
    columns = data.get("columns")
    count = len(columns) if isinstance(columns, list) else 0
    words = "1 column" if count == 1 else f"{count} columns"
    return f"{name if len(name) <= MAX_SHOWN else name[:MAX_SHOWN] + '...'}, {words}" if name else words


def _saved() -> list[tuple[int, Path]]:
    """Return the files of sessions with the time of their last change in nanoseconds."""
    try:
        paths = [path for path in folder().iterdir() if _NAME.fullmatch(path.name)]
    except OSError:
        return []
    found = []
    for path in sorted(paths, key=lambda each: int(each.stem))[:MOST]:
        with contextlib.suppress(OSError):
            found.append((path.stat().st_mtime_ns, path))
    return found


def _read(path: Path) -> Any:
    saved = strict_json.loads(read_regular(path, MAX_BYTES), max_bytes=MAX_BYTES, max_depth=MAX_DEPTH)
    if not isinstance(saved, dict):
        raise InputError("It is no object.")
    return saved


def _lock(path: Path) -> QLockFile:
    with contextlib.suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
    lock = QLockFile(str(path.with_suffix(".lock")))
    # Old age says nothing: a window may be open for weeks. That its process is dead does.
    lock.setStaleLockTime(0)
    return lock


def _take(lock: QLockFile) -> bool:
    """Take a lock unless another window has it; where nothing can be written nobody has."""
    if not _is_free_or_file(lock):
        return False
    return lock.tryLock(0) or lock.error() != QLockFile.LockError.LockFailedError


def _is_free_or_file(lock: QLockFile) -> bool:
    """Return whether nothing or a file is in the place of a lock: whoever asks a pipe waits for ever."""
    try:
        return stat.S_ISREG(os.stat(lock.fileName()).st_mode)
    except OSError:
        return not os.path.islink(lock.fileName())


def _put_aside(path: Path, error: Exception) -> str:
    broken = path.with_suffix(".broken.json")
    try:
        path.replace(broken)
    except OSError:
        return f"The session in {path} cannot be read ({reason(error)})."
    return f"A session is damaged and was left out. The file was kept as {broken}."
