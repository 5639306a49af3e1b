"""Analysis: the sorted pixels and subbands of every colour axis of an exemplar.

Reference: Heeger and Bergen 1995, sections 2.3 (match-texture), 2.4 (edges) and 2.5 (colour).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from texlab_core.stats.histogram import Sample, sorted_sample
from texlab_core.transforms import fourier, gaussian, laplacian, steerable
from texlab_core.transforms.colour import ColourAxes, principal_axes_task
from texlab_core.transforms.fourier import periodic_component_task
from texlab_core.transforms.steerable import BandKey, Transform

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from texlab_core.engine.steps import FloatImage
    from texlab_core.work.tasks import Crew, Task

Plane = NDArray[np.float32]
Pyramid = Literal["steerable", "laplacian", "textbook"]
OddSides = Literal["spread", "doubled"]
Around = Literal["spread", "periodic"]
Border = Literal["reflect", "periodic", "wrap"]

# A band this much weaker than its plane is measured against the plane: rounding has no distribution to match.
FAINT = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class Target:
    """The distribution that one subband is to have.

    Parameters
    ----------
    sample
        Its values in the exemplar, sorted.
    spread
        Standard deviation that distances are divided by.
    """

    sample: Sample
    spread: float


@dataclass(frozen=True, slots=True, eq=False)
class PlaneModel:
    """The targets of one colour axis.

    Parameters
    ----------
    pixels
        Of the plane itself.
    bands
        Of every subband. Low-pass residuals are there for every number of levels up to the largest, for results
        that are too small for all of them.
    """

    pixels: Target
    bands: Mapping[BandKey, Target]


@dataclass(frozen=True, slots=True, eq=False)
class TextureModel:
    """Everything that Heeger and Bergen's method knows of an exemplar.

    Parameters
    ----------
    axes
        Principal axes of the colours; None for a gray image, whose one plane is the image itself.
    planes
        One for each axis; none for a constant image.
    palette
        Sorted values of each channel.
    levels
        Number of levels analyzed: as many as were asked for and fit.
    """

    axes: ColourAxes | None
    planes: tuple[PlaneModel, ...]
    palette: tuple[Sample, ...]
    levels: int

    @property
    def channels(self) -> int:
        """Number of channels of the exemplar."""
        return len(self.palette)

    def to_image(self, planes: Sequence[NDArray[np.float32]], size: tuple[int, ...]) -> Task[FloatImage]:
        """Return the image (H, W, C) of planes (H, W), or the volume of planes (D, H, W); not clipped."""
        if self.axes is not None and planes:
            return (yield from self.axes.from_axes(planes))
        if planes:
            return np.repeat(planes[0][..., None], self.channels, axis=2)
        middle = np.array([sample[sample.size // 2] for sample in self.palette], np.float32)
        return np.broadcast_to(middle, (*size, self.channels)).copy()


def max_levels(size: Sequence[int], pyramid: Pyramid) -> int:
    """Return the largest number of levels that a pyramid of this size can have."""
    return steerable.max_levels(size) if pyramid == "steerable" else max(0, gaussian.max_levels(size) - 1)


def band_keys(pyramid: Pyramid, levels: int, orientations: int) -> tuple[BandKey, ...]:
    """Return the places of all subbands, from fine to coarse."""
    if pyramid == "steerable":
        return steerable.band_keys(levels, orientations)
    return (*(BandKey("bandpass", level) for level in range(levels)), BandKey("lowpass", levels))


def expansion(pyramid: Pyramid) -> gaussian.Expansion:
    """Return how a Laplacian pyramid expands: the textbook's replicates."""
    return "replicate" if pyramid == "textbook" else "interpolate"


def around(odd_sides: OddSides) -> Around:
    """Return the border rule of a Laplacian pyramid that wraps around."""
    return "spread" if odd_sides == "spread" else "periodic"


