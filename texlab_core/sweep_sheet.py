"""The contact sheet of a sweep: every cell with what was varied and what came of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.contact_sheet import LARGEST_CELL, Tile, contact_sheet, series_columns
from texlab_core.registry import find_method
from texlab_core.sweep import show

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from texlab_core.sweep import Cell, Sweep


def sweep_sheet(
    sweep: Sweep, cells: Sequence[Cell], *, columns: int | None = None, largest: int = LARGEST_CELL
) -> NDArray[np.uint8]:
    """Draw the cells that are there, each in its place.

    Two knobs make rows and columns with heads; a series of one is wrapped into rows.

    Parameters
    ----------
    sweep
        The grid.
    cells
        All of its cells, or those that have finished.
    columns
        Cells in a row of a series; chosen from their number when None.
    largest
        Longest side at which a cell is shown.

    Returns
    -------
    uint8 array
        (H, W, 3).
    """
    is_grid = len(sweep.axes) == 2
    finished = {cell.index: cell for cell in cells}
    tiles = [_tile(finished.get(index), is_grid) for index in range(len(sweep.jobs))]
    across = len(sweep.axes[0].values) if is_grid else columns or series_columns(len(tiles))
    heads = [[f"{axis.name.replace('_', ' ')} {show(value)}" for value in axis.values] for axis in sweep.axes]
    return contact_sheet(
        tiles,
        across,
        title=_title(sweep),
        column_heads=heads[0] if is_grid else (),
        row_heads=heads[1] if is_grid else (),
        largest=largest,
    )


def _tile(cell: Cell | None, is_grid: bool) -> Tile:
    if cell is None:
        return Tile(None, ("...",))
    lines = (cell.evidence,) if is_grid else (cell.setting, cell.evidence)
    image = None if cell.result is None else cell.result.image
    return Tile(image, tuple(line for line in lines if line), cell.error)


def _title(sweep: Sweep) -> tuple[str, str]:
    names = [axis.name.replace("_", " ") for axis in sweep.axes]
    varied = names[0] if len(names) == 1 else f"{names[0]} across, {names[1]} down"
    base = sweep.base
    fixed = [f"{base.size[1]} x {base.size[0]}"]
    fixed += [] if "seed" in names else [f"seed {base.seed}"]
    defaults = type(base.params)()
    for name, value in base.params.to_json().items():
        if value != defaults.to_json()[name] and name not in {axis.name for axis in sweep.axes}:
            fixed.append(f"{name.replace('_', ' ')} {show(value)}")
    exemplar = base.inputs.get("exemplar")
    source = [] if exemplar is None else [exemplar.name]
    return f"{find_method(base.method).title}: {varied}", ", ".join([*source, *fixed])
