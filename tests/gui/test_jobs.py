"""Background workers: the newest request wins, every request ends once, nothing stale arrives."""

from __future__ import annotations

import threading
from typing import TYPE_CHECKING, Any

import pytest
import shiboken6

from texlab.runs.errands import Errands
from texlab.runs.slots import Rank, Slots
from texlab.runs.worker import Task, Worker
from texlab_core.errors import Cancelled, InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator


@pytest.fixture
def make_worker(qapp: Any) -> Iterator[Callable[..., tuple[Worker, list[tuple[str, Any]]]]]:
    """Return a function that makes a worker and a record of everything that it tells."""
    made: list[Worker] = []

    def make(slots: Slots | None = None) -> tuple[Worker, list[tuple[str, Any]]]:
        worker = Worker(f"test-{len(made)}", slots)
        made.append(worker)
        told: list[tuple[str, Any]] = []
        worker.progressed.connect(lambda value: told.append(("progressed", value)))
        worker.finished.connect(lambda value: told.append(("finished", value)))
        worker.failed.connect(lambda value: told.append(("failed", value)))
        worker.cancelled.connect(lambda: told.append(("cancelled", None)))
        return worker, told

    yield make
    for worker in made:
        worker.close()
        worker.deleteLater()


def until_stopped(started: threading.Event) -> Callable[[Task], None]:
    def work(task: Task) -> None:
        started.set()
        while not task.should_stop():
            threading.Event().wait(0.001)
        raise Cancelled

    return work


def test_the_newest_of_many_requests_is_the_only_one_told(qtbot: Any, make_worker: Any) -> None:
    worker, told = make_worker()
    started = threading.Event()
    worker.submit(until_stopped(started))
    assert started.wait(60)
    ran = []
    for number in range(50):
        worker.submit(lambda task, number=number: ran.append(number) or number)
    qtbot.waitUntil(lambda: ("finished", 49) in told, timeout=10_000)
    assert told == [("finished", 49)]
    # Requests that were replaced while they waited never ran.
    assert ran[-1] == 49
    assert worker.generation == 51


def test_a_result_that_was_replaced_on_its_way_is_dropped(qtbot: Any, make_worker: Any) -> None:
    worker, told = make_worker()
    done = threading.Event()

    def first(task: Task) -> str:
        done.set()
        return "first"

    worker.submit(first)
    assert done.wait(60)
    # The event of the first result waits in the queue of this thread, which has not looked yet.
    worker.submit(lambda task: "second")
    qtbot.waitUntil(lambda: ("finished", "second") in told, timeout=10_000)
    assert told == [("finished", "second")]


def test_progress_is_the_newest_and_comes_before_the_end(qtbot: Any, make_worker: Any) -> None:
    worker, told = make_worker()

    def work(task: Task) -> str:
        for number in range(1000):
            task.progress(number)
        return "end"

    worker.submit(work)
    qtbot.waitUntil(lambda: ("finished", "end") in told, timeout=10_000)
    numbers = [value for kind, value in told if kind == "progressed"]
    assert numbers == sorted(numbers)
    assert numbers[-1] == 999
    assert told[-1] == ("finished", "end")


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (InputError("size: must be at least 1, got 0."), "size: must be at least 1, got 0."),
        (OSError("the disk is full"), "the disk is full"),
        (MemoryError(), "There is not enough memory"),
        (KeyError("inner"), "KeyError: 'inner'. The log has the details."),
    ],
)
def test_a_failure_is_one_sentence_and_the_worker_lives_on(
    qtbot: Any, make_worker: Any, error: Exception, sentence: str
) -> None:
    worker, told = make_worker()

    def fail(task: Task) -> None:
        raise error

    worker.submit(fail)
    qtbot.waitUntil(lambda: bool(told), timeout=10_000)
    assert told[0][0] == "failed"
    assert sentence in told[0][1]
    assert "Traceback" not in told[0][1]
    worker.submit(lambda task: 7)
    qtbot.waitUntil(lambda: ("finished", 7) in told, timeout=10_000)
    assert len(told) == 2


