"""From an MSG code to a plane of texture of any size, tileable by construction.

Reference: Navarro & Portilla 1996, section 3.2, eqs. 5 to 12, with eqs. 6 and 10 corrected.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from texlab_core.methods.spectral.fourier import Floats, Half, Plane, draw_phase, inverse, random_phase
from texlab_core.methods.spectral.radial import RadialLobes
from texlab_core.transforms.gabor_bank import (
    CENTRES_U,
    CENTRES_V,
    CHANNELS,
    WIDTHS,
    channel_profiles,
    frequencies,
    mirrored,
    power_profile,
    residual_reach,
)
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.engine.progress import Progress
    from texlab_core.engine.steps import Step
    from texlab_core.engine.streams import Streams
    from texlab_core.methods.spectral.choices import Equations, PhaseChoice
    from texlab_core.methods.spectral.code import MsgCode, Residual

Size: TypeAlias = tuple[int, int]
# Share of a lobe's peak below which its rows are left out.
_NEGLIGIBLE = 1e-12


@dataclass(frozen=True, eq=False)
class Design:
    """The synthetic channels of a code on an output grid.

    Parameters
    ----------
    bandwidths_u, bandwidths_v
        (16,) synthesis bandwidths b, in cycles per pixel.
    energies
        (16,) mean squares of the synthetic channels, in squared gray levels.
    gains
        (16,) squared amplitudes c^2 of the unit-peak Gaussians in the Fourier plane.
    achieved
        (16,) energies that the analysis of the result finds before the histogram step.
    error
        Sum of the energies' errors over the sum of the coded energies.
    clipped
        The exact solution had negative energies, so that the nearest non-negative one was taken.
    imaginary
        How many synthesis bandwidths have no real solution.
    lobes
        The channels as products of profiles, or as Gaussians along and across their waves.
    """

    bandwidths_u: Floats
    bandwidths_v: Floats
    energies: Floats
    gains: Floats
    achieved: Floats
    error: float
    clipped: bool
    imaginary: int
    lobes: Lobes | RadialLobes


def synthesis_bandwidths(measured: Floats, equations: Equations = "corrected") -> tuple[Floats, NDArray[np.bool_]]:
    """Return the bandwidths b of the synthetic channels, and where the equation has no real solution.

    Filtering multiplies spectra, so that 1 / b^2 = 1 / (2 A^2) - 1 / a^2; at most 2 a. The printed eq. 6,
    b^2 = 2 A^2 - a^2, adds squares of bandwidths as if spectra were convolved.
    """
    square = 2 * np.square(measured)
    if equations == "printed":
        printed = square - np.square(WIDTHS)
        return np.sqrt(np.maximum(printed, 0)), printed < 0
    wide = square >= np.square(WIDTHS)
    reciprocal = np.where(wide, 1, 1 / square - 1 / np.square(WIDTHS))
    found = np.where(wide, np.inf, 1 / np.sqrt(np.maximum(reciprocal, 1e-30)))
    return np.minimum(found, 2 * WIDTHS), np.zeros(CHANNELS, bool)


def closed_form_overlap(bandwidths_u: Floats, bandwidths_v: Floats) -> Floats:
    """Return R in the continuum: the share of synthetic channel m's energy that Gabor filter n passes, (16, 16).

    Reference: Navarro & Portilla 1996, eq. 9, solved; eq. 10 is the same with eq. 6 put in.
    """
    square = np.square(WIDTHS)[:, None]
    wide_u, wide_v = square + np.square(bandwidths_u), square + np.square(bandwidths_v)
    total: Floats = np.zeros((CHANNELS, CHANNELS))
    for sign in (1, -1):
        du, dv = (each[:, None] - sign * each for each in (CENTRES_U, CENTRES_V))
        total += np.exp(-2 * np.pi * (du**2 / wide_u + dv**2 / wide_v))
    overlap: Floats = square / np.sqrt(wide_u * wide_v) * total
    return overlap


class Lobes:
    """The squared Gaussians of the synthetic channels as products of profiles on an output grid.

    Parameters
    ----------
    bandwidths_u, bandwidths_v
        (16,) in cycles per pixel.
    size
        Height and width of the output.
    """

    def __init__(self, bandwidths_u: Floats, bandwidths_v: Floats, size: Size) -> None:
        self.size = size
        height, width = size
        self.u = power_profile(frequencies(width), CENTRES_U, bandwidths_u)
        self.v = power_profile(frequencies(height), CENTRES_V, bandwidths_v)

    def energies(self) -> Floats:
        """Return the mean squares of the channels for unit amplitude; both lobes count."""
        height, width = self.size
        energies: Floats = 2 * self.u.sum(axis=1) * self.v.sum(axis=1) / (height * width) ** 2
        return energies

    def overlap(self) -> Floats:
        """Return the energy (16, 16) each filter passes of each channel of unit amplitude, less the residual."""
        from texlab_core.kernels.gabor import overlaps

        height, width = self.size
        gain_u, gain_v = channel_profiles(width, vertical=False), channel_profiles(height, vertical=True)
        low_u, low_v = (_low(frequencies_count) for frequencies_count in (width, height))
        total: Floats = np.zeros((CHANNELS, CHANNELS))
        for u, v in ((self.u, self.v), (mirrored(self.u), mirrored(self.v))):
            total += overlaps(gain_u, u) * overlaps(gain_v, v)
            # The low-pass residual is written over the channels.
            total -= overlaps(gain_u[:, low_u], u[:, low_u]) * overlaps(gain_v[:, low_v], v[:, low_v])
        return 2 * total / (height * width) ** 2

    def half_plane(self) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        """Return (H, 32) and (32, W // 2 + 1) float32 factors of both lobes on the half plane."""
        columns = self.size[1] // 2 + 1
        v = np.concatenate([self.v, mirrored(self.v)]).T
        u = np.concatenate([self.u[:, :columns], mirrored(self.u)[:, :columns]])
        return v.astype(np.float32), u.astype(np.float32)


def design(code: MsgCode, size: Size, equations: Equations = "corrected") -> Design:
    """Choose bandwidths and energies of the synthetic channels so that their analysis gives the code back.

    The overlap R and the channels' energies are sums over the output grid: the closed form is off by up to 78 %
    for bandwidths near one sample of the spectrum.
    """
    found = [synthesis_bandwidths(np.array(each), equations) for each in (code.bandwidths_u, code.bandwidths_v)]
    imaginary = int(sum(wrong.sum() for _, wrong in found))
    height, width = size
    # Nothing can be narrower than one sample of the spectrum.
    bandwidths_u, bandwidths_v = (np.maximum(b, 1 / n) for (b, _), n in zip(found, (width, height), strict=True))
    lobes = Lobes(bandwidths_u, bandwidths_v, size)
    printed = _printed_overlap(code) if equations == "printed" else None
    return _plan(code, size, lobes, (bandwidths_u, bandwidths_v), imaginary, printed)


def design_radial(code: MsgCode, size: Size) -> Generator[float, None, Design]:
    """Do :func:`design` for a code whose bandwidths are radial and angular, yielding fractions."""
    found = [synthesis_bandwidths(np.array(each))[0] for each in (code.bandwidths_u, code.bandwidths_v)]
    # Nothing can be narrower than one sample of the spectrum, in whatever direction.
    radial, angular = (np.maximum(each, 1 / min(size)) for each in found)
    lobes = RadialLobes(radial, angular, size)
    yield from lobes.measured()
    return _plan(code, size, lobes, (radial, angular), 0, None)


def _plan(
    code: MsgCode,
    size: Size,
    lobes: Lobes | RadialLobes,
    bandwidths: tuple[Floats, Floats],
    imaginary: int,
    printed: Floats | None,
) -> Design:
    """Solve for the energies, with the overlaps on the grid or as printed."""
    wanted = np.array(code.energies)
    unit = lobes.energies()
    residual = residual_energies(code.residual, size)
    overlap = lobes.overlap() / unit
    solved, clipped = _solve(overlap, wanted - residual) if printed is None else _solve(printed, wanted)
    achieved = overlap @ solved + residual
    total = float(wanted.sum())
    error = float(np.abs(achieved - wanted).sum() / total) if total > 0 else 0.0
    return Design(
        *bandwidths,
        solved,
        solved / unit,
        achieved,
        error,
        clipped=clipped,
        imaginary=imaginary,
        lobes=lobes,
    )


def _printed_overlap(code: MsgCode) -> Floats:
    """Return R as printed in eq. 10."""
    width_u, width_v = (np.array(each)[:, None] for each in (code.bandwidths_u, code.bandwidths_v))
    du, dv = (each[:, None] - each for each in (CENTRES_U, CENTRES_V))
    shape = np.exp(-np.pi * ((du / width_u) ** 2 + (dv / width_v) ** 2))
    overlap: Floats = np.square(WIDTHS)[:, None] / (2 * width_u * width_v) * shape
    return overlap


def _solve(matrix: Floats, wanted: Floats) -> tuple[Floats, bool]:
    """Return the non-negative solution, and whether that constraint was active."""
    try:
        exact = np.asarray(np.linalg.solve(matrix, wanted), np.float64)
    except np.linalg.LinAlgError:
        exact = np.full(CHANNELS, -1.0)
    if np.isfinite(exact).all() and (exact >= 0).all():
        return exact, False
    from scipy.optimize import nnls

    return nnls(matrix, wanted)[0], True


def _low(count: int) -> NDArray[np.intp]:
    """Return the indices of the low-pass residual on an axis in FFT order."""
    return np.arange(-residual_reach(count), residual_reach(count) + 1)


def residual_modulus(residual: Residual, size: Size) -> Floats:
    """Return the moduli / sqrt(pixels) of the low-pass residual, indices from -reach to reach, 0 at DC."""
    reach_v, reach_u = (len(_low(count)) // 2 for count in size)
    modulus = np.empty((2 * reach_v + 1, 2 * reach_u + 1))
    modulus[:reach_v, :reach_u] = modulus[reach_v + 1 :, reach_u + 1 :] = residual.falling
    modulus[:reach_v, reach_u + 1 :] = modulus[reach_v + 1 :, :reach_u] = residual.rising
    modulus[:, reach_u] = residual.v_axis
    modulus[reach_v, :] = residual.u_axis
    modulus[reach_v, reach_u] = 0
    return modulus


def residual_energies(residual: Residual, size: Size) -> Floats:
    """Return what the low-pass residual adds to the energy of each Gabor channel, (16,)."""
    height, width = size
    gain_u = channel_profiles(width, vertical=False)[:, _low(width)]
    gain_v = channel_profiles(height, vertical=True)[:, _low(height)]
    power = np.square(residual_modulus(residual, size))
    energies: Floats = 2 * np.einsum("nv,vu,nu->n", gain_v, power, gain_u) / (height * width)
    return energies


def synthesize_plane(
    code: MsgCode,
    plan: Design,
    size: Size,
    streams: Streams,
    phase: PhaseChoice,
    progress: Progress,
    names: tuple[str, str, str] = ("phase", "channels", "transform"),
) -> Generator[Step, None, Plane]:
    """Return a plane of texture in gray levels, (H, W) float32, before the histogram step."""
    noise, mixing, transform = names
    lobes = plan.lobes
    if isinstance(lobes, RadialLobes):
        half = yield from _radial_noise(lobes, plan.gains, streams, phase, progress, (noise, mixing))
    elif phase == "one":
        half = yield from random_phase(size, streams, progress, noise)
        yield from _shape(half, lobes, plan.gains, progress, mixing)
    else:
        half = yield from _sixteen_noises(lobes, plan.gains, streams, progress, noise)
    _write_residual(half, code.residual, size)
    yield progress.at(mixing)
    plane = yield from inverse(half, size, progress, transform)
    return plane


def _shape(half: Half, lobes: Lobes, gains: Floats, progress: Progress, stage: str) -> Generator[Step, None, None]:
    """Multiply a unit-modulus half plane by the root of the channels' summed power."""
    from texlab_core.kernels import gabor

    factor_v, factor_u = lobes.half_plane()
    factor_u *= np.tile(gains, 2).astype(np.float32)[:, None]
    for rows in _rows(half):
        gabor.shape(half[rows], rows.start, factor_v, factor_u, _NEGLIGIBLE)
        yield progress.at(stage, rows.stop / half.shape[0])


def _radial_noise(
    lobes: RadialLobes,
    gains: Floats,
    streams: Streams,
    phase: PhaseChoice,
    progress: Progress,
    names: tuple[str, str],
) -> Generator[Step, None, Half]:
    """Return one noise, or sixteen, through channels whose axes follow their waves."""
    noise, mixing = names
    if phase == "one":
        half = yield from random_phase(lobes.size, streams, progress, noise)
        yield from progress.follow(lobes.shaped(half, gains), mixing)
        return half
    height, width = lobes.size
    total = np.zeros((height, width // 2 + 1), np.complex64)
    for channel in range(CHANNELS):
        low, high = channel / CHANNELS, (channel + 0.5) / CHANNELS
        drawing = draw_phase(lobes.size, streams("phase", channel + 1))
        half = yield from progress.follow(drawing, noise, low, high)
        part = lobes.filtered(half, channel, gains[channel])
        yield from progress.follow(part, noise, high, (channel + 1) / CHANNELS)
        for rows in _rows(half):
            total[rows] += half[rows]
            yield progress.at(noise, (channel + 1) / CHANNELS)
    return total


def _sixteen_noises(
    lobes: Lobes, gains: Floats, streams: Streams, progress: Progress, stage: str
) -> Generator[Step, None, Half]:
    """Return the sum of sixteen independent noises of constant modulus, each through its own channel (Fig. 3)."""
    height, width = lobes.size
    total = np.zeros((height, width // 2 + 1), np.complex64)
    factor_v, factor_u = (np.sqrt(each) for each in lobes.half_plane())
    for channel in range(CHANNELS):
        drawing = draw_phase(lobes.size, streams("phase", channel + 1))
        half = yield from progress.follow(drawing, stage, channel / CHANNELS, (channel + 0.5) / CHANNELS)
        amplitude = np.float32(math.sqrt(gains[channel]))
        for rows in _rows(half):
            for lobe in (channel, channel + CHANNELS):
                gain = np.multiply.outer(factor_v[rows, lobe] * amplitude, factor_u[lobe])
                total[rows] += half[rows] * gain
            yield progress.at(stage, (channel + 0.5 + 0.5 * rows.stop / height) / CHANNELS)
    return total


def _write_residual(half: Half, residual: Residual, size: Size) -> None:
    """Replace the lowest frequencies' moduli by the coded ones, keeping the phase of the sum (section 3.2.3)."""
    height, width = size
    rows, columns = _low(height), _low(width)
    reach = len(columns) // 2
    modulus = residual_modulus(residual, size)[:, reach:] * math.sqrt(height * width)
    old = half[rows, : reach + 1]
    length = np.abs(old)
    half[rows, : reach + 1] = np.where(length > 0, old / np.where(length > 0, length, 1), 1) * modulus
    half[0, 0] = residual.mean * height * width


def _rows(half: Half) -> list[slice]:
    return row_blocks((half.shape[0], half.shape[1]), 2**18)
