"""One run of one column in its worker's thread: previews, kept frames, the result."""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Protocol

from texlab.state.scene import Frame
from texlab.style.pictures import Picture, to_picture
from texlab_core.engine.inputs import ImageInput
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from texlab_core.engine.cache import AnalysisCache
    from texlab_core.engine.job import Job
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import FloatImage, Step
    from texlab_core.warming import Need, Warmth

MAX_FRAME_BYTES = 96 * 2**20


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
    """A request for a worker: runs ``job``; as a draft with nothing on the way and without further measures."""

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
        away = 0.0
        metrics: dict[str, float] = {}

        def watch(step: Step) -> None:
            nonlocal kept, away
            away += task.give_way()
            metrics.update(step.metrics)
            self.state = step.state
            due = not self.draft and task.due()
            keep = step.frame is not None and not self.draft and kept < MAX_FRAME_BYTES
            image = step.preview() if step.preview is not None and (due or keep) else None
            picture = to_picture(image) if image is not None else None
            if keep and picture is not None and step.frame is not None:
                kept += picture.nbytes
                self.frames.append(Frame(step.frame, picture))
            if due:
                fraction = step.fraction if step.phase == "synthesis" else 0.0
                elapsed = time.perf_counter() - start - away
                message = step.stage or step.phase
                task.progress(
                    Progress(fraction, message, dict(metrics), picture, image, tuple(self.frames), elapsed)
                )

        result = run(self.make_job(), watch, task.should_stop, cache=self.cache, threads=1)
        result = replace(result, elapsed_s=result.elapsed_s - away)
        self.state = getattr(result.details, "state", None)
        metrics |= {} if self.draft else spectral_distances(result, task.should_stop)
        return Finished(result, to_picture(result.image), tuple(self.frames), self.draft, metrics)


def spectral_distances(result: Result, should_stop: Callable[[], bool]) -> dict[str, float]:
    """Return how far the result's spectrum is from the exemplar's: dB, and share of the power moved.

    Raises ``Cancelled`` when ``should_stop``, which is asked every few milliseconds, says so.
    """
    from texlab_core.stats.spectrum import log_spectral_distance, power_spectrum, total_variation

    exemplar = result.job.inputs.get("exemplar")
    if not isinstance(exemplar, ImageInput) or exemplar.channels != result.image.shape[2]:
        return {}

    def look() -> None:
        if should_stop():
            raise Cancelled

    first, second = power_spectrum(exemplar.pixels, look), power_spectrum(result.image, look)
    look()
    distance = log_spectral_distance(first, second)
    look()
    return {"spectral-distance": distance, "spectral-variation": total_variation(first, second)}


def with_exemplar(exemplar: ImageInput, inputs: tuple[tuple[str, Any], ...]) -> dict[str, Any]:
    """Return the named inputs of a column's job."""
    return {"exemplar": exemplar, **dict(inputs)}
