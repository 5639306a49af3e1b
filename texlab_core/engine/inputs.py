"""The named, hashed, read-only things that a job works on."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from texlab_core.engine.params import frozen_mapping
from texlab_core.files.wording import printable

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.engine.levels import Levels
    from texlab_core.engine.steps import FloatImage


@dataclass(frozen=True, slots=True)
class Crop:
    """A rectangle in the scaled source, in pixels: top row, left column, height, width."""

    top: int
    left: int
    height: int
    width: int


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Origin:
    """Where an exemplar was taken from: the source image, scaled first, then cropped.

    Parameters
    ----------
    pixels
        The whole source, (H, W, C) float32 in [0, 1], read-only.
    scale
        Factor applied to both sides of the source, 0 < scale <= 1.
    crop
        Part of the scaled source, or None for all of it.
    alpha
        Transparency of the whole source, (H, W, 1) float32 in [0, 1], read-only, where it is kept.
    notes
        What was converted when the source was read, one sentence each.
    taken
        Scale and crop at which a picture too large to be kept whole was read; ``pixels`` is what came out.
    levels
        What was made of the values, after scale and crop; None: nothing.
    """

    pixels: FloatImage
    scale: float = 1.0
    crop: Crop | None = None
    alpha: FloatImage | None = None
    notes: tuple[str, ...] = ()
    taken: tuple[float, Crop | None] | None = None
    levels: Levels | None = None

    def __repr__(self) -> str:
        """Return one short line."""
        return f"<Origin: {_extent(self.pixels)}, scale {self.scale:g}, crop {self.crop}>"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ImageInput:
    """An image as methods get it.

    Parameters
    ----------
    pixels
        (H, W, C) float32 in [0, 1], C-contiguous, read-only; C is 1 (gray) or 3 (RGB).
    name
        For people and recipes ("gallery:structured-pebbles", "wall.jpg").
    sha256
        Hash of shape and values; caches and recipes use it.
    origin
        The source it was scaled and cropped from, when that is known.
    notes
        What was converted on the way in, one sentence each.
    depth
        8, 16 or "float": the depth of the file or array it came from, at which results are saved by default.
    alpha
        Transparency, (H, W, 1) float32 in [0, 1], read-only, where it is kept; methods do not see it.
    """

    pixels: FloatImage
    name: str
    sha256: str
    origin: Origin | None = None
    notes: tuple[str, ...] = ()
    depth: Literal[8, 16, "float"] = 8
    alpha: FloatImage | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", printable(self.name))

    @property
    def size(self) -> tuple[int, int]:
        """Height and width."""
        return self.pixels.shape[0], self.pixels.shape[1]

    @property
    def channels(self) -> int:
        """1 (gray) or 3 (RGB)."""
        return int(self.pixels.shape[2])

    def __repr__(self) -> str:
        """Return one short line."""
        return f"<ImageInput: {shorten(self.name)}, {_extent(self.pixels)}, SHA-256 {self.sha256[:12]}...>"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class DataInput:
    """A small JSON document as input: a code of 69 numbers, say."""

    data: Any
    name: str
    sha256: str = field(default="")

    def __post_init__(self) -> None:
        text = json.dumps(self.data, sort_keys=True, separators=(",", ":"), allow_nan=False)
        object.__setattr__(self, "name", printable(self.name))
        object.__setattr__(self, "sha256", hashlib.sha256(text.encode()).hexdigest())

    def __repr__(self) -> str:
        """Return one short line."""
        return f"<DataInput: {shorten(self.name)}, SHA-256 {self.sha256[:12]}...>"


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ArraysInput:
    """Named arrays as input: a state to go on from. The arrays are copied and made read-only."""

    arrays: Mapping[str, NDArray[Any]]
    name: str
    sha256: str = field(default="")

    def __post_init__(self) -> None:
        copies = {}
        for key in sorted(self.arrays):
            copies[key] = np.array(self.arrays[key], order="C", copy=True)
            copies[key].flags.writeable = False
        object.__setattr__(self, "name", printable(self.name))
        object.__setattr__(self, "arrays", frozen_mapping(copies))
        object.__setattr__(self, "sha256", hash_arrays(copies))

    def __repr__(self) -> str:
        """Return one short line."""
        return f"<ArraysInput: {shorten(self.name)}, {len(self.arrays)} arrays, SHA-256 {self.sha256[:12]}...>"


def shorten(text: str, longest: int = 60) -> str:
    """Return a text as a short line shows it."""
    return text if len(text) <= longest else f"{text[: longest - 3]}..."


def _extent(pixels: NDArray[Any]) -> str:
    sides = " x ".join(str(side) for side in pixels.shape[-2::-1])
    return f"{sides} pixels, {'gray' if pixels.shape[-1] == 1 else 'colour'}"


Input = ImageInput | DataInput | ArraysInput
Inputs = Mapping[str, Input]


def hash_arrays(arrays: Mapping[str, NDArray[Any]]) -> str:
    """Return the SHA-256 of names, shapes, types and values."""
    digest = hashlib.sha256()
    for key in sorted(arrays):
        value = np.ascontiguousarray(arrays[key])
        digest.update(f"{key}:{value.shape}:{value.dtype.str};".encode())
        digest.update(value.view(np.uint8).reshape(-1).data if value.size else b"")
    return digest.hexdigest()


def exemplar_of(inputs: Inputs) -> ImageInput:
    """Return the input called ``exemplar``; raises ``KeyError`` when a job lacks it (checked by ``Job``)."""
    exemplar = inputs["exemplar"]
    if not isinstance(exemplar, ImageInput):
        raise TypeError("The exemplar must be an ImageInput.")
    return exemplar
