"""The threshold table T: a law with two knobs, and the user's own cells on top of it."""

from __future__ import annotations

import math
import numbers
import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import NDArray

Cell = tuple[int, str]

MAX_K = 24
MAX_THRESHOLD = 1e6
MAX_CELLS = 4096
_NAME = re.compile(
    r"(luminance|red|green|blue|axis-[123])/(laplacian|residual|(first|second|oriented)-[0-9]{1,3}(\.[0-9]{1,2})?)"
)


@dataclass(frozen=True, slots=True)
class ThresholdTable:
    """The cells of the threshold table that were set by hand; all others follow the law.

    A cell is keyed by k, the place of its level counted from the coarsest (1), and by the name of its feature, so
    that it keeps its meaning at another size and another depth of the pyramid.

    Parameters
    ----------
    cells
        ((k, feature name), threshold) pairs, sorted; 1 <= k <= 24, 0 <= threshold <= 1000000.

    Raises
    ------
    ValueError
        When a cell is out of range, named twice, or there are more than 4096.
    """

    cells: tuple[tuple[Cell, float], ...] = ()
    _lookup: dict[Cell, float] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if len(self.cells) > MAX_CELLS:
            raise ValueError(f"at most {MAX_CELLS} cells, got {len(self.cells)}")
        checked = [_checked(k, name, value) for (k, name), value in self.cells]
        lookup = dict(checked)
        if len(lookup) != len(checked):
            raise ValueError("every cell at most once")
        object.__setattr__(self, "cells", tuple(sorted(checked)))
        object.__setattr__(self, "_lookup", lookup)

    @classmethod
    def from_json(cls, data: object) -> ThresholdTable:
        """Build from ``[[k, "feature", threshold], ...]``; raises ``ValueError`` when it is anything else."""
        if not isinstance(data, list | tuple):
            raise ValueError("a list of [k, feature, threshold]")
        if len(data) > MAX_CELLS:
            raise ValueError(f"at most {MAX_CELLS} cells, got {len(data)}")
        cells = []
        for entry in data:
            if not isinstance(entry, list | tuple) or len(entry) != 3:
                raise ValueError("a list of [k, feature, threshold]")
            k, name, value = entry
            cells.append(_checked(k, name, value))
        return cls(tuple(cells))

    @classmethod
    def example(cls) -> ThresholdTable:
        """Return a table that sets the two coarsest levels of a Laplacian pyramid."""
        return cls(tuple(((k, f"{colour}/laplacian"), 4.0) for k in (1, 2) for colour in ("red", "luminance")))

    def to_json(self) -> list[list[int | str | float]]:
        """Return ``[[k, "feature", threshold], ...]``, coarsest level first."""
        return [[k, name, value] for (k, name), value in self.cells]

    def get(self, k: int, name: str) -> float | None:
        """Return the threshold that was set for a cell, or None where the law holds."""
        return self._lookup.get((k, name))

    def changed(self, values: Mapping[Cell, float]) -> ThresholdTable:
        """Return a table with some cells set."""
        return ThresholdTable(tuple((self._lookup | dict(values)).items()))

    def reset(self, cells: Iterable[Cell] | None = None) -> ThresholdTable:
        """Return a table in which these cells (None: all) follow the law again."""
        if cells is None:
            return ThresholdTable()
        dropped = set(cells)
        return ThresholdTable(tuple(cell for cell in self.cells if cell[0] not in dropped))

    def matrix(self, alpha: float, beta: float, depth: int, names: Sequence[str]) -> NDArray[np.float32]:
        """Return the full table: the law, and these cells on top of it.

        Parameters
        ----------
        alpha, beta
            See :func:`threshold_law`.
        depth
            Number of levels that constrain, N; row k - 1 of the result belongs to level N - k + 1.
        names
            Names of the features, one for each column.

        Returns
        -------
        ndarray
            (depth, len(names)) float32.
        """
        table = np.repeat(threshold_law(alpha, beta, depth)[:, None], len(names), axis=1)
        columns = {name: column for column, name in enumerate(names)}
        for (k, name), value in self.cells:
            if k <= depth and name in columns:
                table[k - 1, columns[name]] = value
        return table


def threshold_law(alpha: float, beta: float, depth: int) -> NDArray[np.float32]:
    """Return T = alpha / k^beta for k = 1 (coarsest) .. depth, (depth,) float32.

    Reference: De Bonet 1997, eq. 13.
    """
    k = np.arange(1, depth + 1, dtype=np.float64)
    return (alpha / k**beta).astype(np.float32)


def _checked(k: object, name: object, value: object) -> tuple[Cell, float]:
    if isinstance(k, bool) or not isinstance(k, numbers.Integral) or not 1 <= int(k) <= MAX_K:
        raise ValueError(f"k must be a whole number from 1 to {MAX_K}, got {_shown(k)}")
    if not isinstance(name, str) or len(name) > 40 or _NAME.fullmatch(name) is None:
        raise ValueError(f"a feature is named like red/first-45 or luminance/laplacian, got {_shown(name)}")
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise ValueError(f"a threshold must be a number from 0 to {MAX_THRESHOLD:.0f}, got {_shown(value)}")
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not 0 <= number <= MAX_THRESHOLD:
        raise ValueError(f"a threshold must be a number from 0 to {MAX_THRESHOLD:.0f}, got {_shown(value)}")
    return (int(k), name), number + 0.0


def _shown(value: object) -> str:
    if isinstance(value, int) and not isinstance(value, bool) and value.bit_length() > 64:
        return "a number of more than 64 bits"
    text = repr(value) if isinstance(value, str | int | float | bool | type(None)) else f"a {type(value).__name__}"
    return text if len(text) <= 40 else text[:37] + "..."
