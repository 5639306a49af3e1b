"""What the tests of the spectral methods share."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.progress import Progress
from texlab_core.engine.streams import Streams
from texlab_core.methods.spectral.analysis import analyze_plane
from texlab_core.methods.spectral.fourier import random_phase
from texlab_core.methods.spectral.marginal import Histogram16
from texlab_core.methods.spectral.synthesis import Design, design, synthesize_plane
from texlab_core.methods.spectral.tone import Tone
from texlab_core.transforms.gabor_bank import CENTRES_U, CENTRES_V, CHANNELS, WIDTHS
from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.methods.spectral.code import MsgCode

ANY = Progress(dict.fromkeys("abcdefgh", 1.0))
FLAT = Tone(Histogram16("blocks", (1 / 16,) * 16))


def analyzed(plane: NDArray[Any], measure: Any = "participation") -> MsgCode:
    """Return the code of a plane in gray levels."""
    return finish(analyze_plane(plane.astype(np.float32), FLAT, measure, ANY, "a", "b"))


def synthesized(
    code: MsgCode, size: tuple[int, int], *, seed: int = 0, phase: Any = "one", equations: Any = "corrected"
) -> tuple[Design, NDArray[np.float32]]:
    """Return the design and the plane before the histogram step."""
    plan = design(code, size, equations)
    return plan, finish(synthesize_plane(code, plan, size, Streams(seed), phase, ANY, ("a", "b", "c")))


def white(size: tuple[int, int], deviation: float, seed: int = 0) -> NDArray[np.float32]:
    """Return noise whose modulus is the same at every frequency but zero, where it is 0."""
    half = finish(random_phase(size, Streams(seed), ANY, "a"))
    half[0, 0] = 0
    plane = np.fft.irfft2(half, size) * deviation * np.sqrt(size[0] * size[1])
    return (plane + 128).astype(np.float32)


def sinusoid(size: tuple[int, int], u: float, v: float, amplitude: float = 40.0) -> NDArray[np.float32]:
    """Return a wave about gray level 128."""
    y, x = np.indices(size)
    return (128 + amplitude * np.cos(2 * np.pi * (u * x + v * y) + 0.3)).astype(np.float32)


def texture(size: tuple[int, int], seed: int = 1) -> NDArray[np.float32]:
    """Return a smooth, oriented, slightly periodic random plane in gray levels."""
    rng = np.random.Generator(np.random.PCG64(seed))
    v, u = np.fft.fftfreq(size[0])[:, None], np.fft.fftfreq(size[1])
    gain = 1 / (0.02 + np.hypot(u, 1.7 * v + 0.4 * u)) + 60 * np.exp(-((np.abs(u) - 0.11) ** 2 + v**2) / 2e-4)
    plane = np.fft.ifft2(np.fft.fft2(rng.standard_normal(size)) * gain).real
    return (128 + 35 * plane / plane.std()).astype(np.float32)


def full_plane_features(plane: NDArray[Any], measure: str) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Return energies and bandwidths by the definition: every filter over the whole plane, in float64."""
    height, width = plane.shape
    power = np.abs(np.fft.fft2(plane.astype(np.float64) - plane.mean(dtype=np.float64))) ** 2
    v, u = np.fft.fftfreq(height)[:, None], np.fft.fftfreq(width)[None, :]
    energies, bands_u, bands_v = np.empty(CHANNELS), np.empty(CHANNELS), np.empty(CHANNELS)
    for n in range(CHANNELS):
        du, dv = (d - np.round(d) for d in (u - CENTRES_U[n], v - CENTRES_V[n]))
        passed = power * np.exp(-np.pi * (du**2 + dv**2) / WIDTHS[n] ** 2) ** 2
        energies[n] = 2 * passed.sum() / plane.size**2
        for axis, bands, count in ((0, bands_u, width), (1, bands_v, height)):
            marginal = passed.sum(axis=axis)
            if measure == "paper":
                bands[n] = marginal.sum() / marginal.max() / count
            else:
                bands[n] = marginal.sum() ** 2 / (np.sqrt(2) * (marginal**2).sum()) / count
    return energies, bands_u, bands_v
