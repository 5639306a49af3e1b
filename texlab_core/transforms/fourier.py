"""Fourier transforms of planes, in pieces when they are large, and the periodic part of an image."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from texlab_core.work.tasks import finish, row_blocks
from texlab_core.work.threads import workers

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from numpy.typing import NDArray

    from texlab_core.work.tasks import Task

Norm = Literal["forward", "backward"]

# A transform of so many samples takes about 10 ms; a larger one is cut into rows, then columns.
LARGE = 2**21
# Below this, more than one thread is slower.
SMALL = 2**18


def rfft2(plane: NDArray[Any], norm: Norm = "forward", large: int | None = None) -> Task[NDArray[Any]]:
    """Return the half spectrum (H, W // 2 + 1) of a plane; scaled forward, its first entry is the mean.

    Planes of more than ``large`` samples (None: ``LARGE``) are cut; the last bit of a value may depend on that.
    """
    from scipy import fft

    if plane.size <= (LARGE if large is None else large):
        yield plane.size
        return fft.rfft2(plane, norm=norm, workers=_threads(plane.size))
    height, width = plane.shape
    spectrum = np.empty((height, width // 2 + 1), np.result_type(plane.dtype, np.complex64))
    for rows in row_blocks(plane.shape):
        spectrum[rows] = fft.rfft(plane[rows], axis=1, norm=norm, workers=workers())
        yield plane[rows].size
    for columns in row_blocks(spectrum.shape[::-1]):
        spectrum[:, columns] = fft.fft(spectrum[:, columns], axis=0, norm=norm, workers=workers())
        yield spectrum[:, columns].size
    return spectrum


def irfft2(
    spectrum: NDArray[Any], size: Sequence[int], norm: Norm = "forward", large: int | None = None
) -> Task[NDArray[Any]]:
    """Return the plane (H, W) of a half spectrum that was scaled likewise and is overwritten."""
    from scipy import fft

    height, width = size
    samples = height * width
    if samples <= (LARGE if large is None else large):
        yield samples
        return fft.irfft2(spectrum, s=(height, width), norm=norm, workers=_threads(samples), overwrite_x=True)
    for columns in row_blocks(spectrum.shape[::-1]):
        spectrum[:, columns] = fft.ifft(spectrum[:, columns], axis=0, norm=norm, workers=workers())
        yield spectrum[:, columns].size
    plane = np.empty((height, width), spectrum.real.dtype)
    for rows in row_blocks(plane.shape):
        plane[rows] = fft.irfft(spectrum[rows], n=width, axis=1, norm=norm, workers=workers())
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
        (H, W) or (H, W, C), float32 or float64; channels are taken one by one.

    Returns
    -------
    ndarray
        The same shape, type and mean. An image without jumps between opposite borders is returned as it is.

    Reference: Moisan 2011, "Periodic plus smooth image decomposition", equations 10 and 11.
    """
    if image.ndim == 2:
        return finish(periodic_component_task(image))
    planes = [finish(periodic_component_task(image[..., channel])) for channel in range(image.shape[2])]
    return np.ascontiguousarray(np.stack(planes, axis=2))


def periodic_component_task(image: NDArray[Any]) -> Task[NDArray[Any]]:
    """Do :func:`periodic_component` of a plane in pieces."""
    height, width = image.shape
    spectrum = np.empty((height, width // 2 + 1), np.complex128)
    for rows, part in smooth_spectrum(image):
        spectrum[rows] = part
        yield part.size
    smooth = yield from irfft2(spectrum, image.shape, "backward")
    periodic: NDArray[Any] = (image - smooth).astype(image.dtype)
    return periodic


def smooth_spectrum(plane: NDArray[Any]) -> Iterator[tuple[slice, NDArray[np.complex128]]]:
    """Yield rows of the half spectrum of a plane's smooth component, not scaled.

    Its periodic Laplacian is the jumps between opposite borders, so that of the rest sees no border. The jumps
    live on two lines: their spectrum takes one-dimensional transforms only.
    """
    height, width = plane.shape
    across = np.fft.rfft(plane[-1].astype(np.float64) - plane[0])
    down = np.fft.fft(plane[:, -1].astype(np.float64) - plane[:, 0])
    v, u = np.fft.fftfreq(height), np.arange(width // 2 + 1) / width
    step_v, step_u = 1 - np.exp(2j * np.pi * v), 1 - np.exp(2j * np.pi * u)
    for rows in row_blocks((height, u.size), 2**17):
        laplacian = 2 * np.cos(2 * np.pi * v[rows])[:, None] + 2 * np.cos(2 * np.pi * u) - 4
        if rows.start == 0:
            laplacian[0, 0] = 1
        jumps = step_v[rows, None] * across + down[rows, None] * step_u
        if rows.start == 0:
            jumps[0, 0] = 0
        yield rows, jumps / laplacian


def periodic_spectrum(plane: NDArray[np.float32]) -> Task[NDArray[np.complex64]]:
    """Return the whole spectrum (H, W) of the periodic part of a plane, not scaled: one transform serves."""
    width = plane.shape[1]
    half = yield from rfft2(np.asarray(plane, np.float32), "backward")
    for rows, part in smooth_spectrum(plane):
        half[rows] -= part
        yield part.size
    spectrum = np.empty(plane.shape, np.complex64)
    spectrum[:, : half.shape[1]] = half
    yield half.size
    # Negative frequencies mirror the positive ones through the origin.
    mirror = half[:, (width - 1) // 2 : 0 : -1]
    np.conjugate(mirror[0], out=spectrum[0, half.shape[1] :])
    np.conjugate(mirror[:0:-1], out=spectrum[1:, half.shape[1] :])
    return spectrum
