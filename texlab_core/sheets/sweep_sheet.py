"""The contact sheet of a sweep: every cell with what was varied and what came of it, drawn and written."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.engine.registry import find_method
from texlab_core.engine.sizes import size_text
from texlab_core.errors import ParamError
from texlab_core.sheets.contact_sheet import LARGEST_CELL, Tile, check_sheet, contact_sheet, series_columns
from texlab_core.sheets.figure import Figure, encode_figure, figure_page, is_figure
from texlab_core.sheets.sweep import TEXTURE, heads, show

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from texlab_core.sheets.sweep import Cell, Sweep


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
    tiles = _tiles(sweep, cells)
    across = len(sweep.axes[0].values) if is_grid else columns or series_columns(len(tiles))
    across_heads, row_heads = heads(sweep)
    return contact_sheet(
        tiles,
        across,
        title=sweep_title(sweep),
        column_heads=across_heads,
        row_heads=row_heads,
        largest=largest,
    )


def _tiles(sweep: Sweep, cells: Sequence[Cell]) -> list[Tile]:
    """Return the picture or the reason of every place."""
    finished = {cell.index: cell for cell in cells}
    return [_tile(finished.get(index), len(sweep.axes) == 2) for index in range(len(sweep.jobs))]


def _tile(cell: Cell | None, is_grid: bool) -> Tile:
    if cell is None:
        return Tile(None, message="not run")
    lines = (cell.evidence,) if is_grid else (cell.setting, cell.evidence)
    image = None if cell.result is None else cell.result.image
    return Tile(image, tuple(line for line in lines if line), cell.error)


def write_sheet(
    path: str | os.PathLike[str],
    sweep: Sweep,
    cells: Sequence[Cell],
    *,
    name: str = "sweep",
    note: str = "",
    columns: int | None = None,
    largest: int = LARGEST_CELL,
    look: Figure | None = None,
) -> None:
    """Write the contact sheet, which carries the sweep, so that it can be run again, and the numbers of its cells.

    Parameters
    ----------
    path
        Ends in .png, or in .pdf or .svg for a figure.
    sweep, cells, columns, largest
        As for :func:`sweep_sheet`.
    name, note
        Of the recipe that the sheet carries.
    look
        Of a figure.

    Raises
    ------
    InputError
        When the sheet would be too large, or cannot be written.
    """
    from texlab_core.engine.run import versions
    from texlab_core.files.strict_json import packed
    from texlab_core.files.whole import write_whole
    from texlab_core.images.formats.writing import encode_png
    from texlab_core.sheets.sweep_recipes import TEXT_KEY, SweepRecipe

    across = sheet_columns(sweep, columns)
    recipe = SweepRecipe.of(sweep, name, note, cells).to_json() | {"versions": dict(versions())}
    text = packed(recipe)
    if is_figure(path):
        across_heads, row_heads = heads(sweep)
        page = figure_page(
            _tiles(sweep, cells),
            look or Figure(),
            columns=across,
            title=sweep_title(sweep),
            column_heads=across_heads,
            row_heads=row_heads,
            texts={TEXT_KEY: text},
        )
        write_whole(path, encode_figure(path, page))
        return
    check_sheet(len(sweep.jobs), across, sweep.base.picture_size, largest)
    sheet = sweep_sheet(sweep, cells, columns=across, largest=largest)
    write_whole(path, encode_png(sheet, {TEXT_KEY: text}))


def sheet_columns(sweep: Sweep, wanted: int | None = None) -> int:
    """Return how many cells stand in a row.

    The values of the first of two knobs; in a series as many as wanted, or what suits it.

    Raises
    ------
    ParamError
        When another number is wanted of two knobs.
    """
    if len(sweep.axes) < 2:
        return min(wanted or series_columns(len(sweep.jobs)), len(sweep.jobs))
    own = len(sweep.axes[0].values)
    if wanted not in (None, own):
        raise ParamError("columns", f"{own}, the values of {sweep.axes[0].name}", wanted)
    return own


def sweep_title(sweep: Sweep) -> tuple[str, str]:
    """Return what is varied, and what all cells share, as two lines."""
    names = [axis.name.replace("_", " ") for axis in sweep.axes]
    varied = names[0] if len(names) == 1 else f"{names[0]} across, {names[1]} down"
    base = sweep.base
    fixed = [size_text(base.size)]
    fixed += [] if "seed" in names else [f"seed {base.seed}"]
    defaults = type(base.params)()
    for name, value in base.params.to_json().items():
        if value != defaults.to_json()[name] and name not in {axis.name for axis in sweep.axes}:
            fixed.append(f"{name.replace('_', ' ')} {show(value)}")
    exemplar = base.inputs.get("exemplar")
    source = [] if exemplar is None or TEXTURE in names else [exemplar.name]
    return f"{find_method(base.method).title}: {varied}", ", ".join([*source, *fixed])
