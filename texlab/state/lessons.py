"""What the steps of a lesson make of the session, and a session of a step: pure functions."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from texlab.state.chosen import Column, Sample, State
from texlab_core.documents.lesson_parts import Drawing, LessonError, Place, StepColumn, Tab, Taken
from texlab_core.documents.lessons import LessonStep
from texlab_core.engine.inputs import ImageInput

if TYPE_CHECKING:
    from collections.abc import Mapping

    from texlab_core.engine.inputs import Input


@dataclass(frozen=True, eq=False)
class StepPictures:
    """The pictures of a step, read: its sample, the exemplar as methods get it, further inputs of each column."""

    sample: Sample | None = None
    exemplar: ImageInput | None = None
    inputs: tuple[tuple[tuple[str, Input], ...], ...] = ()


def state_of(step: LessonStep, pictures: StepPictures, before: State, first_id: int) -> State:
    """Return the session that a step shows.

    Parameters
    ----------
    step, pictures
        The step, and its pictures.
    before
        The session before it: a step without an exemplar keeps what is there.
    first_id
        Id of the first column; columns at the same place keep theirs from step to step.
    """
    columns = tuple(
        Column(first_id + place, each.method, each.params(), inputs, each.size, each.title, seed=each.seed)
        for place, (each, inputs) in enumerate(zip(step.columns, pictures.inputs, strict=True))
    )
    sample = pictures.sample or before.sample
    return State(sample, columns, step.seed, step.size, max(before.next_id, first_id + len(columns)))


@dataclass(frozen=True, eq=False)
class Draft:
    """What the window shows now, to be kept as a step.

    Parameters
    ----------
    state, selected_id
        Of the session.
    pixel
        Column id, row and column of the pixel that is kept.
    tab, settings
        Name of the tab in front, and how its controls stand.
    tile
        Results are shown 2 x 2.
    drawing
        Of the step that was shown before; kept with it.
    """

    state: State
    selected_id: int = 0
    pixel: tuple[int, int, int] | None = None
    tab: str = ""
    settings: Mapping[str, Any] = field(default_factory=dict)
    tile: bool = False
    drawing: Drawing | None = None


def step_of(draft: Draft, sentence: str, file: str) -> LessonStep:
    """Return the step that shows what the window shows now.

    Parameters
    ----------
    draft
        What it shows.
    sentence
        Its large sentence.
    file
        Name of the exemplar's file beside the lesson, where it is none of the gallery's.

    Raises
    ------
    LessonError
        When a column works on what a lesson cannot hold.
    """
    state = draft.state
    if state.sample is None:
        raise LessonError("There is no exemplar yet, so there is no step to keep.")
    places = [column.id for column in state.columns]
    sample = state.sample
    # Any other transparency has become part of the picture that is kept.
    alpha = "white" if sample.source.alpha is None else "keep"
    taken = Taken(source_of(sample.source, file), sample.crop, sample.scale, sample.used_levels, alpha)
    pixel = None
    if draft.pixel is not None and draft.pixel[0] in places:
        pixel = Place(places.index(draft.pixel[0]), *draft.pixel[1:])
    from texlab_core.documents.lesson_parts import Shown

    return LessonStep(
        sentence=sentence,
        exemplar=taken,
        size=state.size,
        seed=state.seed,
        columns=tuple(_column(each) for each in state.columns),
        chosen=places.index(draft.selected_id) if draft.selected_id in places else 0,
        tab=Tab(draft.tab, draft.settings) if draft.tab else None,
        pixel=pixel,
        view=Shown(tile=draft.tile),
    )


def source_of(image: ImageInput, file: str) -> str:
    """Return a texture of the gallery by its name, any other picture by the file beside the lesson."""
    return image.name if image.name.startswith("gallery:") else file


def file_of(image: ImageInput) -> str:
    """Return the name of the file in which a picture is kept beside a lesson."""
    return f"{image.sha256[:16]}{'' if image.alpha is None else '-alpha'}.png"


def _column(column: Column) -> StepColumn:
    inputs = {}
    for name, each in column.inputs:
        if not isinstance(each, ImageInput) or not each.name.startswith("gallery:"):
            raise LessonError(
                f"The input {name} of {column.method} is no texture of the gallery; a step holds no other."
            )
        origin = each.origin
        inputs[name] = Taken(
            each.name,
            None if origin is None else origin.crop,
            1.0 if origin is None else origin.scale,
            None if origin is None else origin.levels,
        )
    return StepColumn.from_json(
        {
            "method": column.method,
            "parameters": column.params.to_json(),
            "inputs": {name: taken.to_json() for name, taken in inputs.items()},
            "title": column.name,
            **({} if column.size is None else {"size": _size(column.size)}),
            **({} if column.seed is None else {"seed": column.seed}),
        }
    )


def _size(size: tuple[int, ...]) -> dict[str, int]:
    from texlab_core.engine.sizes import size_to_json

    return size_to_json(size)
