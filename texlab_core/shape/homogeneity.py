"""What homogeneity says about a plane's orientation: nothing under orthography, and what does work.

An orthographic view of a plane is an affine map: it multiplies every area by the same cosine, wherever it lies and
however it is shaped. A homogeneous Poisson process seen so is one again, with another density, and no count in any
set of the picture depends on slant or tilt. (Section 11.4.1 says so first, and argues with long rectangles along
and across the tilt afterwards; those hold equally many points.) Four experiments show it:

1. :func:`uniformity` of the back-projected points over all hypotheses is flat.
2. With quadrats that reach beyond the picture, slant 0 always looks best: an artefact of the border.
3. Marks with a shape do tell: their mean shape is a circle on the plane (:func:`orientation_of_marks`).
4. Perspective does tell: the density varies over the picture (:func:`orientation_of_density`).

Reference: Forsyth and Ponce, section 11.4.1, homogeneity assumptions; Gårding 1992 (marks); Aloimonos 1986 and
Blake and Marinos 1990 (density).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.errors import InputError, ParamError
from texlab_core.shape.orientation import MOST_SLANT, Orientation, of_tensor
from texlab_core.shape.points import back_projected, check_count
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# Points that a quadrat holds on average.
PER_QUADRAT = 8.0
# Half the picture's side at distance 1: a field of view of 53 degrees.
HALF_SIDE = 0.5
# The horizon is kept so far from the picture: the nearest corner has at least this depth.
_LEAST_DEPTH = 0.05
_QUADRATURE = 24


def count_ratio(points: Floats, tilt: float, *, length: float = 0.66, width: float = 0.22) -> tuple[int, int]:
    """Return the points in a rectangle of the picture that is long along the tilt, and in one long across it.

    Both are congruent and have the picture's middle for theirs; the chapter argues that the first holds more.
    """
    if not 0 < math.hypot(length, width) <= 1 or width <= 0:
        raise ParamError("length", "such that the rectangle fits the picture however it is turned", length)
    angle = math.radians(tilt)
    centred = points - 0.5
    along = np.abs(centred @ np.array([math.cos(angle), math.sin(angle)]))
    across = np.abs(centred @ np.array([-math.sin(angle), math.cos(angle)]))
    first = (along <= length / 2) & (across <= width / 2)
    second = (along <= width / 2) & (across <= length / 2)
    return int(first.sum()), int(second.sum())


def uniformity(points: Floats, orientation: Orientation, *, at_border: bool = False) -> float:
    """Return how uneven the points are once they are projected back onto a hypothesis: 0 (even) to 1 (uneven).

    Parameters
    ----------
    points
        (n, 2) in the picture.
    orientation
        The hypothesis.
    at_border
        Also count in quadrats that reach beyond the picture, which makes frontal planes look best.

    Returns
    -------
    float
        Probability that a Poisson process would be more even: uniform between 0 and 1 for one, whatever the
        hypothesis.
    """
    from scipy.stats import chi2

    plane = back_projected(points, orientation)
    # Square quadrats of the plane along and across the tilt; all hypotheses have equally full ones.
    angle = math.radians(orientation.tilt) if orientation.slant else 0.0
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    # Frontally they divide the picture evenly, as anybody would divide it.
    across = max(1, round(math.sqrt(len(points) / PER_QUADRAT)))
    side = 1 / across / math.sqrt(orientation.cosine)
    half = math.ceil(math.sqrt(0.5) / orientation.cosine / side) + 1 + (across % 2) / 2
    number = round(2 * half)
    cell = np.floor(plane @ turn / side + half).astype(np.int64)
    kept = ((cell >= 0) & (cell < number)).all(axis=1)
    counts = np.bincount(cell[kept, 1] * number + cell[kept, 0], minlength=number * number)
    corners = (np.arange(number + 1) - half) * side
    y, x = np.meshgrid(corners, corners, indexing="ij")
    seen = np.stack([x, y], axis=-1) @ turn.T @ orientation.foreshortening()
    # A corner on the border counts as outside for cells that reach beyond, as inside for those that do not.
    within = (np.abs(seen) <= 0.5 + (-1e-9 if at_border else 1e-9)).all(axis=-1)
    parts = np.stack([within[:-1, :-1], within[1:, :-1], within[:-1, 1:], within[1:, 1:]])
    used = (parts.any(axis=0) if at_border else parts.all(axis=0)).reshape(-1)
    chosen = counts[used]
    if chosen.size < 2 or not chosen.any():
        return 0.5
    mean = chosen.mean()
    return float(chi2.cdf(np.square(chosen - mean).sum() / mean, chosen.size - 1))


def uniformity_landscape(
    points: Floats, samples: int = 25, *, at_border: bool = False, look: Callable[[], None] = go_on
) -> tuple[Floats, Floats]:
    """Return :func:`uniformity` over the disc slant · (cos 2 tilt, sin 2 tilt), NaN outside, and its axis."""
    axis = np.linspace(-MOST_SLANT + 5, MOST_SLANT - 5, samples)
    found = np.full((samples, samples), np.nan)
    for row, y in enumerate(axis):
        look()
        for column, x in enumerate(axis):
            if math.hypot(x, y) <= axis[-1] + 1e-9:
                hypothesis = Orientation.from_disc(float(x), float(y))
                found[row, column] = uniformity(points, hypothesis, at_border=at_border)
    return found, axis


def most_uniform(points: Floats, hypotheses: list[Orientation], *, at_border: bool = False) -> int:
    """Return which hypothesis leaves the points most even (the search that the chapter proposes)."""
    return int(np.argmin([uniformity(points, each, at_border=at_border) for each in hypotheses]))


def random_marks(
    count: int, orientation: Orientation, rng: np.random.Generator, *, aspect: float = 2.0
) -> tuple[Floats, Floats]:
    """Return the picture of ellipses that lie on a plane in random directions.

    Returns
    -------
    places
        (n, 2) in the picture.
    tensors
        (n, 2, 2): the shape of each, R diag(a², b²) Rᵀ with a b = 1 on the plane, as it is seen.
    """
    check_count(count)
    if aspect < 1:
        raise ParamError("aspect", "a number from 1", aspect)
    angle = rng.uniform(0, np.pi, count)
    along = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    across = np.stack([-along[:, 1], along[:, 0]], axis=-1)
    shapes = aspect * along[:, :, None] * along[:, None, :] + across[:, :, None] * across[:, None, :] / aspect
    matrix = orientation.foreshortening()
    return rng.random((count, 2)), matrix @ shapes @ matrix


def orientation_of_marks(tensors: Floats) -> Orientation:
    """Return the orientation from the mean shape of marks, which is c A² when their directions are random.

    Parameters
    ----------
    tensors
        (n, 2, 2) shapes as seen, from n of 2 or more.
    """
    if len(tensors) < 2:
        raise InputError(f"A mean shape needs at least 2 marks, got {len(tensors)}.")
    slant, tilt = of_tensor(tensors.mean(axis=0))
    return Orientation(min(slant, 89.9), tilt)


def perspective_points(count: int, orientation: Orientation, rng: np.random.Generator) -> Floats:
    """Return the perspective picture of a homogeneous Poisson process, given how many of its points are seen.

    Parameters
    ----------
    count
        Points in the picture.
    orientation
        Of the plane; its depth is largest opposite to the tilt.
    rng
        Source of randomness.

    Raises
    ------
    ParamError
        When the plane's horizon would come into the picture.
    """
    check_count(count)
    gradient = _gradient(orientation)
    lowest = 1 - HALF_SIDE * float(np.abs(gradient).sum())
    if lowest < _LEAST_DEPTH:
        raise ParamError("slant", "such that the horizon stays outside the picture", orientation.slant)
    found = np.empty((0, 2))
    while len(found) < count:
        # Rejection: the density is (n · p)^-3, largest where the plane is farthest.
        tried = rng.random((4 * count, 2))
        depth = 1 + (tried - 0.5) * (2 * HALF_SIDE) @ gradient
        found = np.concatenate([found, tried[rng.random(len(tried)) < (lowest / depth) ** 3]])
    return found[:count]


def _gradient(orientation: Orientation) -> Floats:
    """Return (p, q) of n ~ (p, q, 1)."""
    normal = orientation.normal
    gradient: Floats = normal[:2] / normal[2]
    return gradient


@dataclass(frozen=True, slots=True, eq=False)
class DensityFit:
    """The orientation of greatest likelihood, and whether the guard before the horizon held it back."""

    orientation: Orientation
    at_guard: bool


def orientation_of_density(points: Floats) -> DensityFit:
    """Return the orientation of greatest likelihood of a perspective picture of a Poisson process.

    The density of the points is proportional to (n · p)^-3 with p = (x, y, 1). Unlike in an orthographic view the
    tilt has no ambiguity.

    Parameters
    ----------
    points
        (n, 2) in the picture, n of 3 or more.
    """
    if len(points) < 3:
        raise InputError(f"A density needs at least 3 points, got {len(points)}.")
    from scipy.optimize import minimize

    centred = (points - 0.5) * (2 * HALF_SIDE)
    nodes, weights = np.polynomial.legendre.leggauss(_QUADRATURE)
    y, x = np.meshgrid(nodes * HALF_SIDE, nodes * HALF_SIDE, indexing="ij")
    grid = np.stack([x, y], axis=-1).reshape(-1, 2)
    area = np.outer(weights, weights).reshape(-1) / 4

    def unlikely(gradient: Floats) -> float:
        lowest = 1 - HALF_SIDE * float(np.abs(gradient).sum())
        if lowest < _LEAST_DEPTH:
            return 1e6 * (1 + _LEAST_DEPTH - lowest)
        logs = np.log1p(centred @ gradient).mean()
        return float(3 * logs + np.log(area @ (1 + grid @ gradient) ** -3))

    simplex = np.array([[0.0, 0.0], [0.3, 0.0], [0.0, 0.3]])
    found = minimize(
        unlikely,
        simplex[0],
        method="Nelder-Mead",
        options={"initial_simplex": simplex, "xatol": 1e-4, "fatol": 1e-9},
    )
    p, q = float(found.x[0]), float(found.x[1])
    slant, tilt = math.degrees(math.atan(math.hypot(p, q))), math.degrees(math.atan2(q, p)) % 360
    return DensityFit(Orientation(slant, tilt), 1 - HALF_SIDE * (abs(p) + abs(q)) < 1.2 * _LEAST_DEPTH)
