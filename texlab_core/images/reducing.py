"""Pictures that are too large to be kept whole, scaled down or cropped a band of rows at a time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from scipy.sparse import csr_array

    from texlab_core.engine.inputs import Crop
    from texlab_core.engine.steps import FloatImage
    from texlab_core.images.unit_range import UnitRange


def reduced(
    image: UnitRange,
    size: tuple[int, int],
    target: tuple[int, int],
    crop: Crop,
    should_stop: Callable[[], bool] | None = None,
) -> tuple[FloatImage, FloatImage | None]:
    """Return a part of an image that is scaled down, without ever holding the image in floats.

    Parameters
    ----------
    image
        The picture in bands.
    size
        Its height and width.
    target
        Height and width of the whole picture after scaling; every pixel is the mean over its area.
    crop
        The part of that which is wanted, and which lies inside.
    should_stop
        See :meth:`UnitRange.bands`.

    Returns
    -------
    colours
        (H, W, C) float32 in [0, 1].
    alpha
        (H, W, 1), or None.
    """
    down = area_weights(size[0], target[0])[crop.top : crop.top + crop.height]
    across = area_weights(size[1], target[1])[crop.left : crop.left + crop.width]
    channels = image.channels + image.has_alpha
    total = np.zeros((crop.height, crop.width, channels), np.float64)
    columns = down.tocsc()
    for top, colours, alpha in image.bands(should_stop):
        band = colours if alpha is None else np.concatenate([colours, alpha], axis=2)
        weights = columns[:, top : top + band.shape[0]]
        touched = np.flatnonzero(np.diff(weights.tocsr().indptr))
        if touched.size == 0:
            continue
        rows = slice(int(touched[0]), int(touched[-1]) + 1)
        part = weights.tocsr()[rows]
        for channel in range(channels):
            total[rows, :, channel] += (part @ band[..., channel].astype(np.float64)) @ across.T
    values = total.clip(0, 1).astype(np.float32)
    return values[..., : image.channels], values[..., image.channels :] if image.has_alpha else None


def area_weights(length: int, target: int) -> csr_array:
    """Return the (target, length) matrix of the shares that source pixels have in the mean over each new one."""
    from scipy import sparse

    edges = np.arange(target + 1) * (length / target)
    edges[-1] = length
    first = np.minimum(edges[:-1].astype(np.int64), length - 1)
    count = int(np.ceil(length / target)) + 1
    columns = first[:, None] + np.arange(count)
    share = np.minimum(columns + 1, edges[1:, None]) - np.maximum(columns, edges[:-1, None])
    share = np.where(columns < length, share, 0).clip(0)
    rows = np.repeat(np.arange(target), count)
    weights = sparse.coo_array(
        (share.ravel() * (target / length), (rows, np.minimum(columns, length - 1).ravel())), (target, length)
    )
    matrix = weights.tocsr()
    matrix.eliminate_zeros()
    return matrix
