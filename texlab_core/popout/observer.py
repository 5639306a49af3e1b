"""A machine that plays along: it clicks on the window that differs most from the rest of the picture.

The measure of difference is D (De Bonet 1997, section 2), taken locally. As a viewer, the machine never sees the
exemplar: it compares every window of the piece's size with the rest of the same picture.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.measures.discriminability import BLOCK, BORDER, LAGS, block_starts, looks, whitening_of
from texlab_core.transforms.luma import luma
from texlab_core.transforms.octave_bands import oriented_bands
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage

# Windows and their sums go by cells of so many pixels.
CELL = 8


def observe(image: FloatImage, piece: tuple[int, int], look: Callable[[], None] = go_on) -> tuple[int, int] | None:
    """Return row and column of the middle of the window with the largest local D.

    Parameters
    ----------
    image
        (H, W, C) float32 in [0, 1].
    piece
        Height and width of what is looked for.
    look
        Called every few milliseconds; may raise to stop.

    Returns
    -------
    tuple or None
        None where piece or picture are too small to say anything: under 40 pixels, or with no room around.
    """
    found = local_difference(image, piece, look)
    if found is None:
        return None
    values, tops, lefts = found
    row, column = np.unravel_index(int(values.argmax()), values.shape)
    return int(tops[row]) + piece[0] // 2, int(lefts[column]) + piece[1] // 2


def local_difference(
    image: FloatImage, piece: tuple[int, int], look: Callable[[], None] = go_on
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]] | None:
    """Return the local D of every window of the piece's size, against the rest of the picture.

    D = ln(m + 0.001) + 2 ln(b + 0.05) as in :mod:`texlab_core.measures.discriminability`. b is the mean distance
    of the window's blocks to the nearest block that does not touch the window, under the covariance of all blocks
    of the picture; m is the RMS difference between the window's magnitude autocorrelation and that of the rest.

    Returns
    -------
    values, tops, lefts
        (rows, columns) float64, and first rows and columns of the windows; None where there are none.
    """
    size = image.shape[:2]
    inner = min(piece)
    if inner < BLOCK + CELL or any(side < n + BLOCK for side, n in zip(size, piece, strict=True)):
        return None
    tops, lefts = (np.arange(0, side - n + 1, CELL) for side, n in zip(size, piece, strict=True))
    m = _magnitude_differences(image, piece, tops, lefts, look)
    b = _block_distances(image, piece, tops, lefts, look)
    return np.log(m + 0.001) + 2 * np.log(b + 0.05), tops, lefts


def _block_distances(
    image: FloatImage,
    piece: tuple[int, int],
    tops: NDArray[np.int64],
    lefts: NDArray[np.int64],
    look: Callable[[], None],
) -> NDArray[np.float64]:
    from scipy.spatial.distance import cdist

    blocks = looks(image, look).blocks
    starts = block_starts(image.shape[:2])
    points = blocks @ whitening_of(blocks)
    look()
    distances = cdist(points, points, "sqeuclidean").astype(np.float32)
    look()
    rows, columns = (np.repeat(starts[0], len(starts[1])), np.tile(starts[1], len(starts[0])))
    found = np.empty((len(tops), len(lefts)))
    for i, top in enumerate(tops):
        touching = (rows > top - BLOCK) & (rows < top + piece[0])
        within = (rows >= top) & (rows <= top + piece[0] - BLOCK)
        for j, left in enumerate(lefts):
            look()
            inside = np.flatnonzero(within & (columns >= left) & (columns <= left + piece[1] - BLOCK))
            outside = np.flatnonzero(~(touching & (columns > left - BLOCK) & (columns < left + piece[1])))
            found[i, j] = _mean_nearest(distances, inside, outside)
    return found


def _mean_nearest(distances: NDArray[np.float32], inside: NDArray[np.int64], outside: NDArray[np.int64]) -> float:
    """Return the mean distance of some blocks to the nearest of others; 0 where there are none of either."""
    if not (len(inside) and len(outside)):
        return 0.0
    return float(np.sqrt(distances[np.ix_(inside, outside)].min(axis=1)).mean(dtype=np.float64))


def _magnitude_differences(
    image: FloatImage,
    piece: tuple[int, int],
    tops: NDArray[np.int64],
    lefts: NDArray[np.int64],
    look: Callable[[], None],
) -> NDArray[np.float64]:
    squares = np.zeros((len(tops), len(lefts)))
    count = 0
    for octave, _, band in oriented_bands(luma(image), 1, look):
        if octave:
            break
        magnitude = np.abs(band).astype(np.float64)
        # Wrapping at the picture's border is the same in all pictures, but not a texture's.
        magnitude[:BORDER] = magnitude[-BORDER:] = np.median(magnitude)
        magnitude[:, :BORDER] = magnitude[:, -BORDER:] = np.median(magnitude)
        look()
        for difference in _correlations(magnitude, piece, tops, lefts, look):
            squares += np.square(difference)
            count += 1
    return np.sqrt(squares / count)


def _correlations(
    magnitude: NDArray[np.float64],
    piece: tuple[int, int],
    tops: NDArray[np.int64],
    lefts: NDArray[np.int64],
    look: Callable[[], None],
) -> list[NDArray[np.float64]]:
    """Return for each lag the difference of the autocorrelations of window and rest, (rows, columns) each."""
    first, other = _means(magnitude, piece, tops, lefts)
    second, beyond = _means(np.square(magnitude), piece, tops, lefts)
    spread, spread_beyond = second - np.square(first), beyond - np.square(other)
    found = []
    for down in range(LAGS + 1):
        for across in range(-LAGS if down else 1, LAGS + 1):
            look()
            # Pairs that leave the picture wrap around into its median border.
            product = magnitude * np.roll(magnitude, (-down, -across), (0, 1))
            own, rest = _means(product, piece, tops, lefts)
            found.append(
                (own - np.square(first)) / np.maximum(spread, 1e-12)
                - (rest - np.square(other)) / np.maximum(spread_beyond, 1e-12)
            )
    return found


def _means(
    plane: NDArray[np.float64], piece: tuple[int, int], tops: NDArray[np.int64], lefts: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the means over every window and over the rest of the plane, (rows, columns) each."""
    totals = np.zeros((plane.shape[0] + 1, plane.shape[1] + 1))
    totals[1:, 1:] = plane.cumsum(axis=0).cumsum(axis=1)
    low, high = tops[:, None], tops[:, None] + piece[0]
    near, far = lefts[None], lefts[None] + piece[1]
    sums = totals[high, far] - totals[low, far] - totals[high, near] + totals[low, near]
    area = piece[0] * piece[1]
    return sums / area, (totals[-1, -1] - sums) / (plane.size - area)
