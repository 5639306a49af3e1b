"""What opening and choosing make of the session: pure functions."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from texlab.state.chosen import Column, Sample, State
from texlab_core.engine.params import describe
from texlab_core.methods.de_bonet.thresholds import ThresholdTable

if TYPE_CHECKING:
    from collections.abc import Mapping

    from texlab_core.engine.inputs import DataInput, ImageInput, Input
    from texlab_core.engine.job import Job
    from texlab_core.engine.params import Params
    from texlab_core.sheets.sweep import Cell

COMFORTABLE_SIDE = 256
SMALLEST_SIDE = 2


@dataclass(frozen=True, eq=False)
class Opened:
    """What a file turned out to be: an image, or a saved result with its job and its numbers by id."""

    image: ImageInput
    path: str | None
    job: Job | None = None
    measures: Mapping[str, float] = field(default_factory=dict)


def sample_of(image: ImageInput, path: str | None) -> Sample:
    """Return the sample for an image: a photograph is scaled to a comfortable size at first."""
    sample = sample_as_used(image, path)
    side = max(image.size)
    if sample.source is not image or side <= COMFORTABLE_SIDE:
        return sample
    return dataclasses.replace(sample, scale=round(COMFORTABLE_SIDE / side, 3))


def is_reduced(sample: Sample) -> bool:
    """Return whether a picture is shown smaller than it is, at the scale that the program chooses by itself."""
    return sample.scale < 1 and sample == dataclasses.replace(
        sample, scale=round(COMFORTABLE_SIDE / max(sample.source.size), 3)
    )


def reduced_words(sample: Sample) -> str:
    """Return what is said beside a picture that the program has reduced; empty for any other."""
    if not is_reduced(sample):
        return ""
    return f"shown at {100 * sample.scale:.3g} % so that it fits {COMFORTABLE_SIDE} px"


def part_words(sample: Sample, size: tuple[int, int]) -> str:
    """Return which part of a picture is used, whoever chose it; empty for all of it at its own size.

    Parameters
    ----------
    sample
        What is used.
    size
        Height and width of the scaled picture.
    """
    crop, said = sample.crop, []
    if crop is not None and (crop.height, crop.width) != size:
        said.append(f"at {crop.left}, {crop.top} of {size[1]} x {size[0]}")
    if sample.scale != 1 and not is_reduced(sample):
        height, width = sample.source.size
        said.append(f"{width} x {height} scaled to {100 * sample.scale:.3g} %")
    return ", ".join(said)


def levels_words(sample: Sample) -> str:
    """Return the levels and what they are for; empty without any."""
    if sample.levels is None:
        return ""
    return f"levels {sample.levels.words}" + (", for looking only" if sample.look_only else "")


def at_full_size(sample: Sample) -> Sample:
    """Return the other choice for a large picture: its middle, pixel by pixel, at most 256 x 256."""
    from texlab_core.engine.inputs import Crop

    height, width = sample.source.size
    rows, columns = min(height, COMFORTABLE_SIDE), min(width, COMFORTABLE_SIDE)
    crop = Crop((height - rows) // 2, (width - columns) // 2, rows, columns)
    return dataclasses.replace(sample, scale=1.0, crop=crop)


def as_a_whole(sample: Sample) -> Sample:
    """Return the first choice for a large picture: all of it, scaled to a comfortable size."""
    side = max(sample.source.size)
    return dataclasses.replace(sample, scale=round(min(1.0, COMFORTABLE_SIDE / side), 3), crop=None)


def sample_as_used(image: ImageInput, path: str | None = None) -> Sample:
    """Return the sample whose exemplar is this image, pixel by pixel."""
    origin = image.origin
    if origin is not None and (origin.scale != 1.0 or origin.crop is not None or origin.levels is not None):
        whole = dataclasses.replace(
            image,
            pixels=origin.pixels,
            sha256=image.sha256 + ":source",
            origin=None,
            notes=origin.notes,
            alpha=origin.alpha,
        )
        return Sample(whole, origin.scale, origin.crop, path, levels=origin.levels)
    return Sample(image, 1.0, None, path)


def fitting(sample: Sample) -> Sample:
    """Return the sample, without its crop and scale where the file has become too small for them."""
    from texlab_core.images.exemplar import scaled_size

    height, width = scaled_size(*sample.source.size, sample.scale)
    if min(height, width) < SMALLEST_SIDE:
        return dataclasses.replace(sample, scale=1.0, crop=None)
    crop = sample.crop
    if crop is None or (
        min(crop.top, crop.left) >= 0
        and min(crop.height, crop.width) >= SMALLEST_SIDE
        and crop.top + crop.height <= height
        and crop.left + crop.width <= width
    ):
        return sample
    return dataclasses.replace(sample, crop=None)


def with_crop_of(sample: Sample, before: Sample | None) -> Sample:
    """Keep the crop from one texture of the gallery to the next, so that they can be compared."""
    if before is None or before.crop is None or before.scale != sample.scale:
        return sample
    crop, (height, width) = before.crop, sample.source.size
    both = all(each.source.name.startswith("gallery:") for each in (before, sample))
    fits = crop.top + crop.height <= height and crop.left + crop.width <= width
    return dataclasses.replace(sample, crop=crop) if both and fits else sample


def restored(state: State, opened: Opened) -> tuple[State, int]:
    """Return the state in which a saved result's job runs, and the id of its column.

    The first column with the same method takes the parameters; without one, a column is added.
    """
    job = opened.job
    assert job is not None
    extra = _further(job)
    # A solid's size is its column's own; all other columns go on making pictures of theirs.
    size, own = (job.picture_size, None) if len(job.size) == 2 else (state.size, job.size)
    state = dataclasses.replace(state, sample=sample_as_used(opened.image), seed=job.seed, size=size)
    for column in state.columns:
        if column.method == job.method:
            changed = dataclasses.replace(column, params=job.params, inputs=extra, size=own)
            return state.with_column(changed), column.id
    added = Column(state.next_id, job.method, job.params, extra, own)
    return dataclasses.replace(state, columns=(*state.columns, added), next_id=state.next_id + 1), added.id


def with_method(state: State, method: str) -> State:
    """Return a state that has a column of a method, with its defaults if it is added."""
    from texlab_core.engine.registry import find_method

    if any(column.method == method for column in state.columns):
        return state
    added = Column(state.next_id, method, find_method(method).params())
    return dataclasses.replace(state, columns=(*state.columns, added), next_id=state.next_id + 1)


def fresh_ids(state: State, first: int) -> State:
    """Return a state whose columns have ids from ``first``: an id is never used again within a session."""
    columns = tuple(dataclasses.replace(column, id=number) for number, column in enumerate(state.columns, first))
    return dataclasses.replace(state, columns=columns, next_id=first + len(columns))


def with_code(state: State, code: DataInput, chosen: int) -> tuple[State, int]:
    """Return the state in which MSG works from a code, and the id of its column.

    The chosen column takes it, or the first one of MSG; without one, a column is added.
    """
    from texlab_core.engine.registry import find_method

    inputs = (("code", code),)
    for column in sorted(state.columns, key=lambda column: column.id != chosen):
        if column.method == "msg":
            return state.with_column(dataclasses.replace(column, inputs=inputs)), column.id
    added = Column(state.next_id, "msg", find_method("msg").params(), inputs)
    return dataclasses.replace(state, columns=(*state.columns, added), next_id=state.next_id + 1), added.id


def rescaled(sample: Sample, scale: float) -> Sample:
    """Return the sample at another scale with its crop over the same part of the picture."""
    from texlab_core.engine.inputs import Crop
    from texlab_core.images.exemplar import scaled_size

    crop = sample.crop
    if crop is not None:
        factor = scale / sample.scale
        height, width = scaled_size(*sample.source.size, scale)
        rows = min(max(round(crop.height * factor), 2), height)
        columns = min(max(round(crop.width * factor), 2), width)
        top = min(round(crop.top * factor), height - rows)
        left = min(round(crop.left * factor), width - columns)
        crop = Crop(top, left, rows, columns)
    return dataclasses.replace(sample, scale=scale, crop=crop)


def with_cell_column(state: State, cell: Cell, after: int) -> tuple[State, int]:
    """Return the state with a new column that has what made a cell (all but the size), and its id.

    It stands behind the column with the id ``after``, or at the end. The exemplar changes where the cell is of
    another texture; nothing else is changed.
    """
    job, state = cell.job, _with_texture_of(state, cell)
    seed = None if job.seed == state.seed else job.seed
    column = Column(state.next_id, job.method, job.params, _further(job), seed=seed)
    places = [each.id for each in state.columns]
    place = places.index(after) + 1 if after in places else len(places)
    # Behind all that are pinned.
    place = max(place, sum(each.pinned for each in state.columns))
    columns = (*state.columns[:place], column, *state.columns[place:])
    return dataclasses.replace(state, columns=columns, next_id=state.next_id + 1), column.id


def cell_alone(state: State, cell: Cell) -> State:
    """Return a state with nothing but a cell's texture and a column with what made it, all but the size."""
    from texlab_core.engine.inputs import ImageInput

    job = cell.job
    texture = job.inputs["exemplar"]
    assert isinstance(texture, ImageInput)
    column = Column(1, job.method, job.params, _further(job))
    return State(sample_as_used(texture), (column,), job.seed, state.size, 2)


