"""Which thresholds of De Bonet to try: alpha, coarsest side and patches, then rows of the table, then cells."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

from texlab_core.sheets.tuning_search import best_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from texlab_core.engine.params import Params
    from texlab_core.engine.streams import Streams
    from texlab_core.methods.de_bonet.method import DeBonetParams
    from texlab_core.methods.de_bonet.thresholds import Cell
    from texlab_core.sheets.tuning_search import Measured, Rounds

ALPHAS = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5)
SIDES = (1, 2, 4, 8, 16)
# What rows, and cells, are multiplied by.
ROW_FACTORS = (0.5, 0.7, 1.4, 2.0)
CELL_FACTORS = (0.25, 4.0)
# Widths of the patches of the coarsest level, and alphas that go with them.
PATCHES = (0.2, 0.25, 0.3, 0.35, 0.4)
PATCH_ALPHAS = (0.05, 0.1, 0.2)
# Alphas between two of the grid.
HALVINGS = 2
# Rows are gone through again while this helps.
ROW_TURNS = 2


def threshold_rounds(
    start: Measured, shape_of: Callable[[Params], tuple[int, tuple[str, ...]]], limit: float, streams: Streams
) -> Rounds:
    """Look at alpha with the coarsest side, then with the patches; halve alpha's steps; vary rows, then cells.

    Parameters
    ----------
    start
        Where to begin, measured, with :class:`~texlab_core.methods.de_bonet.method.DeBonetParams`.
    shape_of
        Number of rows of the table and names of its columns, for parameters that were tried.
    limit
        Of :meth:`~texlab_core.sheets.tuning_search.Measured.rank`.
    streams
        Decide in which order the single cells are taken.
    """
    first = cast("DeBonetParams", start.params)
    phase = "alpha and coarsest side"
    best = start
    grid = [_sided(first, side).replace(alpha=alpha) for side in SIDES for alpha in ALPHAS]
    best = best_of((yield phase, list(grid)), limit, best)
    if first.coarsest == "patches":
        found = cast("DeBonetParams", best.params)
        sided = [first] if found.coarsest_side == first.coarsest_side else [first, found]
        alphas = sorted({*PATCH_ALPHAS, found.alpha})
        patches = [each.replace(patch=width, alpha=a) for each in sided for width in PATCHES for a in alphas]
        best = best_of((yield "patches", list(patches)), limit, best)
    step = ALPHAS[1] - ALPHAS[0]
    for _ in range(HALVINGS):
        step /= 2
        here = cast("DeBonetParams", best.params)
        alphas = [float(f"{max(0.0, here.alpha + side * step):.6g}") for side in (-1, 1)]
        best = best_of((yield phase, [here.replace(alpha=each) for each in alphas]), limit, best)
    for _ in range(ROW_TURNS):
        before = best
        depth, names = shape_of(best.params)
        for k in range(1, depth + 1):
            row = [(k, name) for name in names]
            best = best_of((yield "rows", _scaled(best, row, ROW_FACTORS, depth, names)), limit, best)
        if best is before:
            break
    turn = 0
    while True:
        before = best
        depth, names = shape_of(best.params)
        cells = [(k, name) for k in range(1, depth + 1) for name in names]
        for place in streams("tuning cells", turn).permutation(len(cells)):
            cell = [cells[int(place)]]
            best = best_of((yield "cells", _scaled(best, cell, CELL_FACTORS, depth, names)), limit, best)
        turn += 1
        if best is before:
            return


def _sided(params: DeBonetParams, side: int) -> DeBonetParams:
    """Return parameters whose coarsest level is at least ``side`` pixels wide, filters or not."""
    if side == params.coarsest_side:
        return params
    return params.replace(coarsest_side=side, fit_filters=side >= params.filter_size and params.fit_filters)


def _scaled(
    best: Measured, cells: Iterable[Cell], factors: Sequence[float], depth: int, names: tuple[str, ...]
) -> list[Params]:
    """Return the parameters with some cells of the present table multiplied."""
    params = cast("DeBonetParams", best.params)
    table = params.thresholds.matrix(params.alpha, params.beta, depth, names)
    column = {name: place for place, name in enumerate(names)}
    now = {(k, name): float(table[k - 1, column[name]]) for k, name in cells}
    return [
        params.replace(
            thresholds=params.thresholds.changed(
                {cell: float(f"{value * factor:.6g}") for cell, value in now.items()}
            )
        )
        for factor in factors
    ]
