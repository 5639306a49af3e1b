"""One pair of Gabor filters in quadrature with free parameters, sampled in space as the textbook writes it.

The symmetric kernel is cos(k · x + phase) times a Gaussian, the antisymmetric one the sine. What a constant would
answer is removed from both, and they are scaled so that a matching wave of amplitude 1 answers with magnitude 1.

Reference: Forsyth and Ponce, section 11.2.2, Figs. 11.9 to 11.11.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.errors import ParamError
from texlab_core.transforms.gabor import Response
from texlab_core.work.tasks import go_on
from texlab_core.work.threads import workers

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

SHORTEST, LONGEST = 2.0, 256.0
LARGEST_SIGMA = 128.0
# Standard deviations of the Gaussian that the kernels hold.
_REACH = 3.0


@dataclass(frozen=True, slots=True)
class GaborPair:
    """Parameters of the pair.

    Parameters
    ----------
    wavelength
        In pixels, 2 to 256.
    orientation
        Of the wave vector in degrees, from the columns' axis towards the rows' (0: vertical stripes).
    sigma
        Standard deviation of the Gaussian in pixels, 0.5 to 128; None takes half a wavelength.
    phase
        Of the symmetric kernel's cosine, in degrees.

    Raises
    ------
    ParamError
        When a parameter is out of range.
    """

    wavelength: float = 8.0
    orientation: float = 0.0
    sigma: float | None = None
    phase: float = 0.0

    def __post_init__(self) -> None:
        if not SHORTEST <= self.wavelength <= LONGEST:
            raise ParamError("wavelength", f"a number of pixels from {SHORTEST:g} to {LONGEST:g}", self.wavelength)
        if not 0.5 <= self.width <= LARGEST_SIGMA:
            raise ParamError("sigma", f"a number of pixels from 0.5 to {LARGEST_SIGMA:g}", self.width)
        for name in ("orientation", "phase"):
            if not math.isfinite(getattr(self, name)):
                raise ParamError(name, "a number of degrees", getattr(self, name))

    @property
    def width(self) -> float:
        """The Gaussian's standard deviation."""
        return self.wavelength / 2 if self.sigma is None else self.sigma

    @property
    def reach(self) -> int:
        """Pixels from the middle to the border of the kernels."""
        return math.ceil(_REACH * self.width)

    def kernel(self) -> NDArray[np.complex64]:
        """Return symmetric + i · antisymmetric kernel, (n, n) complex64, n odd, the origin in the middle."""
        y, x = np.mgrid[-self.reach : self.reach + 1, -self.reach : self.reach + 1].astype(np.float64)
        angle = math.radians(self.orientation)
        wave = np.exp(2j * np.pi / self.wavelength * (x * math.cos(angle) + y * math.sin(angle)))
        gaussian = np.exp(-(x**2 + y**2) / (2 * self.width**2))
        turned = wave * np.exp(1j * math.radians(self.phase))
        values = gaussian * (turned - (gaussian * turned).sum() / gaussian.sum())
        # A cosine of amplitude 1 is half this wave and half its mirror image.
        matched = np.abs((values * wave.conj()).sum()) / 2
        mirrored = np.abs((values * wave).sum()) / 2
        scaled: NDArray[np.complex64] = (values / max(matched + mirrored, 1e-12)).astype(np.complex64)
        return scaled

    def respond(self, plane: NDArray[np.float32], look: Callable[[], None] = go_on) -> Response:
        """Return what both filters answer, (H, W) complex64; the plane (H, W) float32 is mirrored at its borders.

        Both are convolutions: the answer to cos(k · x + p) has the phase p at its origin, 0 on the middle of a
        bright stripe. ``look`` is called between the transforms and may raise to stop.
        """
        import cv2
        from scipy import fft

        reach = self.reach
        height, width = plane.shape
        centred = plane - np.float32(plane.mean(dtype=np.float64))
        padded = cv2.copyMakeBorder(centred, reach, reach, reach, reach, cv2.BORDER_REFLECT_101)
        size = (fft.next_fast_len(padded.shape[0]), fft.next_fast_len(padded.shape[1]))
        look()
        spectrum = fft.fft2(padded, s=size, workers=workers())
        look()
        spectrum *= fft.fft2(self.kernel(), s=size, workers=workers())
        look()
        values = fft.ifft2(spectrum, overwrite_x=True, workers=workers())
        cut = values[2 * reach : 2 * reach + height, 2 * reach : 2 * reach + width]
        return Response(np.ascontiguousarray(cut, np.complex64))