def test_a_cancel_ends_once_and_frees_the_worker(qtbot: Any, make_worker: Any) -> None:
    worker, told = make_worker()
    started = threading.Event()
    worker.submit(until_stopped(started))
    assert started.wait(60)
    worker.cancel()
    qtbot.waitUntil(lambda: not worker.busy, timeout=10_000)
    worker.cancel()
    worker.submit(lambda task: 1)
    qtbot.waitUntil(lambda: ("finished", 1) in told, timeout=10_000)
    assert told == [("cancelled", None), ("finished", 1)]


def test_busy_lasts_until_the_end_is_told(qtbot: Any, make_worker: Any) -> None:
    worker, told = make_worker()
    idle: list[list[tuple[str, Any]]] = []
    worker.idle.connect(lambda: idle.append(list(told)) or (worker.busy and idle.append([])))
    worker.submit(lambda task: "end")
    while worker.occupied:
        threading.Event().wait(0.001)
    # This thread has not looked at its queue yet.
    assert worker.busy
    assert told == []
    qtbot.waitUntil(lambda: not worker.busy, timeout=10_000)
    assert idle == [[("finished", "end")]]


def test_a_cancel_while_the_result_is_on_its_way_is_told(qtbot: Any, make_worker: Any) -> None:
    worker, told = make_worker()
    worker.submit(lambda task: "too late")
    while worker.occupied:
        threading.Event().wait(0.001)
    worker.cancel()
    qtbot.waitUntil(lambda: not worker.busy, timeout=10_000)
    assert told == [("cancelled", None)]


def test_a_cancel_after_the_end_was_told_says_nothing(qtbot: Any, make_worker: Any) -> None:
    worker, told = make_worker()
    worker.finished.connect(lambda value: worker.cancel())
    worker.submit(lambda task: "end")
    qtbot.waitUntil(lambda: not worker.busy and bool(told), timeout=10_000)
    assert told == [("finished", "end")]


def test_what_comes_first_takes_no_place_and_can_be_cancelled(qtbot: Any, make_worker: Any) -> None:
    slots = Slots(1)
    (waiting, told), (running, others) = make_worker(slots), make_worker(slots)
    begun = threading.Event()
    waiting.submit(lambda task: "never", first=until_stopped(begun))
    assert begun.wait(60)
    running.submit(lambda task: "ran", first=lambda task: None)
    qtbot.waitUntil(lambda: told != [] or others == [("finished", "ran")], timeout=10_000)
    waiting.cancel()
    qtbot.waitUntil(lambda: not waiting.busy, timeout=10_000)
    assert told == [("cancelled", None)]
    waiting.submit(lambda task: "later")
    qtbot.waitUntil(lambda: ("finished", "later") in told, timeout=10_000)


def test_no_more_run_than_there_are_places(qtbot: Any, make_worker: Any) -> None:
    slots = Slots(1)
    (first, first_told), (second, second_told) = make_worker(slots), make_worker(slots)
    started = threading.Event()
    first.submit(until_stopped(started))
    assert started.wait(60)
    ran = threading.Event()
    second.submit(lambda task: ran.set())
    qtbot.waitUntil(lambda: bool(slots._waiting))
    assert not ran.is_set()
    first.cancel()
    qtbot.waitUntil(lambda: bool(second_told), timeout=10_000)
    assert ran.is_set()
    assert first_told == [("cancelled", None)]


def test_one_that_waits_for_a_place_can_be_cancelled(qtbot: Any, make_worker: Any) -> None:
    slots = Slots(1)
    (first, _), (second, told) = make_worker(slots), make_worker(slots)
    started = threading.Event()
    first.submit(until_stopped(started))
    assert started.wait(60)
    second.submit(lambda task: "never")
    second.cancel()
    qtbot.waitUntil(lambda: not second.busy, timeout=10_000)
    assert told == [("cancelled", None)]
    first.cancel()


def in_order(slots: Slots, ranks: list[Rank], told: list[Rank]) -> list[threading.Thread]:
    """Start a thread for each rank that waits for a place, one after the other."""
    threads = []
    for rank in ranks:

        def work(rank: Rank = rank) -> None:
            with slots.place(lambda: False, rank):
                told.append(rank)

        threads.append(threading.Thread(target=work))
        waiting = len(slots._waiting)
        threads[-1].start()
        while len(slots._waiting) == waiting:
            threading.Event().wait(0.001)
    return threads


