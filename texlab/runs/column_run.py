"""One run of one column in its worker's thread: previews, kept frames, the result."""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

from texlab.state.scene import Frame
from texlab.style.pictures import Picture, to_picture
from texlab_core.engine.cache import array_bytes
from texlab_core.engine.inputs import ArraysInput
from texlab_core.engine.job import Job, job_key
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    import numpy as np
    from numpy.typing import NDArray

    from texlab.state.chosen import Column, State
    from texlab_core.engine.cache import AnalysisCache
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage, Step
    from texlab_core.findings.finding import Finding
    from texlab_core.measures.subject import PreparedCache
    from texlab_core.warming import Need, Warmth

    Keep = Callable[[], Mapping[str, Any]]

MAX_FRAME_BYTES = 96 * 2**20
# Pictures on the way take at most this share of a run: one of a large result takes longer than a step of the work.
PICTURES_SHARE = 0.25
SOLID = "A solid is not examined: findings are about pictures. A slice can be exported and examined."
BROKEN = "The result could not be examined; the log says why."


class TaskLike(Protocol):
    """What a run needs of its worker."""

    def should_stop(self) -> bool:
        """Whether to stop."""
        ...

    def due(self) -> bool:
        """Whether another report would be shown."""
        ...

    def progress(self, value: object) -> None:
        """Report."""
        ...

    def give_way(self) -> float:
        """Let what goes first have the place for a while; return the seconds that it took."""
        ...


@dataclass(frozen=True, eq=False)
class Progress:
    """A report on the way."""

    fraction: float
    message: str
    metrics: Mapping[str, float]
    picture: Picture | None
    image: FloatImage | None
    frames: tuple[Frame, ...]
    elapsed_s: float
    filled: NDArray[np.bool_] | None = None


@dataclass(frozen=True)
class Waits:
    """What a run waits for before it starts."""

    reason: str = ""


@dataclass(frozen=True, eq=False)
class Finished:
    """The end of a run."""

    result: Result
    picture: Picture
    frames: tuple[Frame, ...]
    draft: bool
    metrics: Mapping[str, float] = field(default_factory=dict)
    stored: bool = False
    """Whether it comes from the disk: without the model and the details that explain it."""

    @cached_property
    def nbytes(self) -> int:
        """Bytes of what it holds, counted once; maps that nobody has looked at yet are not computed for that."""
        result, seen = self.result, set[int]()
        parts = (result.image, result.model, result.details, self.picture, [each.picture for each in self.frames])
        return sum(array_bytes(each, seen) for each in parts)


@dataclass(frozen=True, eq=False)
class Drafted:
    """A quick picture, made while a control is dragged; no result."""

    picture: Picture
    image: FloatImage


@dataclass(frozen=True)
class Loading:
    """A request for a worker: waits until a run with this need does not have to load anything itself."""

    warmth: Warmth
    need: Need

    def __call__(self, task: TaskLike) -> None:
        """Wait, and say so."""
        if not self.warmth.is_warm(self.need):
            task.progress(Waits("loading"))
            self.warmth.wait(self.need, task.should_stop)
            task.progress(Waits())


@dataclass(frozen=True)
class Stored:
    """A request for a worker: what the disk holds of a job, before anything else is waited for."""

    make_job: Callable[[], Job]
    read: Callable[[Job], Finished | None]
    otherwise: Loading

    def __call__(self, task: TaskLike) -> Finished | None:
        """Return the result; None, once everything is loaded, when it has to be made."""
        found = self.read(self.make_job())
        if found is None:
            self.otherwise(task)
        return found


@dataclass(frozen=True)
class DraftRun:
    """A request for a worker: the method's own quick picture of a job."""

    make_job: Callable[[], Job]

    def __call__(self, task: TaskLike) -> Drafted:
        """Make the picture."""
        job = self.make_job()
        make = find_method(job.method).draft
        assert make is not None
        image = make(job.inputs, job.params, job.size, job.seed)
        return Drafted(to_picture(image), image)


