"""What every method promises of its runs: bits, steps, cancel, outputs."""

from __future__ import annotations

import itertools
import random
import time
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from tests.contract.cases import IDS, METHODS, assert_image, assert_sentence, job, params_of, size_for, texture
from texlab_core.contract.runs import Stop
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.run import run
from texlab_core.engine.sizes import default_size
from texlab_core.engine.streams import Streams
from texlab_core.errors import Cancelled, InputError
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from texlab_core.engine.registry import Method
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import Map, Step

each_method = pytest.mark.parametrize("method", METHODS, ids=IDS)
# Longest work between two steps at 128 x 128, in CPU seconds; the promise is 50 ms of wall time at 512 x 512.
LONGEST_GAP_S = 0.2


def watched(job: Any, **options: Any) -> tuple[Result, list[Step]]:
    """Run with a watcher that makes, checks and spoils every preview."""
    steps: list[Step] = []

    def watch(step: Step) -> None:
        steps.append(step)
        if step.preview is not None:
            preview = step.preview()
            assert_image(preview, (*job.picture_size, job.inputs["exemplar"].channels))
            if preview.flags.writeable:
                preview[:] = 0.5

    return run(job, watch, **options), steps


def assert_same_bits(one: Result, other: Result) -> None:
    np.testing.assert_array_equal(one.image, other.image)
    assert (one.volume is None) == (other.volume is None)
    if one.volume is not None:
        np.testing.assert_array_equal(one.volume, other.volume)
    assert one.maps.keys() == other.maps.keys()
    assert one.measures == other.measures
    assert one.notes == other.notes
    for name in one.maps:
        np.testing.assert_array_equal(one.maps[name].data, other.maps[name].data)
    for name in one.curves:
        np.testing.assert_array_equal(one.curves[name].y, other.curves[name].y)


@each_method
@pytest.mark.parametrize("channels", [1, 3])
def test_same_job_same_bits(method: Method, channels: int) -> None:
    exemplar = texture(30, 41, channels)
    plan = job(method, exemplar, size=(37, 22), seed=3)
    first = run(plan, threads=1)
    assert_same_bits(first, run(plan, threads=2))
    assert_same_bits(first, watched(plan)[0])
    cache = AnalysisCache()
    run(job(method, exemplar, size=(16, 16), seed=4), cache=cache)
    assert_same_bits(first, run(plan, cache=cache))
    assert_same_bits(first, run(plan, should_stop=lambda: False, cache=cache))


@each_method
def test_another_seed_gives_other_bits_unless_nothing_is_random(method: Method) -> None:
    # Larger than the exemplar: at its own size a method may rightly return the exemplar.
    one, other = (run(job(method, size=(40, 56), seed=seed)).image for seed in (0, 1))
    assert method.random == (one != other).any()


@each_method
def test_inputs_and_global_generators_stay_as_they_were(method: Method) -> None:
    exemplar = texture(24, 32)
    before = exemplar.pixels.copy()
    state = random.getstate(), str(np.random.get_state())  # noqa: NPY002
    result = run(job(method, exemplar))
    np.testing.assert_array_equal(exemplar.pixels, before)
    assert not exemplar.pixels.flags.writeable
    assert not np.shares_memory(result.image, exemplar.pixels)
    assert (random.getstate(), str(np.random.get_state())) == state  # noqa: NPY002


@each_method
def test_steps_tell_progress(method: Method) -> None:
    _, steps = watched(job(method, texture(40, 33)))
    for phase in ("analysis", "synthesis"):
        told = [step for step in steps if step.phase == phase]
        assert all(0 <= step.done <= step.total for step in told)
        assert all(a.fraction <= b.fraction for a, b in itertools.pairwise(told))
        assert all(a.done <= b.done for a, b in itertools.pairwise(told))
    synthesis = [step for step in steps if step.phase == "synthesis"]
    assert synthesis
    assert any(step.preview is not None for step in synthesis)
    for step in steps:
        assert step.stage
        assert "\n" not in step.stage
        assert step.frame is None or step.preview is not None
        assert all(np.isfinite(value) for value in step.metrics.values())


