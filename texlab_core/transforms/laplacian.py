"""Laplacian pyramid: what each Gaussian level has beyond the prediction from the next coarser one.

Reference: Burt and Adelson 1983; Heeger and Bergen 1995, section 2.1; Forsyth and Ponce, algorithms 11.1 and 11.2.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from texlab_core.transforms.gaussian import Border, Expansion, FloatT, expand, reduce
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray


def build(
    image: NDArray[FloatT],
    levels: int,
    border: Border = "reflect",
    mode: Expansion = "interpolate",
    *,
    look: Callable[[], None] = go_on,
) -> list[NDArray[FloatT]]:
    """Split an image into bands: L_i = G_i - expand(G_{i+1}) and L_N = G_N.

    Parameters
    ----------
    image
        (H, W) or (H, W, C), float32 or float64, any size.
    levels
        Number N of band-pass levels; 0 gives the image alone.
    border, mode
        See :mod:`texlab_core.transforms.gaussian`.
    look
        Called between the levels; may raise to stop.

    Returns
    -------
    list of ndarray
        N band-pass levels, finest first, and the low-pass residual.
    """
    bands = []
    for _ in range(levels):
        look()
        coarser = reduce(image, border)
        look()
        bands.append(image - expand(coarser, image.shape, border, mode))
        image = coarser
    bands.append(image)
    return bands


def collapse(
    pyramid: Sequence[NDArray[FloatT]],
    border: Border = "reflect",
    mode: Expansion = "interpolate",
    *,
    look: Callable[[], None] = go_on,
) -> NDArray[FloatT]:
    """Return the image that a Laplacian pyramid was built from, up to rounding.

    Parameters
    ----------
    pyramid
        As from :func:`build`.
    border, mode
        As they were given to :func:`build`.
    look
        Called between the levels; may raise to stop.
    """
    image = pyramid[-1]
    for band in reversed(pyramid[:-1]):
        look()
        image = band + expand(image, band.shape, border, mode)
    return image
