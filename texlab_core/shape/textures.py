"""Isotropic, homogeneous textures of known properties: filtered noise, and discs that keep their distance."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.errors import ParamError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Plane = NDArray[np.float32]
    Floats = NDArray[np.float64]

# Of the noise: width in octaves of the Gaussian in the logarithm of the frequency.
_OCTAVES = 0.6
# Candidates for each disc of a closest packing; more would hardly place further ones.
_TRIES = 6


def noise_texture(side: int, rng: np.random.Generator, *, wavelength: float = 11.0) -> Plane:
    """Return isotropic Gaussian noise of one scale, (side, side) float32 in [0, 1], periodic.

    Parameters
    ----------
    side
        8 or more.
    rng
        Source of randomness.
    wavelength
        Of its strongest waves in pixels, 3 or more.

    Raises
    ------
    ParamError
        When side or wavelength is out of range.
    """
    _check(side, "wavelength", wavelength, 3.0)
    from scipy import fft

    v, u = np.fft.fftfreq(side)[:, None], np.fft.rfftfreq(side)[None, :]
    octaves = np.log2(np.maximum(np.hypot(u, v), 1e-9) * wavelength)
    spectrum = fft.rfft2(rng.standard_normal((side, side))) * np.exp(-((octaves / _OCTAVES) ** 2) / 2)
    plane = fft.irfft2(spectrum, s=(side, side))
    plane *= 0.17 / max(float(plane.std()), 1e-12)
    return np.clip(plane + 0.5, 0, 1).astype(np.float32)


def disc_texture(
    side: int, rng: np.random.Generator, *, radius: float = 6.0, distance: float = 15.0, softness: float = 2.0
) -> Plane:
    """Return bright discs on a dark ground, (side, side) float32 in [0, 1], periodic.

    Parameters
    ----------
    side
        8 or more.
    rng
        Source of randomness.
    radius, softness
        Of the discs, and the width of their edge, in pixels. A hard edge is broader in the picture than on the
        plane once it is foreshortened below a pixel, and slants above 50° are then read too small.
    distance
        Least distance of two centres.

    Raises
    ------
    ParamError
        When side, radius, softness or distance is out of range.
    """
    _check(side, "radius", radius, 0.5)
    _check(side, "distance", distance, 1.0)
    if not 0 < softness <= 2 * radius:
        raise ParamError("softness", f"above 0 and at most twice the radius ({2 * radius:g})", softness)
    from scipy.spatial import cKDTree

    places = rng.random((int(_TRIES * (side / distance) ** 2) + 8, 2)) * side
    tree = cKDTree(places, boxsize=np.full(2, float(side)))
    kept = places[keep_apart(tree.query_ball_point(places, distance))]
    grid = np.arange(side, dtype=np.float64)
    pixels = np.stack(np.meshgrid(grid, grid, indexing="ij"), axis=-1).reshape(-1, 2)
    reach = radius + softness
    nearest, _ = cKDTree(kept, boxsize=np.full(2, float(side))).query(pixels, distance_upper_bound=reach)
    return soft_disc(np.minimum(nearest, reach).reshape(side, side), radius, softness)


def keep_apart(neighbours: Any) -> NDArray[np.bool_]:
    """Return which places are kept when each one that is kept forbids its neighbours, in their order."""
    alive, kept = np.ones(len(neighbours), bool), np.zeros(len(neighbours), bool)
    for place, near in enumerate(neighbours):
        if alive[place]:
            kept[place] = True
            alive[near] = False
    return kept


def soft_disc(distance: Floats, radius: float, softness: float) -> Plane:
    """Return gray levels by the distance from the nearest centre: 0.15 outside, 0.85 inside."""
    inside = np.clip((radius - distance) / softness + 0.5, 0, 1)
    return (0.15 + 0.7 * inside).astype(np.float32)


def _check(side: int, name: str, value: float, low: float) -> None:
    if not 8 <= side <= 4096:
        raise ParamError("side", "a whole number from 8 to 4096", side)
    if not low <= value <= side / 2:
        raise ParamError(name, f"a number from {low:g} to half the side ({side / 2:g})", value)