@each_method
def test_cancel_at_any_step_leaves_nothing_behind(method: Method) -> None:
    plan = job(method)
    result, steps = watched(plan)
    count = len(steps)
    for after in sorted({0, 1, 2, count // 2, count - 1, count}):
        stop = Stop(after)
        try:
            ended = run(plan, should_stop=stop)
        except Cancelled:
            continue
        # Some methods make more steps on a slower machine: what was never told to stop goes on to its end.
        assert not stop.told
        assert_same_bits(result, ended)
    assert_same_bits(result, run(plan))


@each_method
def test_generators_end_when_they_are_closed(method: Method) -> None:
    plan = job(method)
    model = run(plan).model
    streams = Streams(plan.seed)
    for steps in (
        method.analyze(plan.inputs, plan.params),
        method.synthesize(model, plan.inputs, plan.params, plan.size, streams),
    ):
        next(steps, None)
        # Raises RuntimeError when the generator goes on instead.
        steps.close()
        assert steps.gi_frame is None


@each_method
def test_work_between_steps_is_short(method: Method) -> None:
    plan = job(method, texture(128, 128))
    run(plan)
    gaps = []
    for _ in range(2):
        moments = [time.thread_time()]
        run(plan, lambda step, moments=moments: moments.append(time.thread_time()), threads=1)
        moments.append(time.thread_time())
        gaps.append(max(b - a for a, b in itertools.pairwise(moments)))
    assert min(gaps) < LONGEST_GAP_S


@each_method
@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("size", [(24, 32), (50, 17), (9, 64)])
def test_the_output_is_what_was_asked_for(method: Method, channels: int, size: tuple[int, int]) -> None:
    exemplar = texture(24, 32, channels)
    result = run(job(method, exemplar, size=size))
    assert_output(result, size_for(method, size), exemplar.pixels.shape)


def assert_output(result: Result, size: tuple[int, ...], exemplar: tuple[int, ...]) -> None:
    assert result.job.size == size
    assert_image(result.image, (*size[-2:], exemplar[2]))
    assert (result.volume is not None) == (len(size) == 3)
    if result.volume is not None:
        assert_image(result.volume, (*size, exemplar[2]))
        np.testing.assert_array_equal(result.image, result.volume[size[0] // 2])
    for name, each in result.maps.items():
        assert name == name.lower().replace(" ", "-").replace("_", "-")
        assert each.title
        assert_map(each, size, exemplar)
    for name, curve in result.curves.items():
        assert name == name.lower().replace(" ", "-").replace("_", "-")
        assert curve.title
        assert curve.x.shape == curve.y.shape
        assert np.isfinite(curve.x).all()
        assert np.isfinite(curve.y).all()
    assert all(np.isfinite(value) for value in result.measures.values())
    for note in result.notes:
        assert_sentence(note)


def assert_map(each: Map, size: tuple[int, ...], exemplar: tuple[int, ...]) -> None:
    assert each.plane.data.shape[:2] == size[-2:]
    if each.kind == "source":
        assert each.data.shape == (*size, 2)
        assert each.data.dtype == np.int32
        assert (each.data >= 0).all()
        assert (each.data < exemplar[:2]).all()
        return
    assert each.data.shape == size
    if each.kind == "count":
        assert np.issubdtype(each.data.dtype, np.integer)
        assert (each.data >= 0).all()
    else:
        assert each.data.dtype == {"label": np.int32, "scalar": np.float32}[each.kind]


ODD_EXEMPLARS = {
    "2x2": texture(2, 2),
    "2x9-gray": texture(2, 9, 1),
    "3x5": texture(3, 5),
    "7x7-gray": texture(7, 7, 1),
    "61x4": texture(61, 4),
    "13x31": texture(13, 31),
    "constant": as_exemplar(np.full((16, 16, 3), (0.2, 0.4, 0.6), np.float32)),
    "constant-gray": as_exemplar(np.full((16, 16), 0.5, np.float32)),
    "black": as_exemplar(np.zeros((9, 12), np.uint8)),
    "one-dot": as_exemplar(np.eye(1, 16 * 16, 100, dtype=np.float32).reshape(16, 16)),
    "two-colours": as_exemplar(np.where(np.indices((16, 16)).sum(0)[..., None] % 2, (1.0, 0, 0), (0, 0, 1.0))),
}


@each_method
@pytest.mark.parametrize("size", [None, (1, 1), (5, 3), (2, 40)], ids=str)
@pytest.mark.parametrize("name", ODD_EXEMPLARS)
def test_odd_inputs_work_or_are_refused_in_one_sentence(
    method: Method, name: str, size: tuple[int, int] | None
) -> None:
    exemplar = ODD_EXEMPLARS[name]
    try:
        result = run(job(method, exemplar, size=size))
    except InputError as error:
        assert_sentence(str(error))
        return
    expected = default_size(exemplar.size, method.dimensions) if size is None else size_for(method, size)
    assert_output(result, expected, exemplar.pixels.shape)


@pytest.mark.slow
@each_method
@settings(max_examples=25, phases=[Phase.generate], suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_every_setting_works_or_is_refused_in_one_sentence(method: Method, data: st.DataObject) -> None:
    params = data.draw(params_of(method))
    exemplar = texture(16, 13, data.draw(st.sampled_from([1, 3])))
    try:
        result = run(job(method, exemplar, params=params, size=(11, 18), seed=data.draw(st.integers(0, 9))))
    except InputError as error:
        assert_sentence(str(error))
        return
    assert_output(result, size_for(method, (11, 18)), exemplar.pixels.shape)
