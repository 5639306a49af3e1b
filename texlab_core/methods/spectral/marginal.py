"""The gray-level histogram in sixteen numbers, and matching to it with a lookup table.

Reference: Navarro & Portilla 1996, sections 3.1.4 and 3.2.4.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, get_args

import numpy as np

from texlab_core.methods.spectral.choices import HistogramKind
from texlab_core.methods.spectral.digits import keep_digits
from texlab_core.methods.spectral.fourier import BLOCK, Floats, Plane
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.engine.progress import Progress
    from texlab_core.engine.steps import Step

HISTOGRAM_KINDS = get_args(HistogramKind)
SAMPLES = 16
_SPACING = 17
_BLOCK = 16
# Gray levels by which the sampled histogram may be worse than block masses.
_TOLERANCE = 1.0
# Steps of the lookup table over the range of the plane to be matched.
_TABLE = 2**14


@dataclass(frozen=True)
class Histogram16:
    """A histogram of 256 gray levels in 16 numbers.

    Parameters
    ----------
    kind
        ``samples``: the low-passed histogram at gray levels 0, 17, .., 255; ``blocks``: the masses of 16 blocks.
    values
        16 numbers; masses per gray level for samples, masses for blocks.
    """

    kind: HistogramKind
    values: tuple[float, ...]

    def masses(self) -> Floats:
        """Return the decoded histogram: 256 masses that sum to 1."""
        values = np.array(self.values)
        if self.kind == "blocks":
            decoded = np.repeat(np.maximum(values, 0), _BLOCK)
        else:
            levels = np.arange(256.0)
            decoded = np.maximum(np.interp(levels, levels[::_SPACING], values), 0)
        total = decoded.sum()
        return decoded / total if total > 0 else np.full(256, 1 / 256)


def histogram256(plane: Plane, progress: Progress, stage: str) -> Generator[Step, None, Floats]:
    """Return the masses of the gray levels 0 .. 255 (nearest level; the plane is in gray levels)."""
    counts = np.zeros(256, np.int64)
    for rows in row_blocks(plane.shape, BLOCK):
        levels = np.rint(plane[rows]).astype(np.uint8)
        counts += np.bincount(levels.reshape(-1), minlength=256)
        yield progress.at(stage)
    return counts / plane.size


def encode_histogram(masses: Floats) -> Histogram16:
    """Code a histogram in 16 numbers: samples of the low-passed one, or block masses where those do better.

    Parameters
    ----------
    masses
        (256,) masses that sum to 1.

    Reference
    ---------
    Navarro & Portilla 1996, section 3.1.4, Fig. 5. Spikes at the ends (saturated photographs) make the odd
    extension explode; block masses are taken when they are more than 1 gray level closer.
    """
    sampled = Histogram16("samples", keep_digits(_lowpass(masses)[::_SPACING]))
    blocks = Histogram16("blocks", keep_digits(masses.reshape(SAMPLES, _BLOCK).sum(axis=1)))
    worse = gray_level_distance(sampled.masses(), masses) - gray_level_distance(blocks.masses(), masses)
    return blocks if worse > _TOLERANCE else sampled


def gray_level_distance(first: Floats, second: Floats) -> float:
    """Return the earth mover's distance of two histograms of unit mass, in gray levels."""
    return float(np.abs(np.cumsum(first) - np.cumsum(second)).sum())


def _lowpass(masses: Floats) -> Floats:
    # Odd extension about the end samples leaves exactly those two unchanged (Fig. 5).
    reach = _SPACING - 1
    before = 2 * masses[0] - masses[reach:0:-1]
    after = 2 * masses[-1] - masses[-2 : -2 - reach : -1]
    # A triangle of half height 17: with linear interpolation between the samples it keeps the mass.
    kernel = 1 - np.abs(np.arange(-reach, reach + 1)) / _SPACING
    return np.convolve(np.concatenate([before, masses, after]), kernel / kernel.sum(), mode="valid")


def quantiles(masses: Floats, ranks: Floats) -> Floats:
    """Return the gray levels at cumulative ranks in (0, 1).

    Level g stands for g - 1/2 .. g + 1/2, cut at 0 and 255.
    """
    edges = np.clip(np.arange(257) - 0.5, 0, 255)
    cumulative = np.concatenate([[0.0], np.cumsum(masses)])
    return np.asarray(np.interp(ranks, cumulative / cumulative[-1], edges))


@dataclass(frozen=True, eq=False)
class RankIndex:
    """A plane cut into equal steps, and the cumulative rank of every step.

    Parameters
    ----------
    index
        (H, W) uint16, the step of every pixel.
    ranks
        (n,) float64 in (0, 1), the middle rank of the pixels in each step.
    """

    index: NDArray[np.uint16]
    ranks: Floats


def rank_index(
    plane: Plane, low: float, high: float, progress: Progress, stage: str
) -> Generator[Step, None, RankIndex]:
    """Return the ranks of a plane's values to within a 16384th of its range, low to high."""
    scale = np.float32((_TABLE - 1) / (high - low)) if high > low else np.float32(0)
    index = np.empty(plane.shape, np.uint16)
    counts = np.zeros(_TABLE, np.int64)
    for rows in row_blocks(plane.shape, BLOCK):
        index[rows] = (plane[rows] - np.float32(low)) * scale
        counts += np.bincount(index[rows].reshape(-1), minlength=_TABLE)
        yield progress.at(stage, 0.5 * rows.stop / plane.shape[0])
    cumulative = np.cumsum(counts) / plane.size
    return RankIndex(index, cumulative - 0.5 * counts / plane.size)
