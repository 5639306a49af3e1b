"""One run of a column, without its worker: its pictures, what is measured after it, and that it can be stopped."""

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest

from tests.gui.dock_scenes import column_of
from texlab.columns.status import details, figures, numbers_of, status_parts
from texlab.docks.findings.words import nothing_to_list
from texlab.runs import column_run
from texlab.runs.column_run import SOLID, ColumnRun, Measured, MeasureRun
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.engine.steps import Step
from texlab_core.errors import Cancelled
from texlab_core.findings.registry import Detector, find_all
from texlab_core.images.exemplar import as_exemplar
from texlab_core.measures.registry import Measure, measure_all, measure_quick
from texlab_core.measures.subject import PreparedCache, Subject


def job():
    pixels = np.random.default_rng(1).random((48, 44, 3), np.float32)
    return Job(method="tiling", inputs={"exemplar": as_exemplar(pixels)}, size=(52, 60), seed=1)


class Task:
    """A worker that asks for a stop at its ``stop_at``-th question."""

    def __init__(self, stop_at=0):
        self.stop_at, self.asked, self.ways = stop_at, 0, 0
        self.reports = []

    def should_stop(self):
        self.asked += 1
        return self.asked == self.stop_at

    def due(self):
        return False

    def progress(self, value):
        self.reports.append(value)

    def give_way(self):
        self.ways += 1
        return 0.0


def measuring(result, draft=False, cache=None):
    cache = PreparedCache() if cache is None else cache
    return MeasureRun(result.image, result.job.inputs["exemplar"], result, cache, draft)


def test_what_an_end_takes_is_counted_where_it_was_made():
    end = ColumnRun(job, AnalysisCache())(Task())
    # The window's thread reads it, and walks no arrays.
    assert vars(end)["nbytes"] == end.nbytes
    maps = sum(each.nbytes for each in (end.result.image, end.picture))
    assert end.nbytes >= maps == 52 * 60 * 3 * (4 + 1)


def test_a_run_can_be_stopped_at_every_question():
    whole = Task()
    ColumnRun(job, AnalysisCache())(whole)
    for stop_at in range(1, whole.asked + 1):
        task = Task(stop_at)
        with pytest.raises(Cancelled):
            ColumnRun(job, AnalysisCache())(task)
        assert task.asked == stop_at


@pytest.mark.parametrize(("step_s", "picture_s"), [(0.02, 0.001), (0.1, 1.0), (0.05, 20.0)])
def test_pictures_on_the_way_take_a_share_of_the_time_and_reports_none(monkeypatch, step_s, picture_s):
    count, clock, drawn = 4000, [0.0], []

    def preview():
        clock[0] += picture_s
        drawn.append(clock[0])
        return np.zeros((4, 4, 3), np.float32)

    def steps(made, watch, *_, **__):
        for done in range(count):
            clock[0] += step_s
            watch(Step(done, count, "round", preview=preview, phase="synthesis"))
        return run(made)

    monkeypatch.setattr(column_run, "run", steps)
    monkeypatch.setattr(column_run, "time", SimpleNamespace(perf_counter=lambda: clock[0]))
    task = Task()
    task.due = lambda: True
    ColumnRun(job, AnalysisCache())(task)
    assert [each.fraction for each in task.reports] == [done / count for done in range(count)]
    assert sum(each.picture is not None for each in task.reports) == len(drawn)
    assert drawn[0] == pytest.approx(step_s + picture_s)
    share = column_run.PICTURES_SHARE
    if picture_s / (picture_s + step_s) <= share:
        assert len(drawn) == count
    else:
        assert len(drawn) > 1
        assert (len(drawn) - 1) * picture_s <= share * clock[0]
        assert len(drawn) * (picture_s + step_s) >= share * clock[0] / 2


def test_a_result_is_measured_quickly_then_wholly():
    result = run(job())
    task = Task()
    found = measuring(result)(task)
    subject = Subject.of_result(result)
    assert found.measures == measure_all(subject)
    assert found.size == (52, 60)
    # Quick numbers, all numbers, then what is wrong.
    assert [each.measures for each in task.reports] == [measure_quick(subject), measure_all(subject)]
    assert [(each.findings, each.unexamined) for each in task.reports] == [(None, "")] * 2
    assert found.findings == find_all(subject, result.job.params)
    assert found.unexamined == ""
    assert task.ways >= task.asked > 40


