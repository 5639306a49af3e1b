"""How different two textures look: De Bonet's D, from the finest magnitudes (m) and from blocks (b).

D = ln(m + 0.001) + 2 ln(b + 0.05). Its constants and limits were chosen on results that were looked at and
labelled; see ``limits.py`` for the evidence.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.measures.registry import Measure, register
from texlab_core.transforms.luma import luma
from texlab_core.transforms.octave_bands import oriented_bands
from texlab_core.work.tasks import go_on, row_blocks

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.measures.subject import Subject

BLOCK = 32
STEP = 8
OCTAVES = 4
LAGS = 4
# Periodic wrapping and the smooth part's border show up to here.
BORDER = 12
COLOUR_WEIGHT = 3.0
# Share of the covariance, share of its diagonal, and what is added to the diagonal.
SHRINKAGE = (0.9, 0.1, 0.01)
# Makes b span the range that it has with hardly any constant on the diagonal, so that limits stay where they were.
SCALE = 1.4
SMALLEST = BLOCK + STEP
_MOST_BLOCKS = 4096
_FLOOR = 1e-10


@dataclass(frozen=True, eq=False)
class Looks:
    """What D compares.

    Parameters
    ----------
    lags
        (4, 9, 9) float64: autocorrelation of the standardized magnitudes in the finest octave, by orientation and
        by lag 0 .. 4, -4 .. -1 down and across.
    blocks
        (n, 19) float64: of each block log10 mean energies by octave and orientation, and weighted mean colours.
    """

    lags: NDArray[np.float64]
    blocks: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PreparedLooks:
    """The exemplar's looks, its blocks multiplied by ``whitening`` (19, 19): distances are then Mahalanobis's."""

    lags: NDArray[np.float64]
    blocks: NDArray[np.float64]
    whitening: NDArray[np.float64]


def looks(image: FloatImage, look: Callable[[], None]) -> Looks:
    """Describe an image (H, W, C) of at least 40 x 40 pixels; ``look`` is called between the pieces."""
    size = image.shape[:2]
    starts = block_starts(size)
    lags, features = [], []
    for octave, _, band in oriented_bands(luma(image), OCTAVES, look):
        energy = np.square(band.real)
        energy += np.square(band.imag)
        look()
        if octave == 0:
            lags.append(magnitude_lags(np.sqrt(energy[BORDER:-BORDER, BORDER:-BORDER])))
            look()
        features.append(np.log10(block_means(energy, size, starts) + _FLOOR))
        look()
    for channel in (0, 1, 2) if image.shape[2] == 3 else (0, 0, 0):
        features.append(COLOUR_WEIGHT * block_means(image[:, :, channel], size, starts))
        look()
    return Looks(np.array(lags), np.stack([each.reshape(-1) for each in features], axis=1))


def prepare(pixels: FloatImage, look: Callable[[], None]) -> PreparedLooks:
    """Describe an exemplar, and how its blocks scatter."""
    return prepared_looks(looks(pixels, look))


def prepared_looks(
    found: Looks, shrinkage: tuple[float, float, float] = SHRINKAGE, scale: float = SCALE
) -> PreparedLooks:
    """Return an exemplar's looks with its blocks whitened, by these constants of the covariance."""
    whitening = whitening_of(found.blocks, shrinkage) * scale
    return PreparedLooks(found.lags, found.blocks @ whitening, whitening)


def whitening_of(
    blocks: NDArray[np.float64], shrinkage: tuple[float, float, float] = SHRINKAGE
) -> NDArray[np.float64]:
    """Return the matrix (n, n) that blocks (m, n) are multiplied by, so that distances are their Mahalanobis's.

    They are divided by the square root of n. Of the covariance C, ``shrinkage`` takes so much of C, so much of its
    diagonal, and a constant on the diagonal.
    """
    covariance = np.cov(blocks, rowvar=False)
    whole, diagonal, constant = shrinkage
    steady = whole * covariance + np.diag(diagonal * np.diag(covariance) + constant)
    return np.asarray(np.linalg.inv(np.linalg.cholesky(steady)).T / math.sqrt(len(steady)))


