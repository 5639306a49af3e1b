"""Sizes of what is made: height and width of an image, or depth, height and width of a volume."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np

from texlab_core.errors import ParamError

if TYPE_CHECKING:
    from collections.abc import Sequence

MAX_PIXELS = 64 * 2**20
DEFAULT_SOLID = 64
_SIDES = ("depth", "height", "width")


@overload
def check_size(size: object, dimensions: Literal[2] = 2) -> tuple[int, int]: ...


@overload
def check_size(size: object, dimensions: int) -> tuple[int, ...]: ...


def check_size(size: object, dimensions: int = 2) -> tuple[int, ...]:
    """Return (height, width), or (depth, height, width) for three ``dimensions``.

    Raises ``ParamError`` unless every side is at least 1 and it is at most 64 megapixels (or as many voxels).
    """
    allowed = (
        "height and width of at least 1 pixel and at most 64 megapixels together"
        if dimensions == 2
        else "depth, height and width of at least 1 voxel and at most 64 million voxels together"
    )
    if not isinstance(size, tuple | list) or len(size) != dimensions:
        raise ParamError("size", allowed, size)
    for side in size:
        if isinstance(side, bool) or not isinstance(side, int | np.integer) or side < 1:
            raise ParamError("size", allowed, size)
    if math.prod(map(int, size)) > MAX_PIXELS:
        raise ParamError("size", allowed, size)
    return tuple(map(int, size))


def size_from_text(text: str, dimensions: int = 2, name: str = "size") -> tuple[int, ...]:
    """Return (height, width) of ``256x192``, or (depth, height, width) of ``128x128x64``: text has width first.

    One number stands for all sides.

    Raises
    ------
    ParamError
        When it is no size of so many sides, each of at least 1, or has more than 64 megapixels.
    """
    sides = re.split(r"\s*[xX\u00d7]\s*", text.strip())
    sides = sides * dimensions if len(sides) == 1 else sides
    if len(sides) != dimensions or not all(re.fullmatch("0{0,8}[1-9][0-9]{0,8}", side) for side in sides):
        wanted = (
            "width and height as in 256x192" if dimensions == 2 else "width, height and depth as in 128x128x64"
        )
        raise ParamError(name, f"{wanted}, or one number of at least 1 for all sides", text)
    size = tuple(int(side) for side in reversed(sides))
    if math.prod(size) > MAX_PIXELS:
        unit = "megapixels" if dimensions == 2 else "million voxels"
        raise ParamError(name, f"at most 64 {unit}", text)
    return size


def default_size(exemplar: tuple[int, int], dimensions: int) -> tuple[int, ...]:
    """Return the size without a choice: the exemplar's, or a cube with its shorter side, at most 64."""
    return exemplar if dimensions == 2 else (min(*exemplar, DEFAULT_SOLID),) * dimensions


def size_text(size: Sequence[int], between: str = " x ") -> str:
    """Return a size as people write it: width x height, or width x height x depth."""
    return between.join(str(side) for side in (*size[:-3:-1], *size[:-2]))


def size_to_json(size: Sequence[int]) -> dict[str, int]:
    """Return a size as JSON: width, height and, for a volume, depth."""
    return dict(reversed(list(zip(_SIDES[-len(size) :], size, strict=True))))


def size_from_json(data: Any, dimensions: int) -> tuple[int, ...]:
    """Return the size that :func:`size_to_json` wrote; raises ``ParamError``."""
    if not isinstance(data, Mapping) or set(data) != set(_SIDES[-dimensions:]):
        names = "a width and a height" if dimensions == 2 else "a width, a height and a depth"
        raise ParamError("size", names, data)
    return check_size(tuple(data[side] for side in _SIDES[-dimensions:]), dimensions)
