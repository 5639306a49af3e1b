"""Inputs inside a recipe: lossless when they are small enough, otherwise by name and hash."""

from __future__ import annotations

import base64
import binascii
import json
import math
import threading
import weakref
import zlib
from collections import OrderedDict
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.inputs import ArraysInput, ImageInput
from texlab_core.errors import InputError, RecipeError
from texlab_core.files import strict_json
from texlab_core.images.formats.png_text import inflate
from texlab_core.images.formats.writing import encode_png, quantize

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import Crop, Input
    from texlab_core.engine.steps import FloatImage

MAX_EMBEDDED = 2 * 2**20
"""Longest encoding of an input that is embedded, in bytes before base64."""
MAX_USED = 8 * 2**20
"""The same for what was used of an exemplar, its crop at its scale, where the whole is not embedded."""
MAX_UNPACKED = 256 * 2**20
"""Most bytes that packed numbers may unpack to."""
MAX_DATA_DEPTH = 24

_BAND = 64
_BLOCK = 2**20


def embed(given: Input, *, limit: int = MAX_EMBEDDED, used: int = MAX_EMBEDDED) -> dict[str, Any]:
    """Return a JSON object that describes an input, and holds it when its encoding is not too long.

    Parameters
    ----------
    given
        An image is kept as its whole source if that fits, otherwise as the pixels that were used: its crop at its
        scale.
    limit, used
        Longest encoding in bytes, before base64, of a whole source (arrays, a document), and of what was used of
        a larger one.
    """
    entry: dict[str, Any] = {"name": given.name, "sha256": given.sha256}
    if isinstance(given, ImageInput):
        return entry | _embed_image(given, limit, used)
    if isinstance(given, ArraysInput):
        entry["kind"] = "arrays"
        if (packed := _pack_arrays(given.arrays, limit)) is not None:
            entry["arrays"] = packed
        return entry
    entry["kind"] = "data"
    if _is_small_json(given.data):
        entry["data"] = given.data
    return entry


def _embed_image(given: ImageInput, limit: int, used: int) -> dict[str, Any]:
    height, width = given.size
    origin = given.origin
    crop = None if origin is None else origin.crop
    entry: dict[str, Any] = {
        "kind": "image",
        "size": {"width": width, "height": height},
        "channels": given.channels,
        "scale": 1.0 if origin is None else origin.scale,
        "crop": _rectangle(crop),
    }
    if given.depth != 8:
        entry["depth"] = given.depth
    if origin is not None and origin.taken is not None:
        scale, part = origin.taken
        entry["taken"] = {"scale": scale, "crop": _rectangle(part)}
    if origin is not None and origin.levels is not None:
        entry["levels"] = origin.levels.to_json()
    alpha = given.alpha
    # A picture that was used whole is the file that the user has.
    is_part = origin is not None and (origin.scale != 1 or origin.crop is not None or origin.taken is not None)
    is_part = is_part or "levels" in entry
    if origin is not None and (packed := _SOURCES.pack(origin.pixels, limit)) is not None:
        entry["source"] = packed
        alpha = origin.alpha
    elif (packed := pack_pixels(given.pixels, used if is_part else limit)) is not None:
        entry["pixels"] = packed
    if alpha is not None and (packed := pack_pixels(alpha, limit)) is not None:
        entry["alpha"] = packed
    return entry


def kept_notes(inputs: Mapping[str, Mapping[str, Any]]) -> tuple[str, ...]:
    """Return one sentence for each image that a recipe does not hold whole.

    Parameters
    ----------
    inputs
        What :func:`embed` made, by role.
    """
    notes = []
    for role, entry in inputs.items():
        if entry["kind"] != "image" or "source" in entry:
            continue
        if "pixels" not in entry:
            notes.append(f"The {role} {entry['name']} is too large to be kept in the file: keep it beside.")
        elif entry["scale"] != 1 or entry["crop"] is not None or "taken" in entry or "levels" in entry:
            width, height = entry["size"]["width"], entry["size"]["height"]
            notes.append(
                f"The file keeps the {width} x {height} pixels that were used of {entry['name']}, whose whole is "
                "too large for it."
            )
    return tuple(notes)


