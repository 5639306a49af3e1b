"""Which cells of a threshold table bind: what each alone excludes, as colours and in words."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from texlab.docks.recent import Recent, Same
from texlab.docks.thresholds.distance_view import Distances
from texlab_core.errors import Cancelled
from texlab_core.methods.de_bonet.binding import binding_steps
from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab.docks.thresholds.table import TableView
    from texlab.state.scene import ColumnScene
    from texlab_core.methods.de_bonet.analysis import Analysis
    from texlab_core.methods.de_bonet.binding import Binding
    from texlab_core.methods.de_bonet.sampling import Sampling

Colouring = Literal["values", "alone", "released"]
COLOURINGS: list[tuple[str, Colouring]] = [
    ("colour: thresholds", "values"),
    ("colour: excludes alone", "alone"),
    ("colour: would add", "released"),
]

_known = Recent(8)


@dataclass(frozen=True, eq=False)
class Answered:
    """The distances of the chosen cell; and which cells bind, where that was asked for and is known."""

    distances: Distances
    cell: tuple[Same, int, int]
    """Model, k and feature that the distances are about."""
    found: Binding | None = None


class _Stale(Exception):  # nothing went wrong
    """A newer result is there: nobody wants to know about this one any more."""


def answer(
    model: Analysis,
    k: int,
    feature: int,
    sampling: Sampling | None,
    newest: Callable[[], Sampling | None],
    should_stop: Callable[[], bool],
) -> Answered:
    """Measure a cell's distances and, for a sampling, which cells bind (in a background thread).

    The latter stops as soon as ``newest`` returns another sampling, and is left out then; raises ``Cancelled``
    when ``should_stop`` says so.
    """
    distances = Distances.of(model, k, feature)
    cell = Same(model), k, feature
    if sampling is None:
        return Answered(distances, cell)

    def look() -> None:
        if should_stop():
            raise Cancelled
        if newest() is not sampling:
            raise _Stale

    try:
        found = _known.get(Same(sampling), lambda: finish(binding_steps(sampling), look))
        return Answered(distances, cell, found)
    except _Stale:
        return Answered(distances, cell)


def of_cells(view: TableView, found: Binding, colouring: Colouring) -> NDArray[np.float64] | None:
    """Return a number for every cell of a view (R, C), the sum over its channels; None when the tables differ.

    ``alone``: the share of its level's exclusions that a cell alone causes; ``released``: how many candidates more
    a typical pixel would have without it.
    """
    numbers = found.released if colouring == "released" else found.alone_shares
    if numbers.shape != (view.axes.depth, len(view.axes.features)):
        return None
    columns = {feature.name: column for column, feature in enumerate(view.axes.features)}
    heads = [[columns[feature.name] for feature in head.features] for head in view.heads]
    return np.stack([numbers[:, each].sum(axis=1) for each in heads], axis=1)


def shading(numbers: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return how strongly cells are coloured, 0 .. 1: by the root, or one cell would hide all others."""
    largest = float(numbers.max(initial=0.0))
    return np.sqrt(numbers / largest) if largest > 0 else np.zeros_like(numbers)


def words(view: TableView, found: Binding, row: int, column: int) -> str:
    """Return what a cell excludes, in words; nothing when the tables differ."""
    alone, released = (of_cells(view, found, which) for which in ("alone", "released"))
    if alone is None or released is None:
        return ""
    return (
        f"alone causes {alone[row, column]:.1%} of the exclusions at this level; without it "
        f"{released[row, column]:.2g} more candidates"
    )


def strictest(view: TableView, found: Binding) -> str:
    """Return which cell costs most candidates, in words."""
    released = of_cells(view, found, "released")
    if released is None:
        return ""
    if released.max(initial=0.0) <= 0:
        return f"No cell alone costs candidates ({found.candidates:.3g} on average)."
    row, column = np.unravel_index(int(released.argmax()), released.shape)
    return (
        f"Strictest: {view.heads[column].title}, k {row + 1}: {released[row, column]:.2g} more candidates without "
        f"it (now {found.candidates:.3g} on average)."
    )


def counts(column: ColumnScene, depth: int) -> tuple[str, ...]:
    """Return how many candidates are left once each level was compared, on median, coarsest level first.

    Empty when the column's result does not tell.
    """
    curve = column.result.curves.get("median-candidates") if column.result is not None else None
    if curve is None:
        return ()
    by_level = dict(zip(np.asarray(curve.x).tolist(), np.asarray(curve.y).tolist(), strict=True))
    # Row k compares level N + 1 - k, whose matches are the parents of the next finer level's candidates.
    found = [by_level.get(float(depth - k)) for k in range(1, depth + 1)]
    if any(value is None for value in found):
        return ()
    return tuple(f"{value:.4g}" for value in found)
