"""Jobs are checked before they run; streams depend on their name only; run() ends exactly once."""

from __future__ import annotations

import itertools
import threading
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.core.toy import Log, NoiseParams, noise_method, stock
from texlab_core.engine import registry
from texlab_core.engine.cache import AnalysisCache, array_bytes
from texlab_core.engine.inputs import DataInput, ImageInput
from texlab_core.engine.job import MAX_SEED, Job, check_size
from texlab_core.engine.params import Params
from texlab_core.engine.registry import InputSpec
from texlab_core.engine.run import run
from texlab_core.engine.streams import Streams
from texlab_core.errors import Cancelled, InputError, ParamError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.version import __version__
from texlab_core.work.threads import sums_in_one_thread, use_workers, workers

if TYPE_CHECKING:
    from texlab_core.engine.steps import Step


@pytest.fixture
def log(monkeypatch: pytest.MonkeyPatch) -> Log:
    """Register the toy method for one test."""
    log = Log()
    stock(monkeypatch, registry._METHODS, noise_method(log), _pair_method())
    return log


def _pair_method() -> Any:
    def check(inputs: Any, params: Any, size: tuple[int, int]) -> None:
        if size[0] > 100:
            raise InputError("Toy pair makes at most 100 rows.")

    code = InputSpec("code", "Some numbers.", kind="data", required=False)
    return noise_method(id="toy-pair", title="Toy pair", inputs=(registry.EXEMPLAR, code), check=check)


@pytest.fixture
def exemplar() -> ImageInput:
    values = np.linspace(0.25, 0.75, 12 * 10 * 3, dtype=np.float32)
    return as_exemplar(values.reshape(12, 10, 3))


def job(exemplar: ImageInput, **changes: Any) -> Job:
    return Job(**({"method": "toy-noise", "inputs": {"exemplar": exemplar}} | changes))


def test_the_result_is_the_closed_form(log: Log, exemplar: ImageInput) -> None:
    result = run(job(exemplar, seed=5, size=(7, 8)))
    noise = Streams(5)("noise", 2).random((7, 8, 3), dtype=np.float32)
    mean = float(exemplar.pixels.astype(np.float64).mean())
    np.testing.assert_array_equal(result.image, np.clip(mean + 0.25 * (noise - 0.5), 0, 1).astype(np.float32))
    assert result.model == mean
    assert result.job.size == (7, 8)
    assert result.versions["texlab"] == __version__
    assert result.versions["numpy"] == np.__version__
    assert result.elapsed_s > 0
    assert log.analyzed == log.closed == 1


def test_defaults_are_the_exemplars_size_seed_0_and_default_params(log: Log, exemplar: ImageInput) -> None:
    made = job(exemplar)
    assert (made.size, made.seed, made.params) == ((12, 10), 0, NoiseParams())


def test_steps_arrive_in_order_with_their_phase(log: Log, exemplar: ImageInput) -> None:
    seen: list[Step] = []
    run(job(exemplar), seen.append)
    assert [(step.phase, step.done, step.total) for step in seen] == [
        *[("analysis", 0, 1), ("analysis", 1, 1)],
        *[("synthesis", 1, 3), ("synthesis", 2, 3), ("synthesis", 3, 3)],
    ]
    assert [step.fraction for step in seen[2:]] == [1 / 3, 2 / 3, 1.0]


def test_watching_changes_no_bit(log: Log, exemplar: ImageInput) -> None:
    def watch(step: Step) -> None:
        if step.preview is not None:
            step.preview()[:] = 0

    np.testing.assert_array_equal(run(job(exemplar)).image, run(job(exemplar), watch).image)


@pytest.mark.parametrize("after", range(6))
def test_cancel_raises_and_closes_the_generator(log: Log, exemplar: ImageInput, after: int) -> None:
    asked = 0

    def should_stop() -> bool:
        nonlocal asked
        asked += 1
        return asked > after

    with pytest.raises(Cancelled):
        run(job(exemplar), should_stop=should_stop)
    assert log.closed == (1 if after > 3 else 0)


def test_a_watcher_that_fails_closes_the_generator(log: Log, exemplar: ImageInput) -> None:
    def watch(step: Step) -> None:
        if step.phase == "synthesis":
            raise RuntimeError("watcher")

    with pytest.raises(RuntimeError, match="watcher"):
        run(job(exemplar), watch)
    assert log.closed == 1


