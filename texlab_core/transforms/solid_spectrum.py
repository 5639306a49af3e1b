"""Fourier transform of a real volume, in pieces of a few slices; half of the spectrum along the last axis."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from texlab_core.work.tasks import Task

# Samples of one batch of transforms: a few milliseconds.
BATCH = 2**17


def forward(volume: NDArray[np.float32]) -> Task[NDArray[Any]]:
    """Return the spectrum of a volume.

    Parameters
    ----------
    volume
        (D, H, W) float32.

    Returns
    -------
    ndarray
        (D, H, W // 2 + 1) complex64, divided by the number of samples: at frequency 0 lies the mean.
    """
    from scipy import fft

    depth, height, width = volume.shape
    spectrum = np.empty((depth, height, width // 2 + 1), np.complex64)
    for block in row_blocks(volume.shape, BATCH):
        spectrum[block] = fft.rfft2(volume[block], norm="forward")
        yield volume[block].size
    for rows in _row_blocks(spectrum):
        spectrum[:, rows] = fft.fft(spectrum[:, rows], axis=0, norm="forward")
        yield spectrum[:, rows].size
    return spectrum


def inverse(spectrum: NDArray[Any], shape: Sequence[int]) -> Task[NDArray[np.float32]]:
    """Return the volume (D, H, W) float32 of a spectrum of :func:`forward`, which is overwritten."""
    from scipy import fft

    volume = np.empty(tuple(shape), np.float32)
    for rows in _row_blocks(spectrum):
        spectrum[:, rows] = fft.ifft(spectrum[:, rows], axis=0, norm="forward")
        yield spectrum[:, rows].size
    for block in row_blocks(volume.shape, BATCH):
        volume[block] = fft.irfft2(spectrum[block], s=volume.shape[1:], norm="forward", overwrite_x=True)
        yield volume[block].size
    return volume


def _row_blocks(spectrum: NDArray[Any]) -> list[slice]:
    """Return blocks along the second axis."""
    depth, height, half = spectrum.shape
    return list(row_blocks((height, depth, half), BATCH))
