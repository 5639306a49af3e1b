"""How different two pictures are: De Bonet's V, and how much of the exemplar was laid down as a whole."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.measures.registry import Measure, register
from texlab_core.transforms import fourier
from texlab_core.transforms.luma import luma
from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.measures.subject import Subject

SMALLEST = 8
# Half a gray level of 255: what scatters less is one flat piece.
FLAT = 0.5 / 255


@dataclass(frozen=True, eq=False)
class Correlator:
    """An exemplar, periodically continued, made ready to be correlated with windows.

    Parameters
    ----------
    spectrum
        (h, w) complex64 of the luminance without its mean.
    scatter
        (h, w) float32: 1 / standard deviation under a window that begins there; 0 where it is flat.
    flat
        Whether any window is flat.
    size
        h, w of the exemplar.
    window
        Height and width of a window.
    """

    spectrum: NDArray[np.complex64]
    scatter: NDArray[np.float32]
    flat: bool
    size: tuple[int, int]
    window: tuple[int, int]

    def largest(self, patches: Sequence[NDArray[np.float32]], look: Callable[[], None]) -> list[float]:
        """Return the largest correlation, 0 .. 1, of each window of luminance with any place of the exemplar.

        A flat window matches a flat place with 1 and everything else with 0.
        """
        found: list[float] = []
        # Two real windows share a complex transform.
        for first in range(0, len(patches), 2):
            found += self._pair(patches[first : first + 2], look)
        return found

    def _pair(self, patches: Sequence[NDArray[np.float32]], look: Callable[[], None]) -> list[float]:
        padded = np.zeros(self.size, np.complex64)
        parts = padded.real, padded.imag
        deviations = []
        for patch, part, sign in zip(patches, parts, (1, -1), strict=False):
            values = patch - np.float32(patch.mean(dtype=np.float64))
            deviations.append(math.sqrt(float(np.mean(np.square(values), dtype=np.float64))))
            part[: patch.shape[0], : patch.shape[1]] = np.float32(sign) * values
        product = finish(fourier.fft2(padded), look)
        np.conjugate(product, out=product)
        product *= self.spectrum
        covariance = finish(fourier.ifft2(product), look)
        found = []
        for deviation, part in zip(deviations, (covariance.real, covariance.imag), strict=False):
            if deviation < FLAT:
                found.append(1.0 if self.flat else 0.0)
                continue
            largest = float((part * self.scatter).max())
            found.append(min(max(largest / (math.prod(self.window) * deviation), 0.0), 1.0))
            look()
        return found


def correlator(pixels: FloatImage, window: tuple[int, int], look: Callable[[], None]) -> Correlator:
    """Prepare an exemplar (H, W, C) for windows of a size, at most its own."""
    gray = luma(pixels)
    look()
    plane = gray - np.float32(gray.mean(dtype=np.float64))
    spectrum = np.asarray(finish(fourier.fft2(plane), look), np.complex64)
    mean, square = (_window_means(each, window, look) for each in (plane, np.square(plane, dtype=np.float64)))
    deviation = np.sqrt(np.maximum(square - np.square(mean), 0))
    flat = deviation < FLAT
    scatter = np.divide(1, deviation, out=np.zeros(deviation.shape), where=~flat).astype(np.float32)
    return Correlator(spectrum, scatter, bool(flat.any()), plane.shape, window)


def _window_means(
    plane: NDArray[np.floating], window: tuple[int, int], look: Callable[[], None]
) -> NDArray[np.float64]:
    """Return the mean under a window that begins at each place, around the borders."""
    means = plane.astype(np.float64)
    for axis, length in enumerate(window):
        look()
        ends = np.take(means, np.arange(length - 1), axis=axis)
        running = np.cumsum(np.concatenate([means, ends], axis=axis), axis=axis)
        upper = np.take(running, np.arange(length - 1, running.shape[axis]), axis=axis)
        lower = np.take(running, np.arange(plane.shape[axis] - 1), axis=axis)
        pad = [(1, 0) if each == axis else (0, 0) for each in (0, 1)]
        means = (upper - np.pad(lower, pad)) / length
    return means


def windows(size: tuple[int, ...], window: tuple[int, int]) -> Iterator[tuple[slice, slice]]:
    """Cover an image with windows that overlap by half or more, the last ones at its borders."""
    starts = [
        np.rint(np.linspace(0, side - length, max(1, math.ceil(2 * (side - length) / length)) + 1)).astype(int)
        for side, length in zip(size, window, strict=True)
    ]
    for row in np.unique(starts[0]):
        for column in np.unique(starts[1]):
            yield slice(row, row + window[0]), slice(column, column + window[1])


def visual_difference(subject: Subject) -> float | None:
    """Return V = 1 - the largest correlation of windows half as large as the exemplar, on average."""
    image = subject.image.shape[:2]
    sides = [min(half, side) for half, side in zip((n // 2 for n in subject.pixels.shape[:2]), image, strict=True)]
    if min(sides) < SMALLEST:
        return None
    window = (sides[0], sides[1])
    name = f"correlator {window[0]} x {window[1]}"
    exemplar = subject.prepared(name, lambda pixels, look: correlator(pixels, window, look))
    if not exemplar.scatter.any():
        return None
    gray = subject.once("gray", lambda: luma(subject.image))
    found = exemplar.largest([gray[place] for place in windows(image, window)], subject.look)
    return 1 - math.fsum(found) / len(found)


def laid_down_share(subject: Subject) -> float | None:
    """Return the mean correlation of exemplar-sized blocks with their best cyclic shift of the exemplar."""
    block = subject.pixels.shape[:2]
    image = subject.image.shape[:2]
    if min(block) < SMALLEST or any(side < length for side, length in zip(image, block, strict=True)):
        return None
    exemplar = subject.prepared("correlator whole", lambda pixels, look: correlator(pixels, block, look))
    if not exemplar.scatter.any():
        return None
    gray = subject.once("gray", lambda: luma(subject.image))
    blocks = [
        gray[row : row + block[0], column : column + block[1]]
        for row in range(0, image[0] - block[0] + 1, block[0])
        for column in range(0, image[1] - block[1] + 1, block[1])
    ]
    found = exemplar.largest(blocks, subject.look)
    return math.fsum(found) / len(found)


register(
    Measure(
        id="visual-difference",
        title="V",
        summary="How different the pictures are (De Bonet's visual difference): 1 - the correlation of "
        "overlapping windows, half as large as the exemplar, with the most similar place in it. 0 for copies and "
        "tilings; unrelated pictures of the same texture come near 0.7.",
        low=0.0,
        high=1.0,
        better="higher",
        needs=("exemplar",),
        function=visual_difference,
        form=".2f",
        reference="J. S. De Bonet, SIGGRAPH 1997, section 2",
        live=True,
        order=20,
    )
)
register(
    Measure(
        id="laid-down-share",
        title="laid down",
        summary="Correlation of each block as large as the exemplar with its best cyclic shift of the exemplar, "
        "on average: near 1 the result is shifted copies side by side; 0.3 is usual for pixel-wise growth.",
        low=0.0,
        high=1.0,
        better="lower",
        needs=("exemplar",),
        function=laid_down_share,
        form=".0%",
        live=True,
        order=30,
    )
)
