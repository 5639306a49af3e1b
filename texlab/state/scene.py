"""The frozen picture of session and results that the docks look at."""

from __future__ import annotations

import operator
from dataclasses import dataclass, field, fields
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from texlab.state.filling import NO_FILL, FillScene
from texlab.state.history import NO_HISTORY, History
from texlab.state.lesson_scene import NO_LESSON, LessonScene
from texlab.state.sweeps import NO_SWEEP, SweepScene
from texlab.state.tuning import NO_TUNING, TuningScene

if TYPE_CHECKING:
    from collections.abc import Hashable, Mapping, Sequence

    from numpy.typing import NDArray

    from texlab.state.sweeps import ShownCell
    from texlab.style.pictures import Picture
    from texlab_core.engine.inputs import ImageInput, Input
    from texlab_core.engine.params import Params
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage
    from texlab_core.findings.finding import Finding

Status = Literal["idle", "waiting", "running", "finished", "cancelled", "failed"]


@dataclass(frozen=True, eq=False)
class Frame:
    """One kept stage of a run ("iteration 3"), as (H, W, 3) uint8."""

    name: str
    picture: Picture

    def values(self, channels: int) -> FloatImage:
        """Return (H, W, ``channels``) float32 in [0, 1]: always the same array, made when first wanted."""
        return self._gray if channels == 1 else self._colour

    @cached_property
    def _colour(self) -> FloatImage:
        return np.multiply(self.picture, np.float32(1 / 255), dtype=np.float32)

    @cached_property
    def _gray(self) -> FloatImage:
        return np.multiply(self.picture[..., :1], np.float32(1 / 255), dtype=np.float32)


@dataclass(frozen=True, eq=False)
class Past:
    """A finished result of a column, small, with what makes it again.

    Parameters
    ----------
    key
        Of its job: what has the same key has the same bits.
    exemplar
        Hash of the exemplar.
    method, params, inputs, size, seed
        What it was made with, besides the exemplar.
    thumbnail
        At most 64 pixels wide and high, (h, w, 3) uint8.
    measures
        Numbers about it by id; empty until it has been measured.
    """

    key: Hashable
    exemplar: str
    method: str
    params: Params
    inputs: tuple[tuple[str, Input], ...]
    size: tuple[int, ...]
    seed: int
    thumbnail: Picture
    measures: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class ColumnScene:
    """What a column shows.

    Parameters
    ----------
    id, method, title, params
        What the user chose.
    status
        idle, waiting (for a core), running, finished, cancelled or failed.
    message
        One line for people: the stage, or why it failed.
    fraction
        Progress from 0 to 1 of the phase under way.
    picture
        What is painted, (H, W, 3) uint8.
    image
        The same as values, (H, W, C) float32 in [0, 1]; a preview while the run goes on.
    filled
        Which pixels of a preview have their value already, (H, W) bool; None when all have.
    result
        The finished result, or None while there is none for the present parameters. While a control is dragged it
        is the newest there is; ``result.job`` tells what it was made with.
    stored
        The result comes from the disk, without what explains it; a run makes that again.
    draft
        The picture is a quick one, made while a control is dragged.
    frames
        Stages kept for the scrubber, in order.
    metrics
        The newest numbers of the run.
    measures
        Numbers about the picture by id, of the registry of measures; those of a control that is dragged may be
        about the picture before.
    findings
        What is wrong with the finished picture; None until that was looked into.
    unexamined
        Why that cannot be looked into, or some of it, one sentence; empty where it is, or will be.
    measured_size
        Height and width of the picture that they are about.
    elapsed_s
        Wall time of the run.
    resumable
        A stopped or finished run can be gone on with, also at a larger size.
    inputs
        What the column works on besides the exemplar (a code of 69 numbers, say).
    size
        Height and width of its full result, or depth, height and width; empty before the first run.
    name
        What the user called it; "" leaves that to what differs from other columns.
    pinned
        It stays in front.
    seed
        Its own; None is that of all columns.
    history
        Its finished results, the newest last.
    """

    id: int
    method: str
    title: str
    params: Params
    status: Status = "idle"
    message: str = ""
    fraction: float = 0.0
    picture: Picture | None = None
    image: FloatImage | None = None
    filled: NDArray[np.bool_] | None = None
    result: Result | None = None
    stored: bool = False
    draft: bool = False
    frames: tuple[Frame, ...] = ()
    metrics: Mapping[str, float] = field(default_factory=dict)
    measures: Mapping[str, float] = field(default_factory=dict)
    findings: tuple[Finding, ...] | None = None
    unexamined: str = ""
    measured_size: tuple[int, int] | None = None
    elapsed_s: float = 0.0
    resumable: bool = False
    inputs: tuple[tuple[str, Input], ...] = ()
    size: tuple[int, ...] = ()
    name: str = ""
    pinned: bool = False
    seed: int | None = None
    history: tuple[Past, ...] = ()


