"""Sweeps: ranges against closed forms, cells against single runs, one analysis for all, cancel and failure."""

from __future__ import annotations

import dataclasses
import threading
from functools import partial

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.stub_method import StubParams, analyses, exemplar, running, stub  # noqa: F401
from texlab_core.batch.places import InProcess
from texlab_core.batch.running import run_jobs
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.engine.steps import Map
from texlab_core.errors import Cancelled, InputError, ParamError
from texlab_core.measures.registry import measure_quick
from texlab_core.measures.subject import Subject
from texlab_core.sheets.sweep import Cell, Sweep, Vary, sweep_of
from texlab_core.sheets.sweep_running import run_sweep, run_sweep_elsewhere

pytestmark = pytest.mark.usefixtures("stub")


def base(**params):
    return Job(method="stub", inputs={"exemplar": exemplar()}, params=StubParams(**params), seed=3)


# Values


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("level=0:1:5", (0.0, 0.25, 0.5, 0.75, 1.0)),
        ("level=0.1:0.3:3", (0.1, 0.2, 0.3)),
        ("level=1:0:3", (1.0, 0.5, 0.0)),
        ("level=2:2:1", (2.0,)),
        ("level=2:2:9", (2.0,)),
        ("grain=0.01:100:5:log", (0.01, 0.1, 1.0, 10.0, 100.0)),
        ("grain=1000:0.001:3:log", (1000.0, 1.0, 0.001)),
        ("rounds=1:4:7", (1, 2, 3, 4)),
        ("rounds=1:256:9:log", (1, 2, 4, 8, 16, 32, 64, 128, 256)),
        ("window=3:9:7", (3, 5, 7, 9)),
        ("window=3:41:3", (3, 23, 41)),
        ("border=wrap,reflect", ("wrap", "reflect")),
        ("exact=yes,no,on", (True, False)),
        ("level=0.5, 0.25,0.5", (0.5, 0.25)),
        ("level=[0.5, 1]", (0.5, 1.0)),
        ("seed=1:4:4", (1, 2, 3, 4)),
        (" seed = 7,9 ", (7, 9)),
    ],
)
def test_texts(text, values):
    vary = Vary.parse(text, StubParams)
    assert vary.values == values
    assert [type(each) for each in vary.values] == [type(each) for each in values]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("level", "vary: must be NAME=FROM:TO:COUNT"),
        ("level=", "vary: must be NAME=FROM:TO:COUNT"),
        ("=1:2:3", "vary: must be NAME=FROM:TO:COUNT"),
        ("level=1:2", "vary: must be NAME=FROM:TO:COUNT"),
        ("level=1:2:3:lin", "vary: must be NAME=FROM:TO:COUNT"),
        ("level=1:2:3:log:x", "vary: must be NAME=FROM:TO:COUNT"),
        ("levle=1:2:3", "(did you mean level?), got 'levle'"),
        ("level=1:2:0", "a count from 1 to 400 for level"),
        ("level=1:2:401", "a count from 1 to 400 for level"),
        ("level=1:2:1e9", "a count from 1 to 400 for level"),
        ("level=1:2:99999999999999999999", "a count from 1 to 400 for level"),
        ("level=0:2:3:log", "a range above 0 for level in even ratios"),
        ("level=0:9:3", "level: must be a number from 0 to 4, got 9."),
        ("level=nan:1:3", "level: must be a number from 0 to 4"),
        ("level=a:1:3", "level: must be a number from 0 to 4"),
        ("window=3:10:3", "window: must be an odd whole number from 3 to 41"),
        ("window=4", "window: must be an odd whole number from 3 to 41"),
        ("border=wrap,tile", "border: must be one of reflect, wrap, got 'tile'"),
        ("border=0:1:2", "border: must be one of"),
        ("exact=0:1:2", "exact: must be true or false"),
        ("seed=-1", "seed: must be a whole number from 0"),
        ("level=[NaN]", "holds NaN"),
        ("level=[]", "a list of values for level"),
        ("level=" + ",".join(["1"] * 401), "at most 400 values for level"),
    ],
)
def test_texts_that_are_refused(text, says):
    with pytest.raises(InputError) as caught:
        Vary.parse(text, StubParams)
    assert says in str(caught.value)
    assert str(caught.value).endswith(".")


fixture_is_fine = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


@fixture_is_fine
@given(first=st.floats(0, 4), last=st.floats(0, 4), count=st.integers(1, 50))
def test_ranges_start_and_end_where_they_were_told_and_are_even(first, last, count):
    values = Vary.parse(f"level={first!r}:{last!r}:{count}", StubParams).values
    assert values[0] == pytest.approx(first, rel=1e-11)
    assert all(0 <= each <= 4 for each in values)
    if len(values) == count > 1:
        np.testing.assert_allclose(np.diff(values), (last - first) / (count - 1), atol=1e-10)


