"""Sweeps in the window: what the user asked for as a sweep, and its run in a worker's thread."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from texlab.runs.cell_runner import CellsMade, Teller, workers
from texlab.runs.column_run import TaskLike, job_of
from texlab.state.sweeps import ShownCell
from texlab.style.pictures import to_picture
from texlab_core.engine.registry import find_method
from texlab_core.engine.sizes import size_text
from texlab_core.errors import InputError
from texlab_core.sheets.sweep import MAX_CELLS, Cell, Sweep
from texlab_core.sheets.sweep_running import Places, run_sweep
from texlab_core.sheets.texture_grid import left_out_words, read_textures, texture_grid

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab.state.chosen import Column, State
    from texlab.state.sweeps import SweepPlan
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.sheets.texture_grid import TextureGrid

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
    _check_pixels(sweep)
    return sweep


def _check_pixels(sweep: Sweep) -> None:
    # Of solids only the slices that are shown are kept.
    if len(sweep.jobs) * math.prod(sweep.base.picture_size) > MAX_PIXELS:
        raise InputError(
            f"{len(sweep.jobs)} cells of {size_text(sweep.base.size)} are more than "
            f"{MAX_PIXELS // 2**20} megapixels; ask for fewer or smaller cells."
        )


def grid_of(
    plan: SweepPlan, state: State, column: Column, should_stop: Callable[[], bool]
) -> tuple[TextureGrid, str]:
    """Read the textures that were asked for (in a worker's thread), and return their grid and what is left out.

    Raises
    ------
    InputError
        When there is no texture that the method can work with, or it would not fit in memory.
    Cancelled
        When ``should_stop`` said so.
    """
    from texlab_core.images.sources import sources_of

    assert plan.textures is not None
    listed = (source for text in plan.textures.texts for source, _ in sources_of(text, Path(), "Textures"))
    sources = tuple(dict.fromkeys(listed))
    down = plan.axes[0] if plan.axes else None
    count = len(sources) * (1 if down is None else len(down.values))
    if count > MAX_CELLS:
        raise InputError(f"A sweep has at most {MAX_CELLS} cells, and these textures make {count}; choose fewer.")
    textures, unread = read_textures(sources, should_stop=should_stop)
    if not textures:
        raise InputError(unread[0][1])
    dimensions = find_method(column.method).dimensions
    grid, unfit = texture_grid(
        textures,
        column.method,
        column.params if plan.params is None else plan.params,
        size=state.size_of(column) if plan.side is None else (plan.side,) * dimensions,
        seed=state.seed_of(column),
        inputs=dict(column.inputs),
        down=down,
    )
    _check_pixels(grid)
    return grid, left_out_words((*unread, *unfit))


@dataclass
class SweepRun:
    """A request for a worker: runs every cell, each on a place of its own, and leaves one core to the columns.

    Parameters
    ----------
    sweep
        The cells; or what reads many textures, and makes them and what is said of those that were left out.
    places
        On the cores.
    """

    sweep: Sweep | Callable[[Callable[[], bool]], tuple[Sweep, str]]
    places: Places

    def __call__(self, task: TaskLike) -> CellsMade:
        """Run to the end, reporting every cell."""
        teller = Teller(task)
        if isinstance(self.sweep, Sweep):
            sweep = self.sweep
        else:
            sweep, left_out = self.sweep(task.should_stop)
            teller.tell(sweep=sweep, left_out=left_out)

        def show(cell: Cell) -> None:
            teller.add(ShownCell(cell, None if cell.result is None else to_picture(cell.result.image)))

        run_sweep(sweep, show, task.should_stop, on_progress=teller.advance, workers=workers(), places=self.places)
        return teller.end()
