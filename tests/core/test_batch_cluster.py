"""What goes to a cluster and comes back, with a client that works at once: inputs once, losses in one sentence."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.core.batch_tools import shape_of
from texlab_core.batch import cluster
from texlab_core.batch.orders import Outcome, make_order
from texlab_core.batch.parcels import Packer
from texlab_core.engine.inputs import Crop
from texlab_core.engine.job import Job
from texlab_core.errors import Cancelled, InputError
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


class KilledWorker(Exception):
    """As Dask calls it."""


class Future:
    """A result that is there already."""

    def __init__(self, key: str, value: Any, status: str = "finished") -> None:
        self.key, self.value, self.status = key, value, status

    def result(self) -> Any:
        return self.value

    def exception(self) -> Any:
        return self.value

    def add_done_callback(self, call: Callable[[Future], None]) -> None:
        call(self)


class Client:
    """Runs what it gets at once; remembers what was sent, and what was cancelled."""

    id = "client"

    def __init__(self, outcome: Callable[[Any], tuple[Any, str]] | None = None) -> None:
        self.sent: list[str] = []
        self.cancelled: list[str] = []
        self.outcome = outcome

    def nthreads(self) -> dict[str, int]:
        return {"one": 1, "two": 1}

    def submit(self, function: Any, *given: Any, key: str) -> Future:
        self.sent.append(key)
        if self.outcome is not None and key.startswith("texlab-job"):
            value, status = self.outcome(given[0])
            return Future(key, value, status)
        return Future(key, function(*[each.value if isinstance(each, Future) else each for each in given]))

    def cancel(self, futures: list[Future]) -> None:
        self.cancelled += [future.key for future in futures]


@pytest.fixture(autouse=True)
def here(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Be the worker."""
    monkeypatch.setattr(cluster, "_was_cancelled", lambda: lambda: False)
    yield
    cluster._bench.cache_clear()


def orders(count: int) -> Iterator[Any]:
    """Yield jobs on crops of two images, one image after the other."""
    packer = Packer()
    for image in range(2):
        pixels = np.random.Generator(np.random.PCG64(image)).random((20, 20, 3), np.float32)
        whole = as_exemplar(pixels)
        for place in range(count // 2):
            exemplar = as_exemplar(whole, crop=Crop(place, 0, 8, 8))
            yield make_order(Job(method="tiling", inputs={"exemplar": exemplar}, size=(4, 5)), shape_of, packer)


def ship(client: Client, given: Any, should_stop: Any = None) -> list[Outcome]:
    place = cluster.Cluster("tcp://127.0.0.1:1")
    return list(cluster._Shipping(client, place._count_workers).outcomes(iter(given), should_stop))


def test_a_source_goes_to_the_cluster_once_for_all_its_jobs() -> None:
    client = Client()
    outcomes = ship(client, orders(12))
    assert len(outcomes) == 12
    assert {each.value[0] for each in outcomes} == {(4, 5, 3)}
    parcels = [key for key in client.sent if key.startswith("texlab-parcel-")]
    assert len(parcels) == len(set(parcels)) == 2
    assert len(client.sent) == 2 + 12
    assert client.cancelled == []


def test_a_kept_cluster_is_connected_once(monkeypatch: pytest.MonkeyPatch) -> None:
    place, connected = cluster.Cluster("tcp://127.0.0.1:1"), []

    def connect(stack: Any) -> Client:
        connected.append(Client())
        return connected[-1]

    monkeypatch.setattr(place, "_connect", connect)
    with place.kept():
        first, second = (list(place.run(orders(4))) for _ in range(2))
    assert [each.value for each in first] == [each.value for each in second]
    assert len(connected) == 1
    assert len(list(place.run(orders(2)))) == 2
    assert len(connected) == 2


def test_sources_that_nobody_needs_any_more_are_let_go() -> None:
    place = cluster.Cluster("tcp://127.0.0.1:1")
    shipping = cluster._Shipping(Client(), place._count_workers)
    held = [len(shipping._parcels) for _ in shipping.outcomes(orders(24), None)]
    assert max(held) <= 2
    assert held[-1] == 1
    assert place.width == 2


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (KilledWorker("job"), "The workers that ran it ended without a word several times"),
        (ImportError("no\nmodule"), "The cluster could not run it (ImportError: no module)."),
    ],
)
def test_what_goes_wrong_there_is_one_sentence(error: Exception, sentence: str) -> None:
    outcomes = ship(Client(lambda order: (error, "error")), orders(4))
    assert len(outcomes) == 4
    assert all(each.error.startswith(sentence) for each in outcomes)


def test_a_lost_connection_ends_the_batch() -> None:
    with pytest.raises(InputError, match="connection to the cluster was lost; run the batch again"):
        ship(Client(lambda order: (None, "cancelled")), orders(4))


def test_a_result_that_is_lost_with_its_worker_is_waited_for() -> None:
    lost: list[Future] = []

    class Losing(Client):
        def submit(self, function: Any, *given: Any, key: str) -> Future:
            future = super().submit(function, *given, key=key)
            if key.startswith("texlab-job") and len(lost) < 3:
                future.status = ("lost", "pending", "lost")[len(lost)]
                lost.append(future)
            return future

    asked = []

    def stop() -> bool:
        # Made again after a while.
        asked.append(None)
        if len(asked) > 6:
            for future in lost:
                future.status = "finished"
        return False

    outcomes = ship(Losing(), orders(12), stop)
    assert len(outcomes) == len({each.key for each in outcomes}) == 12
    assert {each.error for each in outcomes} == {""}


def test_stopping_cancels_what_waits() -> None:
    client = Client()
    asked = []

    def stop() -> bool:
        asked.append(None)
        return len(asked) > 2

    with pytest.raises(Cancelled):
        ship(client, orders(12), stop)
    assert client.cancelled
    assert all(key.startswith("texlab-job-") for key in client.cancelled)


def test_a_cluster_that_cannot_be_reached_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    import distributed

    def refuse(*given: Any, **options: Any) -> Any:
        raise OSError("Timed out")

    monkeypatch.setattr(distributed, "Client", refuse)
    with pytest.raises(InputError, match=r"^The cluster tcp://127.0.0.1:1 cannot be reached \(Timed out\)\.$"):
        list(cluster.Cluster("tcp://127.0.0.1:1").run(orders(2)))