@dataclass
class ColumnRun:
    """A request for a worker: runs ``job``; as a draft with nothing on the way."""

    make_job: Callable[[], Job]
    cache: AnalysisCache
    draft: bool = False
    frames: list[Frame] = field(default_factory=list)
    state: Callable[[], Mapping[str, Any]] | None = None
    """Makes the arrays from which the run goes on where it stands; read it when the worker is free again."""

    def __call__(self, task: TaskLike) -> Finished:
        """Run to the end, reporting on the way."""
        start = time.perf_counter()
        kept = 0
        away = next_picture = 0.0
        metrics: dict[str, float] = {}

        def watch(step: Step) -> None:
            nonlocal kept, away, next_picture
            away += task.give_way()
            metrics.update(step.metrics)
            self.state = step.state
            due = not self.draft and task.due()
            keep = step.frame is not None and not self.draft and kept < MAX_FRAME_BYTES
            before = time.perf_counter()
            shown = due and before >= next_picture
            image = step.preview() if step.preview is not None and (shown or keep) else None
            picture = to_picture(image) if image is not None else None
            filled = step.filled() if step.filled is not None and image is not None else None
            if image is not None:
                after = time.perf_counter()
                next_picture = after + (after - before) * (1 / PICTURES_SHARE - 1)
            if keep and picture is not None and step.frame is not None:
                kept += picture.nbytes
                self.frames.append(Frame(step.frame, picture))
            if due:
                fraction = step.fraction if step.phase == "synthesis" else 0.0
                elapsed = time.perf_counter() - start - away
                message = step.stage or step.phase
                task.progress(
                    Progress(fraction, message, dict(metrics), picture, image, tuple(self.frames), elapsed, filled)
                )

        result = run(self.make_job(), watch, task.should_stop, cache=self.cache, threads=1)
        result = replace(result, elapsed_s=result.elapsed_s - away)
        self.state = getattr(result.details, "state", None)
        end = Finished(result, to_picture(result.image), tuple(self.frames), self.draft, metrics)
        # Counted here: whoever keeps it in the window's thread has nothing left to do.
        _ = end.nbytes
        return end


@dataclass(frozen=True, eq=False)
class Measured:
    """Numbers about the picture that is shown, by id, its height and width, and what is wrong with it.

    ``findings`` is None while that was not looked into; ``unexamined`` says why it never will be, or what was left
    out because its detector failed.
    """

    measures: Mapping[str, float]
    size: tuple[int, int]
    findings: tuple[Finding, ...] | None = None
    unexamined: str = ""


@dataclass(frozen=True, eq=False)
class MeasureRun:
    """A request for a worker: measures a picture that is shown already; of a draft only what is quick."""

    image: FloatImage
    exemplar: ImageInput
    result: Result | None
    cache: PreparedCache
    draft: bool

    def __call__(self, task: TaskLike) -> Measured:
        """Measure, reporting the quick numbers first."""
        from texlab_core.findings.registry import examine
        from texlab_core.measures.registry import measure_all, measure_quick, measures
        from texlab_core.measures.subject import Subject

        def look() -> None:
            task.give_way()
            if task.should_stop():
                raise Cancelled

        subject = Subject(image=self.image, exemplar=self.exemplar, cache=self.cache, look=look)
        if self.result is not None:
            subject = replace(Subject.of_result(self.result, self.cache), look=look)
        size = (self.image.shape[0], self.image.shape[1])
        found = measure_quick(subject)
        if self.draft:
            return Measured(found, size)
        task.progress(Measured(dict(found), size))
        found |= measure_all(subject, (each.id for each in measures().values() if not (each.slow or each.live)))
        task.progress(Measured(dict(found), size))
        if self.result is None:
            return Measured(found, size)
        if self.result.volume is not None:
            return Measured(found, size, None, SOLID)
        examined = examine(subject, self.result.job.params)
        # Where nothing at all was looked for there are no findings, not even none.
        nothing = bool(examined.why) and not examined.failed
        return Measured(found, size, None if nothing else examined.findings, examined.why)


def with_exemplar(exemplar: ImageInput, inputs: tuple[tuple[str, Any], ...]) -> dict[str, Any]:
    """Return the named inputs of a column's job."""
    return {"exemplar": exemplar, **dict(inputs)}


def key_of(column: Column, state: State, exemplar: ImageInput) -> tuple[object, ...]:
    """Return the key of a column's job (:attr:`Job.key`), which is not made for that."""
    inputs = with_exemplar(exemplar, column.inputs)
    return job_key(column.method, inputs, column.params, state.size_of(column), state.seed_of(column))


def job_of(
    column: Column,
    state: State,
    exemplar: ImageInput,
    *,
    size: tuple[int, ...] | None = None,
    kept: Keep | None = None,
) -> Job:
    """Return a column's job.

    Parameters
    ----------
    column, state, exemplar
        Whose job, in which state of the session, on what.
    size
        Of the result; None is the column's.
    kept
        Makes the arrays from which the job goes on; they are read now.

    Raises
    ------
    InputError
        When it cannot work.
    """
    inputs = with_exemplar(exemplar, column.inputs)
    if kept is not None:
        inputs["state"] = ArraysInput(kept(), "state")
    size = state.size_of(column) if size is None else size
    return Job(method=column.method, inputs=inputs, params=column.params, size=size, seed=state.seed_of(column))
