"""Views of a textured plane: rendered slanted, area-averaged, and turned back to the front.

Reference: Forsyth and Ponce, section 11.4.1 (viewing transformation and its inverse).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np

from texlab_core.errors import ParamError
from texlab_core.shape.orientation import MOST_SLANT

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.shape.orientation import Orientation

    Plane = NDArray[np.float32]

Beyond = Literal["mirrored", "repeated"]


def slanted_plane(
    texture: Plane, orientation: Orientation, size: tuple[int, int], *, beyond: Beyond = "repeated"
) -> Plane:
    """Render a textured plane orthographically.

    Parameters
    ----------
    texture
        (h, w) float32; its centre is seen in the middle of the picture.
    orientation
        Of the plane, slanted by at most 80 degrees.
    size
        Height and width of the picture.
    beyond
        How the plane goes on beyond the texture.

    Returns
    -------
    ndarray
        (H, W) float32. Each pixel is the mean of ceil(1 / cos slant)² samples, so that nothing aliases where the
        texture is packed more densely than the pixels.

    Raises
    ------
    ParamError
        When the slant is above 80 degrees.
    """
    if orientation.slant > MOST_SLANT:
        raise ParamError("slant", f"at most {MOST_SLANT:g} degrees for a picture", orientation.slant)
    import cv2

    times = max(1, math.ceil(1 / orientation.cosine - 1e-9))
    height, width = size
    to_plane = np.linalg.inv(orientation.foreshortening())
    centre = np.array([width * times - 1, height * times - 1]) / 2
    middle = np.array([texture.shape[1] - 1, texture.shape[0] - 1]) / 2
    warp = np.column_stack([to_plane / times, middle - to_plane @ centre / times])
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    border = cv2.BORDER_WRAP if beyond == "repeated" else cv2.BORDER_REFLECT_101
    fine = cv2.warpAffine(texture, warp, (width * times, height * times), flags=flags, borderMode=border)
    if times > 1:
        fine = cv2.resize(fine, (width, height), interpolation=cv2.INTER_AREA)
    return np.asarray(fine, np.float32)


def rectified(image: Plane, orientation: Orientation, fill: float | None = None) -> Plane:
    """Turn the view of a plane back to the front: what a hypothesis says the texture looks like.

    Parameters
    ----------
    image
        (H, W) float32.
    orientation
        The hypothesis.
    fill
        Gray level where the picture shows nothing of the plane; None takes the picture's mean.

    Returns
    -------
    ndarray
        (H, W) float32 around the picture's centre.
    """
    import cv2

    height, width = image.shape
    middle = np.array([width - 1, height - 1]) / 2
    matrix = orientation.foreshortening()
    warp = np.column_stack([matrix, middle - matrix @ middle])
    level = float(image.mean(dtype=np.float64)) if fill is None else fill
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    flat = cv2.warpAffine(
        image, warp, (width, height), flags=flags, borderMode=cv2.BORDER_CONSTANT, borderValue=level
    )
    return np.asarray(flat, np.float32)
