"""Run the steps of a lesson: jobs in their order, the slider's results, the drawing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from texlab_core.documents.lesson_parts import LessonError
from texlab_core.engine.inputs import Crop, ImageInput
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.engine.sizes import default_size
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.images.unit_range import TRANSPARENCY
from texlab_core.lessons.drawing import Drawn, Scene, draw, kind_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from texlab_core.documents.lesson_parts import StepColumn, Taken
    from texlab_core.documents.lessons import Lesson, LessonStep
    from texlab_core.engine.cache import AnalysisCache
    from texlab_core.engine.result import Result

REDUCED_SIDE = 64


@dataclass(frozen=True, eq=False)
class StepResult:
    """What a step shows.

    Parameters
    ----------
    exemplar
        What its columns work on.
    results
        One for each column.
    series
        One for each value of the slider.
    drawn
        Its drawing.
    """

    exemplar: ImageInput | None
    results: tuple[Result, ...]
    series: tuple[Result, ...]
    drawn: Drawn | None


def check_step(step: LessonStep) -> None:
    """Refuse a drawing that nobody can draw, or that lacks what it needs.

    Raises
    ------
    InputError
        With one sentence.
    """
    if step.drawing is None:
        return
    kind, _ = kind_of(step.drawing)
    chosen = step.columns[step.chosen] if step.columns else None
    given = {"exemplar": step.exemplar, "other": step.drawing.other, "result": chosen, "pixel": step.pixel}
    for need in kind.needs:
        if given[need] is None:
            raise LessonError(f"drawing: {step.drawing.kind} needs {_NEEDED[need]}, and there is none.")
    if kind.methods and (chosen is None or chosen.method not in kind.methods):
        names = " or ".join(kind.methods)
        raise LessonError(f"drawing: {step.drawing.kind} needs a chosen column of {names}.")


_NEEDED = {"exemplar": "an exemplar", "other": "a second picture", "result": "a column", "pixel": "a pixel"}


def check_lesson(lesson: Lesson) -> None:
    """Check every step's drawing; raises ``LessonError`` that names the step."""
    for number, step in enumerate(lesson.steps, 1):
        try:
            check_step(step)
        except InputError as bad:
            raise LessonError(f"Step {number} of {lesson.title}: {bad}") from bad


def jobs(lesson: Lesson, step: LessonStep, *, reduced: bool = False) -> tuple[Job, ...]:
    """Return the jobs of a step: of its columns, then of its slider.

    Parameters
    ----------
    reduced
        At most 64 pixels a side, for a quick check.

    Raises
    ------
    InputError
        When a picture cannot be read, or a method cannot do what is asked.
    """
    if step.exemplar is None:
        return ()
    exemplar = picture(lesson, step.exemplar, reduced=reduced)
    columns = list(step.columns)
    if step.series is not None:
        column = step.columns[step.series.column]
        columns += [step.series.at(column, value) for value in step.series.values]
    return tuple(_job(lesson, step, each, exemplar, reduced=reduced) for each in columns)


