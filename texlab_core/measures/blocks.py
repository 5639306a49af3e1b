"""What the blocks of D say beyond their mean: the odd ones, those that are missing, and how much they vary."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.measures.discriminability import BLOCK, block_starts, described, distances
from texlab_core.measures.registry import Measure, register
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.measures.discriminability import PreparedLooks
    from texlab_core.measures.subject import Subject

_ENERGIES = 16
_FLOOR = 0.003


@dataclass(frozen=True, eq=False)
class BlockMap:
    """The distance of every block to the exemplar's most similar one.

    Parameters
    ----------
    distances
        (rows, columns) float64.
    tops, lefts
        First row and column of the blocks, which are ``side`` pixels wide and high.
    side
        32.
    """

    distances: NDArray[np.float64]
    tops: NDArray[np.int64]
    lefts: NDArray[np.int64]
    side: int = BLOCK


def block_map(subject: Subject) -> BlockMap | None:
    """Return a local D: how unlike the exemplar each block is. None where exemplar or picture are too small."""
    found = described(subject)
    if found is None:
        return None
    tops, lefts = block_starts(subject.image.shape[:2])
    return BlockMap(distances(subject, *found).reshape(len(tops), len(lefts)), tops, lefts)


def missing_distances(subject: Subject) -> NDArray[np.float64] | None:
    """Return the distance (n,) of each block of the exemplar to the picture's most similar one."""
    found = described(subject)
    if found is None:
        return None
    return subject.once("missing blocks", lambda: _back(subject, found[0].blocks @ found[1].whitening, found[1]))


def _back(subject: Subject, points: NDArray[np.float64], exemplar: PreparedLooks) -> NDArray[np.float64]:
    from scipy.spatial.distance import cdist

    nearest = np.empty(len(exemplar.blocks))
    for rows in row_blocks((len(nearest), len(points))):
        subject.look()
        nearest[rows] = cdist(exemplar.blocks[rows], points, "sqeuclidean").min(axis=1)
    return np.sqrt(nearest)


def block_distance_back(subject: Subject) -> float | None:
    """Return the median of :func:`missing_distances`."""
    found = missing_distances(subject)
    return None if found is None else float(np.median(found))


def odd_blocks(subject: Subject) -> float | None:
    """Return the 99th percentile of the distances of :func:`block_map`."""
    found = block_map(subject)
    return None if found is None else float(np.percentile(found.distances, 99))


def energy_spread(subject: Subject) -> float | None:
    """Return the root of the ratio of the variances of the blocks' log energies, result over exemplar.

    The geometric mean over 4 octaves of 4 orientations; a variance below 0.003 counts as that.
    """
    found = described(subject)
    if found is None:
        return None
    own = found[1].blocks @ np.linalg.inv(found[1].whitening)
    logs = [np.log(np.var(each[:, :_ENERGIES], axis=0) + _FLOOR) for each in (found[0].blocks, own)]
    return math.exp(float(np.mean(logs[0] - logs[1])) / 2)


register(
    Measure(
        id="block-distance-back",
        title="b back",
        summary="How far blocks of the exemplar are from the most similar block of the result, half of them: what "
        "of the exemplar is not there. Near 0 everything is there again, as in a copy.",
        low=0.0,
        high=1e4,
        better="neither",
        needs=("exemplar",),
        function=block_distance_back,
        form=".2f",
        order=63,
    )
)
register(
    Measure(
        id="odd-blocks",
        title="odd blocks",
        summary="How far the hundredth of the blocks that is most unlike the exemplar is from it: large "
        "where some "
        "place went wrong, even where the rest is right.",
        low=0.0,
        high=1e4,
        better="lower",
        needs=("exemplar",),
        function=odd_blocks,
        form=".2f",
        order=64,
    )
)
register(
    Measure(
        id="energy-spread",
        title="energy spread",
        summary="How much the strength of details varies from place to place, as a multiple of the exemplar's: 1 "
        "is right, below 1 the result is more even than the exemplar, above 1 less so.",
        low=0.0,
        high=1e4,
        better="neither",
        needs=("exemplar",),
        function=energy_spread,
        form=".2f",
        order=65,
    )
)
