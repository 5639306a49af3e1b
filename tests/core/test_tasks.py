"""Tasks side by side: order, equality with one thread, errors, and an end that leaves no thread behind."""

from __future__ import annotations

import threading
import time

import pytest

from texlab_core.work.tasks import Pace, crew, finish, now_and_then, relay, row_blocks, through
from texlab_core.work.threads import use_workers


def task(number, pieces=3, pause=0.0):
    for _ in range(pieces):
        time.sleep(pause)
        yield 10
    return number


def collect(count, tasks):
    found = []

    def accept(result):
        found.append(result)
        yield 1

    with use_workers(count), crew() as team:
        work = sum(team.in_order(tasks, accept))
    return found, work


@pytest.mark.parametrize("count", [1, 2, 3])
def test_results_come_in_the_order_of_the_tasks_and_the_work_adds_up(count):
    # The first tasks take longest.
    tasks = (task(number, pause=0.002 * (number < 3)) for number in range(12))
    assert collect(count, tasks) == (list(range(12)), 12 * 31)
    assert collect(count, iter(())) == ([], 0)


@pytest.mark.parametrize("count", [1, 2])
def test_an_error_in_a_task_comes_out_and_the_threads_end(count):
    def failing():
        yield 1
        raise ZeroDivisionError("here")

    before = threading.active_count()
    with pytest.raises(ZeroDivisionError, match="here"):
        collect(count, iter([task(0), failing(), task(1)]))
    assert threading.active_count() == before


@pytest.mark.parametrize("count", [1, 2])
def test_leaving_stops_running_tasks_and_closes_them(count):
    closed = []

    def endless(number):
        try:
            while True:
                time.sleep(0.001)
                yield 1
        finally:
            closed.append(number)

    before = threading.active_count()

    def caller():
        with crew() as team:
            yield from team.in_order((endless(number) for number in range(9)), lambda _: ())

    with use_workers(count):
        generator = caller()
        next(generator)
        generator.close()
    assert threading.active_count() == before
    assert sorted(closed) == list(range(count))


def test_a_pace_makes_a_step_for_every_stride_and_whenever_it_waits():
    def work():
        yield from (4, 4, 4, 0, 1, 20)
        return "end"

    def all_steps():
        returned.append((yield from Pace(10).steps(work(), lambda done: done)))

    returned = []
    assert list(all_steps()) == [12, 0, 21]
    assert returned == ["end"]


def test_finish_returns_what_a_task_returns():
    assert finish(task(7)) == 7


@pytest.mark.parametrize("shape", [(10,), (10, 4), (3, 100), (0, 5), (7, 0)])
def test_blocks_cover_every_row_once(shape):
    blocks = row_blocks(shape, 8)
    assert [row for block in blocks for row in range(block.start, block.stop)] == list(range(shape[0]))
    rest = 1
    for side in shape[1:]:
        rest *= side
    assert all(block.stop - block.start == 1 or (block.stop - block.start) * rest <= 8 for block in blocks)


def test_finish_looks_before_every_piece_and_can_be_stopped():
    class Stop(Exception):
        pass

    pieces, looks = [], []

    def work():
        for piece in range(5):
            pieces.append(piece)
            yield 1

    def look():
        looks.append(len(pieces))
        if len(pieces) == 3:
            raise Stop

    with pytest.raises(Stop):
        finish(work(), look)
    assert looks == [0, 1, 2, 3]


def counting(closed: list[str]):
    try:
        yield 1
        yield 2
    finally:
        closed.append("closed")
    return "done"


def test_what_one_yields_is_turned_into_what_another_yields() -> None:
    closed: list[str] = []
    relayed = relay(counting(closed), lambda item: item * 10)
    assert [next(relayed), next(relayed)] == [10, 20]
    with pytest.raises(StopIteration) as end:
        next(relayed)
    assert end.value.value == "done"
    assert finish(through(counting(closed), "same")) == "done"


def test_a_relayed_task_is_closed_with_what_relays_it() -> None:
    closed: list[str] = []
    for relayed in (relay(counting(closed), str), now_and_then(counting(closed), -1.0, lambda: 0)):
        next(relayed)
        relayed.close()
    assert closed == ["closed", "closed"]


def test_many_pieces_make_a_step_now_and_then() -> None:
    assert list(now_and_then(counting([]), -1.0, lambda: "step")) == ["step", "step"]
    quiet = now_and_then(counting([]), 1e9, lambda: "step")
    with pytest.raises(StopIteration) as end:
        next(quiet)
    assert end.value.value == "done"
