"""The one protocol for long work: a generator that yields every few milliseconds and returns its result.

What it yields is up to who asks: how much was worked (a :data:`Task`), a fraction, a Step. Stopping is the
caller's: whoever drives a generator closes it, or does not go on. :func:`finish` runs one to its end;
:func:`relay` and :func:`through` turn what one yields into what another yields; :func:`now_and_then` and
:class:`Pace` make fewer steps of many pieces; :func:`row_blocks` cuts arrays; :func:`crew` runs independent tasks
on several threads, with results that do not depend on how many.
"""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Generator
from concurrent.futures import Future, ThreadPoolExecutor
from concurrent.futures import TimeoutError as NotYet
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TypeVar

from texlab_core.errors import Cancelled
from texlab_core.work.threads import workers

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

ItemT = TypeVar("ItemT")
ResultT = TypeVar("ResultT")
StepT = TypeVar("StepT")
Task = Generator[int, None, ResultT]

# While threads work, the caller is asked this often whether to go on.
PATIENCE_S = 0.01


def go_on() -> None:
    """Do not stop."""


def finish(task: Generator[Any, None, ResultT], look: Callable[[], None] = go_on) -> ResultT:
    """Run a task to its end, here and at once; ``look`` is called between its pieces and may raise to stop."""
    while True:
        look()
        try:
            next(task)
        except StopIteration as end:
            result: ResultT = end.value
            return result


def relay(
    task: Generator[ItemT, None, ResultT], tell: Callable[[ItemT], StepT]
) -> Generator[StepT, None, ResultT]:
    """Yield ``tell(item)`` for every item that ``task`` yields, and return what it returns."""
    try:
        while True:
            item = next(task)
            yield tell(item)
    except StopIteration as end:
        result: ResultT = end.value
        return result
    finally:
        task.close()


def through(task: Generator[Any, None, ResultT], item: StepT) -> Generator[StepT, None, ResultT]:
    """Yield ``item`` whenever ``task`` yields, and return what it returns."""
    return relay(task, lambda _: item)


def now_and_then(
    task: Generator[Any, None, ResultT], seconds: float, make: Callable[[], StepT]
) -> Generator[StepT, None, ResultT]:
    """Run a task of many small pieces, yielding ``make()`` whenever ``seconds`` have passed."""
    begin = time.perf_counter()
    try:
        while True:
            next(task)
            if time.perf_counter() - begin > seconds:
                yield make()
                begin = time.perf_counter()
    except StopIteration as end:
        result: ResultT = end.value
        return result
    finally:
        task.close()


def row_blocks(shape: Sequence[int], samples: int = 2**19) -> list[slice]:
    """Cut an array into slices of rows with at most ``samples`` entries each (but at least one row)."""
    rows = max(1, samples // max(1, math.prod(shape[1:])))
    return [slice(start, min(start + rows, shape[0])) for start in range(0, shape[0], rows)]


def row_bounds(shape: Sequence[int], samples: int = 2**19) -> list[tuple[int, int]]:
    """Return (first, last) of the slices of :func:`row_blocks`, for kernels."""
    return [(rows.start, rows.stop) for rows in row_blocks(shape, samples)]


class Pace:
    """Turns work into steps: one for every ``stride`` units of work, and one whenever a task waits for threads."""

    def __init__(self, stride: int) -> None:
        self._stride = stride
        self._work = 0

    def steps(self, task: Task[ResultT], make: Callable[[int], StepT]) -> Generator[StepT, None, ResultT]:
        """Run a task; ``make`` gets the work done since the last step."""
        while True:
            try:
                work = next(task)
            except StopIteration as end:
                result: ResultT = end.value
                return result
            self._work += work
            if self._work >= self._stride or not work:
                done, self._work = self._work, 0
                yield make(done)


class Crew:
    """Threads that work on tasks; made by :func:`crew`."""

    def __init__(self, pool: ThreadPoolExecutor | None, stop: threading.Event, ahead: int) -> None:
        self._pool, self._stop, self._ahead = pool, stop, ahead

    def in_order(
        self, tasks: Iterable[Task[ResultT]], accept: Callable[[ResultT], Iterable[int]]
    ) -> Generator[int, None, None]:
        """Run tasks side by side and accept their results one by one, in the order of the tasks.

        Parameters
        ----------
        tasks
            They must not touch what others or ``accept`` write.
        accept
            Called in the calling thread; returns how much it works, in pieces (a generator, or an empty tuple).

        Yields
        ------
        int
            Work done since the last time, as the tasks count it; 0 while waiting.
        """
        if self._pool is None:
            for task in tasks:
                yield from accept((yield from task))
            return
        waiting: deque[Future[tuple[ResultT, int]]] = deque()
        for task in tasks:
            waiting.append(self._pool.submit(self._drive, task))
            if len(waiting) > self._ahead:
                yield from self._next(waiting, accept)
        while waiting:
            yield from self._next(waiting, accept)

    def _next(
        self, waiting: deque[Future[tuple[ResultT, int]]], accept: Callable[[ResultT], Iterable[int]]
    ) -> Generator[int, None, None]:
        future = waiting.popleft()
        while True:
            try:
                result, work = future.result(PATIENCE_S)
                break
            except NotYet:
                yield 0
        yield work
        yield from accept(result)

    def _drive(self, task: Task[ResultT]) -> tuple[ResultT, int]:
        work = 0
        try:
            while not self._stop.is_set():
                work += next(task)
        except StopIteration as end:
            return end.value, work
        finally:
            task.close()
        raise Cancelled


@contextmanager
def crew() -> Iterator[Crew]:
    """Provide as many threads as :func:`texlab_core.work.threads.workers` says; one is the caller's own.

    When the block is left, tasks that are still running end at their next yield.
    """
    count = workers()
    if count == 1:
        yield Crew(None, threading.Event(), 0)
        return
    stop = threading.Event()
    pool = ThreadPoolExecutor(count, thread_name_prefix="texlab-task")
    try:
        yield Crew(pool, stop, 2 * count)
    finally:
        stop.set()
        pool.shutdown(wait=True, cancel_futures=True)