def _rectangle(crop: Crop | None) -> dict[str, int] | None:
    if crop is None:
        return None
    return {"top": crop.top, "left": crop.left, "height": crop.height, "width": crop.width}


def pack_pixels(pixels: FloatImage, limit: int = MAX_EMBEDDED) -> dict[str, Any] | None:
    """Return the pixels, losslessly encoded, or None when that takes more than ``limit`` bytes (2 MB).

    An 8-bit PNG when every value is k / 255, a 16-bit one when every value is k / 65535, else packed float32.
    """
    for peak in (255, 65535):
        values = quantize(pixels, peak)
        if _same_bits(np.divide(values, np.float32(peak), dtype=np.float32), pixels):
            png = _small_png(values, limit)
            return None if png is None else {"encoding": "png", "base64": _text(png)}
    packed = _deflate(pixels.astype("<f4", copy=False), limit)
    if packed is None:
        return None
    return {"encoding": "float32", "shape": list(pixels.shape), "base64": _text(packed)}


class _Sources:
    """The sources that were packed last: the jobs of one exemplar, and of its crops, all carry the same."""

    def __init__(self, capacity: int = 2) -> None:
        self._capacity = capacity
        self._lock = threading.Lock()
        # A source is known as long as someone else holds it: scans are large.
        self._packed: OrderedDict[tuple[int, int], tuple[weakref.ref[NDArray[Any]], dict[str, Any] | None]] = (
            OrderedDict()
        )

    def pack(self, pixels: FloatImage, limit: int) -> dict[str, Any] | None:
        """Return what :func:`pack_pixels` does."""
        if pixels.flags.writeable:
            # Nobody knows whether it is still what it was.
            return pack_pixels(pixels, limit)
        key = id(pixels), limit
        with self._lock:
            known = self._packed.get(key)
        if known is None or known[0]() is not pixels:
            known = weakref.ref(pixels), pack_pixels(pixels, limit)
            with self._lock:
                self._packed[key] = known
                self._packed.move_to_end(key)
                while len(self._packed) > self._capacity:
                    self._packed.popitem(last=False)
        return None if known[1] is None else dict(known[1])


_SOURCES = _Sources()


def unpack_pixels(packed: Mapping[str, Any], name: str) -> FloatImage:
    """Return (H, W, 1 | 3) float32 in [0, 1] from what :func:`pack_pixels` made.

    A PNG may also come as it is, as ``bytes`` under that name: what was a file of its own needs no detour by text.

    Raises
    ------
    RecipeError
        When it is not that.
    """
    try:
        raw = packed.get("bytes")
        data = raw if isinstance(raw, bytes) else base64.b64decode(packed["base64"], validate=True)
        if packed["encoding"] == "png":
            return _decode_png(data, name)
        if packed["encoding"] != "float32":
            raise ValueError("has an unknown encoding")
        pixels = _inflate(data, "<f4", packed["shape"]).astype(np.float32, copy=False)
        if pixels.ndim != 3 or pixels.shape[2] not in (1, 3) or not ((pixels >= 0) & (pixels <= 1)).all():
            raise ValueError("is no image")
    except InputError as error:
        raise RecipeError(f"The recipe's input {error}") from error
    except (KeyError, TypeError, ValueError, binascii.Error) as error:
        raise RecipeError(f"The recipe's input {name} {_reason(error)}.") from error
    return pixels


def unpack_arrays(packed: Any, name: str) -> dict[str, NDArray[Any]]:
    """Return arrays by name.

    Raises
    ------
    RecipeError
        When they are malformed, or unpack to more than 256 MB.
    """
    arrays: dict[str, NDArray[Any]] = {}
    total = 0
    try:
        for key, each in packed.items():
            data = base64.b64decode(each["base64"], validate=True)
            arrays[key] = _inflate(data, each["dtype"], each["shape"])
            total += arrays[key].nbytes
            if total > MAX_UNPACKED:
                raise ValueError("is too large")
    except (AttributeError, KeyError, TypeError, ValueError, binascii.Error) as error:
        raise RecipeError(f"The recipe's input {name} {_reason(error)}.") from error
    return arrays