def test_lower_ranks_go_first_and_equals_in_their_order() -> None:
    slots = Slots(1)
    told: list[Rank] = []
    assert slots.acquire(lambda: False)
    wanted = [Rank.REST, Rank.CHANGED, Rank.DRAFT, Rank.CHANGED, Rank.REST]
    threads = in_order(slots, wanted, told)
    slots.release()
    for thread in threads:
        thread.join(60)
    assert told == sorted(wanted)


def test_what_runs_gives_way_to_lower_ranks_only_and_goes_on_before_its_equals() -> None:
    slots = Slots(1)
    told: list[Rank] = []
    with slots.place(lambda: False, Rank.CHANGED):
        threads = in_order(slots, [Rank.CHANGED, Rank.REST], told)
        assert slots.give_way(lambda: False, Rank.CHANGED) == 0
        assert told == []
        threads += in_order(slots, [Rank.DRAFT], told)
        assert slots.give_way(lambda: False, Rank.CHANGED) > 0
        assert told == [Rank.DRAFT]
    for thread in threads:
        thread.join(60)
    assert told == [Rank.DRAFT, Rank.CHANGED, Rank.REST]


def test_a_cancel_while_giving_way_loses_no_place() -> None:
    slots = Slots(1)
    told: list[Rank] = []
    with slots.place(lambda: False):
        threads = in_order(slots, [Rank.DRAFT], told)
        with pytest.raises(Cancelled):
            slots.give_way(lambda: True)
        # It is held until the end of the block.
        assert told == []
    for thread in threads:
        thread.join(60)
    assert told == [Rank.DRAFT]
    # One place, no more and no less.
    assert slots.acquire(lambda: False)
    assert not slots.acquire(lambda: True)
    assert slots._free == 0


def test_closing_stops_what_runs(make_worker: Any) -> None:
    worker, told = make_worker()
    started = threading.Event()
    worker.submit(until_stopped(started))
    assert started.wait(60)
    worker.close()
    assert not any(thread.name == "texlab-test-0" for thread in threading.enumerate())
    assert told == []


def test_a_thread_that_could_not_be_stopped_in_time_ends_quietly(qapp: Any, caplog: Any) -> None:
    worker = Worker("stubborn")
    started, hold = threading.Event(), threading.Event()

    def work(task: Task) -> None:
        started.set()
        assert hold.wait(60)
        task.progress(1)

    worker.submit(work)
    assert started.wait(60)
    thread = next(each for each in threading.enumerate() if each.name == "texlab-stubborn")
    worker.close(timeout_s=0.01)
    assert "did not end within" in caplog.text
    # Its Qt half goes first; an exception in the thread would fail this test.
    shiboken6.delete(worker)
    hold.set()
    thread.join(60)
    assert not thread.is_alive()


def test_what_is_being_written_is_waited_for(qapp: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Worker.close, "__defaults__", (0.01,))
    begun, go_on = threading.Event(), threading.Event()
    written: list[str] = []

    def write(task: Task) -> None:
        begun.set()
        assert go_on.wait(60)
        written.append("all of it")

    errands = Errands()
    errands.run("save", write)
    assert begun.wait(60)
    threading.Timer(0.2, go_on.set).start()
    errands.close()
    assert written == ["all of it"]


def test_all_is_idle_only_after_the_last_errand(qtbot: Any) -> None:
    go_on = threading.Event()
    idle: list[tuple[str, ...]] = []
    errands = Errands()
    errands.idle.connect(lambda: idle.append(errands.names))
    errands.run("slow", lambda task: go_on.wait(60))
    errands.run("quick", lambda task: None)
    qtbot.waitUntil(lambda: errands.names == ("slow",))
    assert (idle, errands.busy) == ([], True)
    go_on.set()
    qtbot.waitUntil(lambda: bool(idle))
    assert (idle, errands.busy) == ([()], False)
    errands.close()


def test_the_thread_comes_with_the_first_request(qtbot: Any, make_worker: Any) -> None:
    names = {each.name for each in threading.enumerate()}
    (worker, told), (unused, _) = make_worker(), make_worker()
    assert {each.name for each in threading.enumerate()} <= names
    assert worker.ended
    worker.cancel()
    assert told == []
    worker.submit(lambda task: 7)
    qtbot.waitUntil(lambda: told == [("finished", 7)])
    assert not worker.ended
    # One that nobody ever asked ends as well, and takes nothing more.
    unused.finish()
    unused.close()
    unused.submit(lambda task: pytest.fail("It was closed."))
    assert unused.ended
