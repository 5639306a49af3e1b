"""The multiscale Gabor transform: 16 complex channels and a low-pass residual, whose sum is nearly the image.

Reference: Navarro & Portilla 1996, section 2.1, eqs. 1 and 2; Forsyth & Ponce, Figs. 11.9 to 11.11.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
import scipy  # scipy.fft is loaded on its first use
from numpy.typing import NDArray

from texlab_core.transforms import fourier
from texlab_core.transforms.gabor_bank import (
    CENTRE_FREQUENCIES,
    CENTRES_U,
    CENTRES_V,
    CHANNELS,
    ORIENTATIONS,
    WIDTH_RATIO,
    WIDTHS,
    frequencies,
    mirrored,
    power_profile,
)
from texlab_core.work.tasks import finish, go_on, row_blocks
from texlab_core.work.threads import workers

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

Plane: TypeAlias = NDArray[np.float32]

# The residual meets the lowest channels at half height: at 2/3 of 1/32.
RESIDUAL_HALF_HEIGHT = float(CENTRE_FREQUENCIES[0]) * 2 / 3
# Forsyth & Ponce, Fig. 11.11: stripes, and the frequency and orientation of most of them.
ZEBRA, ZEBRA_FREQUENCY, ZEBRA_ORIENTATION = "gallery:oriented-zebra", 1 / 28, 12.0
_RESIDUAL_WIDTH = RESIDUAL_HALF_HEIGHT * math.sqrt(math.pi / math.log(2))


@dataclass(frozen=True)
class Circle:
    """Where a lobe of a filter falls to half its peak, in cycles per pixel.

    Parameters
    ----------
    u, v
        Its centre: horizontal, and down the rows.
    radius
        Of the circle.
    channel
        Channel 4 p + q, or -1 for the residual.
    mirrored
        It is the lobe on the other side of the origin.
    """

    u: float
    v: float
    radius: float
    channel: int
    mirrored: bool = False


def circles() -> tuple[Circle, ...]:
    """Return the half-height circles of both lobes of all channels, and of the residual."""
    found = [Circle(0.0, 0.0, RESIDUAL_HALF_HEIGHT, -1)]
    for channel in range(CHANNELS):
        u, v = float(CENTRES_U[channel]), float(CENTRES_V[channel])
        radius = math.hypot(u, v) / 3
        found += [Circle(u, v, radius, channel), Circle(-u, -v, radius, channel, mirrored=True)]
    return tuple(found)


def filter_bank(size: tuple[int, int]) -> Plane:
    """Return the largest gain of any filter at each frequency, (H, W) float32, zero frequency in the middle."""
    height, width = size
    bank = np.outer(*_residual_profiles(size))
    for gain_v, gain_u in zip(*_profiles(size), strict=True):
        np.maximum(bank, np.outer(gain_v, gain_u), out=bank)
        np.maximum(bank, np.outer(mirrored(gain_v), mirrored(gain_u)), out=bank)
    return np.roll(bank, (height // 2, width // 2), axis=(0, 1)).astype(np.float32)


def channel_gain(channel: int, size: tuple[int, int]) -> NDArray[np.float64]:
    """Return the gain of channel 4 p + q at each frequency, both lobes, (H, W) float64 in FFT order."""
    gain_v, gain_u = (each[channel] for each in _profiles(size))
    gain: NDArray[np.float64] = np.outer(gain_v, gain_u) + np.outer(mirrored(gain_v), mirrored(gain_u))
    return gain


def residual_gain(size: tuple[int, int]) -> NDArray[np.float64]:
    """Return the gain of the low-pass residual at each frequency, (H, W) float64 in FFT order."""
    return np.asarray(np.outer(*_residual_profiles(size)), np.float64)


@dataclass(frozen=True, eq=False)
class Response:
    """What a pair of Gabor filters in quadrature answers, in the units of the image.

    Parameters
    ----------
    values
        (H, W) complex64: even (symmetric) filter + i times odd (antisymmetric) filter.
    """

    values: NDArray[np.complex64]

    @property
    def even(self) -> Plane:
        """Answer of the symmetric filter."""
        return self.values.real

    @property
    def odd(self) -> Plane:
        """Answer of the antisymmetric filter."""
        return self.values.imag

    @property
    def magnitude(self) -> Plane:
        """Local amplitude: it does not depend on where within a stripe one is."""
        magnitude: Plane = np.abs(self.values)
        return magnitude

    @property
    def phase(self) -> Plane:
        """Local phase in radians, -pi to pi: 0 on the middle of a bright stripe."""
        phase: Plane = np.angle(self.values)
        return phase


class GaborTransform:
    """The channels of one image, each computed when it is asked for.

    Parameters
    ----------
    plane
        (H, W) float32, taken as periodic. Its mean belongs to the residual alone.
    look
        Here and in the methods: called between pieces of large transforms; may raise to stop.
    """

    def __init__(self, plane: Plane, look: Callable[[], None] = go_on) -> None:
        self.plane = plane
        self.size = (plane.shape[0], plane.shape[1])
        self.mean = float(plane.mean(dtype=np.float64))
        centred = plane.astype(np.float32) - np.float32(self.mean)
        look()
        self._spectrum: NDArray[Any] = finish(fourier.fft2(centred), look)

    def channel(self, channel: int, look: Callable[[], None] = go_on) -> Response:
        """Return the answer of channel 4 p + q; its even part is what the paper's real filters give."""
        gain_v, gain_u = (each[channel] for each in _profiles(self.size))
        return self._filtered(gain_v, gain_u, look)

    def residual(self, look: Callable[[], None] = go_on) -> Plane:
        """Return the low-pass residual, mean included."""
        gain_v, gain_u = _residual_profiles(self.size)
        # One lobe at zero frequency is the whole filter.
        return 0.5 * self._filtered(gain_v, gain_u, look).even + np.float32(self.mean)

    def reconstruction(self) -> Plane:
        """Return the sum of the even channels and the residual: nearly the image."""
        gain = np.outer(*_residual_profiles(self.size))
        for gain_v, gain_u in zip(*_profiles(self.size), strict=True):
            gain += np.outer(gain_v, gain_u) + np.outer(mirrored(gain_v), mirrored(gain_u))
        filtered: NDArray[np.complex64] = scipy.fft.ifft2(
            self._spectrum * gain.astype(np.float32), workers=workers()
        )
        return filtered.real + np.float32(self.mean)

    def reconstruction_error(self) -> float:
        """Return the signal-to-noise ratio of the reconstruction of an image in [0, 1], in dB."""
        return psnr(self.reconstruction(), self.plane)

    def channels(self) -> Generator[Response, None, None]:
        """Yield all channels, lowest octave first."""
        for channel in range(CHANNELS):
            yield self.channel(channel)

    def rms_table(self) -> NDArray[np.float64]:
        """Return the (4, 4) rms values of the even channels as percentages of the image's mean (table 2)."""
        rms = [math.sqrt(float(np.square(each.even, dtype=np.float64).mean())) for each in self.channels()]
        return 100 * np.array(rms).reshape(-1, ORIENTATIONS) / max(self.mean, 1e-12)

    def _filtered(
        self, gain_v: NDArray[np.float64], gain_u: NDArray[np.float64], look: Callable[[], None]
    ) -> Response:
        product = np.empty_like(self._spectrum)
        # Twice one lobe is the analytic signal: its real part has both lobes.
        down, across = (2 * gain_v[:, None]).astype(np.float32), gain_u.astype(np.float32)
        for rows in row_blocks(product.shape):
            look()
            np.multiply(self._spectrum[rows], down[rows], out=product[rows])
            product[rows] *= across
        return Response(finish(fourier.ifft2(product), look))


