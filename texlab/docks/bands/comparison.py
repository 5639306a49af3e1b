"""The distribution of exemplar and result beside each other. NumPy only, no Qt."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.stats.distances import w1
from texlab_core.stats.moments import Moments, moments

if TYPE_CHECKING:
    from numpy.typing import NDArray

WIDEST = 8.0


@dataclass(frozen=True, eq=False)
class Comparison:
    """Two histograms over the same bins, and the numbers.

    Parameters
    ----------
    title
        What was compared.
    edges
        (bins + 1,) float64.
    exemplar, result
        Shares of all values per unit of the axis, (bins,) float64; ``result`` is None while there is none.
    exemplar_moments, result_moments
        Mean, standard deviation, skewness, kurtosis, range.
    distance
        Wasserstein-1 distance in the values' unit, or None.
    """

    title: str
    edges: NDArray[np.float64]
    exemplar: NDArray[np.float64]
    result: NDArray[np.float64] | None
    exemplar_moments: Moments
    result_moments: Moments | None
    distance: float | None

    @property
    def relative_distance(self) -> float | None:
        """The distance in standard deviations of the exemplar; None when that is 0."""
        if self.distance is None or self.exemplar_moments.sd == 0:
            return None
        return self.distance / self.exemplar_moments.sd


def compare(
    title: str,
    exemplar: NDArray[Any],
    result: NDArray[Any] | None,
    *,
    limits: tuple[float, float] | None = None,
    bins: int = 128,
) -> Comparison:
    """Compare two samples of any shapes and sizes.

    Parameters
    ----------
    title
        For people.
    exemplar, result
        The values.
    limits
        Range of the bins; by default around zero as far as the values go, but at most 8 standard deviations.
    bins
        Their number.
    """
    first = moments(exemplar)
    second = None if result is None else moments(result)
    low, high = limits or _around_zero([each for each in (first, second) if each is not None])
    edges = np.linspace(low, high, bins + 1)
    return Comparison(
        title,
        edges,
        density(exemplar, edges),
        None if result is None else density(result, edges),
        first,
        second,
        None if result is None else w1(exemplar, result),
    )


def density(values: NDArray[Any], edges: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the share of the values in each of the equal bins, per unit; values outside count in the total."""
    bins = edges.size - 1
    low, high = float(edges[0]), float(edges[-1])
    flat = np.asarray(values, np.float32).reshape(-1)
    inside = flat[(flat >= low) & (flat <= high)]
    place = np.minimum(((inside - low) * (bins / (high - low))).astype(np.intp), bins - 1)
    counts = np.bincount(np.maximum(place, 0), minlength=bins)
    return counts / (flat.size * (high - low) / bins)


def _around_zero(found: list[Moments]) -> tuple[float, float]:
    largest = max(max(abs(each.low), abs(each.high)) for each in found)
    widest = WIDEST * max(each.sd for each in found)
    if all(each.low >= 0 for each in found) or all(each.high <= 0 for each in found):
        # One-sided values (a low-pass residual) get the range that they have.
        low, high = min(each.low for each in found), max(each.high for each in found)
        return (low, high) if high > low else (low - 0.5, high + 0.5)
    limit = min(largest, widest) or 1.0
    return -limit, limit
