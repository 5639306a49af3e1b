"""A lesson made ready in the background: its pictures first, then step by step what the columns will show."""

from __future__ import annotations

import dataclasses
import logging
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from texlab.runs.column_run import ColumnRun, Loading, MeasureRun, job_of, key_of
from texlab.runs.slots import Rank
from texlab.runs.worker import Worker
from texlab.state.changes import sample_as_used
from texlab.state.chosen import State
from texlab.state.lessons import StepPictures, state_of
from texlab_core.errors import InputError
from texlab_core.warming import Need

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable

    from texlab.runs.column_run import Finished, TaskLike
    from texlab.runs.column_runner import Shared
    from texlab_core.documents.lessons import Lesson
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.lessons.drawing import Drawn


log = logging.getLogger(__name__)


@dataclass(frozen=True, eq=False)
class Opened:
    """A lesson with its pictures."""

    name: str
    lesson: Lesson
    pictures: tuple[StepPictures, ...]


@dataclass(frozen=True, eq=False)
class _Made:
    place: int
    keys: tuple[Hashable, ...]
    drawn: Drawn | None


@dataclass(frozen=True)
class _Numbers:
    place: int


class LessonRunner(QObject):
    """Opens lessons and computes their steps ahead, with what no column needs.

    When all are ready, the numbers and findings about their results are found out too, so that nothing is left to
    compute when a step is shown.

    ``opened(opened)`` when the pictures are there; ``advanced()`` whenever another step is ready;
    ``failed(sentence)``.
    """

    opened = Signal(object)
    advanced = Signal()
    failed = Signal(str)

    def __init__(self, shared: Shared, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._shared = shared
        self._open: Opened | None = None
        self._left: list[int] = []
        self._making = False
        self._keys: dict[int, tuple[Hashable, ...]] = {}
        self._drawn: dict[int, Drawn | None] = {}
        # Steps whose numbers and findings are known.
        self._measured: set[int] = set()
        self._worker = Worker("lesson", shared.slots, self)
        self._worker.finished.connect(self._finished)
        self._worker.failed.connect(self._failed)

    @property
    def busy(self) -> bool:
        """Whether a lesson is being opened or a step made ready."""
        return self._worker.busy

    def open(self, name: str, read: Callable[[], Lesson]) -> None:
        """Open a lesson instead of the present one; ``read`` is called in the background."""
        self.leave_lesson()
        self._worker.submit(lambda task: _opened(name, read), rank=Rank.CHANGED)

    def prepare_from(self, place: int) -> None:
        """Make the steps ready, this one first and then those behind it."""
        if self._open is None:
            return
        count = len(self._open.pictures)
        order = [*range(place, count), *range(place)]
        self._left = [each for each in order if not self.ready(each)]
        if not self._making:
            self._next()

    def rearrange(self, lesson: Lesson, order: tuple[int, ...]) -> Opened | None:
        """Go on with the steps in another order and with other words; what is ready stays so.

        Parameters
        ----------
        lesson
            As it is to be.
        order
            For each of its steps the index of a present one that shows the same.
        """
        before = self._open
        if before is None:
            return None
        if order != tuple(range(len(before.pictures))):
            # What is being made ready is for a place that another step has now.
            self._worker.cancel()
            self._making = False
        self._open = Opened(before.name, lesson, tuple(before.pictures[place] for place in order))
        self._keys = {new: self._keys[old] for new, old in enumerate(order) if old in self._keys}
        self._drawn = {new: self._drawn[old] for new, old in enumerate(order) if old in self._drawn}
        self._measured = {new for new, old in enumerate(order) if old in self._measured}
        return self._open

    def leave_lesson(self) -> None:
        """Stop making steps ready, and forget the lesson; finished results stay kept."""
        self._worker.cancel()
        self._open, self._left, self._making = None, [], False
        self._keys.clear()
        self._drawn.clear()
        self._measured.clear()

    def ready(self, place: int) -> bool:
        """Whether a step shows at once: what it needs has been made, and is still kept."""
        kept = self._shared.kept
        return place in self._keys and all(kept.get(key) is not None for key in self._keys[place])

    def drawn(self, place: int) -> Drawn | None:
        """Return a step's drawing, as soon as it is there."""
        return self._drawn.get(place)

    def leave(self) -> None:
        """Ask the thread to end, without waiting."""
        self._worker.leave()

    def close(self) -> None:
        """Stop the thread and wait for its end."""
        self._worker.close()

    @property
    def ended(self) -> bool:
        """Whether the thread has ended."""
        return self._worker.ended

    def _next(self) -> None:
        """Make the next step ready; when all are, find out the numbers that stand under their pictures."""
        if self._open is None:
            return
        work: Callable[[TaskLike], _Made | _Numbers]
        if self._left:
            work = partial(_make, self._shared, self._open, self._left.pop(0))
        else:
            place = next((each for each in self._keys if each not in self._measured), None)
            if place is None:
                return
            work = partial(_measure, self._shared, self._open, place, self._keys[place])
        self._making = True
        self._worker.submit(work, rank=Rank.AHEAD)

    def _finished(self, value: Opened | _Made | _Numbers) -> None:
        if isinstance(value, Opened):
            self._open = value
            self.opened.emit(value)
            return
        self._making = False
        if isinstance(value, _Made):
            self._keys[value.place] = value.keys
            self._drawn[value.place] = value.drawn
            self.advanced.emit()
        else:
            self._measured.add(value.place)
        self._next()

    def _failed(self, sentence: str) -> None:
        self._making = False
        self.failed.emit(sentence)
        self._next()


def _opened(name: str, read: Callable[[], Lesson]) -> Opened:
    from texlab_core.lessons.running import check_lesson

    lesson = read()
    check_lesson(lesson)
    read_before: dict[object, ImageInput] = {}
    return Opened(name, lesson, tuple(_pictures(lesson, place, read_before) for place in range(len(lesson.steps))))


def _pictures(lesson: Lesson, place: int, before: dict[object, ImageInput]) -> StepPictures:
    """Read a step's pictures; a texture that several steps use is read once."""
    from texlab_core.images.exemplar import as_exemplar
    from texlab_core.lessons.running import picture, read_picture, taken_from

    step = lesson.steps[place]
    if step.exemplar is None:
        return StepPictures(inputs=tuple(() for _ in step.columns))
    source = lesson.locate(step.exemplar), step.exemplar.alpha
    if source not in before:
        before[source] = read_picture(lesson, step.exemplar)
    used = sample_as_used(taken_from(before[source], step.exemplar))
    sample = dataclasses.replace(used, alpha=step.exemplar.alpha)
    exemplar = as_exemplar(sample.source, scale=sample.scale, crop=sample.crop, levels=sample.levels)
    inputs = tuple(
        tuple((name, picture(lesson, each)) for name, each in column.inputs.items()) for column in step.columns
    )
    return StepPictures(sample, exemplar, inputs)


def _make(shared: Shared, opened: Opened, place: int, task: TaskLike) -> _Made:
    """Compute what a step shows, and keep it (in the worker's thread)."""
    from texlab_core.lessons.running import drawn

    step, pictures = opened.lesson.steps[place], opened.pictures[place]
    keys: list[Hashable] = []
    ends: list[Finished] = []
    if pictures.exemplar is not None:
        state = state_of(step, pictures, State(), 1)
        columns = list(state.columns)
        if step.series is not None:
            base, first = step.columns[step.series.column], columns[step.series.column]
            columns += [
                dataclasses.replace(first, params=step.series.at(base, value).params())
                for value in step.series.values
            ]
        for column in columns:
            key = key_of(column, state, pictures.exemplar)
            end = shared.kept.get(key)
            if end is None or end.stored:
                # What comes from the disk shows the result, not how it came about.
                Loading(shared.warmth, Need(column.method, pictures.exemplar.channels))(task)
                run = ColumnRun(partial(job_of, column, state, pictures.exemplar), shared.cache)
                end = run(task)
                shared.kept.put(key, end)
            keys.append(key)
            ends.append(end)
    results = tuple(end.result for end in ends[: len(step.columns)])
    return _Made(place, tuple(keys), drawn(opened.lesson, step, pictures.exemplar, results))


def _measure(shared: Shared, opened: Opened, place: int, keys: tuple[Hashable, ...], task: TaskLike) -> _Numbers:
    """Find out numbers and findings about what a step shows, and keep them with it (in the worker's thread)."""
    exemplar = opened.pictures[place].exemplar
    for key in keys:
        end = shared.kept.get(key)
        if exemplar is None or end is None or shared.kept.measured(key) is not None:
            continue
        try:
            result = end.result
            shared.kept.note(key, MeasureRun(result.image, exemplar, result, shared.prepared, draft=False)(task))
        except InputError as bad:
            # The column says so itself when it is shown.
            log.warning("A step of %s could not be measured: %s", opened.lesson.title, bad)
    return _Numbers(place)
