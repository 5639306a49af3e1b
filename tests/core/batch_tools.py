"""What the tests of batches share; importable by the processes that they start."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.batch.plan import Plan, plan_from_json
from texlab_core.images.formats.writing import write_image
from texlab_core.work.threads import SUM_VARIABLES

if TYPE_CHECKING:
    from texlab_core.engine.result import Result

ROOT = Path(__file__).resolve().parents[2]
# What differs from run to run, and what belongs to no job.
NOT_COMPARED = {"times.csv", ".texlab-batch.lock"}


def run_python(
    *arguments: object, folder: Path | None = None, timeout: float = 240
) -> subprocess.CompletedProcess[str]:
    """Run Python in a process of its own that knows the project, may be killed or start processes."""
    return subprocess.run(
        [sys.executable, "-W", "ignore", *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=folder or ROOT,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        check=False,
        timeout=timeout,
    )


def photos(folder: Path, count: int = 3) -> None:
    """Write small images of smooth noise, other ones for each number."""
    folder.mkdir(parents=True, exist_ok=True)
    for number in range(count):
        rng = np.random.Generator(np.random.PCG64(number))
        noise = rng.random((26, 30, 3))
        smooth = (noise + np.roll(noise, 1, 0) + np.roll(noise, 1, 1)) / 3
        write_image(folder / f"photo-{number}.png", smooth)


def small_plan(folder: Path, **changes: Any) -> Plan:
    """Return a plan over three images that takes a moment."""
    photos(folder / "in")
    data = {"inputs": ["in/*.png"], "methods": ["tiling", "heeger-bergen"], "seeds": [1, 2], "sizes": ["20x12"]}
    return plan_from_json(data | changes, folder=folder)


def files_of(folder: Path) -> dict[str, bytes]:
    """Return what a batch made, by path."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name not in NOT_COMPARED
    }


def shape_of(result: Result) -> tuple[tuple[int, ...], int]:
    """Return the shape of a result and the process that made it."""
    return result.image.shape, os.getpid()


def sum_variables(result: Result) -> set[str | None]:
    """Return what the process that made a result says to libraries for linear algebra."""
    return {os.environ.get(name) for name in SUM_VARIABLES}


def die_at_first(result: Result, *, marker: str) -> str:
    """End the process without a word, but only once."""
    if not Path(marker).exists():
        Path(marker).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return "made"


def die_when_large(result: Result) -> str:
    """End the process without a word for every result that is larger than 20 rows."""
    if result.image.shape[0] > 20:
        os.kill(os.getpid(), signal.SIGKILL)
    return "made"
