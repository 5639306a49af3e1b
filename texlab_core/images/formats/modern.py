"""Write AVIF and JPEG XL, where the codecs are installed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.errors import ImageError

if TYPE_CHECKING:
    from numpy.typing import NDArray

_CODECS = {".avif": ("AVIF", "AVIF"), ".jxl": ("JPEGXL", "JPEG XL")}


def check_codec(suffix: str, name: str) -> None:
    """Raise ``ImageError`` when files with this suffix cannot be encoded here."""
    if suffix not in _CODECS:
        return
    import imagecodecs

    codec, title = _CODECS[suffix]
    if not getattr(getattr(imagecodecs, codec, None), "available", False):
        raise ImageError(f"{name}: the installed imagecodecs has no codec for {title}; choose PNG or WebP.")


def encode_avif(values: NDArray[Any], quality: int | None) -> bytes:
    """Return an AVIF file of (H, W) or (H, W, 3 | 4) uint8; without loss unless a quality is given."""
    import imagecodecs

    planes = values.reshape(*values.shape[:2], -1)
    if planes.shape[2] == 2:
        # The codec has no gray with transparency.
        planes = np.concatenate([np.repeat(planes[..., :1], 3, axis=2), planes[..., 1:]], axis=2)
    plane = np.ascontiguousarray(planes[..., 0] if planes.shape[2] == 1 else planes)
    # Level 100 is lossless in this codec.
    return bytes(imagecodecs.avif_encode(plane, level=100 if quality is None else min(quality, 99)))


def encode_jxl(values: NDArray[Any], quality: int | None) -> bytes:
    """Return a JPEG XL file of (H, W) or (H, W, 2 | 3 | 4) uint8, uint16 or float32 in [0, 1]."""
    import imagecodecs

    plane = np.ascontiguousarray(values)
    if quality is None:
        return bytes(imagecodecs.jpegxl_encode(plane, lossless=True))
    return bytes(imagecodecs.jpegxl_encode(plane, lossless=False, distance=jxl_distance(quality)))


def jxl_distance(quality: int) -> float:
    """Return the distance of JPEG XL (1 is just noticeable) for a quality from 1 to 100.

    The straight part of what libjxl's own encoder does; below 30 it goes on to the largest distance, 15.
    """
    if quality >= 30:
        return 0.1 + (100 - quality) * 0.09
    return 6.4 + (30 - quality) * 8.6 / 29
