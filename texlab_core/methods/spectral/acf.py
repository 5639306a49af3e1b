"""AC-H: the centre of the autocorrelation, and the spectrum that it stands for.

Reference: Navarro & Portilla 1996, section 4, Fig. 7a.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.spectral.fourier import Floats, Half, Plane, column_weights, forward
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.engine.progress import Progress
    from texlab_core.engine.steps import Step

REACH = 5
# The centre is its own mirror image: 60 samples and the variance.
PARAMETERS = ((2 * REACH + 1) ** 2 + 1) // 2


@dataclass(frozen=True, eq=False)
class Acf:
    """The centre of an autocovariance.

    Parameters
    ----------
    values
        (11, 11) float64 in squared gray levels; lags -5 .. 5 down the rows and along the columns.
    mean
        Mean gray level.
    """

    values: Floats
    mean: float


def measure(plane: Plane, progress: Progress, transform: str, stage: str) -> Generator[Step, None, Acf]:
    """Return the centre of the periodic autocovariance of a plane in gray levels."""
    height, width = plane.shape
    mean = float(plane.mean(dtype=np.float64))
    half = yield from forward(plane - np.float32(mean), progress, transform)
    along_v, along_u = _waves(height), _waves(width)[: width // 2 + 1] * column_weights(width)[:, None]
    values = np.zeros((2 * REACH + 1, 2 * REACH + 1))
    for rows in row_blocks((height, half.shape[1]), 2**17):
        part = half[rows].astype(np.complex128)
        power = np.square(part.real) + np.square(part.imag)
        for column, wave in enumerate(along_u.T):
            lag = (power * wave).sum(axis=1)
            values[:, column] += (along_v[rows] * lag[:, None]).sum(axis=0).real
        yield progress.at(stage, rows.stop / height)
    return Acf(values / float(height * width) ** 2, mean)


def spectrum(acf: Acf, size: tuple[int, int], rows: slice) -> Floats:
    """Return the power per pixel that the samples stand for, on rows of the half plane; it may be negative."""
    height, width = size
    along_v, along_u = _waves(height)[rows], _waves(width)[: width // 2 + 1].T
    power = np.zeros((along_v.shape[0], along_u.shape[1]))
    # Term by term: the order of the sum does not depend on a library's threads.
    for wave, samples in zip(along_v.T, acf.values, strict=True):
        power += np.multiply.outer(wave, (samples[:, None] * along_u).sum(axis=0)).real
    return power


def shape_noise(
    half: Half, acf: Acf, size: tuple[int, int], progress: Progress, stage: str
) -> Generator[Step, None, float]:
    """Multiply a unit-modulus half plane by the root of the spectrum, in place.

    Returns
    -------
    float
        Share of the spectrum's mass that was negative and was clipped, from 0 to 1.
    """
    weights = column_weights(size[1])
    negative = total = 0.0
    for rows in row_blocks((half.shape[0], half.shape[1]), 2**17):
        power = spectrum(acf, size, rows)
        negative -= float((np.minimum(power, 0) @ weights).sum())
        total += float((np.abs(power) @ weights).sum())
        half[rows] *= np.sqrt(np.maximum(power, 0) * (size[0] * size[1])).astype(np.float32)
        yield progress.at(stage, rows.stop / half.shape[0])
    half[0, 0] = acf.mean * size[0] * size[1]
    return negative / total if total > 0 else 0.0


def _waves(count: int) -> NDArray[np.complex128]:
    """Return (count, 11) exp(-2 pi i f lag); the samples are symmetric, so that the sign does not matter."""
    waves: NDArray[np.complex128] = np.exp(
        -2j * np.pi * np.outer(np.fft.fftfreq(count), np.arange(-REACH, REACH + 1))
    )
    return waves