@pytest.mark.parametrize("error", [StopIteration, GeneratorExit, RuntimeError, KeyboardInterrupt])
@pytest.mark.parametrize("after", [0, 1, 3])
def test_what_should_stop_raises_comes_through(
    log: Log, exemplar: ImageInput, error: type[BaseException], after: int
) -> None:
    asked = itertools.count()

    def should_stop() -> bool:
        if next(asked) >= after:
            raise error
        return False

    cache = AnalysisCache()
    with pytest.raises(error):
        run(job(exemplar), should_stop=should_stop, cache=cache)
    # The analysis asks three times and is kept only when it came to its end.
    assert (cache.get(job(exemplar).analysis_key) is None) == (after < 3)


def test_a_callback_that_runs_out_is_no_result(log: Log, exemplar: ImageInput) -> None:
    def watch(step: Step) -> None:
        next(iter(()))

    with pytest.raises(StopIteration):
        run(job(exemplar), watch)


def test_the_analysis_is_kept_while_what_it_depends_on_stays(log: Log, exemplar: ImageInput) -> None:
    cache = AnalysisCache()
    first = run(job(exemplar), cache=cache)
    again = run(job(exemplar, params=NoiseParams(spread=0.5), seed=3, size=(4, 4)), cache=cache)
    assert log.analyzed == 1
    assert again.model == first.model
    run(job(exemplar, params=NoiseParams(power=2)), cache=cache)
    other = as_exemplar(1 - exemplar.pixels)
    run(job(other), cache=cache)
    assert log.analyzed == 3
    np.testing.assert_array_equal(run(job(exemplar), cache=cache).image, first.image)
    cache.clear()
    run(job(exemplar), cache=cache)
    assert log.analyzed == 4


def test_a_cancelled_analysis_is_not_kept(log: Log, exemplar: ImageInput) -> None:
    cache = AnalysisCache()
    with pytest.raises(Cancelled):
        run(job(exemplar), should_stop=lambda: log.analyzed > 0, cache=cache)
    assert cache.get(job(exemplar).analysis_key) is None


def test_the_cache_drops_what_was_not_used_for_longest() -> None:
    cache = AnalysisCache(2)
    cache.put(("a",), 1)
    cache.put(("b",), 2)
    assert cache.get(("a",)) == 1
    cache.put(("c",), 3)
    assert [cache.get((name,)) for name in "abc"] == [1, None, 3]


@dataclass(frozen=True, slots=True)
class Model:
    planes: tuple[Any, ...]
    table: dict[str, Any]


def test_the_bytes_of_a_model_are_those_of_its_arrays() -> None:
    plane = np.zeros((10, 10), np.float32)
    model = Model((plane, plane, [plane[:2], None]), {"codes": np.zeros(7, np.uint8), "name": "x" * 1000})
    assert array_bytes(model) == 400 + 7
    assert array_bytes(np.frombuffer(b"12345678", np.float32)) == 8
    loop: list[Any] = [plane]
    loop.append(loop)
    assert array_bytes(loop) == 400


def test_the_cache_keeps_within_its_bytes_but_always_the_newest() -> None:
    cache = AnalysisCache(max_bytes=1000)
    models = [Model((np.zeros(400, np.uint8),), {}) for _ in range(3)]
    for index, model in enumerate(models[:2]):
        cache.put((index,), model)
    assert cache.get((0,)) is models[0]
    cache.put((2,), models[2])
    # The second one was not used for longest.
    assert [cache.get((index,)) for index in range(3)] == [models[0], None, models[2]]
    cache.put((2,), models[1])
    assert cache.get((0,)) is models[0]
    huge = Model((np.zeros(5000, np.uint8),), {})
    cache.put((3,), huge)
    assert cache.get((3,)) is huge
    assert cache.get((0,)) is cache.get((2,)) is None
    cache.clear()
    cache.put((0,), models[0])
    assert cache.get((0,)) is models[0]