@fixture_is_fine
@given(first=st.integers(1, 20), last=st.integers(1, 20), count=st.integers(2, 30))
def test_odd_ranges_hold_odd_numbers_nearest_to_even_steps(first, last, count):
    first, last = 2 * first + 1, 2 * last + 1
    values = Vary.parse(f"window={first}:{last}:{count}", StubParams).values
    places = np.linspace(first, last, count)
    odd = np.arange(3, 42, 2)
    assert set(values) <= set(odd.tolist())
    assert all(np.abs(places - each).min() <= 1 for each in values)
    assert values[0] == first
    assert values[-1] == last


# Grids


def test_the_first_axis_runs_across():
    sweep = sweep_of(base(), ["level=0:1:3", "seed=5,6"])
    assert [(job.params.level, job.seed) for job in sweep.jobs] == [
        (0.0, 5),
        (0.5, 5),
        (1.0, 5),
        (0.0, 6),
        (0.5, 6),
        (1.0, 6),
    ]
    assert all(dict(sweep.values(index)) for index in range(6))
    assert all(job.params.rounds == 2 for job in sweep.jobs)


@pytest.mark.parametrize(
    ("texts", "says"),
    [
        ([], "one or two knobs, got 0"),
        (["level=1,2", "seed=1,2", "rounds=1,2"], "one or two knobs, got 3"),
        (["level=1,2", "level=3,4"], "got level twice"),
        (["level=0:1:21", "seed=1:20:20"], "at most 400 cells, got 420"),
    ],
)
def test_grids_that_are_refused_before_any_work(texts, says):
    with pytest.raises(InputError, match=says):
        sweep_of(base(), texts)
    assert not running


def test_values_given_as_data_are_checked_too():
    assert Sweep(base(), (Vary("window", (3, 5.0)),)).axes[0].values == (3, 5)
    with pytest.raises(ParamError, match="window"):
        Sweep(base(), (Vary("window", (4,)),))
    with pytest.raises(ParamError, match="a list of values"):
        Sweep(base(), (Vary("window", "3"),))


# Running


@pytest.mark.parametrize("workers", [1, 2, 5])
def test_cells_equal_single_runs_bit_for_bit(workers):
    sweep = sweep_of(base(), ["level=0:2:4", "seed=1,2"])
    seen = []
    shares = []
    cells = run_sweep(sweep, seen.append, on_progress=shares.append, workers=workers)
    assert [cell.index for cell in cells] == list(range(8))
    assert sorted(cell.index for cell in seen) == list(range(8))
    for cell in cells:
        alone = run(cell.job)
        assert np.array_equal(cell.result.image, alone.image)
        assert cell.result.measures == alone.measures
        assert cell.measures == measure_quick(Subject.of_result(alone))
        assert cell.measures["median-candidates"] == 7
        assert cell.measures["copied-share"] == cell.job.params.level / 4
        assert cell.result.maps == {}
        assert cell.result.model is None
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_an_analysis_is_made_once_for_all_cells_that_share_it():
    cache = AnalysisCache()
    run_sweep(sweep_of(base(), ["level=0:2:8"]), cache=cache, workers=4)
    assert analyses == [0]
    run_sweep(sweep_of(base(), ["level=1:2:3"]), cache=cache, workers=2)
    assert analyses == [0]
    run_sweep(sweep_of(base(), ["detail=0,1,2", "level=1,2"]), cache=cache, workers=3)
    assert sorted(analyses) == [0, 1, 2]


def test_callbacks_come_in_the_callers_thread():
    here = threading.get_ident()
    threads = []
    run_sweep(sweep_of(base(), ["level=0:2:4"]), lambda _: threads.append(threading.get_ident()), workers=2)
    assert set(threads) == {here}
    assert here not in running


def test_a_failing_cell_keeps_its_sentence_and_the_others_go_on():
    cells = run_sweep(sweep_of(base(), ["level=1,3,2"]))
    assert [cell.error for cell in cells] == ["", "level: 3 is what this stub fails at.", ""]
    assert cells[1].result is None
    assert cells[1].label == "level 3, failed"
    assert cells[0].label.startswith("level 1, ")
    assert cells[0].label.endswith("candidates 7")


def test_an_unexpected_failure_is_logged_and_kept(caplog, monkeypatch):
    monkeypatch.setattr("texlab_core.sheets.sweep_running.measure_quick", lambda _: 1 / 0)
    cells = run_sweep(sweep_of(base(), ["level=1,2"]))
    assert cells[0].error == "Something unexpected happened (ZeroDivisionError: division by zero)."
    assert "ZeroDivisionError" in caplog.text


