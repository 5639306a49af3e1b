"""Jobs of one exemplar stay with one process, nothing is given twice or left, and nothing is read long before."""

from __future__ import annotations

import dataclasses
from collections import defaultdict
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tests.core.batch_tools import shape_of
from texlab_core.batch.orders import make_order
from texlab_core.batch.parcels import Slip
from texlab_core.batch.processes import Processes
from texlab_core.batch.running import run_jobs
from texlab_core.batch.supply import AHEAD, Supply
from texlab_core.engine.job import Job
from texlab_core.images.exemplar import as_exemplar

if TYPE_CHECKING:
    from collections.abc import Iterator

    from texlab_core.batch.places import Loaded


def loaded(exemplar: int, seed: int) -> Loaded:
    image = np.full((6, 6), exemplar / 64, np.float32)
    return make_order(
        Job(method="tiling", inputs={"exemplar": as_exemplar(image)}, size=(4, 4), seed=seed), shape_of
    )


def given(exemplars: int, seeds: int, takers: int, draw: int) -> tuple[list[tuple[int, str]], list[int], int]:
    """Hand a plan out to takers that ask at random; return (taker, exemplar), what was read, all jobs."""
    orders = [loaded(exemplar, seed) for exemplar in range(exemplars) for seed in range(seeds)]
    read = 0

    def supply() -> Iterator[Loaded]:
        nonlocal read
        for order in orders:
            read += 1
            yield order

    found, reads, keys = [], [], []
    rng = np.random.Generator(np.random.PCG64(draw))
    stock = Supply(supply(), takers)
    while True:
        taker = int(rng.integers(takers))
        one = stock.next(taker)
        if one is None:
            break
        found.append((taker, one[0].subject))
        keys.append(one[0].key)
        reads.append(read)
    assert all(stock.next(taker) is None for taker in range(takers))
    assert sorted(keys) == sorted(order.key for order, _ in orders), "each once"
    return found, reads, len(orders)


@pytest.mark.parametrize("draw", range(5))
@pytest.mark.parametrize(("exemplars", "seeds", "takers"), [(12, 6, 2), (20, 1, 2), (12, 5, 3), (30, 2, 4)])
def test_an_exemplar_has_one_process_until_the_end_is_near(
    exemplars: int, seeds: int, takers: int, draw: int
) -> None:
    found, reads, count = given(exemplars, seeds, takers, draw)
    takers_of = defaultdict(set)
    for taker, subject in found[: count - AHEAD - seeds * takers]:
        takers_of[subject].add(taker)
    assert {len(each) for each in takers_of.values()} <= {1}
    assert max(read - number for number, read in enumerate(reads, 1)) <= AHEAD


def test_where_there_is_one_exemplar_all_share_it() -> None:
    found, reads, _ = given(1, 60, 2, draw=1)
    share = [taker for taker, _ in found].count(0) / len(found)
    assert 0.2 < share < 0.8
    assert max(read - number for number, read in enumerate(reads, 1)) <= AHEAD


def test_without_an_exemplar_the_inputs_are_what_jobs_share() -> None:
    order, _ = loaded(1, 1)
    slips = [Slip("arrays", "state", str(number), str(number)) for number in range(3)]
    first, again, other = (
        dataclasses.replace(order, slips=given).subject
        for given in (
            {"a": slips[0], "b": slips[1]},
            {"b": slips[0], "a": slips[1]},
            {"a": slips[0], "b": slips[2]},
        )
    )
    assert first == again != other


def test_two_processes_prepare_an_exemplar_once() -> None:
    images = [as_exemplar(np.full((6, 6), number / 8, np.float32)) for number in range(6)]
    jobs = [
        Job(method="tiling", inputs={"exemplar": image}, size=(4, 4), seed=seed)
        for image in images
        for seed in range(4)
    ]
    where = defaultdict(set)
    for number, outcome in run_jobs(iter(jobs), place=Processes(2), finish=shape_of):
        where[number // 4].add(outcome.value[1])
    # At the end, whoever is idle shares what the other one works on.
    assert sum(len(each) > 1 for each in where.values()) <= 2
    assert len(set().union(*where.values())) == 2