def test_what_cannot_run_is_refused_before_it_runs(log: Log, exemplar: ImageInput) -> None:
    code = DataInput([1, 2], "code")
    for changes, words in [
        ({"method": "toy-nose"}, "did you mean toy-noise"),
        ({"params": Params()}, "takes NoiseParams, got Params"),
        ({"inputs": {}}, "needs the input exemplar"),
        ({"inputs": {"exemplar": code}}, "exemplar: must be an input of kind image, got DataInput"),
        ({"inputs": {"exemplar": exemplar, "mask": exemplar}}, "one of exemplar for Toy noise, got 'mask'"),
        ({"seed": -1}, "seed: must be a whole number from 0 to 2147483647, got -1"),
        ({"seed": MAX_SEED + 1}, "seed"),
        ({"seed": True}, "seed"),
        ({"seed": 1.0}, "seed"),
        ({"size": (0, 5)}, "size: must be height and width of at least 1 pixel"),
        ({"size": (5,)}, "size"),
        ({"size": 5}, "size"),
        ({"size": (5.0, 5)}, "size"),
        ({"size": (8193, 8192)}, "64 megapixels"),
        ({"method": "toy-pair", "size": (101, 5)}, "at most 100 rows"),
    ]:
        with pytest.raises(InputError) as caught:
            job(exemplar, **changes)
        assert words in str(caught.value)
        assert str(caught.value).endswith(".")
    assert log.analyzed == 0


def test_optional_inputs_are_taken_and_change_the_key(log: Log, exemplar: ImageInput) -> None:
    code = DataInput([1, 2], "code")
    without = job(exemplar, method="toy-pair")
    given = job(exemplar, method="toy-pair", inputs={"exemplar": exemplar, "code": code})
    assert without.analysis_key != given.analysis_key
    with pytest.raises(TypeError):
        given.inputs["code"] = code  # type: ignore[index]


def test_size_takes_numpy_integers() -> None:
    assert check_size([np.int64(3), np.uint8(4)]) == (3, 4)
    assert check_size((8192, 8192)) == (8192, 8192)


@given(st.integers(0, MAX_SEED), st.text(max_size=5), st.lists(st.integers(0, 99), max_size=3))
def test_a_stream_is_a_function_of_seed_name_and_index(seed: int, name: str, index: list[int]) -> None:
    drawn = Streams(seed)(name, *index).random(4)
    np.testing.assert_array_equal(Streams(seed)(name, *index).random(4), drawn)
    assert Streams(seed).key(name, *index) == Streams(seed).key(name, *index)
    assert 0 <= Streams(seed).key(name, *index) < 2**64
    for other in (
        Streams(seed ^ 1)(name, *index),
        Streams(seed)(name + "x", *index),
        Streams(seed)(name, *index, 0),
    ):
        assert (other.random(4) != drawn).all()


def test_streams_do_not_depend_on_the_order_of_asking() -> None:
    streams = Streams(7)
    first = [streams("a").random(), streams("b").random()]
    second = [streams("b").random(), streams("a").random()]
    assert first == second[::-1]
    assert first[0] != first[1]


def test_streams_are_unrelated() -> None:
    draws = np.stack([Streams(1)("noise", i).standard_normal(4000) for i in range(8)])
    correlation = np.corrcoef(draws) - np.eye(8)
    # The largest of 28 correlations of 4000 draws stays below 5 sd = 5 / sqrt(4000).
    assert np.abs(correlation).max() < 5 / np.sqrt(4000)


def test_the_number_of_threads_is_set_within_the_run_only(exemplar: ImageInput, log: Log) -> None:
    seen = []
    assert workers() == 1
    run(job(exemplar), lambda step: seen.append(workers()), threads=2)
    assert set(seen) == {2}
    assert workers() == 1
    with use_workers(None):
        assert 1 <= workers() <= 2


def test_sums_are_taken_in_one_thread_until_the_last_one_leaves() -> None:
    import cv2  # noqa: F401
    import scipy.linalg  # noqa: F401
    from threadpoolctl import threadpool_info, threadpool_limits

    def counts() -> set[int]:
        return {each["num_threads"] for each in threadpool_info() if each["user_api"] == "blas"}

    with threadpool_limits(2, "blas"):
        before = counts()
        first, second = sums_in_one_thread(), sums_in_one_thread()
        first.__enter__()
        second.__enter__()
        assert counts() == {1}, "libraries that SciPy and OpenCV bring count too"
        first.__exit__(None, None, None)
        assert counts() == {1}
        second.__exit__(None, None, None)
        assert counts() == before


def test_the_number_of_threads_belongs_to_its_thread() -> None:
    seen = []
    with use_workers(2):
        thread = threading.Thread(target=lambda: seen.append(workers()))
        thread.start()
        thread.join()
    assert seen == [1]


def test_param_errors_are_input_errors(log: Log, exemplar: ImageInput) -> None:
    with pytest.raises(ParamError) as caught:
        job(exemplar, seed="x")
    assert caught.value.field == "seed"
