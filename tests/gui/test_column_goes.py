"""A column that is shown no more holds nothing of its pictures, wherever its run stood."""

from __future__ import annotations

import gc
import weakref
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import image_input

from texlab.runs.column_runner import ColumnRunner, Shared
from texlab.runs.slots import Slots
from texlab.state.chosen import Column, State
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.registry import methods
from texlab_core.warming import Warmth

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.app.explorer import Explorer

SIDES = (29, 31)
# One that can go on from where it was stopped, and one that keeps every iteration.
SMALL = {"efros-leung": {"window": 5}, "heeger-bergen": {"scales": 2, "iterations": 3}}


class At:
    """Waits until a column that runs stands where it is looked for."""

    def __init__(self, qtbot: Any, method: str) -> None:
        self._qtbot = qtbot
        warmth = Warmth()
        # Runs load what they need by themselves.
        warmth.close()
        self.shared = Shared(Slots(1), AnalysisCache(), warmth)
        self.exemplar = image_input(np.random.default_rng(4).random((24, 25, 3), np.float32), "noise")
        self.column = Column(1, method, methods()[method].params.from_json(SMALL[method]))
        self.runner = ColumnRunner(self.column, self.shared)
        self.seen: list[weakref.ref[Any]] = []
        self.runner.changed.connect(self._see)

    def _see(self) -> None:
        scene = self.runner.scene
        shown = scene.picture, scene.image, scene.result, *(frame.picture for frame in scene.frames)
        self.seen += [weakref.ref(each) for each in shown if each is not None]

    def start(self, **how: Any) -> None:
        self.runner.start(self.column, State(None, (self.column,), 5, SIDES, 2), self.exemplar, **how)

    def until(self, there: Callable[[], bool]) -> None:
        self._qtbot.waitUntil(there, timeout=30_000)

    def first_picture(self) -> None:
        self.start()
        self.until(lambda: bool(self.runner.scene.frames) or self.runner.scene.image is not None)

    def stopped(self) -> None:
        self.first_picture()
        self.runner.stop()

    def finished(self) -> None:
        self.start()
        self.until(lambda: self.runner.scene.status == "finished")

    def measured(self) -> None:
        self.finished()
        self.until(lambda: not self.runner.measuring)

    def dragged(self) -> None:
        self.measured()
        self.start(draft=True)
        self.until(lambda: self.runner.scene.status == "finished")


@pytest.mark.parametrize("where", [At.first_picture, At.stopped, At.finished, At.measured, At.dragged])
@pytest.mark.parametrize("method", list(SMALL))
def test_a_column_that_goes_holds_none_of_its_pictures(
    qtbot: Any, method: str, where: Callable[[At], None]
) -> None:
    at = At(qtbot, method)
    where(at)
    assert at.seen
    at.runner.leave()
    at.runner.forget()
    # Kept for the next time, within bounds of their own.
    at.shared.kept.clear()
    at.shared.cache.clear()
    at.until(lambda: at.runner.ended)
    qtbot.wait(0)
    gc.collect()
    assert not [type(held).__name__ for each in at.seen if (held := each()) is not None]
    assert not [key for key, held in vars(at.runner).items() if key in ("_run", "_kept", "_exemplar") and held]


def test_what_has_come_to_its_end_is_no_longer_held_as_a_run(qtbot: Any) -> None:
    at = At(qtbot, "heeger-bergen")
    at.measured()
    assert at.runner._run is None
    assert at.runner.scene.frames
    at.runner.close()


def test_whoever_holds_the_view_of_a_column_that_went_holds_no_picture(qtbot: Any, explorer: Explorer) -> None:
    session, workspace = explorer.session, explorer.workspace
    gone = session.state.columns[0].id
    view = workspace.columns[gone]
    qtbot.waitUntil(lambda: view.pane.picture is not None and explorer.idle)
    view.pane.set_overlay(np.zeros((8, 8, 4), np.uint8))
    explorer.window.actions_by_name["tile"].trigger()
    shown = view.scene, view.pane._overlay, view.pane.item.image, view.pane._copies[0].whole
    assert all(each is not None for each in shown)
    session.remove_column(gone)
    qtbot.waitUntil(lambda: gone not in workspace.columns)
    held = view.scene, view.pane.picture, view.pane.item.whole, view.pane.item.image, view.pane.item.qimage
    assert all(each is None for each in held)
    assert view.pane._overlay is None
    assert all(copy.whole is None for copy in view.pane._copies)
