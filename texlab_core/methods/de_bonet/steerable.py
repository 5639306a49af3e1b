"""Algorithm 11.5 over the steerable pyramid, whose bands are what is sampled and the features.

A location of a level has one value of each of K orientations (and, at the finest level, of the high-pass
residual); all of them are copied together from one place. The parent structure of a location is what its ancestors
have: their K orientations, and the low-pass residual at the coarsest level. The output is the collapse of the
copied bands, which is periodic: it tiles.

With mirrored borders the bands are those of the mirrored exemplar. Since the output is periodic, even a verbatim
copy then differs from the exemplar towards its borders; with repeated ones it is exact.

Reference: Forsyth and Ponce, algorithm 11.5, programming assignments a and b; De Bonet 1997, section 4.2.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.steps import Step
from texlab_core.errors import InputError
from texlab_core.methods.de_bonet.analysis import Analysis, finish_level
from texlab_core.methods.de_bonet.channels import planes_of
from texlab_core.methods.de_bonet.features import Feature
from texlab_core.methods.de_bonet.fitting import fit
from texlab_core.methods.de_bonet.growth import grow_levels, total_work, visible, visible_steps
from texlab_core.methods.de_bonet.seams import Seams
from texlab_core.transforms import steerable
from texlab_core.transforms.steerable import BandKey, Transform
from texlab_core.work.tasks import through

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable, Sequence

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.methods.de_bonet.choices import Channels, ExemplarBorder, Fitting, Normalization
    from texlab_core.methods.de_bonet.quadtree import Grid
    from texlab_core.methods.de_bonet.sampling import Progress


@dataclass(frozen=True, eq=False, slots=True)
class SteerableAnalysis(Analysis):
    """The analysis of an exemplar by its steerable pyramid.

    Parameters
    ----------
    orientations
        K. The bands of a level are K for each channel, channel by channel; at level 0 the high-pass residuals
        follow, and the coarsest level holds the low-pass residuals alone.
    """

    orientations: int

    @property
    def channels(self) -> int:
        """Channels of the image."""
        return int(self.levels[-1].band.shape[1])


def analyze_steerable_steps(
    pixels: NDArray[np.float32],
    *,
    depth: int,
    orientations: int,
    border: ExemplarBorder = "reflect",
    fitting: Fitting = "crop",
    normalization: Normalization = "variance",
    channels: Channels = "all",
) -> Generator[tuple[int, int], None, SteerableAnalysis]:
    """Analyze an exemplar, yielding (done, total) on the way.

    Parameters
    ----------
    pixels
        (H, W, C) float32.
    depth
        N: levels 0 .. N - 1 have oriented bands, level N the low-pass residual.
    orientations
        K, 1 to 18.
    border, fitting, normalization, channels
        As for the Laplacian pyramid.

    Returns
    -------
    SteerableAnalysis
    """
    fitted = fit(pixels, depth, border, fitting)
    grid, count = fitted.grid, pixels.shape[2]
    planes = planes_of(fitted.pixels, channels)
    features = _features(planes.names, orientations)
    # The coarsest level has features of its own where one more level fits; it is not collapsed.
    deepest = min(depth + 1, steerable.max_levels(grid.shape(0)))
    total, done = count * ((depth + 1) * orientations + 2) + (depth + 1), 0
    bands: list[list[NDArray[np.float32]]] = [[] for _ in range(depth + 2)]
    residuals: list[tuple[NDArray[np.float32], NDArray[np.float32]]] = []
    for channel in range(count):
        plane = np.ascontiguousarray(fitted.pixels[..., channel])
        seen = steerable.mirror(plane) if border == "reflect" else plane
        transform = Transform.of(seen, deepest, orientations)
        spectrum = transform.forward(seen)
        split = {}
        for key in (BandKey("highpass"), *(key for key in transform.keys if key.kind == "oriented"), _low(depth)):
            band = yield from through(transform.band_task(spectrum, key), (done, total))
            split[key] = steerable.quadrant(band, plane.shape, key.level) if border == "reflect" else band
            done += 1
            yield done, total
        for key, band in split.items():
            if key.kind == "oriented":
                bands[key.level].append(band)
        residuals.append((split[BandKey("highpass")], split[_low(depth)]))
    levels = []
    for level in range(depth + 1):
        oriented = bands[level] if level < deepest else []
        low = np.stack([each[1] for each in residuals], axis=-1) if level == depth else None
        sampled = [low] if low is not None else [np.stack(oriented, axis=-1)]
        if level == 0 and depth > 0:
            sampled.append(np.stack([each[0] for each in residuals], axis=-1))
        measured = np.zeros((len(features) if level else 0, *grid.shape(level)), np.float32)
        if level and low is not None:
            _fill(measured, 0, planes.see(low), len(planes.names))
        for k in range(orientations) if level and oriented else ():
            along = np.stack([oriented[channel * orientations + k] for channel in range(count)], axis=-1)
            _fill(measured, 1 + k, planes.see(along), len(planes.names))
        band = np.concatenate(sampled, axis=-1).astype(np.float64)
        finishing = finish_level(grid, level, band, measured, normalization, planes.stretch)
        levels.append((yield from through(finishing, (done, total))))
        done += 1
        yield done, total
    return SteerableAnalysis(
        grid,
        tuple(levels),
        features,
        "periodic",
        fitted.rows,
        fitted.columns,
        fitted.whole,
        Seams.of(fitted.pixels, grid.rows, grid.columns),
        fitted.notes,
        orientations,
    )


def _low(depth: int) -> BandKey:
    return BandKey("lowpass", depth)


def _features(names: Sequence[str], orientations: int) -> tuple[Feature, ...]:
    """Return the low-pass residual of every plane, then every orientation of every plane."""
    found = [Feature(name, "residual") for name in names]
    for k in range(orientations):
        # Angles of features are counter-clockwise, those of the pyramid's waves run towards the rows.
        found += [Feature(name, "oriented", (180 - 180 * k / orientations) % 180) for name in names]
    return tuple(found)


def _fill(measured: NDArray[np.float32], group: int, seen: NDArray[np.float32], planes: int) -> None:
    measured[group * planes : (group + 1) * planes] = np.moveaxis(seen, -1, 0)


def check_steerable_size(size: tuple[int, int], depth: int) -> None:
    """Refuse outputs that have too few cells for the pyramid; raises ``InputError``."""
    least = 2 ** (depth + 1)
    if min(size) < least:
        raise InputError(
            f"size: a steerable pyramid of {depth} levels needs at least {least} pixels a side, got "
            f"{size[1]} x {size[0]}."
        )


def grow_steerable(
    analysis: SteerableAnalysis,
    grid: Grid,
    sources: Sequence[NDArray[np.int32]],
    progress: Iterable[Progress],
    *,
    size: tuple[int, int],
    after: int = 0,
) -> Generator[Step, None, FloatImage]:
    """Add the bands of each level to the output's spectrum as soon as its sources are complete.

    Parameters
    ----------
    sources, progress, size, after
        As for :func:`texlab_core.methods.de_bonet.growth.grow`.

    Returns
    -------
    ndarray
        (H, W, C) float32, cropped and clipped.
    """
    depth, channels, total = grid.depth, analysis.channels, total_work(grid, after)
    blank = np.empty(grid.shape(0), np.float32)
    transform = Transform.of(blank, min(depth, steerable.max_levels(grid.shape(0))), analysis.orientations)
    sums = [transform.empty_sum() for _ in range(channels)]

    def preview() -> FloatImage:
        planes = [transform.inverse(each.copy()) for each in sums]
        return visible(np.stack(planes, axis=-1), size)

    def make(level: int) -> Generator[int, None, None]:
        return _add(analysis, grid, level, sources[level], transform, sums)

    yield from through(make(depth), Step(grid.count(depth), total, "residual"))
    yield from grow_levels(grid, progress, make, preview=preview, after=after)
    # The sums are not needed any more: they become the planes.
    image = np.empty((*grid.shape(0), channels), np.float32)
    step = Step(total_work(grid), total, "level 0")
    for channel, each in enumerate(sums):
        image[..., channel] = yield from through(_inverse(each, transform), step)
        yield step
    return (yield from through(visible_steps(image, size), step))


def _inverse(total: NDArray[Any], transform: Transform) -> Generator[int, None, NDArray[np.float32]]:
    from texlab_core.transforms.fourier import irfft2

    return (yield from irfft2(total, transform.size))


def _add(
    analysis: SteerableAnalysis,
    grid: Grid,
    level: int,
    source: NDArray[np.int32],
    transform: Transform,
    sums: list[NDArray[Any]],
) -> Generator[int, None, None]:
    """Filter the copied bands of a level again and add them to the spectra of the channels."""
    orientations, band = analysis.orientations, analysis.levels[level].band
    place = source[grid.order(level)]
    for column in range(band.shape[1]):
        channel, number = divmod(column, orientations)
        if level == grid.depth:
            channel, key = column, _low(level)
        elif channel < len(sums):
            key = BandKey("oriented", level, number)
        else:
            channel, key = column - len(sums) * orientations, BandKey("highpass")
        copied = band[place, column].astype(np.float32)
        yield copied.size
        part = yield from transform.filtered_task(key, copied)
        yield from transform.add_task(sums[channel], key, part)
