"""Fourier transforms of planes, in pieces when they are large, and the periodic part of an image."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.work.tasks import finish, row_blocks
from texlab_core.work.threads import workers

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from texlab_core.work.tasks import Task

# A transform of so many samples takes about 10 ms; a larger one is cut into rows, then columns.
LARGE = 2**21
# Below this, more than one thread is slower.
SMALL = 2**18


def rfft2(plane: NDArray[Any]) -> Task[NDArray[Any]]:
    """Return the half spectrum (H, W // 2 + 1) of a plane, scaled so that its first entry is the mean."""
    from scipy import fft

    if plane.size <= LARGE:
        yield plane.size
        return fft.rfft2(plane, norm="forward", workers=_threads(plane.size))
    height, width = plane.shape
    spectrum = np.empty((height, width // 2 + 1), np.result_type(plane.dtype, np.complex64))
    for rows in row_blocks(plane.shape):
        spectrum[rows] = fft.rfft(plane[rows], axis=1, norm="forward", workers=workers())
        yield plane[rows].size
    for columns in row_blocks(spectrum.shape[::-1]):
        spectrum[:, columns] = fft.fft(spectrum[:, columns], axis=0, norm="forward", workers=workers())
        yield spectrum[:, columns].size
    return spectrum


def irfft2(spectrum: NDArray[Any], size: Sequence[int]) -> Task[NDArray[Any]]:
    """Return the plane (H, W) of a half spectrum, which is overwritten."""
    from scipy import fft

    height, width = size
    samples = height * width
    if samples <= LARGE:
        yield samples
        return fft.irfft2(spectrum, s=(height, width), norm="forward", workers=_threads(samples), overwrite_x=True)
    for columns in row_blocks(spectrum.shape[::-1]):
        spectrum[:, columns] = fft.ifft(spectrum[:, columns], axis=0, norm="forward", workers=workers())
        yield spectrum[:, columns].size
    plane = np.empty((height, width), spectrum.real.dtype)
    for rows in row_blocks(plane.shape):
        plane[rows] = fft.irfft(spectrum[rows], n=width, axis=1, norm="forward", workers=workers())
        yield plane[rows].size
    return plane


def fft2(plane: NDArray[Any]) -> Task[NDArray[Any]]:
    """Return the whole spectrum (H, W) of a plane, not scaled."""
    from scipy import fft

    if plane.size <= LARGE:
        yield plane.size
        return fft.fft2(plane, workers=_threads(plane.size))
    spectrum = np.empty(plane.shape, np.result_type(plane.dtype, np.complex64))
    for rows in row_blocks(plane.shape):
        spectrum[rows] = fft.fft(plane[rows], axis=1, workers=workers())
        yield plane[rows].size
    for columns in row_blocks(plane.shape[::-1]):
        spectrum[:, columns] = fft.fft(spectrum[:, columns], axis=0, workers=workers())
        yield spectrum[:, columns].size
    return spectrum


def ifft2(spectrum: NDArray[Any]) -> Task[NDArray[Any]]:
    """Return the complex plane of a whole spectrum, which is overwritten."""
    from scipy import fft

    if spectrum.size <= LARGE:
        yield spectrum.size
        return fft.ifft2(spectrum, overwrite_x=True, workers=_threads(spectrum.size))
    for columns in row_blocks(spectrum.shape[::-1]):
        spectrum[:, columns] = fft.ifft(spectrum[:, columns], axis=0, workers=workers())
        yield spectrum[:, columns].size
    for rows in row_blocks(spectrum.shape):
        spectrum[rows] = fft.ifft(spectrum[rows], axis=1, workers=workers())
        yield spectrum[rows].size
    return spectrum


def _threads(samples: int) -> int:
    return workers() if samples >= SMALL else 1


def periodic_component(image: NDArray[Any]) -> NDArray[Any]:
    """Return the periodic part of an image: without the smooth image that explains the jumps at its borders.

    Parameters
    ----------
    image
        (H, W) float32 or float64.

    Returns
    -------
    ndarray
        (H, W) of the same type and mean. An image without jumps between opposite borders is returned as it is.

    Reference: Moisan 2011, "Periodic plus smooth image decomposition", equations 10 and 11.
    """
    return finish(periodic_component_task(image))


def periodic_component_task(image: NDArray[Any]) -> Task[NDArray[Any]]:
    """Do :func:`periodic_component` in pieces."""
    from scipy import fft

    values = image.astype(np.float64)
    jumps = np.zeros_like(values)
    across, down = values[-1] - values[0], values[:, -1] - values[:, 0]
    jumps[0] += across
    jumps[-1] -= across
    jumps[:, 0] += down
    jumps[:, -1] -= down
    height, width = values.shape
    rows = 2 * np.cos(2 * np.pi * np.arange(height) / height)[:, None]
    columns = 2 * np.cos(2 * np.pi * np.arange(width // 2 + 1) / width)[None, :]
    laplacian = rows + columns - 4
    laplacian[0, 0] = 1
    yield image.size
    spectrum = fft.rfft2(jumps, workers=workers())
    yield image.size
    spectrum /= laplacian
    spectrum[0, 0] = 0
    yield image.size
    smooth = fft.irfft2(spectrum, s=values.shape, workers=workers())
    yield image.size
    # The periodic Laplacian of the smooth part is the jumps: that of the rest sees no border.
    periodic: NDArray[Any] = (values - smooth).astype(image.dtype)
    return periodic
