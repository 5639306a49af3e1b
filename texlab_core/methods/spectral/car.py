"""Causal autoregressive model: every pixel a weighted sum of 60 earlier ones, plus noise.

Reference: Navarro & Portilla 1996, section 4, Fig. 7b; for stability DeCarlo, Murray & Saeks 1977, Strintzis 1977.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.spectral.fourier import Floats, Half, Plane, inverse
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.engine.progress import Progress
    from texlab_core.engine.steps import Step

REACH = 5
# Offsets (rows above, columns to the left) of the non-symmetric half plane of radius 5.
OFFSETS = tuple((dy, dx) for dy in range(REACH + 1) for dx in range(-REACH if dy else 1, REACH + 1))
COEFFICIENTS = len(OFFSETS)
# Relative size of the ridge: constant and periodic exemplars leave the equations without a unique solution.
_RIDGE = 1e-10
# Standard deviation of rounding to whole gray levels.
_QUANTUM = 1 / np.sqrt(12)
_WARM = 64
# Values beyond so many standard deviations of the exemplar are limited: an unstable recursion grows without end.
_LIMIT = 16.0
_ANGLES = 256


@dataclass(frozen=True, eq=False)
class Car:
    """A fitted model.

    Parameters
    ----------
    coefficients
        (60,) float64, in the order of ``OFFSETS``.
    mean, deviation
        Of the plane, in gray levels.
    noise
        Standard deviation of the prediction error, in gray levels.
    """

    coefficients: Floats
    mean: float
    deviation: float
    noise: float

    def grid(self) -> Floats:
        """Return the coefficients as (6, 11): [rows above, columns to the left + 5]."""
        grid = np.zeros((REACH + 1, 2 * REACH + 1))
        for (dy, dx), value in zip(OFFSETS, self.coefficients, strict=True):
            grid[dy, dx + REACH] = value
        return grid


def fit(plane: Plane, progress: Progress, stage: str) -> Generator[Step, None, Car]:
    """Fit the model by least squares over the pixels whose 60 predecessors lie inside the plane.

    Parameters
    ----------
    plane
        (H, W) float32 in gray levels. Planes too small for that are taken as periodic.
    """
    from texlab_core.kernels import gabor

    mean = float(plane.mean(dtype=np.float64))
    values = plane.astype(np.float64) - mean
    deviation = float(np.sqrt(np.square(values).mean()))
    if plane.shape[0] < 4 * REACH or plane.shape[1] < 4 * REACH:
        values = np.pad(values, ((REACH, 0), (REACH, REACH)), mode="wrap")
    height, width = values.shape[0] - REACH, values.shape[1] - 2 * REACH
    products = np.zeros((COEFFICIENTS + 1, COEFFICIENTS + 1))
    offsets = np.array([(0, 0), *OFFSETS])
    for rows in row_blocks((height, width), 2**12):
        gabor.covariances(values[rows.start : rows.stop + REACH], offsets, products)
        yield progress.at(stage, rows.stop / height)
    products = np.triu(products) + np.triu(products, 1).T
    covariance, target = products[1:, 1:], products[1:, 0]
    ridge = _RIDGE * max(np.trace(covariance) / COEFFICIENTS, 1e-30)
    solved = np.linalg.solve(covariance + ridge * np.eye(COEFFICIENTS), target)
    error = products[0, 0] - 2 * solved @ target + solved @ covariance @ solved
    # A strictly periodic plane leaves no error, and without noise nothing would be synthesized.
    noise = max(float(np.sqrt(max(error, 0.0) / (height * width))), _QUANTUM if deviation > 0 else 0.0)
    return Car(solved, mean, deviation, noise)


def transfer(model: Car, size: tuple[int, int], rows: slice) -> NDArray[np.complex128]:
    """Return 1 - A(u, v) on rows of the half plane, A the transform of the coefficients."""
    height, width = size
    u, v = np.arange(width // 2 + 1) / width, np.fft.fftfreq(height)[rows]
    along_u = np.exp(-2j * np.pi * np.outer(np.arange(-REACH, REACH + 1), u))
    along_v = np.exp(-2j * np.pi * np.outer(v, np.arange(REACH + 1)))
    value = np.ones((v.size, u.size), complex)
    # Term by term: the order of the sum does not depend on a library's threads.
    for wave, weights in zip(along_v.T, model.grid(), strict=True):
        value -= np.multiply.outer(wave, (weights[:, None] * along_u).sum(axis=0))
    return value


def shape_noise(
    half: Half, model: Car, size: tuple[int, int], progress: Progress, stage: str
) -> Generator[Step, None, None]:
    """Multiply a unit-modulus half plane by the model's magnitude spectrum, in place."""
    gain = model.noise * np.sqrt(size[0] * size[1])
    for rows in row_blocks((half.shape[0], half.shape[1]), 2**17):
        modulus = np.abs(transfer(model, size, rows))
        half[rows] *= (gain / np.maximum(modulus, 1e-9)).astype(np.float32)
        yield progress.at(stage, rows.stop / half.shape[0])
    half[0, 0] = model.mean * size[0] * size[1]


