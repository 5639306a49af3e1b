"""A textured sphere, and its shape from local estimates: each window is taken as a plane of isotropic texture.

The sphere is seen orthographically. Its texture is homogeneous on the sphere itself: discs that keep their
distance on it, or the surface of a solid noise. Estimates are needles whose direction has the 180° ambiguity of
the tilt; near the middle, where the cosine is flat, they say little.

Reference: Forsyth and Ponce, section 11.4.2; Gårding 1992; Malik and Rosenholtz 1997.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from texlab_core.errors import ParamError
from texlab_core.shape.orientation import normal_errors
from texlab_core.shape.textures import keep_apart, soft_disc

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Plane = NDArray[np.float32]
    Floats = NDArray[np.float64]

SphereTexture = Literal["discs", "noise"]
# Beyond it a window holds more limb than texture.
LIMB = 75.0
SLANT_BINS = ((0, 20), (20, 40), (40, 60), (60, 75))
_MARGIN = 0.45
_DISC_RADIUS, _DISC_DISTANCE, _DISC_SOFTNESS = 7.0, 16.5, 3.0
_WAVELENGTH = 14.0
_TRIES = 6


@dataclass(frozen=True, eq=False, slots=True)
class Sphere:
    """A picture of a sphere and the true orientation of its surface.

    Parameters
    ----------
    image
        (n, n) float32 in [0, 1], 0.5 outside the sphere.
    slant, tilt
        (n, n) float64 degrees, NaN outside.
    """

    image: Plane
    slant: Floats
    tilt: Floats


@dataclass(frozen=True, eq=False, slots=True)
class LocalShape:
    """Orientation by window.

    Parameters
    ----------
    slant, tilt
        (H, W) float64 degrees; tilt and tilt + 180 are alike.
    """

    slant: Floats
    tilt: Floats


def render_sphere(side: int, rng: np.random.Generator, texture: SphereTexture = "discs") -> Sphere:
    """Render a textured sphere whose radius is 0.45 of the picture's side.

    Parameters
    ----------
    side
        96 to 1024.
    rng
        Source of randomness.
    texture
        ``discs`` of 7 pixels radius, or ``noise``: solid noise of wavelength 14 where the sphere cuts it.

    Raises
    ------
    ParamError
        When side or texture is out of range.
    """
    if not 96 <= side <= 1024:
        raise ParamError("side", "a whole number from 96 to 1024", side)
    if texture not in get_args(SphereTexture):
        raise ParamError("texture", f"one of {', '.join(get_args(SphereTexture))}", texture)
    radius = _MARGIN * side
    grid = (np.arange(2 * side) + 0.5) / 2 - side / 2
    y, x = np.meshgrid(grid / radius, grid / radius, indexing="ij")
    inside = x**2 + y**2 < 1
    places = np.stack([x[inside], y[inside], np.sqrt(1 - x[inside] ** 2 - y[inside] ** 2)], axis=-1)
    fine = np.full(x.shape, 0.5, np.float32)
    fine[inside] = _discs(places, radius, rng) if texture == "discs" else _noise(places, radius, rng)
    image = fine.reshape(side, 2, side, 2).mean(axis=(1, 3))
    middle = (np.arange(side) + 0.5 - side / 2) / radius
    far = np.hypot(middle[:, None], middle[None, :])
    slant = np.degrees(np.arcsin(np.where(far < 1, far, np.nan)))
    tilt = np.where(far < 1, np.degrees(np.arctan2(middle[:, None], middle[None, :])), np.nan)
    return Sphere(image, slant, tilt)


def _discs(places: Floats, radius: float, rng: np.random.Generator) -> Plane:
    from scipy.spatial import cKDTree

    number = int(_TRIES * 4 * np.pi * (radius / _DISC_DISTANCE) ** 2)
    tried = rng.standard_normal((number, 3))
    tried /= np.linalg.norm(tried, axis=1, keepdims=True)
    kept = tried[keep_apart(cKDTree(tried).query_ball_point(tried, _DISC_DISTANCE / radius))]
    reach = _DISC_RADIUS + _DISC_SOFTNESS
    nearest, _ = cKDTree(kept).query(places, distance_upper_bound=reach / radius)
    return soft_disc(np.minimum(nearest * radius, reach), _DISC_RADIUS, _DISC_SOFTNESS)


def _noise(places: Floats, radius: float, rng: np.random.Generator) -> Plane:
    """Cut solid Gaussian noise: a periodic cube with four samples to a wave, read between its samples."""
    from scipy import fft, ndimage

    side, step = 64, _WAVELENGTH / 4
    axis = np.fft.fftfreq(side)
    distance = np.sqrt(axis[:, None, None] ** 2 + axis[None, :, None] ** 2 + np.fft.rfftfreq(side) ** 2)
    octaves = np.log2(np.maximum(distance, 1e-9) * 4)
    spectrum = fft.rfftn(rng.standard_normal((side, side, side))) * np.exp(-((octaves / 0.5) ** 2) / 2)
    solid = fft.irfftn(spectrum, s=(side, side, side))
    solid *= 0.17 / solid.std()
    values = ndimage.map_coordinates(solid, (places * radius / step).T, order=3, mode="grid-wrap")
    return np.clip(values + 0.5, 0, 1).astype(np.float32)


def local_shape(image: Plane, window: float = 24.0) -> LocalShape:
    """Estimate the orientation around every pixel from second moments of the gradient (isotropy).

    Parameters
    ----------
    image
        (H, W) float32.
    window
        Side of the (Gaussian) windows in pixels, four standard deviations: 8 to 128.

    Raises
    ------
    ParamError
        When the window is out of range.
    """
    if not 8 <= window <= 128:
        raise ParamError("window", "a number of pixels from 8 to 128", window)
    import cv2

    # Exact for polynomials of degree 4: a coarser difference would not see what foreshortening packs.
    difference = np.array([1, -8, 0, 8, -1], np.float64) / 12
    gx = cv2.sepFilter2D(image, cv2.CV_32F, difference, np.ones(1))
    gy = cv2.sepFilter2D(image, cv2.CV_32F, np.ones(1), difference)

    def smooth(plane: Plane) -> Floats:
        return cv2.GaussianBlur(plane, (0, 0), window / 4, borderType=cv2.BORDER_REFLECT_101).astype(np.float64)

    xx, xy, yy = smooth(gx * gx), smooth(gx * gy), smooth(gy * gy)
    total, difference_of = xx + yy, np.hypot(xx - yy, 2 * xy)
    low, high = np.maximum(total - difference_of, 0), total + difference_of
    ratio = np.divide(low, high, out=np.ones_like(low), where=high > 1e-12)
    return LocalShape(np.degrees(np.arccos(np.sqrt(ratio))), np.degrees(np.arctan2(2 * xy, xx - yy)) / 2 % 180)


def errors_by_slant(sphere: Sphere, found: LocalShape) -> tuple[float, ...]:
    """Return the mean error of the normals in degrees within each of :data:`SLANT_BINS`, the limb left out."""
    known = np.isfinite(sphere.slant)
    errors = normal_errors(found.slant[known], found.tilt[known], sphere.slant[known], sphere.tilt[known])
    slant = sphere.slant[known]
    return tuple(float(errors[(slant >= low) & (slant < high)].mean()) for low, high in SLANT_BINS)
