"""Several processes on this machine.

They are those of ``concurrent.futures``. It is part of Python, starts in the time that imports take and opens no
port; joblib's pool does the same with one more library (its memory-mapped arguments are not needed, since inputs
travel by hash), and Dask's ``LocalCluster`` needs a scheduler and a supervisor for each process, which pay off
only where several machines share the work. What it lacks, going on after a process has died, is done here.
"""

from __future__ import annotations

import contextlib
import multiprocessing
import os
import shutil
import tempfile
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.batch import child
from texlab_core.batch.orders import Order, Outcome
from texlab_core.batch.parcels import Deposit
from texlab_core.batch.places import POLL_S
from texlab_core.batch.supply import Supply
from texlab_core.errors import Cancelled, InputError, ParamError
from texlab_core.files.regular import reason

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from multiprocessing.synchronize import Event

    from texlab_core.batch.parcels import Parcel
    from texlab_core.batch.places import Loaded, Outcomes, ShouldStop

MAX_PROCESSES = 256
# A process has the next order at hand while none takes longer; a long one would keep it from those who are idle.
SHORT_S = 3.0
# An order whose process died gets so many more, each alone, before it is given up.
CHANCES = 2
UNBORN = (
    "No process came so far as to begin its work; there may be too little memory for it, or the script that asks "
    'for processes does its work outside of if __name__ == "__main__", which each of them runs again.'
)
DIED = "The process that ran it ended without a word {} times; there may be too little memory for it."


class Processes:
    """Orders run in processes of their own, each of which keeps its last inputs and analyses.

    Parameters
    ----------
    count
        How many; None means one for each core.
    scratch
        Folder through which inputs reach them, removed at the end; None makes one for temporary files.
    """

    title = "local processes"

    def __init__(self, count: int | None = None, scratch: Path | None = None) -> None:
        count = (os.cpu_count() or 1) if count is None else count
        if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= MAX_PROCESSES:
            raise ParamError("processes", f"a whole number from 1 to {MAX_PROCESSES}", count)
        self.width = count
        self.scratch = scratch
        self._crew: _Crew | None = None
        self._keeps = False

    @contextlib.contextmanager
    def kept(self) -> Iterator[None]:
        """Keep the processes from one run to the next; see :meth:`texlab_core.batch.places.Place.kept`."""
        self._keeps = True
        try:
            yield
        finally:
            self._keeps = False
            if self._crew is not None:
                self._crew.end()
                self._crew = None

    def begin(self, jobs: int) -> None:
        """Start the processes now, for a run of so many jobs: they load while the first input is read."""
        if self._crew is None:
            self._crew = self._begin()
            self._crew.begin(jobs)

    def run(self, orders: Iterable[Loaded], should_stop: ShouldStop | None = None) -> Outcomes:
        """Carry orders out; see :meth:`texlab_core.batch.places.Place.run`."""
        crew, whole = self._crew or self._begin(), False
        self._crew = None
        try:
            yield from crew.outcomes(iter(orders), should_stop)
            whole = True
        finally:
            if whole and self._keeps:
                self._crew = crew
            else:
                crew.end()

    def _begin(self) -> _Crew:
        folder = Path(tempfile.mkdtemp(prefix="texlab-batch-")) if self.scratch is None else self.scratch
        return _Crew(self.width, _Drop(folder))