def psnr(first: Plane, second: Plane) -> float:
    """Return the peak signal-to-noise ratio of images in [0, 1], in dB."""
    error = float(np.square(first.astype(np.float64) - second).mean())
    return math.inf if error == 0 else -10 * math.log10(error)


def local_frequency(plane: Plane, frequency: float, orientation: float) -> Response:
    """Return what a quadrature pair of any frequency and orientation answers: local spatial frequency analysis.

    Parameters
    ----------
    plane
        (H, W) float32, reflected at its borders.
    frequency
        In cycles per pixel, above 0 and at most 1/2; the filter falls to half at 2/3 and 4/3 of it.
    orientation
        Of the wave vector in degrees; 0 answers to vertical stripes, 90 (down the rows) to horizontal ones.

    Raises
    ------
    ValueError
        When the frequency is out of range.

    Reference: Forsyth & Ponce, section 11.2.2, Fig. 11.11.
    """
    if not 0 < frequency <= 0.5:
        raise ValueError(f"The frequency must be above 0 and at most 0.5 cycles per pixel, got {frequency:g}.")
    # Beyond 1.5 / a the kernel is below a thousandth of its peak.
    reach = math.ceil(1.5 / (WIDTH_RATIO * frequency))
    height, width = plane.shape
    top, left = (min(reach, side - 1) for side in (height, width))
    padded = np.pad(plane, ((top, top), (left, left)), mode="reflect").astype(np.float32)
    gains = []
    angle = math.radians(orientation)
    for count, centre in zip(padded.shape, (math.sin(angle), math.cos(angle)), strict=True):
        axis = frequencies(count)
        half_width = np.array([WIDTH_RATIO * frequency])
        gains.append(np.sqrt(power_profile(axis, np.array([frequency * centre]), half_width))[0])
    spectrum = scipy.fft.fft2(padded - padded.mean(dtype=np.float64).astype(np.float32), workers=workers())
    product = spectrum * (2 * np.outer(*gains)).astype(np.float32)
    values = scipy.fft.ifft2(product, workers=workers())[top : top + height, left : left + width]
    return Response(np.ascontiguousarray(values))


def kernel(frequency: float, orientation: float) -> NDArray[np.complex64]:
    """Return the quadrature pair in space, (n, n) complex64 with n odd and the origin in the middle (eq. 1)."""
    a = WIDTH_RATIO * frequency
    reach = math.ceil(1.5 / a)
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    angle = math.radians(orientation)
    wave = np.exp(2j * np.pi * frequency * (x * math.cos(angle) + y * math.sin(angle)))
    values: NDArray[np.complex64] = (a**2 * np.exp(-np.pi * a**2 * (x**2 + y**2)) * wave).astype(np.complex64)
    return values


def _profiles(size: tuple[int, int]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the (16, H) and (16, W) factors of the filters, one lobe each."""
    height, width = size
    return (
        np.sqrt(power_profile(frequencies(height), CENTRES_V, WIDTHS)),
        np.sqrt(power_profile(frequencies(width), CENTRES_U, WIDTHS)),
    )


def _residual_profiles(size: tuple[int, int]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    height, width = (
        np.sqrt(power_profile(frequencies(count), np.zeros(1), np.array([_RESIDUAL_WIDTH])))[0] for count in size
    )
    return height, width
