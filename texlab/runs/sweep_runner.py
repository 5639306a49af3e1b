"""The newest sweep at work: its thread, and what there is to see of it."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING, Any

from texlab.runs.cell_runner import CellRunner, CellsMade
from texlab.runs.sweep_run import SweepRun, grid_of, sweep_of
from texlab.state.sweeps import SweepScene

if TYPE_CHECKING:
    from PySide6.QtCore import QObject

    from texlab.runs.slots import Slots
    from texlab.runs.worker import Request
    from texlab.state.chosen import Column, State
    from texlab.state.sweeps import SweepPlan
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.warming import Warmth


class SweepRunner(CellRunner):
    """Runs one sweep, the newest instead of any other."""

    scene: SweepScene

    def __init__(self, slots: Slots, warmth: Warmth, parent: QObject | None = None) -> None:
        super().__init__("sweep", SweepScene(), slots, warmth, parent)
        self._begun = 0.0

    def start(self, plan: SweepPlan, state: State, column_id: int, exemplar: ImageInput | None) -> None:
        """Run what was asked for; what cannot be run is said in ``scene.problem``, and what runs goes on."""

        def make(column: Column, exemplar: ImageInput) -> tuple[SweepScene, Request]:
            if plan.textures is not None:
                self._begun = time.perf_counter()
                read = partial(grid_of, plan, state, column)
                return SweepScene(asked=plan, plan=plan), SweepRun(read, self._slots)
            sweep = sweep_of(plan, state, column, exemplar)
            self._begun = time.perf_counter()
            return SweepScene(asked=plan, plan=plan, sweep=sweep), SweepRun(sweep, self._slots)

        self._begin(state, column_id, exemplar, make, asked=plan)

    def _progressed(self, made: CellsMade, **more: Any) -> None:
        super()._progressed(made, seconds=time.perf_counter() - self._begun, **more)
