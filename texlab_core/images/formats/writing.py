"""Write images: PNG, TIFF, WebP, JPEG, AVIF, JPEG XL and OpenEXR, as deep as each goes; whole or not at all."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from texlab_core.errors import ImageError
from texlab_core.files.whole import write_whole
from texlab_core.images.formats import jpeg_text, webp_text
from texlab_core.images.formats.modern import check_codec
from texlab_core.images.formats.png_text import with_chunk, with_text

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

Bits = Literal[8, 16, "float"]
WRITABLE_SUFFIXES = (".png", ".tif", ".tiff", ".webp", ".jpg", ".jpeg", ".avif", ".jxl", ".exr")
LOSSY_SUFFIXES = (".webp", ".jpg", ".jpeg", ".avif", ".jxl")
TEXT_SUFFIXES = (".png", ".tif", ".tiff", ".webp", ".jpg", ".jpeg")
_BITS: dict[str, tuple[Bits, ...]] = {
    ".png": (8, 16),
    ".tif": (8, 16, "float"),
    ".tiff": (8, 16, "float"),
    ".webp": (8,),
    ".jpg": (8,),
    ".jpeg": (8,),
    ".avif": (8,),
    ".jxl": (8, 16, "float"),
    ".exr": ("float",),
}
_ROWS = 256
_JPEG_QUALITY = 95
_MAX_WEBP_SIDE = 16383
# Perceptual intent (PNG specification, 11.3.2.5).
_SRGB = b"\0"
_TIFF_PREFIX = "TexLab "


def write_image(
    path: str | os.PathLike[str],
    pixels: NDArray[np.floating[Any]],
    *,
    bits: Bits = 8,
    text: Mapping[str, str] | None = None,
    alpha: NDArray[np.floating[Any]] | None = None,
) -> None:
    """Write an image; the suffix of the path chooses the format. See :func:`encode_image`.

    Raises
    ------
    ImageError
        When the format is unknown or cannot hold what is asked, or the values are not finite.
    InputError
        When the file cannot be written; what was there before stays as it was.
    """
    write_whole(path, encode_image(path, pixels, bits=bits, text=text, alpha=alpha))


def encode_image(
    path: str | os.PathLike[str],
    pixels: NDArray[np.floating[Any]],
    *,
    bits: Bits = 8,
    text: Mapping[str, str] | None = None,
    alpha: NDArray[np.floating[Any]] | None = None,
    quality: int | None = None,
) -> bytes:
    """Return the bytes of an image file.

    Parameters
    ----------
    path
        Ends in .png, .tif, .tiff, .webp, .jpg, .jpeg, .avif, .jxl or .exr, which chooses the format.
    pixels
        (H, W) or (H, W, 1 | 3) floats in [0, 1]; integers of a file are rounded to the nearest, and values outside
        are clipped. Floats are written as float32, as they are; OpenEXR holds light, without the curve of sRGB.
    bits
        8, 16 or "float" for each sample.
    text
        Texts by key, for PNG, JPEG and WebP; a TIFF takes one ASCII text, its description, after the word TexLab:
        what starts with a brace and has a "shape" is taken by other programs for a description of theirs.
    alpha
        (H, W) or (H, W, 1) floats in [0, 1], for all formats but JPEG; OpenEXR holds colours multiplied by it.
    quality
        1 to 100, for the formats that can lose something: JPEG (95 when None), WebP, AVIF and JPEG XL, which lose
        nothing when None.

    Raises
    ------
    ImageError
        When the format is unknown or cannot hold what is asked, or the values are not finite.
    """
    suffix = check_format(path, bits)
    name = os.fspath(path)
    check_quality(path, quality)
    image = np.asarray(pixels)
    if (
        image.dtype.kind != "f"
        or image.ndim not in (2, 3)
        or image.size == 0
        or image.shape[2:] not in ((), (1,), (3,))
    ):
        raise ImageError(
            f"{name}: an image to write is (H, W), (H, W, 1) or (H, W, 3) of floats, got {image.shape}."
        )
    if not np.isfinite(image).all():
        raise ImageError(f"{name}: the image has values that are not finite, and cannot be written.")
    if alpha is not None:
        image = _with_alpha(image, np.asarray(alpha), suffix, name)
    image = image[..., 0] if image.shape[2:] == (1,) else image
    values = image.astype(np.float32) if bits == "float" else quantize(image, 2**bits - 1)
    if suffix == ".png":
        return encode_png(values, text)
    if suffix in (".tif", ".tiff"):
        return _encode_tiff(values, text)
    if suffix == ".webp":
        return _encode_webp(values, text, name, quality)
    if suffix == ".exr":
        return _encode_exr(values, text)
    if suffix in (".avif", ".jxl"):
        from texlab_core.images.formats.modern import encode_avif, encode_jxl

        if text:
            raise ValueError(f"A {suffix} file takes no text.")
        return encode_avif(values, quality) if suffix == ".avif" else encode_jxl(values, quality)
    return _encode_jpeg(values, text, _JPEG_QUALITY if quality is None else quality)


def _with_alpha(
    image: NDArray[np.floating[Any]], alpha: NDArray[np.floating[Any]], suffix: str, name: str
) -> NDArray[np.floating[Any]]:
    if not can_hold_alpha(suffix):
        raise ImageError(f"{name}: a JPEG file holds no transparency; choose PNG, TIFF or WebP.")
    if alpha.shape[:2] != image.shape[:2] or alpha.size != image.shape[0] * image.shape[1]:
        raise ImageError(f"{name}: the transparency must be as large as the image, got {alpha.shape}.")
    if not np.isfinite(alpha).all():
        raise ImageError(f"{name}: the transparency has values that are not finite, and cannot be written.")
    planes = image.reshape(*image.shape[:2], -1)
    return np.concatenate([planes, alpha.reshape(*alpha.shape[:2], 1).astype(planes.dtype)], axis=2)


def can_hold_alpha(path: str | os.PathLike[str]) -> bool:
    """Return whether files of this name or suffix hold transparency."""
    return not os.fspath(path).lower().endswith((".jpg", ".jpeg"))


def default_bits(path: str | os.PathLike[str], depth: Bits) -> Bits:
    """Return the depth at which a result is saved by default: that of its exemplar, as far as the format has it.

    Parameters
    ----------
    path
        The file to write.
    depth
        ``ImageInput.depth`` of the exemplar.

    Raises
    ------
    ImageError
        When no image can be written under this name.
    """
    allowed = _BITS[check_format(path)]
    return depth if depth in allowed else allowed[-1]


def named_with_suffix(path: str | os.PathLike[str], suffix: str) -> Path:
    """Return the path with the suffix of the chosen format, unless it ends in one that is written already.

    ``wall.v2`` and .png make ``wall.v2.png``, since what follows a dot may be part of the name.
    """
    given = Path(path)
    return given if given.suffix.lower() in _BITS else given.with_name(given.name + suffix)


def check_format(path: str | os.PathLike[str], bits: Bits | None = None) -> str:
    """Return the suffix in lower case; ``bits`` None asks for the format alone.

    Raises
    ------
    ImageError
        When no image can be written under this name, or not with these bits.
    """
    suffix = Path(path).suffix.lower()
    if not os.fspath(path):
        raise ImageError("The name of the file to write is empty.")
    if suffix not in _BITS:
        raise ImageError(
            f"{os.fspath(path)}: images are written as {', '.join(WRITABLE_SUFFIXES)}, got {suffix!r}."
        )
    check_codec(suffix, os.fspath(path))
    if bits is not None and bits not in _BITS[suffix]:
        allowed = " or ".join(str(each) for each in _BITS[suffix])
        raise ImageError(f"{os.fspath(path)}: the bits of a {suffix} file must be {allowed}, got {bits!r}.")
    return suffix


def check_quality(path: str | os.PathLike[str], quality: int | None) -> None:
    """Raise ``ImageError`` when a quality is out of range, or the format of this name loses nothing anyway."""
    suffix = Path(path).suffix.lower()
    if quality is None:
        return
    if isinstance(quality, bool) or not isinstance(quality, int) or not 1 <= quality <= 100:
        raise ImageError(f"quality: must be a whole number from 1 to 100, got {quality!r}.")
    if suffix not in LOSSY_SUFFIXES:
        kinds = ", ".join(LOSSY_SUFFIXES)
        raise ImageError(f"quality: is for {kinds}; a {suffix} file loses nothing and takes none.")


def quantize(pixels: NDArray[np.floating[Any]], peak: int) -> NDArray[Any]:
    """Return the nearest of 0 .. ``peak`` as uint8 or uint16; values are clipped to [0, 1]."""
    values = np.empty(pixels.shape, np.uint8 if peak <= 255 else np.uint16)
    for top in range(0, pixels.shape[0], _ROWS):
        rows = slice(top, top + _ROWS)
        # The product is exact in float64, so that it is rounded once.
        values[rows] = np.rint(pixels[rows].clip(0, 1).astype(np.float64) * peak)
    return values


def encode_png(values: NDArray[Any], text: Mapping[str, str] | None = None, *, srgb: bool = True) -> bytes:
    """Return a PNG file of (H, W) or (H, W, 1 | 2 | 3 | 4) uint8 or uint16, which says that it is in sRGB."""
    import imagecodecs

    plane = values[..., 0] if values.shape[2:] == (1,) else values
    png = bytes(imagecodecs.png_encode(np.ascontiguousarray(plane)))
    png = with_text(png, text) if text else png
    return with_chunk(png, b"sRGB", _SRGB) if srgb else png


def _encode_tiff(values: NDArray[Any], text: Mapping[str, str] | None) -> bytes:
    import tifffile

    if text and len(text) > 1:
        raise ValueError(f"A TIFF file takes one text, got {len(text)}.")
    out = io.BytesIO()
    tifffile.imwrite(
        out,
        values,
        photometric="rgb" if values.shape[2:] in ((3,), (4,)) else "minisblack",
        planarconfig="contig" if values.ndim == 3 else None,
        extrasamples=("unassalpha",) if values.shape[2:] in ((2,), (4,)) else None,
        compression="zlib",
        predictor=values.dtype.kind == "u",
        metadata=None,
        software="TexLab",
        description=_TIFF_PREFIX + next(iter(text.values())) if text else None,
    )
    return out.getvalue()


def _encode_webp(values: NDArray[Any], text: Mapping[str, str] | None, name: str, quality: int | None) -> bytes:
    import imagecodecs

    if max(values.shape[:2]) > _MAX_WEBP_SIDE:
        raise ImageError(
            f"{name}: a WebP file has at most {_MAX_WEBP_SIDE} pixels in a side, got {values.shape[1]} x "
            f"{values.shape[0]}."
        )
    planes = values.reshape(*values.shape[:2], -1)
    colours = planes.shape[2] - 1 + planes.shape[2] % 2
    # The format has no gray.
    rgb = np.repeat(planes[..., :1], 3, axis=2) if colours == 1 else planes[..., :3]
    whole = np.ascontiguousarray(np.concatenate([rgb, planes[..., colours:]], axis=2))
    lossless = quality is None
    webp = bytes(imagecodecs.webp_encode(whole, level=None if lossless else quality, lossless=lossless))
    for key, each in (text or {}).items():
        webp = webp_text.with_text(webp, key, each)
    return webp


def _encode_exr(values: NDArray[Any], text: Mapping[str, str] | None) -> bytes:
    from texlab_core.images.formats.exr import encode_exr
    from texlab_core.images.formats.profiles import decode_srgb

    if text:
        raise ValueError("A .exr file takes no text.")
    planes = values.reshape(*values.shape[:2], -1)
    colours = planes.shape[2] - (planes.shape[2] in (2, 4))
    light, alpha = decode_srgb(planes[..., :colours]), planes[..., colours:]
    if alpha.shape[2]:
        light = np.concatenate([light * alpha, alpha], axis=2)
    return encode_exr(light.astype(np.float32))


def _encode_jpeg(values: NDArray[Any], text: Mapping[str, str] | None, quality: int) -> bytes:
    from PIL import Image

    out = io.BytesIO()
    # Colour at full resolution: textures have fine colour.
    Image.fromarray(values).save(out, "JPEG", quality=quality, subsampling=0)
    jpeg = out.getvalue()
    for key, each in (text or {}).items():
        jpeg = jpeg_text.with_text(jpeg, key, each)
    return jpeg
