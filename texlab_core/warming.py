"""Loading what is loaded late (compiled kernels, transforms) before anybody waits for it.

The first run of a method in a process imports, and loads or even compiles, what it needs in one piece that nobody
can stop: half a second, or many when nothing has been compiled on this machine yet. So one thread does that for
all others with :meth:`Warmth.serve`, and whoever is about to run a method waits for it with :meth:`Warmth.wait`,
which can be stopped at any moment.
"""

from __future__ import annotations

import logging
import threading
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from texlab_core.engine.job import Job
from texlab_core.engine.registry import EXEMPLAR, find_method, methods
from texlab_core.engine.run import run
from texlab_core.engine.streams import Streams
from texlab_core.errors import Cancelled, InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.kernels.jit import stoppable_compiling
from texlab_core.stats import histogram

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from texlab_core.engine.inputs import Input
    from texlab_core.engine.registry import Method
    from texlab_core.engine.result import Result

log = logging.getLogger(__name__)

SIDES = (48, 48)
# Another size than the exemplar's, short and long: some methods take a short cut where sizes agree or are small.
OUTPUT = (32, 72)
DEPTH = 8
# Whoever waits asks this often whether to go on.
PATIENCE_S = 0.01
# What this process has in memory, whoever loaded it.
_LOADED: dict[Need, Method] = {}


class Need(NamedTuple):
    """What a run needs in memory: kernels are compiled by the types of their arguments."""

    method: str
    channels: int
    questions: bool = False
    """Not the run, but what tabs ask of its result."""


def every_need() -> tuple[Need, ...]:
    """Return what the registered methods need for gray and for coloured exemplars, then what tabs ask for."""
    runs = (Need(name, channels) for name in methods() for channels in (1, 3))
    asked = (name for name, method in methods().items() if method.questions or method.dimensions == 3)
    return (*runs, *(Need(name, 3, questions=True) for name in asked))


def load(need: Need, should_stop: Callable[[], bool] | None = None) -> None:
    """Run a method once on a tiny exemplar, and once more with each of its rehearsals; forget the results.

    Where that is needed, what tabs ask of a result is asked of the first one instead.

    Raises
    ------
    Cancelled
        When ``should_stop`` said so, between two steps of a run or two passes of the compiler.
    """
    method = find_method(need.method)
    exemplar = as_exemplar(Streams(0)("warm up").random((*SIDES, need.channels), np.float32))
    inputs: dict[str, Input] = {EXEMPLAR.name: exemplar}
    inputs |= {spec.name: exemplar for spec in method.inputs if spec.required and spec.kind == "image"}
    size = (*(DEPTH,) * (method.dimensions - 2), *OUTPUT)
    with stoppable_compiling(should_stop):
        for params in (method.params(), *(() if need.questions else method.rehearsals)):
            job = Job(method=method.id, inputs=inputs, params=params, size=size)
            result = run(job, should_stop=should_stop, threads=1)
            if need.questions:
                _ask(method, result)
        # Large planes are sorted in pieces, by kernels that no tiny run needs.
        histogram.warm_up()
    _LOADED[need] = method


def _ask(method: Method, result: Result) -> None:
    for question in method.questions:
        question(result)
    if result.volume is not None:
        from texlab_core.solids.rendering import View, render

        render(result.volume, View(), (DEPTH, DEPTH))


def load_once(need: Need, should_stop: Callable[[], bool] | None = None) -> None:
    """Do as :func:`load` does, unless this process has loaded the same method before; raise what it raises."""
    if _LOADED.get(need) is not find_method(need.method):
        load(need, should_stop)


def warm_up(should_stop: Callable[[], bool] | None = None) -> tuple[Need, ...]:
    """Load for every method in gray and in colour; return what was loaded until ``should_stop`` said so."""
    done: list[Need] = []
    for need in every_need():
        try:
            load(need, should_stop)
        except Cancelled:
            break
        except InputError:
            # A method that cannot use such an exemplar loads its kernels when it is used.
            continue
        done.append(need)
    return tuple(done)


class Warmth:
    """What is in memory, what is waited for, and the order in which the rest is loaded.

    Parameters
    ----------
    load
        ``load(need, should_stop)`` does the loading; a second window of a process finds what the first has loaded.
    """

    def __init__(self, load: Callable[[Need, Callable[[], bool]], None] = load_once) -> None:
        self._load = load
        self._warm: set[Need] = set()
        # One entry for everybody who waits, the longest waiting first.
        self._waited: list[Need] = []
        self._wished: tuple[Need, ...] = ()
        self._closed = False
        self._changed = threading.Condition()

    def is_warm(self, need: Need) -> bool:
        """Whether a run with this need starts without waiting."""
        with self._changed:
            return self._closed or need in self._warm

    def wait(self, need: Need, should_stop: Callable[[], bool]) -> None:
        """Return when a need is in memory, or will not be: loading failed, or nobody loads any more.

        Raises
        ------
        Cancelled
            When ``should_stop`` said so.
        """
        with self._changed:
            self._waited.append(need)
            self._changed.notify_all()
            try:
                while not (self._closed or need in self._warm):
                    if should_stop():
                        raise Cancelled
                    self._changed.wait(PATIENCE_S)
            finally:
                self._waited.remove(need)

    def wish(self, needs: Iterable[Need]) -> None:
        """Load these while nobody waits for others, before what was wished for earlier."""
        with self._changed:
            self._wished = tuple(dict.fromkeys((*needs, *self._wished)))
            self._changed.notify_all()

    def serve(self) -> None:
        """Load in this thread until :meth:`close`: what is waited for first, then what is wished for."""
        try:
            while (need := self._await_need()) is not None:
                self._serve_one(need)
        finally:
            # Whoever still waits goes on without.
            self.close()

    def close(self) -> None:
        """Stop loading (between two steps of it) and let everybody go."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def _serve_one(self, need: Need) -> None:
        try:
            # Nobody waits any more, or somebody waits for another one: what is compiled by then stays.
            self._load(need, lambda: self._next() != need)
        except Cancelled:
            return
        except InputError as error:
            log.info("%s is loaded when it is first run: %s", need.method, error)
        except Exception:
            log.exception("Loading %s failed; its first run tries again.", need.method)
        with self._changed:
            self._warm.add(need)
            self._changed.notify_all()

    def _await_need(self) -> Need | None:
        with self._changed:
            while (need := self._next()) is None and not self._closed:
                self._changed.wait()
            return need

    def _next(self) -> Need | None:
        with self._changed:
            if self._closed:
                return None
            return next((need for need in (*self._waited, *self._wished) if need not in self._warm), None)
