"""Results on the disk: the same bits, numbers and findings; whatever the folder holds, never an error."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import threading
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.gui.conftest import wait_idle
from texlab.runs import column_run, kept_results
from texlab.runs.column_run import ColumnRun, Finished, Measured
from texlab.runs.kept_results import KeptResults
from texlab.storage import stored_results
from texlab.storage.paths import results_dir
from texlab.storage.stored_results import StoredResults
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.registry import methods
from texlab_core.findings.finding import Finding, Region, Remedy, Where
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from texlab.app.explorer import Explorer

FINDING = Finding(
    id="seam",
    title="A seam",
    what="A seam of 3.5 levels.",
    where=Where("result", "rows 1 to 3", (Region(1, 0, 2, 8),), ("4 px, 45°",)),
    why="It wraps.",
    remedy=Remedy("Take another size.", {"size": 12}, ""),
    certainty="look at",
    measures=("seam",),
)


class Task:
    def should_stop(self) -> bool:
        return False

    def due(self) -> bool:
        return False

    def progress(self, value: object) -> None:
        raise AssertionError("nothing is due")

    def give_way(self) -> float:
        return 0.0


def made(seed: int = 0, method: str = "efros-leung") -> Finished:
    exemplar = as_exemplar(np.random.default_rng(1).random((9, 10, 3), np.float32))
    params = methods()["efros-leung"].params.from_json({"window": 3}) if method == "efros-leung" else None
    job = Job(method=method, inputs={"exemplar": exemplar}, params=params, size=(8, 9), seed=seed)  # type: ignore[arg-type]
    return ColumnRun(lambda: job, AnalysisCache())(Task())


def measured(**changes: Any) -> Measured:
    return Measured({"mean": 0.1 + 0.2, "energy": 1e-9}, (8, 9), changes.get("findings", (FINDING,)), "")


def test_what_comes_back_is_what_was_kept_to_the_bit(tmp_path: Path) -> None:
    for method in ("efros-leung", "heeger-bergen", "pixels"):
        end = made(method=method)
        end = replace(
            end, metrics={"distance": 1 / 3}, result=replace(end.result, notes=("One row was cropped.",))
        )
        assert StoredResults(tmp_path / "results").put(end, measured())
        found = StoredResults(tmp_path / "results").get(made(method=method).result.job)
        assert found is not None
        back, numbers = found
        assert back.stored
        assert vars(numbers) == vars(measured())
        assert back.metrics == end.metrics
        assert np.array_equal(back.picture, end.picture)
        assert [each.name for each in back.frames] == [each.name for each in end.frames]
        assert all(np.array_equal(a.picture, b.picture) for a, b in zip(back.frames, end.frames, strict=True))
        was, result = end.result, back.result
        assert result.image.dtype == np.float32
        assert np.array_equal(result.image, was.image)
        assert (result.notes, result.elapsed_s) == (was.notes, was.elapsed_s)
        assert (dict(result.measures), dict(result.versions)) == (dict(was.measures), dict(was.versions))
        assert set(result.maps) == set(was.maps)
        for name, each in was.maps.items():
            assert np.array_equal(result.maps[name].data, each.data)
            assert (result.maps[name].kind, result.maps[name].title) == (each.kind, each.title)
        assert set(result.curves) == set(was.curves)
        for name, curve in was.curves.items():
            assert np.array_equal(result.curves[name].y, curve.y)
            assert result.curves[name].x_label == curve.x_label
    assert made().frames or made(method="heeger-bergen").frames
    assert made().result.maps


def test_another_job_version_or_machine_is_another_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = StoredResults(tmp_path)
    end = made()
    assert store.put(end, measured())
    assert store.get(end.result.job) is not None
    assert store.get(made(seed=1).result.job) is None
    assert store.get(made(method="pixels").result.job) is None
    with monkeypatch.context() as there:
        there.setattr(platform, "node", lambda: "another")
        assert store.get(end.result.job) is None
    with monkeypatch.context() as later:
        later.setattr(stored_results, "versions_for", lambda method: {"numpy": "0"})
        assert store.get(end.result.job) is None
    assert store.get(end.result.job) is not None


def cut(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-100])


def flip(path: Path) -> None:
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0xFF
    path.write_bytes(bytes(data))


def of_another_job(path: Path) -> None:
    other = StoredResults(path.parent / "other")
    other.put(made(seed=9), measured())
    (theirs,) = other.folder.iterdir()
    os.replace(theirs, path)


@pytest.mark.parametrize("harm", [cut, flip, of_another_job, lambda path: path.write_bytes(b""), "folder"])
def test_what_is_damaged_or_foreign_is_a_missing_result_and_is_replaced(tmp_path: Path, harm: Any) -> None:
    store = StoredResults(tmp_path)
    end = made()
    assert store.put(end, measured())
    (path,) = tmp_path.iterdir()
    if harm == "folder":
        path.unlink()
        path.mkdir()
        assert store.get(end.result.job) is None
        assert not store.put(end, measured())
        return
    harm(path)
    assert store.get(end.result.job) is None
    assert store.put(end, measured())
    assert store.get(end.result.job) is not None


def test_what_was_not_used_for_longest_goes_first(tmp_path: Path) -> None:
    ends = [made(seed) for seed in range(4)]
    store = StoredResults(tmp_path)
    store.put(ends[0], measured())
    one = store.nbytes
    store = StoredResults(tmp_path, max_bytes=3 * one + one // 2)
    paths = [store._path(stored_results.identity_of(each.result.job)) for each in ends]
    for place, each in enumerate(ends[:3]):
        store.put(each, measured())
        os.utime(paths[place], ns=(place, place))
    assert store.get(ends[0].result.job) is not None
    store.put(ends[3], measured())
    assert [path.exists() for path in paths] == [True, False, True, True]
    assert store.nbytes <= 3 * one + one // 2
    # One that has no room at all is not kept, and costs no other its place.
    small = StoredResults(tmp_path, max_bytes=one // 2)
    assert not small.put(made(5), measured())
    assert [path.exists() for path in paths] == [True, False, True, True]
    (tmp_path / "notes.txt").write_text("not ours")
    assert store.clear()[0] == 3
    assert [path.name for path in tmp_path.iterdir()] == ["notes.txt"]
    assert store.clear() == (0, 0)


def test_a_folder_that_cannot_be_made_keeps_nothing(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    store = StoredResults(tmp_path / "file" / "results")
    assert not store.put(made(), measured())
    assert store.get(made().result.job) is None
    assert store.clear() == (0, 0)


WRITER = """
import sys
from pathlib import Path
import numpy as np
from texlab.runs.column_run import Finished, Measured
from texlab.storage.stored_results import StoredResults
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
exemplar = as_exemplar(np.full((8, 9, 3), 0.5, np.float32))
store = StoredResults(Path(sys.argv[1]), max_bytes=20_000)
for seed in range(24):
    result = run(Job(method="pixels", inputs={"exemplar": exemplar}, seed=seed))
    store.put(Finished(result, np.zeros((8, 9, 3), np.uint8), (), draft=False), Measured({"mean": 0.5}, (8, 9)))
    found = store.get(result.job)
    assert found is None or found[1].measures == {"mean": 0.5}
