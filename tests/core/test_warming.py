"""Loading beforehand."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from tests.stub_method import know, stub  # noqa: F401
from texlab_core import warming
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, InputError
from texlab_core.kernels import ranks
from texlab_core.kernels.jit import stoppable_compiling
from texlab_core.warming import Need, Warmth, every_need, load, load_once, warm_up

PATIENCE_S = 60.0
A, B, C = Need("a", 3), Need("b", 3), Need("c", 1)


def never() -> bool:
    return False


def channels(job) -> int:
    return job.inputs["exemplar"].channels


def test_every_method_is_run_in_gray_and_in_colour(monkeypatch):
    seen = []

    def watched(job, **more):
        seen.append((job.method, channels(job), job.params))
        return run(job, **more)

    monkeypatch.setattr(warming, "run", watched)
    assert warm_up() == every_need()
    runs = [
        (name, channels, params)
        for name, method in methods().items()
        for channels in (1, 3)
        for params in (method.params(), *method.rehearsals)
    ]
    # Then what tabs ask of a result.
    asked = {name for name, method in methods().items() if method.questions or method.dimensions == 3}
    assert asked >= {"de-bonet", "efros-leung", "solid"}
    assert seen == [*runs, *((name, 3, method.params()) for name, method in methods().items() if name in asked)]


def test_it_stops_at_once():
    assert warm_up(lambda: True) == ()


# Every choice and the ends of every range, in a process whose kernels are those that loading has loaded. What a
# size decides is seen at the parameters that a method starts with; the others take less of the exemplar.
NOTHING_ELSE = """
import gc, numpy as np
from numba.core.dispatcher import Dispatcher
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.engine.params import describe
from texlab_core.kernels import ranks
from texlab_core.kernels.jit import stoppable_compiling
from texlab_core.engine.registry import methods
from texlab_core.engine.run import run
from texlab_core.engine.job import Job
from texlab_core.solids.rendering import View, render
from texlab_core.warming import warm_up

def loaded():
    kernels = [each for each in gc.get_objects() if isinstance(each, Dispatcher)]
    return {(each.__module__, each.__qualname__, str(types)) for each in kernels for types in each.overloads}

warm_up()
before = loaded()
assert before
pixels = np.random.default_rng(0).random((70, 90, 3), np.float32)

def sizes(dimensions, whole):
    if dimensions == 3:
        return (20, 24, 28), (9, 32, 20)
    return ((70, 90), (80, 64)) if whole else ((37, 45), (48, 32))

for method in methods().values():
    variants = [method.params()]
    for field in describe(method.params):
        ends = () if field.name == "iterations" else (field.knob.low, field.knob.high)
        values = field.choices or ((False, True) if field.kind == "bool" else ends)
        for value in values:
            try:
                variants.append(method.params().replace(**{field.name: value}))
            except (InputError, TypeError):
                continue
    for channels in (3, 1):
        for params in variants:
            whole = params == variants[0]
            exemplar = as_exemplar(pixels[: 70 if whole else 37, : 90 if whole else 45, :channels])
            for size in sizes(method.dimensions, whole):
                inputs = {spec.name: exemplar for spec in method.inputs if spec.required} | {"exemplar": exemplar}
                try:
                    result = run(Job(method=method.id, inputs=inputs, params=params, size=size), threads=1)
                except InputError:
                    continue
                for question in method.questions:
                    question(result)
                if result.volume is not None:
                    render(result.volume, View("torus"), (9, 12), smooth=True)
        if method.draft is not None:
            method.draft(inputs, method.params(), size, 1)
    print(method.id, sorted(loaded() - before))
    assert loaded() <= before, method.id
