"""A column at work, without a window: what it keeps, what it shows, how long it thinks the full size takes."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from tests.stub_method import StubParams, analyses, exemplar, stub  # noqa: F401
from texlab.runs.column_run import BROKEN, Drafted, Finished, Measured, Progress, Waits
from texlab.runs.column_runner import ColumnRunner, Shared
from texlab.runs.measurer import MEASURING_SHARE, OVERDUE_S
from texlab.runs.slots import Rank, Slots
from texlab.runs.sweep_run import SweepRun, sweep_of
from texlab.runs.worker import Worker
from texlab.state.chosen import Column, State
from texlab.state.sweeps import SweepPlan
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.sheets.sweep import Vary
from texlab_core.warming import Warmth

pytestmark = pytest.mark.usefixtures("stub")
COLUMN = Column(1, "stub", StubParams())


class Idle:
    """A worker that notes what it is to do and never does it."""

    behind = False

    def __init__(self) -> None:
        self.asked: list[dict[str, Any]] = []
        self.cancels = 0

    def submit(self, request: Any, **how: Any) -> None:
        self.asked.append({"request": request, **how})

    def cancel(self) -> None:
        self.cancels += 1


@pytest.fixture
def runner(qapp: Any) -> Any:
    made = ColumnRunner(COLUMN, Shared(Slots(1), AnalysisCache(), Warmth()))
    made.worker.close()
    made.worker = Idle()  # type: ignore[assignment]
    made.measurer.worker.close()
    made.measurer.worker = Idle()  # type: ignore[assignment]
    return made


def start(runner: ColumnRunner, size: tuple[int, int] = (96, 128), **how: Any) -> dict[str, Any]:
    runner.start(COLUMN, State(None, (COLUMN,), 5, size, 2), exemplar(), **how)
    asked: dict[str, Any] = runner.worker.asked[-1]  # type: ignore[attr-defined]
    return asked


def finished(size: tuple[int, int], seconds: float, *, draft: bool = False) -> Finished:
    image = np.zeros((*size, 3), np.float32)
    inputs = {"exemplar": exemplar()}
    job = Job(method=COLUMN.method, inputs=inputs, params=COLUMN.params, size=size, seed=int(1e6 * seconds))
    result: Any = SimpleNamespace(image=image, job=job, elapsed_s=seconds, maps={}, details=None, model=None)
    return Finished(result, np.zeros((*size, 3), np.uint8), (), draft)


@pytest.mark.parametrize(
    ("drawn", "seconds", "full"),
    [((96, 128), 0.5, 0.5), ((48, 64), 0.5, 2.0), ((24, 128), 0.1, 0.4), ((200, 200), 0.3, 0.3)],
)
def test_the_time_of_the_full_size_grows_with_the_area(
    runner: Any, drawn: Any, seconds: float, full: float
) -> None:
    start(runner)
    runner._finished(finished(drawn, seconds, draft=True))
    assert runner.seconds == pytest.approx(full)


def test_the_next_draft_is_as_large_as_the_time_allows(runner: Any) -> None:
    start(runner)
    runner._finished(finished((96, 128), 0.2))
    asked = start(runner, draft=True)
    assert asked["request"].make_job().size == (48, 64)
    assert asked["rank"] == Rank.DRAFT
    assert start(runner)["request"].make_job().size == (96, 128)


def test_what_is_asked_of_one_column_goes_before_what_all_do(runner: Any) -> None:
    assert start(runner)["rank"] == Rank.REST
    assert start(runner, alone=True)["rank"] == Rank.CHANGED


def test_a_drag_lets_its_pictures_finish(runner: Any) -> None:
    assert start(runner, draft=True)["patient"] is False
    assert start(runner, draft=True)["patient"] is True
    assert start(runner)["patient"] is False


def test_the_last_result_stays_while_a_control_is_dragged(runner: Any) -> None:
    start(runner)
    end = finished((96, 128), 5.0)
    runner._finished(end)
    start(runner, draft=True)
    assert (runner.scene.result, runner.scene.status, runner.scene.draft) == (end.result, "waiting", True)
    runner._finished(finished((48, 64), 0.05, draft=True))
    assert runner.scene.draft
    start(runner)
    assert (runner.scene.result, runner.scene.draft) == (None, False)


def test_a_point_has_the_numbers_of_its_own_picture(runner: Any) -> None:
    start(runner)
    first, second = finished((96, 128), 0.01), finished((96, 128), 0.02, draft=True)
    runner._finished(first)
    runner.measurer._finished(Measured({"d": 1.0}, (96, 128)))
    start(runner, draft=True)
    runner._finished(second)
    # The newer picture is shown with the numbers of the one before, until it has its own.
    assert (runner.scene.result, dict(runner.scene.measures)) == (second.result, {"d": 1.0})
    assert len(runner._shared.points.points) == 1
    runner.measurer._measure_next()
    runner.measurer._finished(Measured({"d": 2.0}, (96, 128)))
    points = runner._shared.points.points
    assert [each.cell.measures for each in points] == [{"d": 1.0}, {"d": 2.0}]
    assert [each.cell.job.key for each in points] == [each.result.job.key for each in (first, second)]


def test_a_picture_of_a_drag_is_measured_when_no_other_follows(runner: Any, monkeypatch: Any) -> None:
    now = [100.0]
    monkeypatch.setattr("texlab.runs.measurer.time.monotonic", lambda: now[0])
    measured: list[Any] = runner.measurer.worker.asked
    start(runner)
    runner._finished(finished((96, 128), 0.01))
    assert len(measured) == 1
    runner.measurer._finished(Measured({"d": 1.0}, (96, 128)))
    for number in range(5):
        now[0] += 0.016
        start(runner, draft=True)
        runner._finished(finished((96, 128), 0.02 + number / 100, draft=True))
        # The next event comes soon: no core is taken from its picture.
        assert (len(measured), runner.measuring) == (1, True)
    runner.measurer._rest.timeout.emit()
    assert len(measured) == 2
    now[0] += 0.1
    runner.measurer._finished(Measured({"d": 2.0}, (96, 128)))
    assert not runner.measuring
    # Numbers that take 100 ms are made every two seconds, so that pictures have nearly all of the time.
    for after, count in ((OVERDUE_S, 2), (0.1 / MEASURING_SHARE, 3)):
        now[0] += after
        start(runner, draft=True)
        runner._finished(finished((96, 128), after, draft=True))
        assert len(measured) == count
        now[0] -= after


def test_an_earlier_result_is_shown_until_there_is_a_picture(runner: Any) -> None:
    first, second = (np.full((8, 6, 3), value, np.uint8) for value in (1, 2))
    runner.show_stored(first, {"d": 1.0})
    assert runner.scene.picture is first
    assert (dict(runner.scene.measures), runner.scene.measured_size) == ({"d": 1.0}, (8, 6))
    runner.show_stored(second, {})
    assert runner.scene.picture is first


def test_what_a_drag_makes_is_not_kept_as_a_result(runner: Any) -> None:
    start(runner, draft=True)
    # At full size it has the job of the result, but neither its stages nor a state to go on from.
    runner._finished(finished((96, 128), 0.01, draft=True))
    assert (len(runner._shared.kept), runner.scene.history, runner.resumable) == (0, (), False)
    start(runner)
    runner._finished(finished((96, 128), 0.01))
    assert (len(runner._shared.kept), len(runner.scene.history)) == (1, 1)


def test_a_draft_of_the_methods_own_is_no_result(runner: Any) -> None:
    start(runner)
    image = np.zeros((8, 8, 3), np.float32)
    runner._finished(Drafted(np.zeros((8, 8, 3), np.uint8), image))
    assert (runner.scene.result, runner.scene.draft, runner.scene.image is image) == (None, True, True)


def test_every_report_is_shown(runner: Any) -> None:
    changes: list[Any] = []
    runner.changed.connect(lambda: changes.append(runner.scene))
    start(runner)
    runner._progressed(Waits("loading"))
    assert runner.scene.message == "loading"
    runner._started()
    assert runner.scene.status == "running"
    image = np.zeros((8, 8, 3), np.float32)
    runner._progressed(Progress(0.5, "half", {"a": 1.0}, np.zeros((8, 8, 3), np.uint8), image, (), 2.0))
    assert (runner.scene.fraction, runner.scene.message, runner.scene.image is image) == (0.5, "half", True)
    runner.stop()
    assert runner.worker.cancels == 1
    runner._cancelled()
    assert runner.scene.status == "cancelled"
    runner._failed("Too small.")
    assert (runner.scene.status, runner.scene.message, runner.scene.picture) == ("failed", "Too small.", None)
    assert len(changes) == 6


def test_a_picture_that_cannot_be_measured_stays(runner: Any, caplog: pytest.LogCaptureFixture) -> None:
    start(runner)
    end = finished((96, 128), 0.01)
    runner._finished(end)
    assert runner.measuring
    runner.measurer._failed("There is not enough memory for this size.")
    assert (runner.scene.status, runner.scene.result, runner.measuring) == ("finished", end.result, False)
    assert runner.scene.unexamined == BROKEN
    assert "could not be measured: There is not enough memory" in caplog.text


def test_where_another_exemplar_stood_is_no_place_to_go_on_from(runner: Any) -> None:
    start(runner)
    runner._run.state = lambda: {"canvas": np.zeros(3)}
    runner.stop()
    assert runner.resumable
    kept = runner._kept
    # The job reads it last.
    assert start(runner, go_on=True)["request"].make_job.keywords["kept"] is kept
    assert start(runner)["request"].make_job.keywords["kept"] is None
    other = exemplar(height=18)
    runner.start(COLUMN, State(None, (COLUMN,), 5, (96, 128), 2), other, go_on=True)
    assert runner.worker.asked[-1]["request"].make_job.keywords["kept"] is None
    assert not runner.resumable


def test_the_cells_of_a_sweep_share_their_analysis(qapp: Any) -> None:
    plan = SweepPlan((Vary("level", (0.0, 1.0, 2.0)), Vary("detail", (3, 4))), 16)
    sweep = sweep_of(plan, State(None, (COLUMN,), 5, (24, 24), 2), COLUMN, exemplar())
    analyses.clear()
    task: Any = SimpleNamespace(
        should_stop=lambda: False, due=lambda: False, progress=lambda value: None, give_way=lambda: 0.0
    )
    report = SweepRun(sweep, Slots(2))(task)
    assert len(report.cells) == 6
    assert sorted(analyses) == [3, 4]


def test_the_worker_is_the_columns_own(qapp: Any) -> None:
    made = ColumnRunner(COLUMN, Shared(Slots(1), AnalysisCache(), Warmth()))
    assert isinstance(made.worker, Worker)
    # Threads come with what they are asked for.
    assert made.ended
    for worker in (made.worker, made.measurer.worker):
        worker.submit(lambda task: None)
        assert not made.ended
    made.leave()
    made.close()
    assert made.ended
