"""Finished results on the disk, by their job: a session of hours ago, or of the last start, shows them at once."""

from __future__ import annotations

import hashlib
import json
import logging
import os
import platform
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab.runs.column_run import Finished, Measured
from texlab.state.scene import Frame
from texlab.storage.arrays import pack, unpack
from texlab.style.pictures import to_picture
from texlab_core.engine.registry import find_method
from texlab_core.engine.result import Result
from texlab_core.engine.run import versions_for
from texlab_core.engine.steps import Curve, Map
from texlab_core.errors import InputError
from texlab_core.files import strict_json
from texlab_core.files.leftovers import sweep
from texlab_core.files.whole import write_whole
from texlab_core.findings.finding import Finding, Region, Remedy, Where

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from texlab_core.engine.job import Job

log = logging.getLogger(__name__)

VERSION = 1
SUFFIX = ".result"
# What all of them may take, and one of them.
MAX_BYTES = 2**30
MAX_ONE = 2**29
MAX_HEAD = 2**22

_NAME = re.compile(r"[0-9a-f]{64}\.result")


class StoredResults:
    """A folder of results that several windows share; none of this belongs into the window's thread.

    What is not there, damaged, foreign, or of another version or machine is a missing result, never an error.

    Parameters
    ----------
    folder
        It is made when there is something to keep.
    max_bytes
        How much the files may take together; those that were not used for longest go first.
    """

    def __init__(self, folder: Path, max_bytes: int = MAX_BYTES) -> None:
        self.folder = folder
        self._max_bytes = max_bytes

    def get(self, job: Job) -> tuple[Finished, Measured] | None:
        """Return what a job came to, without what its method's own views need; None when that is not known."""
        identity = identity_of(job)
        path = self._path(identity)
        if not path.is_file():
            return None
        try:
            arrays = unpack(path, MAX_ONE + MAX_HEAD)
            head = strict_json.loads(arrays["head"].tobytes(), max_bytes=MAX_HEAD)
            if head["job"] != identity:
                raise ValueError("it belongs to another job")
            found = _restored(job, head, arrays)
        except MemoryError:
            return None
        except Exception as error:
            # Whatever such a file holds by now: the result is made again, and takes its place.
            log.warning("%s: the kept result cannot be used (%s).", path.name, error)
            _remove(path)
            return None
        _touch(path)
        return found

    def put(self, end: Finished, measured: Measured) -> bool:
        """Keep a finished result with its numbers and findings; return whether it lies on the disk now."""
        identity = identity_of(end.result.job)
        path = self._path(identity)
        try:
            if path.is_file():
                _touch(path)
                return True
            arrays = _arrays(end, measured, identity)
            if sum(each.nbytes for each in arrays.values()) > min(MAX_ONE, self._max_bytes):
                return False
            self.folder.mkdir(parents=True, exist_ok=True)
            write_whole(path, pack(arrays))
            self._make_room()
        except (OSError, ValueError, InputError) as error:
            log.warning("A result could not be kept on the disk: %s", error)
            return False
        return path.is_file()

    def clear(self) -> tuple[int, int]:
        """Remove every kept result; return how many there were, and their bytes."""
        listed = self._listed()
        for _, _, path in listed:
            _remove(path)
        sweep(self.folder)
        return len(listed), sum(size for _, size, _ in listed)

    @property
    def nbytes(self) -> int:
        """Bytes of all files."""
        return sum(size for _, size, _ in self._listed())

    def _path(self, identity: Mapping[str, Any]) -> Path:
        text = json.dumps(identity, sort_keys=True)
        return self.folder / f"{hashlib.sha256(text.encode()).hexdigest()}{SUFFIX}"

    def _listed(self) -> list[tuple[int, int, Path]]:
        """Return time of the last use, bytes and path of every file, the one not used for longest first."""
        listed = []
        try:
            with os.scandir(self.folder) as entries:
                for entry in entries:
                    if _NAME.fullmatch(entry.name) and entry.is_file(follow_symlinks=False):
                        found = entry.stat(follow_symlinks=False)
                        listed.append((found.st_mtime_ns, found.st_size, self.folder / entry.name))
        except OSError:
            # It is not there, or another window has just removed a file: what was seen until then counts.
            pass
        return sorted(listed)

    def _make_room(self) -> None:
        sweep(self.folder)
        listed = self._listed()
        held = sum(size for _, size, _ in listed)
        for _, size, path in listed:
            if held <= self._max_bytes:
                return
            _remove(path)
            held -= size


