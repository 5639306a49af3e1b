"""Statistics of volumes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

# Radii that are looked at, in cycles per voxel: below there are few frequencies, above there is no whole shell.
LOWEST, HIGHEST = 1 / 16, 1 / 2


def streaks(volume: NDArray[Any]) -> float:
    """Return how much more power lies beside the axes of the spectrum than elsewhere at the same radius.

    Streaks along the axes (what is coarse within a slice and changes from slice to slice) put power within one
    frequency of an axis. About 1 says that the axes are not special; the frequencies on the axes themselves are
    left out, since they are the means of the slices.

    Parameters
    ----------
    volume
        (D, H, W), taken as periodic.

    Returns
    -------
    float
        Mean over the axes of (mean power beside the axis) / (mean power of the shells), 0 for a constant volume.
    """
    from scipy import fft

    values = np.asarray(volume, np.float64)
    power = np.abs(fft.fftn(values - values.mean())) ** 2
    steps = np.meshgrid(*(np.fft.fftfreq(side, 1 / side) for side in power.shape), indexing="ij", sparse=True)
    radius = np.sqrt(sum((step / side) ** 2 for step, side in zip(steps, power.shape, strict=True)))
    shell = np.rint(radius * min(power.shape)).astype(np.intp).ravel()
    mean = np.bincount(shell, power.ravel()) / np.maximum(np.bincount(shell), 1)
    expected = mean[shell].reshape(power.shape)
    looked_at = (radius > LOWEST) & (radius < HIGHEST) & (expected > 0)
    shares = []
    for axis in range(3):
        first, second = (np.abs(steps[other]) for other in range(3) if other != axis)
        beside = looked_at & (np.maximum(first, second) == 1)
        if beside.any():
            shares.append(float((power[beside] / expected[beside]).mean()))
    return float(np.mean(shares)) if shares else 0.0
