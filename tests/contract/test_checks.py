"""The checks that other packages run find deliberate mistakes, and say what they are."""

from __future__ import annotations

import dataclasses
import random
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import pytest

from tests.contract.cases import IDS, METHODS
from tests.core.toy import NoiseParams, noise_method, stock
from texlab_core.contract import __main__ as command
from texlab_core.contract.checking import Finding, check_method, checks, methods_of
from texlab_core.contract.declarations import check_identity, check_knobs, check_refusals, check_round_trips
from texlab_core.engine import registry
from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.params import Knob, Params
from texlab_core.engine.registry import InputSpec
from texlab_core.engine.steps import Output, Step
from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.engine.registry import Method


@pytest.mark.parametrize("check", [check_identity, check_knobs, check_refusals, check_round_trips])
@pytest.mark.parametrize("method", METHODS, ids=IDS)
def test_our_own_methods_declare_what_they_should(method: Method, check: Callable[[Method], None]) -> None:
    check(method)


@pytest.fixture
def known(monkeypatch: pytest.MonkeyPatch) -> Callable[[Method], Method]:
    def add(method: Method) -> Method:
        stock(monkeypatch, registry._METHODS, method, alone=True)
        return method

    return add


def whole(**changes: Any) -> Method:
    return noise_method(reference="A test, 2026.", fails_on=("everything else",), package="some", **changes)


def broken(method: Method) -> dict[str, str]:
    return {finding.check: finding.problem for finding in check_method(method) if finding.problem}


def test_a_method_without_mistakes_keeps_every_promise(known: Any) -> None:
    method = known(whole())
    findings = list(check_method(method))
    assert broken(method) == {}
    assert [finding.check for finding in findings] == list(checks())
    assert all(finding.promise for finding in findings)
    assert findings[0] == Finding("toy-noise", "identity", findings[0].promise)


@dataclass(frozen=True, kw_only=True)
class Bad(Params):
    size: Annotated[int, Knob(help="no sentence", low=1)] = 3


def wrong(change: Callable[[Any], Any]) -> Callable[..., Any]:
    """Return a synthesis whose image was changed."""

    def synthesize(model: Any, inputs: Any, params: Any, size: Any, streams: Any) -> Any:
        image = streams("noise").random((*size, exemplar_of(inputs).channels), dtype=np.float32)
        yield Step(1, 1, "all", preview=image.copy)
        return Output(image=change(image))

    return synthesize


def uses_global(model: Any, inputs: Any, params: Any, size: Any, streams: Any) -> Any:
    random.random()
    image = streams("noise").random((*size, exemplar_of(inputs).channels), dtype=np.float32)
    yield Step(1, 1, "all", preview=image.copy)
    return Output(image=image)


def falls_back(model: Any, inputs: Any, params: Any, size: Any, streams: Any) -> Any:
    image = streams("noise").random((*size, exemplar_of(inputs).channels), dtype=np.float32)
    yield Step(2, 2, "end", preview=image.copy)
    yield Step(1, 2, "two\nlines")
    return Output(image=image)


def goes_on(model: Any, inputs: Any, params: Any, size: Any, streams: Any) -> Any:
    image = streams("noise").random((*size, exemplar_of(inputs).channels), dtype=np.float32)
    try:
        yield Step(1, 1, "all", preview=image.copy)
    except GeneratorExit:
        yield Step(1, 1, "more")
    return Output(image=image)


def no_steps(model: Any, inputs: Any, params: Any, size: Any, streams: Any) -> Any:
    yield from ()
    raise ZeroDivisionError("no pixels")


@dataclass(frozen=True, kw_only=True)
class Unmarked(NoiseParams):
    # The analysis uses it, and its stage does not say so.
    power: Annotated[int, Knob(help="Moment to keep.", low=1, high=4)] = 1


@pytest.mark.parametrize(
    ("changes", "check", "sentence"),
    [
        ({"id": "Toy Noise"}, "identity", "id: must be lower-case words"),
        ({"summary": "no sentence"}, "identity", "summary must be one sentence"),
        ({"reference": "A test."}, "identity", "with its year"),
        ({"fails_on": ()}, "identity", "fails_on: must say"),
        ({"params": Bad}, "knobs", "size: its help must be one sentence"),
        ({"params": Unmarked}, "cached-analysis", "one of them needs stage='analysis'"),
        ({"random": False}, "seeds", "random is False, and seeds matter"),
        ({"synthesize": wrong(lambda image: image * 0)}, "seeds", "say random=False"),
        ({"synthesize": wrong(lambda image: image.astype(np.float64))}, "outputs", "must be float32, got float64"),
        ({"synthesize": wrong(lambda image: image + 1)}, "outputs", "must lie in 0 to 1, got 1"),
        ({"synthesize": wrong(lambda image: image[1:])}, "outputs", "must have the shape"),
        ({"synthesize": uses_global}, "no-side-effects", "draw from streams instead"),
        ({"synthesize": falls_back}, "steps", "progress falls back"),
        ({"synthesize": goes_on}, "generators", "goes on after it was closed"),
        ({"synthesize": no_steps}, "settings", "raises ZeroDivisionError: no pixels"),
    ],
)
def test_a_mistake_is_found_and_named(known: Any, changes: dict[str, Any], check: str, sentence: str) -> None:
    method = known(dataclasses.replace(whole(), **changes))
    state = random.getstate()
    try:
        found = broken(method)
    finally:
        random.setstate(state)
    assert sentence in found[check], found


def test_an_input_that_cannot_be_made_is_said(known: Any) -> None:
    code = InputSpec("code", "Some numbers.", kind="data")
    method = known(whole(inputs=(*noise_method().inputs, code)))
    assert "the input code is required" in broken(method)["same-bits"]


def test_the_command_says_what_it_checked(known: Any, capsys: pytest.CaptureFixture[str]) -> None:
    known(whole())
    assert command.main(["Some"]) == 0
    assert capsys.readouterr().out.endswith("Every promise is kept.\n")
    known(dataclasses.replace(whole(), fails_on=()))
    assert command.main(["some"]) == 1
    out = capsys.readouterr().out
    assert "  BROKEN  identity: Say what it is" in out
    assert "          fails_on: must say what the method is known to fail on.\n" in out
    assert out.endswith("1 promises are broken.\n")
    assert command.main(["nothing"]) == 2
    assert "No installed package nothing adds a method; these do: some." in capsys.readouterr().err
    assert command.main([]) == 2
    assert command.main(["--help"]) == 0
    with pytest.raises(InputError):
        methods_of("nothing")
