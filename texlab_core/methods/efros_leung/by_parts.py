"""Filling part by part: the work and the search depend on the holes, and not on how large the picture is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from texlab_core.engine.inputs import ArraysInput, ImageInput, exemplar_of, hash_arrays
from texlab_core.engine.steps import Map, Output, Step
from texlab_core.engine.streams import Streams
from texlab_core.errors import InputError
from texlab_core.methods.efros_leung.candidates import make_pool, may_be_copied, to_bytes, whole_windows
from texlab_core.methods.efros_leung.evidence import UNITS, measuring
from texlab_core.methods.efros_leung.fill import (
    begin,
    hole_image,
    image_of,
    make_growth,
    placed,
    region_of,
    settings_digest,
)
from texlab_core.methods.efros_leung.parts import Box, dilated, parts_of, shifted, size_of
from texlab_core.methods.efros_leung.patches import patches_of
from texlab_core.work.tasks import relay, row_blocks, through

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import Input, Inputs
    from texlab_core.engine.steps import FloatImage
    from texlab_core.kernels.neighbourhood_types import Canvas
    from texlab_core.methods.efros_leung.fill import Place
    from texlab_core.methods.efros_leung.windows import Criterion, Matching

    MatchingOf = Callable[[ImageInput], Matching]

_PIXELS_AT_ONCE = 2**17


class PartStreams(Streams):
    """The random streams of one part: those of the job, by other names."""

    def __init__(self, streams: Streams, part: int) -> None:
        super().__init__(streams.seed)
        self._part = part

    def _digest(self, name: str, index: tuple[int, ...]) -> bytes:
        return super()._digest(f"{name} of part", (self._part, *index))


@dataclass(eq=False)
class Frame:
    """The output as it grows.

    Parameters
    ----------
    image
        (H, W, C) float32: the picture where it is known, zero elsewhere.
    unknown
        (H, W) bool.
    source, order, matches, d_min
        Maps of the result.
    place
        Where the picture lies in it.
    barred
        (h, w) bool, what of the picture must not be copied: it was or is to be replaced.
    own
        Whether the pixels are copied from the picture itself.
    """

    image: FloatImage
    unknown: NDArray[np.bool_]
    source: NDArray[np.int32]
    order: NDArray[np.float32]
    matches: NDArray[np.int32]
    d_min: NDArray[np.float32]
    place: Box
    barred: NDArray[np.bool_]
    own: bool
    filled: int = 0
    total: int = 0

    def step(self, stage: str, done: int = 0) -> Step:
        """Return where things stand, ``done`` pixels of the part at hand included."""
        return Step(min(self.filled + done, self.total), self.total, stage, preview=lambda: self.image)


def fill_by_parts(
    inputs: Inputs, matching_of: MatchingOf, size: tuple[int, int], streams: Streams, *, reach: int, anchor: Place
) -> Generator[Step, None, Output]:
    """Fill what is unknown, part after part, each from the surroundings of that part.

    Parameters
    ----------
    inputs
        ``exemplar``, and a ``start``, ``mask`` or ``blend``; ``patches`` are laid over the picture first.
    matching_of
        How windows are compared, for an image that is copied from.
    size
        Height and width of the output.
    streams
        Of the job; every part has streams of its own.
    reach
        Pixels around a part from which is copied, at least the window; more where that leaves no whole window.
    anchor
        Where the picture lies in the output.

    Raises
    ------
    InputError
        When nothing is left to copy from.
    """
    frame = yield from _laid_out(inputs, size, anchor)
    frame.total = int(np.count_nonzero(frame.unknown))
    boxes = yield from relay(parts_of(frame.unknown), lambda _: frame.step("dividing"))
    # Window and criterion alone: the spread of a whole picture, which tau goes by, would hold up a stop.
    whole = exemplar_of(inputs)
    first = matching_of(_image_input(whole.pixels[:1, :1], whole.name))
    matching_of = _once_each(matching_of)
    reach, criterion = max(reach, first.window), first.criterion
    searched = 0
    for number, box in enumerate(boxes):
        stage = "growing" if len(boxes) == 1 else f"growing part {number + 1} of {len(boxes)}"
        searched += yield from _fill_part(
            inputs, matching_of, frame, box, PartStreams(streams, number), reach, stage
        )
    return (yield from _output(frame, criterion, boxes, searched))


def _once_each(matching_of: MatchingOf) -> MatchingOf:
    """Return a function that looks at each exemplar once: many parts may be copied from the same one."""
    found: dict[str, Matching] = {}

    def known(exemplar: ImageInput) -> Matching:
        if exemplar.sha256 not in found:
            found[exemplar.sha256] = matching_of(exemplar)
        return found[exemplar.sha256]

    return known


def _laid_out(inputs: Inputs, size: tuple[int, int], anchor: Place) -> Generator[Step, None, Frame]:
    exemplar = exemplar_of(inputs)
    picture = image_of(inputs, "start") or exemplar
    channels = exemplar.channels
    hole = hole_image(inputs)
    height, width = picture.size
    place = placed(picture.size, size, anchor)
    frame = Frame(
        image=np.zeros((*size, channels), np.float32),
        unknown=np.ones(size, bool),
        source=np.empty((*size, 2), np.int32),
        order=np.zeros(size, np.float32),
        matches=np.zeros(size, np.int32),
        d_min=np.zeros(size, np.float32),
        place=place,
        barred=np.zeros((height, width), bool),
        own=picture.sha256 == exemplar.sha256,
    )
    step = Step(0, 1, "laying out what is known", preview=lambda: frame.image)
    for rows in row_blocks(size, _PIXELS_AT_ONCE):
        frame.source[rows] = -1
        yield step
    columns = np.arange(width, dtype=np.int32)
    for rows in row_blocks((height, width), _PIXELS_AT_ONCE):
        known = np.ones((rows.stop - rows.start, width), bool)
        if hole is not None:
            known = hole.pixels[rows].max(axis=2) == 0
        frame.barred[rows] = ~known
        frame.unknown[place][rows] = ~known
        frame.image[place][rows] = picture.pixels[rows] * known[..., None]
        if frame.own:
            source = frame.source[place][rows]
            source[..., 0] = np.where(known, np.arange(rows.start, rows.stop, dtype=np.int32)[:, None], -1)
            source[..., 1] = np.where(known, columns, -1)
        yield step
    earlier = inputs.get("patches")
    for box, marked, values in () if not isinstance(earlier, ArraysInput) else patches_of(earlier):
        frame.barred[box] |= marked
        laid = marked & ~frame.unknown[place][box]
        frame.image[place][box][laid] = np.broadcast_to(values, (*marked.shape, channels))[laid]
        frame.source[place][box][laid] = -1
        yield step
    return frame


def _fill_part(
    inputs: Inputs,
    matching_of: MatchingOf,
    frame: Frame,
    box: Box,
    streams: PartStreams,
    reach: int,
    stage: str,
) -> Generator[Step, None, int]:
    """Fill one part; returns how many candidates were searched, 0 when another part has filled it already."""
    wanted = frame.unknown[box].copy()
    if not wanted.any():
        return 0
    exemplar, corner, region = _surroundings(inputs, matching_of, frame, box, reach)
    matching = matching_of(exemplar)
    around = dilated(box, matching.window // 2, frame.unknown.shape)
    part: dict[str, Input] = {
        "exemplar": exemplar,
        "start": _image_input(frame.image[around], "the picture around a part"),
        "mask": _image_input(frame.unknown[around][..., None].astype(np.float32), "what is unknown"),
        "region": _image_input(region[..., None].astype(np.float32), "what may be copied"),
    }
    yield frame.step(stage)
    size = size_of(around)
    pool = make_pool(to_bytes(exemplar.pixels), region, matching)
    laying = begin(part, matching, size, streams, seed_patch=1, anchor="center")
    beginning = yield from through(laying, frame.step(stage))
    growth = make_growth(beginning, pool, matching, streams, settings_digest(part, matching, size, streams))
    shown = frame.image[box]
    inner = shifted(box, around)

    def preview() -> FloatImage:
        # What is under way stands in the picture itself: nobody looks at it between two steps.
        known = wanted & (growth.canvas.status[inner] == 1)
        shown[known] = np.moveaxis(growth.canvas.values[:, *inner], 0, 2)[known] / np.float32(255)
        return frame.image

    def told(step: Step) -> Step:
        made = frame.step(stage, step.done)
        return Step(made.done, made.total, stage, preview=preview)

    yield from relay(growth.run(), told)
    _take(frame, box, wanted, growth.canvas, inner, exemplar, corner)
    yield frame.step(stage)
    return whole_windows(region, matching)


def _take(
    frame: Frame,
    box: Box,
    wanted: NDArray[np.bool_],
    canvas: Canvas,
    inner: Box,
    exemplar: ImageInput,
    corner: tuple[int, int],
) -> None:
    """Take what was filled of a part, at the exemplar's full precision."""
    places = canvas.source[inner][wanted] - 1
    rows, columns = places // exemplar.size[1], places % exemplar.size[1]
    frame.image[box][wanted] = exemplar.pixels[rows, columns]
    frame.source[box][wanted] = np.stack([rows + corner[0], columns + corner[1]], axis=1)
    # The order within the part; what lies around the part was filled for its sake alone.
    order = canvas.order[inner][wanted]
    ranks = np.empty(order.size, np.float32)
    ranks[np.argsort(order, kind="stable")] = np.arange(1, order.size + 1)
    frame.order[box][wanted] = frame.filled + ranks
    frame.matches[box][wanted] = canvas.matches[inner][wanted]
    frame.d_min[box][wanted] = canvas.d_min[inner][wanted]
    frame.unknown[box] = False
    frame.filled += int(np.count_nonzero(wanted))


