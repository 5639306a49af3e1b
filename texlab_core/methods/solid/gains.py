"""Gains for the bands of a solid with which none of them moves away from the exemplar's.

A solid has one spectrum, and its bands overlap in it. How strong each band may be follows from the shape of its
histogram; what is looked for is the spectrum nearest to a given one in which all bands are as strong as they may
be, and near what they should be. Nearest in relative entropy it is the given one times the exponential of a sum of
the bands' responses, and finding the sum is a convex problem with as many unknowns as there are bands.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Factors of the standard deviation that are tried, closest to each other about 1.
_FACTORS = np.exp(2 * np.linspace(-1, 1, 121) ** 3)
# How much of its strength a band gives way for a gain of e: inside its limits, and beyond them.
_INSIDE, _BEYOND = 0.3, 0.01
_TURNS = 30
_CLOSE = 1e-4


@dataclass(frozen=True, slots=True, eq=False)
class Reach:
    """How far each band is from the exemplar's, by the factor of its standard deviation.

    Parameters
    ----------
    distances
        (bands, factors) float64: W1 / sd at each of the factors.
    """

    distances: NDArray[np.float64]

    @classmethod
    def of(
        cls, quantiles: NDArray[np.float64], wanted: NDArray[np.float64], spreads: NDArray[np.float64]
    ) -> Reach:
        """Measure from the quantiles of the bands and of the exemplar's, (bands, n), and the spreads (bands,)."""
        from texlab_core.kernels.histograms import scaled_distances

        middle = quantiles.mean(axis=1, keepdims=True)
        rows = zip(quantiles - middle, wanted - middle, strict=True)
        return cls(np.array([scaled_distances(*row, _FACTORS) for row in rows]) / spreads[:, None])

    @property
    def least(self) -> NDArray[np.float64]:
        """(bands,) the smallest distance that a factor alone can give."""
        nearest: NDArray[np.float64] = self.distances.min(axis=1)
        return nearest

    def within(self, limits: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return between which factors of the power each band is nearer than a limit.

        Where none is near enough both are that of the smallest distance.
        """
        low, high = np.empty(len(limits)), np.empty(len(limits))
        for place, (distances, limit) in enumerate(zip(self.distances, limits, strict=True)):
            best = int(distances.argmin())
            left, right = distances[: best + 1], distances[best:]
            if distances[best] >= limit:
                low[place] = high[place] = _FACTORS[best]
                continue
            # The distance is convex in the factor, so it falls to its smallest value and rises again.
            low[place] = np.interp(-limit, -left, _FACTORS[: best + 1])
            high[place] = np.interp(limit, right, _FACTORS[best:])
        return low**2, high**2


def find_gains(
    responses: NDArray[np.float64],
    power: NDArray[np.float64],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    goal: NDArray[np.float64],
    scale: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return the bands' gains, whose responses times gains add up to the logarithm of the power's change.

    Parameters
    ----------
    responses
        (bands, classes) of the power.
    power
        (classes,) as it is.
    low, high
        (bands,) how strong they may be.
    goal
        (bands,) how strong they should be, within these limits.
    scale
        (bands,) unit of a band's power.

    Returns
    -------
    ndarray
        (bands,) float64.
    """
    goal = goal.clip(low, high)
    least, most = (goal - high) / (_INSIDE * scale), (goal - low) / (_INSIDE * scale)
    gains = np.zeros(len(responses))

    def excess(
        gains: NDArray[np.float64],
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        changed = power * np.exp((gains @ responses).clip(-30, 30))
        inside = gains.clip(least, most)
        wanted = goal - scale * (_INSIDE * inside + _BEYOND * (gains - inside))
        slope = scale * np.where((gains > least) & (gains < most), _INSIDE, _BEYOND)
        return changed, responses @ changed - wanted, slope

    changed, over, slope = excess(gains)
    for _ in range(_TURNS):
        size = float(((over / scale) ** 2).sum())
        if np.abs(over / scale).max() < _CLOSE:
            break
        # Newton's step, no longer than a change by e^2 anywhere, and shorter until it helps.
        matrix = (responses * changed) @ responses.T
        matrix[np.diag_indices_from(matrix)] += slope
        step = np.linalg.solve(matrix, -over)
        length = min(1.0, 2.0 / max(float(np.abs(step @ responses).max()), 1e-12))
        best: tuple[float, NDArray[np.float64]] | None = None
        for _ in range(6):
            tried = gains + length * step
            left = float(((excess(tried)[1] / scale) ** 2).sum())
            if best is None or left < best[0]:
                best = (left, tried)
            if left < size:
                break
            length /= 2
        assert best is not None
        gains = best[1]
        changed, over, slope = excess(gains)
    return gains
