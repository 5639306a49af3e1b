"""Every knob does something, and says truly whether the analysis depends on it."""

from __future__ import annotations

import contextlib
import itertools
import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.contract.cases import METHODS, job, texture
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.params import Field, describe
from texlab_core.engine.run import run
from texlab_core.errors import InputError, ParamError
from texlab_core.methods.de_bonet.thresholds import ThresholdTable

if TYPE_CHECKING:
    from collections.abc import Iterator

    from texlab_core.engine.job import Job
    from texlab_core.engine.params import Params
    from texlab_core.engine.registry import Method
    from texlab_core.engine.result import Result

KNOBS = [
    pytest.param(method, field, id=f"{method.id}-{field.name}")
    for method in METHODS
    for field in describe(method.params)
]
# Another value for each structured parameter, by its type.
OTHER_VALUES: dict[type, Any] = {
    ThresholdTable: [[k, f"{colour}/laplacian", 4.0] for k in (1, 2) for colour in ("red", "luminance")],
}


def other_values(field: Field) -> list[Any]:
    """Return values that differ from the default, the ones likeliest to show first."""
    if field.kind == "bool":
        return [not field.default]
    if field.kind == "choice":
        return [choice for choice in field.choices if choice != field.default]
    if field.kind == "value":
        if field.type not in OTHER_VALUES:
            raise AssertionError(f"Give tests/contract/test_knobs.py another value of {field.type.__name__}.")
        return [field.type.from_json(OTHER_VALUES[field.type])]
    low, high = field.knob.low, field.knob.high
    assert low is not None
    assert high is not None
    candidates = [2 * field.default + 1, field.default / 2, low, min(high, low + 1), high]
    if field.kind == "int":
        candidates = [math.floor(value) | 1 if field.knob.odd else math.floor(value) for value in candidates]
    fitting = dict.fromkeys(value for value in candidates if low <= value <= high and value != field.default)
    return list(fitting)


def bases(method: Method, field: Field) -> Iterator[Params]:
    """Yield parameters under which the knob may have an effect: ``when`` holds; then with another knob changed."""
    fields = {each.name: each for each in describe(method.params)}
    changes: dict[str, Any] = {}
    each = field
    while each.knob.when is not None:
        name, values = each.knob.when
        if method.params().to_json()[name] not in values:
            changes[name] = values[0]
        each = fields[name]
    first = method.params().replace(**changes)
    yield first
    for name in (name for name in fields if name != field.name and name not in changes):
        for value in other_values(fields[name]):
            with contextlib.suppress(ParamError):
                yield first.replace(**{name: value})


def situations(method: Method) -> Iterator[dict[str, Any]]:
    """Yield jobs in which a knob may show: outputs of other sizes, gray, and with an optional picture given."""
    for exemplar in (texture(24, 32), texture(40, 33, 1)):
        for size in (exemplar.size, (40, 56)):
            yield {"exemplar": exemplar, "size": size}
        for spec in method.inputs:
            if spec.kind == "image" and not spec.required:
                given = {"exemplar": exemplar, spec.name: texture(*exemplar.size, exemplar.channels)}
                yield {"exemplar": exemplar, "size": (40, 56), "inputs": given}


def same(one: Result, other: Result) -> bool:
    """Return whether two results agree in everything that they carry."""
    if one.image.tobytes() != other.image.tobytes() or one.measures != other.measures:
        return False
    return one.maps.keys() == other.maps.keys() and all(
        np.array_equal(one.maps[name].data, other.maps[name].data) for name in one.maps
    )


def pairs(method: Method, field: Field) -> Iterator[tuple[Job, Job]]:
    """Yield jobs that differ in one knob only; what cannot work is left out."""
    for base, value, situation in itertools.product(bases(method, field), other_values(field), situations(method)):
        with contextlib.suppress(InputError, ParamError):
            changed = base.replace(**{field.name: value})
            one, other = (job(method, params=params, seed=2, **situation) for params in (base, changed))
            yield one, other


@pytest.mark.parametrize(("method", "field"), KNOBS)
def test_the_knob_changes_something(method: Method, field: Field) -> None:
    for one, other in pairs(method, field):
        try:
            if not same(run(one), run(other)):
                return
        except InputError:
            continue
    pytest.fail(
        f"The knob {field.name} of {method.id} is dead: no value changed any bit of a result. Use it, remove it, "
        "or say with Knob(when=...) under which other value it has an effect."
    )


@pytest.mark.parametrize(("method", "field"), KNOBS)
def test_an_analysis_is_found_again_only_where_it_is_the_same(method: Method, field: Field) -> None:
    compared = 0
    for one, other in pairs(method, field):
        cache = AnalysisCache()
        try:
            run(one, cache=cache)
            fresh, cached = run(other), run(other, cache=cache)
        except InputError:
            continue
        compared += 1
        assert same(fresh, cached), (
            f"{method.id}: with {field.name} = {getattr(other.params, field.name)!r} the kept analysis gives "
            'another result than a new one. The analysis depends on it: declare the knob with stage="analysis".'
        )
        if compared >= 4:
            return
    assert compared, f"No value of {field.name} of {method.id} could be tried."
