"""Numbers that follow the slider: beside the pictures, which never wait, said with the draft's own size."""

import threading
import time

import numpy as np
import pytest

from tests.stub_method import StubParams, stub  # noqa: F401
from texlab.runs.column_run import Measured, MeasureRun
from texlab.runs.controller import Controller
from texlab.state.chosen import Column, Sample, State
from texlab.state.session import Session
from texlab_core.errors import Cancelled
from texlab_core.images.exemplar import as_exemplar
from texlab_core.measures.registry import measure_all
from texlab_core.measures.subject import Subject

PATIENCE_MS = 30_000


@pytest.fixture
def bench(qtbot, stub):  # noqa: F811
    session = Session()
    controller = Controller(session)
    pixels = np.random.default_rng(2).random((48, 44, 3), np.float32)
    session.apply(State(None, (Column(1, "stub", StubParams()),), 5, (48, 56), 2), "start")
    session.set_sample(Sample(as_exemplar(pixels)))
    yield session, controller
    controller.close()
    controller.deleteLater()


def test_the_numbers_come_after_the_picture_and_are_the_registrys(qtbot, bench):
    _, controller = bench
    orders = []
    controller.scene_changed.connect(
        lambda scene: orders.append((scene.columns[0].result is not None, bool(scene.columns[0].measures)))
    )
    qtbot.waitUntil(lambda: "w1-bands" in controller.column_scene(1).measures, timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: not controller.busy and not controller.measuring, timeout=PATIENCE_MS)
    column = controller.column_scene(1)
    assert column.status == "finished"
    assert column.measures == measure_all(Subject.of_result(column.result))
    assert column.measured_size == (48, 56)
    # The first picture is there before its first number.
    assert orders.index((True, False)) < orders.index((True, True))


def test_a_new_run_takes_the_old_numbers_away(qtbot, bench):
    session, controller = bench
    qtbot.waitUntil(lambda: bool(controller.column_scene(1).measures), timeout=PATIENCE_MS)
    session.set_seed(6)
    qtbot.waitUntil(lambda: not controller.column_scene(1).measures, timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: not controller.busy and not controller.measuring, timeout=PATIENCE_MS)
    assert controller.column_scene(1).measures


def test_no_picture_waits_for_numbers_and_old_ones_are_renewed(qtbot, bench, monkeypatch):
    """Measuring that takes for ever: a drag goes on beside it, and its numbers are about what was measured."""
    _, controller = bench
    qtbot.waitUntil(lambda: bool(controller.column_scene(1).measures), timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: not controller.measuring, timeout=PATIENCE_MS)
    runner = controller._runners[1]
    begun, may_end = threading.Semaphore(0), threading.Semaphore(0)

    def slow(run, task):
        begun.release()
        while not may_end.acquire(timeout=0.001):
            if task.should_stop():
                raise Cancelled
        return Measured({"contrast": float(run.result.job.params.level)}, run.image.shape[:2])

    monkeypatch.setattr(MeasureRun, "__call__", slow)

    def drag(level):
        # As quick as that: no small drafts on a machine that has much to do.
        runner.seconds = 1e-6
        controller.editing.params(1, StubParams(level=level), "level", False)
        qtbot.waitUntil(lambda: controller.column_scene(1).result.job.params.level == level, timeout=PATIENCE_MS)

    # Numbers that are new enough make way.
    runner.measurer._last_s = time.monotonic() + 1e6
    drag(2.0)
    qtbot.waitUntil(lambda: begun.acquire(blocking=False), timeout=PATIENCE_MS)
    drag(2.5)
    qtbot.waitUntil(lambda: begun.acquire(blocking=False), timeout=PATIENCE_MS)
    # Old ones are made beside the next pictures.
    runner.measurer._last_s = 0.0
    points = len(controller.scene().points)
    drag(3.2)
    drag(3.6)
    assert not begun.acquire(blocking=False)
    may_end.release()
    qtbot.waitUntil(lambda: controller.column_scene(1).measures == {"contrast": 2.5}, timeout=PATIENCE_MS)
    assert controller.column_scene(1).result.job.params.level == 3.6
    # They are no point of the picture that is shown, which is measured next.
    assert len(controller.scene().points) == points
    may_end.release()
    qtbot.waitUntil(lambda: controller.column_scene(1).measures == {"contrast": 3.6}, timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: not controller.measuring, timeout=PATIENCE_MS)
    assert len(controller.scene().points) == points + 1


def test_a_draft_is_measured_at_its_own_size(qtbot, bench):
    _, controller = bench
    qtbot.waitUntil(lambda: not controller.busy and not controller.measuring, timeout=PATIENCE_MS)
    runner = controller._runners[1]
    # The full size is said to take so long that a draft is small.
    runner.seconds = 100.0
    controller.editing.params(1, StubParams(level=2.0), "level", False)
    qtbot.waitUntil(lambda: controller.column_scene(1).draft, timeout=PATIENCE_MS)
    qtbot.waitUntil(lambda: not controller.busy and not controller.measuring, timeout=PATIENCE_MS)
    column = controller.column_scene(1)
    assert column.draft
    assert column.measured_size == column.image.shape[:2] != (48, 56)
    assert "copied-share" in column.measures
    # What is not quick waits for the full size.
    assert "w1-bands" not in column.measures
