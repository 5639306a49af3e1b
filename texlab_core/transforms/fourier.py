"""Fourier tools for images that are taken as periodic though they are not."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.threads import workers

if TYPE_CHECKING:
    from numpy.typing import NDArray


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
    spectrum = fft.rfft2(jumps, workers=workers()) / laplacian
    spectrum[0, 0] = 0
    smooth = fft.irfft2(spectrum, s=values.shape, workers=workers())
    # The periodic Laplacian of the smooth part is the jumps: that of the rest sees no border.
    periodic: NDArray[Any] = (values - smooth).astype(image.dtype)
    return periodic
