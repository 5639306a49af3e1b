"""Which subbands built a pixel: what each of them gives alone, when all others are zero.

The pyramids are linear, so the contributions add up to the picture, pixel by pixel.

Reference: Heeger and Bergen 1995, section 2.1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import NDArray

from texlab_core.methods.heeger_bergen.analysis import Pyramid, band_keys, expansion, max_levels
from texlab_core.transforms import laplacian
from texlab_core.transforms.steerable import BandKey, Transform
from texlab_core.work.tasks import finish, go_on

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.transforms.steerable import Spectrum

Plane = NDArray[np.float32]


class Contributions(Protocol):
    """What each subband adds to each pixel of a plane."""

    @property
    def keys(self) -> tuple[BandKey, ...]:
        """Places of the subbands, from fine to coarse."""

    @property
    def spreads(self) -> NDArray[np.float64]:
        """Standard deviation of each contribution over the whole plane, (bands,) float64."""

    @property
    def nbytes(self) -> int:
        """Memory held."""

    def at(self, row: int, column: int) -> NDArray[np.float64]:
        """Return what every subband adds to one pixel, (bands,) float64."""

    def plane(self, index: int, look: Callable[[], None] = go_on) -> Plane:
        """Return what one subband adds to every pixel, (H, W) float32; ``look`` may raise to stop."""


def contributions(
    plane: Plane, pyramid: Pyramid, scales: int, orientations: int, look: Callable[[], None] = go_on
) -> Contributions:
    """Prepare the contributions of the subbands of a plane.

    Parameters
    ----------
    plane
        (H, W) float32, taken as periodic, as the method does.
    pyramid, scales, orientations
        As in the method's parameters; fewer scales are used when the plane is too small.
    look
        Called between the subbands, and between pieces of large ones; may raise to stop.
    """
    levels = min(scales, max_levels(plane.shape, pyramid))
    if pyramid == "steerable":
        return _steerable(plane, levels, orientations, look)
    mode = expansion(pyramid)
    bands = laplacian.build(plane, levels, "periodic", mode, look=look)
    planes, spreads = np.empty((len(bands), *plane.shape), np.float32), []
    for index in range(len(bands)):
        look()
        lone = [band if place == index else np.zeros_like(band) for place, band in enumerate(bands)]
        planes[index] = laplacian.collapse(lone, "periodic", mode, look=look)
        look()
        spreads.append(planes[index].std(dtype=np.float64))
    return _Planes(band_keys(pyramid, levels, orientations), np.array(spreads), planes)


@dataclass(frozen=True, eq=False)
class _Planes:
    """Contributions as planes, (bands, H, W) float32."""

    keys: tuple[BandKey, ...]
    spreads: NDArray[np.float64]
    planes: Plane

    @property
    def nbytes(self) -> int:
        return self.planes.nbytes

    def at(self, row: int, column: int) -> NDArray[np.float64]:
        return self.planes[:, row, column].astype(np.float64)

    def plane(self, index: int, look: Callable[[], None] = go_on) -> Plane:
        plane: Plane = self.planes[index]
        return plane


@dataclass(frozen=True, eq=False)
class _Spectra:
    """Contributions as half spectra cropped to each subband's size: a quarter of the memory of all planes."""

    transform: Transform
    spreads: NDArray[np.float64]
    parts: tuple[Spectrum, ...]

    @property
    def keys(self) -> tuple[BandKey, ...]:
        return self.transform.keys

    @property
    def nbytes(self) -> int:
        return sum(part.nbytes for part in self.parts)

    def at(self, row: int, column: int) -> NDArray[np.float64]:
        # One sample of the inverse transform: first along the rows, then the sum over them.
        height, width = self.transform.size
        found = []
        for part in self.parts:
            u, v = _frequencies(part)
            across = np.exp(2j * np.pi * v * column / width) * _times(part, width)
            down = np.exp(2j * np.pi * u * row / height)
            found.append((down @ (part @ across.astype(part.dtype))).real)
        return np.array(found, np.float64)

    def plane(self, index: int, look: Callable[[], None] = go_on) -> Plane:
        total = self.transform.empty_sum()
        finish(self.transform.add_task(total, self.keys[index], self.parts[index]), look)
        plane: Plane = self.transform.inverse(total, look)
        return plane


def _steerable(plane: Plane, levels: int, orientations: int, look: Callable[[], None]) -> _Spectra:
    transform = Transform.of(plane, levels, orientations)
    spectrum = transform.forward(plane, look)
    parts, spreads = [], []
    for key in transform.keys:
        look()
        part = finish(transform.filtered_task(key, transform.band(spectrum, key, look)), look)
        look()
        # Parseval; the first entry is the mean.
        power = float((np.square(np.abs(part), dtype=np.float64) @ _times(part, plane.shape[1])).sum())
        spreads.append(np.sqrt(max(0.0, power - abs(complex(part[0, 0])) ** 2)))
        parts.append(part)
    return _Spectra(transform, np.array(spreads), tuple(parts))


def _frequencies(part: Spectrum) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the frequencies of the rows, of either sign, and of the columns of a cropped half spectrum."""
    height, columns = part.shape
    rows = np.arange(height)
    return np.where(rows < (height + 1) // 2, rows, rows - height), np.arange(columns)


def _times(part: Spectrum, width: int) -> NDArray[np.float64]:
    """Return how often each column of a half spectrum occurs in the whole one."""
    columns = np.arange(part.shape[1])
    return np.where((columns == 0) | (2 * columns == width), 1.0, 2.0)