def test_a_draft_is_measured_quickly_only_and_without_a_result():
    result = run(job())
    task = Task()
    draft = MeasureRun(result.image[:50], result.job.inputs["exemplar"], None, PreparedCache(), draft=True)
    found = draft(task)
    assert task.reports == []
    assert found.size == (50, 60)
    assert found.measures == measure_quick(Subject.of_images(result.job.inputs["exemplar"], result.image[:50]))
    assert {"discriminability", "visual-difference"} < set(found.measures)


def test_measuring_stops_at_any_question():
    result = run(job())
    whole = Task()
    measuring(result)(whole)
    for stop_at in range(1, whole.asked + 1, 7):
        task = Task(stop_at)
        with pytest.raises(Cancelled):
            measuring(result)(task)
        assert task.asked == stop_at


def test_a_measure_that_fails_leaves_the_picture_as_it_is(monkeypatch, caplog):
    result = run(job())
    whole = measuring(result)(Task())
    monkeypatch.setattr(Measure, "of", fails_for(Measure.of, "visual-difference"))
    monkeypatch.setattr(Detector, "examine", fails_for(Detector.examine, whole.findings[0].id))
    found = measuring(result)(Task())
    assert isinstance(found, Measured)
    assert found.measures.keys() == whole.measures.keys() - {"visual-difference"}
    assert found.findings == whole.findings[1:]
    title = whole.findings[0].title
    assert found.unexamined == f"Not looked for, since this detector failed: {title}. The log says why."
    # Nobody says that nothing is wrong where nobody could look.
    shown = {"findings": (), "unexamined": found.unexamined, "measures": found.measures}
    column = dataclasses.replace(column_of(result.image, title="Stub"), **shown)
    assert nothing_to_list(column) == f"Nothing was found in the result of Stub. {found.unexamined}"
    assert "The measure visual-difference of texlab failed; it is left out." in caplog.text
    assert f"The detector {whole.findings[0].id} of texlab failed; it is left out." in caplog.text
    assert "TypeError" in caplog.text


def fails_for(method, name):
    """Return a method that fails for one of the registered things only."""

    def failing(self, given):
        return method(self, given / 0 if self.id == name else given)

    return failing


def test_what_cannot_be_examined_is_told_from_what_has_no_fault():
    result = run(job())
    solid = measuring(dataclasses.replace(result, volume=np.zeros((4, *result.image.shape), np.float32)))(Task())
    assert (solid.findings, solid.unexamined) == (None, SOLID)
    small = measuring(dataclasses.replace(result, image=result.image[:31]))(Task())
    assert small.findings is None
    assert small.unexamined == "Nothing is looked for where the result or the exemplar is under 32 pixels."


def test_a_column_says_three_numbers_and_the_tool_tip_all():
    image = np.zeros((30, 40, 3), np.float32)
    numbers = {"discriminability": -3.456, "magnitude-difference": 0.02, "visual-difference": 0.25, "cuts": 5.0}
    column = column_of(image, measures={"copied-share": 0.5}, elapsed_s=1.0)
    assert [each.text for each in figures(numbers_of(column))] == ["copied 50%"]
    column = dataclasses.replace(column, measures=numbers, measured_size=(30, 40))
    assert [each.text for each in figures(numbers_of(column))] == ["D -3.46", "V 0.25", "copied 50%"]
    lines = details(column)
    assert lines[0] == "Measured at 40 x 30:"
    assert sorted(lines[1:]) == sorted(["D -3.46", "m 0.020", "V 0.25", "copied 50%", "cuts 5.0"])


def test_a_draft_says_its_own_size():
    column = column_of(np.zeros((30, 40, 3), np.float32), measures={}, draft=True, status="finished")
    column = dataclasses.replace(column, result=None, measures={"discriminability": -2.0}, measured_size=(30, 40))
    assert status_parts(column) == ["draft 40 x 30"]
    assert [each.text for each in figures(numbers_of(column))] == ["D -2.00"]