"""


def test_two_processes_share_the_folder(tmp_path: Path, request: pytest.FixtureRequest) -> None:
    command = [sys.executable, "-W", "error", "-c", WRITER, str(tmp_path)]
    root = request.config.rootpath
    processes = [subprocess.Popen(command, stderr=subprocess.PIPE, cwd=root) for _ in range(2)]
    said = [each.communicate(timeout=170)[1].decode() for each in processes]
    assert [each.returncode for each in processes] == [0, 0], said
    assert 0 < StoredResults(tmp_path).nbytes <= 20_000
    assert not [each for each in tmp_path.iterdir() if each.suffix != ".result"]


def test_what_is_large_is_not_held_in_memory_once_it_is_on_the_disk(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(kept_results, "LARGE", 100)
    kept = KeptResults()
    kept.disk = StoredResults(tmp_path)
    end = made()
    key = end.result.job.key
    kept.put(key, end)
    assert not kept.unwritten
    kept.note(key, measured())
    assert kept.unwritten
    assert kept.get(key) is end
    kept.write()
    assert not kept.unwritten
    assert kept.get(key) is None
    assert kept.nbytes == 0
    back = kept.read(end.result.job)
    assert back is not None
    assert kept.get(key) is back
    assert vars(kept.measured(key)) == vars(measured())
    # What comes from the disk is not written again.
    assert not kept.unwritten


def test_what_is_quick_and_small_is_not_written(tmp_path: Path) -> None:
    kept = KeptResults()
    kept.disk = StoredResults(tmp_path / "results")
    end = made(method="pixels")
    end = replace(end, result=replace(end.result, elapsed_s=0.0))
    kept.put(end.result.job.key, end)
    kept.note(end.result.job.key, measured())
    assert not kept.unwritten
    assert kept.read(end.result.job) is None
    assert kept.forget() == (0, 0)
    assert not (tmp_path / "results").exists()


@pytest.fixture
def watched(monkeypatch: pytest.MonkeyPatch) -> dict[str, list[Any]]:
    """Jobs that really run, and the threads in which the folder is used; everything is worth keeping."""
    seen: dict[str, list[Any]] = {"runs": [], "threads": []}
    real = column_run.run

    def counted(job: Any, *args: Any, **options: Any) -> Any:
        seen["runs"].append(job)
        return real(job, *args, **options)

    monkeypatch.setattr(column_run, "run", counted)
    monkeypatch.setattr(kept_results, "WORTH_S", 0.0)
    for name in ("get", "put", "clear"):
        real_one = getattr(StoredResults, name)

        def asked(self: Any, *args: Any, real_one: Any = real_one) -> Any:
            seen["threads"].append(threading.current_thread())
            return real_one(self, *args)

        monkeypatch.setattr(StoredResults, name, asked)
    return seen


def test_undo_and_a_restart_show_at_once_what_was_finished(
    qtbot: Any, open_window: Callable[..., Explorer], texture: Path, watched: dict[str, list[Any]]
) -> None:
    explorer = open_window(str(texture), [("pixels", methods()["pixels"].params())], size=24)
    controller, session = explorer.controller, explorer.session
    column = session.state.columns[0]
    first = controller.column_scene(column.id)
    session.set_seed(session.state.seed + 1)
    wait_idle(qtbot, explorer)
    # Hours later: nothing of it is in memory.
    qtbot.waitUntil(lambda: not controller.shared.kept.unwritten and not controller._writer.busy)
    controller.shared.kept.clear()
    done = len(watched["runs"])
    session.undo()
    wait_idle(qtbot, explorer)
    back = controller.column_scene(column.id)
    assert back.stored
    assert back.status == "finished"
    assert len(watched["runs"]) == done
    assert np.array_equal(back.result.image, first.result.image)
    assert (back.measures, back.findings) == (first.measures, first.findings)
    assert "kept from before" in explorer.workspace.columns[column.id].foot.line.text()

    # The user asks for a run: everything that explains it is made anew.
    controller.run_column(column.id)
    wait_idle(qtbot, explorer)
    assert len(watched["runs"]) == done + 1
    assert not controller.column_scene(column.id).stored
    assert controller.column_scene(column.id).result.model is not None

    explorer.window.close()
    done = len(watched["runs"])
    again = open_window(str(texture), None)
    assert again.controller.column_scene(again.session.state.columns[0].id).stored
    assert len(watched["runs"]) == done
    said: list[str] = []
    again.controller.said.connect(said.append)
    sizes = [each.stat().st_size for each in results_dir().iterdir()]
    assert len(sizes) == 2
    again.window.actions_by_name["forget-results"].trigger()
    wait_idle(qtbot, again)
    assert not list(results_dir().iterdir())
    assert said == [f"2 finished results ({sum(sizes) / 2**20:.1f} MB) removed from the disk."]
    assert threading.main_thread() not in watched["threads"]
    assert watched["threads"]
