"""What a method says of its results: registered measures only, and the same number that the registry computes."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import pytest

from tests.contract.cases import IDS, METHODS, job, texture
from texlab_core.engine.run import run
from texlab_core.measures.registry import find_measure, measure_all, measures
from texlab_core.measures.subject import Subject

if TYPE_CHECKING:
    from texlab_core.engine.registry import Method


@pytest.mark.parametrize("method", METHODS, ids=IDS)
def test_every_measure_that_a_method_says_is_registered(method: Method) -> None:
    known = measures()
    missing = [each for each in method.measures if each not in known]
    assert not missing, f"{method.id} names measures that nobody registers: {missing}"
    result = run(job(method, texture(40, 48), size=(44, 60)))
    assert set(result.measures) <= set(method.measures), (
        f"{method.id}: Method(measures=...) does not name {set(result.measures) - set(method.measures)}"
    )
    for name, value in result.measures.items():
        measure = find_measure(name)
        assert measure.low <= value <= measure.high, f"{method.id}: {name} = {value} is out of its range"


@pytest.mark.parametrize("method", METHODS, ids=IDS)
def test_what_a_method_says_is_what_the_registry_computes(method: Method) -> None:
    result = run(job(method, texture(40, 48), size=(44, 60)))
    said = Subject.of_result(result)
    silent = dataclasses.replace(said, given={})
    for name, value in result.measures.items():
        assert find_measure(name).of(said) == value
        if find_measure(name).function is not None:
            assert find_measure(name).of(silent) == pytest.approx(value, rel=1e-9), f"{method.id}: {name}"
    found = measure_all(said)
    assert set(result.measures) <= set(found)
    assert {"discriminability", "visual-difference", "w1-pixels", "spectral-distance"} <= set(found)
