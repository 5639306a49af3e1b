"""What every method says of itself is complete, and its knobs check what they are given."""

from __future__ import annotations

import inspect
import json
import math
import re
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.contract.cases import IDS, METHODS, assert_sentence, params_of
from texlab_core.api import synthesize
from texlab_core.engine.params import Field, describe
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    from texlab_core.engine.registry import Method

FIELDS = [
    pytest.param(method, field, id=f"{method.id}-{field.name}")
    for method in METHODS
    for field in describe(method.params)
]


@pytest.mark.parametrize("method", METHODS, ids=IDS)
def test_the_method_says_what_it_is(method: Method) -> None:
    assert re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", method.id)
    assert method.title
    assert_sentence(method.summary)
    assert re.search(r"\b(19|20)\d\d\b", method.reference), "the reference has a year"
    assert method.fails_on
    assert all(phrase and phrase == phrase.strip() for phrase in method.fails_on)
    names = [spec.name for spec in method.inputs]
    assert len(set(names)) == len(names)
    assert all(spec.help for spec in method.inputs)


@pytest.mark.parametrize("method", METHODS, ids=IDS)
def test_defaults_are_the_same_everywhere(method: Method) -> None:
    defaults = method.params()
    assert {field.name: field.default for field in describe(method.params)} == {
        field.name: getattr(defaults, field.name) for field in describe(method.params)
    }
    assert method.params.from_json({}) == method.params.parse({}) == defaults
    assert hash(method.params()) == hash(defaults)


@pytest.mark.parametrize(("method", "field"), FIELDS)
def test_the_knob_is_complete(method: Method, field: Field) -> None:
    knob = field.knob
    assert_sentence(knob.help)
    assert field.name not in inspect.signature(synthesize).parameters
    if field.kind in ("int", "float"):
        assert knob.low is not None
        assert knob.high is not None
        assert knob.low <= field.default <= knob.high
        if knob.linear_to is not None:
            assert max(knob.low, 0) < knob.linear_to < knob.high
        assert not knob.log or knob.low > 0
    assert set(knob.choices) == set(field.choices), "every choice is explained"
    assert all(knob.choices.values())
    if knob.when is not None:
        name, values = knob.when
        other = {each.name: each for each in describe(method.params)}[name]
        assert [other.check(value) for value in values] == list(values)


@pytest.mark.parametrize(("method", "field"), FIELDS)
def test_what_a_knob_refuses_names_it(method: Method, field: Field) -> None:
    for value in _refused(field):
        with pytest.raises(ParamError) as caught:
            method.params.from_json({field.name: value})
        assert caught.value.field == field.name
        assert field.name in str(caught.value)
        assert_sentence(str(caught.value))


def _refused(field: Field) -> list[Any]:
    if field.kind == "bool":
        return [1, "true", None]
    if field.kind == "choice":
        return ["no such choice", 1, None]
    if field.kind == "value":
        return [object(), "no such value", math.nan]
    low, high = field.knob.low, field.knob.high
    beyond = [bound + way for bound, way in ((low, -1), (high, 1)) if bound is not None]
    return [*beyond, math.nan, math.inf, -math.inf, "1", None, True]


@pytest.mark.parametrize("method", METHODS, ids=IDS)
@settings(suppress_health_check=[HealthCheck.filter_too_much])
@given(data=st.data())
def test_params_round_trip(method: Method, data: st.DataObject) -> None:
    params = data.draw(params_of(method))
    as_json = json.loads(json.dumps(params.to_json(), allow_nan=False))
    assert method.params.from_json(as_json) == params
    texts = {name: value if isinstance(value, str) else json.dumps(value) for name, value in as_json.items()}
    assert method.params.parse(texts) == params
    assert set(dict(params.analysis_key())) <= set(as_json)
