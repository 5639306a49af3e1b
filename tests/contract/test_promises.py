"""Our own methods keep every promise that other packages are held to, and keep it at any setting."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from tests.contract.cases import IDS, METHODS, params_of
from texlab_core.contract.cases import Broken, job, promise, size_for, texture
from texlab_core.contract.checking import checks
from texlab_core.contract.declarations import promise_round_trip
from texlab_core.contract.runs import promise_output_or_refusal
from texlab_core.engine.run import run
from texlab_core.measures.registry import measure_all
from texlab_core.measures.subject import Subject

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.engine.registry import Method

each_method = pytest.mark.parametrize("method", METHODS, ids=IDS)


def problem(keep: Callable[[], None]) -> str:
    """Return in words how a promise is broken; nothing when it is kept."""
    try:
        keep()
    except Broken as broken:
        return str(broken)
    return ""


def test_a_broken_promise_is_told() -> None:
    assert problem(lambda: promise(False, "it is dead.")) == "it is dead."


@pytest.mark.parametrize("check", checks().values(), ids=checks())
@each_method
def test_the_promise_is_kept(method: Method, check: Callable[[Method], None]) -> None:
    assert problem(lambda: check(method)) == ""


@each_method
@settings(suppress_health_check=[HealthCheck.filter_too_much])
@given(data=st.data())
def test_params_round_trip(method: Method, data: st.DataObject) -> None:
    params = data.draw(params_of(method))
    assert method.params.from_json(params.to_json()) == params
    assert problem(lambda: promise_round_trip(method, params)) == ""


@pytest.mark.slow
@each_method
@settings(max_examples=25, phases=[Phase.generate], suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_every_setting_works_or_is_refused_in_one_sentence(method: Method, data: st.DataObject) -> None:
    params = data.draw(params_of(method))
    exemplar = texture(16, 13, data.draw(st.sampled_from([1, 3])))
    seed = data.draw(st.integers(0, 9))
    wanted = size_for(method, (11, 18))
    chosen = {"exemplar": exemplar, "params": params, "size": (11, 18), "seed": seed}
    assert problem(lambda: promise_output_or_refusal(method, wanted, **chosen)) == ""


@each_method
def test_every_result_is_measured(method: Method) -> None:
    found = measure_all(Subject.of_result(run(job(method, texture(40, 48), size=(44, 60)))))
    assert {"discriminability", "visual-difference", "w1-pixels", "spectral-distance"} <= set(found)