@dataclass(frozen=True)
class Probe:
    """The pixel that the user asks about: under the pointer, or pinned by a click."""

    column_id: int
    row: int
    column: int
    pinned: bool = False


@dataclass(frozen=True, eq=False)
class Scene:
    """Everything that docks may show.

    Parameters
    ----------
    exemplar
        As the methods get it; None while it is prepared for the first time.
    columns
        From left to right.
    selected_id
        Id of the chosen column; 0 when there is none.
    probe
        The pixel that the user asks about.
    sweep
        The newest sweep.
    seed
        Of all columns.
    tuning
        The newest search for parameters.
    points
        Every finished and measured run of the columns in this session, with a small picture, the newest last.
    stage
        The stage of the chosen column's run that the tabs look at; None: its result, or its newest preview.
    lesson
        The lesson that is given, and where the user's own ones are.
    source
        The whole picture that the exemplar is taken from; None where that is not known.
    fill
        The newest fill of a whole picture.
    history
        The steps that undo and redo know.
    opened
        Paths of the pictures that were opened together, else of those opened of late, the newest first.
    compared
        Ids of A and B while these two are compared; empty otherwise.
    notes
        What the user wrote about the project.
    """

    exemplar: ImageInput | None = None
    columns: tuple[ColumnScene, ...] = ()
    selected_id: int = 0
    probe: Probe | None = None
    sweep: SweepScene = NO_SWEEP
    seed: int = 1
    tuning: TuningScene = NO_TUNING
    points: tuple[ShownCell, ...] = ()
    stage: Frame | None = None
    lesson: LessonScene = NO_LESSON
    source: ImageInput | None = None
    fill: FillScene = NO_FILL
    history: History = NO_HISTORY
    opened: tuple[str, ...] = ()
    compared: tuple[int, ...] = ()
    notes: str = ""

    @property
    def selected(self) -> ColumnScene | None:
        """The chosen column."""
        return next((column for column in self.columns if column.id == self.selected_id), None)

    def has_lost(self, before: Scene) -> bool:
        """Whether the exemplar of before has gone, or what any column showed: its picture, result, stages."""
        return not before._shown <= self._shown

    @cached_property
    def _shown(self) -> frozenset[int]:
        parts = (part for each in self.columns for part in (each.image, each.result, *each.frames))
        return frozenset(map(id, (self.exemplar, *parts)))


def asked_columns(scene: Scene) -> tuple[int, ...]:
    """Return whose pixel the user asks about: a column, or A and B while the column is one of them."""
    if scene.probe is None:
        return ()
    asked = scene.probe.column_id
    return scene.compared if asked in scene.compared else (asked,)


def are_same(columns: Sequence[ColumnScene], others: Sequence[ColumnScene]) -> bool:
    """Whether these are the very same pictures of the same columns, in the same order."""
    return len(columns) == len(others) and all(map(operator.is_, columns, others))


# Compared by what they are.
_PARTS = tuple(
    each.name for each in fields(Scene) if each.name not in ("columns", "notes", "probe", "seed", "selected_id")
)


def same_but_probe(scene: Scene, other: Scene) -> bool:
    """Whether two scenes differ in nothing but the pixel that the user asks about."""
    return (
        are_same(scene.columns, other.columns)
        and (scene.seed, scene.selected_id, scene.notes) == (other.seed, other.selected_id, other.notes)
        and all(getattr(scene, name) is getattr(other, name) for name in _PARTS)
    )
