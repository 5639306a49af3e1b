"""The methods, and every setting that they can have."""

from __future__ import annotations

from typing import Any

from hypothesis import strategies as st

from texlab_core.engine.params import Params, describe
from texlab_core.engine.registry import Method, methods
from texlab_core.errors import ParamError

METHODS = list(methods().values())
IDS = list(methods())


def params_of(method: Method) -> st.SearchStrategy[Params]:
    """Return a strategy for every setting that each knob accepts and the checks over several knobs let pass."""
    values: dict[str, st.SearchStrategy[Any]] = {}
    for field in describe(method.params):
        low, high = field.knob.low, field.knob.high
        if field.kind == "int":
            numbers = st.integers(None if low is None else int(low), None if high is None else int(high))
            values[field.name] = numbers.filter(lambda value: value % 2 == 1) if field.knob.odd else numbers
        elif field.kind == "float":
            values[field.name] = st.floats(low, high, allow_nan=False, allow_infinity=False)
        elif field.kind == "bool":
            values[field.name] = st.booleans()
        elif field.kind == "choice":
            values[field.name] = st.sampled_from(field.choices)
        else:
            values[field.name] = st.just(field.default)
    return (
        st.fixed_dictionaries(values)
        .map(lambda chosen: _build(method, chosen))
        .filter(lambda built: built is not None)
    )  # type: ignore[return-value]


def _build(method: Method, chosen: dict[str, Any]) -> Params | None:
    try:
        return method.params(**chosen)
    except ParamError:  # a check over several fields
        return None
