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
