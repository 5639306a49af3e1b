"""The orientation of a textured plane in an orthographic view: slant and tilt.

Image coordinates are (x, y), x along the columns and y down the rows; tilt is counted from x towards y, as the
angles of waves are everywhere in this program. A plane is seen shortened by cos(slant) along the tilt direction
and unchanged across it. Tilt and tilt + 180° give the same picture: no orthographic method can tell them apart.

Reference: Forsyth and Ponce, section 11.4.1, Fig. 11.24.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.errors import ParamError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

# Beyond it a plane is little more than a line, and rendering one takes more than six samples per pixel and side.
MOST_SLANT = 80.0


@dataclass(frozen=True, slots=True)
class Orientation:
    """How a plane is turned away from the viewer.

    Parameters
    ----------
    slant
        Angle between the plane's normal and the line of sight in degrees, 0 (seen frontally) up to below 90.
    tilt
        Direction in degrees, in the image, of the projected normal. It means nothing at slant 0.

    Raises
    ------
    ParamError
        When the slant is out of range or either angle is not finite.
    """

    slant: float
    tilt: float = 0.0

    def __post_init__(self) -> None:
        if not 0 <= self.slant < 90:
            raise ParamError("slant", "a number of degrees from 0 to below 90", self.slant)
        if not math.isfinite(self.tilt):
            raise ParamError("tilt", "a number of degrees", self.tilt)

    @classmethod
    def from_disc(cls, x: float, y: float, most: float = MOST_SLANT) -> Orientation:
        """Return the orientation at a point of the disc slant · (cos 2 tilt, sin 2 tilt)."""
        return cls(min(math.hypot(x, y), most), math.degrees(math.atan2(y, x)) / 2 % 180)

    @property
    def disc(self) -> tuple[float, float]:
        """The point slant · (cos 2 tilt, sin 2 tilt): one for each pair of tilts that look alike."""
        twice = math.radians(2 * self.tilt)
        return self.slant * math.cos(twice), self.slant * math.sin(twice)

    @property
    def cosine(self) -> float:
        """By what the tilt direction is shortened."""
        return math.cos(math.radians(self.slant))

    @property
    def normal(self) -> Floats:
        """The plane's unit normal, (3,): x, y, and towards the viewer."""
        return normals(np.float64(self.slant), np.float64(self.tilt))

    @property
    def other(self) -> Orientation:
        """The orientation that looks alike: the tilt the other way round."""
        return Orientation(self.slant, (self.tilt + 180) % 360)

    def foreshortening(self) -> Floats:
        """Return A, (2, 2): a point X of the plane is seen at A X, with the plane's axes chosen so that A = Aᵀ."""
        tilt = math.radians(self.tilt)
        along = np.array([math.cos(tilt), math.sin(tilt)])
        matrix: Floats = np.eye(2) - (1 - self.cosine) * np.outer(along, along)
        return matrix

    def error(self, truth: Orientation) -> float:
        """Return the angle between two normals in degrees, the 180° ambiguity of the tilt forgiven."""
        return float(normal_errors(self.slant, self.tilt, truth.slant, truth.tilt))


def normals(slant: Any, tilt: Any) -> Floats:
    """Return unit normals, (..., 3), of slants and tilts in degrees of the same shape."""
    s, t = np.radians(slant), np.radians(tilt)
    found: Floats = np.stack([np.sin(s) * np.cos(t), np.sin(s) * np.sin(t), np.cos(s)], axis=-1)
    return found


def normal_errors(slant: Any, tilt: Any, true_slant: Any, true_tilt: Any) -> Floats:
    """Return the angles in degrees between normals, the better of both tilts that look alike."""
    one, other = normals(slant, tilt), normals(true_slant, true_tilt)
    depth = one[..., 2] * other[..., 2]
    across = np.abs(one[..., 0] * other[..., 0] + one[..., 1] * other[..., 1])
    errors: Floats = np.degrees(np.arccos(np.clip(depth + across, -1, 1)))
    return errors


def of_tensor(tensor: Floats) -> tuple[float, float]:
    """Return slant and tilt of a plane whose isotropic moments are seen as a symmetric (2, 2) tensor of *widths*.

    Such a tensor is c A²: it is narrow along the tilt, and the ratio of its eigenvalues is cos² slant.
    """
    values, vectors = np.linalg.eigh(tensor)
    low, high = max(float(values[0]), 0.0), float(values[1])
    if high <= 0:
        return 0.0, 0.0
    return math.degrees(math.acos(math.sqrt(low / high))), math.degrees(
        math.atan2(vectors[1, 0], vectors[0, 0])
    ) % 180
