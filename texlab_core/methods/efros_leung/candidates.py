"""The exemplar as a pool of candidates: its bytes in the layout of the kernels, and where windows may lie."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from texlab_core.methods.efros_leung.windows import offsets

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.kernels.neighbourhood_types import Pool
    from texlab_core.methods.efros_leung.windows import Matching


def to_bytes(pixels: FloatImage) -> NDArray[np.uint8]:
    """Return (C, H, W) uint8 gray levels of (H, W, C) pixels in [0, 1]: what the comparisons see."""
    return np.ascontiguousarray(np.moveaxis(np.rint(pixels * np.float32(255.0)).astype(np.uint8), 2, 0))


def may_be_copied(
    size: tuple[int, int], matching: Matching, region: NDArray[np.bool_] | None, hole: NDArray[np.bool_] | None
) -> NDArray[np.bool_]:
    """Return where in an exemplar of this size the centre of a candidate may be.

    Parameters
    ----------
    size
        Height and width of the exemplar.
    region
        (H, W) bool, pixels that may be copied; None for all.
    hole
        (H, W) bool, pixels without content: no window may touch one; None for none.
    """
    allowed = np.ones(size, bool) if region is None else region.copy()
    if hole is not None:
        allowed &= ~_touching(hole, matching)
    return allowed


def _touching(hole: NDArray[np.bool_], matching: Matching) -> NDArray[np.bool_]:
    """Return the centres whose window, centre included, touches the hole."""
    import cv2

    reach = matching.window // 2
    element = np.zeros((matching.window, matching.window), np.uint8)
    rows, columns = (offsets(matching.shape, matching.window) + reach).T
    element[rows, columns] = 1
    element[reach, reach] = 1
    padded = np.pad(hole.astype(np.uint8), reach, mode="wrap" if matching.border == "periodic" else "constant")
    grown = cv2.dilate(padded, element, borderType=cv2.BORDER_CONSTANT, borderValue=0)
    height, width = hole.shape
    return grown[reach : reach + height, reach : reach + width] > 0


def whole_windows(allowed: NDArray[np.bool_], matching: Matching) -> int:
    """Count the candidates whose whole window lies inside of the exemplar: any pixel can be matched with those."""
    if matching.border == "periodic":
        return int(allowed.sum())
    reach = matching.window // 2
    height, width = allowed.shape
    below = 0 if matching.causal else reach
    return int(allowed[reach : height - below, reach : width - reach].sum())


def make_pool(values: NDArray[np.uint8], allowed: NDArray[np.bool_], matching: Matching) -> Pool:
    """Lay out (C, H, W) bytes and (H, W) places for the kernels."""
    from texlab_core.kernels.neighbourhood_types import LANES, Pool

    margin = matching.window // 2 if matching.border == "periodic" else 0
    channels, height, width = values.shape
    planes = np.pad(values, ((0, 0), (margin, margin), (margin, margin)), mode="wrap") if margin else values
    places = np.pad(allowed.astype(np.uint8), margin).ravel()
    tail = np.zeros(LANES, np.uint8)
    return Pool(
        values=np.concatenate([planes.ravel(), tail]),
        allowed=places,
        before=np.concatenate([[0], np.cumsum(places, dtype=np.int64)]),
        mean=values.reshape(channels, -1).mean(axis=1),
        variance=values.reshape(channels, -1).var(axis=1),
        plane=places.size,
        stride=width + 2 * margin,
        margin=margin,
        height=height,
        width=width,
    )