"""


@pytest.mark.slow
def test_no_run_needs_another_kernel():
    done = subprocess.run([sys.executable, "-c", NOTHING_ELSE], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


# The order of loading, and who waits.


class Loader:
    """Loads what it is allowed to, and keeps the order; a need that nobody allows takes for ever."""

    def __init__(self) -> None:
        self.started: list[Need] = []
        self.abandoned: list[Need] = []
        self.done: list[Need] = []
        self.allowed: dict[Need, threading.Event] = {need: threading.Event() for need in (A, B, C)}
        self.begun: dict[Need, threading.Event] = {need: threading.Event() for need in (A, B, C)}

    def __call__(self, need, should_stop):
        self.started.append(need)
        self.begun[need].set()
        while not self.allowed[need].wait(0.001):
            if should_stop():
                self.abandoned.append(need)
                raise Cancelled
        self.done.append(need)


@pytest.fixture
def loader():
    return Loader()


@pytest.fixture
def warmth(loader):
    """What is loaded by another thread."""
    warmth = Warmth(loader)
    thread = threading.Thread(target=warmth.serve)
    thread.start()
    yield warmth
    warmth.close()
    thread.join(PATIENCE_S)
    assert not thread.is_alive()


def test_whoever_waits_goes_on_when_it_is_loaded(warmth, loader):
    with ThreadPoolExecutor() as threads:
        waiting = threads.submit(warmth.wait, A, never)
        assert loader.begun[A].wait(PATIENCE_S)
        assert not waiting.done()
        assert not warmth.is_warm(A)
        loader.allowed[A].set()
        waiting.result(PATIENCE_S)
    assert warmth.is_warm(A)
    warmth.wait(A, never)
    assert loader.done == [A]


def test_whoever_waits_can_be_stopped_while_loading_goes_on_for_ever(warmth, loader):
    stop = threading.Event()
    with ThreadPoolExecutor() as threads:
        waiting = threads.submit(warmth.wait, A, stop.is_set)
        assert loader.begun[A].wait(PATIENCE_S)
        stop.set()
        with pytest.raises(Cancelled):
            waiting.result(PATIENCE_S)
        # Nobody waits for it any more, so that another one gets its turn.
        loader.allowed[B].set()
        threads.submit(warmth.wait, B, never).result(PATIENCE_S)
    assert loader.abandoned == [A]
    assert not warmth.is_warm(A)


def test_what_is_waited_for_comes_before_what_is_wished_for(warmth, loader):
    warmth.wish((C, A, B))
    assert loader.begun[C].wait(PATIENCE_S)
    with ThreadPoolExecutor() as threads:
        waiting = threads.submit(warmth.wait, B, never)
        assert loader.begun[B].wait(PATIENCE_S)
        for allowed in loader.allowed.values():
            allowed.set()
        waiting.result(PATIENCE_S)
        for need in (A, B, C):
            threads.submit(warmth.wait, need, never).result(PATIENCE_S)
    assert loader.started[:2] == [C, B]
    assert loader.abandoned == [C]
    assert loader.done[0] == B
    assert sorted(loader.done) == [A, B, C]


def test_the_newest_wish_comes_first_and_the_earlier_ones_later(warmth, loader):
    warmth.wish((C,))
    assert loader.begun[C].wait(PATIENCE_S)
    warmth.wish((A, B))
    assert loader.begun[A].wait(PATIENCE_S)
    for allowed in loader.allowed.values():
        allowed.set()
    for need in (A, B, C):
        warmth.wait(need, never)
    assert loader.abandoned == [C]
    assert sorted(loader.done) == [A, B, C]


def test_nobody_waits_once_it_is_closed(warmth, loader):
    with ThreadPoolExecutor() as threads:
        waiting = threads.submit(warmth.wait, A, never)
        assert loader.begun[A].wait(PATIENCE_S)
        warmth.close()
        waiting.result(PATIENCE_S)
    warmth.wait(B, never)
    assert loader.done == []


@pytest.mark.parametrize("error", [InputError("Too small."), RuntimeError("No code.")])
def test_a_failure_lets_the_run_try_itself(error, caplog):
    def fail(need, should_stop):
        raise error

    warmth = Warmth(fail)
    thread = threading.Thread(target=warmth.serve)
    thread.start()
    warmth.wait(A, never)
    assert warmth.is_warm(A)
    assert ("failed" in caplog.text) == isinstance(error, RuntimeError)
    warmth.close()
    thread.join(PATIENCE_S)
    assert not thread.is_alive()


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_nobody_waits_for_a_thread_that_has_ended():
    def crash(need, should_stop):
        raise SystemExit

    warmth = Warmth(crash)
    thread = threading.Thread(target=warmth.serve)
    thread.start()
    warmth.wait(A, never)
    thread.join(PATIENCE_S)
    assert not thread.is_alive()
    warmth.wait(B, never)


def test_a_method_is_loaded_with_its_rehearsals(stub, monkeypatch):  # noqa: F811
    seen = []
    monkeypatch.setattr(warming, "run", lambda job, **_: seen.append(job.params))
    load(Need("stub", 1))
    load(Need("car", 3))
    assert seen == [
        stub.params(),
        *(methods()["car"].params(synthesis=each) for each in ("spectrum", "recursion")),
    ]


def test_what_the_process_has_in_memory_is_not_loaded_again(stub, monkeypatch):  # noqa: F811
    seen = []
    monkeypatch.setattr(warming, "_LOADED", {})
    monkeypatch.setattr(warming, "run", lambda job, **_: seen.append((job.method, channels(job))))
    for need in (Need("stub", 1), Need("stub", 3), Need("stub", 1), Need("stub", 3)):
        load_once(need)
    assert seen == [("stub", 1), ("stub", 3)]
    # Whoever says so loads it all the same, and a method that takes another's name is another one.
    load(Need("stub", 1))
    assert len(seen) == 3
    know(monkeypatch, {"stub": dataclasses.replace(stub, title="Another")})
    load_once(Need("stub", 1))
    assert len(seen) == 4


def test_what_was_stopped_or_refused_is_not_in_memory(stub, monkeypatch):  # noqa: F811
    tries = []

    def refuse(job, **_):
        tries.append(job.method)
        raise (Cancelled, InputError("Too small."))[len(tries) % 2]

    monkeypatch.setattr(warming, "_LOADED", {})
    monkeypatch.setattr(warming, "run", refuse)
    for error in (InputError, Cancelled):
        with pytest.raises(error):
            load_once(Need("stub", 3))
    assert tries == ["stub", "stub"]


def test_a_second_window_finds_what_the_first_has_loaded(stub, monkeypatch):  # noqa: F811
    seen = []
    monkeypatch.setattr(warming, "_LOADED", {})
    monkeypatch.setattr(warming, "run", lambda job, **_: seen.append(job.method))
    for _ in range(2):
        warmth = Warmth()
        thread = threading.Thread(target=warmth.serve)
        thread.start()
        warmth.wait(Need("stub", 3), never)
        warmth.close()
        thread.join(PATIENCE_S)
        assert not thread.is_alive()
    assert seen == ["stub"]


def test_kernels_that_only_large_planes_need_are_loaded_too(monkeypatch):
    called = set()
    names = ["count", "starts", "scatter_first", "scatter_next", "shuffle_ties", "assign"]
    for name in names:
        kernel = getattr(ranks, name)
        monkeypatch.setattr(
            ranks, name, lambda *given, name=name, kernel=kernel: (called.add(name), kernel(*given))[1]
        )
    load(Need("heeger-bergen", 1))
    assert called == set(names)


def test_compiling_stops_between_two_passes():
    import numba
    from numba.core import event

    @numba.njit
    def inner(value):
        return value + 1

    @numba.njit
    def kernel(values):
        total = 0.0
        for value in values:
            total += inner(value)
        return total

    passes = []

    class Counting(event.Listener):
        def on_start(self, event):
            passes.append(event.data["name"])

        def on_end(self, event):
            pass

    asked = []

    def after_some():
        asked.append(None)
        return len(asked) > 5

    numbers = np.arange(4.0)
    with event.install_listener("numba:run_pass", Counting()):
        with pytest.raises(Cancelled), stoppable_compiling(after_some):
            kernel(numbers)
        stopped = len(passes)
        assert stopped <= 6
        # Outside nobody is asked, and what was begun is compiled from the start.
        assert kernel(numbers) == 10.0
    assert len(passes) > stopped + 6
    assert len(asked) == 6


def test_another_thread_compiles_on():
    import numba

    kernel = numba.njit(lambda value: value * 2)
    with ThreadPoolExecutor() as threads, stoppable_compiling(lambda: True):
        assert threads.submit(kernel, 3).result(PATIENCE_S) == 6