def identity_of(job: Job) -> dict[str, Any]:
    """Return everything that the bits of a result depend on, as JSON data: the job, the versions, the machine."""
    return {
        "version": VERSION,
        "method": job.method,
        "inputs": {name: job.inputs[name].sha256 for name in sorted(job.inputs)},
        "params": json.loads(json.dumps(job.params.to_json())),
        "size": list(job.size),
        "seed": job.seed,
        "versions": dict(versions_for(find_method(job.method))),
        "machine": [platform.system(), platform.machine(), platform.node()],
    }


def _arrays(end: Finished, measured: Measured, identity: Mapping[str, Any]) -> dict[str, np.ndarray[Any, Any]]:
    result = end.result
    arrays: dict[str, np.ndarray[Any, Any]] = {"image": result.image}
    if result.volume is not None:
        arrays["volume"] = result.volume
    arrays |= {f"frame-{place}": each.picture for place, each in enumerate(end.frames)}
    maps = dict(result.maps)
    arrays |= {f"map-{name}": each.data for name, each in maps.items()}
    for name, curve in result.curves.items():
        arrays |= {f"x-{name}": curve.x, f"y-{name}": curve.y}
    head = {
        "job": identity,
        "elapsed_s": result.elapsed_s,
        "notes": list(result.notes),
        "said": {name: float(value) for name, value in result.measures.items()},
        "metrics": {name: float(value) for name, value in end.metrics.items()},
        "frames": [each.name for each in end.frames],
        "maps": {name: [each.kind, each.title, each.unit] for name, each in maps.items()},
        "curves": {
            name: [each.title, each.x_label, each.y_label, each.reference] for name, each in result.curves.items()
        },
        "measures": {name: float(value) for name, value in measured.measures.items()},
        "measured_size": list(measured.size),
        "findings": None if measured.findings is None else [each.to_json() for each in measured.findings],
        "unexamined": measured.unexamined,
    }
    return {"head": np.frombuffer(json.dumps(head, allow_nan=False).encode(), np.uint8), **arrays}


def _restored(job: Job, head: Mapping[str, Any], arrays: Mapping[str, Any]) -> tuple[Finished, Measured]:
    image = arrays["image"]
    channels = image.shape[2]
    if image.shape != (*job.picture_size, channels) or channels not in (1, 3) or image.dtype != np.float32:
        raise ValueError("its picture has another form")
    result = Result(
        job=job,
        model=None,
        image=image,
        volume=arrays.get("volume"),
        maps={name: Map(arrays[f"map-{name}"], *each) for name, each in head["maps"].items()},
        curves={
            name: Curve(arrays[f"x-{name}"], arrays[f"y-{name}"], *each) for name, each in head["curves"].items()
        },
        measures=head["said"],
        notes=tuple(head["notes"]),
        details=None,
        elapsed_s=head["elapsed_s"],
        versions=versions_for(find_method(job.method)),
    )
    frames = tuple(Frame(name, arrays[f"frame-{place}"]) for place, name in enumerate(head["frames"]))
    found = head["findings"]
    height, width = head["measured_size"]
    measured = Measured(
        head["measures"],
        (height, width),
        None if found is None else tuple(_finding(each) for each in found),
        head["unexamined"],
    )
    end = Finished(result, to_picture(image), frames, draft=False, metrics=head["metrics"], stored=True)
    return end, measured


def _finding(data: Mapping[str, Any]) -> Finding:
    where, remedy = data["where"], data["try"]
    return Finding(
        id=data["id"],
        title=data["title"],
        what=data["what"],
        where=Where(
            where["place"],
            where["words"],
            tuple(Region(**each) for each in where["regions"]),
            tuple(where["bands"]),
        ),
        why=data["why"],
        remedy=Remedy(remedy["words"], remedy["params"], remedy["method"] or ""),
        certainty=data["certainty"],
        measures=tuple(data["measures"]),
    )


def _touch(path: Path) -> None:
    try:
        os.utime(path)
    except OSError as error:
        log.info("%s: %s", path.name, error)


def _remove(path: Path) -> None:
    try:
        path.unlink(missing_ok=True)
    except OSError as error:
        log.warning("%s could not be removed: %s", path.name, error)
