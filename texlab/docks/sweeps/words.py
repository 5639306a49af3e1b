"""What the sweeps dock says, and in which order its cells stand."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from texlab.style.numbers import duration, remaining
from texlab_core.measures.registry import measures
from texlab_core.sheets.sweep import heads, setting_words

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping

    from texlab.state.sweeps import SweepScene
    from texlab_core.sheets.sweep import Cell, Sweep


def status_text(shown: SweepScene) -> str:
    """Return how far a sweep is, in words."""
    total = 0 if shown.sweep is None else len(shown.sweep.jobs)
    failed = sum(each.picture is None for each in shown.cells)
    counts = f"{len(shown.cells)} of {total}{f' · {failed} failed' if failed else ''}"
    if shown.status == "finished":
        return f"{counts} · {duration(shown.seconds)}"
    if shown.status == "stopped":
        return f"{counts} · stopped"
    if shown.running and shown.fraction > 0.05:
        left = shown.seconds * (1 - shown.fraction) / shown.fraction
        return f"{counts} · about {remaining(left)} left"
    return counts


def sortings(cells: Iterable[Cell]) -> list[tuple[str, Any]]:
    """Return (text, measure) for every measure by which these cells can be sorted."""
    known = {id for cell in cells for id in cell.measures}
    return [(f"by {each.title}", each.id) for each in measures().values() if each.id in known]


def arranged(
    total: int, cells: Mapping[int, Cell], by: str | None, kept: Collection[int] | None
) -> list[int] | None:
    """Return the cells that are shown in their order; None for all of them in their places.

    Parameters
    ----------
    total
        Number of cells, finished or not.
    cells
        Those that have finished, by index.
    by
        Id of a measure: the best value comes first, or the largest where none is better; cells without it, last.
    kept
        Only these; None for all.
    """
    if by is None and kept is None:
        return None
    shown = [index for index in range(total) if kept is None or index in kept]
    if by is None:
        return shown
    sign = 1 if measures()[by].better == "lower" else -1
    values = {index: cell.measures[by] for index, cell in cells.items() if by in cell.measures}
    return sorted(shown, key=lambda index: (index not in values, sign * values.get(index, 0.0)))


def headings(sweep: Sweep) -> tuple[list[str], list[str]] | None:
    """Return the headings of columns and rows; None for a series, whose cells have captions."""
    return heads(sweep) if len(sweep.axes) == 2 else None


def setting(sweep: Sweep, index: int) -> str:
    """Return what is varied in a cell, in words."""
    return setting_words(sweep.values(index))
