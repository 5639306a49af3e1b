"""The one door through which an image enters: whatever it was, it comes out as methods want it."""

from __future__ import annotations

import dataclasses
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from texlab_core.engine.inputs import Crop, ImageInput, Origin, hash_arrays
from texlab_core.engine.job import MAX_PIXELS
from texlab_core.errors import ImageError
from texlab_core.images.formats.decoded import Decoded, check_pixels
from texlab_core.images.formats.reading import display_name, read_image
from texlab_core.images.unit_range import ALPHA, UnitRange

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.engine.levels import Levels
    from texlab_core.engine.steps import FloatImage
    from texlab_core.images.formats.decoded import Depth
    from texlab_core.images.unit_range import Alpha

Source = NDArray[Any] | ImageInput | str | os.PathLike[str] | bytes
MIN_SIDE = 2


def as_exemplar(
    source: Source,
    *,
    name: str | None = None,
    crop: Crop | None = None,
    scale: float = 1.0,
    background: float = 1.0,
    alpha: Alpha = "background",
    levels: Levels | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> ImageInput:
    """Make an exemplar of an image, whatever it is.

    Parameters
    ----------
    source
        An array (H, W) or (H, W, 1 | 3 | 4), of any real type; an image input; the path or the bytes of a PNG,
        JPEG, TIFF, WebP, AVIF, JPEG XL, JPEG 2000, GIF, BMP, TGA, PSD, QOI, OpenEXR, Radiance HDR, PBM, PGM or PPM
        file; or "gallery:NAME".
    name
        For people and recipes; by default the file's name.
    crop
        The part to use, in pixels of the scaled source.
    scale
        Factor of both sides, 0 < scale <= 1, by area averaging; applied before the crop. An image input without
        crop and scale comes back as it is; with them it is taken from its source anew.
    background
        Gray level, 0 to 1, over which transparent pixels are laid.
    alpha
        "background" lays transparent pixels over it; "ignore" uses the colours as they are; so does "keep", which
        has alpha beside the pixels (``ImageInput.alpha``).
    levels
        Black, white and gamma of what is used, after scale and crop; None leaves the values as they are.
    should_stop
        Asked while a large picture is read.

    Returns
    -------
    ImageInput
        (H, W, C) float32 in [0, 1], C-contiguous, read-only, at least 2 x 2 pixels; C is 3, or 1 for gray images,
        stored in one channel or in three equal ones. Values are used as stored, that is, gamma-encoded.

    Raises
    ------
    ImageError
        When it cannot be read, is empty, too small or too large (64 megapixels; 256 of which a scale or crop makes
        less), has values that are not finite, or the crop does not lie inside.
    Cancelled
        When ``should_stop`` said so.

    Notes
    -----
    Values of arrays and files become shares by one rule. Bools are 0 and 1; unsigned integers are divided by the
    largest value of their type; signed integers and floats are used as they are when all lie in 0 to 1, and are
    otherwise read as 0 to 1, 0 to 255 or 0 to 65535 by their range, or else mapped by their percentiles (see
    :class:`UnitRange`), which ``notes`` says.
    """
    if alpha not in ALPHA:
        raise ImageError(f"The use of alpha must be {', '.join(ALPHA[:-1])} or {ALPHA[-1]}, got {alpha!r}.")
    if isinstance(source, ImageInput):
        return _taken_anew(source, name, crop, scale, levels)
    level = _check_level(background)
    _check_scale(scale, "The image" if name is None else name)
    large = scale < 1 or crop is not None
    decoded, name = _load(source, name, scale=float(scale), reduced=large, should_stop=should_stop)
    image = UnitRange(decoded, name, level, alpha)
    height, width = decoded.size
    if height * width <= MAX_PIXELS:
        pixels, opacity = _whole(image, decoded.values.shape, should_stop)
        return take(
            pixels, name, crop, scale, tuple(image.notes), depth=decoded.depth, alpha=opacity, levels=levels
        )
    return _read_reduced(image, decoded, name, crop, float(scale), levels, should_stop)


def as_first_exemplar(source: Source) -> ImageInput:
    """Read an image by the rules of the first version, so that its recipes find it; see :class:`UnitRange`.

    Raises
    ------
    ImageError
        As :func:`as_exemplar`.
    """
    decoded, name = _load(source, None, scale=1.0, reduced=False, should_stop=None)
    image = UnitRange(decoded, name, 1.0, "background", first_rules=True)
    pixels, _ = _whole(image, decoded.values.shape, None)
    return take(pixels, name, notes=tuple(image.notes), depth=decoded.depth)


def _taken_anew(
    source: ImageInput, name: str | None, crop: Crop | None, scale: float, levels: Levels | None
) -> ImageInput:
    if crop is None and scale == 1.0 and (levels is None or levels.plain):
        return source if name is None else dataclasses.replace(source, name=name)
    name = source.name if name is None else name
    origin = source.origin or Origin(source.pixels, alpha=source.alpha, notes=source.notes)
    return take(
        origin.pixels,
        name,
        crop,
        scale,
        origin.notes,
        depth=source.depth,
        alpha=origin.alpha,
        taken=origin.taken,
        levels=levels,
    )


def _read_reduced(
    image: UnitRange,
    decoded: Decoded,
    name: str,
    crop: Crop | None,
    scale: float,
    levels: Levels | None,
    should_stop: Callable[[], bool] | None,
) -> ImageInput:
    """Scale down or crop a picture of more than 64 megapixels."""
    from texlab_core.images.reducing import reduced

    height, width = decoded.size
    target = scaled_size(height, width, scale)
    part = Crop(0, 0, *target) if crop is None else crop
    _check_crop(part, target, name)
    check_pixels(part.width, part.height, name)
    pixels, opacity = reduced(image, decoded.values.shape[:2], target, part, should_stop)
    notes = (
        *image.notes,
        f"The picture of {width} x {height} pixels is too large to be kept whole: {part.width} x {part.height} "
        f"pixels of it at {100 * scale:.3g} % were read.",
    )
    said = list(notes)
    pixels = _gray_if_gray(pixels, said)
    return take(
        pixels,
        name,
        None,
        1.0,
        tuple(said),
        depth=decoded.depth,
        alpha=opacity,
        taken=(scale, crop),
        levels=levels,
    )


def _whole(
    image: UnitRange, shape: tuple[int, ...], should_stop: Callable[[], bool] | None
) -> tuple[FloatImage, FloatImage | None]:
    height, width = shape[:2]
    pixels = np.empty((height, width, image.channels), np.float32)
    opacity = np.empty((height, width, 1), np.float32) if image.has_alpha else None
    for top, colours, alpha in image.bands(should_stop):
        pixels[top : top + colours.shape[0]] = colours
        if opacity is not None:
            opacity[top : top + colours.shape[0]] = alpha
    pixels = _gray_if_gray(pixels, image.notes)
    for each in (pixels, opacity):
        if each is not None and each.base is None:
            # Made here, and nobody else has it: no need for a copy.
            each.flags.writeable = False
    return pixels, opacity


def _gray_if_gray(pixels: FloatImage, notes: list[str]) -> FloatImage:
    if pixels.shape[2] == 3 and _is_gray(pixels):
        notes.append("The three channels are equal, so the image is used as gray.")
        return pixels[..., :1]
    return pixels


def _load(
    source: Source, name: str | None, *, scale: float, reduced: bool, should_stop: Callable[[], bool] | None
) -> tuple[Decoded, str]:
    """Return the decoded image and its name."""
    if isinstance(source, str) and source.startswith("gallery:"):
        from texlab_core.images.gallery import find_entry

        entry = find_entry(source)
        return read_image(entry.read(), entry.uri), name or entry.uri
    if isinstance(source, str | os.PathLike):
        shown = os.fspath(source)
        if not shown:
            raise ImageError("The name of the image is empty.")
        decoded = read_image(Path(source), shown, scale=scale, reduced=reduced, should_stop=should_stop)
        return decoded, name or display_name(shown)
    if isinstance(source, bytes | bytearray | memoryview):
        name = name or "image"
        return read_image(bytes(source), name, scale=scale, reduced=reduced, should_stop=should_stop), name
    if isinstance(source, np.ndarray):
        name = name or "array"
        # Without the rules of a subclass, in this machine's order of bytes.
        plain = np.asarray(source)
        return _from_array(plain.astype(plain.dtype.newbyteorder("="), copy=False), name, reduced=reduced), name
    raise ImageError(
        "An image must be an array, a path, the bytes of a file, an image input or gallery:NAME, "
        f"got {type(source).__name__}."
    )


def _from_array(array: NDArray[Any], name: str, *, reduced: bool) -> Decoded:
    if array.ndim == 2:
        array = array[:, :, None]
    if array.ndim != 3 or array.shape[2] not in (1, 3, 4):
        raise ImageError(f"{name}: the shape must be (H, W) or (H, W, 1, 3 or 4), got {array.shape}.")
    check_pixels(array.shape[1], array.shape[0], name, reduced=reduced)
    # As for files: what has no sign is a share of its largest value, the rest is taken as it is or mapped.
    if array.dtype.kind == "b":
        return Decoded(array.astype(np.uint8), 1)
    if array.dtype.kind == "u":
        return Decoded(array, int(np.iinfo(array.dtype).max))
    if array.dtype.kind not in "if":
        raise ImageError(f"{name}: the values must be bools, integers or floats, got {array.dtype}.")
    return Decoded(array, None, stored=depth_of(array))


def depth_of(values: NDArray[Any]) -> Depth:
    """Return the least depth at which floats lose nothing: 8 or 16 when all are k / 255 or k / 65535."""
    for bits, peak in ((8, 255), (16, 65535)):
        # A few rows tell in most cases.
        if all(_are_steps(part, peak) for part in (values[:: 1 + values.shape[0] // 16], values)):
            return 8 if bits == 8 else 16
    return "float"


def _are_steps(values: NDArray[Any], peak: int) -> bool:
    if not (float(values.min()) >= 0 and float(values.max()) <= 1):
        return False
    steps = np.rint(values.astype(np.float64) * peak)
    return bool((np.divide(steps, peak).astype(np.float32) == values.astype(np.float32)).all())


def _check_level(background: float) -> float:
    if not 0 <= background <= 1:
        raise ImageError(f"The background must be a gray level from 0 to 1, got {background!r}.")
    return float(background)


def _is_gray(pixels: FloatImage) -> bool:
    # A few rows tell most colour images from gray ones.
    few = pixels[:: 1 + pixels.shape[0] // 16]
    return all(bool((part[..., :1] == part[..., 1:]).all()) for part in (few, pixels))


def take(
    pixels: FloatImage,
    name: str,
    crop: Crop | None = None,
    scale: float = 1.0,
    notes: tuple[str, ...] = (),
    *,
    depth: Depth = 8,
    alpha: FloatImage | None = None,
    taken: tuple[float, Crop | None] | None = None,
    levels: Levels | None = None,
) -> ImageInput:
    """Scale and crop pixels that are float32 in [0, 1] already, (H, W, 1 | 3), and the alpha beside them.

    ``levels`` are of what is left then.

    Raises
    ------
    ImageError
        When they are not in that range, or for a scale or crop that cannot be; see :func:`as_exemplar`.
    """
    source = _sealed(pixels)
    check_pixels(source.shape[1], source.shape[0], name)
    _check_scale(scale, name)
    if not (float(source.min()) >= 0 and float(source.max()) <= 1):
        # NaN fails both comparisons.
        raise ImageError(f"{name}: was read with values outside 0 to 1, and is refused.")
    used = _part(source, crop, scale, name)
    height, width, _ = used.shape
    if height < MIN_SIDE or width < MIN_SIDE:
        raise ImageError(
            f"{name}: an exemplar needs at least {MIN_SIDE} x {MIN_SIDE} pixels, got {width} x {height}."
        )
    opacity = None if alpha is None else _sealed(alpha)
    if opacity is not None and opacity.shape != (*source.shape[:2], 1):
        raise ImageError(f"{name}: its transparency has another size than its colours.")
    levels = None if levels is None or levels.plain else levels
    origin = Origin(source, float(scale), crop, opacity, notes, taken, levels)
    said = notes
    whole = source.shape[0], source.shape[1]
    if (scaled := scaled_size(*whole, scale)) != whole:
        said = (*notes, reduction_note(whole, scaled, scale))
    if levels is not None:
        used = _sealed(levels.applied(used))
        said = (*said, f"The levels are {levels.words}.")
    opacity = None if opacity is None else _part(opacity, crop, scale, name)
    return ImageInput(used, name, hash_arrays({"pixels": used}), origin, said, depth, opacity)


def reduction_note(source: tuple[int, int], scaled: tuple[int, int], scale: float) -> str:
    """Return the sentence about a picture that is used at a smaller scale; sizes are (height, width)."""
    return (
        f"The picture of {source[1]} x {source[0]} pixels is used at {100 * scale:.3g} %, as {scaled[1]} x "
        f"{scaled[0]} pixels."
    )


def _part(source: FloatImage, crop: Crop | None, scale: float, name: str) -> FloatImage:
    scaled = _scaled(source, scale)
    return scaled if crop is None else _sealed(_cropped(scaled, crop, name))


def _check_scale(scale: float, name: str) -> None:
    if isinstance(scale, bool) or not isinstance(scale, int | float | np.number) or not 0 < scale <= 1:
        raise ImageError(f"{name}: the scale must be above 0 and at most 1, got {scale!r}.")


def _sealed(pixels: FloatImage) -> FloatImage:
    """Return a read-only, C-contiguous copy; as it is when it is one already."""
    if not pixels.flags.writeable and pixels.flags.c_contiguous and pixels.flags.owndata:
        return pixels
    copy = np.array(pixels, dtype=np.float32, order="C", copy=True)
    copy.flags.writeable = False
    return copy


def _scaled(pixels: FloatImage, scale: float) -> FloatImage:
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
    _check_crop(crop, pixels.shape[:2], name)
    return pixels[crop.top : crop.top + crop.height, crop.left : crop.left + crop.width]


def _check_crop(crop: Crop, size: tuple[int, int], name: str) -> None:
    height, width = size
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