@pytest.mark.parametrize("workers", [1, 3])
def test_a_stopped_sweep_raises_and_leaves_nothing_running(workers):
    seen = []
    sweep = sweep_of(base(rounds=500), ["level=1,2", "seed=1:20:20"])
    with pytest.raises(Cancelled):
        run_sweep(sweep, seen.append, lambda: len(running) >= workers, workers=workers)
    assert len(running) <= workers
    assert not seen
    assert not [each for each in threading.enumerate() if each.name.startswith("sweep")]


def test_a_cell_that_waits_for_an_analysis_can_be_stopped():
    sweep = sweep_of(base(rounds=500), ["level=0:2:20"])
    asked = []
    with pytest.raises(Cancelled):
        run_sweep(sweep, None, lambda: len(asked) > 1 or bool(asked.append(1)), workers=8)
    assert len(running) <= 8


# Labels


@pytest.mark.parametrize(
    ("values", "measures", "label"),
    [
        ({"alpha": 0.15, "beta": 1.0}, {"copied-share": 0.9449}, "alpha 0.15, beta 1, copied 94%"),
        ({"seed": 7}, {"cuts": 3.0}, "seed 7"),
        ({"window": 15}, {"copied-share": 1.0, "median-candidates": 1234.0}, None),
        ({"exact": True}, {"median-candidates": 2.5, "cuts": 4.0}, "exact yes, candidates 2.5"),
        ({"alpha": 1 / 3}, {}, "alpha 0.3333"),
    ],
)
def test_labels(values, measures, label):
    expected = "window 15, copied 100%, candidates 1,234" if label is None else label
    assert Cell(index=0, job=base(), values=values, measures=measures).label == expected


def test_evidence_comes_from_the_maps():
    rows, columns = np.mgrid[0:8, 0:8].astype(np.int32)
    source = np.stack([rows, columns], axis=2)
    counts = np.arange(64, dtype=np.int32).reshape(8, 8)
    maps = {"source": Map(source, "source", "Source"), "count": Map(counts, "count", "Candidates")}
    output = Subject(image=np.zeros((8, 8, 1), np.float32), maps=maps)
    assert measure_quick(output) == {"copied-share": 1.0, "largest-copy": 1.0, "median-candidates": 31.5}
    said = dataclasses.replace(output, given={"median-candidates": 3.0, "exact-share": 0.5})
    assert measure_quick(said) == measure_quick(output) | {"median-candidates": 3.0, "exact-share": 0.5}


class OnePlace:
    """One place for everybody, with a record of who held it."""

    def __init__(self):
        self.changed = threading.Condition()
        self.holder = None
        self.held = []

    def acquire(self, should_stop):
        with self.changed:
            while self.holder is not None and not should_stop():
                self.changed.wait()
            if should_stop():
                return False
            self.holder = threading.get_ident()
            self.held.append(self.holder)
            return True

    def release(self):
        with self.changed:
            assert self.holder == threading.get_ident()
            self.holder = None
            self.changed.notify_all()

    def wake(self):
        with self.changed:
            self.changed.notify_all()


def test_cells_take_places():
    places = OnePlace()
    sweep = sweep_of(base(), ["level=0:4:9"])
    cells = run_sweep(sweep, workers=3, places=places)
    assert len(places.held) == 9
    assert places.holder is None
    alone = run_sweep(sweep, workers=1)
    for here, there in zip(cells, alone, strict=True):
        assert here.error == there.error
        if here.result is not None:
            assert np.array_equal(here.result.image, there.result.image)


def test_cancel_while_waiting_for_a_place():
    places = OnePlace()
    assert places.acquire(lambda: False)
    with pytest.raises(Cancelled):
        run_sweep(sweep_of(base(), ["level=0:2:5"]), should_stop=lambda: True, workers=2, places=places)
    assert len(places.held) == 1
    places.release()


def test_cells_that_run_elsewhere_are_the_same():
    sweep = sweep_of(base(), ["level=0,1,2", "seed=1,2"])
    told, shares = [], []
    elsewhere = partial(run_jobs, place=InProcess())
    cells = run_sweep_elsewhere(sweep, told.append, elsewhere=elsewhere, on_progress=shares.append)
    for cell, here in zip(cells, run_sweep(sweep), strict=True):
        assert (cell.index, cell.label, cell.error) == (here.index, here.label, here.error)
        assert cell.measures == here.measures
        assert cell.job is cell.result.job is sweep.jobs[cell.index]
        np.testing.assert_array_equal(cell.result.image, here.result.image)
    assert [cell.index for cell in told] == list(range(6))
    assert shares == [(place + 1) / 6 for place in range(6)]
    failing = run_sweep_elsewhere(sweep_of(base(), ["level=0,3"]), elsewhere=elsewhere)
    assert [cell.error for cell in failing] == [cell.error for cell in run_sweep(sweep_of(base(), ["level=0,3"]))]
    with pytest.raises(Cancelled):
        run_sweep_elsewhere(sweep, elsewhere=elsewhere, should_stop=lambda: True)
