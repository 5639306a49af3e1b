"""Which thresholds of De Bonet to try: alpha, coarsest side and patches, then rows of the table, then cells."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from texlab_core.sheets.tuning_search import best_of

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable, Mapping, Sequence

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
# With patches the coarsest side matters less: a thinner grid.
FEW_ALPHAS = (0.05, 0.15, 0.3)
# Widths of the patches of the coarsest level, from how many places each is drawn, and alphas that go with them.
PATCHES = (0.25, 0.3, 0.36, 0.39, 0.42, 0.48)
PLACES = (1, 3, 8)
PATCH_ALPHAS = (0.05, 0.15)
FEW_PLACES = 3
# What may make the conditions fit this exemplar better, whatever the layout is.
CONDITIONS: tuple[Mapping[str, Any], ...] = (
    {"beta": 0.5},
    {"beta": 1.0},
    {"border": "smooth"},
    {"border": "periodic"},
    {"channels": "scaled"},
    {"channels": "principal"},
    {"orientations": 2},
    {"orientations": 8},
    {"filters": "first"},
    {"filters": "second"},
    {"pyramid": "steerable"},
)
# Where some conditions make D smaller by this much, smaller patches may turn that into a larger V.
GAINED_D = 0.05
TRADED_PATCHES = (0.36, 0.39, 0.42)
# Alphas are multiplied by these as well.
ALPHA_FACTORS = (0.5, 1.7, 2.7)
# Where the coarsest level comes from: with the same ones and the same seed results differ in few places only.
LAYOUT = ("coarsest", "coarsest_side", "fit_filters", "patch", "places", "fitting")
# Alphas between two of the grid.
HALVINGS = 2
# Rows are gone through again while this helps.
ROW_TURNS = 2


def threshold_rounds(
    start: Measured, shape_of: Callable[[Params], tuple[int, tuple[str, ...]]], limit: float, streams: Streams
) -> Rounds:
    """Look at alpha with the coarsest side, at patches, conditions and finer alphas; vary rows, then cells.

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
    patched = first.coarsest == "patches"
    alphas: Sequence[float] = FEW_ALPHAS if patched else ALPHAS
    grid = [_sided(first, side).replace(alpha=alpha) for side in SIDES for alpha in alphas]
    known = [start, *(yield phase, list(grid))]
    best = best_of(known, limit, start)
    if patched:
        found = cast("DeBonetParams", best.params)
        sided = [first] if found.coarsest_side == first.coarsest_side else [first, found]
        patches = [
            each.replace(patch=width, places=places, **changes)
            for each in sided
            for width in PATCHES
            for places in PLACES
            for changes in _with_patches(found.alpha, places)
        ]
        known += yield "patches", list(patches)
        best = best_of(known, limit, best)
    # Two seeds say little of another layout, and much of other conditions on the same one.
    own = best_of([each for each in known if _layout(each.params) == _layout(first)], limit, start)
    leaders = list(dict.fromkeys([start.params, own.params, best.params]))
    conditions = [each for leader in leaders for each in _conditions(cast("DeBonetParams", leader))]
    found_there = yield "conditions", list(conditions)
    known += found_there
    nearest = min((each for each in found_there if each.usable), key=lambda each: each.kept, default=start)
    if patched and nearest.kept < start.kept - GAINED_D:
        strict = cast("DeBonetParams", nearest.params)
        traded = [strict.replace(patch=width, places=places) for width in TRADED_PATCHES for places in PLACES]
        known += yield "patches", list(traded)
    own = best_of([each for each in known if _layout(each.params) == _layout(first)], limit, own)
    best = best_of(known, limit, best)
    step = ALPHAS[1] - ALPHAS[0]
    for _ in range(HALVINGS):
        step /= 2
        here = cast("DeBonetParams", best.params)
        alphas = [float(f"{max(0.0, here.alpha + side * step):.6g}") for side in (-1, 1)]
        best = best_of((yield phase, [here.replace(alpha=each) for each in alphas]), limit, best)
    if own is not best:
        own = yield from _by_rows(own, shape_of, limit)
        best = best_of([own], limit, best)
    for _ in range(ROW_TURNS):
        before = best
        best = yield from _by_rows(best, shape_of, limit)
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


def _layout(params: Params) -> tuple[object, ...]:
    return tuple(getattr(params, name) for name in LAYOUT)


def _with_patches(alpha: float, places: int) -> list[dict[str, Any]]:
    """Return what goes with each width of patches: alphas, and the border that makes the sides of patches fit."""
    alphas = sorted({*PATCH_ALPHAS, alpha}) if places == FEW_PLACES else [PATCH_ALPHAS[-1]]
    return [*({"alpha": each} for each in alphas), {"border": "smooth"}]


def _conditions(params: DeBonetParams) -> list[DeBonetParams]:
    """Return the parameters with other conditions, one at a time."""
    alphas = [float(f"{min(params.alpha * factor, ALPHAS[-1]):.3g}") for factor in ALPHA_FACTORS]
    changed = [params.replace(**changes) for changes in CONDITIONS]
    return [each for each in (*changed, *(params.replace(alpha=a) for a in alphas)) if each != params]


def _by_rows(
    best: Measured, shape_of: Callable[[Params], tuple[int, tuple[str, ...]]], limit: float
) -> Generator[tuple[str, list[Params]], Sequence[Measured], Measured]:
    """Multiply row after row of the threshold table, and return the best."""
    depth, names = shape_of(best.params)
    for k in range(1, depth + 1):
        row = [(k, name) for name in names]
        best = best_of((yield "rows", _scaled(best, row, ROW_FACTORS, depth, names)), limit, best)
    return best


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
