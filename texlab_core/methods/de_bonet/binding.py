"""Which cells of the threshold table bind: what each alone excludes, and what would be there without it.

A candidate is excluded by all the cells that it violates, so releasing one of several changes nothing. What counts
is the candidates that violate one cell and no other, at any level of their ancestors.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.work.tasks import finish

if TYPE_CHECKING:
    from collections.abc import Generator

    from numpy.typing import NDArray

    from texlab_core.methods.de_bonet.sampling import Sampling

# Parents of pixels that stand for all of them.
SAMPLED = 512


@dataclass(frozen=True, eq=False, slots=True)
class Binding:
    """What the cells of the threshold table do to a result, rows coarsest level first as in the table.

    Parameters
    ----------
    tested
        (N,) int64: how many exemplar locations were compared with an ancestor of a pixel at each level.
    excluded
        (N,) int64: how many of them violate at least one cell.
    violated
        (N, J) int64: how many violate each cell.
    alone
        (N, J) int64: how many violate that cell and no other one of their level.
    candidates
        Mean number of candidates of a pixel.
    released
        (N, J) float64: how many more there would be, on average, if this cell alone let everything through and all
        pixels' ancestors stayed as they are.
    """

    tested: NDArray[np.int64]
    excluded: NDArray[np.int64]
    violated: NDArray[np.int64]
    alone: NDArray[np.int64]
    candidates: float
    released: NDArray[np.float64]

    @property
    def alone_shares(self) -> NDArray[np.float64]:
        """(N, J) float64, 0 .. 1: the share of the exclusions of a level that each cell alone causes."""
        return self.alone / np.maximum(self.excluded, 1)[:, None]

    @property
    def strictest(self) -> tuple[int, int] | None:
        """Row and column of the cell whose release adds most candidates; None when none adds any."""
        if self.released.size == 0 or self.released.max() <= 0:
            return None
        row, column = np.unravel_index(int(self.released.argmax()), self.released.shape)
        return int(row), int(column)


def binding(sampling: Sampling, sampled: int | None = SAMPLED) -> Binding:
    """Measure what every cell of the threshold table excludes.

    Parameters
    ----------
    sampling
        From the details of a result.
    sampled
        How many parents of pixels to look at, evenly spread; None takes all of them.
    """
    return finish(binding_steps(sampling, sampled))


def binding_steps(sampling: Sampling, sampled: int | None = SAMPLED) -> Generator[tuple[int, int], None, Binding]:
    """Do what :func:`binding` does, yielding (done, total) after each parent of pixels."""
    from texlab_core.kernels.exclusion import near_set

    grid, exemplar = sampling.grid, sampling.analysis.grid
    depth, columns = grid.depth, len(sampling.analysis.features)
    totals = np.zeros((depth, 2), np.int64)
    violated, alone = np.zeros((depth, columns), np.int64), np.zeros((depth, columns), np.int64)
    released, matching = np.zeros(depth * columns, np.int64), 0
    count = grid.count(1) if depth else 0
    total = count if sampled is None else min(count, sampled)
    everything = np.arange(exemplar.count(depth), dtype=np.int32)
    for done, place in enumerate(np.linspace(0, max(count - 1, 0), total).astype(np.int64)):
        found, tags = everything, np.full(everything.size, -1, np.int32)
        for level in range(depth, 0, -1):
            row, fan = depth - level, 1 if level == depth else 4
            out, out_tags = np.empty(fan * found.size, np.int32), np.empty(fan * found.size, np.int32)
            source = int(sampling.sources[level][int(place) >> 2 * (level - 1)])
            features = sampling.analysis.levels[level].features
            end = near_set(
                found, tags, fan, features, sampling.row(level), source, row * columns, out, out_tags, totals[row],
                violated[row], alone[row],
            )  # fmt: skip
            found, tags = out[:end], out_tags[:end]
        matching += int((tags < 0).sum())
        released += np.bincount(tags[tags >= 0], minlength=released.size)
        yield done + 1, total
    # All four children of a match are candidates, or one of them.
    children = (4 if sampling.literal[0] else 1) if depth else 1
    return Binding(
        tested=totals[:, 0].copy(),
        excluded=totals[:, 1].copy(),
        violated=violated,
        alone=alone,
        candidates=children * matching / total if total else 1.0,
        released=children * released.reshape(depth, columns) / max(total, 1),
    )
