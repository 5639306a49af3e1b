"""Animations as files: APNG, GIF and WebP that go on for ever."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import TYPE_CHECKING

from texlab_core.errors import ImageError
from texlab_core.images.formats.png_text import with_text
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    import numpy as np
    from numpy.typing import NDArray

ANIMATED = {".png": "PNG", ".apng": "PNG", ".gif": "GIF", ".webp": "WEBP"}
FASTEST, SLOWEST = 50.0, 0.2


def check_animation(path: str | os.PathLike[str], rate: float = 25.0) -> str:
    """Return the suffix in lower case.

    Raises
    ------
    ImageError
        When no animation can be written under this name, or not at this rate.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in ANIMATED:
        raise ImageError(f"{os.fspath(path)}: animations are written as {', '.join(ANIMATED)}, got {suffix!r}.")
    if not SLOWEST <= rate <= FASTEST:
        raise ImageError(f"rate: must be from {SLOWEST:g} to {FASTEST:g} frames a second, got {rate!r}.")
    return suffix


def encode_animation(
    path: str | os.PathLike[str],
    frames: Iterable[NDArray[np.uint8]],
    *,
    rate: float = 25.0,
    text: Mapping[str, str] | None = None,
    look: Callable[[], None] = go_on,
) -> bytes:
    """Return the bytes of an animation.

    Parameters
    ----------
    path
        Ends in .apng, .png (an APNG as well), .gif or .webp, which chooses the format.
    frames
        (H, W, 3) uint8 of one size, at least one; taken one by one.
    rate
        Frames a second, 0.2 to 50; a GIF counts in hundredths of a second.
    text
        Texts by key, for APNG.
    look
        Called before each frame; may raise to stop.

    Raises
    ------
    ImageError
        When the format is unknown or the rate cannot be kept.
    """
    suffix = check_animation(path, rate)
    if text and ANIMATED[suffix] != "PNG":
        raise ValueError(f"An animation in {suffix} takes no text.")
    from PIL import Image

    def pictures() -> Iterator[Image.Image]:
        for frame in frames:
            look()
            picture = Image.fromarray(frame)
            # A palette of its own for each frame; the slower ways of finding one look no better in motion.
            yield picture.quantize(256, Image.Quantize.FASTOCTREE) if suffix == ".gif" else picture

    rest = pictures()
    first = next(rest, None)
    if first is None:
        raise ValueError("An animation needs at least one frame.")
    out = io.BytesIO()
    # Pillow goes over the frames of an APNG twice.
    following = list(rest) if ANIMATED[suffix] == "PNG" else rest
    options = {"lossless": False, "quality": 90, "method": 2} if suffix == ".webp" else {}
    first.save(
        out,
        ANIMATED[suffix],
        save_all=True,
        append_images=following,
        duration=round(1000 / rate),
        loop=0,
        **options,
    )
    data = out.getvalue()
    return with_text(data, text) if text else data
