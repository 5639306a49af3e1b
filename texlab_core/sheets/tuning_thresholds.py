"""Which thresholds of De Bonet to try: alpha, coarsest side and patches, then rows of the table, then cells."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, cast

from texlab_core.sheets.tuning_moves import ROW_FACTORS, Effect, largest_chance, moves, together
from texlab_core.sheets.tuning_search import SEARCH_SEEDS, Asked, Measured, best_of

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterable, Sequence

    from texlab_core.engine.params import Params
    from texlab_core.engine.streams import Streams
    from texlab_core.methods.de_bonet.params import DeBonetParams
    from texlab_core.methods.de_bonet.thresholds import Cell
    from texlab_core.sheets.tuning_moves import Move
    from texlab_core.sheets.tuning_search import Rounds

    Shape = Callable[[Params], tuple[int, tuple[str, ...]]]

ALPHAS = (0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5)
SIDES = (1, 2, 4, 8, 16)
# What cells are multiplied by.
CELL_FACTORS = (0.25, 4.0)
# With patches the coarsest side matters less: a thinner grid.
FEW_ALPHAS = (0.05, 0.15, 0.3)
# Widths of the patches of the coarsest level, from how many places each is drawn, and alphas that go with them.
PATCHES = (0.25, 0.3, 0.36, 0.39, 0.42, 0.48)
PLACES = (1, 3, 8)
PATCH_ALPHAS = (0.05, 0.15)
FEW_PLACES = 3
# Where the coarsest level comes from: with the same ones and the same seed results differ in few places only.
LAYOUT = ("coarsest", "coarsest_side", "fit_filters", "patch", "places", "fitting", "border", "pyramid")
# Other layouts, by what decides how parts fit.
FITS = ({"border": "smooth"}, {"border": "periodic"}, {"pyramid": "steerable"})
# How many layouts are measured again, with how many seeds, and how far means of two seeds scatter (D, V).
LAYOUTS, MOST_SEEDS = 8, 16
SCATTER = 0.18, 0.015
# Seeds of what has the layout of what it is compared with.
ALIKE_SEEDS = 4
# Combinations of moves that are tried for a layout.
COMBINED = 16
# The search stays by this much below the limit, in D: what looks best is partly lucky.
MARGIN = 0.04
# Rows are gone through again while this helps.
ROW_TURNS = 2

_Shift = tuple[float, float]
# The best of a layout, which D it is to have, and how means of fewer seeds are moved.
_Leader = tuple[Measured, float, _Shift]


def threshold_rounds(start: Measured, shape_of: Shape, limit: float, streams: Streams) -> Rounds:
    """Look at alpha with the coarsest side, at patches, at single moves and combinations, then at rows and cells.

    Parameters
    ----------
    start
        Where to begin, measured, with :class:`~texlab_core.methods.de_bonet.params.DeBonetParams`.
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
    known = [start, *(yield Asked(phase, grid))]
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
        known += yield Asked("patches", patches)
    fits = [changed for each in FITS if (changed := first.replace(**each)) != first]
    known += yield Asked("layouts", fits)
    # Two seeds say little of another layout, and much of other conditions on the same one.
    again = yield Asked("layouts", [start.params, *_other_layouts(known, start, limit)], MOST_SEEDS)
    own = next((each for each in again if each.params == start.params), start)
    # The limit is that of the start with these seeds, where it is the start's.
    allowed = own.kept if limit == start.kept else limit
    others = _surest([each for each in again if each is not own], own, allowed, 1, MOST_SEEDS)
    ends: list[_Leader] = []
    for leader in (own, *others):
        # Of another layout nobody knows well how far it is from the start's.
        unsure = 0.0 if leader is own else SCATTER[0] * math.sqrt(SEARCH_SEEDS / MOST_SEEDS)
        ends.append((yield from _climb(leader, own, shape_of, allowed - MARGIN - unsure)))
    best, goal, shift = max(ends, key=lambda each: each[0].rank(each[1]))
    turn = 0
    while True:
        before = best
        depth, names = shape_of(best.params)
        cells = [(k, name) for k in range(1, depth + 1) for name in names]
        for place in streams("tuning cells", turn).permutation(len(cells)):
            scaled = _scaled(best.params, [cells[int(place)]], CELL_FACTORS, depth, names)
            best = best_of(_shifted((yield Asked("cells", scaled, ALIKE_SEEDS)), shift), goal, best)
        turn += 1
        if best is before:
            return


def _shifted(found: Iterable[Measured], shift: _Shift) -> list[Measured]:
    return [replace(each, kept=each.kept + shift[0], gained=each.gained + shift[1]) for each in found]


