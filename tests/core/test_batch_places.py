"""One process, two, and a cluster give the same bits; what is killed at any moment goes on to the same files."""

from __future__ import annotations

import os
import sys
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.core.batch_tools import (
    die_at_first,
    die_when_large,
    files_of,
    run_python,
    shape_of,
    small_plan,
    sum_variables,
)
from texlab_core.batch import cluster
from texlab_core.batch.cluster import Cluster
from texlab_core.batch.places import InProcess
from texlab_core.batch.processes import UNBORN, Processes
from texlab_core.batch.running import run_batch, run_jobs
from texlab_core.engine.inputs import ArraysInput
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.efros_leung.params import EfrosLeungParams

if TYPE_CHECKING:
    from pathlib import Path


def jobs(sizes: tuple[int, ...] = (4, 5, 6, 7), **changes: Any) -> list[Job]:
    exemplar = as_exemplar(np.random.Generator(np.random.PCG64(1)).random((12, 12, 3), np.float32))
    given: dict[str, Any] = {"method": "tiling", "inputs": {"exemplar": exemplar}} | changes
    return [Job(**given, size=(size, 9)) for size in sizes]


# The n-th time that the process asks for a file to be on the disk, or renames one, is its last.
KILLED = """
import os, signal, sys
from pathlib import Path
import texlab_core.files.whole
from tests.core.batch_tools import small_plan
from texlab_core.batch.processes import Processes
from texlab_core.batch.running import run_batch

def main():
    folder, moment, count, processes = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    left, original = [count], getattr(os, moment)

    def watched(*args):
        left[0] -= 1
        if not left[0]:
            os.kill(os.getpid(), signal.SIGKILL)
        return original(*args)

    plan = small_plan(folder, methods=["tiling", "pixels"])
    setattr(os, moment, watched)
    run_batch(plan, folder / "out", place=Processes(processes) if processes else None)

if __name__ == "__main__":
    main()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no kill -9")
def test_killed_at_any_moment_it_goes_on_to_the_same_files(tmp_path: Path) -> None:
    quick = {"methods": ["tiling", "pixels"]}
    run_batch(small_plan(tmp_path / "whole", **quick), tmp_path / "whole" / "out")
    wanted = files_of(tmp_path / "whole" / "out")
    # In the middle of writing; before, between and after the renames of one job; and while the report is written.
    moments = [("fsync", 3), ("replace", 3), ("replace", 4), ("fsync", 11), ("replace", 16)]
    made = []
    for number, (moment, count) in enumerate(moments):
        done = run_python("-c", KILLED, tmp_path / "killed", moment, count, 2 if number == 2 else 0)
        assert done.returncode == -9, done.stderr
        made.append(len(list((tmp_path / "killed" / "out" / "records").glob("*.json"))))
    assert made == sorted(made)
    assert made[0] < made[-1] < 12
    last = run_batch(small_plan(tmp_path / "killed", **quick), tmp_path / "killed" / "out", place=Processes(2))
    assert last.found == made[-1]
    assert files_of(tmp_path / "killed" / "out") == wanted


ON_CLUSTER = """
import os, signal, sys
from pathlib import Path
import psutil
from tests.core.batch_tools import small_plan
from texlab_core.batch.cluster import Cluster
from texlab_core.batch.running import run_batch

def workers():
    found = psutil.Process().children(recursive=True)
    return [each for each in found if "spawn_main" in " ".join(each.cmdline())]

def main():
    folder, killed = Path(sys.argv[1]), []

    def watch(progress):
        if progress.done == 3 and not killed:
            killed.append(workers()[0].pid)
            os.kill(killed[0], signal.SIGKILL)

    result = run_batch(small_plan(folder), folder / "out", place=Cluster("local:2"), on_progress=watch)
    assert killed
    assert (result.made, result.failed) == (12, 0), result
    print("made", result.made)

if __name__ == "__main__":
    main()
