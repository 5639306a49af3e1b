"""Kill a batch of 400 jobs with -9 at 20 random moments, and workers of a cluster; the files must be the same.

What is killed and resumed is compared, byte for byte, with a batch that nobody disturbed: in one process, in two,
and on a Dask cluster that loses five of its workers. Each seed draws other moments.

    python .ci/kill_batch.py [--jobs 400] [--kills 20] [--seed 1]
"""

from __future__ import annotations

import argparse
import contextlib
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]
POLL_S = 0.002
WORKERS_KILLED = 5


def plan_of(folder: Path, jobs: int) -> Any:
    """Return a plan of so many quick jobs (a multiple of 20)."""
    from tests.core.batch_tools import photos
    from texlab_core.batch.plan import plan_from_json

    photos(folder / "in", 5)
    data = {
        "inputs": ["in/*.png"],
        "methods": ["tiling", "pixels"],
        "seeds": {"from": 1, "count": jobs // 10},
        "sizes": ["20x12"],
    }
    return plan_from_json(data, folder=folder)


def run(folder: Path, jobs: int, processes: int) -> None:
    """Run the batch, or what is left of it."""
    from texlab_core.batch.places import InProcess
    from texlab_core.batch.processes import Processes
    from texlab_core.batch.running import run_batch

    place = InProcess() if processes == 1 else Processes(processes)
    result = run_batch(plan_of(folder, jobs), folder / "out", place=place)
    assert result.failed == 0
    assert result.made + result.found == jobs


def run_on_a_cluster(folder: Path, jobs: int, seed: int) -> None:
    """Run the batch on a local cluster of two workers, and kill one of them now and then."""
    import psutil

    from texlab_core.batch.cluster import Cluster
    from texlab_core.batch.running import run_batch

    draw = random.Random(seed)
    moments = sorted(draw.sample(range(jobs // 20, jobs - jobs // 20), WORKERS_KILLED))
    killed: list[int] = []

    def watch(progress: Any) -> None:
        if len(killed) < len(moments) and progress.done >= moments[len(killed)]:
            workers = []
            for each in psutil.Process().children(recursive=True):
                # One that has just died has no command line any more.
                with contextlib.suppress(psutil.Error):
                    workers += [each] if "spawn_main" in " ".join(each.cmdline()) else []
            # While the last one is started again there may be none.
            if workers:
                killed.append(draw.choice(workers).pid)
                os.kill(killed[-1], signal.SIGKILL)

    result = run_batch(plan_of(folder, jobs), folder / "out", place=Cluster("local:2"), on_progress=watch)
    print(f"cluster: {len(killed)} workers killed at {moments} jobs, {result.made} made, {result.failed} failed")
    assert (len(killed), result.made, result.failed) == (WORKERS_KILLED, jobs, 0)


def run_killed(folder: Path, jobs: int, kills: int, seed: int) -> None:
    """Run the batch again and again, killing it each time at a random moment; at last let it finish."""
    draw = random.Random(seed)
    targets = sorted(draw.randrange(jobs) for _ in range(kills))
    records, made = folder / "out" / "records", []
    for target in targets:
        child = subprocess.Popen(
            [
                sys.executable,
                *("-W", "ignore"),
                __file__,
                "--only",
                str(folder),
                "--jobs",
                str(jobs),
                "--processes",
                str(draw.choice((1, 2))),
            ]
        )
        while child.poll() is None and (not records.is_dir() or len(os.listdir(records)) <= target):
            time.sleep(POLL_S)
        time.sleep(draw.uniform(0, 0.1))
        child.send_signal(signal.SIGKILL)
        child.wait()
        made.append(len(list(records.glob("*.json"))))
    print(f"killed {kills} times, with {made} jobs done")
    assert made == sorted(made)
    run(folder, jobs, 2)


def main() -> int:
    """Run everything and compare."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=400)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", metavar="DIR", help=argparse.SUPPRESS)
    parser.add_argument("--processes", type=int, default=1, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.only:
        run(Path(args.only), args.jobs, args.processes)
        return 0
    from tests.core.batch_tools import files_of

    with tempfile.TemporaryDirectory() as base:
        whole, two, killed, cluster = (Path(base) / name for name in ("whole", "two", "killed", "cluster"))
        run(whole, args.jobs, 1)
        wanted = files_of(whole / "out")
        for name, folder, work in (
            ("two processes", two, lambda: run(two, args.jobs, 2)),
            ("killed and resumed", killed, lambda: run_killed(killed, args.jobs, args.kills, args.seed)),
            ("a cluster that loses workers", cluster, lambda: run_on_a_cluster(cluster, args.jobs, args.seed)),
        ):
            began = time.monotonic()
            work()
            found = files_of(folder / "out")
            differing = [path for path in wanted.keys() | found.keys() if wanted.get(path) != found.get(path)]
            print(f"{name}: {len(found)} files, {len(differing)} differ ({time.monotonic() - began:.0f} s)")
            if differing:
                print(*sorted(differing)[:20], sep="\n")
                return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