def block_starts(size: tuple[int, ...]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first rows and columns of the blocks: every 8 px, or more where there would be over 4096."""
    step = STEP
    while math.prod((side - BLOCK) // step + 1 for side in size[:2]) > _MOST_BLOCKS:
        step += STEP
    return np.arange(0, size[0] - BLOCK + 1, step), np.arange(0, size[1] - BLOCK + 1, step)


def block_means(
    plane: NDArray[np.float32], size: tuple[int, ...], starts: tuple[NDArray[np.int64], NDArray[np.int64]]
) -> NDArray[np.float64]:
    """Return the means of blocks of an image of ``size`` from a plane of the same scene with fewer samples."""
    import cv2

    totals = np.asarray(cv2.integral(np.ascontiguousarray(plane)), np.float64)
    over = _sums(totals, size[0], starts[0])
    return np.ascontiguousarray(_sums(over.T, size[1], starts[1]).T) * (1 / BLOCK**2)


def _sums(running: NDArray[np.float64], length: int, starts: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return sums over 32 pixels down the rows of running sums; a sample that is cut counts in part."""
    samples = len(running) - 1

    def up_to(pixel: NDArray[np.int64]) -> NDArray[np.float64]:
        whole, part = np.divmod(pixel * samples, length)
        sums = running[whole]
        if part.any():
            following = running[np.minimum(whole + 1, samples)]
            sums = sums + (following - sums) * (part / length)[:, None]
        return np.asarray(sums)

    return np.asarray((up_to(starts + BLOCK) - up_to(starts)) * (length / samples))


def magnitude_lags(magnitude: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return the autocorrelation (9, 9) of standardized values by lag 0 .. 4, -4 .. -1; opposite borders meet."""
    from scipy import fft

    values = magnitude - np.float32(magnitude.mean(dtype=np.float64))
    values /= np.float32(max(math.sqrt(float(np.mean(np.square(values), dtype=np.float64))), 1e-6))
    spectrum = fft.rfft2(values)
    power = np.square(spectrum.real) + np.square(spectrum.imag)
    lag = np.concatenate([np.arange(LAGS + 1), np.arange(-LAGS, 0)])
    return np.asarray(fft.irfft2(power, s=values.shape)[np.ix_(lag, lag)] / values.size, np.float64)


def nearest_blocks(
    blocks: NDArray[np.float64], prepared: PreparedLooks, look: Callable[[], None] = go_on
) -> NDArray[np.float64]:
    """Return the distance of each block (n, 19) to the exemplar's nearest one."""
    from scipy.spatial.distance import cdist

    points = blocks @ prepared.whitening
    nearest = np.empty(len(points))
    for rows in row_blocks((len(points), len(prepared.blocks))):
        look()
        nearest[rows] = cdist(points[rows], prepared.blocks, "sqeuclidean").min(axis=1)
    return np.sqrt(nearest)


def described(subject: Subject) -> tuple[Looks, PreparedLooks] | None:
    """Return the looks of picture and exemplar; None without an exemplar, or where one is under 40 pixels."""
    if subject.exemplar is None or min(*subject.image.shape[:2], *subject.pixels.shape[:2]) < SMALLEST:
        return None
    exemplar = subject.prepared("looks", prepare)
    return subject.once("looks", lambda: looks(subject.image, subject.look)), exemplar


def magnitude_difference(subject: Subject) -> float | None:
    """Return m: the RMS difference of the magnitude autocorrelations in the finest octave."""
    found = described(subject)
    return None if found is None else math.sqrt(float(np.mean(np.square(found[0].lags - found[1].lags))))


def block_distance(subject: Subject) -> float | None:
    """Return b: the mean distance of the image's blocks to the nearest block of the exemplar."""
    found = described(subject)
    if found is None:
        return None
    return float(distances(subject, *found).mean())


def distances(subject: Subject, picture: Looks, exemplar: PreparedLooks) -> NDArray[np.float64]:
    """Return the distance of each block of the picture to the exemplar's nearest one, row by row."""
    return subject.once("nearest-blocks", lambda: nearest_blocks(picture.blocks, exemplar, subject.look))


def discriminability(subject: Subject) -> float | None:
    """Return D of m and b, as in :func:`joined`."""
    m, b = magnitude_difference(subject), block_distance(subject)
    return None if m is None or b is None else joined(m, b)


def joined(m: float, b: float) -> float:
    """Return D = ln(m + 0.001) + 2 ln(b + 0.05)."""
    return math.log(m + 0.001) + 2 * math.log(b + 0.05)


register(
    Measure(
        id="discriminability",
        title="D",
        summary="How different the textures look (De Bonet's discriminability), from -13 for the exemplar itself "
        "upwards: at -3.4 and below 19 of 20 results look right, at -2.1 and above 19 of 20 look wrong. It does "
        "not see copying: read it together with V and cuts.",
        low=-13.0,
        high=20.0,
        better="lower",
        needs=("exemplar",),
        function=discriminability,
        form=".2f",
        reference="J. S. De Bonet, SIGGRAPH 1997, section 2",
        live=True,
        order=10,
    )
)
register(
    Measure(
        id="magnitude-difference",
        title="m",
        summary="First group of D: how differently the finest details cluster (RMS difference of the "
        "autocorrelations of band-pass magnitudes at a quarter cycle per pixel); 0 for equal pictures.",
        low=0.0,
        high=2.0,
        better="lower",
        needs=("exemplar",),
        function=magnitude_difference,
        form=".3f",
        part_of="discriminability",
        live=True,
        order=11,
    )
)
register(
    Measure(
        id="block-distance",
        title="b",
        summary="Second group of D: how far blocks of 32 x 32 pixels are from the most similar block of the "
        "exemplar, in its own scatter of energies and colours; 0 where every block is one of the exemplar's.",
        low=0.0,
        high=1e4,
        better="lower",
        needs=("exemplar",),
        function=block_distance,
        form=".2f",
        part_of="discriminability",
        live=True,
        order=12,
    )
)
