"""The compiled search of non-parametric sampling: what its arrays are called.

The types are part of the key under which compiled code is cached, so that a change here reaches it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

SSD, SAD, NCC = 0, 1, 2
UNKNOWN, KNOWN, QUEUED = 0, 1, 2

# Candidates in a row that are summed together.
LANES = 64
# Entries between two looks at the limit.
STRIDE = 4
BUCKETS = 64
NEVER = np.inf

# Places in ``Search.numbers`` (integers) and ``Search.levels`` (floats).
POSITION, STARTED, FILLED, ENTRIES, NEXT, LAST, COLUMN, COLUMN_END, FOUND, EXCLUDED = range(10)
BEST, LIMIT, WEIGHT, TARGET, SQUARES, LAYER_BEST, ERROR_LIMIT = range(7)


class Pool(NamedTuple):
    """The candidates: the exemplar as planes of bytes, row by row, one after the other.

    ``values`` is (channels x plane + tail,) uint8 with a tail that blocks may run into; ``allowed`` is (plane,)
    uint8, 1 where the window's centre may be; ``before`` is (plane + 1,) int64, how many are allowed before it.
    ``margin`` is the width of the periodic continuation on each side (0 without).
    """

    values: NDArray[np.uint8]
    allowed: NDArray[np.uint8]
    before: NDArray[np.int64]
    mean: NDArray[np.float64]
    variance: NDArray[np.float64]
    plane: int
    stride: int
    margin: int
    height: int
    width: int


class Window(NamedTuple):
    """Offsets and weights, (n,) each, the nearest first."""

    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    weights: NDArray[np.int32]
    reach: int


class Canvas(NamedTuple):
    """The image being grown: ``values`` (C, H, W) uint8, (H, W) maps; ``source`` is row x width + column + 1."""

    values: NDArray[np.uint8]
    status: NDArray[np.uint8]
    source: NDArray[np.int32]
    order: NDArray[np.int32]
    matches: NDArray[np.int32]
    d_min: NDArray[np.float32]


class Rule(NamedTuple):
    """How to compare and choose: ``eps`` in millionths, ``tau`` in thousandths of a gray level."""

    criterion: int
    eps: int
    tau: int
    key: np.uint64
    tiles: bool
    leave_out: bool
    guesses: int


class Search(NamedTuple):
    """Working memory: the known part of the window as entries, the sums of a block, and what was found."""

    offset: NDArray[np.int64]
    weight: NDArray[np.int32]
    value: NDArray[np.int32]
    telling: NDArray[np.float64]
    bucket: NDArray[np.int64]
    counts: NDArray[np.int64]
    spare_offset: NDArray[np.int64]
    spare_weight: NDArray[np.int32]
    spare_value: NDArray[np.int32]
    sums: NDArray[np.int32]
    found: NDArray[np.int32]
    distance: NDArray[np.float64]
    numbers: NDArray[np.int64]
    levels: NDArray[np.float64]