def _surest(found: Iterable[Measured], start: Measured, limit: float, count: int, seeds: int) -> list[Measured]:
    """Return those that are surest to have a larger V with D within the limit; means of so many seeds."""
    scatter = SCATTER[0] * math.sqrt(2 / seeds), SCATTER[1] * math.sqrt(2 / seeds)

    def sure(each: Measured) -> tuple[float, float]:
        chance = largest_chance(each.kept, each.gained, limit, start.gained, scatter)
        return round(chance, 1), each.gained

    return sorted((each for each in found if each.usable), key=sure, reverse=True)[:count]


def _other_layouts(known: Sequence[Measured], start: Measured, limit: float) -> list[Params]:
    """Return the best settings of the most promising layouts, one of each."""
    own = layout_of(start.params)
    found: dict[tuple[object, ...], Params] = {}
    for each in _surest(known, start, limit, len(known), SEARCH_SEEDS):
        if (layout := layout_of(each.params)) != own:
            found.setdefault(layout, each.params)
    return list(found.values())[:LAYOUTS]


def _climb(
    leader: Measured, own: Measured, shape_of: Shape, goal: float
) -> Generator[Asked, Sequence[Measured], _Leader]:
    """Try the moves from a setting one by one, then those together that may gain, then rows; return the best.

    ``own`` is the start with as many seeds, ``goal`` the largest D.
    """
    params = cast("DeBonetParams", leader.params)
    single = moves(params, shape_of(params)[0])
    asked = [_moved(params, (each,), shape_of) for each in single]
    found = yield Asked("moves", [params, *asked], ALIKE_SEEDS)
    by_params = {each.params: each for each in found}
    here = by_params.get(params, leader)
    effects = [
        Effect(move, by_params[made].kept - here.kept, by_params[made].gained - here.gained)
        for move, made in zip(single, asked, strict=True)
        if made in by_params
    ]
    offset = leader.kept - own.kept, leader.gained - own.gained
    combined = [_moved(params, each, shape_of) for each in together(effects, offset, goal - own.kept, COMBINED)]
    more = yield Asked("combinations", combined, ALIKE_SEEDS)
    # Fewer seeds do for what shares a layout; their means are moved to those of all seeds.
    shift = leader.kept - here.kept, leader.gained - here.gained
    best = best_of(_shifted([*found, *more], shift), goal, leader)
    for _ in range(ROW_TURNS):
        before = best
        best = yield from _by_rows(best, shape_of, goal, shift)
        if best is before:
            break
    return best, goal, shift


def _moved(params: DeBonetParams, chosen: Iterable[Move], shape_of: Shape) -> Params:
    """Return the parameters with moves made: conditions first, then rows of the table that these give."""
    chosen = tuple(chosen)
    changed = params.replace(**{name: value for each in chosen for name, value in each.changes})
    for each in chosen:
        if each.row:
            depth, names = shape_of(changed)
            cells = [(each.row, name) for name in names]
            (changed,) = _scaled(changed, cells, (each.factor,), depth, names)
    return changed


def layout_of(params: Params) -> tuple[object, ...]:
    """Return what decides where the coarsest level comes from; the same for all parameters of another method."""
    return tuple(getattr(params, name, None) for name in LAYOUT)


def _with_patches(alpha: float, places: int) -> list[dict[str, Any]]:
    """Return what goes with each width of patches: alphas, and the border that makes the sides of patches fit."""
    alphas = sorted({*PATCH_ALPHAS, alpha}) if places == FEW_PLACES else [PATCH_ALPHAS[-1]]
    return [*({"alpha": each} for each in alphas), {"border": "smooth"}]


def _by_rows(
    best: Measured, shape_of: Shape, limit: float, shift: _Shift
) -> Generator[Asked, Sequence[Measured], Measured]:
    """Multiply row after row of the threshold table, and return the best."""
    depth, names = shape_of(best.params)
    for k in range(1, depth + 1):
        row = [(k, name) for name in names]
        scaled = _scaled(best.params, row, ROW_FACTORS, depth, names)
        best = best_of(_shifted((yield Asked("rows", scaled, ALIKE_SEEDS)), shift), limit, best)
    return best


def _sided(params: DeBonetParams, side: int) -> DeBonetParams:
    """Return parameters whose coarsest level is at least ``side`` pixels wide, filters or not."""
    if side == params.coarsest_side:
        return params
    return params.replace(coarsest_side=side, fit_filters=side >= params.filter_size and params.fit_filters)


def _scaled(
    given: Params, cells: Iterable[Cell], factors: Sequence[float], depth: int, names: tuple[str, ...]
) -> list[DeBonetParams]:
    """Return the parameters with some cells of the present table multiplied."""
    params = cast("DeBonetParams", given)
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
