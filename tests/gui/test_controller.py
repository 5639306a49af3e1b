"""The controller without a window: what is pointed at, dragged, swept."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

from tests.stub_method import Gate, StubParams, exemplar, stub  # noqa: F401
from texlab.runs.controller import Controller
from texlab.state.chosen import Column, Sample, State
from texlab.state.scene import Probe
from texlab.state.session import Session
from texlab.state.sweeps import NO_SWEEP, SweepPlan
from texlab_core.engine.inputs import Crop
from texlab_core.sheets.sweep import Vary
from texlab_core.warming import Need

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.usefixtures("stub")


@pytest.fixture
def controller(qtbot: Any) -> Iterator[Controller]:
    session = Session()
    made = Controller(session)
    columns = tuple(Column(number, "stub", StubParams()) for number in (1, 2))
    session.apply(State(Sample(exemplar()), columns, 5, (24, 32), 3), "start")
    session.select(1)
    wait(qtbot, made)
    yield made
    made.close()
    made.deleteLater()


def wait(qtbot: Any, controller: Controller) -> None:
    qtbot.waitUntil(lambda: not controller.busy)


def test_a_pinned_pixel_stays_until_it_is_pinned_again(controller: Controller) -> None:
    controller.pointing.point_at(1, 3, 4)
    assert controller.scene().probe == Probe(1, 3, 4)
    controller.pointing.pin(1, 5, 6)
    controller.pointing.point_at(2, 7, 8)
    assert controller.scene().probe == Probe(1, 5, 6, pinned=True)
    controller.pointing.pin(1, 5, 7)
    assert controller.scene().probe == Probe(1, 5, 7, pinned=True)
    controller.pointing.pin(1, 5, 7)
    assert controller.scene().probe is None
    controller.pointing.point_at(2, 7, 8)
    controller.pointing.point_at(2, -1, -1)
    assert controller.scene().probe is None


def test_a_scene_is_the_session_and_what_came_of_it(qtbot: Any, controller: Controller) -> None:
    scene = controller.scene()
    assert ([column.id for column in scene.columns], scene.selected_id, scene.seed) == ([1, 2], 1, 5)
    assert scene.sweep is NO_SWEEP or scene.sweep.number == 0
    assert [column.status for column in scene.columns] == ["finished", "finished"]
    controller.session.set_seed(8)
    wait(qtbot, controller)
    assert controller.scene().seed == 8
    assert [column.result.job.seed for column in controller.scene().columns] == [8, 8]  # type: ignore[union-attr]


def test_a_dragged_crop_ends_at_full_size(qtbot: Any, controller: Controller) -> None:
    for left in (1, 2, 3):
        controller.editing.crop(Crop(0, left, 12, 12), final=False)
    # The last draft is there before the button goes up.
    wait(qtbot, controller)
    assert any(runner.drafted for runner in controller._runners.values())
    controller.editing.crop(Crop(0, 3, 12, 12), final=True)
    wait(qtbot, controller)
    for column in controller.scene().columns:
        assert not column.draft
        assert column.result is not None
        assert column.result.job.inputs["exemplar"].size == (12, 12)
        assert column.result.image.shape[:2] == (24, 32)
    assert not any(runner.drafted for runner in controller._runners.values())
    controller.session.undo()
    assert controller.session.state.sample is not None
    assert controller.session.state.sample.crop is None


def test_dragged_parameters_are_one_step(qtbot: Any, controller: Controller) -> None:
    for level in (0.1, 0.2, 0.3):
        controller.editing.params(1, StubParams(level=level), "level", False)
    controller.editing.params(1, StubParams(level=0.3), "level", True)
    wait(qtbot, controller)
    scene = controller.column_scene(1)
    assert scene is not None
    assert scene.result is not None
    assert (scene.draft, scene.result.job.params) == (False, StubParams(level=0.3))
    controller.session.undo()
    assert controller.session.state.columns[0].params == StubParams()


def test_a_sweep_that_cannot_be_run_is_said_and_leaves_what_runs(qtbot: Any, controller: Controller) -> None:
    plan = SweepPlan((Vary("level", (0.0, 1.0)),), 16)
    controller.run_sweep(1, plan)
    qtbot.waitUntil(lambda: controller.scene().sweep.status == "finished")
    before = controller.scene().sweep
    assert (before.number, before.column_id, before.plan, len(before.cells)) == (1, 1, plan, 2)
    huge = SweepPlan((Vary("seed", tuple(range(400))),), 512)
    controller.run_sweep(1, huge)
    after = controller.scene().sweep
    assert (after.number, after.plan, after.asked, after.cells) == (1, plan, huge, before.cells)
    assert "megapixels" in after.problem
    controller.run_sweep(99, plan)
    assert controller.scene().sweep.problem
    # What works again has no problem.
    controller.run_sweep(1, plan)
    assert (controller.scene().sweep.problem, controller.scene().sweep.number) == ("", 2)
    qtbot.waitUntil(lambda: controller.scene().sweep.status == "finished")


def test_cells_wait_until_their_method_is_loaded(
    qtbot: Any, controller: Controller, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Any] = []
    warmth = SimpleNamespace(wait=lambda need, should_stop: asked.append(need))
    monkeypatch.setattr(controller._sweeps, "_warmth", warmth)
    controller.run_sweep(1, SweepPlan((Vary("level", (0.0, 1.0)),), 16))
    wait(qtbot, controller)
    qtbot.waitUntil(lambda: controller.scene().sweep.status == "finished")
    assert asked == [Need("stub", controller.exemplar.channels)]


def test_a_sweep_is_stopped_with_what_it_has(
    qtbot: Any, controller: Controller, monkeypatch: pytest.MonkeyPatch
) -> None:
    plan = SweepPlan((Vary("level", tuple(level / 20 for level in range(30))),), 16, StubParams(rounds=60))
    gate = Gate(monkeypatch, 3)
    controller.run_sweep(1, plan)
    qtbot.waitUntil(lambda: len(controller.scene().sweep.cells) == 3)
    controller.stop_sweep()
    gate.open()
    stopped = controller.scene().sweep
    assert (stopped.status, stopped.running) == ("stopped", False)
    assert len(stopped.cells) == 3


def test_a_column_that_was_removed_holds_no_picture(controller: Controller) -> None:
    shown = controller.column_scene(2)
    assert shown is not None
    assert shown.result is not None
    assert shown.picture is not None
    controller.session.remove_column(2)
    # Its runner waits for its thread, and for another one to go.
    (gone,) = controller._leaving
    assert gone.scene.id == 2
    assert (gone.scene.result, gone.scene.picture, gone.scene.image) == (None, None, None)
    assert not gone.scene.frames
