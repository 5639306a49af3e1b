"""What a threshold table looks like and how it is changed: pure functions of frozen values, no Qt."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from texlab_core.engine.params import describe
from texlab_core.methods.de_bonet.analysis import Analysis
from texlab_core.methods.de_bonet.report import DeBonetDetails
from texlab_core.methods.de_bonet.thresholds import MAX_THRESHOLD, ThresholdTable, threshold_law

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from numpy.typing import ArrayLike, NDArray

    from texlab.state.scene import ColumnScene
    from texlab_core.engine.inputs import Input
    from texlab_core.engine.params import Params
    from texlab_core.methods.de_bonet.features import Feature
    from texlab_core.methods.de_bonet.thresholds import Cell

Arrangement = Literal["each", "together"]

# Below this, moving down ends at 0: no threshold this small lets anything through but copies.
SMALLEST = 1e-4
FIRST = 1e-3
MOST_KNOWN = 12
KINDS = {
    "laplacian": "Laplacian band",
    "first": "first derivative",
    "second": "second derivative",
    "residual": "low-pass residual",
    "oriented": "oriented band",
}
GROUPS = {
    "laplacian": "band",
    "first": "first derivatives",
    "second": "second derivatives",
    "residual": "residual",
    "oriented": "orientations",
}


@dataclass(frozen=True)
class SoftLog:
    """A logarithmic scale that has a zero: log(1 + value / knee), 0 .. 1 for values 0 .. ``high``."""

    knee: float
    high: float

    def place(self, values: ArrayLike) -> NDArray[np.float64]:
        """Return where values lie; those above ``high`` at 1."""
        shares = np.log1p(np.asarray(values, np.float64) / self.knee) / math.log1p(self.high / self.knee)
        return np.clip(shares, 0.0, 1.0)

    def value(self, place: float) -> float:
        """Return the value at a place."""
        return self.knee * math.expm1(min(max(place, 0.0), 1.0) * math.log1p(self.high / self.knee))


@dataclass(frozen=True, eq=False)
class Axes:
    """Rows and columns of a table.

    Parameters
    ----------
    features
        In the order of the analysis.
    sizes
        (height, width) of the levels k = 1 (coarsest) .. N.
    model
        The analysis that they are from.
    """

    features: tuple[Feature, ...]
    sizes: tuple[tuple[int, int], ...]
    model: Analysis

    @classmethod
    def of(cls, model: Analysis) -> Axes:
        """Return the axes of an analysis."""
        sizes = tuple(model.grid.shape(model.level_of(k)) for k in range(1, model.depth + 1))
        return cls(model.features, sizes, model)

    @property
    def depth(self) -> int:
        """Number of rows."""
        return len(self.sizes)

    @property
    def channels(self) -> tuple[str, ...]:
        """Channels that have features, in order."""
        return tuple(dict.fromkeys(feature.channel for feature in self.features))

    def level(self, k: int) -> int:
        """Return the level of row k; 0 is the finest."""
        return self.depth + 1 - k


# What an analysis depends on: the hash of its exemplar, and the parameters that matter to it.
Origin = tuple[str, tuple[tuple[str, object], ...]]


def origin_of(exemplar: Input, params: Params) -> Origin:
    """Return what the analysis of this exemplar with these parameters depends on."""
    return exemplar.sha256, params.analysis_key()


class KnownAxes:
    """The axes of every column, while they are those of its exemplar and parameters."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[Axes, Origin]] = {}

    def of(self, column: ColumnScene, exemplar: Input | None = None) -> Axes | None:
        """Return the axes of a column: its result's; without one, those that are known for the same analysis.

        Parameters
        ----------
        column
            The column.
        exemplar
            What the next result will be made from; None takes the one that the known axes are of.
        """
        known = self._known.get(column.id)
        result = column.result
        if result is None:
            if known is None:
                return None
            axes, (pixels, _) = known
            wanted = (pixels if exemplar is None else exemplar.sha256), column.params.analysis_key()
            return axes if known[1] == wanted else None
        details = result.details
        # A tile may have fewer levels than the exemplar's own pyramid.
        model: object = details.sampling.analysis if isinstance(details, DeBonetDetails) else result.model
        if isinstance(model, Analysis) and (known is None or known[0].model is not model):
            self.learn(column.id, Axes.of(model), origin_of(result.job.inputs["exemplar"], result.job.params))
        found = self._known.get(column.id)
        return None if found is None else found[0]

    def learn(self, column_id: int, axes: Axes, origin: Origin) -> None:
        """Remember the axes of an analysis."""
        self._known[column_id] = axes, origin
        while len(self._known) > MOST_KNOWN:
            del self._known[next(iter(self._known))]


