"""A Dask cluster: one that is running, or one started on this machine.

A parcel is the result of a task of its own, named by its hash: it goes to the scheduler once, from there to a
worker, and from worker to worker. Unlike scattered data it can be made again when the worker that holds it is
lost, so that nothing but the jobs that ran on that worker is run again.
"""

from __future__ import annotations

import contextlib
import functools
import importlib.util
import queue
import threading
import time
from typing import TYPE_CHECKING, Any

from texlab_core.batch.orders import Order, Outcome, Workbench
from texlab_core.batch.parcels import Deposit
from texlab_core.batch.places import POLL_S
from texlab_core.errors import Cancelled, InputError, ParamError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from texlab_core.batch.parcels import Parcel
    from texlab_core.batch.places import Loaded, Outcomes, ShouldStop

MAX_WORKERS = 256
CONNECT_S = 10
COUNT_S = 2.0
# What a future says when nothing more will come.
OVER = ("finished", "error", "cancelled")
DIED = "The workers that ran it ended without a word several times; there may be too little memory for it."


class Cluster:
    """Orders run on the workers of a Dask cluster.

    Parameters
    ----------
    address
        Of a scheduler (``tcp://host:8786``); ``local`` or ``local:N`` starts one with N workers (one for each
        core) on this machine, for as long as the orders take.

    Raises
    ------
    InputError
        When the address has another form, or Dask is not installed (``pip install texlab[cluster]``).
    """

    def __init__(self, address: str) -> None:
        self.address = address
        self.title = f"the cluster {address}"
        self._local = _local_workers(address)
        self.width = self._local or 1
        if importlib.util.find_spec("distributed") is None:
            raise InputError("A cluster needs Dask, which is not installed: pip install texlab[cluster].")
        self._client: Any = None

    @contextlib.contextmanager
    def kept(self) -> Iterator[None]:
        """Stay connected from one run to the next; see :meth:`texlab_core.batch.places.Place.kept`."""
        with contextlib.ExitStack() as stack:
            self._client = self._connect(stack)
            try:
                yield
            finally:
                self._client = None

    def run(self, orders: Iterable[Loaded], should_stop: ShouldStop | None = None) -> Outcomes:
        """Carry orders out; see :meth:`texlab_core.batch.places.Place.run`.

        Raises
        ------
        InputError
            When the scheduler cannot be reached.
        """
        with contextlib.ExitStack() as stack:
            client = self._client or self._connect(stack)
            yield from _Shipping(client, self._count_workers).outcomes(iter(orders), should_stop)

    def _connect(self, stack: contextlib.ExitStack) -> Any:
        import dask
        import distributed

        # Exemplars are large, and they go to the scheduler on purpose.
        stack.enter_context(dask.config.set({"distributed.admin.large-graph-warning-threshold": "4 GB"}))
        target: Any = self.address
        if self._local:
            target = stack.enter_context(
                distributed.LocalCluster(
                    n_workers=self._local,
                    threads_per_worker=1,
                    processes=True,
                    dashboard_address=None,
                    host="127.0.0.1",
                )
            )
        try:
            return stack.enter_context(distributed.Client(target, timeout=CONNECT_S, set_as_default=False))
        except (OSError, ValueError) as error:
            raise InputError(f"The cluster {self.address} cannot be reached ({error}).") from error

    def _count_workers(self, client: Any) -> int:
        self.width = max(1, sum(client.nthreads().values()))
        return self.width


def _local_workers(address: str) -> int:
    """Return how many workers to start here; 0 for a cluster that is there."""
    name, _, count = address.partition(":")
    if name != "local":
        if "://" not in address:
            raise ParamError("cluster", "an address as in tcp://host:8786, local, or local:N", address)
        return 0
    if not count and ":" not in address:
        import os

        return os.cpu_count() or 1
    if not count.isascii() or not count.isdigit() or not 1 <= int(count[:4]) <= MAX_WORKERS:
        raise ParamError("cluster", f"local:N with N from 1 to {MAX_WORKERS}", address)
    return int(count)


