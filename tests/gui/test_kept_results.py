"""What was finished is kept by its job: a step back shows it at once, and computes nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab.runs import column_run
from texlab.runs.column_run import Finished, Measured, MeasureRun, key_of
from texlab.runs.kept_results import KeptResults
from texlab.style.pictures import to_picture
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer
    from texlab_core.engine.result import Result


def toy_result(seed: int = 0, size: tuple[int, int] = (8, 8)) -> Result:
    exemplar = as_exemplar(np.random.default_rng(1).random((8, 8, 3), np.float32))
    return run(Job(method="pixels", inputs={"exemplar": exemplar}, size=size, seed=seed))


def finished(seed: int = 0) -> Finished:
    result = toy_result(seed=seed)
    return Finished(result, to_picture(result.image), (), draft=False)


def test_results_are_found_by_their_job_and_the_oldest_goes_first() -> None:
    ends = [finished(seed) for seed in range(3)]
    size = KeptResults()
    size.put("one", ends[0])
    kept = KeptResults(max_bytes=2 * size.nbytes)
    for end in ends[:2]:
        kept.put(end.result.job.key, end)
    assert kept.get(ends[0].result.job.key) is ends[0]
    kept.put(ends[2].result.job.key, ends[2])
    assert kept.get(ends[1].result.job.key) is None
    assert kept.get(ends[0].result.job.key) is ends[0]
    assert kept.get(ends[2].result.job.key) is ends[2]
    assert len(kept) == 2
    kept.clear()
    assert kept.nbytes == 0


def test_no_more_than_so_many_are_kept() -> None:
    kept = KeptResults(most=2)
    for seed in range(4):
        kept.put(seed, finished(seed))
    assert len(kept) == 2
    assert kept.get(1) is None
    assert kept.get(2) is not None


def test_the_newest_is_kept_whatever_it_takes() -> None:
    kept = KeptResults(max_bytes=0)
    end = finished()
    kept.put("key", end)
    assert kept.get("key") is end
    assert kept.nbytes >= end.result.image.nbytes + end.picture.nbytes


def test_another_seed_size_or_parameter_is_another_job() -> None:
    jobs = [toy_result(seed=seed, size=size).job for seed in (0, 1) for size in ((8, 8), (8, 9))]
    assert len({job.key for job in jobs}) == 4
    assert toy_result(seed=0, size=(8, 8)).job.key == jobs[0].key


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Every job that a column really runs."""
    seen: list[Any] = []
    real = column_run.run

    def counted(job: Any, *args: Any, **options: Any) -> Any:
        seen.append(job)
        return real(job, *args, **options)

    monkeypatch.setattr(column_run, "run", counted)
    return seen


def test_undo_shows_what_was_there_without_a_run(qtbot: Any, explorer: Explorer, runs: list[Any]) -> None:
    session, controller = explorer.session, explorer.controller
    column = session.state.columns[0]
    first = controller.column_scene(column.id).result
    session.set_seed(session.state.seed + 1)
    qtbot.waitUntil(lambda: explorer.idle and controller.column_scene(column.id).result is not first)
    second = controller.column_scene(column.id).result
    assert not np.array_equal(first.image, second.image)
    done = len(runs)
    session.undo()
    qtbot.waitUntil(lambda: explorer.idle and controller.column_scene(column.id).result is first)
    session.redo()
    qtbot.waitUntil(lambda: explorer.idle and controller.column_scene(column.id).result is second)
    assert len(runs) == done
    assert controller.column_scene(column.id).status == "finished"


def test_running_again_what_is_finished_shows_it(qtbot: Any, explorer: Explorer, runs: list[Any]) -> None:
    column = explorer.session.state.columns[0]
    result = explorer.controller.column_scene(column.id).result
    explorer.controller.run_column(column.id)
    qtbot.waitUntil(lambda: explorer.idle)
    assert explorer.controller.column_scene(column.id).result is result
    assert runs == []


def test_the_key_of_a_column_is_that_of_its_job(explorer: Explorer) -> None:
    state, exemplar = explorer.session.state, explorer.controller.exemplar
    for column in state.columns:
        job = explorer.controller.column_scene(column.id).result.job
        assert key_of(column, state, exemplar) == job.key


def test_what_was_measured_is_not_measured_again(
    qtbot: Any, explorer: Explorer, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Any] = []
    real = MeasureRun.__call__
    monkeypatch.setattr(MeasureRun, "__call__", lambda self, task: (asked.append(self), real(self, task))[1])
    session, controller = explorer.session, explorer.controller
    column = session.state.columns[0]
    first = controller.column_scene(column.id)
    assert first.measures
    assert first.findings is not None
    session.set_seed(session.state.seed + 1)
    qtbot.waitUntil(lambda: explorer.idle and controller.column_scene(column.id).result is not first.result)
    second = controller.column_scene(column.id)
    assert second.measures != first.measures
    done = len(asked)
    assert done > 0
    for step, wanted in ((session.undo, first), (session.redo, second)):
        step()
        qtbot.waitUntil(lambda wanted=wanted: controller.column_scene(column.id).result is wanted.result)
        # They come with the picture.
        scene = controller.column_scene(column.id)
        assert (scene.measures, scene.findings) == (wanted.measures, wanted.findings)
        assert scene.measured_size == wanted.measured_size
        qtbot.waitUntil(lambda: explorer.idle)
        assert controller.column_scene(column.id).measures == wanted.measures
    assert len(asked) == done


def test_numbers_go_with_their_result() -> None:
    kept, end = KeptResults(most=1), finished(0)
    found = Measured({"d": 0.1}, (8, 8), ())
    kept.note("a", found)
    assert kept.measured("a") is None
    kept.put("a", end)
    kept.note("a", found)
    assert kept.measured("a") is found
    kept.put("b", finished(1))
    assert kept.measured("a") is None