@dataclass(frozen=True)
class Head:
    """A column of the editor: the features that it edits, all of one kind and angle.

    Parameters
    ----------
    features
        One, or that of every channel.
    group
        Under which heading it stands.
    """

    features: tuple[Feature, ...]
    group: str

    @property
    def first(self) -> Feature:
        """The feature that stands for all."""
        return self.features[0]

    @property
    def title(self) -> str:
        """What it is, in words: ``red, first derivative 45°``."""
        what = KINDS[self.first.kind] + (f" {self.first.angle:g}°" if self.first.directed else "")
        return f"{self.first.channel}, {what}" if len(self.features) == 1 else what


@lru_cache(maxsize=32)
def make_heads(features: tuple[Feature, ...], arrangement: Arrangement) -> tuple[Head, ...]:
    """Return the columns: channel by channel, or one for all channels together."""
    channels = list(dict.fromkeys(feature.channel for feature in features))
    if arrangement == "each" and len(channels) > 1:
        ordered = sorted(features, key=lambda feature: channels.index(feature.channel))
        return tuple(Head((feature,), feature.channel) for feature in ordered)
    kinds: dict[tuple[str, float], list[Feature]] = {}
    for feature in features:
        kinds.setdefault((feature.kind, feature.angle), []).append(feature)
    return tuple(Head(tuple(found), GROUPS[kind]) for (kind, _), found in kinds.items())


@dataclass(frozen=True, eq=False)
class TableView:
    """A table as it is shown.

    Parameters
    ----------
    axes, heads
        Rows and columns.
    table
        The cells that were set by hand.
    values
        (N, columns) float64, the law where no cell is set; of the first feature where channels are together.
    changed, mixed
        (N, columns) bool: set by hand; the channels differ.
    """

    axes: Axes
    heads: tuple[Head, ...]
    table: ThresholdTable
    law: NDArray[np.float32]
    values: NDArray[np.float64]
    changed: NDArray[np.bool_]
    mixed: NDArray[np.bool_]

    def looks_like(self, other: TableView) -> bool:
        """Whether another view shows the same."""
        return (
            self.heads == other.heads
            and self.axes.sizes == other.axes.sizes
            and np.array_equal(self.values, other.values)
            and np.array_equal(self.changed, other.changed)
            and np.array_equal(self.mixed, other.mixed)
        )

    def cells(self, row: int, column: int) -> list[Cell]:
        """Return the cells of the table under a cell of the view."""
        return [(row + 1, feature.name) for feature in self.heads[column].features]

    def value(self, cell: Cell) -> float:
        """Return the threshold of a cell of the table."""
        found = self.table.get(*cell)
        return float(self.law[cell[0] - 1]) if found is None else found

    def describe(self, row: int, column: int) -> str:
        """Return what a cell is and holds, in words."""
        k = row + 1
        height, width = self.axes.sizes[row]
        place = f"{self.heads[column].title}, k = {k} (level {self.axes.level(k)}, {width} × {height})"
        law = f"{float(self.law[row]):.4g}"
        if self.mixed[row, column]:
            return f"{place}: the channels differ; the law says {law}"
        value = f"{self.values[row, column]:.4g}"
        rest = f"set by hand, the law says {law}" if self.changed[row, column] else "follows the law"
        return f"{place}: {value}, {rest}"


def make_view(axes: Axes, arrangement: Arrangement, table: ThresholdTable, law: tuple[float, float]) -> TableView:
    """Return a table as it is shown; ``law`` is alpha and beta."""
    return _fill(axes, make_heads(axes.features, arrangement), table, threshold_law(*law, axes.depth))


