"""D against V: what is plotted and where, by plain data; the search and a click, with real events in a session."""

from __future__ import annotations

import math
import threading
from dataclasses import replace

import numpy as np
import pytest
from bench import DockBench
from dock_scenes import check_controls, shown
from PySide6.QtCore import QPointF, Qt

from tests.stub_method import StubParams, exemplar, stub  # noqa: F401
from texlab.docks.tuning.dock import TuningDock, looks
from texlab.docks.tuning.points import (
    SEARCH,
    SWEEP,
    D,
    Group,
    Placed,
    V,
    axes_of,
    describe_cell,
    groups_of,
    knob_choices,
    limit_choices,
    nearest,
    placed,
    settings,
    zone_lines,
)
from texlab.runs.kept_points import MOST, KeptPoints, small
from texlab.state.intentions import RunTuning, StopTuning, TakeCell
from texlab.state.scene import ColumnScene, Scene
from texlab.state.sweeps import ShownCell, SweepScene
from texlab.state.tuning import TuningPlan, TuningScene
from texlab.style.pictures import to_picture
from texlab.style.theme import DARK
from texlab_core.engine.job import Job
from texlab_core.engine.result import Result
from texlab_core.errors import Cancelled, InputError, ParamError
from texlab_core.methods.de_bonet.params import DeBonetParams
from texlab_core.sheets.sweep import Cell, Sweep, Vary

pytestmark = pytest.mark.usefixtures("stub")
PATIENCE_MS = 20_000


def job_of(level=1.0, seed=0, image=None):
    inputs = {"exemplar": image or exemplar()}
    return Job(method="stub", inputs=inputs, params=StubParams(level=level), size=(24, 32), seed=seed)


def shown_of(d, v, level=1.0, index=0, image=None, **more):
    job = job_of(level, image=image)
    picture = np.full((4, 4, 3), 9, np.uint8)
    return ShownCell(Cell(index=index, job=job, values={}, measures={D: d, V: v, **more}), picture)


def test_groups_are_the_search_the_sweep_and_the_methods():
    sweep = Sweep(job_of(), (Vary("level", (0.5, 1.0, 2.0)), Vary("seed", (1, 2))))
    cells = [shown_of(-index, 0.1 * index, index=index) for index in (4, 0, 1, 3)]
    other = shown_of(-1, 0.5, image=exemplar(height=17))
    bare = replace_measures(shown_of(0, 0), {})
    scene = Scene(
        exemplar=exemplar(),
        sweep=SweepScene(sweep=sweep, cells=(*cells, other)),
        tuning=TuningScene(cells=(shown_of(-3, 0.4), bare)),
        points=(shown_of(-2, 0.3), other),
    )
    search, swept, stub_runs = groups_of(scene)
    assert (search.title, swept.title, stub_runs.title) == ("search", "sweep", "Stub")
    assert (len(search.cells), len(stub_runs.cells)) == (1, 1)
    # In the order of the grid; each row of it is a curve.
    assert [each.cell.index for each in swept.cells] == [0, 1, 3, 4]
    assert swept.curves == ((0, 1), (2, 3))
    assert groups_of(Scene()) == ()


def replace_measures(shown, measures):
    return ShownCell(replace(shown.cell, measures=measures), shown.picture)


@pytest.mark.parametrize(
    ("axis", "curves"),
    [(Vary("level", (0.5, 1.0)), ((0, 1),)), (Vary("seed", (1, 2)), ()), (Vary("exact", (False, True)), ())],
)
def test_only_numbers_make_curves(axis, curves):
    scene = SweepScene(sweep=Sweep(job_of(), (axis,)), cells=(shown_of(0, 0, index=0), shown_of(1, 1, index=1)))
    assert groups_of(Scene(exemplar=exemplar(), sweep=scene))[0].curves == curves


def test_a_method_keeps_its_colour_when_a_search_and_a_sweep_come():
    methods = [Group(f"method {number}", ()) for number in range(9)]
    alone = looks(methods)
    beside = looks([Group(SEARCH, ()), Group(SWEEP, ()), *methods])
    assert beside[2:] == alone
    assert not set(beside[:2]) & set(alone)


def test_trials_are_a_faint_cloud_behind_runs_that_can_be_read(qtbot):
    dock = shown(qtbot, TuningDock())
    cloud = tuple(shown_of(-3, 0.4, index=index) for index in range(3))
    dock.show_scene(Scene(exemplar=exemplar(), tuning=TuningScene(cells=cloud), points=(shown_of(-3.1, 0.4),)))
    (trials, run), texts = dock.plot._series[:2], dock.plot._texts
    assert trials.item.opts["size"] < run.item.opts["size"]
    assert (trials.item.opts["pen"].style(), run.item.opts["pen"].style()) == (
        Qt.PenStyle.NoPen,
        Qt.PenStyle.SolidLine,
    )
    assert all(item.fill.color().alpha() > 128 for item, *_ in texts)
    assert all(trials.item.zValue() < item.zValue() < run.item.zValue() for item, *_ in texts)


