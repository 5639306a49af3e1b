"""What is plotted: runs, sweeps and trials as points of any two measures; plain decisions without widgets."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from texlab_core.engine.params import describe
from texlab_core.engine.registry import find_method
from texlab_core.measures.limits import LIMITS
from texlab_core.measures.registry import find_measure, measures, written
from texlab_core.sheets.sweep import show

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from texlab.state.scene import Scene
    from texlab.state.sweeps import ShownCell, SweepScene
    from texlab_core.engine.params import Params
    from texlab_core.sheets.sweep import Cell

D, V = "discriminability", "visual-difference"
SEARCH, SWEEP = "search", "sweep"
# How near the pointer must be, in pixels.
REACH = 12.0
# Parameters named in one line.
MOST_NAMED = 6


@dataclass(frozen=True, eq=False)
class Group:
    """Points of one kind.

    Parameters
    ----------
    title
        The method's, "sweep", or "search".
    cells
        Runs with numbers, on the present exemplar.
    curves
        Runs of places in ``cells`` that are joined by a line.
    """

    title: str
    cells: tuple[ShownCell, ...]
    curves: tuple[tuple[int, ...], ...] = ()


@dataclass(frozen=True, eq=False)
class Placed:
    """A point at its place."""

    x: float
    y: float
    shown: ShownCell


def groups_of(scene: Scene) -> tuple[Group, ...]:
    """Return what is to be plotted: the search below, then the sweep, the columns' runs by method on top."""
    if scene.exemplar is None:
        return ()
    sha256 = scene.exemplar.sha256

    def usable(shown: ShownCell) -> bool:
        exemplar = shown.cell.job.inputs.get("exemplar")
        return bool(shown.cell.measures) and exemplar is not None and exemplar.sha256 == sha256

    found: list[Group] = []
    trials = tuple(filter(usable, scene.tuning.cells))
    if trials:
        found.append(Group(SEARCH, trials))
    cells = tuple(sorted(filter(usable, scene.sweep.cells), key=lambda each: each.cell.index))
    if cells:
        found.append(Group(SWEEP, cells, _curves(scene.sweep, cells)))
    by_method: dict[str, list[ShownCell]] = {}
    for each in filter(usable, scene.points):
        by_method.setdefault(find_method(each.cell.job.method).title, []).append(each)
    return (*found, *(Group(title, tuple(cells)) for title, cells in by_method.items()))


def _curves(scene: SweepScene, cells: Sequence[ShownCell]) -> tuple[tuple[int, ...], ...]:
    """Join the cells of every row of a sweep; seeds and choices are in no order, and stay points."""
    sweep = scene.sweep
    if sweep is None:
        return ()
    across = sweep.axes[0]
    if across.name == "seed" or not all(type(value) in (int, float) for value in across.values):
        return ()
    rows: dict[int, list[int]] = {}
    for place, each in enumerate(cells):
        rows.setdefault(each.cell.index // len(across.values), []).append(place)
    return tuple(tuple(row) for row in rows.values() if len(row) > 1)


def placed(cells: Iterable[ShownCell], x: str, y: str) -> list[Placed | None]:
    """Return the points at two measures, None where one of them is missing."""
    found: list[Placed | None] = []
    for each in cells:
        across, up = (each.cell.measures.get(name, math.nan) for name in (x, y))
        usable = math.isfinite(across) and math.isfinite(up)
        found.append(Placed(across, up, each) if usable else None)
    return found


def axes_of(groups: Iterable[Group]) -> list[tuple[str, str]]:
    """Return title and id of every registered measure that a point has, D and V always, in their order."""
    there = {D, V}.union(*(each.cell.measures for group in groups for each in group.cells))
    return [(each.title, each.id) for each in measures().values() if each.id in there]


def nearest(points: Iterable[Placed], x: float, y: float, pixel: tuple[float, float]) -> Placed | None:
    """Return the point under the pointer.

    Parameters
    ----------
    points
        Later ones lie on top.
    x, y
        Where the pointer is.
    pixel
        Width and height of a pixel in units of the axes.
    """
    best, least = None, REACH
    for each in points:
        away = math.hypot((each.x - x) / pixel[0], (each.y - y) / pixel[1])
        if away <= least:
            best, least = each, away
    return best


def zone_lines(measure: str) -> tuple[tuple[float, str], ...]:
    """Return where good ends and bad begins, with the words beside the lines; nothing for other measures."""
    limit = LIMITS.get(measure)
    if limit is None:
        return ()
    if limit.good == limit.bad:
        return ((limit.good, "good | bad"),)
    return ((limit.good, "good"), (limit.bad, "bad"))


def settings(params: Params) -> str:
    """Return the parameters that are not the method's defaults, in words."""
    named = []
    for each in describe(type(params)):
        value = getattr(params, each.name)
        if value != each.default:
            cells = getattr(value, "cells", None)
            if cells is None:
                named.append(f"{each.label} {show(value)}")
            else:
                named.append(f"{len(cells)} cell{'' if len(cells) == 1 else 's'} set")
    more = f" and {len(named) - MOST_NAMED} more" if len(named) > MOST_NAMED else ""
    return ", ".join(named[:MOST_NAMED]) + more or "the defaults"


def describe_cell(cell: Cell, x: str, y: str) -> str:
    """Return what is known of a point: method, numbers, parameters, seed."""
    numbers = ", ".join(written(cell.measures, dict.fromkeys((x, y, D, V))))
    return f"{find_method(cell.job.method).title}: {numbers}; {settings(cell.job.params)}; seed {cell.job.seed}"


def limit_choices(own: float | None) -> list[tuple[str, float | str]]:
    """Return the limits that are offered, with their words."""
    text = find_measure(D).text
    choices: list[tuple[str, float | str]] = [
        (f"D at most {text(-3.1)}", -3.1),
        (f"D at most {text(-3.4)}", -3.4),
        ("D as it is now", "start"),
    ]
    if own is not None:
        choices.append((f"D of the exemplar's own: {text(own)}", own))
    return choices


def knob_choices(method: str) -> list[tuple[str, tuple[str, ...]]]:
    """Return what can be tuned of a method, with its words; De Bonet's thresholds first."""
    from texlab_core.methods.de_bonet.params import DeBonetParams

    params = find_method(method).params
    numbers = [each for each in describe(params) if each.kind in ("int", "float")]
    choices: list[tuple[str, tuple[str, ...]]] = []
    if issubclass(params, DeBonetParams):
        choices.append(("thresholds", ()))
    if len(numbers) > 1:
        choices.append((f"{numbers[0].label} and {numbers[1].label}", (numbers[0].name, numbers[1].name)))
    return choices + [(each.label, (each.name,)) for each in numbers]
