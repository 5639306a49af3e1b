"""Sweeps in the window: what the user asked for as a sweep, and its run in a worker's thread."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab.runs.cell_runner import CellsMade, Teller, workers
from texlab.runs.column_run import TaskLike, job_of
from texlab.state.sweeps import ShownCell
from texlab.style.pictures import to_picture
from texlab_core.engine.registry import find_method
from texlab_core.engine.sizes import size_text
from texlab_core.errors import InputError
from texlab_core.sheets.sweep import Cell, Sweep
from texlab_core.sheets.sweep_running import Places, run_sweep

if TYPE_CHECKING:
    from texlab.state.session import Column, State
    from texlab.state.sweeps import SweepPlan
    from texlab_core.engine.inputs import ImageInput

# All results are kept at full precision, for the sheet that is saved: 12 bytes a pixel.
MAX_PIXELS = 32 * 2**20


def sweep_of(plan: SweepPlan, state: State, column: Column, exemplar: ImageInput) -> Sweep:
    """Return the sweep of a column's method that was asked for.

    Raises
    ------
    InputError
        When it cannot be run, or would not fit in memory.
    """
    if plan.params is not None:
        column = dataclasses.replace(column, params=plan.params)
    size = None if plan.side is None else (plan.side,) * find_method(column.method).dimensions
    base = job_of(column, state, exemplar, size=size)
    sweep = Sweep(base, plan.axes)
    # Of solids only the slices that are shown are kept.
    if len(sweep.jobs) * math.prod(base.picture_size) > MAX_PIXELS:
        raise InputError(
            f"{len(sweep.jobs)} cells of {size_text(base.size)} are more than "
            f"{MAX_PIXELS // 2**20} megapixels; ask for fewer or smaller cells."
        )
    return sweep


@dataclass
class SweepRun:
    """A request for a worker: runs every cell, each on a place of its own, and leaves one core to the columns."""

    sweep: Sweep
    places: Places

    def __call__(self, task: TaskLike) -> CellsMade:
        """Run to the end, reporting every cell."""
        teller = Teller(task)

        def show(cell: Cell) -> None:
            teller.add(ShownCell(cell, None if cell.result is None else to_picture(cell.result.image)))

        run_sweep(
            self.sweep, show, task.should_stop, on_progress=teller.advance, workers=workers(), places=self.places
        )
        return teller.end()
