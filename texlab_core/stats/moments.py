"""Mean, spread and shape of a sample."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Moments:
    """The first four moments of a sample and its range.

    Parameters
    ----------
    mean, sd
        Mean and standard deviation (of the sample itself, divided by n).
    skewness
        Third standardized moment; 0 for a symmetric sample, and for a constant one.
    kurtosis
        Fourth standardized moment; 3 for a normal sample; 0 for a constant one.
    low, high
        Smallest and largest value.
    """

    mean: float
    sd: float
    skewness: float
    kurtosis: float
    low: float
    high: float


def moments(values: NDArray[Any]) -> Moments:
    """Return the moments of all values of an array, computed in float64."""
    flat = np.asarray(values, np.float64).reshape(-1)
    mean, low, high = float(flat.mean()), float(flat.min()), float(flat.max())
    if low == high:
        return Moments(low, 0.0, 0.0, 0.0, low, high)
    centred = flat - mean
    square = centred * centred
    variance = float(square.mean())
    third, fourth = float((square * centred).mean()), float((square * square).mean())
    return Moments(mean, variance**0.5, third / variance**1.5, fourth / variance**2, low, high)
