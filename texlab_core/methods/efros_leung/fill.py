"""Where growth begins: a seed patch, an image with holes or to grow outward, or an earlier state."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from texlab_core.engine.inputs import ArraysInput, ImageInput, Inputs, exemplar_of
from texlab_core.errors import InputError
from texlab_core.methods.efros_leung.candidates import may_be_copied, to_bytes
from texlab_core.methods.efros_leung.growth import Growth, empty_canvas
from texlab_core.work.tasks import row_blocks

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping

    from numpy.typing import NDArray

    from texlab_core.engine.steps import FloatImage
    from texlab_core.engine.streams import Streams
    from texlab_core.kernels.neighbourhood_types import Canvas, Pool
    from texlab_core.methods.efros_leung.windows import Matching

Anchor = Literal[
    "center", "top-left", "top", "top-right", "left", "right", "bottom-left", "bottom", "bottom-right", "at"
]
Place = Anchor | tuple[int, int]
"""Where an image lies in a larger output: at one of its borders, or with its top left pixel at (row, column)."""
_PIXELS_AT_ONCE = 2**16


@dataclass(frozen=True, eq=False)
class Beginning:
    """What is known before the first pixel is filled.

    Parameters
    ----------
    canvas
        The image so far and its maps.
    given
        (H, W, C) float32, the pixels that no exemplar pixel stands for; None when there are none.
    progress
        What a state knows of the layer at hand: the fields of ``Growth`` by name.
    """

    canvas: Canvas
    given: FloatImage | None
    progress: Mapping[str, Any]


def hole_of(inputs: Inputs) -> NDArray[np.bool_] | None:
    """Return where the exemplar itself is to be filled, (H, W) bool: no window that touches it is a candidate."""
    mask, start = hole_image(inputs), image_of(inputs, "start")
    if mask is None or (start is not None and start.sha256 != exemplar_of(inputs).sha256):
        return None
    return marked_in(mask)


def hole_image(inputs: Inputs) -> ImageInput | None:
    """Return what says where the start image is filled: its mask, or how much of the fill covers it."""
    return image_of(inputs, "mask") or image_of(inputs, "blend")


def fills(inputs: Inputs) -> bool:
    """Return whether an image is filled or extended, and not grown from a seed or a state."""
    return "state" not in inputs and any(name in inputs for name in ("start", "mask", "blend"))


def region_of(inputs: Inputs) -> NDArray[np.bool_] | None:
    """Return what may be copied of the exemplar, (H, W) bool; raises ``InputError`` for another size."""
    region = image_of(inputs, "region")
    if region is None:
        return None
    height, width = exemplar_of(inputs).size
    if region.size != (height, width):
        raise InputError(
            f"region: must have the size of the exemplar, {width} x {height} pixels, "
            f"got {region.size[1]} x {region.size[0]}."
        )
    return marked_in(region)


def allowed_centres(inputs: Inputs, matching: Matching) -> NDArray[np.bool_]:
    """Return where in the exemplar the centre of a candidate may be, (H, W) bool."""
    return may_be_copied(exemplar_of(inputs).size, matching, region_of(inputs), hole_of(inputs))


def begin(
    inputs: Inputs, matching: Matching, size: tuple[int, int], streams: Streams, *, seed_patch: int, anchor: Place
) -> Generator[None, None, Beginning]:
    """Lay out what is known at the start; yields between portions of large images.

    A ``state`` counts most; then ``start`` (the exemplar when there is only a ``mask``) but what the mask marks;
    otherwise a patch of ``seed_patch`` x ``seed_patch`` pixels from a random place of the exemplar is put in the
    middle (top left for a causal window). What is smaller than ``size`` is placed at ``anchor``.
    """
    state = inputs.get("state")
    if isinstance(state, ArraysInput):
        return (yield from _from_state(state, size, anchor))
    if fills(inputs):
        return (yield from _from_image(inputs, size, anchor))
    return _from_seed(inputs, matching, size, streams("seed patch"), seed_patch)


def settings_digest(inputs: Inputs, matching: Matching, size: tuple[int, int], streams: Streams) -> bytes:
    """Identify everything that the way of growing depends on, the beginning apart."""
    hashes = [
        each.sha256 if (each := inputs.get(name)) is not None else "" for name in ("exemplar", "mask", "region")
    ]
    # Nothing more where there is none: states that were kept before go on as they would have.
    hashes += [each.sha256] if (each := inputs.get("blend")) is not None else []
    hole = "hole" if hole_of(inputs) is not None else ""
    text = repr((matching, size, streams.seed, hashes, hole))
    return hashlib.blake2b(text.encode(), digest_size=16).digest()


def make_growth(
    beginning: Beginning, pool: Pool, matching: Matching, streams: Streams, settings: bytes, *, guesses: int = 0
) -> Growth:
    """Return the growth that goes on from a beginning: in its layer under the same settings, else in a new one."""
    progress = dict(beginning.progress)
    if progress.pop("settings", settings) != settings:
        progress = {"filled": progress["filled"], "since": progress["filled"]}
        status = beginning.canvas.status
        status[status == 2] = 0
    return Growth(
        beginning.canvas,
        pool,
        matching,
        streams.key("choice"),
        streams.key("order"),
        guesses=guesses,
        settings=settings,
        **progress,
    )


def full_state(growth: Growth, exemplar: ImageInput, given: FloatImage | None) -> dict[str, NDArray[Any]]:
    """Return the arrays from which :func:`begin` goes on: the growth's own, its exemplar and the given pixels."""
    return dict(growth.state()) | {
        "exemplar": np.frombuffer(bytes.fromhex(exemplar.sha256), np.uint8).copy(),
        "given": np.empty(0, np.float32) if given is None else given.copy(),
    }


