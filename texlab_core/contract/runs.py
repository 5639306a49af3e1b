"""What a method promises of its runs: bits, steps, cancel, outputs."""

from __future__ import annotations

import dataclasses
import inspect
import itertools
import math
import random
import time
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.contract.cases import (
    Broken,
    case,
    check_image,
    check_sentence,
    job,
    odd_exemplars,
    promise,
    size_for,
    texture,
)
from texlab_core.contract.declarations import settings
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.run import run
from texlab_core.engine.sizes import default_size
from texlab_core.engine.streams import Streams
from texlab_core.errors import Cancelled, InputError
from texlab_core.measures.registry import measure_all, measures
from texlab_core.measures.subject import Subject

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.job import Job
    from texlab_core.engine.registry import Method
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import Map, Step

# Longest work between two steps at 128 x 128, in CPU seconds; the promise is 50 ms of wall time at 512 x 512.
LONGEST_GAP_S = 0.2


def watched(given: Job, **options: Any) -> tuple[Result, list[Step]]:
    """Run with a watcher that makes, checks and spoils every preview."""
    steps: list[Step] = []

    def watch(step: Step) -> None:
        steps.append(step)
        if step.preview is not None:
            preview = step.preview()
            exemplar: Any = given.inputs["exemplar"]
            check_image(
                preview, (*given.picture_size, exemplar.channels), f"the preview of the step {step.stage!r}"
            )
            if preview.flags.writeable:
                preview[:] = 0.5

    return run(given, watch, **options), steps


def promise_same_bits(one: Result, other: Result, when: str) -> None:
    """Check that two results of one job are the same, to the last bit."""
    promise(_same(one.image, other.image), f"the image differs {when}.")
    promise((one.volume is None) == (other.volume is None), f"only one of them has a volume {when}.")
    if one.volume is not None and other.volume is not None:
        promise(_same(one.volume, other.volume), f"the volume differs {when}.")
    promise(one.maps.keys() == other.maps.keys(), f"the maps differ {when}.")
    promise(one.curves.keys() == other.curves.keys(), f"the curves differ {when}.")
    promise(one.measures == other.measures, f"the measures differ {when}.")
    promise(one.notes == other.notes, f"the notes differ {when}.")
    for name in one.maps:
        promise(_same(one.maps[name].data, other.maps[name].data), f"the map {name} differs {when}.")
    for name in one.curves:
        promise(_same(one.curves[name].y, other.curves[name].y), f"the curve {name} differs {when}.")


def _same(one: NDArray[Any], other: NDArray[Any]) -> bool:
    return one.shape == other.shape and one.dtype == other.dtype and one.tobytes() == other.tobytes()


def check_same_bits(method: Method) -> None:
    """Give the same bits for the same job: with any number of threads, watched, with a cache."""
    for channels in (1, 3):
        exemplar = texture(30, 41, channels)
        plan = job(method, exemplar, size=(37, 22), seed=3)
        first = run(plan, threads=1)
        promise_same_bits(first, run(plan, threads=2), "with two threads")
        promise_same_bits(first, watched(plan)[0], "when somebody watches")
        cache = AnalysisCache()
        run(job(method, exemplar, size=(16, 16), seed=4), cache=cache)
        promise_same_bits(first, run(plan, cache=cache), "with a cached analysis")
        asked = run(plan, should_stop=lambda: False, cache=cache)
        promise_same_bits(first, asked, "when it is asked whether to stop")


def check_seeds(method: Method) -> None:
    """Give other bits for another seed, or say that nothing is random."""
    # Larger than the exemplar: at its own size a method may rightly return the exemplar.
    one, other = (run(job(method, size=(40, 56), seed=seed)).image for seed in (0, 1))
    differs = bool((one != other).any())
    promise(
        method.random == differs,
        "two seeds give the same bits; say random=False."
        if method.random
        else "random is False, and seeds matter.",
    )


def check_no_side_effects(method: Method) -> None:
    """Leave inputs and global random generators as they were."""
    exemplar = texture(24, 32)
    before = exemplar.pixels.copy()
    state = random.getstate(), str(np.random.get_state())  # noqa: NPY002
    result = run(job(method, exemplar))
    promise(np.array_equal(exemplar.pixels, before), "the exemplar was changed.")
    promise(not exemplar.pixels.flags.writeable, "the exemplar was made writeable.")
    promise(not np.shares_memory(result.image, exemplar.pixels), "the image shares memory with the exemplar.")
    same = (random.getstate(), str(np.random.get_state())) == state  # noqa: NPY002
    promise(same, "a global random generator was used; draw from streams instead.")