def _fill(
    axes: Axes, heads: tuple[Head, ...], table: ThresholdTable, law_values: NDArray[np.float32]
) -> TableView:
    shape = (axes.depth, len(heads))
    values = np.repeat(law_values[:, None].astype(np.float64), shape[1], axis=1)
    changed, mixed = np.zeros(shape, bool), np.zeros(shape, bool)
    # A view is made for every event of a drag, and hardly ever is a cell set by hand.
    features = ((each.name, place) for place, head in enumerate(heads) for each in head.features)
    columns = dict(features) if table.cells else {}
    cells = [cell for cell, _ in table.cells if cell[0] <= axes.depth and cell[1] in columns]
    for row, column in {(k - 1, columns[name]) for k, name in cells}:
        found = [table.get(row + 1, feature.name) for feature in heads[column].features]
        numbers = [float(law_values[row]) if value is None else value for value in found]
        values[row, column] = numbers[0]
        changed[row, column] = True
        mixed[row, column] = max(numbers) > min(numbers)
    return TableView(axes, heads, table, law_values, values, changed, mixed)


def replaced(view: TableView, table: ThresholdTable) -> TableView:
    """Return the same view of another table."""
    return _fill(view.axes, view.heads, table, view.law)


def table_field(params: Params) -> str | None:
    """Return the name of the parameter that is a threshold table, or None."""
    return next((field.name for field in describe(type(params)) if field.type is ThresholdTable), None)


def law_of(params: Any) -> tuple[float, float]:
    """Return alpha and beta of T = alpha / k^beta; without them every threshold that is not set is 0."""
    return float(getattr(params, "alpha", 0.0)), float(getattr(params, "beta", 0.0))


def moved(value: float, by: float) -> float:
    """Return a threshold multiplied by e^by; small ones fall to zero, and zero is left upwards."""
    if value > 0:
        return rounded(value * math.exp(by))
    return rounded(FIRST * math.exp(by)) if by > 0 else 0.0


def rounded(value: float) -> float:
    """Return a threshold with three digits that matter, within its range."""
    value = min(max(value, 0.0), MAX_THRESHOLD)
    return 0.0 if value < SMALLEST else float(f"{value:.3g}")


def changed(table: ThresholdTable, values: Mapping[Cell, float], locked: Iterable[Cell]) -> ThresholdTable:
    """Return a table with some cells set, without those that are locked."""
    kept = set(locked)
    return table.changed({cell: value for cell, value in values.items() if cell not in kept})


def reset(table: ThresholdTable, cells: Iterable[Cell], locked: Iterable[Cell]) -> ThresholdTable:
    """Return a table in which cells follow the law again, but for those that are locked."""
    return table.reset(set(cells) - set(locked))


def mirrored(view: TableView, cells: Iterable[Cell]) -> dict[Cell, float]:
    """Return what cells give to those of the mirrored orientation, theta -> 180 - theta.

    Where both a cell and its mirror image are given, the one below 90 degrees is copied.
    """
    features = {feature.name: feature for feature in view.axes.features}
    given = set(cells)
    made = {}
    for k, name in given:
        feature = features[name]
        other = feature.mirrored()
        target = (k, other.name)
        if other.name in features and other != feature and (target not in given or feature.angle < 90):
            made[target] = view.value((k, name))
    return made


def runs(view: TableView, locked: frozenset[Cell]) -> list[list[tuple[int, int]]]:
    """Return, for every row, first and last column of neighbouring cells of a group that hold the same.

    Cells that were set by hand, differ between channels or are locked stand alone.
    """
    found = []
    for row in range(view.values.shape[0]):
        parts: list[tuple[int, int]] = []
        before: object = None
        for column, head in enumerate(view.heads):
            alone = view.changed[row, column] or view.mixed[row, column]
            alone = alone or (bool(locked) and all(cell in locked for cell in view.cells(row, column)))
            here = None if alone else (head.group, float(view.values[row, column]))
            if here is not None and here == before:
                parts[-1] = parts[-1][0], column
            else:
                parts.append((column, column))
            before = here
        found.append(parts)
    return found


def cell_texts(value: float) -> tuple[str, ...]:
    """Return the ways in which a threshold can be written in a cell, the fullest first."""
    ways = []
    for digits in (3, 2, 1):
        full = cell_text(value, digits)
        ways += [full, full.replace("0.", ".", 1)] if full.startswith("0.") else [full]
    return tuple(dict.fromkeys(ways))


def cell_text(value: float, digits: int = 3) -> str:
    """Return a threshold as it is written in a cell: scientific only when it must be."""
    if value == 0:
        return "0"
    if 1e-3 <= value < 9999.5:
        return f"{value:.{digits}g}" if value < 10**digits - 0.5 else f"{value:.0f}"
    mantissa, exponent = f"{value:.{max(digits - 2, 0)}e}".split("e")
    return f"{mantissa.removesuffix('.0')}e{int(exponent)}"
