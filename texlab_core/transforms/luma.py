"""The one gray of a coloured picture: luma by the weights of BT.601."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

LUMA = (0.299, 0.587, 0.114)


def luma(image: NDArray[Any]) -> NDArray[Any]:
    """Return the luma of an image.

    Parameters
    ----------
    image
        (H, W, 1) or (H, W, 3), float32 or float64.

    Returns
    -------
    ndarray
        (H, W), C-contiguous, of the same type; the one channel of a gray image as it is.
    """
    if image.shape[2] == 1:
        return np.ascontiguousarray(image[..., 0])
    return np.ascontiguousarray(image @ np.array(LUMA, image.dtype))
