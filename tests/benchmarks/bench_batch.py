"""Batches in processes: how much faster two are than one, by CPU time, and memory against the number of jobs.

Other programs do not count: on two free cores, two processes take half of what parent and processes need together.
Where no other program runs, the clock says it too, here for all of De Bonet's textures:

    python -m tests.benchmarks.bench_batch 800

One process is what ``--processes 1`` gives: one thread works (98% of its CPU time is the main thread's; these
textures are too small for transforms in two threads), as in each of two. The clock runs from the command to its
end: start of Python, loading of compiled code, and the report are in it, and count more the fewer the jobs. What
other programs took beside is printed too: from a tenth of a core on, the ratio says nothing.
"""

from __future__ import annotations

import json
import os
import resource
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import pytest

from tests.core.batch_tools import run_python

pytestmark = pytest.mark.benchmark

FEW, MANY = 40, 160


def run(jobs: int, processes: int, folder: Path) -> dict[str, Any]:
    """Run jobs of De Bonet's 800 in a process of their own; return its figures."""
    done = run_python(__file__, jobs, processes, folder, timeout=1200)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_two_processes_and_many_jobs(tmp_path: Path) -> None:
    found = {
        (jobs, count): run(jobs, count, tmp_path / f"{jobs}-{count}") for jobs in (FEW, MANY) for count in (1, 2)
    }
    for jobs in (FEW, MANY):
        one, two = found[jobs, 1], found[jobs, 2]
        together = two["own_s"] + two["children_s"]
        ratio = one["own_s"] / (together / 2)
        print(f"{jobs} textures: {one['own_s']:.1f} s of CPU in one process, {two['own_s']:.1f} and", end=" ")
        print(f"{two['children_s']:.1f} with two: {ratio:.2f} times as fast on two free cores;", end=" ")
        print(
            f"{jobs / together * 2:.1f} textures a second; peak {one['peak_mb']:.0f} MB in one process", end=", "
        )
        print(f"{two['peak_mb']:.0f} + 2 x {two['child_mb']:.0f} MB with two")
    assert ratio > 1.7
    for count, name in ((1, "peak_mb"), (2, "peak_mb"), (2, "child_mb")):
        assert found[MANY, count][name] - found[FEW, count][name] < 20


def main(jobs: int, processes: int, folder: str) -> None:
    from texlab_core.batch.places import InProcess
    from texlab_core.batch.plan import find_plan
    from texlab_core.batch.processes import Processes
    from texlab_core.batch.running import run_batch

    place = InProcess() if processes == 1 else Processes(processes)
    result = run_batch(find_plan("gallery:de-bonet-800"), folder, sample=jobs, place=place)
    assert result.made == jobs
    own, children = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    print(
        json.dumps(
            {
                "own_s": own.ru_utime + own.ru_stime,
                "children_s": children.ru_utime + children.ru_stime,
                "peak_mb": own.ru_maxrss / 1024,
                "child_mb": children.ru_maxrss / 1024,
            }
        )
    )


def busy_s() -> float:
    """Return the CPU time that everything on this machine has taken, in seconds; 0 where it is not said."""
    if not Path("/proc/stat").exists():
        return 0.0
    first = Path("/proc/stat").read_text("utf-8").splitlines()[0]
    user, nice, system, _, _, irq, soft = map(int, first.split()[1:8])
    return (user + nice + system + irq + soft) / os.sysconf("SC_CLK_TCK")


def command(jobs: int, processes: int, folder: Path) -> tuple[float, float, float]:
    """Run jobs as one does by hand; return wall time, its CPU time, and that of all other programs, in seconds."""
    before, busy, start = _children_s(), busy_s(), time.monotonic()
    asked = ("gallery:de-bonet-800", "--sample", jobs, "--processes", processes, "--out", folder, "--quiet")
    done = run_python("-m", "texlab", "batch", *asked, timeout=1200)
    wall, own = time.monotonic() - start, _children_s() - before
    assert done.returncode == 0, done.stderr
    return wall, own, max(busy_s() - busy - own, 0.0)


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def by_the_clock(jobs: int) -> None:
    """Print how long one process and two take, from start to end; each twice in turns, and the quicker counts."""
    took: dict[int, list[float]] = {1: [], 2: []}
    with tempfile.TemporaryDirectory() as folder:
        for turn in range(2):
            for count, all_took in took.items():
                wall, own, others = command(jobs, count, Path(folder) / f"{count}-{turn}")
                all_took.append(wall)
                print(f"{jobs} textures, --processes {count}: {wall:.1f} s, {own:.1f} s of CPU,", end=" ")
                print(f"other programs {others / wall:.2f} cores", flush=True)
    one, two = min(took[1]), min(took[2])
    print(f"{jobs} textures: {one:.1f} s in one process, {two:.1f} s in two: {one / two:.2f} times as fast")


if __name__ == "__main__":
    if len(sys.argv) == 2:
        by_the_clock(int(sys.argv[1]))
    else:
        main(int(sys.argv[1]), int(sys.argv[2]), sys.argv[3])
