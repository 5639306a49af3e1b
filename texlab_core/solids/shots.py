"""Shots of a solid: a picture of it, or an animation, in a file that carries the solid's recipe."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np

from texlab_core.documents.beside import write_with_recipe
from texlab_core.documents.reading import KEY
from texlab_core.errors import ImageError, InputError
from texlab_core.files.whole import write_whole
from texlab_core.images.formats.animations import ANIMATED, check_animation, encode_animation
from texlab_core.images.formats.writing import encode_png
from texlab_core.solids.pictures import (
    GAP,
    Place,
    Turn,
    Walk,
    panel,
    walk_frames,
)
from texlab_core.solids.rendering import DARK, MAX_PICTURE, Colour, View, render, render_wrapped
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage, FloatVolume

Show = Literal["object", "both", "slices"]
SHOWN: tuple[Show, ...] = get_args(Show)


@dataclass(frozen=True, slots=True)
class Shot:
    """What to draw of a solid.

    Parameters
    ----------
    show
        ``object``: the shaded object; ``both``: beside it the same object with the exemplar wrapped around it;
        ``slices``: three slices through a place and the object.
    view
        How the object is looked at.
    motion
        A turn of the object or a walk through the slices; None makes a picture.
    place
        Depth, row and column of the slices; None is the middle.
    side
        Height and width of the object's picture in pixels.
    rate
        Frames a second of a motion.
    background
        Red, green and blue.

    Raises
    ------
    InputError
        When these do not go together, or the side is out of range.
    """

    show: Show = "object"
    view: View = field(default_factory=View)
    motion: Turn | Walk | None = None
    place: Place | None = None
    side: int = 400
    rate: float = 25.0
    background: Colour = DARK

    def __post_init__(self) -> None:
        if self.show not in SHOWN:
            raise InputError(f"show: must be one of {', '.join(SHOWN)}, got {self.show!r}.")
        if type(self.side) is not int or not 16 <= self.side <= MAX_PICTURE // 2:
            raise InputError(
                f"side: must be a whole number from 16 to {MAX_PICTURE // 2} pixels, got {self.side!r}."
            )
        if self.show == "slices" and self.motion is not None:
            raise InputError("The slices and the object together make a picture, not an animation.")


def check_shot(path: str | os.PathLike[str], shot: Shot) -> str:
    """Return the suffix in lower case; raises ``ImageError`` when the shot cannot be written under this name."""
    if shot.motion is not None:
        return check_animation(path, shot.rate)
    suffix = Path(path).suffix.lower()
    if suffix != ".png":
        kinds = ", ".join(ANIMATED)
        raise ImageError(
            f"{os.fspath(path)}: a picture of a solid is written as .png, and only an animation as {kinds},"
            f" got {suffix!r}."
        )
    return suffix


def frames(
    volume: FloatVolume, shot: Shot, exemplar: FloatImage | None = None, *, look: Callable[[], None] = go_on
) -> Iterator[NDArray[np.uint8]]:
    """Yield the pictures of a shot, (H, W, 3) uint8 each: one, or those of its motion.

    Parameters
    ----------
    volume
        (D, H, W, C) float32 in [0, 1].
    shot
        What to draw.
    exemplar
        (H, W, C) float32, needed when ``both`` are shown.
    look
        Called every few milliseconds; may raise to stop.

    Raises
    ------
    InputError
        When the exemplar is missing or the place lies outside.
    """
    if isinstance(shot.motion, Walk):
        yield from walk_frames(volume, shot.motion)
    elif shot.show == "slices":
        yield panel(volume, shot.view, shot.place, background=shot.background, look=look)
    else:
        count = 1 if shot.motion is None else shot.motion.frames
        for frame in range(count):
            yield _object(volume, shot, shot.view.turned(360 * frame / count), exemplar, look)


def _object(
    volume: FloatVolume, shot: Shot, view: View, exemplar: FloatImage | None, look: Callable[[], None]
) -> NDArray[np.uint8]:
    size = (shot.side, shot.side)
    drawn = render(volume, view, size, background=shot.background, smooth=True, look=look)
    if shot.show != "both":
        return drawn
    if exemplar is None:
        raise InputError("The exemplar is needed to wrap it around the object, and the file does not hold it.")
    gap = np.empty((shot.side, GAP, 3), np.uint8)
    gap[:] = shot.background
    wrapped = render_wrapped(
        exemplar, volume.shape, view, size, background=shot.background, smooth=True, look=look
    )
    return np.concatenate([drawn, gap, wrapped], axis=1)


def save_shot(
    path: str | os.PathLike[str],
    volume: FloatVolume,
    shot: Shot,
    *,
    recipe: str | None = None,
    exemplar: FloatImage | None = None,
    look: Callable[[], None] = go_on,
) -> None:
    """Draw a shot and save it.

    Parameters
    ----------
    path
        Ends in .png; for a motion in .apng, .png, .gif or .webp.
    volume, shot, exemplar, look
        As for :func:`frames`.
    recipe
        The solid's recipe as JSON: inside a PNG, beside a GIF or WebP as ``.texlab.json``.

    Raises
    ------
    InputError
        When the shot cannot be drawn, or the file not be written.
    """
    suffix = check_shot(path, shot)
    is_png = ANIMATED[suffix] == "PNG"
    text = {KEY: recipe} if recipe is not None and is_png else None
    pictures = frames(volume, shot, exemplar, look=look)
    if shot.motion is None:
        data = encode_png(next(pictures), text)
    else:
        data = encode_animation(path, pictures, rate=shot.rate, text=text, look=look)
    if recipe is None or is_png:
        write_whole(path, data)
    else:
        write_with_recipe(path, data, recipe)
