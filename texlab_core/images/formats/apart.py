"""Decoding in a process of its own: it can be stopped at once, has a budget, and its libraries are not heard.

What a file costs to decode is known from its header only in part, and no decoder can be interrupted; a process
can.
The parent gives the open file, the child answers with one line of JSON and the samples, through a file without a
name. The child ends by itself when its parent has gone.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np

from texlab_core.errors import Cancelled, ImageError
from texlab_core.images.formats.decoded import Decoded, Gate, HeavyError

if TYPE_CHECKING:
    from collections.abc import Callable

_LOOK_S = 0.02
_WATCH_S = 0.2
_MAX_LINE = 2**20
_START = (
    "import json, sys; path, job = json.loads(sys.argv[1]); sys.path[:] = path; "
    "from {module} import child; child(job)"
)


def decode_apart(
    file: BinaryIO, gate: Gate, heavy: HeavyError, should_stop: Callable[[], bool] | None = None
) -> Decoded:
    """Decode an open file in another process.

    Parameters
    ----------
    file
        A regular file.
    gate
        As the reader got it.
    heavy
        The budget.
    should_stop
        Asked every 20 ms; when it says so, the process is ended.

    Raises
    ------
    ImageError
        When the file cannot be decoded, or takes more time or memory than its size in pixels explains.
    Cancelled
        When ``should_stop`` said so.
    """
    job = {
        "name": gate.name,
        "length": gate.length,
        "scale": gate.scale,
        "reduced": gate.reduced,
        "memory": heavy.memory,
        "seconds": heavy.seconds,
        "parent": os.getpid(),
    }
    command = [sys.executable, "-c", _START.format(module=__name__), json.dumps([sys.path, job])]
    os.lseek(file.fileno(), 0, os.SEEK_SET)
    with tempfile.TemporaryFile() as answer:
        process = subprocess.Popen(
            command,
            stdin=file,
            stdout=answer,
            stderr=subprocess.DEVNULL,
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
        try:
            late = _wait(process, heavy.seconds, should_stop)
        finally:
            if process.poll() is None:
                process.kill()
            process.wait()
        if late:
            raise ImageError(f"{gate.name}: took more than {heavy.seconds:.0f} s to decode, and was given up.")
        return _answer(answer, process.returncode, gate.name, heavy)


def _wait(process: subprocess.Popen[bytes], seconds: float, should_stop: Callable[[], bool] | None) -> bool:
    """Return whether the time is over before the process has ended."""
    end = time.monotonic() + seconds
    while True:
        if should_stop is not None and should_stop():
            raise Cancelled
        try:
            process.wait(_LOOK_S)
        except subprocess.TimeoutExpired:
            if time.monotonic() > end:
                return True
        else:
            return False


def _answer(answer: BinaryIO, code: int, name: str, heavy: HeavyError) -> Decoded:
    answer.seek(0)
    line = answer.readline(_MAX_LINE)
    if not line.endswith(b"\n"):
        raise ImageError(
            f"{name}: the image is damaged, or takes more than {heavy.memory / 2**30:.1f} GB to decode (the "
            f"decoder ended with {code})."
        )
    head = json.loads(line)
    if "error" in head:
        raise ImageError(head["error"])
    values = np.empty(head["shape"], np.dtype(head["dtype"]))
    if answer.readinto(values.reshape(-1).view(np.uint8).data) != values.nbytes:  # type: ignore[attr-defined]
        raise ImageError(f"{name}: there is not enough room for the decoded image in {tempfile.gettempdir()}.")
    full = head["full_size"]
    return Decoded(
        values,
        head["peak"],
        tuple(head["notes"]),
        head["premultiplied"],
        head["stored"],
        None if full is None else (full[0], full[1]),
    )


def child(job: dict[str, Any]) -> None:
    """Decode standard input and answer on standard output; the life of the process."""
    _confine(job)
    gate = Gate(job["name"], job["length"], job["scale"], job["reduced"], apart=True)
    # A copy of the descriptor: Python's own object would close it.
    out = os.fdopen(os.dup(1), "wb")
    # What libraries print goes nowhere.
    os.dup2(2, 1)
    from texlab_core.images.formats.kinds import decode_open

    try:
        with os.fdopen(os.dup(0), "rb") as file:
            decoded = decode_open(file, gate)
    except ImageError as error:
        out.write(json.dumps({"error": str(error)}).encode() + b"\n")
    else:
        values = np.ascontiguousarray(decoded.values)
        head = {
            "shape": values.shape,
            "dtype": values.dtype.str,
            "peak": decoded.peak,
            "notes": decoded.notes,
            "premultiplied": decoded.premultiplied,
            "stored": decoded.stored,
            "full_size": decoded.full_size,
        }
        out.write(json.dumps(head).encode() + b"\n")
        out.write(values.reshape(-1).view(np.uint8).data)
    out.close()
    # No waiting for threads of libraries.
    os._exit(0)


def _confine(job: dict[str, Any]) -> None:
    """Limit memory and time, and end when the parent does."""
    try:
        import resource
    except ImportError:
        pass
    else:
        # Of the data, since libraries reserve addresses that they never use; no core files.
        resource.setrlimit(resource.RLIMIT_DATA, (job["memory"], job["memory"]))
        processors = os.cpu_count() or 1
        seconds = int(job["seconds"] * processors) + 1
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    end = time.monotonic() + job["seconds"]

    def watch() -> None:
        while time.monotonic() < end and (os.name != "posix" or os.getppid() == job["parent"]):
            time.sleep(_WATCH_S)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
