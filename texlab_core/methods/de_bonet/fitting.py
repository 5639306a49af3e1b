"""Fitting an exemplar to the pyramid: sides that halve evenly, by padding or by cropping."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from texlab_core.methods.de_bonet.quadtree import Grid
from texlab_core.transforms.fourier import periodic_component

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.methods.de_bonet.choices import ExemplarBorder, Fitting

# Padding or cropping may change the area by at most this share; beyond it the pyramid gets fewer levels.
LARGEST_LOSS = 0.15
_BEYOND = {"reflect": "mirrored", "periodic": "repeated", "smooth": "repeated"}


@dataclass(frozen=True, eq=False, slots=True)
class Fitted:
    """An exemplar whose sides halve evenly.

    Parameters
    ----------
    pixels
        (H, W, C) float32.
    grid
        Locations of its pyramid.
    rows, columns
        (H,) and (W,) int32: which row and column of the exemplar each of its own shows.
    whole
        Rows and columns of the coarsest level whose cells hold nothing padded.
    notes
        What was done, one sentence each.
    """

    pixels: NDArray[np.float32]
    grid: Grid
    rows: NDArray[np.int32]
    columns: NDArray[np.int32]
    whole: tuple[int, int]
    notes: tuple[str, ...]


def choose_depth(height: int, width: int, smallest: int, fitting: Fitting = "crop") -> int:
    """Return the largest N for which a level N of ``smallest`` whole cells remains and the area changes little."""
    depth = 0
    while True:
        side = 2 ** (depth + 1)
        rows, columns = height // side, width // side
        if fitting == "crop":
            changed = 1 - rows * columns * side * side / (height * width)
        else:
            changed = -(-height // side) * -(-width // side) * side * side / (height * width) - 1
        if min(rows, columns) < smallest or changed > LARGEST_LOSS:
            return depth
        depth += 1


def even_halvings(height: int, width: int) -> int:
    """Return how often both sides can be halved without a remainder."""
    return min((side & -side).bit_length() - 1 for side in (height, width))


def fit(pixels: NDArray[np.float32], depth: int, border: ExemplarBorder, fitting: Fitting) -> Fitted:
    """Make the sides of an exemplar multiples of 2^depth.

    Parameters
    ----------
    pixels
        (H, W, C) float32.
    depth
        Number of halvings.
    border
        How the exemplar goes on beyond its border: what padding shows. ``smooth`` also takes away the component
        that makes opposite borders differ (Moisan 2011).
    fitting
        ``pad`` below and on the right, so that nothing is lost; or ``crop`` to the centre.
    """
    height, width, _ = pixels.shape
    side = 2**depth
    notes: tuple[str, ...] = ()
    whole = (height // side, width // side)
    if fitting == "crop":
        grid = Grid(*whole, depth)
        top, left = ((old - new) // 2 for old, new in zip((height, width), grid.shape(0), strict=True))
        rows, columns = top + np.arange(grid.shape(0)[0]), left + np.arange(grid.shape(0)[1])
        if grid.shape(0) != (height, width):
            notes = (
                f"The exemplar was cropped from {width} x {height} to {columns.size} x {rows.size} pixels, its "
                f"centre, so that {depth} halvings come out even.",
            )
    else:
        grid = Grid.covering(height, width, depth)
        mode: Literal["reflect", "wrap"] = "reflect" if border == "reflect" else "wrap"
        rows, columns = (
            np.pad(np.arange(old), (0, new - old), mode=mode)
            for old, new in zip((height, width), grid.shape(0), strict=True)
        )
        if grid.shape(0) != (height, width):
            notes = (
                f"The exemplar was padded from {width} x {height} to {columns.size} x {rows.size} pixels, "
                f"{_BEYOND[border]} on the right and below, so that {depth} halvings come out even.",
            )
    if border == "smooth" and fitting == "pad":
        # Of the exemplar as it is: its own borders are to fit.
        pixels = periodic_component(pixels)
    if grid.shape(0) != (height, width):
        pixels = np.ascontiguousarray(pixels[np.ix_(rows, columns)])
    if border == "smooth":
        if fitting == "crop":
            pixels = periodic_component(pixels)
        notes += ("The smooth component of the exemplar was removed, so that its borders fit.",)
    return Fitted(pixels, grid, rows.astype(np.int32), columns.astype(np.int32), whole, notes)
