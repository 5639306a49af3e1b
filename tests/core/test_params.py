"""Parameters: declared once, checked always, and the same through JSON and the command line."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Annotated, Any, Literal, Self

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from texlab_core.engine.params import Knob, Params, describe
from texlab_core.errors import InputError, ParamError


@dataclass(frozen=True)
class Weights:
    """A structured parameter."""

    values: tuple[float, ...] = (1.0,)

    @classmethod
    def from_json(cls, data: object) -> Self:
        if not isinstance(data, list) or not data:
            raise ValueError("a list of numbers is wanted.")
        return cls(tuple(float(value) for value in data))

    def to_json(self) -> object:
        return list(self.values)


@dataclass(frozen=True, kw_only=True)
class Sample(Params):
    rounds: Annotated[int, Knob(help="Rounds.", low=1, high=50)] = 5
    window: Annotated[int, Knob(help="Window.", low=3, high=31, odd=True, stage="analysis")] = 7
    strength: Annotated[float, Knob(help="Strength.", low=0, high=2, unit="sd")] = 0.5
    tiling: Annotated[bool, Knob(help="Tiling.")] = False
    border: Annotated[Literal["reflect", "wrap"], Knob(help="Border.", stage="analysis")] = "reflect"
    weights: Annotated[Weights, Knob(help="Weights.")] = field(default_factory=Weights)
    free: Annotated[float, Knob(help="Anything finite.")] = 0.0


valid = st.fixed_dictionaries(
    {
        "rounds": st.integers(1, 50),
        "window": st.integers(1, 15).map(lambda half: 2 * half + 1),
        "strength": st.floats(0, 2),
        "tiling": st.booleans(),
        "border": st.sampled_from(["reflect", "wrap"]),
        "weights": st.lists(st.floats(-9, 9), min_size=1).map(lambda values: Weights(tuple(values))),
        "free": st.floats(allow_nan=False, allow_infinity=False),
    }
)


@given(valid)
def test_json_round_trip(values: dict[str, Any]) -> None:
    params = Sample(**values)
    assert Sample.from_json(json.loads(json.dumps(params.to_json(), allow_nan=False))) == params
    assert {name: getattr(params, name) for name in values} == values


@given(valid)
def test_command_line_round_trip(values: dict[str, Any]) -> None:
    params = Sample(**values)
    texts = {name: json.dumps(value).strip('"') for name, value in params.to_json().items()}
    assert Sample.parse(texts) == params


@given(valid, valid)
def test_replace_equals_building_anew(values: dict[str, Any], changes: dict[str, Any]) -> None:
    assert Sample(**values).replace(**changes) == Sample(**changes)
    assert hash(Sample(**values)) == hash(Sample(**values))


@given(st.integers() | st.floats())
def test_a_number_is_taken_if_and_only_if_it_is_in_range(value: float) -> None:
    accepted = math.isfinite(value) and value == int(value) and 1 <= value <= 50
    if accepted:
        assert Sample(rounds=value).rounds == value  # type: ignore[arg-type]
        assert type(Sample(rounds=value).rounds) is int  # type: ignore[arg-type]
    else:
        with pytest.raises(ParamError, match=r"^rounds: must be a whole number from 1 to 50, got"):
            Sample(rounds=value)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("rounds", True),
        ("rounds", "5"),
        ("rounds", None),
        ("rounds", 2.5),
        ("rounds", 10**400),
        ("window", 4),
        ("strength", math.nan),
        ("strength", np.float32("inf")),
        ("strength", 1j),
        ("free", -math.inf),
        ("tiling", 1),
        ("tiling", "yes"),
        ("border", "mirror"),
        ("border", 0),
        ("weights", []),
        ("weights", {"a": 1}),
    ],
)
def test_what_does_not_fit_is_refused_in_one_sentence_that_names_the_field(name: str, value: object) -> None:
    with pytest.raises(ParamError) as caught:
        Sample.from_json({name: value})
    message = str(caught.value)
    assert caught.value.field == name
    assert message.startswith(f"{name}: must be ")
    assert message.endswith(".")
    assert "\n" not in message


@pytest.mark.parametrize("value", [3, 3.0, np.int64(3), np.float32(3), Fraction(3)])
def test_numbers_of_every_kind_are_stored_as_python_numbers(value: Any) -> None:
    assert type(Sample(rounds=value).rounds) is int
    assert type(Sample(strength=value / 3).strength) is float


def test_numpy_booleans_are_booleans() -> None:
    assert Sample(tiling=np.bool_(True)).tiling is True  # type: ignore[arg-type]


@pytest.mark.parametrize("build", [Sample.from_json, Sample.parse, lambda names: Sample().replace(**names)])
def test_an_unknown_name_is_refused_with_the_closest_known_one(build: Any) -> None:
    with pytest.raises(ParamError, match=r"did you mean rounds\?"):
        build({"round": "3"})


def test_a_method_without_parameters_says_so() -> None:
    with pytest.raises(ParamError, match="has no parameters"):
        Params.from_json({"rounds": 3})


@pytest.mark.parametrize(
    ("text", "value"), [("true", True), ("Yes", True), ("ON", True), ("1", True), (" no ", False), ("off", False)]
)
def test_words_for_booleans(text: str, value: bool) -> None:
    assert Sample.parse({"tiling": text}).tiling is value


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("rounds", "five"),
        ("rounds", "5.5"),
        ("rounds", ""),
        ("rounds", "9" * 5000),
        ("strength", "nan"),
        ("tiling", "maybe"),
        ("border", "Wrap"),
        ("weights", "[1,"),
        ("weights", "[" * 100_000),
    ],
)
def test_texts_that_do_not_fit_name_the_field(name: str, text: str) -> None:
    with pytest.raises(ParamError) as caught:
        Sample.parse({name: text})
    assert caught.value.field == name
    assert len(str(caught.value)) < 200


def test_texts_are_laid_over_a_base() -> None:
    base = Sample(rounds=9, strength=1.5)
    assert Sample.parse({"rounds": "5e0"}, base) == Sample(rounds=5, strength=1.5)


def test_only_parameters_of_the_analysis_change_its_key() -> None:
    key = Sample().analysis_key()
    assert dict(key) == {"window": 7, "border": "reflect"}
    assert Sample(rounds=9, strength=2, tiling=True).analysis_key() == key
    assert Sample(window=9).analysis_key() != key


def test_describe_says_everything_in_the_order_of_declaration() -> None:
    fields = describe(Sample)
    assert [each.name for each in fields] == [
        *("rounds", "window", "strength", "tiling", "border", "weights", "free"),
    ]
    assert [each.kind for each in fields] == ["int", "int", "float", "bool", "choice", "value", "float"]
    assert {each.name: each.default for each in fields} == {
        each.name: getattr(Sample(), each.name) for each in fields
    }
    assert [each.allowed for each in fields] == [
        "a whole number from 1 to 50",
        "an odd whole number from 3 to 31",
        "a number from 0 to 2",
        "true or false",
        "one of reflect, wrap",
        "a Weights",
        "a number",
    ]


@pytest.mark.parametrize(
    ("knob", "words"), [(Knob(help="x", low=2), "of at least 2"), (Knob(help="x", high=7.5), "of at most 7.5")]
)
def test_half_open_ranges(knob: Knob, words: str) -> None:
    one = type(
        "One", (Params,), {"__annotations__": {"a": Annotated[float, knob]}, "a": 5.0, "__module__": __name__}
    )
    params = dataclass(frozen=True, kw_only=True)(one)
    assert describe(params)[0].allowed.endswith(words)
    with pytest.raises(ParamError, match=words):
        params(a=1.0 if knob.low else 8.0)


def test_labels_are_names_with_spaces_unless_given() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Named(Params):
        mean_only: Annotated[bool, Knob(help="Mean.")] = False
        k: Annotated[int, Knob(help="K.", low=1, high=18, label="Orientations")] = 4

    assert [each.label for each in describe(Named)] == ["mean only", "Orientations"]


def test_programming_errors_are_type_errors() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Bare(Params):
        rounds: int = 5

    @dataclass(frozen=True, kw_only=True)
    class NoDefault(Params):
        rounds: Annotated[int, Knob(help="Rounds.")]

    @dataclass(frozen=True, kw_only=True)
    class Unshowable(Params):
        table: Annotated[list[int], Knob(help="Table.")] = field(default_factory=list)

    for params in (Bare, NoDefault, Unshowable):
        with pytest.raises(TypeError, match=params.__name__):
            describe(params)


def test_checks_over_several_fields_run_on_every_construction() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Ordered(Params):
        low: Annotated[float, Knob(help="Low.", low=0, high=1)] = 0.2
        high: Annotated[float, Knob(help="High.", low=0, high=1)] = 0.8

        def check(self) -> None:
            if self.low > self.high:
                raise ParamError("low", "at most high", self.low)

    assert Ordered(low=0.5).low == 0.5
    with pytest.raises(ParamError, match="low: must be at most high"):
        Ordered().replace(low=0.9)


def test_a_long_value_is_shortened_in_the_message() -> None:
    assert len(str(ParamError("a", "b", "x" * 1000))) < 100
    assert issubclass(ParamError, InputError)
    assert issubclass(InputError, ValueError)
