"""Animations as MP4, where an encoder is found, and as a sequence of PNG files."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.errors import ImageError
from texlab_core.images.formats.animations import ANIMATED, check_animation, encode_animation
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from numpy.typing import NDArray

MOVIES = (*ANIMATED, ".mp4")
# MPEG-4 part 2, the one encoder that OpenCV's own packages bring along.
_CODEC = "mp4v"


def check_movie(path: str | os.PathLike[str], rate: float) -> str:
    """Return the suffix in lower case.

    Raises
    ------
    ImageError
        When no animation can be written under this name, or not at this rate.
    """
    suffix = Path(path).suffix.lower()
    if suffix == ".mp4":
        check_animation("a.png", rate)
        return suffix
    if suffix not in ANIMATED:
        raise ImageError(
            f"{os.fspath(path)}: animations are written as {', '.join(MOVIES)}, or as PNG files in a folder, got "
            f"{suffix!r}."
        )
    return check_animation(path, rate)


def encode_movie(
    path: str | os.PathLike[str],
    frames: Iterable[NDArray[np.uint8]],
    *,
    rate: float = 25.0,
    text: Mapping[str, str] | None = None,
    look: Callable[[], None] = go_on,
) -> bytes:
    """Return the bytes of an animation; see :func:`encode_animation`. An MP4 has no loop, its player has.

    Raises
    ------
    ImageError
        When the format is unknown, the rate cannot be kept, or no encoder for MP4 is found.
    """
    suffix = check_movie(path, rate)
    return (
        _mp4(frames, rate, look)
        if suffix == ".mp4"
        else encode_animation(path, frames, rate=rate, text=text, look=look)
    )


def _mp4(frames: Iterable[NDArray[np.uint8]], rate: float, look: Callable[[], None]) -> bytes:
    import cv2

    with tempfile.TemporaryDirectory(prefix="texlab-") as folder:
        path = str(Path(folder) / "movie.mp4")
        writer: Any = None
        try:
            for frame in frames:
                look()
                # The codec has colour at half resolution, and wants even sides.
                even = np.pad(frame, ((0, frame.shape[0] % 2), (0, frame.shape[1] % 2), (0, 0)), "edge")
                if writer is None:
                    size = (even.shape[1], even.shape[0])
                    writer = cv2.VideoWriter(path, cv2.VideoWriter.fourcc(*_CODEC), rate, size)
                    if not writer.isOpened():
                        raise ImageError(
                            "No encoder for MP4 is found here; choose .webp, .gif, .apng or PNG files in a folder."
                        )
                writer.write(np.ascontiguousarray(even[..., ::-1]))
        finally:
            if writer is not None:
                writer.release()
        if writer is None:
            raise ValueError("An animation needs at least one frame.")
        return Path(path).read_bytes()
