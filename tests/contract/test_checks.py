"""The checks that other packages run find deliberate mistakes, and say what they are."""

from __future__ import annotations

import dataclasses
import itertools
import random
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
import pytest

from tests.core.toy import NoiseParams, noise_method, stock
from texlab_core.contract import __main__ as command
from texlab_core.contract.checking import Finding, check_method, checks, methods_of
from texlab_core.engine import registry
from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.params import Knob, Params
from texlab_core.engine.registry import InputSpec
from texlab_core.engine.steps import Curve, Output, Step
from texlab_core.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

    from texlab_core.engine.registry import Method


@pytest.fixture
def known(monkeypatch: pytest.MonkeyPatch) -> Callable[[Method], Method]:
    def add(method: Method) -> Method:
        stock(monkeypatch, registry._METHODS, method, alone=True)
        return method

    return add


def silent(model: Any, inputs: Any, params: Any, size: Any, streams: Any) -> Any:
    """Make toy noise without its measure, which is not registered."""
    output = yield from noise_method().synthesize(model, inputs, params, size, streams)
    return dataclasses.replace(output, measures={})


def whole(**changes: Any) -> Method:
    fields = {"reference": "A test, 2026.", "fails_on": ("everything else",), "package": "some"}
    return noise_method(**(fields | {"synthesize": silent} | changes))


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


@dataclass(frozen=True, kw_only=True)
class Idle(NoiseParams):
    nothing: Annotated[float, Knob(help="Moves nothing.", low=0, high=1)] = 0.5


@dataclass(frozen=True, kw_only=True)
class Raised(NoiseParams):
    def check(self) -> None:
        object.__setattr__(self, "rounds", 9)


class Fixed:
    """A structured parameter without an example."""

    @classmethod
    def from_json(cls, data: object) -> Fixed:
        if data != []:
            raise ValueError("an empty list")
        return cls()

    def to_json(self) -> object:
        return []

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Fixed)

    def __hash__(self) -> int:
        return 0


@dataclass(frozen=True, kw_only=True)
class Structured(NoiseParams):
    table: Annotated[Fixed, Knob(help="A table.")] = dataclasses.field(default_factory=Fixed)


def told(**measures: float) -> Callable[..., Any]:
    """Return a synthesis with these measures, by name with underscores."""

    def synthesize(model: Any, inputs: Any, params: Any, size: Any, streams: Any) -> Any:
        output = yield from silent(model, inputs, params, size, streams)
        said = {name.replace("_", "-"): value for name, value in measures.items()}
        return dataclasses.replace(output, measures=said)

    return synthesize


def forgets_when_asked(model: Any, inputs: Any, params: Any, size: Any, streams: Any) -> Any:
    output = yield from silent(model, inputs, params, size, streams)
    return dataclasses.replace(output, curves={f"curve-{next(COUNT)}": Curve.of([1.0], "One")})


COUNT = itertools.count()


class Stepwise:
    """Steps that no generator makes."""

    def __init__(self, *given: Any) -> None:
        self._steps = silent(*given)

    def __next__(self) -> Step:
        return next(self._steps)

    def close(self) -> None:
        pass


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
        ({"synthesize": Stepwise}, "generators", "synthesize: must be a generator, got Stepwise."),
        ({"synthesize": no_steps}, "settings", "raises ZeroDivisionError: no pixels (NoiseParams(rounds=3"),
        ({"params": Raised}, "defaults", "rounds: the default 3 becomes 9."),
        ({"params": Idle}, "living-knobs", "The knob nothing of toy-noise is dead"),
        ({"params": Structured}, "living-knobs", "table: give Fixed a class method example()"),
        ({"params": Structured}, "cached-analysis", "table: no other value of it could be tried."),
        ({"synthesize": wrong(lambda image: image[1:])}, "odd-inputs", "(exemplar 2 x 2, size "),
        ({"synthesize": forgets_when_asked}, "same-bits", "the curves differ with two threads"),
        ({"measures": ("no-such",)}, "measures", "names what nobody registers: no-such."),
        ({"synthesize": told(cuts=0.5)}, "measures", "lacks cuts."),
        ({"synthesize": told(cuts=-1e9), "measures": ("cuts",)}, "measures", "out of its range"),
        ({"synthesize": told(cuts=0.4321), "measures": ("cuts",)}, "measures", "computed from the result it is"),
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
