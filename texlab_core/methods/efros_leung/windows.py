"""Windows to compare: shapes, and integer weights that keep every distance exact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.kernels.neighbourhood_types import Window

Shape = Literal["square", "disc", "cross", "causal"]
Criterion = Literal["ssd", "flat-ssd", "sad", "ncc"]
Border = Literal["inside", "periodic"]
TauScale = Literal["relative", "absolute"]

# sum of weights x channels x 255^2 stays below 2^31: every distance is exact in 32 bits.
LARGEST_SUM = (2**31 - 1) // 255**2
# Standard deviation in gray levels from which a relative tau counts in full: that of a usual texture.
FULL_SPREAD = 40.0
# Pixels of an exemplar whose spread is taken.
_SAMPLED = 2**20


@dataclass(frozen=True, kw_only=True)
class Matching:
    """How windows are compared and which candidates match.

    Parameters
    ----------
    window
        Side of the window in pixels, odd.
    shape
        Which offsets belong to it.
    criterion
        Gaussian-weighted or flat sum of squared differences, weighted sum of absolute differences, or weighted
        zero-mean normalized correlation over all channels together.
    eps, tau
        The match set is d <= max((1 + eps) d_min, tau^2); eps counts in millionths,
        tau (gray levels) in thousandths.
    error_limit
        Gray levels; a pixel is filled only while its d_min is within error_limit^2, which grows by 1.1 when a
        whole layer finds nothing. 0 is no limit.
    border
        Windows of the exemplar lie inside of it, or continue it periodically.
    tiles
        The output continues periodically.
    """

    window: int = 15
    shape: Shape = "square"
    criterion: Criterion = "ssd"
    eps: float = 0.1
    tau: float = 3.0
    error_limit: float = 0.0
    border: Border = "inside"
    tiles: bool = False

    @property
    def causal(self) -> bool:
        """Whether pixels are filled row by row."""
        return self.shape == "causal"

    @property
    def wraps(self) -> bool:
        """Whether the output is periodic: a causal window sees nothing ahead and cannot close the tile."""
        return self.tiles and not self.causal

    @property
    def limit(self) -> float:
        """``error_limit`` in the units of the distance; infinite without a limit or for a causal window."""
        if self.error_limit == 0.0 or self.causal:
            return float("inf")
        return in_distance_units(self.error_limit, self.criterion)


def in_distance_units(level: float, criterion: Criterion) -> float:
    """Return a difference in gray levels as a distance: squared, itself for SAD, (level / 255)^2 for NCC."""
    if criterion == "sad":
        return level
    return (level / 255.0) ** 2 if criterion == "ncc" else level**2


def effective_tau(tau: float, scale: TauScale, criterion: Criterion, pixels: NDArray[np.float32]) -> float:
    """Return tau in gray levels of an exemplar.

    Parameters
    ----------
    tau
        As the user has it, in gray levels.
    scale
        ``relative``: in full where the exemplar's values spread by at least 40 gray levels (standard deviation,
        root mean square over the channels), in proportion below; ``absolute``: in full.
    criterion
        Correlation knows no contrast, so that its tau is the same for all exemplars.
    pixels
        (H, W, C) float32 in [0, 1].
    """
    if scale == "absolute" or criterion == "ncc":
        return tau
    samples = pixels.reshape(-1, pixels.shape[2])
    samples = samples[:: max(1, len(samples) // _SAMPLED)]
    spread = 255 * float(np.sqrt(samples.var(axis=0, dtype=np.float64).mean()))
    return tau * min(1.0, spread / FULL_SPREAD)


def offsets(shape: Shape, window: int) -> NDArray[np.int64]:
    """Return the offsets (row, column) of a window without its centre.

    Parameters
    ----------
    shape
        ``square``; ``disc`` of diameter ``window``; ``cross``, row and column of the centre; ``causal``,
        the rows above and what is left of the centre.
    window
        Side in pixels, odd.

    Returns
    -------
    (n, 2) int64, nearest first.

    Reference
    ---------
    Forsyth & Ponce, 11.3.4 and programming assignment c.
    """
    reach = window // 2
    rows, columns = (axis.ravel() for axis in np.mgrid[-reach : reach + 1, -reach : reach + 1])
    distance = rows**2 + columns**2
    belongs = {
        "square": distance > 0,
        "disc": (distance > 0) & (4 * distance <= window**2),
        "cross": (distance > 0) & ((rows == 0) | (columns == 0)),
        "causal": (rows < 0) | ((rows == 0) & (columns < 0)),
    }[shape]
    order = np.argsort(distance[belongs], kind="stable")
    return np.stack([rows[belongs], columns[belongs]], axis=1)[order].astype(np.int64)


def integer_weights(
    places: NDArray[np.int64], window: int, criterion: Criterion, channels: int
) -> NDArray[np.int32]:
    """Return integer weights >= 1 for offsets: Gaussian with sigma = window / 6.4, or flat.

    The Gaussian is scaled as finely as exact sums in 32 bits allow.

    Reference
    ---------
    Efros & Leung 1999, section 2.1.
    """
    if criterion == "flat-ssd":
        return np.ones(len(places), np.int32)
    gaussian = np.exp(-np.sum(places**2, axis=1) / (2.0 * (window / 6.4) ** 2))
    largest = LARGEST_SUM // channels
    low, high = 1, 64 * largest
    while low < high:
        scale = (low + high + 1) // 2
        if _rounded(gaussian, scale).sum() <= largest:
            low = scale
        else:
            high = scale - 1
    return _rounded(gaussian, low)


def _rounded(gaussian: NDArray[np.float64], scale: int) -> NDArray[np.int32]:
    return np.maximum(np.rint(scale * gaussian), 1).astype(np.int32)


def make_window(matching: Matching, channels: int) -> Window:
    """Return offsets and weights as the kernels take them."""
    from texlab_core.kernels.neighbourhood_types import Window

    places = offsets(matching.shape, matching.window)
    weights = integer_weights(places, matching.window, matching.criterion, channels)
    rows, columns = np.ascontiguousarray(places.T)
    return Window(rows, columns, weights, matching.window // 2)
