"""Analysis: the exemplar's Laplacian pyramid and normalized features, in quadtree order."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.de_bonet.channels import planes_of
from texlab_core.methods.de_bonet.features import FeatureKind, feature_list
from texlab_core.methods.de_bonet.fitting import choose_depth, fit
from texlab_core.methods.de_bonet.seams import Seams
from texlab_core.work.tasks import row_bounds, through

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.methods.de_bonet.choices import Channels, ExemplarBorder, FilterSet, Fitting, Normalization
    from texlab_core.methods.de_bonet.features import Feature
    from texlab_core.methods.de_bonet.quadtree import Grid
    from texlab_core.transforms.gaussian import Border
    from texlab_core.transforms.oriented import Order

# Features that vary by less than this are constant up to rounding; images live in [0, 1].
_CONSTANT = 1e-6
# A printed Z below this is rounding: the feature sums to nothing.
_SMALLEST_SUM = 1e-12
PIXELS_AT_ONCE = 2**17


@dataclass(frozen=True, eq=False, slots=True)
class Level:
    """One level of the analysis, all arrays in quadtree order.

    Parameters
    ----------
    band
        (P, C) float64: the Laplacian band in the image's own units; at the coarsest level the Gaussian one.
    features
        (P, J) float32: features divided by sqrt(Z); (P, 0) at level 0, which constrains nothing.
    classes
        (P,) int32: equal where all features are.
    scale
        (J,) float64: Z of eq. 10, infinite for a constant feature.
    coordinates
        (P, 2) int32: row and column of each location at this level.
    """

    band: NDArray[np.float64]
    features: NDArray[np.float32]
    classes: NDArray[np.int32]
    scale: NDArray[np.float64]
    coordinates: NDArray[np.int32]


@dataclass(frozen=True, eq=False, slots=True)
class Analysis:
    """Everything that does not depend on thresholds.

    Parameters
    ----------
    grid
        Locations of the fitted exemplar.
    levels
        Level 0 (finest) .. N.
    features
        What the columns of every feature table are.
    border
        Border rule of the pyramid, which the collapse follows.
    rows, columns
        (H,) and (W,) int32: which row and column of the exemplar each of the fitted one shows.
    whole
        Rows and columns of the coarsest level whose cells hold nothing padded.
    seams
        How well places of the coarsest level continue each other.
    notes
        What was done to the exemplar, one sentence each.
    """

    grid: Grid
    levels: tuple[Level, ...]
    features: tuple[Feature, ...]
    border: Border
    rows: NDArray[np.int32]
    columns: NDArray[np.int32]
    whole: tuple[int, int]
    seams: Seams
    notes: tuple[str, ...]

    @property
    def depth(self) -> int:
        """Index N of the coarsest level, and the number of levels that constrain."""
        return self.grid.depth

    @property
    def feature_names(self) -> tuple[str, ...]:
        """Names of the features, as threshold tables use them."""
        return tuple(feature.name for feature in self.features)

    @property
    def channels(self) -> int:
        """Channels of the image."""
        return int(self.levels[0].band.shape[1])

    def level_of(self, k: int) -> int:
        """Return the level that row k (1 = coarsest) of the threshold table belongs to."""
        return self.depth + 1 - k


def analyze_steps(
    pixels: NDArray[np.float32],
    *,
    smallest: int = 8,
    border: ExemplarBorder = "reflect",
    fitting: Fitting = "crop",
    depth: int | None = None,
    normalization: Normalization = "variance",
    filters: FilterSet = "both",
    orientations: int = 4,
    filter_size: int = 5,
    channels: Channels = "all",
) -> Generator[tuple[int, int], None, Analysis]:
    """Analyze an exemplar, yielding (done, total) on the way.

    Parameters
    ----------
    pixels
        (H, W, C) float32.
    smallest
        Shorter side that the coarsest level may not fall below, in pixels.
    fitting
        How the sides of the exemplar become multiples of 2^N.
    depth
        N; None takes the largest that ``smallest`` and ``fitting`` allow.
    border
        Border rule of the pyramid; ``smooth`` is periodic after the removal of the smooth component that makes
        opposite borders differ (Moisan 2011).
    normalization
        Z of eq. 10: the feature's variance, the mean variance of all features of the level, the squared range,
        the sum of squares over all pixels, or the size of the sum over all pixels, as it is printed.
    filters, orientations, filter_size
        Filter bank.
    channels
        Which planes have features, see :func:`texlab_core.methods.de_bonet.channels.planes_of`; colours always
        move together.

    Returns
    -------
    Analysis

    Reference: De Bonet 1997, section 4.2, eqs. 5, 7, 8 and 10.
    """
    height, width, _ = pixels.shape
    if depth is None:
        depth = choose_depth(height, width, smallest, fitting)
    fitted = fit(pixels, depth, border, fitting)
    grid = fitted.grid
    rule: Border = "reflect" if border == "reflect" else "periodic"
    planes = planes_of(fitted.pixels, channels)
    features = feature_list(planes.names, filters, orientations)
    kinds = {feature.kind for feature in features}
    total = sum(grid.count(i) * (2 + (len(features) + 3 if i else 0)) for i in range(depth + 1))
    done = 0
    levels = []
    gaussian = fitted.pixels
    for i in range(depth + 1):
        coarser, band = gaussian, gaussian.astype(np.float64)
        if i < depth:
            coarser, band = yield from through(_split(gaussian, rule), (done, total))
        done += 2 * grid.count(i)
        measured = np.empty((len(features) if i else 0, *grid.shape(i)), np.float32)
        if i > 0:
            filling = _measure(
                planes.see(gaussian), planes.see(band), measured, kinds, orientations, filter_size, rule
            )
            yield from through(filling, (done, total))
        levels.append(
            (
                yield from through(
                    finish_level(grid, i, band, measured, normalization, planes.stretch), (done, total)
                )
            )
        )
        done += grid.count(i) * (len(features) + 3 if i else 0)
        gaussian = coarser
        yield done, total
    seams = Seams.of(fitted.pixels, grid.rows, grid.columns)
    return Analysis(
        grid, tuple(levels), features, rule, fitted.rows, fitted.columns, fitted.whole, seams, fitted.notes
    )


def _split(
    gaussian: NDArray[np.float32], border: Border
) -> Generator[None, None, tuple[NDArray[np.float32], NDArray[np.float64]]]:
    """Return the coarser level and the band that it lacks (eq. 5)."""
    from texlab_core.kernels.collapse import expand_rows
    from texlab_core.transforms.gaussian import reduce

    coarser = reduce(gaussian, border)
    height, width, channels = gaussian.shape
    expanded = np.empty_like(gaussian)
    framed = np.empty((width // 2 + 2, channels), np.float32)
    band = np.empty(gaussian.shape, np.float64)
    for first, last in row_bounds((height, width * channels), PIXELS_AT_ONCE):
        expand_rows(coarser, border == "periodic", framed, expanded, first, last)
        band[first:last] = gaussian[first:last]
        band[first:last] -= expanded[first:last]
        yield
    return coarser, band


def _measure(
    gaussian: NDArray[np.float32],
    band: NDArray[np.float64],
    out: NDArray[np.float32],
    kinds: set[FeatureKind],
    orientations: int,
    filter_size: int,
    border: Border,
) -> Generator[None, None, None]:
    """Fill ``out`` (J, h, w) in the order of ``feature_list``; eq. 7 where the level is too small."""
    from texlab_core.transforms.oriented import derivatives

    channels = gaussian.shape[2]
    for channel in range(channels):
        out[channel] = band[..., channel]
    first = channels
    orders: tuple[tuple[FeatureKind, Order], ...] = (("first", 1), ("second", 2))
    for kind, order in orders:
        if kind not in kinds:
            continue
        last = first + orientations * channels
        if min(gaussian.shape[:2]) < filter_size:
            out[first:last] = 0
        else:
            for channel in range(channels):
                plane = np.ascontiguousarray(gaussian[..., channel])
                found = derivatives(plane, order, orientations, size=filter_size, border=border)
                out[first + channel : last : channels] = found
                yield
        first = last


def finish_level(
    grid: Grid,
    i: int,
    band: NDArray[np.float64],
    measured: NDArray[np.float32],
    normalization: Normalization,
    stretch: float,
) -> Generator[None, None, Level]:
    """Normalize the features of a level, (J, h, w) float32, and bring everything into quadtree order."""
    from texlab_core.kernels.classes import classify_rows

    columns, height, width = measured.shape
    scale = stretch * (yield from _scales(measured, normalization))
    factor = np.where(np.isfinite(scale), 1 / np.sqrt(scale), 0).astype(np.float32)
    level = Level(
        band=np.empty((height * width, band.shape[2])),
        features=np.empty((height * width, columns), np.float32),
        classes=np.zeros(height * width, np.int32),
        scale=scale,
        coordinates=np.empty((height * width, 2), np.int32),
    )
    row_part, column_part = grid.parts(i)
    for first, last in row_bounds((height, width * max(1, columns)), PIXELS_AT_ONCE):
        order = row_part[first:last, None] + column_part
        level.band[order] = band[first:last]
        level.coordinates[order, 0] = np.arange(first, last, dtype=np.int32)[:, None]
        level.coordinates[order, 1] = np.arange(width, dtype=np.int32)
        # Adding zero turns -0.0 into 0.0: rows that are equal have equal bits.
        level.features[order] = np.moveaxis(measured[:, first:last], 0, -1) * factor + np.float32(0)
        yield
    if columns:
        table = np.full(1 << (2 * height * width - 1).bit_length(), -1, np.int32)
        words, found = level.features.view(np.uint32), 0
        for first, last in row_bounds((height * width, columns), PIXELS_AT_ONCE):
            found = classify_rows(words, table, level.classes, found, first, last)
            yield
    for array in (level.band, level.features, level.classes, level.scale, level.coordinates):
        array.flags.writeable = False
    return level


def _scales(
    measured: NDArray[np.float32], normalization: Normalization
) -> Generator[None, None, NDArray[np.float64]]:
    """Return Z of eq. 10 for every feature of a level, infinite for the constant ones."""
    spread, scale = np.empty(len(measured)), np.empty(len(measured))
    for j, plane in enumerate(measured):
        spread[j] = np.ptp(plane)
        if normalization == "sum":
            scale[j] = np.einsum("yx,yx->", plane, plane, dtype=np.float64)
        elif normalization == "printed":
            scale[j] = max(abs(plane.sum(dtype=np.float64)), _SMALLEST_SUM)
        else:
            scale[j] = spread[j] ** 2 if normalization == "range" else np.var(plane, dtype=np.float64)
        yield
    constant = spread <= _CONSTANT
    if normalization == "level" and not constant.all():
        scale[:] = scale[~constant].mean()
    scale[constant] = np.inf
    return scale
