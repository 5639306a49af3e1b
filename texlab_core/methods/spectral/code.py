"""The MSG code: a texture in exactly 69 numbers (113 in colour).

Reference: Navarro & Portilla 1996, table 1 and section 3.1.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Self, TypeAlias, get_args

import numpy as np

from texlab_core.methods.spectral.choices import BandwidthAxes, BandwidthMeasure
from texlab_core.methods.spectral.digits import keep_digits
from texlab_core.transforms.gabor_bank import CHANNELS, OCTAVES, ORIENTATIONS, WHITE_BANDWIDTHS, WIDTHS

if TYPE_CHECKING:
    from texlab_core.methods.spectral.fourier import Floats
    from texlab_core.methods.spectral.tone import Tone

BANDWIDTH_MEASURES = get_args(BandwidthMeasure)
BANDWIDTH_AXES = get_args(BandwidthAxes)

# 16 numbers, channel n = 4 p + q.
Channels: TypeAlias = tuple[float, ...]

# Quantized bandwidths, as a share of the filter's width: the narrowest and the widest level.
_NARROWEST = 1 / 64
_WIDEST = float(WHITE_BANDWIDTHS[0] / WIDTHS[0])


@dataclass(frozen=True)
class Residual:
    """The low-pass residual in 5 numbers (Fig. 4b), in gray levels.

    Parameters
    ----------
    mean
        Mean gray level.
    u_axis, v_axis
        Mean modulus / sqrt(pixels) of the frequencies on the horizontal and on the vertical axis.
    falling, rising
        The same off the axes: u and v of the same sign (the wave vector points down right), and of opposite
        signs.
    """

    mean: float
    u_axis: float
    v_axis: float
    falling: float
    rising: float


@dataclass(frozen=True)
class MsgCode:
    """A texture as numbers, from which any amount of it can be synthesized.

    Parameters
    ----------
    energies
        Mean square of each Gabor channel, in squared gray levels; rows of 4 orientations (0, 45, 90, 135 degrees),
        lowest frequency first.
    bandwidths_u, bandwidths_v
        Equivalent bandwidths of each channel along both axes, in cycles per pixel (eq. 4); where ``axes`` is
        ``radial``, along and across the direction of its waves.
    measure
        How the bandwidths were measured.
    residual
        The low-pass residual.
    tone
        The histogram, and the colours if there are any.
    axes
        Which axes the bandwidths belong to.
    """

    energies: Channels
    bandwidths_u: Channels
    bandwidths_v: Channels
    measure: BandwidthMeasure
    residual: Residual
    tone: Tone
    axes: BandwidthAxes = "uv"

    @property
    def parameters(self) -> int:
        """How many numbers it consists of: 69, or 113 in colour."""
        return 3 * CHANNELS + 5 + self.tone.parameters

    def energy_table(self) -> Floats:
        """Return the (4, 4) energies: octaves (lowest first) by orientations."""
        return np.array(self.energies).reshape(OCTAVES, ORIENTATIONS)

    def rms_table(self) -> Floats:
        """Return the (4, 4) rms values of the channels as percentages of the mean gray level.

        Reference: Navarro & Portilla 1996, table 2 ("normalized with respect to their mean value").
        """
        return 100 * np.sqrt(self.energy_table()) / max(self.residual.mean, 1e-9)

    def quantized(self, levels: int) -> Self:
        """Return the code with every bandwidth at the nearest of a few levels; see :func:`quantize`."""
        u, v = (quantize(np.array(each), levels) for each in (self.bandwidths_u, self.bandwidths_v))
        return replace(self, bandwidths_u=channels(u), bandwidths_v=channels(v))


def channels(values: Floats) -> Channels:
    """Return 16 numbers as a code holds them."""
    return keep_digits(values.reshape(CHANNELS))


def quantize(bandwidths: Floats, levels: int) -> Floats:
    """Return bandwidths at the nearest of 2 .. 16 levels, even in logarithm, 1/64 .. 1/sqrt(2) of the filters."""
    low, high = np.log(_NARROWEST), np.log(_WIDEST)
    place = (np.log(np.maximum(bandwidths / WIDTHS, _NARROWEST)) - low) / (high - low)
    index = np.clip(np.rint(place * (levels - 1)), 0, levels - 1)
    quantized: Floats = np.exp(low + (high - low) * index / (levels - 1)) * WIDTHS
    return quantized