def expected_work(samples: int, pyramid: Pyramid, orientations: int, border: Border) -> int:
    """Return about how many samples the analysis of an image of so many works through."""
    if pyramid != "steerable":
        return 6 * samples
    # Every band is computed, on the mirrored plane, and sorted.
    return samples * (4 if border == "reflect" else 1) * (8 * orientations // 3 + 4)


def analyze(
    image: FloatImage,
    pyramid: Pyramid,
    scales: int,
    orientations: int,
    border: Border,
    team: Crew,
    odd_sides: OddSides = "spread",
) -> Task[TextureModel]:
    """Analyze an exemplar.

    Parameters
    ----------
    image
        (H, W, C) float32 in [0, 1].
    pyramid, scales, orientations, border
        As in the method's parameters; fewer scales are used when the image is too small.
    team
        Works on the subbands side by side.
    odd_sides
        How a Laplacian pyramid wraps around at odd sides.

    Returns
    -------
    TextureModel
        Targets of every plane and band.
    """
    levels = min(scales, max_levels(image.shape, pyramid))
    palette = []
    for channel in range(image.shape[2]):
        palette.append(sorted_sample(image[..., channel]))
        yield image[..., channel].size
    axes, planes = yield from _planes(image)
    models = []
    for plane in planes:
        pixels = yield from target(plane, 0.0)
        bands: dict[BandKey, Target] = {}
        floor = pixels.spread * FAINT
        whole = (yield from periodic_component_task(plane)) if border == "periodic" else plane
        if pyramid == "steerable":
            yield from _steerable_targets(whole, levels, orientations, border == "reflect", floor, bands, team)
        else:
            yield from _laplacian_targets(
                whole,
                levels,
                "reflect" if border == "reflect" else around(odd_sides),
                expansion(pyramid),
                floor,
                bands,
            )
        models.append(PlaneModel(pixels, bands))
    return TextureModel(axes, tuple(models), tuple(palette), levels)


def _planes(image: FloatImage) -> Task[tuple[ColourAxes | None, list[Plane]]]:
    """Return the colour axes and the planes along them; an image of equal channels is its own one plane."""
    if np.all(image == image[..., :1]):
        constant = image.min() == image.max()
        return None, [] if constant else [np.ascontiguousarray(image[..., 0])]
    yield image.size
    axes = yield from principal_axes_task(image)
    return axes, list((yield from axes.to_axes_task(image)))


def target(values: Plane, floor: float) -> Task[Target]:
    """Return the values as a target; its spread is not below ``floor``."""
    sample = sorted_sample(values)
    yield values.size
    spread = float(values.std(dtype=np.float64))
    yield values.size
    return Target(sample, max(spread, floor))


def _steerable_targets(
    plane: Plane,
    levels: int,
    orientations: int,
    mirrored: bool,
    floor: float,
    bands: dict[BandKey, Target],
    team: Crew,
) -> Task[None]:
    """Fill in every subband, and the low-pass residual of every number of levels."""
    whole = steerable.mirror(plane) if mirrored else plane
    transform = Transform.of(whole, levels, orientations)
    spectrum = yield from fourier.rfft2(whole)

    def task(key: BandKey) -> Task[tuple[BandKey, Target]]:
        band = yield from transform.band_task(spectrum, key)
        yield band.size
        kept = steerable.quadrant(band, plane.shape, key.level) if mirrored else band
        return key, (yield from target(kept, floor))

    def accept(found: tuple[BandKey, Target]) -> tuple[()]:
        bands[found[0]] = found[1]
        return ()

    keys = (*transform.keys, *(BandKey("lowpass", level) for level in range(levels)))
    yield from team.in_order((task(key) for key in keys), accept)


def _laplacian_targets(
    plane: Plane,
    levels: int,
    border: gaussian.Border,
    mode: gaussian.Expansion,
    floor: float,
    bands: dict[BandKey, Target],
) -> Task[None]:
    for level in range(levels):
        bands[BandKey("lowpass", level)] = yield from target(plane, floor)
        band, coarser = laplacian.build(plane, 1, border, mode)
        yield plane.size
        bands[BandKey("bandpass", level)] = yield from target(band, floor)
        plane = coarser
    bands[BandKey("lowpass", levels)] = yield from target(plane, floor)