def test_points_need_both_measures():
    cells = (shown_of(-3, 0.5), replace_measures(shown_of(0, 0), {D: -1.0}), shown_of(-2, math.nan))
    first, second, third = placed(cells, D, V)
    assert (first.x, first.y, second, third) == (-3, 0.5, None, None)
    assert [each.x for each in placed(cells[:1], V, D)] == [0.5]
    titles = dict(axes_of(groups_of(Scene(exemplar=exemplar(), points=(shown_of(0, 0, cuts=3.0),)))))
    assert {"D", "V", "cuts"} == set(titles)


def test_the_nearest_point_is_measured_in_pixels():
    points = [Placed(0, 0, shown_of(0, 0)), Placed(1, 0, shown_of(0, 0)), Placed(1, 0, shown_of(0, 0))]
    assert nearest(points, 0.1, 0, (0.01, 1)) is points[0]
    assert nearest(points, 0.5, 0, (0.01, 1)) is None
    # Across, twelve pixels are .12; up, they are twelve. Of two at one place the upper one counts.
    assert nearest(points, 0.95, 9, (0.01, 1)) is points[2]


def test_words():
    assert zone_lines(D) == ((-3.4, "good"), (-2.1, "bad"))
    assert zone_lines(V) == ()
    assert settings(DeBonetParams()) == "the defaults"
    assert settings(DeBonetParams(alpha=0.2, coarsest_side=1)) == "alpha 0.2, coarsest side 1"
    told = describe_cell(shown_of(-3.2, 0.5, level=2.0).cell, D, V)
    assert told.startswith("Stub: D -3.20, V 0.50; level 2")
    assert told.endswith("seed 0")
    assert [value for _, value in limit_choices(-2.9)] == [-3.1, -3.4, "start", -2.9]
    assert knob_choices("de-bonet")[0] == ("thresholds", ())
    assert ("level", ("level",)) in knob_choices("stub")


def test_finished_runs_are_kept_once_and_the_oldest_go():
    kept = KeptPoints()
    image = np.random.default_rng(0).random((300, 200, 3), np.float32)

    def column(level, measures, **more):
        result = Result(image=image, job=job_of(level), model=None, elapsed_s=0.1, versions={})
        fields = {"id": 3, "method": "stub", "title": "Stub", "params": StubParams(), "status": "finished"}
        fields["picture"] = to_picture(image)
        return ColumnScene(**(fields | {"result": result, "measures": measures} | more))

    first, later = {D: -3.0}, {D: -3.0, V: 0.5}
    for each in (column(0.5, first), column(1.0, {}), column(2.0, first, draft=True), column(0.5, later)):
        kept.note(each)
    (only,) = kept.points
    assert only.cell.measures is later
    assert np.array_equal(only.picture, small(image))
    assert max(only.picture.shape[:2]) <= 128
    before = kept.points
    kept.note(column(0.5, later))
    assert kept.points is before
    for place in range(1, MOST + 1):
        kept.note(column(0.5 + place / 1000, dict(later)))
    assert len(kept.points) == MOST
    assert kept.points[-1].cell.job.params.level == 0.5 + MOST / 1000


@pytest.fixture
def bench(qtbot, monkeypatch):
    monkeypatch.setattr("texlab.docks.tuning.dock.BUDGET", 26)
    made = DockBench(qtbot, TuningDock(), 1000, 420)
    made.begin(48, 64, exemplar(48, 64))
    yield made
    made.close()


def test_trials_of_a_search_are_drawn_together(qtbot):
    dock = shown(qtbot, TuningDock(), 900, 260)
    cells = tuple(shown_of(-3 - k / 10, 0.4, level=k / 10, index=k) for k in range(9))
    given = exemplar()

    def show(count, status="running", **more):
        dock.show_scene(Scene(exemplar=given, tuning=TuningScene(status=status, cells=cells[:count]), **more))
        return len(dock.points)

    assert show(0, "idle") == 0
    # The first one at once, those that follow in one go.
    assert show(1) == 1
    assert dock.status.text() == "1 run so far"
    assert [show(count) for count in (2, 3, 5)] == [1, 1, 1]
    assert dock.status.text() == "5 runs so far"
    dock._redraw.timeout.emit()
    assert len(dock.points) == 5
    # What else there is to see is drawn when it comes, and so is the end.
    assert show(6, points=(shown_of(-1, 0.9),)) == 7
    assert [show(count) for count in (6, 7)] == [6, 6]
    assert show(9, "finished") == 9
    assert not dock._redraw.isActive()


def place_of(dock, point):
    where = dock.plot.graph.mapFromScene(dock.plot.view.mapViewToScene(QPointF(point.x, point.y)))
    return where


