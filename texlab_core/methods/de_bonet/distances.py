"""Distances between the exemplar's own features: what a threshold lets through."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.methods.de_bonet.analysis import Analysis

_PAIRS = 2**17


def feature_distances(analysis: Analysis, k: int, feature: int) -> NDArray[np.float32]:
    """Return D of eq. 10 between pairs of exemplar locations, for one cell of the threshold table.

    Parameters
    ----------
    analysis
        The model of a De Bonet result.
    k
        Row of the threshold table: 1 is the coarsest level.
    feature
        Column of the threshold table.

    Returns
    -------
    ndarray
        (n,) float32, sorted: all pairs of different locations, or about 130,000 evenly spread ones.
    """
    values = analysis.levels[analysis.level_of(k)].features[:, feature]
    shifts = np.arange(1, values.size)
    if values.size * shifts.size > _PAIRS:
        # Evenly spread shifts pair every location equally often, near ones and far ones.
        shifts = np.unique(np.linspace(1, values.size - 1, max(1, _PAIRS // values.size)).astype(np.int64))
    differences = values[None, :] - values[(np.arange(values.size) + shifts[:, None]) % values.size]
    distances: NDArray[np.float32] = (differences * differences).ravel()
    distances.sort()
    return distances


def passing_share(distances: NDArray[np.float32], threshold: float) -> float:
    """Return the share of sorted distances that a threshold lets through, 0 .. 1."""
    if distances.size == 0:
        return 1.0
    return float(np.searchsorted(distances, np.float32(threshold), side="right")) / distances.size