def _reason(error: Exception) -> str:
    reason = str(error)
    known = ("is ", "has ")
    return reason if reason.startswith(known) else "is malformed"


def _decode_png(data: bytes, name: str) -> FloatImage:
    from texlab_core.images.formats.reading import read_image

    if not data.startswith(b"\x89PNG"):
        raise ValueError("is no PNG")
    decoded = read_image(data, name)
    if decoded.values.shape[2] not in (1, 3) or decoded.peak is None:
        raise ValueError("is no image")
    pixels: FloatImage = np.divide(decoded.values, np.float32(decoded.peak), dtype=np.float32)
    # Nobody else has it: it is taken without a copy.
    pixels.flags.writeable = False
    return pixels


def _small_png(values: NDArray[Any], limit: int) -> bytes | None:
    if values.nbytes > 16 * limit:
        # Do not encode a large photograph only to find that it is large.
        middle = values.shape[0] // 2
        band = values[max(0, middle - _BAND // 2) : middle + _BAND // 2]
        if len(encode_png(band, srgb=False)) * values.shape[0] / band.shape[0] > 4 * limit:
            return None
    png = encode_png(values, srgb=False)
    return png if len(png) <= limit else None


def _pack_arrays(arrays: Mapping[str, NDArray[Any]], limit: int) -> dict[str, Any] | None:
    found: dict[str, Any] = {}
    left = limit
    if sum(array.nbytes for array in arrays.values()) > MAX_UNPACKED:
        return None
    for key, array in arrays.items():
        if array.dtype.kind not in "biufc":
            return None
        packed = _deflate(array, left)
        if packed is None:
            return None
        left -= len(packed)
        found[key] = {"dtype": array.dtype.str, "shape": list(array.shape), "base64": _text(packed)}
    return found


def _deflate(array: NDArray[Any], limit: int = MAX_EMBEDDED) -> bytes | None:
    """Return the compressed values, or None as soon as they exceed the limit."""
    if array.nbytes > MAX_UNPACKED:
        return None
    raw = memoryview(np.ascontiguousarray(array).tobytes())
    machine = zlib.compressobj()
    parts: list[bytes] = []
    size = 0
    for start in range(0, len(raw), _BLOCK):
        parts.append(machine.compress(raw[start : start + _BLOCK]))
        size += len(parts[-1])
        if size > limit:
            return None
    packed = b"".join([*parts, machine.flush()])
    return packed if len(packed) <= limit else None


def _inflate(data: bytes, dtype: str, shape: Any) -> NDArray[Any]:
    kind = np.dtype(dtype) if isinstance(dtype, str) and len(dtype) <= 4 else None
    if kind is None or kind.kind not in "biufc":
        raise ValueError("has numbers of an unknown type")
    sides_ok = isinstance(shape, list) and len(shape) <= 32
    if not sides_ok or not all(type(side) is int and 0 <= side <= MAX_UNPACKED for side in shape):
        raise ValueError("has a malformed shape")
    size = math.prod(shape) * kind.itemsize
    if size > MAX_UNPACKED:
        raise ValueError("is too large")
    raw = inflate(data, size)
    if len(raw) < size:
        raise ValueError("is too short for its shape")
    return np.frombuffer(raw, kind).reshape(shape)


def _same_bits(one: FloatImage, other: FloatImage) -> bool:
    # Equal values may differ in the sign of zero, which the hash sees.
    return np.array_equal(one.view(np.uint32), np.ascontiguousarray(other).view(np.uint32))


def _is_small_json(data: Any) -> bool:
    text = json.dumps(data)
    if len(text) > MAX_EMBEDDED:
        return False
    try:
        strict_json.loads(text, max_bytes=MAX_EMBEDDED, max_depth=MAX_DATA_DEPTH)
    except InputError:
        return False
    return True


def _text(data: bytes) -> str:
    return base64.b64encode(data).decode("ascii")