def test_runs_become_points_a_search_adds_more_and_a_click_takes_one(qtbot, bench):
    dock = bench.dock
    check_controls(dock)
    qtbot.waitUntil(lambda: len(dock.points) == 1, timeout=PATIENCE_MS)
    dock.knobs.setCurrentIndex(dock.knobs.findText("level"))
    qtbot.mouseClick(dock.suggest_button, Qt.MouseButton.LeftButton)
    assert bench.intended == [RunTuning(1, TuningPlan(-3.1, ("level",), 26))]
    qtbot.waitUntil(lambda: len(dock.points) > 3, timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: not bench.controller.scene().tuning.running, timeout=PATIENCE_MS)
    tuning = bench.controller.scene().tuning
    assert tuning.status == "finished", tuning.problem
    qtbot.waitUntil(lambda: dock.status.text() == tuning.found.sentence, timeout=PATIENCE_MS)
    usable = {each.params for each in tuning.found.trials if each.usable}
    assert {each.cell.job.params for each in tuning.cells} == usable

    # The pointer shows a point, a click takes its parameters as one step of the history.
    viewport = dock.plot.graph.viewport()
    wanted = dock.points[0]
    qtbot.mouseMove(viewport, place_of(dock, wanted))
    qtbot.waitUntil(lambda: dock.over is not None, timeout=PATIENCE_MS)
    over = dock.over
    assert (over.x, over.y) == (wanted.x, wanted.y)
    assert dock.told.text().startswith("Stub: ")
    assert dock.picture.picture is over.shown.picture
    qtbot.mouseClick(viewport, Qt.MouseButton.LeftButton, pos=place_of(dock, wanted))
    assert isinstance(bench.intended[-1], TakeCell)
    assert bench.session.selected_column.params == over.shown.cell.job.params
    qtbot.waitUntil(lambda: not bench.controller.busy, timeout=PATIENCE_MS)
    dock.set_theme(DARK)


def test_take_gives_the_column_what_was_found(qtbot, bench):
    dock = bench.dock
    dock.knobs.setCurrentIndex(dock.knobs.findText("level"))
    dock.limit.setCurrentIndex(dock.limit.findData("start"))
    dock.suggest()
    qtbot.waitUntil(lambda: bench.controller.scene().tuning.status in ("finished", "failed"), timeout=PATIENCE_MS)
    tuning = bench.controller.scene().tuning
    assert tuning.status == "finished", tuning.problem
    qtbot.waitUntil(lambda: dock.scene.tuning.found is not None, timeout=PATIENCE_MS)
    assert dock.take_button.isEnabled() == bool(tuning.found.changes)
    dock.take()
    assert bench.session.selected_column.params == tuning.found.found
    qtbot.waitUntil(lambda: not bench.controller.busy, timeout=PATIENCE_MS)


def test_a_search_runs_with_the_columns_own_seed(qtbot, bench, monkeypatch):
    bases = []

    def refuse(base, knobs, **more):
        bases.append(base)
        raise InputError("Enough.")

    monkeypatch.setattr("texlab.runs.tuning_runner.tune", refuse)
    bench.session.set_column_seed(1, 8)
    bench.dock.suggest()
    qtbot.waitUntil(lambda: bench.controller.scene().tuning.problem == "Enough.", timeout=PATIENCE_MS)
    assert [base.seed for base in bases] == [8]
    qtbot.waitUntil(lambda: not bench.controller.busy, timeout=PATIENCE_MS)


def test_stop_keeps_the_points(qtbot, bench, monkeypatch):
    dock = bench.dock

    def endless(base, knobs, *, on_trial, should_stop, **more):
        cell = Cell(index=0, job=base, values={}, measures={D: -3.0, V: 0.5}, result=result_of(base))
        on_trial(None, cell)
        while not should_stop():
            threading.Event().wait(0.002)
        raise Cancelled

    monkeypatch.setattr("texlab.runs.tuning_runner.tune", endless)
    dock.suggest()
    qtbot.waitUntil(lambda: len(bench.controller.scene().tuning.cells) == 1, timeout=PATIENCE_MS)
    qtbot.waitUntil(dock.stop_button.isEnabled, timeout=PATIENCE_MS)
    qtbot.mouseClick(dock.stop_button, Qt.MouseButton.LeftButton)
    assert isinstance(bench.intended[-1], StopTuning)
    qtbot.waitUntil(lambda: bench.controller.scene().tuning.status == "stopped", timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: dock.status.text().startswith("Stopped after 1 run;"), timeout=PATIENCE_MS)
    assert len(groups_of(bench.controller.scene())[0].cells) == 1


def result_of(job):
    return Result(image=np.full((24, 32, 3), 0.5, np.float32), job=job, model=None, elapsed_s=0.1, versions={})


def test_what_cannot_be_searched_is_said(qtbot, bench, monkeypatch):
    def refuse(*given, **more):
        raise ParamError("knobs", "numbers", "nothing")

    monkeypatch.setattr("texlab.runs.tuning_runner.tune", refuse)
    bench.dock.suggest()
    said = "knobs: must be numbers, got 'nothing'."
    qtbot.waitUntil(lambda: bench.dock.status.text() == said, timeout=PATIENCE_MS)