"""


@pytest.mark.slow
def test_one_process_two_and_a_cluster_that_loses_a_worker_give_the_same_files(tmp_path: Path) -> None:
    run_batch(small_plan(tmp_path / "one"), tmp_path / "one" / "out", place=InProcess())
    wanted = files_of(tmp_path / "one" / "out")
    run_batch(small_plan(tmp_path / "two"), tmp_path / "two" / "out", place=Processes(2))
    assert files_of(tmp_path / "two" / "out") == wanted
    done = run_python("-c", ON_CLUSTER, tmp_path / "cluster")
    assert done.stdout == "made 12\n", done.stderr
    assert files_of(tmp_path / "cluster" / "out") == wanted


def test_arrays_arrive_as_they_are() -> None:
    params = EfrosLeungParams(window=5)
    (plain,) = jobs((14,), method="efros-leung", params=params)
    state = run(plain).details.state()
    inputs = dict(plain.inputs) | {"state": ArraysInput(state, "state")}
    (plan,) = jobs((14,), method="efros-leung", params=params, inputs=inputs)
    ((_, outcome),) = run_jobs(iter([plan]), place=Processes(1))
    assert outcome.error == ""
    np.testing.assert_array_equal(outcome.value.image, run(plan).image)


def test_a_process_that_dies_costs_its_running_jobs_a_second_run(tmp_path: Path) -> None:
    finish = partial(die_at_first, marker=str(tmp_path / "marker"))
    outcomes = dict(run_jobs(iter(jobs()), place=Processes(2), finish=finish))
    assert sorted(outcomes) == [0, 1, 2, 3]
    assert {(each.value, each.error) for each in outcomes.values()} == {("made", "")}


def test_a_job_that_kills_every_process_fails_alone() -> None:
    outcomes = dict(run_jobs(iter(jobs((4, 30, 5, 6))), place=Processes(2), finish=die_when_large))
    assert [outcomes[number].value for number in (0, 2, 3)] == ["made"] * 3
    assert outcomes[1].error.startswith("The process that ran it ended without a word 3 times")


def test_processes_share_the_work_and_leave_nothing_behind(tmp_path: Path) -> None:
    place = Processes(2, tmp_path / "scratch")
    asked = []

    def supply() -> Any:
        for job in jobs(tuple(range(3, 15))):
            asked.append(sorted(each.name for each in (tmp_path / "scratch").glob("*")))
            yield job

    outcomes = list(run_jobs(supply(), place=place, finish=shape_of))
    assert sorted(number for number, _ in outcomes) == list(range(12))
    assert os.getpid() not in {outcome.value[1] for _, outcome in outcomes}
    assert len({len(each) for each in asked[1:]}) == 1, "an exemplar lies there once for all its jobs"
    assert not (tmp_path / "scratch").exists()


def test_kept_processes_serve_the_next_run_and_results_travel(tmp_path: Path) -> None:
    place = Processes(1, tmp_path / "scratch")
    with place.kept():
        first, second = (dict(run_jobs(iter(jobs((4, 5))), place=place, finish=shape_of)) for _ in range(2))
        (travelled,) = [outcome.value for _, outcome in run_jobs(iter(jobs((6,))), place=place)]
    assert {each.value[1] for each in first.values()} == {each.value[1] for each in second.values()}
    assert os.getpid() not in {each.value[1] for each in first.values()}
    assert not (tmp_path / "scratch").exists()
    (alone,) = [outcome.value for _, outcome in run_jobs(iter(jobs((6,))))]
    assert np.array_equal(travelled.image, alone.image)
    assert (travelled.versions, travelled.curves) == (alone.versions, alone.curves)


def test_a_process_starts_no_threads_for_sums() -> None:
    before = dict(os.environ)
    (found,) = [
        outcome.value for _, outcome in run_jobs(iter(jobs((4,))), place=Processes(1), finish=sum_variables)
    ]
    assert found == {"1"}
    assert dict(os.environ) == before
    # They are read when NumPy is loaded.
    done = run_python("-c", "import sys, texlab_core.batch.child; print('numpy' in sys.modules)")
    assert done.stdout == "False\n", done.stderr


def test_inputs_that_nobody_needs_any_more_are_removed(tmp_path: Path) -> None:
    scratch = tmp_path / "scratch"
    most = []

    def supply() -> Any:
        for number in range(12):
            most.append(len(list(scratch.glob("*.npz"))))
            image = np.full((6, 6), number / 12, np.float32)
            yield Job(method="tiling", inputs={"exemplar": as_exemplar(image)}, size=(4, 4))

    list(run_jobs(supply(), place=Processes(1, scratch), finish=shape_of))
    assert max(most) <= 3


@pytest.mark.parametrize("place", [InProcess(), Processes(1)], ids=["one", "processes"])
def test_stopping_ends_what_runs(place: Any) -> None:
    asked = []

    def stop() -> bool:
        asked.append(None)
        return len(asked) > 3

    slow = jobs((64,), method="heeger-bergen")
    with pytest.raises(Cancelled):
        list(run_jobs(iter(slow * 50), place=place, should_stop=stop))


def test_where_no_processes_can_be_started_is_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(self: object) -> None:
        raise FileNotFoundError(2, "No such file or directory")

    monkeypatch.setattr("multiprocessing.context.BaseContext.Event", fail)
    with pytest.raises(
        InputError, match=r"^No processes can be started here \(No such file or directory\); use only"
    ):
        list(run_jobs(iter(jobs()), place=Processes(2)))


UNGUARDED = """
import sys
from pathlib import Path
from tests.core.batch_tools import small_plan
from texlab_core.batch.processes import Processes
from texlab_core.batch.running import run_batch

folder = Path(sys.argv[1])
run_batch(small_plan(folder, methods=["tiling"]), folder / "out", place=Processes(2))
"""


def test_a_script_that_every_process_would_run_again_is_told_so_at_once(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(UNGUARDED, "utf-8")
    done = run_python(script, tmp_path, folder=tmp_path)
    assert done.returncode == 1
    assert done.stderr.splitlines()[-1] == f"texlab_core.errors.InputError: {UNBORN}"
    # Each of the first processes fails once, and no other one is started.
    assert done.stderr.count("Another batch is at work") <= 2


@pytest.mark.parametrize("count", [0, 257, True, 1.5])
def test_the_number_of_processes_is_checked(count: Any) -> None:
    with pytest.raises(InputError, match="processes: must be a whole number from 1 to 256"):
        Processes(count)


def test_the_address_of_a_cluster_is_checked(monkeypatch: pytest.MonkeyPatch) -> None:
    for wrong in ("here", "", "local:0", "local:x", "local:257"):
        with pytest.raises(InputError, match="cluster: must be"):
            Cluster(wrong)
    assert Cluster("local:3").width == 3
    assert Cluster("local").width == (os.cpu_count() or 1)
    monkeypatch.setattr(cluster.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"pip install texlab\[cluster\]"):
        Cluster("tcp://127.0.0.1:1")
