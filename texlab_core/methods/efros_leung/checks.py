"""What cannot work, said before growth begins."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.engine.inputs import ArraysInput, ImageInput, Inputs, exemplar_of
from texlab_core.errors import InputError, ParamError
from texlab_core.methods.efros_leung.candidates import may_be_copied, whole_windows
from texlab_core.methods.efros_leung.fill import hole_image, hole_of, image_of, marked_in, region_of
from texlab_core.methods.efros_leung.patches import check_patches

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from texlab_core.methods.efros_leung.fill import Place
    from texlab_core.methods.efros_leung.windows import Matching

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


def check_inputs(
    inputs: Inputs, matching: Matching, size: tuple[int, int], anchor: Place = "center", *, by_parts: bool = False
) -> None:
    """Refuse what cannot work; whether enough is left to copy from is seen part by part where ``by_parts``.

    Raises
    ------
    InputError
        For a mask or region of the wrong size, an empty or all-covering mask, an output smaller than the image to
        start from, a window that fits nowhere, or a state of something else.
    """
    exemplar = exemplar_of(inputs)
    height, width = exemplar.size
    _check_window(exemplar, matching)
    region = region_of(inputs)
    if region is not None and not region.any():
        raise InputError("region: marks no pixel that may be copied.")
    if "mask" in inputs and "blend" in inputs:
        raise InputError("mask, blend: both say what is filled; give one of them.")
    if "patches" in inputs and not by_parts:
        raise InputError("patches: are laid over a picture that is filled part by part; set reach above 0.")
    _check_start(inputs, size, anchor)
    earlier = inputs.get("patches")
    if isinstance(earlier, ArraysInput):
        picture = image_of(inputs, "start") or exemplar
        check_patches(earlier, picture.size, exemplar.channels)
    if by_parts:
        return
    allowed = may_be_copied((height, width), matching, region, hole_of(inputs))
    if whole_windows(allowed, matching) == 0:
        names = " and ".join(name for name in ("mask", "blend", "region") if name in inputs)
        raise InputError(
            f"{names}: no whole window of {matching.window} x {matching.window} pixels is left to copy from; "
            "use a smaller window or leave more of the exemplar."
        )
    state = inputs.get("state")
    if isinstance(state, ArraysInput):
        _check_state(state, exemplar, size, anchor)


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


def _check_start(inputs: Inputs, size: tuple[int, int], anchor: Place) -> None:
    start, mask = image_of(inputs, "start"), hole_image(inputs)
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
    _check_place(name, image.size, size, anchor)
    if mask is None:
        if size == image.size:
            raise InputError("There is nothing to fill: give a mask, or a size larger than the start image.")
        return
    role = "mask" if "mask" in inputs else "blend"
    if mask.size != image.size:
        raise InputError(
            f"{role}: must have the size of the {name}, {width} x {height} pixels, "
            f"got {mask.size[1]} x {mask.size[0]}."
        )
    marked = marked_in(mask)
    if marked.all():
        raise InputError(f"{role}: covers the whole image, so that nothing is left to grow from.")
    if not marked.any() and size == image.size:
        raise InputError(f"{role}: marks no pixel, so that there is nothing to fill.")


def _check_place(name: str, inner: tuple[int, int], outer: tuple[int, int], anchor: Place) -> None:
    if isinstance(anchor, tuple) and any(a + b > c for a, b, c in zip(anchor, inner, outer, strict=True)):
        raise InputError(
            f"left, top: the {name} of {inner[1]} x {inner[0]} pixels must lie inside the output of {outer[1]} x "
            f"{outer[0]}, got left {anchor[1]}, top {anchor[0]}."
        )


def _check_state(state: ArraysInput, exemplar: ImageInput, size: tuple[int, int], anchor: Place) -> None:
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
    _check_place("state", (height, width), size, anchor)
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
