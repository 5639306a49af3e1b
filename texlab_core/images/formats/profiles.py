"""Convert stored values to sRGB by the file's own colour profile."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_SPACES = {b"GRAY": "gray", b"RGB ": "rgb", b"CMYK": "cmyk"}
_SAMPLES = {"gray": 1, "rgb": 3, "cmyk": 4}
_LEVEL = 257


def to_srgb(values: NDArray[Any], profile: bytes | None, *, cmyk: bool, notes: list[str]) -> NDArray[Any]:
    """Convert an image to sRGB.

    Parameters
    ----------
    values
        (H, W, C) uint8 or uint16: gray or RGB, with or without alpha, or four inks (0 is no ink).
    profile
        The ICC profile of the file, or None.
    cmyk
        The four channels are inks.
    notes
        What was done, or why it was not, is appended here.

    Returns
    -------
    NDArray
        Gray or RGB with the alpha it had. A profile that amounts to sRGB changes no value; a damaged one is
        ignored.
    """
    alpha = values.shape[2] in (2, 4) and not cmyk
    colours = values[..., :-1] if alpha else values
    space = "cmyk" if cmyk else "gray" if colours.shape[2] == 1 else "rgb"
    converted = _by_profile(colours, profile, space, notes) if profile else None
    if converted is None and cmyk:
        notes.append("The four inks were converted to RGB without a colour profile.")
        converted = _by_ink(colours)
    if converted is None:
        return values
    if space == "gray":
        converted = converted[..., 1:2]
    return np.concatenate([converted, values[..., -1:]], axis=2) if alpha else converted


def _by_profile(colours: NDArray[Any], profile: bytes, space: str, notes: list[str]) -> NDArray[Any] | None:
    if (found := _SPACES.get(profile[16:20])) != space:
        of = f"for {found} images" if found else "of an unknown kind"
        notes.append(f"The colour profile is {of} and was ignored.")
        return None
    try:
        if _is_srgb(profile, space):
            return None
        converted = _transform(colours, profile, space)
    except Exception:
        # The colour engine raises its own errors, and RuntimeError, on damaged profiles.
        notes.append("The colour profile is damaged and was ignored.")
        return None
    notes.append("Colours were converted to sRGB by the image's profile.")
    return converted


def _transform(colours: NDArray[Any], profile: bytes, space: str) -> NDArray[Any]:
    import imagecodecs

    given = np.ascontiguousarray(colours[..., 0] if space == "gray" else colours)
    srgb = imagecodecs.cms_profile("srgb")
    converted: NDArray[Any] = imagecodecs.cms_transform(
        given, profile, srgb, colorspace=space, outcolorspace="rgb"
    )
    return converted


def _is_srgb(profile: bytes, space: str) -> bool:
    """Whether the profile moves no colour of a 9 x 9 x 9 cube (or 257 grays) by more than one level of 255."""
    if space == "cmyk":
        return False
    steps = np.linspace(0, 65535, 9 if space == "rgb" else 257).round().astype(np.uint16)
    cube = np.stack(np.meshgrid(*[steps] * _SAMPLES[space], indexing="ij"), axis=-1).reshape(
        1, -1, _SAMPLES[space]
    )
    moved = _transform(cube, profile, space).astype(np.int32) - cube.astype(np.int32)
    return bool(np.abs(moved).max() <= _LEVEL)


def _by_ink(inks: NDArray[Any]) -> NDArray[Any]:
    peak = np.float32(np.iinfo(inks.dtype).max)
    light = 1 - inks.astype(np.float32) / peak
    rgb: NDArray[Any] = np.rint(light[..., :3] * light[..., 3:] * peak).astype(inks.dtype)
    return rgb