class _Crew:
    """Processes, each of which is a pool of its own: one that dies takes no other one's orders with it."""

    def __init__(self, width: int, drop: _Drop) -> None:
        self._drop = drop
        # A child of a program with threads must not be a copy of it.
        self._context = multiprocessing.get_context("spawn")
        try:
            self._stop: Event = self._context.Event()
            self._begun: Event = self._context.Event()
        except OSError as error:
            # A bare system may lack what processes share.
            raise InputError(f"No processes can be started here ({error.strerror}); use only one.") from error
        self._pools: list[ProcessPoolExecutor | None] = [None] * width

    def begin(self, jobs: int) -> None:
        """Start as many processes as so many jobs need, all at once."""
        # A pool starts its process with the first that is asked of it.
        for number in range(min(jobs, len(self._pools))):
            self._started(number).submit(child.be_ready)

    def outcomes(self, orders: Iterator[Loaded], should_stop: ShouldStop | None) -> Outcomes:
        supply = Supply(orders, len(self._pools))
        waiting: dict[Future[Outcome], tuple[Order, int]] = {}
        lost: list[Order] = []
        more, longest = True, 0.0
        while more or waiting or lost:
            if should_stop is not None and should_stop():
                raise Cancelled
            if lost and not waiting:
                for order in lost:
                    yield self._alone(order, should_stop)
                    self._drop.leave(order.parcels)
                lost = []
            while more and not lost:
                number = self._free([each for _, each in waiting.values()], 2 if 0 < longest < SHORT_S else 1)
                if number is None:
                    break
                loaded = supply.next(number)
                if loaded is None:
                    more = False
                    break
                order = loaded[0]
                self._drop.bring(loaded[1])
                try:
                    waiting[self._started(number).submit(child.carry_out, order)] = order, number
                except BrokenProcessPool:
                    self._lose(order, number, lost)
            for future in wait(waiting, POLL_S, FIRST_COMPLETED).done:
                order, number = waiting.pop(future)
                try:
                    outcome = future.result()
                except BrokenProcessPool:
                    self._lose(order, number, lost)
                    continue
                longest = max(longest, outcome.elapsed_s)
                yield outcome
                self._drop.leave(order.parcels)

    def _free(self, busy: list[int], depth: int) -> int | None:
        """Return the process with the fewest orders, when these are fewer than ``depth``."""
        number = min(range(len(self._pools)), key=busy.count)
        return number if busy.count(number) < depth else None

    def _started(self, number: int) -> ProcessPoolExecutor:
        pool = self._pools[number]
        if pool is None:
            pool = self._pools[number] = ProcessPoolExecutor(
                1,
                mp_context=self._context,
                initializer=child.start,
                initargs=(self._stop, self._begun, str(self._drop.folder)),
            )
        return pool

    def _lose(self, order: Order, number: int, lost: list[Order]) -> None:
        """Keep an order for another try; there is none where no process has ever begun."""
        if not self._begun.is_set():
            raise InputError(UNBORN)
        self._end([number])
        lost.append(order)

    def _alone(self, order: Order, should_stop: ShouldStop | None) -> Outcome:
        """Run an order that was lost with nothing beside it, so that it is clear which one kills its process."""
        for _ in range(CHANCES):
            future = self._started(0).submit(child.carry_out, order)
            try:
                while not wait([future], POLL_S).done:
                    if should_stop is not None and should_stop():
                        raise Cancelled
                return future.result()
            except BrokenProcessPool:
                self._end([0])
        return Outcome(order.key, error=DIED.format(CHANCES + 1))

    def _end(self, numbers: Iterable[int]) -> None:
        pools = [pool for number in numbers if (pool := self._pools[number]) is not None]
        if pools:
            # Side by side: each takes its time to end.
            with ThreadPoolExecutor(len(pools), thread_name_prefix="texlab-ends") as hands:
                list(hands.map(lambda pool: pool.shutdown(wait=True, cancel_futures=True), pools))
        self._pools = [None if pool in pools else pool for pool in self._pools]

    def end(self) -> None:
        """Stop what runs, at its next step, wait until every process has ended, and remove the inputs."""
        self._stop.set()
        self._end(range(len(self._pools)))
        shutil.rmtree(self._drop.folder, ignore_errors=True)


class _Drop(Deposit):
    """The folder where inputs lie while orders that need them are on their way."""

    def __init__(self, folder: Path) -> None:
        super().__init__()
        self.folder = folder

    def put(self, name: str, parcel: Parcel) -> None:
        temporary = self.folder / f"{name}.tmp"
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            with open(temporary, "wb") as file:
                arrays: dict[str, Any] = dict(parcel)
                np.savez(file, **arrays)
            os.replace(temporary, self._file(name))
        except OSError as error:
            raise InputError(f"{self.folder}: an input cannot be laid down there ({reason(error)}).") from error

    def remove(self, name: str) -> None:
        self._file(name).unlink(missing_ok=True)

    def _file(self, name: str) -> Path:
        return self.folder / f"{name}.npz"
