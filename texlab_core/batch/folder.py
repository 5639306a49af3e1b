"""The folder of a batch: pictures, small pictures and records, each whole or not there; what is done is found.

A job is done when its record is there, fits its hash, rests on the measures and findings of this program, and the
picture it names has the length that it says. One whose numbers are an older program's is made again: they stand
in its picture, too, and many of them come from what no picture holds. The record is renamed into place after the
pictures, so that a process that is killed leaves either all of them or a job that is not done.
"""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.leftovers import is_leftover
from texlab_core.files.regular import open_appending, reason
from texlab_core.files.whole import write_pieces, write_together
from texlab_core.findings.revision import judged_by

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from texlab_core.batch.pictures import Picture

FORMAT = "texlab-batch-record"
VERSION = 1
PICTURES, RECORDS, THUMBNAILS, SCRATCH = "pictures", "records", "thumbnails", ".texlab-parcels"
LOCK = ".texlab-batch.lock"
TIMES = "times.csv"


@dataclass(frozen=True)
class Record:
    """A job that is done.

    Parameters
    ----------
    key
        Its hash.
    data
        What it was and what came out, as JSON data.
    """

    key: str
    data: Mapping[str, Any]


class BatchFolder:
    """Where a batch keeps its files; one process at a time.

    Use it as a context: it makes the folders, takes the lock, and removes what an earlier process left half
    written.

    Parameters
    ----------
    path
        Made when it is missing; its parent must be there.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self._lock: int | None = None
        self._times: Any = None

    def __enter__(self) -> Self:
        try:
            for each in (self.path, *(self.path / name for name in (PICTURES, RECORDS, THUMBNAILS))):
                each.mkdir(exist_ok=True)
            self._lock = os.open(self.path / LOCK, os.O_RDWR | os.O_CREAT, 0o666)
        except FileExistsError as error:
            raise InputError(f"{error.filename} is a file, and a folder is wanted.") from error
        except (OSError, ValueError) as error:
            raise InputError(f"{self.path}: cannot be made or written to ({reason(error)}).") from error
        if not _take(self._lock):
            os.close(self._lock)
            self._lock = None
            raise InputError(
                f"Another batch is at work in {self.path}; wait for its end, or choose another folder."
            )
        try:
            self._remove_leftovers()
            self._times = open_appending(self.path / TIMES)
            if not self._times.tell():
                self._note("job,seconds")
        except OSError as error:
            self.__exit__()
            raise InputError(f"{self.path / TIMES}: cannot be written ({reason(error)}).") from error
        except InputError:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        if self._times is not None:
            # What could not be written was said then.
            with contextlib.suppress(OSError):
                self._times.close()
            self._times = None
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    @property
    def scratch(self) -> Path:
        """A folder for what is needed while the batch runs."""
        return self.path / SCRATCH

    @property
    def has_records(self) -> bool:
        """Whether an earlier run has finished any job."""
        with os.scandir(self.path / RECORDS) as found:
            return any(True for _ in found)

    def done(self, key: str) -> Record | None:
        """Return the record of a job that is done, or None."""
        path = self.path / RECORDS / f"{key}.json"
        if not path.is_file():
            return None
        try:
            data = strict_json.load(path)
            strict_json.check_document(data, "record of a batch", form=FORMAT, version=VERSION)
            picture = self.path / data["picture"]
            small = self.path / data["thumbnail"]
            whole = data["job"] == key and data["judged_by"] == judged_by()
            whole = whole and picture.stat().st_size == data["bytes"] and small.is_file()
        except (InputError, KeyError, TypeError, OSError, ValueError):
            return None
        return Record(key, data) if whole else None

    def record(self, key: str) -> Record:
        """Return the record of a job that was done a moment ago; raises ``InputError`` when it is gone."""
        return Record(key, strict_json.load(self.path / RECORDS / f"{key}.json", what="the record of a job"))

    def keep(self, key: str, name: str, picture: Picture, about: Mapping[str, Any], elapsed_s: float) -> Record:
        """Write what a job made, the record last.

        Parameters
        ----------
        key
            The job's hash.
        name
            Start of the picture's file name; what no system accepts in one is replaced.
        picture
            What it made.
        about
            What it was, as JSON data.
        elapsed_s
            How long it took; kept apart from the records, which are the same each time.

        Raises
        ------
        InputError
            When a file cannot be written.
        """
        stem = f"{file_stem(name)}-{key[:10]}"
        data = {
            "format": FORMAT,
            "version": VERSION,
            "job": key,
            **about,
            "picture": f"{PICTURES}/{stem}{picture.suffix}",
            "thumbnail": f"{THUMBNAILS}/{stem}.png",
            "bytes": len(picture.png),
            "pixels_sha256": picture.sha256,
            "judged_by": judged_by(),
            "measures": dict(picture.measures),
            "findings": list(picture.findings),
            "notes": list(picture.notes),
        }
        write_together(
            {
                self.path / data["picture"]: picture.png,
                self.path / data["thumbnail"]: picture.thumbnail,
                self.path / RECORDS / f"{key}.json": strict_json.dumps(data).encode(),
            },
            # Looked through once, at the start: there may be very many files.
            clears=False,
        )
        if self._times is not None:
            self._note(f"{key},{elapsed_s:.3f}")
        return Record(key, data)

    def keep_exemplar(self, sha256: str, thumbnail: bytes | None = None) -> str | None:
        """Return the path of an exemplar's small picture, written when it is given; None when there is none."""
        name = f"{THUMBNAILS}/exemplar-{sha256[:20]}.png"
        if thumbnail is not None:
            write_together({self.path / name: thumbnail}, clears=False)
        return name if (self.path / name).is_file() else None

    def write(self, name: str, pieces: Iterable[str]) -> Path:
        """Write one of the batch's own files, piece by piece."""
        path = self.path / name
        write_pieces(path, (piece.encode() for piece in pieces))
        return path

    def _note(self, line: str) -> None:
        try:
            self._times.write(f"{line}\r\n")
            self._times.flush()
        except OSError as error:
            raise InputError(f"{self.path / TIMES}: cannot be written ({reason(error)}).") from error

    def _remove_leftovers(self) -> None:
        shutil.rmtree(self.scratch, ignore_errors=True)
        for folder in (self.path, *(self.path / name for name in (PICTURES, RECORDS, THUMBNAILS))):
            for each in os.scandir(folder):
                if is_leftover(each.name):
                    with contextlib.suppress(OSError):
                        os.unlink(each.path)


def file_stem(name: str) -> str:
    """Return a text as the start of a file name that every system accepts."""
    plain = re.sub(r"[^0-9A-Za-z.]+", "-", name.encode("ascii", "ignore").decode()).strip("-.")
    return plain[:80] or "texture"


def _take(descriptor: int) -> bool:
    """Lock a file until it is closed or the process ends, however that happens; False when another one has it."""
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