class _Shipping:
    """Orders on their way to the workers and back."""

    def __init__(self, client: Any, count_workers: Callable[[Any], int]) -> None:
        self._client = client
        self._count_workers = count_workers
        self._arrived: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._waiting: dict[str, tuple[Any, Order]] = {}
        # Results that went down with the worker that had them: the cluster makes them again.
        self._lost: list[Any] = []
        self._parcels = _Sent(client)

    def outcomes(self, orders: Iterator[Loaded], should_stop: ShouldStop | None) -> Outcomes:
        more, room, counted = True, 0, 0.0
        try:
            while more or self._waiting:
                if should_stop is not None and should_stop():
                    raise Cancelled
                if not room or time.monotonic() - counted > COUNT_S:
                    # Workers come and go.
                    room, counted = 2 * self._count_workers(self._client), time.monotonic()
                self._look_after_the_lost()
                while more and len(self._waiting) < room:
                    loaded = next(orders, None)
                    if loaded is None:
                        more = False
                        break
                    self._send(*loaded)
                with contextlib.suppress(queue.Empty):
                    outcome = self._receive(self._arrived.get(timeout=POLL_S))
                    if outcome is not None:
                        yield outcome
        finally:
            if self._waiting:
                # What waits never starts; what runs asks at each step whether it was cancelled.
                self._client.cancel([future for future, _ in self._waiting.values()])

    def _send(self, order: Order, parcels: Mapping[str, Parcel]) -> None:
        self._parcels.bring(parcels)
        held = {name: self._parcels.futures[name] for name in order.parcels}
        # Another program may ask the same cluster for the same job, and for something else of its result.
        key = f"texlab-job-{order.key}-{self._client.id}"
        future = self._client.submit(_carry_out, order, list(held), *held.values(), key=key)
        self._waiting[key] = (future, order)
        future.add_done_callback(self._arrived.put)

    def _look_after_the_lost(self) -> None:
        lost, self._lost = self._lost, []
        for future in lost:
            if future.status in OVER:
                self._arrived.put(future)
            else:
                self._lost.append(future)

    def _receive(self, future: Any) -> Outcome | None:
        """Return what became of an order; None when its worker is gone, and it has to be made again."""
        if future.status not in OVER:
            self._lost.append(future)
            return None
        _, order = self._waiting.pop(future.key)
        self._parcels.leave(order.parcels)
        if future.status == "finished":
            outcome: Outcome = future.result()
            return outcome
        if future.status == "cancelled":
            raise InputError("The connection to the cluster was lost; run the batch again to go on.")
        error = future.exception()
        if type(error).__name__ == "KilledWorker":
            return Outcome(order.key, error=DIED)
        why = f"{type(error).__name__}: {' '.join(str(error).split())}"
        return Outcome(order.key, error=f"The cluster could not run it ({why}).")


class _Sent(Deposit):
    """The parcels at the cluster: each is the result of a task, and there as long as its future is held."""

    def __init__(self, client: Any) -> None:
        super().__init__()
        self._client = client
        self.futures: dict[str, Any] = {}

    def put(self, name: str, parcel: Parcel) -> None:
        self.futures[name] = self._client.submit(_keep, dict(parcel), key=f"texlab-parcel-{name}")

    def remove(self, name: str) -> None:
        del self.futures[name]


def _keep(parcel: Mapping[str, Any]) -> Mapping[str, Any]:
    """Be the task whose result is a parcel."""
    return parcel


@functools.cache
def _bench() -> Workbench:
    """Return what this worker keeps between orders."""
    return Workbench()


_lock = threading.Lock()


def _carry_out(order: Order, names: list[str], *parcels: Mapping[str, Any]) -> Outcome:
    with _lock:
        bench = _bench()
    return bench.carry_out(order, dict(zip(names, parcels, strict=True)), _was_cancelled())


def _was_cancelled() -> Callable[[], bool]:
    """Return what tells whether the task that runs in this thread is still wanted."""
    import distributed
    from distributed.worker import thread_state

    tasks, key = distributed.get_worker().state.tasks, thread_state.key

    def cancelled() -> bool:
        task = tasks.get(key)
        return task is None or task.state == "cancelled"

    return cancelled
