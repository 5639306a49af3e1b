"""Point patterns on a plane and in its picture, and whether they look like a Poisson process.

The picture is the unit square [0, 1]², points are (n, 2) float64, x first. The plane's coordinates are those of
:mod:`texlab_core.shape.orientation` about the middle of the picture: a point X is seen at A X.

Reference: Forsyth and Ponce, section 11.4.1, homogeneity assumptions, and exercise 3.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.errors import ParamError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.shape.orientation import Orientation

    Floats = NDArray[np.float64]

MOST_POINTS = 1_000_000
_CENTRE = 0.5


def check_count(count: int, low: int = 1) -> None:
    """Refuse numbers of points that cannot be used; raises ``ParamError``."""
    if not low <= count <= MOST_POINTS:
        raise ParamError("points", f"a whole number from {low} to {MOST_POINTS}", count)


def poisson(expected: float, orientation: Orientation, rng: np.random.Generator) -> Floats:
    """Return the picture of a homogeneous Poisson process on a slanted plane, seen orthographically.

    Parameters
    ----------
    expected
        Points in the picture on average, above 0.
    orientation
        Of the plane.
    rng
        Source of randomness.
    """
    check_count(round(expected))
    # The part of the plane that can be seen lies within this square about the middle.
    reach = math.sqrt(0.5) / orientation.cosine
    density = expected * orientation.cosine
    number = rng.poisson(density * (2 * reach) ** 2)
    plane = rng.uniform(-reach, reach, (number, 2))
    return inside(plane @ orientation.foreshortening() + _CENTRE)


def regular(count: int, rng: np.random.Generator, *, jitter: float = 0.2) -> Floats:
    """Return about ``count`` points of a square lattice, each shaken by up to ``jitter`` of its step."""
    check_count(count)
    side = max(1, round(math.sqrt(count)))
    lattice = (np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2) + 0.5) / side
    return np.clip(lattice + rng.uniform(-jitter, jitter, lattice.shape) / side, 0, 1 - 1e-12)


def inside(points: Floats) -> Floats:
    """Return those points that lie in the picture."""
    kept: Floats = points[((points >= 0) & (points < 1)).all(axis=1)]
    return kept


def back_projected(points: Floats, orientation: Orientation) -> Floats:
    """Return the places on the plane, about the middle, of points of the picture."""
    plane: Floats = (points - _CENTRE) @ np.linalg.inv(orientation.foreshortening())
    return plane


@dataclass(frozen=True, slots=True, eq=False)
class Counts:
    """How many points fall into each of several sets, and how even that is.

    Parameters
    ----------
    counts
        (n,) int64.
    shares
        (n,) float64: of the sets' whole area, 0 .. 1. For a homogeneous Poisson process the counts are multinomial
        with these probabilities.
    """

    counts: NDArray[np.int64]
    shares: Floats

    @property
    def expected(self) -> Floats:
        """Counts in proportion to the areas."""
        return self.shares * float(self.counts.sum())

    @property
    def chi_square(self) -> float:
        """Pearson's statistic of the counts against the areas."""
        expected = self.expected
        safe = np.where(expected > 0, expected, 1)
        return float((np.square(self.counts - expected) / safe).sum())

    @property
    def p_value(self) -> float:
        """Probability of counts at least as uneven: below .05 clustered or uneven, above .95 too regular."""
        from scipy.stats import chi2

        return float(chi2.sf(self.chi_square, max(1, self.counts.size - 1)))

    @property
    def verdict(self) -> str:
        """What the test says, in words."""
        if self.p_value < 0.05:
            return "more uneven than a homogeneous Poisson process"
        return "more even than a Poisson process" if self.p_value > 0.95 else "as a homogeneous Poisson process"


def count_in_sets(points: Floats, columns: int, rows: int | None = None) -> Counts:
    """Count points in equal rectangles that cover the picture (exercise 3: disjoint sets).

    Parameters
    ----------
    points
        (n, 2) in [0, 1)².
    columns, rows
        1 to 64 sets along each side; as many rows as columns where nothing is said.

    Raises
    ------
    ParamError
        When there are fewer than two sets or more than 64 a side.
    """
    rows = columns if rows is None else rows
    for name, number in (("columns", columns), ("rows", rows)):
        if not 1 <= number <= 64:
            raise ParamError(name, "a whole number from 1 to 64", number)
    if columns * rows < 2:
        raise ParamError("columns", "such that there are at least two sets", columns)
    index = (points[:, 1] * rows).astype(np.intp) * columns + (points[:, 0] * columns).astype(np.intp)
    sets = rows * columns
    return Counts(np.bincount(index, minlength=sets).astype(np.int64), np.full(sets, 1 / sets))