def _further(job: Job) -> tuple[tuple[str, Input], ...]:
    """Return a job's inputs besides the exemplar, as a column has them."""
    return tuple((name, each) for name, each in job.inputs.items() if name != "exemplar")


def _with_texture_of(state: State, cell: Cell) -> State:
    """Return the state with the exemplar of a cell of a grid over many textures."""
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.sheets.sweep import TEXTURE

    texture = cell.job.inputs.get("exemplar")
    if TEXTURE not in cell.values or not isinstance(texture, ImageInput):
        return state
    return dataclasses.replace(state, sample=sample_as_used(texture))


def by_hand(params: Params) -> int:
    """Return how many cells of threshold tables were set by hand in some parameters."""
    tables = (getattr(params, each.name) for each in describe(type(params)) if each.type is ThresholdTable)
    return sum(len(table.cells) for table in tables)


def with_cell(state: State, cell: Cell, wanted: tuple[int, ...]) -> tuple[State, int] | None:
    """Return the state in which a column has a cell's parameters (and its seed or texture, where that is varied).

    Parameters
    ----------
    state
        The present state.
    cell
        What was clicked.
    wanted
        Ids of columns by preference; the first with the cell's method takes the parameters, then any other.

    Returns
    -------
    State and id of the column, or None when no column runs the method.
    """
    columns = [column for column in map(state.column, wanted) if column is not None]
    for column in (*columns, *state.columns):
        if column.method == cell.job.method:
            state = _with_texture_of(state, cell)
            changed = state.with_column(dataclasses.replace(column, params=cell.job.params))
            if "seed" not in cell.values:
                return changed, column.id
            if column.seed is None:
                return dataclasses.replace(changed, seed=cell.job.seed), column.id
            own = dataclasses.replace(column, params=cell.job.params, seed=cell.job.seed)
            return state.with_column(own), column.id
    return None
