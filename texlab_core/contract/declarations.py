"""What a method says of itself is complete, and its knobs check what they are given."""

from __future__ import annotations

import inspect
import json
import math
import re
from typing import TYPE_CHECKING, Any

from texlab_core.api import synthesize
from texlab_core.contract.cases import check_sentence, promise
from texlab_core.engine.params import Field, describe
from texlab_core.errors import ParamError

if TYPE_CHECKING:
    from texlab_core.engine.params import Params
    from texlab_core.engine.registry import Method


def check_identity(method: Method) -> None:
    """Say what it is: id, title, summary, reference with its year, known failures, inputs."""
    promise(
        re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", method.id),
        f"id: must be lower-case words with hyphens, got {method.id!r}.",
    )
    promise(method.title, "title: must not be empty.")
    check_sentence(method.summary, "summary")
    promise(re.search(r"\b(19|20)\d\d\b", method.reference), "reference: must name the paper with its year.")
    promise(method.fails_on, "fails_on: must say what the method is known to fail on.")
    promise(all(each and each == each.strip() for each in method.fails_on), "fails_on: must hold phrases.")
    names = [spec.name for spec in method.inputs]
    promise(len(set(names)) == len(names), f"inputs: must have different names, got {names}.")
    promise(all(spec.help for spec in method.inputs), "inputs: each must have a help text.")


def check_defaults(method: Method) -> None:
    """Have the same defaults everywhere: declared, in the class, of an empty document, on the command line."""
    defaults = method.params()
    for field in describe(method.params):
        value = getattr(defaults, field.name)
        promise(value == field.default, f"{field.name}: the default {field.default} becomes {value}.")
    promise(method.params.from_json({}) == defaults, "an empty document means other values than the defaults.")
    promise(method.params.parse({}) == defaults, "an empty command line means other values than the defaults.")
    promise(hash(method.params()) == hash(defaults), "equal parameters must have equal hashes.")


def check_knobs(method: Method) -> None:
    """Give every knob a sentence of help, a range with the default in it, a word on each choice."""
    for field in describe(method.params):
        _check_knob(method, field)


def _check_knob(method: Method, field: Field) -> None:
    knob, name = field.knob, field.name
    check_sentence(knob.help, f"{name}: its help")
    promise(
        name not in inspect.signature(synthesize).parameters,
        f"{name}: is what texlab_core.synthesize calls something else; choose another name.",
    )
    if field.kind in ("int", "float"):
        promise(knob.low is not None and knob.high is not None, f"{name}: needs low and high.")
        low, high = float(knob.low or 0), float(knob.high or 0)
        promise(
            low <= field.default <= high, f"{name}: the default {field.default} must lie in {low:g} to {high:g}."
        )
        if knob.linear_to is not None:
            promise(max(low, 0) < knob.linear_to < high, f"{name}: linear_to must lie between low and high.")
        promise(not knob.log or low > 0, f"{name}: a logarithmic knob needs a low above 0.")
    promise(
        set(knob.choices) == set(field.choices) and all(knob.choices.values()),
        f"{name}: each of the choices {', '.join(field.choices)} must be explained in Knob.choices, and no other.",
    )
    if knob.when is not None:
        other, values = knob.when
        fields = {each.name: each for each in describe(method.params)}
        promise(other in fields, f"{name}: when names {other}, which is no knob.")
        promise(
            [fields[other].check(value) for value in values] == list(values),
            f"{name}: when names values that {other} does not take.",
        )


def check_refusals(method: Method) -> None:
    """Refuse what a knob cannot take by its name, in one sentence."""
    for field in describe(method.params):
        for value in refused(field):
            try:
                method.params.from_json({field.name: value})
            except ParamError as error:
                promise(error.field == field.name, f"{field.name}: the refusal of {value!r} names {error.field}.")
                promise(field.name in str(error), f"{field.name}: the refusal of {value!r} does not name it.")
                check_sentence(str(error), f"{field.name}: the refusal of {value!r}")
            else:
                promise(False, f"{field.name}: takes {value!r}, which it should refuse.")


def refused(field: Field) -> list[Any]:
    """Return values that a knob must not take."""
    if field.kind == "bool":
        return [1, "true", None]
    if field.kind == "choice":
        return ["no such choice", 1, None]
    if field.kind == "value":
        return [object(), "no such value", math.nan]
    low, high = field.knob.low, field.knob.high
    beyond = [bound + way for bound, way in ((low, -1), (high, 1)) if bound is not None]
    return [*beyond, math.nan, math.inf, -math.inf, "1", None, True]


def check_round_trips(method: Method) -> None:
    """Take every setting through JSON and the command line's texts, and get it back."""
    for params in settings(method):
        promise_round_trip(method, params)


def promise_round_trip(method: Method, params: Params) -> None:
    """Check that a setting comes back from JSON and from the command line's texts."""
    as_json = json.loads(json.dumps(params.to_json(), allow_nan=False))
    promise(method.params.from_json(as_json) == params, f"{params}: comes back from JSON as something else.")
    texts = {name: value if isinstance(value, str) else json.dumps(value) for name, value in as_json.items()}
    promise(method.params.parse(texts) == params, f"{params}: comes back from its texts as something else.")
    promise(
        set(dict(params.analysis_key())) <= set(as_json),
        "analysis_key: holds what is no parameter.",
    )


def settings(method: Method) -> list[Any]:
    """Return the defaults, and every setting that differs from them in one knob."""
    found = [method.params()]
    for field in describe(method.params):
        for value in others(field):
            try:
                found.append(method.params().replace(**{field.name: value}))
            except ParamError:
                # A check over several fields: not alone.
                continue
    return found


def others(field: Field) -> list[Any]:
    """Return values of a knob that are not its default: both ends and the middle, other choices, an example."""
    if field.kind == "bool":
        return [not field.default]
    if field.kind == "choice":
        return [each for each in field.choices if each != field.default]
    if field.kind == "value":
        example = getattr(field.type, "example", None)
        return [] if example is None else [each for each in (example(),) if each != field.default]
    if field.knob.low is None or field.knob.high is None:
        return []
    low, high = field.knob.low, field.knob.high
    middle = math.sqrt(low * high) if low > 0 else (low + high) / 2
    values: list[Any] = [low, middle, high]
    if field.kind == "int":
        values = [2 * (round(each) // 2) + 1 if field.knob.odd else round(each) for each in values]
    return [each for each in dict.fromkeys(values) if each != field.default and low <= each <= high]
