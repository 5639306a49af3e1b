"""Convert stored values to sRGB by the file's own colour profile."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_SPACES = {b"GRAY": "gray", b"RGB ": "rgb", b"CMYK": "cmyk"}
_SAMPLES = {"gray": 1, "rgb": 3, "cmyk": 4}
_LEVEL = 257
# A profile is some kilobytes; those of printing presses have one or two megabytes.
MAX_PROFILE = 16 * 2**20
_NO_SHORTCUTS = 0x100
_ROWS = 64
_BRIGHT_SHARE = 99.5
_MOST_SAMPLED = 2**20
_GAMMA_SRGB = 0.45455
_ENCODED_SRGB = 0.04045


def to_srgb(values: NDArray[Any], profile: bytes | None, *, cmyk: bool, notes: list[str]) -> NDArray[Any]:
    """Convert an image to sRGB.

    Parameters
    ----------
    values
        (H, W, C) uint8 or uint16 over their whole range: gray or RGB, with or without alpha, or four inks (0 is no
        ink).
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
    if given.dtype == np.uint8:
        eight: NDArray[Any] = imagecodecs.cms_transform(
            given, profile, srgb, colorspace=space, outcolorspace="rgb"
        )
        return eight
    # The engine's shortcut for 16 bits is a coarse table, wrong by up to 20 levels of 255 in saturated colours.
    converted = np.empty((*given.shape[:2], 3), np.uint16)
    for top in range(0, given.shape[0], _ROWS):
        rows = slice(top, top + _ROWS)
        floats = imagecodecs.cms_transform(
            given[rows], profile, srgb, colorspace=space, outcolorspace="rgb", outdtype="f4", flags=_NO_SHORTCUTS
        )
        converted[rows] = np.rint(np.clip(floats, 0, 1).astype(np.float64) * 65535)
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


def whole_range(values: NDArray[Any], peak: int) -> NDArray[Any]:
    """Return integers 0 .. ``peak`` as uint8 (peak 255) or uint16 over the whole range, which profiles are for."""
    if peak in (255, 65535):
        return values.astype(np.uint8 if peak == 255 else np.uint16, copy=False)
    whole: NDArray[Any] = np.rint(values.clip(0, peak) * (65535 / peak)).astype(np.uint16)
    return whole


def from_gamma(values: NDArray[Any], gamma: float, notes: list[str], peak: int | None = None) -> NDArray[Any]:
    """Return uint16 sRGB of samples that a PNG file declares to be light to the power of ``gamma``.

    Parameters
    ----------
    values
        (H, W, C) uint8 or uint16; alpha, in the second or fourth channel, stays.
    gamma
        Of the gAMA chunk (PNG specification, 11.3.2.2): sample = light ** gamma. 1/2.2 stands for sRGB, and
        changes nothing; neither does what is no gamma of any device (below 0.1 or above 5).
    notes
        What was done, or why it was not, is appended here.
    peak
        The integer that means 1; by default the largest of its kind. With another one the result is always uint16.
    """
    if abs(gamma - _GAMMA_SRGB) < 0.02:
        return values
    if not 0.1 <= gamma <= 5:
        notes.append(f"The file's gamma of {gamma:g} is none of any device and was ignored.")
        return values
    peak = int(np.iinfo(values.dtype).max) if peak is None else peak
    light = (np.arange(peak + 1) / peak) ** (1 / gamma)
    table = np.rint(65535 * encode_srgb(light)).astype(np.uint16)
    alpha = values.shape[2] in (2, 4)
    converted: NDArray[np.uint16] = table[values[..., :-1] if alpha else values]
    notes.append(f"The file's gamma of {gamma:g} was converted to that of sRGB.")
    if not alpha:
        return converted
    opacity = np.rint(values[..., -1:] * (65535 / peak)).astype(np.uint16)
    return np.concatenate([converted, opacity], axis=2)


def encode_srgb(light: NDArray[Any]) -> NDArray[Any]:
    """Return sRGB values of linear light in [0, 1] (IEC 61966-2-1)."""
    low = light * 12.92
    high = 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055
    encoded: NDArray[Any] = np.where(low <= _ENCODED_SRGB, low, high)
    return encoded


def decode_srgb(values: NDArray[Any]) -> NDArray[Any]:
    """Return the linear light of sRGB values in [0, 1]; the inverse of :func:`encode_srgb`."""
    high = ((np.maximum(values, 0) + 0.055) / 1.055) ** 2.4
    light: NDArray[Any] = np.where(values <= _ENCODED_SRGB, values / 12.92, high)
    return light


def from_light(light: NDArray[Any], notes: list[str]) -> NDArray[np.float32]:
    """Return sRGB values in [0, 1] of light, whose white is 1 if next to nothing is brighter.

    Parameters
    ----------
    light
        Finite floats; what is below 0 becomes black.
    notes
        The light that became white is appended here.
    """
    step = 1 + light.size // _MOST_SAMPLED
    bright = float(np.percentile(light.reshape(-1)[::step], _BRIGHT_SHARE, method="higher"))
    white = bright if bright > 1 else 1.0
    notes.append(
        f"Light up to {white:.4g} was mapped to 0 to 1 by the curve of sRGB; what is brighter was clipped."
    )
    values: NDArray[np.float32] = np.clip(encode_srgb(np.clip(light / white, 0, 1)), 0, 1).astype(np.float32)
    return values