def recurse(
    half: Half, model: Car, size: tuple[int, int], progress: Progress, stage: str
) -> Generator[Step, None, tuple[Plane, float]]:
    """Run the recursion on white noise with the given phase.

    Returns
    -------
    plane
        (H, W) float32 in gray levels; it tiles as far as the recursion forgets its start within 64 pixels.
    limited
        Share of values that had to be limited, because the recursion is unstable.
    """
    from texlab_core.kernels import car

    height, width = size
    half[0, 0] = 0
    half *= np.float32(model.noise * np.sqrt(height * width))
    noise = yield from inverse(half, size, progress, stage)
    field = np.zeros((_WARM + height, width + 2 * REACH))
    grid = model.grid()
    limit = _LIMIT * max(model.deviation, 1e-6)
    limited = 0
    for rows in row_blocks((_WARM + height, width + _WARM), 2**16):
        limited += int(car.recurse(noise, grid, field, rows.start, rows.stop, _WARM, limit))
        yield progress.at(stage)
    plane = (field[_WARM:, REACH : REACH + width] + model.mean).astype(np.float32)
    return plane, limited / plane.size


def largest_pole(model: Car, progress: Progress, stage: str) -> Generator[Step, None, float]:
    """Return the largest pole modulus of the recursion; it is stable when that is below 1.

    Reference: DeCarlo, Murray & Saeks 1977; Strintzis 1977. The polynomial of the row alone, and that of the rows
    above with the other variable anywhere on the unit circle, must have their roots within the unit circle.
    """
    grid = model.grid()
    row = np.concatenate([[1.0], -grid[0, REACH + 1 :]])
    largest = float(np.abs(np.roots(row)).max(initial=0.0))
    angles = np.linspace(0, np.pi, _ANGLES + 1)
    moduli = np.concatenate([_pole_moduli(grid, part) for part in np.array_split(angles, 2)])
    yield progress.at(stage, 0.5)
    peak = int(np.argmax(moduli))
    step = angles[1]
    fine = np.linspace(angles[peak] - step, angles[peak] + step, _ANGLES // 2 + 1)
    largest = max(largest, float(moduli.max()), float(_pole_moduli(grid, fine).max()))
    yield progress.at(stage)
    return largest


def _pole_moduli(grid: Floats, angles: Floats) -> Floats:
    """Return the largest modulus of the roots in the vertical variable for horizontal frequencies in radians."""
    shifts = np.exp(-1j * np.outer(np.arange(-REACH, REACH + 1), angles))
    columns = np.stack([(weights[:, None] * shifts).sum(axis=0) for weights in grid])
    companion = np.zeros((angles.size, REACH, REACH), complex)
    companion[:, 0, :] = (columns[1:] / (1 - columns[0])).T
    companion[:, np.arange(1, REACH), np.arange(REACH - 1)] = 1
    moduli: Floats = np.abs(np.linalg.eigvals(companion)).max(axis=1)
    return moduli
