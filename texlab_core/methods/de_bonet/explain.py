"""Why a pixel is there: its ancestors, the candidates of each, and the constraints that left no others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from texlab_core.methods.de_bonet.sampling import match_chain

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.methods.de_bonet.features import Feature
    from texlab_core.methods.de_bonet.sampling import Sampling


class Strictest(NamedTuple):
    """The constraint that excludes most: its row in the threshold table, its column, and how many it excludes."""

    k: int
    feature: int
    excluded: int


@dataclass(frozen=True, eq=False, slots=True)
class ExplainedLevel:
    """The ancestor of a pixel at one level, or the pixel itself at level 0.

    Parameters
    ----------
    level
        0 is the finest.
    location
        Row and column in the output at this level.
    source
        Row and column in the fitted exemplar at this level.
    candidates
        (n, 2) int32 rows and columns in the fitted exemplar that ``source`` was chosen from; at the coarsest
        level, which is laid out and not sampled, the source alone.
    chosen
        Index of ``source`` among the candidates.
    matches
        (m, 2) int32 rows and columns that match this location here and at all coarser levels: M. Empty at level 0.
    tested
        How many locations were compared with this one to find the matches.
    violated
        (J,) int64: how many of those tested exceed the threshold of each feature; (0,) at level 0.
    alone
        (J,) int64: how many exceed that one and no other.
    """

    level: int
    location: tuple[int, int]
    source: tuple[int, int]
    candidates: NDArray[np.int32]
    chosen: int
    matches: NDArray[np.int32]
    tested: int
    violated: NDArray[np.int64]
    alone: NDArray[np.int64]


@dataclass(frozen=True, eq=False, slots=True)
class Explanation:
    """Why a pixel is there.

    Parameters
    ----------
    pixel
        Row and column in the result.
    levels
        Its ancestors, coarsest first; the pixel itself is the last.
    """

    pixel: tuple[int, int]
    levels: tuple[ExplainedLevel, ...]
    _sampling: Sampling

    @property
    def features(self) -> tuple[Feature, ...]:
        """What the columns of parent structures and thresholds are."""
        return self._sampling.analysis.features

    @property
    def thresholds(self) -> NDArray[np.float32]:
        """The threshold table, (N, J) float32, coarsest level first."""
        return self._sampling.thresholds

    def at(self, level: int) -> ExplainedLevel:
        """Return the ancestor at a level."""
        return self.levels[self._sampling.grid.depth - level]

    def exemplar_box(self, level: int, row: int, column: int) -> tuple[int, int, int]:
        """Return top, left and side, in pixels of the exemplar itself, of a location of a level."""
        analysis, side = self._sampling.analysis, 2**level
        # What was padded shows pixels that lie elsewhere.
        top = int(analysis.rows[row * side : (row + 1) * side].min())
        left = int(analysis.columns[column * side : (column + 1) * side].min())
        return top, left, side

    def parent_structure(self, level: int) -> NDArray[np.float32]:
        """Return the normalized features of the ancestors of the location at a level, N .. ``level + 1``.

        Returns
        -------
        ndarray
            (N - level, J) float32, coarsest first, as the rows of the threshold table.
        """
        sources = [self._location(each) for each in self.levels if each.level > level]
        levels = self._sampling.analysis.levels
        rows = [levels[m].features[q] for m, q in zip(self._constraining(level), sources, strict=True)]
        return np.array(rows, np.float32).reshape(len(rows), len(self.features))

    def candidate_structure(self, level: int, candidate: int) -> NDArray[np.float32]:
        """Return the same for a candidate of a level, given by its index."""
        row, column = self.at(level).candidates[candidate]
        grid, levels = self._sampling.analysis.grid, self._sampling.analysis.levels
        place = grid.location(level, int(row), int(column))
        rows = [levels[m].features[place >> 2 * (m - level)] for m in self._constraining(level)]
        return np.array(rows, np.float32).reshape(len(rows), len(self.features))

    def candidate_structures(self, level: int, candidates: NDArray[np.intp]) -> NDArray[np.float32]:
        """Return the same for several candidates, given by their indices: (n, N - level, J) float32."""
        grid, levels = self._sampling.analysis.grid, self._sampling.analysis.levels
        row_part, column_part = grid.parts(level)
        rows, columns = self.at(level).candidates[candidates].T
        places = row_part[rows] + column_part[columns]
        found = [levels[m].features[places >> 2 * (m - level)] for m in self._constraining(level)]
        return np.array(found, np.float32).reshape(len(found), places.size, len(self.features)).swapaxes(0, 1)

    def differences(self, level: int, candidate: int) -> NDArray[np.float32]:
        """Return D of eq. 10 between a candidate's parent structure and the pixel's, (N - level, J) float32."""
        difference = self.candidate_structure(level, candidate) - self.parent_structure(level)
        return difference * difference

    def strictest(self, level: int | None = None) -> Strictest | None:
        """Return the constraint that excludes most locations, of one level or of all, or None."""
        found: Strictest | None = None
        depth = self._sampling.grid.depth
        for each in self.levels:
            if each.level == 0 or (level is not None and each.level != level):
                continue
            feature = int(each.violated.argmax())
            count = int(each.violated[feature])
            if count > (found.excluded if found else 0):
                found = Strictest(depth - each.level + 1, feature, count)
        return found

    def _constraining(self, level: int) -> range:
        return range(self._sampling.grid.depth, level, -1)

    def _location(self, each: ExplainedLevel) -> int:
        return self._sampling.analysis.grid.location(each.level, *each.source)


def explain(sampling: Sampling, row: int, column: int) -> Explanation:
    """Explain a pixel.

    The candidate sets are found anew along the pixel's ancestors, so that it takes a few milliseconds at most and
    also answers where sampling itself listed no set.

    Parameters
    ----------
    sampling
        From the details of a result.
    row, column
        The pixel, within the output.

    Raises
    ------
    ParamError
        When the pixel is not in the output.
    """
    grid = sampling.grid
    place = grid.checked_location(0, row, column)
    chain = match_chain(sampling, 1, place >> 2) if grid.depth else []
    chain.append(np.empty(0, np.int32))
    above: NDArray[np.int32] | None = None
    levels = []
    for level, matches in zip(range(grid.depth, -1, -1), chain, strict=True):
        location = (row >> level, column >> level)
        levels.append(_explain_level(sampling, level, location, place >> 2 * level, above, matches))
        above = matches
    return Explanation((row, column), tuple(levels), sampling)


def _explain_level(
    sampling: Sampling,
    level: int,
    location: tuple[int, int],
    place: int,
    above: NDArray[np.int32] | None,
    matches: NDArray[np.int32],
) -> ExplainedLevel:
    from texlab_core.kernels.exclusion import count_exclusions

    analysed = sampling.analysis.levels[level]
    source = int(sampling.sources[level][place])
    if above is None:
        tested = np.arange(sampling.analysis.grid.count(level), dtype=np.int32)
        candidates = np.array([source], np.int32)
    else:
        tested = np.add.outer(4 * above, np.arange(4)).astype(np.int32).ravel()
        candidates = tested if sampling.literal[level] else tested[place & 3 :: 4]
    columns = len(sampling.analysis.features) if level else 0
    violated, alone = np.zeros(columns, np.int64), np.zeros(columns, np.int64)
    if level:
        count_exclusions(tested, analysed.features, sampling.row(level), source, violated, alone)
    row, column = analysed.coordinates[source]
    return ExplainedLevel(
        level=level,
        location=location,
        source=(int(row), int(column)),
        candidates=analysed.coordinates[candidates],
        chosen=int(np.searchsorted(candidates, source)),
        matches=analysed.coordinates[matches],
        tested=tested.size if level else 0,
        violated=violated,
        alone=alone,
    )
