"""A solid as an object: a block with a carved corner, a sphere, a cylinder or a torus, shaded.

Every point of the surface has the colour that the volume has there: nothing is mapped, so nothing is distorted.
For comparison the same object can wear an image, wrapped around it as usual.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from texlab_core.errors import InputError
from texlab_core.work.tasks import finish, go_on

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage, FloatVolume
    from texlab_core.work.tasks import Task

Shape = Literal["block", "sphere", "cylinder", "torus"]
SHAPES: tuple[Shape, ...] = get_args(Shape)
Colour = tuple[int, int, int]

# The eye's distance from the middle, in half the longest side.
DISTANCE = 6.0
# From above, from the left, from the front.
LIGHT = (-0.40, 0.62, 0.675)
# Share of the picture's shorter side that an object fills at zoom 1.
FILLED = 0.96
DARK: Colour = (24, 26, 30)
# Pixels between two pauses: a millisecond or two.
PIECE = 2**14
MAX_PICTURE = 4096


@dataclass(frozen=True, slots=True)
class View:
    """How an object is looked at.

    Parameters
    ----------
    shape
        The object.
    yaw
        Degrees about the upright axis, positive: the front turns to the right.
    pitch
        Degrees about the axis to the right, positive: the top turns to the viewer.
    zoom
        1 fills the picture at any turn.
    """

    shape: Shape = "block"
    yaw: float = -30.0
    pitch: float = 24.0
    zoom: float = 1.0

    def __post_init__(self) -> None:
        if self.shape not in SHAPES:
            raise InputError(f"shape: must be one of {', '.join(SHAPES)}, got {self.shape!r}.")
        for name in ("yaw", "pitch"):
            if not math.isfinite(getattr(self, name)):
                raise InputError(f"{name}: must be an angle in degrees, got {getattr(self, name)!r}.")
        if not 0.1 <= self.zoom <= 20:
            raise InputError(f"zoom: must be from 0.1 to 20, got {self.zoom!r}.")

    def turned(self, yaw: float, pitch: float = 0.0) -> View:
        """Return the view after a turn by these degrees; the pitch stays within a quarter turn."""
        return View(
            self.shape, (self.yaw + yaw + 180) % 360 - 180, min(max(self.pitch + pitch, -90), 90), self.zoom
        )

    @property
    def matrix(self) -> NDArray[np.float64]:
        """(3, 3), brings object space (x right, y up, z to the viewer) into the viewer's."""
        yaw, pitch = math.radians(self.yaw), math.radians(self.pitch)
        about_y = np.array(
            [[math.cos(yaw), 0, math.sin(yaw)], [0, 1, 0], [-math.sin(yaw), 0, math.cos(yaw)]], np.float64
        )
        about_x = np.array(
            [[1, 0, 0], [0, math.cos(pitch), -math.sin(pitch)], [0, math.sin(pitch), math.cos(pitch)]], np.float64
        )
        return np.ascontiguousarray(about_x @ about_y)


def render(
    volume: FloatVolume,
    view: View,
    size: tuple[int, int] = (400, 400),
    *,
    background: Colour = DARK,
    smooth: bool = False,
    look: Callable[[], None] = go_on,
) -> NDArray[np.uint8]:
    """Draw a solid.

    Parameters
    ----------
    volume
        (D, H, W, C) float32 in [0, 1], C of 1 or 3, C-contiguous. Slice 0 is the front of the block.
    view
        The object and how it is turned.
    size
        Height and width of the picture, 1 to 4096.
    background
        Red, green and blue, 0 to 255.
    smooth
        Four rays for a pixel: no jagged outlines.
    look
        Called every millisecond or two; may raise to stop.

    Returns
    -------
    ndarray
        (H, W, 3) uint8.

    Raises
    ------
    InputError
        When the volume or the size cannot be used.
    """
    return finish(render_task(volume, view, size, background=background, smooth=smooth), look)


