"""Which constraint excludes how many locations from a set of candidates."""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.kernels.jit import njit

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@njit
def count_exclusions(
    tested: NDArray[np.int32],
    features: NDArray[np.float32],
    thresholds: NDArray[np.float32],
    source: int,
    violated: NDArray[np.int64],
    alone: NDArray[np.int64],
) -> None:
    """Add up, feature by feature, the locations that violate it, and those that violate nothing else.

    Parameters
    ----------
    tested
        Exemplar locations of one level.
    features, thresholds
        (P, J) and (J,).
    source
        The location that they are compared with.
    violated, alone
        (J,) counts.
    """
    for q in tested:
        count, last = 0, 0
        for j in range(thresholds.size):
            difference = features[q, j] - features[source, j]
            if difference * difference > thresholds[j]:
                violated[j] += 1
                count, last = count + 1, j
        if count == 1:
            alone[last] += 1


@njit
def near_set(
    parents: NDArray[np.int32],
    tags: NDArray[np.int32],
    fan: int,
    features: NDArray[np.float32],
    thresholds: NDArray[np.float32],
    source: int,
    first_tag: int,
    out: NDArray[np.int32],
    out_tags: NDArray[np.int32],
    totals: NDArray[np.int64],
    violated: NDArray[np.int64],
    alone: NDArray[np.int64],
) -> int:
    """List the children that match ``source``, or would if one cell of the threshold table were released.

    Parameters
    ----------
    parents, tags
        (n,) exemplar locations of the coarser level, and which cell each of them violates; -1 for none.
    fan
        4, or 1 at the coarsest level, where the parents stand for themselves.
    features, thresholds
        (P, J) and (J,) of this level.
    first_tag
        The cell of feature 0 at this level.
    out, out_tags
        (fan * n,): what was found, and what it violates in all.
    totals
        (2,) added to: children of parents that violate nothing, and how many of these violate something.
    violated, alone
        (J,) added to, among these: how many violate each feature, and that one alone.

    Returns
    -------
    int
        How many were found.
    """
    end = 0
    for i in range(parents.size):
        for q in range(parents[i] * fan, parents[i] * fan + fan):
            count, last = 0, -1
            for j in range(thresholds.size):
                difference = features[q, j] - features[source, j]
                if difference * difference > thresholds[j]:
                    count, last = count + 1, j
                    if tags[i] < 0:
                        violated[j] += 1
                    else:
                        break
            if tags[i] < 0:
                totals[0] += 1
                if count:
                    totals[1] += 1
                if count == 1:
                    alone[last] += 1
            if count == 0 or (count == 1 and tags[i] < 0):
                out[end] = q
                out_tags[end] = tags[i] if count == 0 else first_tag + last
                end += 1
    return end
