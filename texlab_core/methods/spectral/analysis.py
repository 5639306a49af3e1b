"""From a gray plane to the energies, bandwidths and residual of the MSG code.

Reference: Navarro & Portilla 1996, section 3.1, eqs. 3 and 4.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.spectral.bandwidths import equivalent_bandwidths
from texlab_core.methods.spectral.code import MsgCode, Residual, channels
from texlab_core.methods.spectral.digits import keep_digits
from texlab_core.methods.spectral.fourier import Floats, Half, Plane, forward, self_conjugate_columns
from texlab_core.transforms.gabor_bank import (
    CHANNELS,
    MIRRORED_U,
    MIRRORED_V,
    PROFILE_U,
    PROFILE_V,
    distinct_profiles,
    mirrored,
    residual_reach,
)
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Generator

    from texlab_core.engine.progress import Progress
    from texlab_core.engine.steps import Step
    from texlab_core.methods.spectral.choices import BandwidthAxes, BandwidthMeasure
    from texlab_core.methods.spectral.tone import Tone


@dataclass(frozen=True, eq=False)
class Marginals:
    """Marginal power spectra of the 16 channels, one lobe each (eq. 4), whose sums are equal.

    Parameters
    ----------
    u, v
        (16, W) and (16, H) float64 in FFT order, in squared gray levels: sums of |T G|^2 / pixels^2.
    """

    u: Floats
    v: Floats

    def energies(self) -> Floats:
        """Return the mean square of the channels; a real filter has two lobes."""
        energies: Floats = 2 * self.u.sum(axis=1)
        return energies

    def bandwidths(self, measure: BandwidthMeasure) -> tuple[Floats, Floats]:
        """Return the equivalent bandwidths along u and v, in cycles per pixel."""
        return equivalent_bandwidths(self.u, measure), equivalent_bandwidths(self.v, measure)


def analyze_plane(
    plane: Plane,
    tone: Tone,
    measure: BandwidthMeasure,
    progress: Progress,
    transform: str,
    features: str,
    axes: BandwidthAxes = "uv",
) -> Generator[Step, None, MsgCode]:
    """Return the code of a gray plane.

    Parameters
    ----------
    plane
        (H, W) float32 in gray levels.
    tone
        Its histogram and colours.
    transform, features
        Names of the two stages.
    axes
        Along which axes bandwidths are measured.
    """
    mean = float(plane.mean(dtype=np.float64))
    half = yield from forward(plane - np.float32(mean), progress, transform)
    marginals = yield from channel_marginals(half, plane.shape[1], progress, features)
    if axes == "radial":
        from texlab_core.methods.spectral.radial import radial_bandwidths

        upright = marginals.bandwidths(measure)
        u, v = yield from progress.follow(radial_bandwidths(half, plane.shape[1], upright, measure), features)
    else:
        u, v = marginals.bandwidths(measure)
    residual = residual_zones(half, plane.shape[1], mean)
    return MsgCode(channels(marginals.energies()), channels(u), channels(v), measure, residual, tone, axes)


def channel_marginals(half: Half, width: int, progress: Progress, stage: str) -> Generator[Step, None, Marginals]:
    """Return the marginal power spectra of the 16 channels from the half plane of a real image.

    Every sum over the whole plane is taken over the half plane and its mirror image, and every filter is a product
    of two profiles out of 20.
    """
    from texlab_core.kernels import gabor

    height, columns = half.shape
    profiles_v, ends_v = distinct_profiles(height)
    profiles_u, ends_u = distinct_profiles(width)
    half_u = np.ascontiguousarray(profiles_u[:, :columns])
    inner_u = half_u.copy()
    # The columns that are their own mirror images count once.
    inner_u[:, list(self_conjugate_columns(width))] = 0
    along_u, along_v = np.zeros_like(half_u), np.empty((len(half_u), height))
    for rows in row_blocks((height, columns), 2**18):
        gabor.marginals(
            half[rows], rows.start, profiles_v, inner_u, ends_v, np.minimum(ends_u, columns), along_u, along_v
        )
        yield progress.at(stage, rows.stop / height)

    u = np.empty((CHANNELS, width))
    u[:, :columns] = along_u[PROFILE_V]
    # Negative u: power(-u, v) = power(u, -v).
    u[:, columns:] = along_u[MIRRORED_V, (width - 1) // 2 : 0 : -1]
    v = along_v[PROFILE_U] + mirrored(along_v[MIRRORED_U])
    for column in self_conjugate_columns(width):
        alone = half[:, column].astype(np.complex128)
        v += half_u[PROFILE_U, column, None] * (alone.real**2 + alone.imag**2)
    scale = 1 / float(height * width) ** 2
    gain_u, gain_v = profiles_u[PROFILE_U], profiles_v[PROFILE_V]
    return Marginals(u * gain_u * scale, v * gain_v * scale)


def residual_zones(half: Half, width: int, mean: float) -> Residual:
    """Return the five numbers of the low-pass residual: |k| < n / 64 on each axis, each by its own size."""
    height = half.shape[0]
    reach_v, reach_u = residual_reach(height), residual_reach(width)
    rows = np.arange(-reach_v, reach_v + 1)
    modulus = np.abs(half[rows, : reach_u + 1].astype(np.complex128)) / math.sqrt(height * width)
    zones = (
        modulus[reach_v, 1:],
        modulus[reach_v + 1 :, 0],
        modulus[reach_v + 1 :, 1:],
        modulus[:reach_v, 1:],
    )
    return Residual(*keep_digits([mean, *(_mean(zone) for zone in zones)]))


def _mean(values: Floats) -> float:
    return float(values.mean()) if values.size else 0.0
