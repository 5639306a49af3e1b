"""The newest fill of a whole picture at work: its run in a worker's thread, and what there is to see of it."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab.runs.scene_runner import SceneRunner
from texlab.state.filling import FillScene
from texlab.style.pictures import Picture, to_picture
from texlab_core.engine.run import run
from texlab_core.methods.efros_leung.filling import filled_of
from texlab_core.warming import Need

if TYPE_CHECKING:
    from PySide6.QtCore import QObject

    from texlab.runs.column_run import TaskLike
    from texlab.runs.slots import Slots
    from texlab.state.filling import FillPlan
    from texlab_core.engine.steps import Step
    from texlab_core.methods.efros_leung.filling import Filled
    from texlab_core.warming import Warmth

# Painting a large part takes a while; nobody sees more than a few of them.
PREVIEW_S = 0.2


@dataclass(frozen=True, eq=False)
class FillProgress:
    """How far a fill is, and what it looks like now and then."""

    fraction: float
    message: str
    preview: Picture | None = None


@dataclass
class FillRun:
    """A request for a worker: fills, and takes from the result what the plan wants of it."""

    plan: FillPlan

    def __call__(self, task: TaskLike) -> Filled:
        """Fill to the end, reporting on the way."""
        shown = time.perf_counter()

        def watch(step: Step) -> None:
            nonlocal shown
            task.give_way()
            if not task.due():
                return
            preview = None
            if step.preview is not None and step.phase == "synthesis" and time.perf_counter() - shown > PREVIEW_S:
                shown = time.perf_counter()
                image = step.preview()
                preview = to_picture(
                    np.ascontiguousarray(image if self.plan.box is None else image[self.plan.box])
                )
            task.progress(FillProgress(step.fraction if step.phase == "synthesis" else 0.0, step.stage, preview))

        result = run(self.plan.make_job(), watch, task.should_stop, threads=1)
        return filled_of(result, self.plan.box)


class FillRunner(SceneRunner):
    """Runs one fill, the newest instead of any other."""

    scene: FillScene

    def __init__(self, slots: Slots, warmth: Warmth, parent: QObject | None = None) -> None:
        super().__init__("fill", FillScene(), slots, parent)
        self._warmth = warmth
        self._worker.progressed.connect(self._progressed)
        self._worker.finished.connect(lambda found: self._show(status="finished", fraction=1.0, found=found))
        self._worker.failed.connect(lambda sentence: self._show(status="failed", message=sentence, preview=None))
        self._worker.cancelled.connect(lambda: self._show(status="stopped", preview=None))

    def start(self, plan: FillPlan) -> None:
        """Fill."""
        self.scene = FillScene(plan, "running", 0.0, "waiting")
        needs, warmth = [Need("efros-leung", channels) for channels in (1, 3)], self._warmth

        def first(task: TaskLike) -> None:
            for need in needs:
                warmth.wait(need, task.should_stop)

        self._worker.submit(FillRun(plan), first=first)
        self.changed.emit()

    @property
    def busy(self) -> bool:
        """Whether it fills."""
        return self.scene.status == "running"

    def _progressed(self, report: FillProgress) -> None:
        preview = self.scene.preview if report.preview is None else report.preview
        self._show(fraction=report.fraction, message=report.message, preview=preview)
