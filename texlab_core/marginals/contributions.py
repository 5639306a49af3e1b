"""Which subbands built a pixel: the plane that each of them gives alone, when all others are zero.

The pyramids are linear, so these planes add up to the picture, pixel by pixel.

Reference: Heeger and Bergen 1995, section 2.1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from texlab_core.marginals.analysis import Pyramid, band_keys, expansion, max_levels
from texlab_core.transforms import laplacian
from texlab_core.transforms.steerable import BandKey, Transform

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

Plane = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Contributions:
    """What each subband adds to each pixel of a plane.

    Parameters
    ----------
    keys
        Places of the subbands, from fine to coarse.
    planes
        (bands, H, W) float32; their sum is the plane.
    spreads
        (bands,) float64: standard deviation of each of them over the whole plane.
    """

    keys: tuple[BandKey, ...]
    planes: NDArray[np.float32]
    spreads: NDArray[np.float64]

    def at(self, row: int, column: int) -> NDArray[np.float64]:
        """Return what every subband adds to one pixel, (bands,) float64."""
        return self.planes[:, row, column].astype(np.float64)


def contributions(
    plane: Plane, pyramid: Pyramid, scales: int, orientations: int, look: Callable[[], None] = lambda: None
) -> Contributions:
    """Collapse every subband of a plane alone.

    Parameters
    ----------
    plane
        (H, W) float32, taken as periodic, as the method does.
    pyramid, scales, orientations
        As in the method's parameters; fewer scales are used when the plane is too small.
    look
        Called between the subbands; may raise to stop.
    """
    levels = min(scales, max_levels(plane.shape, pyramid))
    keys = band_keys(pyramid, levels, orientations)
    planes = np.empty((len(keys), *plane.shape), np.float32)
    alone = _steerable if pyramid == "steerable" else _laplacian
    for index, each in enumerate(alone(plane, pyramid, levels, orientations)):
        look()
        planes[index] = each
    return Contributions(keys, planes, planes.std(axis=(1, 2), dtype=np.float64))


def _steerable(plane: Plane, pyramid: Pyramid, levels: int, orientations: int) -> Iterator[Plane]:
    transform = Transform.of(plane, levels, orientations)
    spectrum = transform.forward(plane)
    for key in transform.keys:
        total = transform.empty_sum()
        transform.add(total, key, transform.band(spectrum, key))
        yield transform.inverse(total)


def _laplacian(plane: Plane, pyramid: Pyramid, levels: int, orientations: int) -> Iterator[Plane]:
    mode = expansion(pyramid)
    bands = laplacian.build(plane, levels, "periodic", mode)
    for index in range(len(bands)):
        lone = [band if place == index else np.zeros_like(band) for place, band in enumerate(bands)]
        yield laplacian.collapse(lone, "periodic", mode)
