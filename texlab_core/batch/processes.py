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
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from texlab_core.batch import child
from texlab_core.batch.orders import Order, Outcome
from texlab_core.batch.parcels import Deposit
from texlab_core.batch.places import POLL_S
from texlab_core.errors import Cancelled, InputError, ParamError
from texlab_core.files.regular import reason

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from multiprocessing.synchronize import Event

    from texlab_core.batch.parcels import Parcel
    from texlab_core.batch.places import Loaded, Outcomes, ShouldStop

MAX_PROCESSES = 256
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

    def begin(self) -> None:
        """Start the processes now, for a run that is about to come: they load while the first input is read."""
        if self._crew is None:
            self._crew = self._begin()
            self._crew.begin()

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
    """A pool that is made again when one of its processes dies."""

    def __init__(self, width: int, drop: _Drop) -> None:
        self._width = width
        self._drop = drop
        # A child of a program with threads must not be a copy of it.
        self._context = multiprocessing.get_context("spawn")
        try:
            self._stop: Event = self._context.Event()
            self._begun: Event = self._context.Event()
        except OSError as error:
            # A bare system may lack what processes share.
            raise InputError(f"No processes can be started here ({error.strerror}); use only one.") from error
        self._pool: ProcessPoolExecutor | None = None

    def begin(self) -> None:
        """Start the processes, which load what jobs need."""
        # A pool starts its processes with the first that is asked of it.
        self._started().submit(child.be_ready)

    def outcomes(self, orders: Iterator[Loaded], should_stop: ShouldStop | None) -> Outcomes:
        waiting: dict[Future[Outcome], Order] = {}
        lost: list[Order] = []
        more = True
        while more or waiting or lost:
            if should_stop is not None and should_stop():
                raise Cancelled
            if lost and not waiting:
                self._renew()
                for order in lost:
                    yield self._alone(order, should_stop)
                    self._drop.leave(order.parcels)
                lost = []
            while more and not lost and len(waiting) < 2 * self._width:
                loaded = next(orders, None)
                if loaded is None:
                    more = False
                    break
                order = loaded[0]
                self._drop.bring(loaded[1])
                try:
                    waiting[self._submit(order)] = order
                except BrokenProcessPool:
                    self._lose(order, lost)
            for future in wait(waiting, POLL_S, FIRST_COMPLETED).done:
                order = waiting.pop(future)
                try:
                    outcome = future.result()
                except BrokenProcessPool:
                    self._lose(order, lost)
                    continue
                yield outcome
                self._drop.leave(order.parcels)

    def _submit(self, order: Order) -> Future[Outcome]:
        return self._started().submit(child.carry_out, order)

    def _started(self) -> ProcessPoolExecutor:
        if self._pool is None:
            self._pool = ProcessPoolExecutor(
                self._width,
                mp_context=self._context,
                initializer=child.start,
                initargs=(self._stop, self._begun, str(self._drop.folder)),
            )
        return self._pool

    def _lose(self, order: Order, lost: list[Order]) -> None:
        """Keep an order for another try; there is none where no process has ever begun."""
        if not self._begun.is_set():
            raise InputError(UNBORN)
        lost.append(order)

    def _alone(self, order: Order, should_stop: ShouldStop | None) -> Outcome:
        """Run an order that was lost with nothing beside it, so that it is clear which one kills its process."""
        for _ in range(CHANCES):
            future = self._submit(order)
            try:
                while not wait([future], POLL_S).done:
                    if should_stop is not None and should_stop():
                        raise Cancelled
                return future.result()
            except BrokenProcessPool:
                self._renew()
        return Outcome(order.key, error=DIED.format(CHANCES + 1))

    def _renew(self) -> None:
        if self._pool is not None:
            self._pool.shutdown(wait=True, cancel_futures=True)
            self._pool = None

    def end(self) -> None:
        """Stop what runs, at its next step, wait until every process has ended, and remove the inputs."""
        self._stop.set()
        self._renew()
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
