"""One round of the synthesis of a solid: every band of it, and of its slices, is matched, then the voxels.

The solid is taken as periodic along all three axes, so that the result tiles in space. All generators yield the
number of samples that they have matched or transformed since the last time.

Reference: Heeger and Bergen 1995, section 3.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from texlab_core.methods.heeger_bergen.analysis import band_keys
from texlab_core.methods.heeger_bergen.rounds import match
from texlab_core.methods.solid.slices import CUTS, SlicePlan, match_slices
from texlab_core.stats.histogram import match_ranks_in_place
from texlab_core.transforms import laplacian, solid_laplacian
from texlab_core.transforms.steerable import BandKey
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from texlab_core.methods.heeger_bergen.analysis import PlaneModel, TextureModel
    from texlab_core.work.tasks import Task

Volume = NDArray[np.float32]

# Samples that are copied or added between two pauses.
PIECE = 2**18
# So many slices across an axis are measured.
MEASURED = 16


@dataclass(frozen=True, slots=True, eq=False)
class AxisModel:
    """The targets of one colour axis.

    Parameters
    ----------
    solid
        Of the Laplacian pyramid.
    slices
        Of the steerable pyramid; None for solids of the kind ``laplacian``.
    """

    solid: PlaneModel
    slices: PlaneModel | None


@dataclass(frozen=True, slots=True, eq=False)
class SolidModel:
    """The exemplar's histograms.

    Parameters
    ----------
    solid
        Of the Laplacian pyramid of every colour axis.
    slices
        Of the steerable pyramid; None for solids of the kind ``laplacian``.
    """

    solid: TextureModel
    slices: TextureModel | None


@dataclass(frozen=True, slots=True)
class Plan:
    """The pyramids of a synthesis.

    Parameters
    ----------
    size
        Depth, height and width.
    levels
        Of the Laplacian pyramid of the solid.
    slices
        How slices are matched; None for solids of the kind ``laplacian``.
    """

    size: tuple[int, int, int]
    levels: int
    slices: SlicePlan | None

    @property
    def keys(self) -> tuple[BandKey, ...]:
        """Places of the solid's own bands, from fine to coarse."""
        return band_keys("laplacian", self.levels, 0)

    @property
    def labels(self) -> tuple[str, ...]:
        """Short names of all bands that are matched: those of the solid, then those of the slices."""
        labels = [key.label for key in self.keys]
        if self.slices is not None:
            for plane, axes in CUTS.items():
                labels += [f"{plane}-{key.label}" for key in self.slices.keys(slice_size(self.size, axes))]
        return tuple(labels)

    @property
    def work(self) -> int:
        """About how many samples a round on one colour axis works through."""
        samples = int(np.prod(self.size))
        if self.slices is None:
            return 4 * samples
        return samples * (6 + 3 * (4 * self.slices.orientations + 4))


def match_round(
    volume: Volume, model: AxisModel, plan: Plan, tie_key: Callable[..., int]
) -> Task[tuple[Volume, NDArray[np.float64]]]:
    """Do one round on one colour axis.

    Parameters
    ----------
    volume
        (D, H, W) float32; stays as it is.
    model
        Targets.
    plan
        How.
    tie_key
        Gives a 64-bit key for any whole numbers.

    Returns
    -------
    volume
        (D, H, W) float32.
    distances
        (bands,) float64: W1 / sd of every band before it was matched, in the order of ``plan.labels``.
    """
    solid, found = yield from _match_solid(volume, model.solid, plan, tie_key)
    distances = [found]
    if plan.slices is not None and model.slices is not None:
        for number, axes in enumerate(CUTS.values(), 1):
            slices = yield from cut(volume, axes)
            matched, found = yield from match_slices(slices, model.slices, plan.slices, partial(tie_key, number))
            distances.append(found)
            yield from add(solid, matched.transpose(np.argsort(axes)))
        for block in row_blocks(plan.size, PIECE):
            solid[block] *= np.float32(1 / (1 + len(CUTS)))
            yield solid[block].size // 8
    yield from match_ranks_in_place(solid, model.solid.pixels.sample, tie_key(len(CUTS) + 1))
    return solid, np.concatenate(distances)


def measure(volume: Volume, model: AxisModel, plan: Plan) -> Task[NDArray[np.float64]]:
    """Return W1 / sd of every band of the solid itself, (levels + 1,) float64."""
    bands = yield from solid_laplacian.build(volume, plan.levels)
    distances = []
    for key, band in zip(plan.keys, bands, strict=True):
        distances.append((yield from match(band, model.solid.bands[key], "exact", 0)))
    return np.array(distances)


def measure_slices(volume: Volume, model: PlaneModel, levels: int) -> Task[NDArray[np.float64]]:
    """Return how far the slices are from the exemplar, seen as pictures of their own.

    Parameters
    ----------
    volume
        (D, H, W) float32.
    model
        Targets of a Laplacian pyramid.
    levels
        Of the pyramid of a slice, at most those of the shortest side.

    Returns
    -------
    ndarray
        (3,) float64: for xy, xz and yz the mean over the bands of W1 / sd, each band pooled over evenly spaced
        slices. The low-pass residual is left out: a few slices say little about it.
    """
    shares = np.zeros(len(CUTS))
    for place, axes in enumerate(CUTS.values()):
        slices = volume.transpose(axes)
        chosen = slices[:: -(-len(slices) // MEASURED)]
        bands: list[list[Volume]] = []
        for each in chosen:
            bands.append(laplacian.build(np.ascontiguousarray(each), levels, "periodic"))
            yield each.size
        distances = []
        for level in range(levels):
            pooled = np.concatenate([split[level].reshape(-1) for split in bands])
            distances.append((yield from match(pooled, model.bands[BandKey("bandpass", level)], "exact", 0)))
        shares[place] = float(np.mean(distances)) if distances else 0.0
    return shares


def _match_solid(
    volume: Volume, model: PlaneModel, plan: Plan, tie_key: Callable[..., int]
) -> Task[tuple[Volume, NDArray[np.float64]]]:
    bands = yield from solid_laplacian.build(volume, plan.levels)
    distances = []
    for index, (key, band) in enumerate(zip(plan.keys, bands, strict=True)):
        distances.append((yield from match(band, model.bands[key], "exact", tie_key(0, index))))
    solid = yield from solid_laplacian.collapse(bands)
    return solid, np.array(distances)


def slice_size(size: tuple[int, int, int], axes: tuple[int, int, int]) -> tuple[int, int]:
    """Return height and width of the slices that the axes of :data:`CUTS` make."""
    return size[axes[1]], size[axes[2]]


def cut(volume: Volume, axes: tuple[int, int, int]) -> Task[Volume]:
    """Return the solid with the slices first, C-contiguous."""
    turned = volume.transpose(axes)
    slices = np.empty(turned.shape, np.float32)
    for block in _blocks(slices):
        slices[block] = turned[block]
        yield slices[block].size // 8
    return slices


def add(total: Volume, part: Volume) -> Task[None]:
    """Add one volume to another, in place."""
    for block in _blocks(total):
        total[block] += part[block]
        yield total[block].size // 8


def _blocks(volume: Volume) -> Iterator[slice]:
    return iter(row_blocks(volume.shape, PIECE))
