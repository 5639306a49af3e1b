"""Exercises 2 and 3 of the chapter, as functions to play with.

Reference: Forsyth and Ponce, chapter 11, exercises 2 and 3, Fig. 11.24.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from texlab_core.errors import ParamError
from texlab_core.shape.homogeneity import HALF_SIDE
from texlab_core.shape.orientation import Orientation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

Camera = Literal["orthographic", "perspective"]


@dataclass(frozen=True, slots=True)
class Ellipse:
    """What a circle on a slanted plane is seen as.

    Parameters
    ----------
    major, minor
        Half axes; the major one is the circle's radius.
    minor_axis
        Direction of the minor axis in degrees, 0 <= angle < 180: the tilt.
    """

    major: float
    minor: float
    minor_axis: float

    @property
    def aspect(self) -> float:
        """Minor over major axis: the cosine of the slant."""
        return self.minor / self.major


def ellipse_of_circle(orientation: Orientation, radius: float = 1.0) -> Ellipse:
    """Return the ellipse that a circle becomes (exercise 2), measured on its outline rather than assumed.

    The outline is A times the circle; its half axes are the singular values of A.
    """
    if not radius > 0:
        raise ParamError("radius", "above 0", radius)
    directions, values, _ = np.linalg.svd(orientation.foreshortening())
    x, y = directions[:, 1]
    return Ellipse(radius * float(values[0]), radius * float(values[1]), math.degrees(math.atan2(y, x)) % 180)


def outline(orientation: Orientation, radius: float = 1.0, points: int = 181) -> Floats:
    """Return the outline of the ellipse, (points, 2), x first, about the circle's centre."""
    angle = np.linspace(0, 2 * np.pi, points)
    circle = radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    seen: Floats = circle @ orientation.foreshortening()
    return seen


def orientation_of_ellipse(major: float, minor: float, minor_axis: float) -> Orientation:
    """Return the orientation of a plane on which an ellipse is a circle; half axes, and degrees.

    Raises
    ------
    ParamError
        When the minor axis is not above 0, or longer than the major one.
    """
    if not 0 < minor <= major:
        raise ParamError("minor", f"above 0 and at most the major axis ({major:g})", minor)
    return Orientation(math.degrees(math.acos(minor / major)), minor_axis % 180)


def back_projected_areas(columns: int, rows: int, orientation: Orientation, camera: Camera) -> Floats:
    """Return the areas, on the plane, of the equal rectangles that a picture is divided into (exercise 3).

    Parameters
    ----------
    columns, rows
        Rectangles along each side of the picture.
    orientation
        Of the plane, at distance 1 along the line of sight.
    camera
        ``orthographic``: all areas are 1 / cos slant of the rectangles', so that only the number of points per
        area, if it is known, gives the slant and nothing gives the tilt. ``perspective`` (field of view 53
        degrees): they differ, and the counts tell slant and tilt.

    Returns
    -------
    ndarray
        (rows, columns) float64, in units of the picture's area.
    """
    if camera == "orthographic":
        return np.full((rows, columns), 1 / (rows * columns * orientation.cosine))
    normal = orientation.normal
    x, y = ((np.arange(n + 1) / n - 0.5) * 2 * HALF_SIDE for n in (columns, rows))
    corners = np.stack(np.broadcast_arrays(x[None, :], y[:, None], np.float64(1)), axis=-1)
    depth = corners @ normal
    if depth.min() <= 0:
        raise ParamError("slant", "such that the horizon stays outside the picture", orientation.slant)
    # The line of sight meets the plane n · X = n_z at distance 1.
    places = corners * (normal[2] / depth)[..., None]
    down, across = places[1:, 1:] - places[:-1, :-1], places[1:, :-1] - places[:-1, 1:]
    areas: Floats = np.linalg.norm(np.cross(down, across), axis=-1) / 2 / (2 * HALF_SIDE) ** 2
    return areas


def slant_of_count(count: int, density: float, area: float = 1.0) -> float | None:
    """Return the slant that a count says when the points per area of the plane are known (exercise 3), in degrees.

    An area of the picture shows ``density · area / cos slant`` points. None when there are fewer than frontally.
    """
    if count <= 0:
        return None
    cosine = density * area / count
    return math.degrees(math.acos(cosine)) if cosine <= 1 else None
