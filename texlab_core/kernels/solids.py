"""Looking at a solid: where rays meet its surface, and the colour of the volume, or of a wrapped image, there.

Object space: x to the right, y up, z towards the viewer; the longest side of the volume is 2 long, its middle is
the origin. Slice 0 of the volume is the front face, its rows go down and its columns to the right.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.kernels.jit import njit

if TYPE_CHECKING:
    from numpy.typing import NDArray

BLOCK, SPHERE, CYLINDER, TORUS = 0, 1, 2, 3

# Of the objects, in units of half the longest side.
RADIUS = 0.98
RING = 0.64
TUBE = 0.34
CARVED = 0.92

_AMBIENT = 0.38
_FAR = 1e30
_NEAR = 1e-3
_MARCH = 80


@njit
def _sphere(
    ox: float, oy: float, oz: float, dx: float, dy: float, dz: float, radius: float
) -> tuple[float, float]:
    """Return where a ray enters and leaves a sphere about the origin; (far, -far) when it misses."""
    b = ox * dx + oy * dy + oz * dz
    q = b * b - (ox * ox + oy * oy + oz * oz - radius * radius)
    if q <= 0.0:
        return _FAR, -_FAR
    root = math.sqrt(q)
    return -b - root, -b + root


@njit
def _slab(o: float, d: float, half: float) -> tuple[float, float]:
    """Return where a ray enters and leaves the space between two planes."""
    if abs(d) < 1e-12:
        return (-_FAR, _FAR) if abs(o) <= half else (_FAR, -_FAR)
    one, other = (-half - o) / d, (half - o) / d
    return (one, other) if one < other else (other, one)


@njit
def _hit_block(
    ox: float, oy: float, oz: float, dx: float, dy: float, dz: float, hx: float, hy: float, hz: float, carve: float
) -> tuple[float, float, float, float, int]:
    """Return distance, normal and face (0 x, 1 y, 2 z, 3 the carved corner) of a block; distance -1 for none."""
    x0, x1 = _slab(ox, dx, hx)
    y0, y1 = _slab(oy, dy, hy)
    z0, z1 = _slab(oz, dz, hz)
    enter, leave = max(x0, y0, z0), min(x1, y1, z1)
    if enter >= leave or enter <= 0.0:
        return -1.0, 0.0, 0.0, 0.0, 0
    s0, s1 = _sphere(ox - hx, oy - hy, oz - hz, dx, dy, dz, carve)
    if s0 <= enter < s1:
        # It comes in through the hole and meets the far wall of it, if that lies inside the block.
        if s1 >= leave:
            return -1.0, 0.0, 0.0, 0.0, 0
        nx, ny, nz = hx - ox - s1 * dx, hy - oy - s1 * dy, hz - oz - s1 * dz
        return s1, nx / carve, ny / carve, nz / carve, 3
    if enter == x0:
        return enter, (-1.0 if dx > 0 else 1.0), 0.0, 0.0, 0
    if enter == y0:
        return enter, 0.0, (-1.0 if dy > 0 else 1.0), 0.0, 1
    return enter, 0.0, 0.0, (-1.0 if dz > 0 else 1.0), 2


@njit
def _hit_cylinder(
    ox: float, oy: float, oz: float, dx: float, dy: float, dz: float, half: float
) -> tuple[float, float, float, float, int]:
    """Return distance, normal and part (0 side, 1 cap) of an upright cylinder."""
    y0, y1 = _slab(oy, dy, half)
    a = dx * dx + dz * dz
    b = ox * dx + oz * dz
    c = ox * ox + oz * oz - RADIUS * RADIUS
    if a < 1e-12:
        s0, s1 = (-_FAR, _FAR) if c <= 0 else (_FAR, -_FAR)
    else:
        q = b * b - a * c
        if q <= 0.0:
            return -1.0, 0.0, 0.0, 0.0, 0
        root = math.sqrt(q)
        s0, s1 = (-b - root) / a, (-b + root) / a
    enter, leave = max(s0, y0), min(s1, y1)
    if enter >= leave or enter <= 0.0:
        return -1.0, 0.0, 0.0, 0.0, 0
    if enter == y0:
        return enter, 0.0, (-1.0 if dy > 0 else 1.0), 0.0, 1
    return enter, (ox + enter * dx) / RADIUS, 0.0, (oz + enter * dz) / RADIUS, 0


@njit
def _hit_torus(
    ox: float, oy: float, oz: float, dx: float, dy: float, dz: float
) -> tuple[float, float, float, float, int]:
    """March along a ray by its distance from a lying torus."""
    y0, y1 = _slab(oy, dy, TUBE)
    s0, s1 = _sphere(ox, oy, oz, dx, dy, dz, RING + TUBE)
    t, leave = max(s0, y0), min(s1, y1)
    if t >= leave or t <= 0.0:
        return -1.0, 0.0, 0.0, 0.0, 0
    for _ in range(_MARCH):
        x, y, z = ox + t * dx, oy + t * dy, oz + t * dz
        flat = math.sqrt(x * x + z * z)
        ring = flat - RING
        across = math.sqrt(ring * ring + y * y)
        away = across - TUBE
        if away < _NEAR:
            share = ring / max(flat, 1e-9)
            return t, x * share / across, y / across, z * share / across, 0
        t += away
        if t >= leave:
            break
    return -1.0, 0.0, 0.0, 0.0, 0


@njit
def _blend(
    volume: NDArray[np.float32], k: float, i: float, j: float, clamped: bool, colour: NDArray[np.float32]
) -> None:
    """Write the volume's colour between eight voxels; beyond its sides it goes on periodically, or is clamped."""
    depth, height, width, channels = volume.shape
    if clamped:
        k, i, j = min(max(k, 0.0), depth - 1.0), min(max(i, 0.0), height - 1.0), min(max(j, 0.0), width - 1.0)
    fk, fi, fj = math.floor(k), math.floor(i), math.floor(j)
    wk, wi, wj = np.float32(k - fk), np.float32(i - fi), np.float32(j - fj)
    k0, i0, j0 = int(fk) % depth, int(fi) % height, int(fj) % width
    k1 = k0 + 1 if k0 + 1 < depth else 0
    i1 = i0 + 1 if i0 + 1 < height else 0
    j1 = j0 + 1 if j0 + 1 < width else 0
    vk, vi, vj = np.float32(1) - wk, np.float32(1) - wi, np.float32(1) - wj
    for c in range(channels):
        near = vi * (vj * volume[k0, i0, j0, c] + wj * volume[k0, i0, j1, c]) + wi * (
            vj * volume[k0, i1, j0, c] + wj * volume[k0, i1, j1, c]
        )
        far = vi * (vj * volume[k1, i0, j0, c] + wj * volume[k1, i0, j1, c]) + wi * (
            vj * volume[k1, i1, j0, c] + wj * volume[k1, i1, j1, c]
        )
        colour[c] = vk * near + wk * far


