"""Pictures of a solid for files: three slices and the object beside them, turns, and walks through its slices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from texlab_core.errors import InputError
from texlab_core.solids.rendering import DARK, Colour, View, render
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatVolume

Cut = Literal["xy", "xz", "yz"]
CUTS: tuple[Cut, ...] = get_args(Cut)
Place = tuple[int, int, int]

CROSS: Colour = (255, 176, 32)
GAP = 6
# Small slices are magnified to at least this.
LEAST_SIDE = 256
MOST_FRAMES = 720


@dataclass(frozen=True, slots=True)
class Walk:
    """A walk through the slices of one cut, all of them in their order."""

    cut: Cut = "xy"

    def __post_init__(self) -> None:
        if self.cut not in CUTS:
            raise InputError(f"cut: must be one of {', '.join(CUTS)}, got {self.cut!r}.")


@dataclass(frozen=True, slots=True)
class Turn:
    """A whole turn about the upright axis in so many frames."""

    frames: int = 60

    def __post_init__(self) -> None:
        if (
            isinstance(self.frames, bool)
            or not isinstance(self.frames, int)
            or not 2 <= self.frames <= MOST_FRAMES
        ):
            raise InputError(f"frames: must be a whole number from 2 to {MOST_FRAMES}, got {self.frames!r}.")


def middle(shape: tuple[int, ...]) -> Place:
    """Return the place (depth, row, column) in the middle of a volume."""
    return shape[0] // 2, shape[1] // 2, shape[2] // 2


def slice_at(volume: FloatVolume, cut: Cut, place: Place) -> NDArray[np.float32]:
    """Return one slice as a picture.

    Parameters
    ----------
    volume
        (D, H, W, C).
    cut
        ``xy``: rows down, columns to the right; ``xz``: depth down, columns to the right; ``yz``: rows down, depth
        to the right.
    place
        Where: depth, row and column.

    Returns
    -------
    ndarray
        (H, W, C), (D, W, C) or (H, D, C) float32, a view of the volume.
    """
    depth, row, column = place
    shown: NDArray[np.float32]
    if cut == "xy":
        shown = volume[depth]
    elif cut == "xz":
        shown = volume[:, row]
    else:
        shown = volume[:, :, column].swapaxes(0, 1)
    return shown


def cross_of(cut: Cut, place: Place) -> tuple[int, int]:
    """Return row and column of a place in the picture of a slice."""
    depth, row, column = place
    return {"xy": (row, column), "xz": (depth, column), "yz": (row, depth)}[cut]


def picture_of(pixels: NDArray[np.float32], factor: int = 1) -> NDArray[np.uint8]:
    """Return (H, W, 1 | 3) float32 in [0, 1] as (H, W, 3) uint8, every pixel ``factor`` x ``factor`` times."""
    values: NDArray[np.uint8] = np.rint(pixels * np.float32(255)).astype(np.uint8)
    if values.shape[2] == 1:
        values = np.repeat(values, 3, axis=2)
    values = values.repeat(factor, axis=0).repeat(factor, axis=1)
    return values


def panel(
    volume: FloatVolume,
    view: View,
    place: Place | None = None,
    *,
    background: Colour = DARK,
    look: Callable[[], None] = go_on,
) -> NDArray[np.uint8]:
    """Draw the three slices through a place, their cross-hairs, and the object beside them.

    ``xy`` is at the top left, ``yz`` to the right of it with the same rows, ``xz`` below it with the same columns.

    Parameters
    ----------
    volume
        (D, H, W, C) float32 in [0, 1].
    view
        How the object is looked at.
    place
        Depth, row and column of the cross-hairs; the middle when None.
    background
        Between the pictures and around the object.
    look
        Called every few milliseconds; may raise to stop.

    Returns
    -------
    ndarray
        (H', W', 3) uint8.
    """
    at = middle(volume.shape) if place is None else check_place(place, volume.shape)
    factor = magnification(volume.shape)
    depth, height, width = (side * factor for side in volume.shape[:3])
    out = np.empty((height + GAP + depth, width + GAP + depth, 3), np.uint8)
    out[:] = background
    corners: dict[Cut, tuple[int, int]] = {"xy": (0, 0), "yz": (0, width + GAP), "xz": (height + GAP, 0)}
    for cut, (top, left) in corners.items():
        look()
        shown = picture_of(slice_at(volume, cut, at), factor)
        row, column = (factor * index + factor // 2 for index in cross_of(cut, at))
        shown[row], shown[:, column] = CROSS, CROSS
        out[top : top + shown.shape[0], left : left + shown.shape[1]] = shown
    drawn = render(volume, view, (depth, depth), background=background, smooth=True, look=look)
    out[height + GAP :, width + GAP :] = drawn
    return out


def check_place(place: Place, shape: tuple[int, ...]) -> Place:
    """Return the place; raises ``InputError`` when it does not lie in the volume."""
    if not all(0 <= index < side for index, side in zip(place, shape[:3], strict=True)):
        depth, height, width = shape[:3]
        raise InputError(
            f"at: must lie in the solid of {width} x {height} x {depth}, from 0,0,0, got "
            f"{place[2]},{place[1]},{place[0]}."
        )
    return place


def magnification(shape: tuple[int, ...]) -> int:
    """Return the whole factor by which slices of a small volume are magnified for a picture."""
    return max(1, -(-LEAST_SIDE // max(shape[:3])))


def walk_frames(volume: FloatVolume, walk: Walk) -> Iterator[NDArray[np.uint8]]:
    """Yield all slices of a cut in their order, (H, W, 3) uint8 each, small ones magnified."""
    factor = magnification(volume.shape)
    axis = {"xy": 0, "xz": 1, "yz": 2}[walk.cut]
    for index in range(volume.shape[axis]):
        place = [0, 0, 0]
        place[axis] = index
        yield picture_of(slice_at(volume, walk.cut, (place[0], place[1], place[2])), factor)
