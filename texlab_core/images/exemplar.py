"""The one door through which an image enters: whatever it was, it comes out as methods want it."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from texlab_core.engine.inputs import Crop, ImageInput, Origin, hash_arrays
from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import Decoded, check_pixels
from texlab_core.images.formats.reading import display_name, read_image

if TYPE_CHECKING:
    from texlab_core.engine.steps import FloatImage

Source = NDArray[Any] | ImageInput | str | os.PathLike[str] | bytes
MIN_SIDE = 2


def as_exemplar(
    source: Source,
    *,
    name: str | None = None,
    crop: Crop | None = None,
    scale: float = 1.0,
    background: float = 1.0,
) -> ImageInput:
    """Make an exemplar of an image, whatever it is.

    Parameters
    ----------
    source
        An array (H, W) or (H, W, 1 | 3 | 4), of any real type; an image input; the path or the bytes of a
        PNG, JPEG, TIFF, WebP, BMP, PGM or PPM file; or "gallery:NAME".
    name
        For people and recipes; by default the file's name.
    crop
        The part to use, in pixels of the scaled source.
    scale
        Factor of both sides, 0 < scale <= 1, by area averaging; applied before the crop. An image input without
        crop and scale comes back as it is; with them it is taken from its source anew.
    background
        Gray level, 0 to 1, over which transparent pixels are laid.

    Returns
    -------
    ImageInput
        (H, W, C) float32 in [0, 1], C-contiguous, read-only, at least 2 x 2 pixels; C is 3, or 1 for gray images,
        stored in one channel or in three equal ones. Values are used as stored, that is, gamma-encoded.

    Raises
    ------
    ImageError
        When it cannot be read, is empty, too small or too large (64 megapixels), has values that are not finite,
        or the crop does not lie inside.

    Notes
    -----
    Values of arrays and files become shares by one rule. Bools are 0 and 1; unsigned integers are divided by the
    largest value of their type; signed integers and floats are used as they are when all lie in 0 to 1, and are
    otherwise mapped from their own smallest and largest value to 0 and 1, which ``notes`` says.
    """
    if isinstance(source, ImageInput):
        if crop is None and scale == 1.0:
            return source if name is None else _renamed(source, name)
        whole = source.pixels if source.origin is None else source.origin.pixels
        return take(whole, source.name if name is None else name, crop, scale, source.notes)
    decoded, name = _load(source, name)
    notes = list(decoded.notes)
    pixels = _unit_range(decoded, _check_level(background), name, notes)
    return take(pixels, name, crop, scale, tuple(notes))


def _renamed(source: ImageInput, name: str) -> ImageInput:
    return ImageInput(source.pixels, name, source.sha256, source.origin, source.notes)


def _load(source: Source, name: str | None) -> tuple[Decoded, str]:
    """Return the decoded image and its name."""
    if isinstance(source, str) and source.startswith("gallery:"):
        from texlab_core.images.gallery import find_entry

        entry = find_entry(source)
        return read_image(entry.read(), entry.uri), name or entry.uri
    if isinstance(source, str | os.PathLike):
        shown = os.fspath(source)
        if not shown:
            raise ImageError("The name of the image is empty.")
        return read_image(Path(source), shown), name or display_name(shown)
    if isinstance(source, bytes | bytearray | memoryview):
        name = name or "image"
        return read_image(bytes(source), name), name
    if isinstance(source, np.ndarray):
        name = name or "array"
        # Without the rules of a subclass, in this machine's order of bytes.
        plain = np.asarray(source)
        return _from_array(plain.astype(plain.dtype.newbyteorder("="), copy=False), name), name
    raise ImageError(
        "An image must be an array, a path, the bytes of a file, an image input or gallery:NAME, "
        f"got {type(source).__name__}."
    )


def _from_array(array: NDArray[Any], name: str) -> Decoded:
    if array.ndim == 2:
        array = array[:, :, None]
    if array.ndim != 3 or array.shape[2] not in (1, 3, 4):
        raise ImageError(f"{name}: the shape must be (H, W) or (H, W, 1, 3 or 4), got {array.shape}.")
    check_pixels(array.shape[1], array.shape[0], name)
    # As for files: what has no sign is a share of its largest value, the rest is taken as it is or mapped.
    if array.dtype.kind == "b":
        return Decoded(array.astype(np.uint8), 1)
    if array.dtype.kind == "u":
        return Decoded(array, int(np.iinfo(array.dtype).max))
    if array.dtype.kind not in "if":
        raise ImageError(f"{name}: the values must be bools, integers or floats, got {array.dtype}.")
    return Decoded(array, None)


def _check_level(background: float) -> np.float32:
    if not 0 <= background <= 1:
        raise ImageError(f"The background must be a gray level from 0 to 1, got {background!r}.")
    return np.float32(background)


def _unit_range(decoded: Decoded, background: np.float32, name: str, notes: list[str]) -> FloatImage:
    """Return gray or RGB in [0, 1]."""
    values = decoded.values
    has_alpha = values.shape[2] in (2, 4)
    colours = values[..., :-1] if has_alpha else values
    if decoded.peak is None:
        pixels = _floats_in_range(colours, name, notes)
    else:
        pixels = _integers_in_range(colours, decoded.peak)
    if has_alpha:
        alpha = values[..., -1:]
        if decoded.peak is None:
            if not np.isfinite(alpha).all():
                raise ImageError(f"{name}: the alpha channel has values that are not finite.")
            opacity = np.clip(alpha, 0, 1).astype(np.float32)
        else:
            opacity = _integers_in_range(alpha, decoded.peak)
        pixels = _over(pixels, opacity, background, notes, premultiplied=decoded.premultiplied)
    if pixels.shape[2] == 3 and _is_gray(pixels):
        notes.append("The three channels are equal, so the image is used as gray.")
        pixels = pixels[..., :1]
    if pixels.base is None and pixels.flags.c_contiguous:
        # Made here, and nobody else has it: no need for a copy.
        pixels.flags.writeable = False
    return pixels


def _integers_in_range(values: NDArray[Any], peak: int) -> FloatImage:
    if peak <= 65535:
        # Both are exact in float32, so that k / peak is rounded once.
        pixels: FloatImage = np.divide(values, np.float32(peak), dtype=np.float32)
        return pixels
    return (values.astype(np.float64) / peak).astype(np.float32)


def _floats_in_range(values: NDArray[Any], name: str, notes: list[str]) -> FloatImage:
    low, high = float(values.min()), float(values.max())
    if not (math.isfinite(low) and math.isfinite(high)):
        count = int(values.size - np.count_nonzero(np.isfinite(values)))
        raise ImageError(f"{name}: {count} of {values.size} values are not finite (NaN or infinite).")
    if low >= 0 and high <= 1:
        # Adding zero makes negative zeros positive; they would change the hash.
        return values.astype(np.float32) + np.float32(0)
    # Halves keep the span of the largest floats finite.
    span = high / 2 - low / 2
    if span == 0:
        notes.append(f"All values are {low:g}, outside 0 to 1, and were set to 0.5.")
        return np.full(values.shape, 0.5, np.float32)
    notes.append(f"Values from {low:g} to {high:g} were mapped to 0 to 1.")
    mapped = (values.astype(np.float64) / 2 - low / 2) / span
    return np.clip(mapped, 0, 1).astype(np.float32)


def _over(
    pixels: FloatImage, opacity: FloatImage, background: np.float32, notes: list[str], *, premultiplied: bool
) -> FloatImage:
    if (opacity == 1).all():
        notes.append("The alpha channel is opaque everywhere and was dropped.")
        return pixels
    shown = {0.0: "black", 1.0: "white"}.get(float(background), f"gray {background:g}")
    notes.append(f"Transparent pixels were laid over {shown}.")
    laid = pixels if premultiplied else pixels * opacity
    laid = laid + (1 - opacity) * background
    return laid.clip(0, 1)


def _is_gray(pixels: FloatImage) -> bool:
    # A few rows tell most colour images from gray ones.
    few = pixels[:: 1 + pixels.shape[0] // 16]
    return all(bool((part[..., :1] == part[..., 1:]).all()) for part in (few, pixels))


def take(
    pixels: FloatImage, name: str, crop: Crop | None = None, scale: float = 1.0, notes: tuple[str, ...] = ()
) -> ImageInput:
    """Scale and crop pixels that are float32 in [0, 1] already, (H, W, 1 | 3); see :func:`as_exemplar`."""
    source = _sealed(pixels)
    check_pixels(source.shape[1], source.shape[0], name)
    scaled = _scaled(source, scale, name)
    used = scaled if crop is None else _sealed(_cropped(scaled, crop, name))
    height, width, _ = used.shape
    if height < MIN_SIDE or width < MIN_SIDE:
        raise ImageError(
            f"{name}: an exemplar needs at least {MIN_SIDE} x {MIN_SIDE} pixels, got {width} x {height}."
        )
    origin = Origin(source, float(scale), crop)
    return ImageInput(used, name, hash_arrays({"pixels": used}), origin, notes)


def _sealed(pixels: FloatImage) -> FloatImage:
    """Return a read-only, C-contiguous copy; as it is when it is one already."""
    if not pixels.flags.writeable and pixels.flags.c_contiguous and pixels.flags.owndata:
        return pixels
    copy = np.array(pixels, dtype=np.float32, order="C", copy=True)
    copy.flags.writeable = False
    return copy


def _scaled(pixels: FloatImage, scale: float, name: str) -> FloatImage:
    if isinstance(scale, bool) or not isinstance(scale, int | float | np.number) or not 0 < scale <= 1:
        raise ImageError(f"{name}: the scale must be above 0 and at most 1, got {scale!r}.")
    height, width = scaled_size(pixels.shape[0], pixels.shape[1], float(scale))
    if (height, width) == pixels.shape[:2]:
        return pixels
    import cv2

    reduced = cv2.resize(pixels, (width, height), interpolation=cv2.INTER_AREA)
    return _sealed(np.clip(reduced.reshape(height, width, -1), 0, 1))


def scaled_size(height: int, width: int, scale: float) -> tuple[int, int]:
    """Return the height and width of a scaled source."""
    return max(1, round(height * scale)), max(1, round(width * scale))


def _cropped(pixels: FloatImage, crop: Crop, name: str) -> FloatImage:
    height, width, _ = pixels.shape
    whole = all(isinstance(side, int | np.integer) for side in (crop.top, crop.left, crop.height, crop.width))
    inside = (
        whole
        and min(crop.top, crop.left) >= 0
        and min(crop.height, crop.width) >= 1
        and crop.top + crop.height <= height
        and crop.left + crop.width <= width
    )
    if not inside:
        raise ImageError(
            f"{name}: the crop must lie inside the scaled image of {width} x {height} pixels, got {crop.width} x "
            f"{crop.height} pixels at left {crop.left}, top {crop.top}."
        )
    return pixels[crop.top : crop.top + crop.height, crop.left : crop.left + crop.width]