@njit
def _unroll(
    shape: int, part: int, x: float, y: float, z: float, hx: float, hy: float, hz: float
) -> tuple[float, float]:
    """Return where a point of the surface lies on an image that is wrapped around the object, in object lengths.

    Angles become lengths along the widest circle, as in every atlas: narrower circles are squeezed.
    """
    if shape == SPHERE:
        return math.atan2(x, z) * RADIUS, math.acos(min(max(y / RADIUS, -1.0), 1.0)) * RADIUS
    if shape == CYLINDER:
        around = math.atan2(x, z) * RADIUS
        return (around, hy - y) if part == 0 else (around, RADIUS - math.sqrt(x * x + z * z))
    if shape == TORUS:
        flat = math.sqrt(x * x + z * z)
        return math.atan2(x, z) * RING, math.atan2(y, flat - RING) * TUBE
    if part == 0:
        return hz - z, hy - y
    if part == 1:
        return x + hx, hz - z
    if part == 2:
        return x + hx, hy - y
    # The carved corner is a piece of a sphere.
    return math.atan2(x - hx, z - hz) * CARVED, math.acos(min(max((y - hy) / CARVED, -1.0), 1.0)) * CARVED


@njit
def draw(
    volume: NDArray[np.float32],
    wrapped: bool,
    shape: int,
    turn: NDArray[np.float64],
    half: NDArray[np.float64],
    voxels: float,
    stretch: NDArray[np.float64],
    distance: float,
    scale: float,
    light: NDArray[np.float64],
    background: NDArray[np.uint8],
    top: int,
    out: NDArray[np.uint8],
    size: tuple[int, int],
) -> None:
    """Draw some rows of a picture.

    Parameters
    ----------
    volume
        (D, H, W, C) float32 in [0, 1], C of 1 or 3; an image that is wrapped around the object has D = 1.
    wrapped
        Whether it is such an image.
    shape
        ``BLOCK``, ``SPHERE``, ``CYLINDER`` or ``TORUS``.
    turn
        (3, 3), brings object space into the viewer's.
    half
        (3,) half the width, height and depth of the block.
    voxels
        Voxels (pixels of the image) in a length of 1.
    stretch
        (2,) factors for the places on a wrapped image, so that a whole number of copies goes around.
    distance, scale
        Of the eye from the middle; pixels of the picture in a length of 1 there.
    light
        (3,) unit vector towards the light, in the viewer's space.
    background
        (3,) uint8.
    top
        First row of the picture that is drawn.
    out
        (rows, W, 3) uint8.
    size
        Height and width of the whole picture.
    """
    height, width = size
    channels = volume.shape[3]
    colour = np.zeros(channels, np.float32)
    hx, hy, hz = half[0], half[1], half[2]
    carve = CARVED * min(hx, hy, hz)
    ox, oy, oz = turn[2, 0] * distance, turn[2, 1] * distance, turn[2, 2] * distance
    lx = turn[0, 0] * light[0] + turn[1, 0] * light[1] + turn[2, 0] * light[2]
    ly = turn[0, 1] * light[0] + turn[1, 1] * light[1] + turn[2, 1] * light[2]
    lz = turn[0, 2] * light[0] + turn[1, 2] * light[1] + turn[2, 2] * light[2]
    for row in range(out.shape[0]):
        v = (0.5 * height - (top + row) - 0.5) / scale
        for column in range(width):
            u = (column + 0.5 - 0.5 * width) / scale
            length = math.sqrt(u * u + v * v + distance * distance)
            dx = (turn[0, 0] * u + turn[1, 0] * v - turn[2, 0] * distance) / length
            dy = (turn[0, 1] * u + turn[1, 1] * v - turn[2, 1] * distance) / length
            dz = (turn[0, 2] * u + turn[1, 2] * v - turn[2, 2] * distance) / length
            if shape == BLOCK:
                t, nx, ny, nz, part = _hit_block(ox, oy, oz, dx, dy, dz, hx, hy, hz, carve)
            elif shape == SPHERE:
                t, leave = _sphere(ox, oy, oz, dx, dy, dz, RADIUS)
                part = 0
                if t > leave:
                    t = -1.0
                nx, ny, nz = (ox + t * dx) / RADIUS, (oy + t * dy) / RADIUS, (oz + t * dz) / RADIUS
            elif shape == CYLINDER:
                t, nx, ny, nz, part = _hit_cylinder(ox, oy, oz, dx, dy, dz, RADIUS * hy)
            else:
                t, nx, ny, nz, part = _hit_torus(ox, oy, oz, dx, dy, dz)
            if t <= 0.0:
                for c in range(3):
                    out[row, column, c] = background[c]
                continue
            x, y, z = ox + t * dx, oy + t * dy, oz + t * dz
            if wrapped:
                across, down = _unroll(shape, part, x, y, z, hx, hy, hz)
                j = across * stretch[0] * voxels - 0.5
                i = down * stretch[1] * voxels - 0.5
                _blend(volume, 0.0, i, j, False, colour)
            else:
                _blend(
                    volume,
                    (hz - z) * voxels - 0.5,
                    (hy - y) * voxels - 0.5,
                    (x + hx) * voxels - 0.5,
                    shape == BLOCK,
                    colour,
                )
            shade = _AMBIENT + (1.0 - _AMBIENT) * max(nx * lx + ny * ly + nz * lz, 0.0)
            for c in range(3):
                value = shade * colour[c if channels == 3 else 0]
                out[row, column, c] = np.uint8(255.0 * min(max(value, 0.0), 1.0) + 0.5)