def render_wrapped(
    image: FloatImage,
    volume_shape: tuple[int, ...],
    view: View,
    size: tuple[int, int] = (400, 400),
    *,
    background: Colour = DARK,
    smooth: bool = False,
    look: Callable[[], None] = go_on,
) -> NDArray[np.uint8]:
    """Draw the object with an image wrapped around it, at the scale at which a solid of this shape has voxels.

    Parameters
    ----------
    image
        (H, W, C) float32 in [0, 1].
    volume_shape
        Depth, height and width of the solid that it is compared with.
    view, size, background, smooth, look
        As in :func:`render`.
    """
    work = render_task(image[None], view, size, background=background, smooth=smooth, wrapped=volume_shape)
    return finish(work, look)


def render_task(
    volume: FloatVolume,
    view: View,
    size: tuple[int, int],
    *,
    background: Colour = DARK,
    smooth: bool = False,
    wrapped: tuple[int, ...] | None = None,
) -> Task[NDArray[np.uint8]]:
    """Do :func:`render`, or :func:`render_wrapped` for a solid's shape, in pieces; yields the pixels drawn."""
    from texlab_core.kernels import solids

    _check(volume, size)
    finer = 2 if smooth else 1
    height, width = size[0] * finer, size[1] * finer
    out = np.empty((height, width, 3), np.uint8)
    sides = np.array((volume.shape if wrapped is None else wrapped)[:3][::-1], np.float64)
    half, voxels = sides / sides.max(), sides.max() / 2
    stretch = np.ones(2) if wrapped is None else _stretch(view.shape, volume.shape[1:3], voxels)
    scale = view.zoom * FILLED * 0.5 * min(height, width) / _reach(view.shape, half)
    turn, light = view.matrix, np.array(LIGHT) / np.linalg.norm(LIGHT)
    values, paint = np.ascontiguousarray(volume, np.float32), np.array(background, np.uint8)
    rows = max(1, PIECE // width)
    for top in range(0, height, rows):
        part = out[top : top + rows]
        solids.draw(
            values,
            wrapped is not None,
            SHAPES.index(view.shape),
            turn,
            half,
            voxels,
            stretch,
            DISTANCE,
            scale,
            light,
            paint,
            top,
            part,
            (height, width),
        )
        yield part.shape[0] * width
    if not smooth:
        return out
    import cv2

    return np.asarray(cv2.resize(out, (size[1], size[0]), interpolation=cv2.INTER_AREA), np.uint8)


def _reach(shape: Shape, half: NDArray[np.float64]) -> float:
    """Return how far an object reaches from the middle, as it is seen from the eye, whatever its turn."""
    from texlab_core.kernels import solids

    radius = {
        "block": math.hypot(*half),
        "sphere": solids.RADIUS,
        "cylinder": solids.RADIUS * math.hypot(1, half[1]),
        "torus": solids.RING + solids.TUBE,
    }[shape]
    return radius / math.sqrt(1 - (radius / DISTANCE) ** 2)


def _stretch(shape: Shape, image: tuple[int, ...], voxels: float) -> NDArray[np.float64]:
    """Return the factors with which a whole number of copies goes around the object, at least one."""
    from texlab_core.kernels import solids

    around, down = {
        "block": (0.0, 0.0),
        "sphere": (2 * math.pi * solids.RADIUS, math.pi * solids.RADIUS),
        "cylinder": (2 * math.pi * solids.RADIUS, 0.0),
        "torus": (2 * math.pi * solids.RING, 2 * math.pi * solids.TUBE),
    }[shape]
    factors = []
    for length, side in ((around, image[1]), (down, image[0])):
        copies = length * voxels / side
        factors.append(max(1, round(copies)) / copies if copies else 1.0)
    return np.array(factors)


def _check(volume: FloatVolume, size: tuple[int, int]) -> None:
    if volume.ndim != 4 or volume.shape[3] not in (1, 3) or volume.size == 0:
        raise InputError(f"A solid to draw is (D, H, W, 1 or 3), got {volume.shape}.")
    if not all(1 <= side <= MAX_PICTURE for side in size):
        raise InputError(f"size: must be from 1 to {MAX_PICTURE} pixels a side, got {size[1]} x {size[0]}.")