def check_steps(method: Method) -> None:
    """Tell in steps what is being done, never fall back, and show a picture at least once."""
    _, steps = watched(job(method, texture(40, 33)))
    for phase in ("analysis", "synthesis"):
        told = [step for step in steps if step.phase == phase]
        promise(all(0 <= step.done <= step.total for step in told), f"{phase}: done must lie in 0 to total.")
        falls = any(a.done > b.done or a.fraction > b.fraction for a, b in itertools.pairwise(told))
        promise(not falls, f"{phase}: progress falls back.")
    synthesis = [step for step in steps if step.phase == "synthesis"]
    promise(synthesis, "synthesis: yields no step.")
    promise(any(step.preview is not None for step in synthesis), "synthesis: no step has a preview.")
    for step in steps:
        promise(step.stage and "\n" not in step.stage, f"a step's stage must be one line, got {step.stage!r}.")
        promise(step.frame is None or step.preview is not None, f"the frame {step.frame!r} needs a preview.")
        promise(all(np.isfinite(value) for value in step.metrics.values()), "metrics must be finite.")


def check_cancel(method: Method) -> None:
    """Stop at any step when asked, and leave nothing behind."""
    plan = job(method)
    result, steps = watched(plan)
    count = len(steps)
    for after in sorted({0, 1, 2, count // 2, count - 1, count}):
        stop = Stop(after)
        try:
            ended = run(plan, should_stop=stop)
        except Cancelled:
            continue
        if stop.told:
            raise Broken(f"the run went on after it was stopped at step {after} of {count}.")
        # A method may make more steps on a slower machine: what was never told to stop goes on to its end.
        promise_same_bits(result, ended, "in another run")
    promise_same_bits(result, run(plan), "after a run that was stopped")


class Stop:
    """Says stop when it is asked for the time after so many, and remembers whether it has."""

    def __init__(self, after: int) -> None:
        self._asked = itertools.count()
        self._after = after
        self.told = False

    def __call__(self) -> bool:
        """Return whether to stop."""
        self.told = next(self._asked) >= self._after
        return self.told


def check_generators(method: Method) -> None:
    """End when the generators are closed."""
    plan = job(method)
    model = run(plan).model
    for name, steps in (
        ("analyze", method.analyze(plan.inputs, plan.params)),
        ("synthesize", method.synthesize(model, plan.inputs, plan.params, plan.size, Streams(plan.seed))),
    ):
        promise(inspect.isgenerator(steps), f"{name}: must be a generator, got {type(steps).__name__}.")
        next(steps, None)
        try:
            steps.close()
        except RuntimeError:
            raise Broken(f"{name}: goes on after it was closed.") from None


def check_gaps(method: Method) -> None:
    """Work only shortly between two steps, so that a run can be watched and stopped."""
    plan = job(method, texture(128, 128))
    run(plan)
    gaps = []
    for _ in range(2):
        moments = [time.thread_time()]
        run(plan, _clock(moments), threads=1)
        moments.append(time.thread_time())
        gaps.append(max(b - a for a, b in itertools.pairwise(moments)))
    promise(
        min(gaps) < LONGEST_GAP_S,
        f"up to {min(gaps):.2f} s pass between two steps at 128 x 128; at most {LONGEST_GAP_S} s are allowed.",
    )


def _clock(moments: list[float]) -> Callable[[Step], None]:
    return lambda step: moments.append(time.thread_time())


def check_outputs(method: Method) -> None:
    """Return the size that was asked for, with maps, curves, measures and notes as they should be."""
    for channels in (1, 3):
        for size in ((24, 32), (50, 17), (9, 64)):
            exemplar = texture(24, 32, channels)
            with case(f"exemplar of {channels} channels, size {size}"):
                result = run(job(method, exemplar, size=size))
                promise_output(result, size_for(method, size), exemplar.pixels.shape)


def promise_output(result: Result, size: tuple[int, ...], exemplar: tuple[int, ...]) -> None:
    """Check everything that a result holds."""
    promise(result.job.size == size, f"the result's job must have the size {size}, got {result.job.size}.")
    check_image(result.image, (*size[-2:], exemplar[2]), "the image")
    if len(size) == 3:
        promise(result.volume is not None, "a method of three dimensions must return a volume.")
        assert result.volume is not None
        check_image(result.volume, (*size, exemplar[2]), "the volume")
        shown = np.array_equal(result.image, result.volume[size[0] // 2])
        promise(shown, "the image of a volume must be its middle slice; leave it out.")
    else:
        promise(result.volume is None, "a method that returns a volume must say dimensions=3.")
    for name, each in result.maps.items():
        _check_name(name, "map")
        promise(each.title, f"the map {name} needs a title.")
        _check_map(each, size, exemplar, name)
    for name, curve in result.curves.items():
        _check_name(name, "curve")
        promise(curve.title, f"the curve {name} needs a title.")
        promise(curve.x.shape == curve.y.shape, f"the curve {name} needs as many x as y.")
        promise(np.isfinite(curve.x).all() and np.isfinite(curve.y).all(), f"the curve {name} must be finite.")
    for name, value in result.measures.items():
        promise(np.isfinite(value), f"the measure {name} must be finite, got {value}.")
    for note in result.notes:
        check_sentence(note, "a note")


def _check_name(name: str, what: str) -> None:
    promise(
        name == name.lower().replace(" ", "-").replace("_", "-"),
        f"the name of a {what} must be lower-case words with hyphens, got {name!r}.",
    )


def _check_map(each: Map, size: tuple[int, ...], exemplar: tuple[int, ...], name: str) -> None:
    promise(each.plane.data.shape[:2] == size[-2:], f"the plane of the map {name} must have the size {size[-2:]}.")
    if each.kind == "source":
        promise(each.data.shape == (*size, 2), f"the map {name} must have the shape {(*size, 2)}.")
        promise(each.data.dtype == np.int32, f"the map {name} must be int32.")
        inside = (each.data >= 0).all() and (each.data < exemplar[:2]).all()
        promise(inside, f"the map {name} must point into the exemplar.")
        return
    promise(each.data.shape == size, f"the map {name} must have the shape {size}.")
    if each.kind == "count":
        whole = np.issubdtype(each.data.dtype, np.integer) and (each.data >= 0).all()
        promise(whole, f"the map {name} must hold whole numbers from 0.")
    else:
        wanted = {"label": np.int32, "scalar": np.float32}[each.kind]
        promise(each.data.dtype == wanted, f"the map {name} must be {np.dtype(wanted)}.")


def check_odd_inputs(method: Method) -> None:
    """Work with odd exemplars and sizes, or refuse them in one sentence."""
    for name, exemplar in odd_exemplars().items():
        for size in (None, (1, 1), (5, 3), (2, 40)):
            wanted = default_size(exemplar.size, method.dimensions) if size is None else size_for(method, size)
            with case(f"exemplar {name}, size {size}"):
                promise_output_or_refusal(method, wanted, exemplar=exemplar, size=size)


def promise_output_or_refusal(
    method: Method, wanted: tuple[int, ...], *, exemplar: ImageInput, **changes: Any
) -> None:
    """Check the result of a job, or the one sentence that refuses it."""
    try:
        result = run(job(method, exemplar, **changes))
    except InputError as error:
        check_sentence(str(error), "the refusal")
        return
    promise_output(result, wanted, exemplar.pixels.shape)


def check_settings(method: Method) -> None:
    """Work with every knob at its ends, or refuse it in one sentence."""
    exemplar = texture(16, 13)
    for params in settings(method):
        with case(str(params)):
            promise_output_or_refusal(
                method, size_for(method, (11, 18)), exemplar=exemplar, params=params, size=(11, 18)
            )


def check_measures(method: Method) -> None:
    """Say registered measures only, those that it names, in their range, and what the registry computes."""
    known = measures()
    missing = [each for each in method.measures if each not in known]
    promise(not missing, f"measures: names what nobody registers: {', '.join(missing)}.")
    result = run(job(method, texture(40, 48), size=(44, 60)))
    unnamed = sorted(set(result.measures) - set(method.measures))
    promise(not unnamed, f"measures: must name what the results carry, and lacks {', '.join(unnamed)}.")
    said = Subject.of_result(result)
    silent = dataclasses.replace(said, given={})
    for name, value in result.measures.items():
        measure = known[name]
        inside = measure.low <= value <= measure.high
        promise(inside, f"the measure {name} is {value:g}, out of its range {measure.low:g} to {measure.high:g}.")
        promise(measure.of(said) == value, f"the measure {name} is {value:g}, and asked for {measure.of(said)}.")
        if measure.function is not None:
            computed = measure.of(silent)
            promise(
                computed is not None and math.isclose(computed, value, rel_tol=1e-9, abs_tol=1e-12),
                f"the measure {name} is {value:g}; computed from the result it is {computed}.",
            )
    promise(set(result.measures) <= set(measure_all(said)), "measures: not all of them are found when asked for.")