def _from_state(state: ArraysInput, size: tuple[int, int], anchor: Place) -> Generator[None, None, Beginning]:
    arrays = state.arrays
    channels, height, width = arrays["values"].shape
    canvas = empty_canvas(channels, size)
    place = placed((height, width), size, anchor)
    given = np.zeros((*size, channels), np.float32) if arrays["given"].size else None
    for rows in row_blocks((height, width), _PIXELS_AT_ONCE):
        for name, target in canvas._asdict().items():
            target[..., *place][..., rows, :] = arrays[name][..., rows, :]
        if given is not None:
            given[place][rows] = arrays["given"][rows]
        yield
    position, filled, filled_before_layer, row, started, since = (int(number) for number in arrays["numbers"])
    if size != (height, width):
        canvas.status[canvas.status == 2] = 0
        return Beginning(canvas, given, {"filled": filled, "since": filled})
    queue = np.array(arrays["queue"], np.int32)
    # Exactly what waits in the queue is marked: a layer that was being collected is collected again.
    status = canvas.status.reshape(-1)
    status[status == 2] = 0
    waiting = queue[status[queue] != 1]
    status[waiting] = 2
    progress = {
        "queue": queue,
        "position": position,
        "filled": filled,
        "since": since,
        "filled_before_layer": filled_before_layer,
        "row": row,
        "started": bool(started),
        "layer_best": float(arrays["levels"][0]),
        "limit": float(arrays["levels"][1]),
        "settings": arrays["settings"].tobytes(),
    }
    return Beginning(canvas, given, progress)


def _from_image(inputs: Inputs, size: tuple[int, int], anchor: Place) -> Generator[None, None, Beginning]:
    exemplar = exemplar_of(inputs)
    start, mask = image_of(inputs, "start"), hole_image(inputs)
    image = exemplar if start is None else start
    height, width = image.size
    canvas = empty_canvas(exemplar.channels, size)
    place = placed(image.size, size, anchor)
    # Every given pixel of the exemplar is its own source; others are kept as they are.
    own = image.sha256 == exemplar.sha256
    given = None if own else np.zeros((*size, exemplar.channels), np.float32)
    for rows in row_blocks((height, width), _PIXELS_AT_ONCE):
        pixels = np.broadcast_to(image.pixels[rows], (rows.stop - rows.start, width, exemplar.channels))
        known = np.ones(pixels.shape[:2], bool)
        if mask is not None:
            known = mask.pixels[rows].max(axis=2) == 0
        canvas.values[:, *place][:, rows] = to_bytes(pixels) * known
        canvas.status[place][rows] = known
        if given is None:
            sources = np.arange(rows.start * width + 1, rows.stop * width + 1, dtype=np.int32)
            canvas.source[place][rows] = sources.reshape(-1, width) * known
        else:
            given[place][rows] = pixels * known[..., None]
        yield
    return Beginning(canvas, given, {})


def _from_seed(
    inputs: Inputs, matching: Matching, size: tuple[int, int], random: np.random.Generator, seed_patch: int
) -> Beginning:
    exemplar = exemplar_of(inputs)
    height, width = exemplar.size
    region = region_of(inputs)
    allowed = np.ones((height, width), bool) if region is None else region
    side = min(seed_patch, height, width, *size)
    while not (corners := _patch_corners(allowed, side)).any():
        side -= 1
    rows, columns = np.nonzero(corners)
    chosen = int(random.integers(len(rows)))
    source_rows, source_columns = np.mgrid[
        rows[chosen] : rows[chosen] + side, columns[chosen] : columns[chosen] + side
    ]
    place = placed((side, side), size, "top-left" if matching.causal else "center")
    canvas = empty_canvas(exemplar.channels, size)
    canvas.values[:, *place] = to_bytes(exemplar.pixels[source_rows, source_columns])
    canvas.status[place] = 1
    canvas.source[place] = source_rows * width + source_columns + 1
    return Beginning(canvas, None, {})


def _patch_corners(allowed: NDArray[np.bool_], side: int) -> NDArray[np.bool_]:
    """Return where the top left pixel of a patch of allowed pixels may be."""
    sums = np.pad(allowed.astype(np.int64), ((1, 0), (1, 0))).cumsum(axis=0).cumsum(axis=1)
    counts = sums[side:, side:] - sums[:-side, side:] - sums[side:, :-side] + sums[:-side, :-side]
    inside: NDArray[np.bool_] = counts == side * side
    return inside


def placed(inner: tuple[int, int], outer: tuple[int, int], anchor: Place) -> tuple[slice, slice]:
    """Return the rows and columns that an image of size ``inner`` takes at ``anchor`` of ``outer``."""
    free = outer[0] - inner[0], outer[1] - inner[1]
    if isinstance(anchor, tuple):
        return slice(anchor[0], anchor[0] + inner[0]), slice(anchor[1], anchor[1] + inner[1])
    top = 0 if "top" in anchor else free[0] if "bottom" in anchor else free[0] // 2
    left = 0 if "left" in anchor else free[1] if "right" in anchor else free[1] // 2
    return slice(top, top + inner[0]), slice(left, left + inner[1])


def image_of(inputs: Inputs, name: str) -> ImageInput | None:
    """Return the image input of this name, if it is given."""
    given = inputs.get(name)
    return given if isinstance(given, ImageInput) else None


def marked_in(mask: ImageInput) -> NDArray[np.bool_]:
    """Return what is not black in a mask, (H, W) bool."""
    marked: NDArray[np.bool_] = mask.pixels.max(axis=2) > 0
    return marked
