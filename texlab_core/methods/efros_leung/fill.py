"""Where growth begins: a seed patch, an image with holes or to grow outward, or an earlier state."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from texlab_core.engine.inputs import ArraysInput, ImageInput, Inputs, exemplar_of
from texlab_core.errors import InputError, ParamError
from texlab_core.methods.efros_leung.candidates import may_be_copied, to_bytes, whole_windows
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
    "center", "top-left", "top", "top-right", "left", "right", "bottom-left", "bottom", "bottom-right"
]
_PIXELS_AT_ONCE = 2**16
_STATE = (
    "values",
    "status",
    "source",
    "order",
    "matches",
    "d_min",
    "given",
    "queue",
    "numbers",
    "levels",
    "settings",
)


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


def check_inputs(inputs: Inputs, matching: Matching, size: tuple[int, int]) -> None:
    """Refuse what cannot work.

    Raises
    ------
    InputError
        For a mask or region of the wrong size, an empty or all-covering mask, an output smaller than the image to
        start from, a window that fits nowhere, or a state of something else.
    """
    exemplar = exemplar_of(inputs)
    height, width = exemplar.size
    _check_window(exemplar, matching)
    region = _region(inputs)
    if region is not None and not region.any():
        raise InputError("region: marks no pixel that may be copied.")
    _check_start(inputs, size)
    allowed = may_be_copied((height, width), matching, region, hole_of(inputs))
    if whole_windows(allowed, matching) == 0:
        names = " and ".join(name for name in ("mask", "region") if name in inputs)
        raise InputError(
            f"{names}: no whole window of {matching.window} x {matching.window} pixels is left to copy from; "
            "use a smaller window or leave more of the exemplar."
        )
    state = inputs.get("state")
    if isinstance(state, ArraysInput):
        _check_state(state, exemplar, size)


def _check_window(exemplar: ImageInput, matching: Matching) -> None:
    height, width = exemplar.size
    # A causal window needs only the rows above.
    largest = min(2 * height - 1 if matching.causal else height, width)
    largest -= 1 - largest % 2
    if matching.border == "periodic" or matching.window <= largest:
        return
    if largest < 3:
        raise InputError(
            f"The exemplar needs at least 3 x 3 pixels for windows inside of it, got {width} x {height}."
        )
    raise ParamError(
        "window", f"at most {largest} inside an exemplar of {width} x {height} pixels", matching.window
    )


def _check_start(inputs: Inputs, size: tuple[int, int]) -> None:
    start, mask = _image(inputs, "start"), _image(inputs, "mask")
    exemplar = exemplar_of(inputs)
    if start is not None and start.channels == 3 and exemplar.channels == 1:
        raise InputError(
            f"The start image {start.name} is in colour, and the exemplar {exemplar.name} is gray; choose a gray "
            "start image or an exemplar in colour."
        )
    if start is None and mask is None:
        return
    image, name = (exemplar, "exemplar") if start is None else (start, "start image")
    height, width = image.size
    if size[0] < height or size[1] < width:
        raise _too_small(name, image.size, size)
    if mask is None:
        if size == image.size:
            raise InputError("There is nothing to fill: give a mask, or a size larger than the start image.")
        return
    if mask.size != image.size:
        raise InputError(
            f"mask: must have the size of the {name}, {width} x {height} pixels, "
            f"got {mask.size[1]} x {mask.size[0]}."
        )
    marked = _marked(mask)
    if marked.all():
        raise InputError("mask: covers the whole image, so that nothing is left to grow from.")
    if not marked.any() and size == image.size:
        raise InputError("mask: marks no pixel, so that there is nothing to fill.")


def _check_state(state: ArraysInput, exemplar: ImageInput, size: tuple[int, int]) -> None:
    arrays = state.arrays
    if any(name not in arrays for name in (*_STATE, "exemplar")) or arrays["status"].ndim != 2:
        raise InputError(f"state: {state.name} is not the state of a growing image.")
    if arrays["exemplar"].tobytes() != bytes.fromhex(exemplar.sha256):
        raise InputError(f"state: {state.name} belongs to another exemplar.")
    height, width = arrays["status"].shape
    shapes_fit = (
        arrays["values"].shape == (exemplar.channels, height, width)
        and all(arrays[name].shape == (height, width) for name in ("source", "order", "matches", "d_min"))
        and arrays["given"].shape in ((height, width, exemplar.channels), (0,))
        and arrays["numbers"].shape == (6,)
        and arrays["levels"].shape == (2,)
        and arrays["queue"].ndim == 1
    )
    if not shapes_fit or not (arrays["status"] == 1).any():
        raise InputError(f"state: {state.name} is damaged.")
    if size[0] < height or size[1] < width:
        raise _too_small("state", (height, width), size)
    if not _state_is_sound(arrays, exemplar.size):
        raise InputError(f"state: {state.name} is damaged.")


def _too_small(name: str, least: tuple[int, int], size: tuple[int, int]) -> InputError:
    return InputError(
        f"size: must be at least that of the {name}, {least[1]} x {least[0]} pixels, got {size[1]} x {size[0]}."
    )


def _state_is_sound(arrays: Mapping[str, NDArray[Any]], exemplar: tuple[int, int]) -> bool:
    """Return whether all numbers are in range: kernels do not check what they index."""
    source, queue, numbers = arrays["source"], arrays["queue"], arrays["numbers"]
    height, width = source.shape
    whole = all(np.issubdtype(each.dtype, np.integer) for each in (source, queue, numbers, arrays["order"]))
    return bool(
        whole
        and source.min() >= 0
        and source.max() <= exemplar[0] * exemplar[1]
        and (queue.size == 0 or (queue.min() >= 0 and queue.max() < height * width))
        and 0 <= numbers[0] <= queue.size
        and numbers.min() >= 0
        and numbers[3] <= height
        and not np.isnan(arrays["levels"]).any()
    )


def hole_of(inputs: Inputs) -> NDArray[np.bool_] | None:
    """Return where the exemplar itself is to be filled, (H, W) bool: no window that touches it is a candidate."""
    mask, start = _image(inputs, "mask"), _image(inputs, "start")
    if mask is None or (start is not None and start.sha256 != exemplar_of(inputs).sha256):
        return None
    return _marked(mask)


def _region(inputs: Inputs) -> NDArray[np.bool_] | None:
    region = _image(inputs, "region")
    if region is None:
        return None
    height, width = exemplar_of(inputs).size
    if region.size != (height, width):
        raise InputError(
            f"region: must have the size of the exemplar, {width} x {height} pixels, "
            f"got {region.size[1]} x {region.size[0]}."
        )
    return _marked(region)


def allowed_centres(inputs: Inputs, matching: Matching) -> NDArray[np.bool_]:
    """Return where in the exemplar the centre of a candidate may be, (H, W) bool."""
    return may_be_copied(exemplar_of(inputs).size, matching, _region(inputs), hole_of(inputs))


def begin(
    inputs: Inputs, matching: Matching, size: tuple[int, int], streams: Streams, *, seed_patch: int, anchor: Anchor
) -> Generator[None, None, Beginning]:
    """Lay out what is known at the start; yields between portions of large images.

    A ``state`` counts most; then ``start`` (the exemplar when there is only a ``mask``) but what the mask marks;
    otherwise a patch of ``seed_patch`` x ``seed_patch`` pixels from a random place of the exemplar is put in the
    middle (top left for a causal window). What is smaller than ``size`` is placed at ``anchor``.
    """
    state = inputs.get("state")
    if isinstance(state, ArraysInput):
        return (yield from _from_state(state, size, anchor))
    if "start" in inputs or "mask" in inputs:
        return (yield from _from_image(inputs, size, anchor))
    return _from_seed(inputs, matching, size, streams("seed patch"), seed_patch)


def settings_digest(inputs: Inputs, matching: Matching, size: tuple[int, int], streams: Streams) -> bytes:
    """Identify everything that the way of growing depends on, the beginning apart."""
    hashes = [
        each.sha256 if (each := inputs.get(name)) is not None else "" for name in ("exemplar", "mask", "region")
    ]
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


def _from_state(state: ArraysInput, size: tuple[int, int], anchor: Anchor) -> Generator[None, None, Beginning]:
    arrays = state.arrays
    channels, height, width = arrays["values"].shape
    canvas = empty_canvas(channels, size)
    place = _placed((height, width), size, anchor)
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


def _from_image(inputs: Inputs, size: tuple[int, int], anchor: Anchor) -> Generator[None, None, Beginning]:
    exemplar = exemplar_of(inputs)
    start, mask = _image(inputs, "start"), _image(inputs, "mask")
    image = exemplar if start is None else start
    height, width = image.size
    canvas = empty_canvas(exemplar.channels, size)
    place = _placed(image.size, size, anchor)
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
    region = _region(inputs)
    allowed = np.ones((height, width), bool) if region is None else region
    side = min(seed_patch, height, width, *size)
    while not (corners := _patch_corners(allowed, side)).any():
        side -= 1
    rows, columns = np.nonzero(corners)
    chosen = int(random.integers(len(rows)))
    source_rows, source_columns = np.mgrid[
        rows[chosen] : rows[chosen] + side, columns[chosen] : columns[chosen] + side
    ]
    place = _placed((side, side), size, "top-left" if matching.causal else "center")
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


def _placed(inner: tuple[int, int], outer: tuple[int, int], anchor: Anchor) -> tuple[slice, slice]:
    """Return the rows and columns that an image of size ``inner`` takes at ``anchor`` of ``outer``."""
    free = outer[0] - inner[0], outer[1] - inner[1]
    top = 0 if "top" in anchor else free[0] if "bottom" in anchor else free[0] // 2
    left = 0 if "left" in anchor else free[1] if "right" in anchor else free[1] // 2
    return slice(top, top + inner[0]), slice(left, left + inner[1])


def _image(inputs: Inputs, name: str) -> ImageInput | None:
    given = inputs.get(name)
    return given if isinstance(given, ImageInput) else None


def _marked(mask: ImageInput) -> NDArray[np.bool_]:
    marked: NDArray[np.bool_] = mask.pixels.max(axis=2) > 0
    return marked