def _surroundings(
    inputs: Inputs, matching_of: MatchingOf, frame: Frame, box: Box, reach: int
) -> tuple[ImageInput, tuple[int, int], NDArray[np.bool_]]:
    """Return what a part is copied from, where that begins in the exemplar, and what of it may be copied."""
    exemplar, region = exemplar_of(inputs), region_of(inputs)
    whole = np.ones(exemplar.size, bool) if region is None else region
    if not frame.own:
        _check_left(whole, matching_of(exemplar))
        return exemplar, (0, 0), whole
    shift = frame.place[0].start, frame.place[1].start
    while True:
        near = _nearest(box, shift, exemplar.size, reach)
        pixels = exemplar.pixels[near]
        part = _image_input(pixels, exemplar.name)
        matching = matching_of(part)
        # Inside of this part: what lies around it is no exemplar, whatever the border's knob says.
        allowed = whole[near] & may_be_copied(size_of(near), matching, None, frame.barred[near])
        if whole_windows(allowed, matching) > 0:
            return part, (near[0].start, near[1].start), allowed
        if size_of(near) == exemplar.size:
            _check_left(allowed, matching)
        reach *= 2


def _check_left(allowed: NDArray[np.bool_], matching: Matching) -> None:
    if whole_windows(allowed, matching) == 0:
        raise InputError(
            f"No whole window of {matching.window} x {matching.window} pixels is left to copy from; use a smaller "
            "window or mark less."
        )


