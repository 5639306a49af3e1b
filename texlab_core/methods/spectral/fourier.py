"""Real Fourier transforms in blocks, and the one random phase that the spectral methods share.

A half plane is an ``rfft2`` array: (H, W // 2 + 1), rows for v = -1/2 .. 1/2 in FFT order, columns for
u = 0 .. 1/2, in cycles per pixel; u is horizontal, v points down like the rows.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from texlab_core.transforms.fourier import irfft2, rfft2
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core.engine.progress import Progress
    from texlab_core.engine.steps import Step
    from texlab_core.engine.streams import Streams

Plane: TypeAlias = NDArray[np.float32]
Half: TypeAlias = NDArray[np.complex64]
Floats: TypeAlias = NDArray[np.float64]

# Values in a block that takes a few milliseconds; the last bits of sums and of large transforms depend on it.
BLOCK = 2**20


def forward(plane: Plane, progress: Progress, stage: str) -> Generator[Step, None, Half]:
    """Return ``rfft2(plane)``, not scaled, yielding between blocks of rows and columns.

    Parameters
    ----------
    plane
        (H, W) float32 (or float64, then the result is complex128).
    """
    work = plane.size + plane.shape[0] * (plane.shape[1] // 2 + 1) if plane.size > BLOCK else plane.size
    return progress.count(rfft2(plane, "backward", BLOCK), stage, work)


def inverse(half: Half, size: tuple[int, int], progress: Progress, stage: str) -> Generator[Step, None, Plane]:
    """Return ``irfft2(half, size)``, yielding between blocks; the half plane is overwritten."""
    samples = size[0] * size[1]
    return progress.count(
        irfft2(half, size, "backward", BLOCK), stage, samples + half.size if samples > BLOCK else samples
    )


def random_phase(
    size: tuple[int, int], streams: Streams, progress: Progress, stage: str, *index: int
) -> Generator[Step, None, Half]:
    """Return the spectrum of white noise whose modulus is 1 everywhere.

    Every spectral method calls this, so that one seed gives all of them the same phase at the same size.

    Parameters
    ----------
    size
        Height and width of the image.
    streams
        The stream "phase" is used.
    index
        Further independent phases.

    Returns
    -------
    phase
        (H, W // 2 + 1) complex64, Hermitian, 1 at zero frequency.
    """
    phase = yield from progress.follow(draw_phase(size, streams("phase", *index)), stage)
    return phase


def draw_phase(size: tuple[int, int], generator: np.random.Generator) -> Generator[float, None, Half]:
    """Draw a unit-modulus half plane, yielding the share that is done."""
    height, width = size
    columns = width // 2 + 1
    phase = np.empty((height, columns), np.complex64)
    for rows in row_blocks((height, columns), BLOCK):
        angle = generator.random((rows.stop - rows.start, columns), dtype=np.float32)
        angle *= np.float32(2 * np.pi)
        np.cos(angle, out=phase[rows].real)
        np.sin(angle, out=phase[rows].imag)
        yield rows.stop / height
    make_hermitian(phase, width)
    return phase


def make_hermitian(phase: Half, width: int) -> None:
    """Give the columns u = 0 and u = 1/2 of a unit-modulus half plane the symmetry of a real image, in place."""
    height = phase.shape[0]
    for column in self_conjugate_columns(width):
        half = (height + 1) // 2
        phase[height - half + 1 :, column] = np.conj(phase[half - 1 : 0 : -1, column])
        for row in {0, height // 2} if height % 2 == 0 else {0}:
            phase[row, column] = 1 if phase[row, column].real >= 0 else -1
    phase[0, 0] = 1


def self_conjugate_columns(width: int) -> tuple[int, ...]:
    """Return the columns of a half plane that are their own mirror images."""
    return (0, width // 2) if width % 2 == 0 else (0,)


def column_weights(width: int) -> NDArray[np.float32]:
    """Return how often each column of a half plane counts in a sum over the whole plane: 1 or 2."""
    weights = np.full(width // 2 + 1, 2, np.float32)
    weights[list(self_conjugate_columns(width))] = 1
    return weights


def mean_square(half: Half, width: int) -> float:
    """Return the mean square of the image whose ``rfft2`` is given (Parseval)."""
    total = 0.0
    weights = column_weights(width)
    for rows in row_blocks(half.shape, BLOCK):
        part = half[rows]
        total += float(np.sum((part.real**2 + part.imag**2) @ weights, dtype=np.float64))
    return total / float(half.shape[0] * width) ** 2
