"""Batches in processes: how much faster two are than one, by CPU time, and memory against the number of jobs.

Other programs do not count: on two free cores, two processes take half of what parent and processes need together.
Where no other program runs, the clock says it too, here for all of De Bonet's textures:

    python -m tests.benchmarks.bench_batch 800
"""

from __future__ import annotations

import json
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
    start = time.monotonic()
    done = run_python(__file__, jobs, processes, folder, timeout=1200)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout) | {"wall_s": time.monotonic() - start}


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


def by_the_clock(jobs: int) -> None:
    """Print how long one process and two take, from start to end; each twice, and the quicker counts."""
    with tempfile.TemporaryDirectory() as folder:
        took = {
            count: min(run(jobs, count, Path(folder) / f"{count}-{turn}")["wall_s"] for turn in range(2))
            for count in (1, 2)
        }
    print(f"{jobs} textures: {took[1]:.1f} s in one process, {took[2]:.1f} s in two:", end=" ")
    print(f"{took[1] / took[2]:.2f} times as fast")


if __name__ == "__main__":
    if len(sys.argv) == 2:
        by_the_clock(int(sys.argv[1]))
    else:
        main(int(sys.argv[1]), int(sys.argv[2]), sys.argv[3])