def _nearest(box: Box, shift: tuple[int, int], size: tuple[int, int], reach: int) -> Box:
    """Return the part of the picture within ``reach`` of a box of the output, which may lie beyond the picture."""
    rows, columns = (
        slice(
            min(max(each.start - by, 0), side - 1),
            min(max(each.stop - by, 1), side),
        )
        for each, by, side in zip(box, shift, size, strict=True)
    )
    return dilated((rows, columns), reach, size)


def _image_input(pixels: NDArray[np.float32], name: str) -> ImageInput:
    kept = np.ascontiguousarray(pixels)
    kept = kept.copy() if kept.base is not None or kept is pixels else kept
    kept.flags.writeable = False
    return ImageInput(kept, name, hash_arrays({"pixels": kept}))


def _output(frame: Frame, criterion: Criterion, boxes: list[Box], searched: int) -> Generator[Step, None, Output]:
    """Return the result with its maps; what is measured is what was filled."""
    step, unit = frame.step("measuring"), UNITS[criterion]
    bounds = _bounds(boxes)
    size = size_of(bounds)
    source = np.empty((*size, 2), np.int32)
    for rows in row_blocks(size, _PIXELS_AT_ONCE):
        source[rows] = np.where(frame.order[bounds][rows, :, None] > 0, frame.source[bounds][rows], -1)
        yield step
    labels = np.zeros(frame.unknown.shape, np.int32)
    labels[bounds], measures, curves = yield from measuring(
        source, frame.order[bounds], frame.d_min[bounds], unit, step
    )
    many = "" if len(boxes) == 1 else f" in {len(boxes)} parts"
    note = f"{frame.total:,} pixels were filled{many}, each from one of about {searched // len(boxes):,} places"
    return Output(
        image=frame.image,
        maps={
            "source": Map(frame.source, "source", "Where each pixel comes from"),
            "order": Map(frame.order, "scalar", "Order of filling", "pixels"),
            "matches": Map(frame.matches, "count", "Size of the match set", "pixels"),
            "distance": Map(frame.d_min, "scalar", "Smallest distance d_min", unit),
            "copied": Map(labels, "label", "Areas copied in one piece"),
        },
        curves=curves,
        measures=measures,
        notes=(f"{note}{' nearby' if frame.own else ''}.",),
    )


def _bounds(boxes: list[Box]) -> Box:
    return (
        slice(min(rows.start for rows, _ in boxes), max(rows.stop for rows, _ in boxes)),
        slice(min(columns.start for _, columns in boxes), max(columns.stop for _, columns in boxes)),
    )
