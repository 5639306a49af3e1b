"""Exemplars in common units: as many channels, and every colour axis with mean 0 and standard deviation 1.

Heeger and Bergen's method takes a gray exemplar as it is and a coloured one along its own whitened axes. Before
two are mixed, both must be of the second kind; a gray one has one axis, along equal red, green and blue.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.heeger_bergen.analysis import PlaneModel, Target
from texlab_core.transforms.colour import ColourAxes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.methods.heeger_bergen.analysis import TextureModel
    from texlab_core.stats.histogram import Sample
    from texlab_core.work.tasks import Task


@dataclass(frozen=True, slots=True, eq=False)
class Common:
    """One exemplar in common units.

    Parameters
    ----------
    mean, covariance
        Of its colours, (C,) and (C, C) float64.
    axes
        Its whitened colour axes; none of them for a constant image.
    planes
        Targets of each axis.
    palette
        Sorted values of each of the C channels.
    levels
        Number of levels analyzed.
    """

    mean: NDArray[np.float64]
    covariance: NDArray[np.float64]
    axes: ColourAxes
    planes: tuple[PlaneModel, ...]
    palette: tuple[Sample, ...]
    levels: int

    @classmethod
    def of(cls, model: TextureModel, channels: int) -> Common:
        """Return a model with so many channels, 1 or 3; a gray one takes part with equal ones."""
        palette = model.palette * (channels // model.channels)
        if model.axes is not None:
            axes, planes = model.axes, model.planes
        else:
            mean = np.array([sample.mean(dtype=np.float64) for sample in palette])
            spread = [plane.pixels.spread for plane in model.planes]
            planes = tuple(_whitened(plane, float(mean[0])) for plane in model.planes)
            # The distance along equal channels is longer than the step of each.
            direction = np.full((len(planes), channels), 1 / math.sqrt(channels))
            axes = ColourAxes(mean, direction, np.array(spread) * math.sqrt(channels))
        scaled = axes.directions * axes.spread[:, None]
        return cls(axes.mean, scaled.T @ scaled, axes, planes, palette, model.levels)

    def to_axes(self, pixels: FloatImage) -> Task[NDArray[np.float32]]:
        """Return an image's planes (A, H, W) along these axes."""
        channels = len(self.mean)
        return (yield from self.axes.to_axes_task(np.broadcast_to(pixels, (*pixels.shape[:2], channels))))


def _whitened(plane: PlaneModel, mean: float) -> PlaneModel:
    """Return the targets of a plane after its mean is taken off and its spread made 1."""
    spread = plane.pixels.spread
    bands = {}
    for key, target in plane.bands.items():
        # The residual has the plane's mean, all other bands have none.
        middle = mean if key.kind == "lowpass" else 0.0
        bands[key] = Target(_shifted(target.sample, middle, spread), target.spread / spread)
    return PlaneModel(Target(_shifted(plane.pixels.sample, mean, spread), 1.0), bands)


def _shifted(sample: Sample, mean: float, spread: float) -> Sample:
    shifted: Sample = ((sample - np.float32(mean)) / np.float32(spread)).astype(np.float32)
    return shifted