def _job(lesson: Lesson, step: LessonStep, column: StepColumn, exemplar: ImageInput, *, reduced: bool) -> Job:
    inputs: Mapping[str, ImageInput] = {
        "exemplar": exemplar,
        **{name: picture(lesson, each, reduced=reduced) for name, each in column.inputs.items()},
    }
    size = column.size or default_size(step.size, find_method(column.method).dimensions)
    if reduced:
        size = tuple(min(side, REDUCED_SIDE if len(size) == 2 else REDUCED_SIDE // 4) for side in size)
    seed = step.seed if column.seed is None else column.seed
    return Job(method=column.method, inputs=inputs, params=column.params(), size=size, seed=seed)


def picture(lesson: Lesson, taken: Taken, *, reduced: bool = False) -> ImageInput:
    """Return a picture of a lesson."""
    found = taken_from(read_picture(lesson, taken), taken)
    if not reduced or max(found.size) <= REDUCED_SIDE:
        return found
    crop = taken.crop or Crop(0, 0, *found.size)
    side = Crop(crop.top, crop.left, min(crop.height, REDUCED_SIDE), min(crop.width, REDUCED_SIDE))
    return as_exemplar(found, crop=side, scale=taken.scale, levels=taken.levels)


def read_picture(lesson: Lesson, taken: Taken) -> ImageInput:
    """Return all of a picture of a lesson, its transparency read as the lesson says."""
    use, background = TRANSPARENCY[taken.alpha]
    return as_exemplar(lesson.locate(taken), alpha=use, background=background)


def taken_from(whole: ImageInput, taken: Taken) -> ImageInput:
    """Return what is used of a picture that :func:`read_picture` has read."""
    return as_exemplar(whole, crop=taken.crop, scale=taken.scale, levels=taken.levels)


def run_step(
    lesson: Lesson,
    step: LessonStep,
    *,
    reduced: bool = False,
    cache: AnalysisCache | None = None,
    on_job: Callable[[int, int], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> StepResult:
    """Run everything that a step shows.

    Parameters
    ----------
    reduced
        At most 64 pixels a side.
    cache
        Of analyses.
    on_job
        Called with the number of jobs that are done, and of all.
    should_stop
        Asked often.

    Raises
    ------
    InputError
        When something in it cannot be done.
    Cancelled
        When ``should_stop`` said so.
    """
    check_step(step)
    wanted = jobs(lesson, step, reduced=reduced)
    made: list[Result] = []
    for number, job in enumerate(wanted):
        if on_job is not None:
            on_job(number, len(wanted))
        # A slider often passes through a column's own value.
        same = next((each for each in made if _same(each.job, job)), None)
        made.append(same or run(job, should_stop=should_stop, cache=cache))
    results, series = tuple(made[: len(step.columns)]), tuple(made[len(step.columns) :])
    exemplar = None if step.exemplar is None else picture(lesson, step.exemplar, reduced=reduced)
    return StepResult(exemplar, results, series, drawn(lesson, step, exemplar, results, reduced=reduced))


def drawn(
    lesson: Lesson,
    step: LessonStep,
    exemplar: ImageInput | None,
    results: tuple[Result, ...],
    *,
    reduced: bool = False,
) -> Drawn | None:
    """Return a step's drawing, or None when it has none."""
    if step.drawing is None:
        return None
    other = step.drawing.other
    drawing = step.drawing
    if reduced and "trials" in kind_of(drawing)[0].settings.__dataclass_fields__:
        drawing = replace(drawing, settings={**drawing.settings, "trials": 2, "points": 60})
    scene = Scene(
        exemplar=exemplar,
        other=None if other is None else picture(lesson, other, reduced=reduced),
        result=results[step.chosen] if results else None,
        pixel=None if step.pixel is None else (step.pixel.row, step.pixel.x),
        seed=step.seed,
    )
    return draw(drawing, scene)


def _same(one: Job, two: Job) -> bool:
    return (one.analysis_key, one.params, one.size, one.seed) == (two.analysis_key, two.params, two.size, two.seed)


def run_lesson(
    lesson: Lesson,
    *,
    reduced: bool = False,
    on_step: Callable[[int, int], None] | None = None,
    should_stop: Callable[[], bool] | None = None,
) -> Iterator[StepResult]:
    """Run step after step; errors name the step."""
    from texlab_core.engine.cache import AnalysisCache

    cache = AnalysisCache()
    for number, step in enumerate(lesson.steps, 1):
        if on_step is not None:
            on_step(number, len(lesson.steps))
        try:
            yield run_step(lesson, step, reduced=reduced, cache=cache, should_stop=should_stop)
        except InputError as bad:
            raise LessonError(f"Step {number} of {lesson.title}: {bad}") from bad
