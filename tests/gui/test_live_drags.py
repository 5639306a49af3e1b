"""Pictures under the finger: patient requests, full size while a control is dragged, docks that rest."""

from __future__ import annotations

import threading
from typing import ClassVar

import numpy as np
import pytest
from dock_scenes import column_of, scene_of
from mouse import on_screen

from tests.gui.conftest import drag, handle_point, ids, result_image, wait_idle
from tests.stub_method import StubParams
from texlab.docks.base import Dock, Question
from texlab.docks.host import DockHost
from texlab.runs.column_run import Finished
from texlab.runs.slots import Slots
from texlab.runs.worker import Worker
from texlab_core.engine.run import run
from texlab_core.methods.de_bonet.params import DeBonetParams


class Gate:
    """A request that runs until it is opened."""

    def __init__(self, value):
        self.value = value
        self.started, self.opened = threading.Event(), threading.Event()

    def __call__(self, task):
        self.started.set()
        while not self.opened.wait(0.005):
            if task.should_stop():
                from texlab_core.errors import Cancelled

                raise Cancelled
        return self.value


@pytest.fixture
def worker():
    made = Worker("test")
    yield made
    made.close()


def test_a_patient_request_lets_the_running_one_finish(worker, qtbot):
    finished = []
    worker.finished.connect(lambda value: finished.append((value, worker.behind)))
    first, second, third = Gate(1), Gate(2), Gate(3)
    worker.submit(first)
    assert first.started.wait(60)
    worker.submit(second, patient=True)
    worker.submit(third, patient=True)
    for gate in (first, second, third):
        gate.opened.set()
    qtbot.waitUntil(lambda: not worker.behind)
    # The second one never started: the newest request took its place.
    assert finished == [(1, True), (3, False)]
    assert not second.started.is_set()


def test_an_impatient_request_stops_what_runs(worker, qtbot):
    finished = []
    worker.finished.connect(finished.append)
    first, second = Gate(1), Gate(2)
    worker.submit(first)
    assert first.started.wait(60)
    worker.submit(second)
    second.opened.set()
    qtbot.waitUntil(lambda: bool(finished))
    assert finished == [2]


def test_cancel_forgets_patient_requests_too(worker, qtbot):
    finished = []
    worker.finished.connect(finished.append)
    first, second = Gate(1), Gate(2)
    worker.submit(first)
    assert first.started.wait(60)
    worker.submit(second, patient=True)
    with qtbot.waitSignal(worker.cancelled):
        worker.cancel()
    qtbot.waitUntil(lambda: not worker.busy)
    assert not worker.behind
    assert finished == []


def test_a_quick_method_is_dragged_at_full_size(open_window, texture, qtbot, monkeypatch):
    # Quick on any machine, however busy it is.
    monkeypatch.setattr("texlab.runs.column_runner.draft_size", lambda size, seconds: None)
    explorer = open_window(str(texture), [("de-bonet", DeBonetParams())])
    controller, session = explorer.controller, explorer.session
    column = session.state.columns[0]
    seen = []

    def look(scene):
        shown = scene.columns[0]
        seen.append((shown.status, shown.draft, shown.result is not None and shown.result.job.size))

    controller.scene_changed.connect(look)
    slider = explorer.window.parameters.form.knobs["alpha"].slider
    qtbot.waitUntil(lambda: slider.width() > 40)
    places = [handle_point(slider, share) for share in (0.2, 0.3, 0.4, 0.5)]
    drag(qtbot, slider, [handle_point(slider), *places])
    wait_idle(qtbot, explorer)
    dragged = [each for each in seen if each[0] == "finished"]
    assert dragged
    assert {draft for _, draft, _ in seen} == {False}
    assert {size for _, _, size in dragged} == {session.state.size}
    final = controller.column_scene(column.id)
    assert final.result.job.params == session.state.columns[0].params
    assert final.frames
    assert session.undo_text is not None
    session.undo()
    assert session.undo_text is None
    assert session.state.columns[0].params == DeBonetParams()


class Counting(Dock):
    """Counts how often it is asked."""

    name: ClassVar[str] = "counting"
    title: ClassVar[str] = "Counting"
    help: ClassVar[str] = ""
    # For ever, until the test has seen it.
    rest_ms: ClassVar[int] = 10**7

    def __init__(self):
        super().__init__()
        self.shown = []
        self.opened = threading.Event()

    def question(self, scene):
        number = float(scene.columns[0].metrics["number"])

        def compute(should_stop):
            self.opened.wait(60)
            return number

        return Question((number,), compute)

    def present(self, answer):
        self.shown.append(answer)

    def present_nothing(self, reason):
        raise AssertionError(reason)


def test_a_dock_rests_between_answers_and_ends_with_the_newest(qtbot):
    dock = Counting()
    qtbot.addWidget(dock)
    dock.show()
    on_screen(qtbot, dock)
    host = DockHost(dock, Slots(1))
    image = np.zeros((4, 4, 3), np.float32)
    for number in range(20):
        host.show_scene(scene_of(column_of(image, metrics={"number": number})))
    assert host.busy
    dock.opened.set()
    qtbot.waitUntil(lambda: bool(dock.shown))
    # The newest waits for the end of the rest.
    assert host._rest.isActive()
    assert host.busy
    assert dock.shown == [0]
    host._rested.setRemainingTime(0)
    host._rest.start(0)
    qtbot.waitUntil(lambda: not host.busy)
    assert dock.shown == [0, 19]
    host.close()


def test_a_changed_column_does_not_wait_for_the_end_of_the_others(open_window, texture, qtbot, monkeypatch, stub):
    monkeypatch.setattr("texlab.runs.controller.os.cpu_count", lambda: 1)
    long, short = ("stub", StubParams(rounds=500)), ("stub", StubParams(rounds=2))
    explorer = open_window(str(texture), [long, short])
    controller, (first, second) = explorer.controller, ids(explorer)
    ends = []
    for each in (first, second):
        controller._runners[each].worker.finished.connect(
            lambda end, each=each: ends.append(each) if isinstance(end, Finished) else None
        )
    # What is finished would be shown again without a run.
    controller._shared.kept.clear()
    controller.run_all()
    qtbot.waitUntil(lambda: controller.column_scene(first).status == "running")
    controller.editing.params(second, StubParams(rounds=2, level=1.0), "level", True)
    wait_idle(qtbot, explorer)
    # Whether or not the short one had its first turn before the long one began.
    assert ends[-2:] == [second, first]
    job = controller.column_scene(first).result.job
    assert np.array_equal(result_image(explorer, first), run(job).image)
    assert controller.column_scene(second).result.measures["copied-share"] == 0.25
