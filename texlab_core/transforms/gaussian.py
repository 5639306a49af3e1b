"""Gaussian pyramid: reduce and expand with the 5-tap binomial filter.

The sample (i, j) of a coarse level lies on the sample (2i, 2j) of the finer one. Both operations see the image go
on beyond its border in one of three ways:

``reflect``
    Mirrored about the centre of the outermost pixel, without repeating it (d c b | a b c d | c b a), so that the
    mirror of a level is the mirror of the level below it.
``periodic``
    Repeated; with sides that halve evenly the pyramid then commutes with circular shifts.
``spread``
    Repeated, and at an odd side N the ceil(N / 2) coarse samples lie evenly around it, N / ceil(N / 2) apart, with
    the filter stretched to fit, so that no place is a seam. At even sides the same as ``periodic``.

A constant image stays constant in both directions, at the borders too.

Reference: Burt and Adelson 1983; Heeger and Bergen 1995, section 2.1; Forsyth and Ponce, section 11.2.1.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeVar, get_args

import numpy as np

from texlab_core.transforms import spread
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

Border = Literal["reflect", "periodic", "spread"]
Expansion = Literal["interpolate", "replicate"]
FloatT = TypeVar("FloatT", np.float32, np.float64)

BINOMIAL = (1 / 16, 4 / 16, 6 / 16, 4 / 16, 1 / 16)


def reduce(image: NDArray[FloatT], border: Border = "reflect") -> NDArray[FloatT]:
    """Smooth with 1/16 (1, 4, 6, 4, 1) along both axes and keep every second sample.

    Parameters
    ----------
    image
        (H, W) or (H, W, C), float32 or float64, any size from 1 x 1.
    border
        How the image goes on beyond its border.

    Returns
    -------
    ndarray
        (ceil(H / 2), ceil(W / 2)) or with C behind, of the same type.
    """
    import cv2

    _check(image, border)
    if border == "spread" and (image.shape[0] % 2 or image.shape[1] % 2):
        return spread.reduce(image)
    kind = cv2.BORDER_REFLECT_101 if border == "reflect" else cv2.BORDER_WRAP
    height, width = image.shape[:2]
    small = cv2.pyrDown(np.ascontiguousarray(image), borderType=kind)
    # OpenCV drops a channel axis of length 1.
    return small.reshape((-(-height // 2), -(-width // 2), *image.shape[2:]))


def expand(
    image: NDArray[FloatT],
    shape: Sequence[int],
    border: Border = "reflect",
    mode: Expansion = "interpolate",
) -> NDArray[FloatT]:
    """Double the size of an image.

    Parameters
    ----------
    image
        (h, w) or (h, w, C), float32 or float64.
    shape
        Height and width of the result; ``h = ceil(H / 2)`` and ``w = ceil(W / 2)``. Further entries are ignored,
        so that the shape of the finer level can be given as it is.
    border
        How the finer image goes on beyond its border, as in :func:`reduce`. At an odd side a periodic image
        is as if its last sample were doubled, so that a constant stays one.
    mode
        ``interpolate``: zeros in between, then twice the filter of :func:`reduce` along each axis.
        ``replicate``: each sample becomes a block of 2 x 2.

    Returns
    -------
    ndarray
        (H, W) or (H, W, C), of the same type.

    Raises
    ------
    ValueError
        When the sizes do not belong to each other.

    Reference: Heeger and Bergen 1995, section 2.1 (interpolate); Forsyth and Ponce, algorithm 11.1 (replicate).
    """
    _check(image, border)
    height, width = int(shape[0]), int(shape[1])
    if image.shape[:2] != (-(-height // 2), -(-width // 2)):
        raise ValueError(f"expand: an image of {image.shape[:2]} cannot become one of {(height, width)}.")
    if border == "spread" and (height % 2 or width % 2):
        return spread.expand(image, (height, width), mode)
    if mode == "replicate":
        return image.repeat(2, axis=0)[:height].repeat(2, axis=1)[:, :width]
    if mode != "interpolate":
        raise ValueError(f"expand: mode must be one of {', '.join(get_args(Expansion))}, got {mode!r}.")
    import cv2

    rows, columns = _surround(height, border), _surround(width, border)
    # A frame of one coarse sample decides the border; what OpenCV does beyond it is cut off.
    framed = image.take(rows, axis=0).take(columns, axis=1)
    large = cv2.pyrUp(framed).reshape((2 * len(rows), 2 * len(columns), *image.shape[2:]))
    return large[2 : 2 + height, 2 : 2 + width]


def max_levels(shape: Sequence[int]) -> int:
    """Return how often an image of this height and width can be reduced until its shorter side is 1."""
    return (min(shape[0], shape[1]) - 1).bit_length()


def build(
    image: NDArray[FloatT], levels: int, border: Border = "reflect", *, look: Callable[[], None] = go_on
) -> list[NDArray[FloatT]]:
    """Return the Gaussian pyramid: the image itself and ``levels`` reductions of it, finest first.

    ``look`` is called between the levels and may raise to stop.
    """
    pyramid = [image]
    for _ in range(levels):
        look()
        pyramid.append(reduce(pyramid[-1], border))
    return pyramid


def _surround(fine: int, border: Border) -> list[int]:
    """Return the coarse samples that make a side of length ``fine``, with one more at each end."""
    coarse = -(-fine // 2)
    if border != "reflect":
        return [coarse - 1, *range(coarse), 0]
    # Mirroring the fine samples about 2m - 1 (even side) repeats the last coarse one; about 2m - 2 it does not.
    last = coarse - 1 if fine % 2 == 0 else max(coarse - 2, 0)
    return [min(1, coarse - 1), *range(coarse), last]


def _check(image: NDArray[FloatT], border: Border) -> None:
    if image.ndim not in (2, 3) or image.size == 0:
        raise ValueError(f"A pyramid needs an array of shape (H, W) or (H, W, C), got {image.shape}.")
    if image.dtype not in (np.float32, np.float64):
        raise ValueError(f"A pyramid needs float32 or float64, got {image.dtype}.")
    if border not in get_args(Border):
        raise ValueError(f"border: must be one of {', '.join(get_args(Border))}, got {border!r}.")
