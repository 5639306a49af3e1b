"""Slider scales: round trips, order, ends, and that every position is a value the knob allows."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from texlab.form.scales import LINEAR_PART, POSITIONS, Scale, box_step, decimals
from texlab_core.engine.params import Field, Knob, describe
from texlab_core.engine.registry import methods


def number(low, high, kind="float", default=None, **knob):
    kinds = {"float": float, "int": int}
    return Field(
        "x", kind, kinds[kind], low if default is None else default, Knob(help="", low=low, high=high, **knob)
    )


@st.composite
def float_fields(draw):
    """Fields whose limits are at least a part in a thousand apart."""
    low = draw(st.floats(0.001, 100))
    high = low * draw(st.floats(1.01, 1e5))
    shape = draw(st.sampled_from(["even", "log", "tail"]))
    if shape == "tail":
        return number(low, high, linear_to=low + (high - low) * draw(st.floats(0.01, 0.9)))
    return number(low, high, log=shape == "log")


@st.composite
def int_fields(draw):
    low = draw(st.integers(1, 50))
    high = low + draw(st.integers(2, 3000))
    shape = draw(st.sampled_from(["even", "log", "tail", "odd"]))
    if shape == "tail":
        return number(low, high, "int", linear_to=draw(st.integers(low + 1, high)))
    return number(low, high, "int", log=shape == "log", odd=shape == "odd")


@given(float_fields(), st.integers(0, POSITIONS))
def test_a_position_comes_back(field, position):
    scale = Scale.of(field)
    assert scale.position(scale.value(position)) == position


@given(float_fields(), st.floats(0, 1))
def test_a_value_comes_back_to_half_a_position(field, share):
    scale = Scale.of(field)
    value = field.knob.low + (field.knob.high - field.knob.low) * share
    place = scale.position(value)
    around = scale.value(max(place - 1, 0)), scale.value(min(place + 1, scale.positions))
    assert around[0] - 1e-9 * value <= value <= around[1] + 1e-9 * value


@given(st.one_of(float_fields(), int_fields()))
def test_order_and_ends(field):
    scale = Scale.of(field)
    values = [scale.value(place) for place in range(scale.positions + 1)]
    assert values == sorted(values)
    assert values[0] == pytest.approx(scale.low, rel=1e-12)
    assert values[-1] == pytest.approx(scale.high, rel=1e-12)


@given(st.one_of(float_fields(), int_fields()))
def test_every_position_is_allowed(field):
    scale = Scale.of(field)
    for place in range(scale.positions + 1):
        value = scale.value(place)
        given = round(value) if field.kind == "int" else value
        assert field.check(given) == given


@given(int_fields(), st.data())
def test_whole_numbers_come_back(field, data):
    scale = Scale.of(field)
    place = data.draw(st.integers(0, scale.positions))
    value = scale.value(place)
    assert value == round(value)
    assert scale.value(scale.position(value)) == value


@given(st.integers(0, 30), st.integers(1, 900), st.booleans(), st.data())
def test_every_whole_number_of_a_short_range_has_a_position(low, span, odd, data):
    field = number(low, low + span + 1, "int", odd=odd)
    scale = Scale.of(field)
    value = data.draw(st.integers(low, low + span + 1).filter(lambda each: each % 2 == 1 or not odd))
    assert scale.value(scale.position(value)) == value


@pytest.mark.parametrize(("low", "high", "ends"), [(2, 10, (3, 9)), (3, 41, (3, 41)), (None, None, (1, 99))])
def test_odd_numbers_within_even_limits(low, high, ends):
    scale = Scale.of(number(low, high, "int", default=5, odd=True))
    assert (scale.low, scale.high) == ends
    assert all(scale.value(place) % 2 == 1 for place in range(scale.positions + 1))


def test_a_linear_part_with_a_logarithmic_tail():
    scale = Scale.of(number(0, 4, linear_to=0.5))
    corner = round(LINEAR_PART * POSITIONS)
    assert scale.value(corner) == 0.5
    assert scale.value(corner // 2) == pytest.approx(0.25)
    assert scale.value(POSITIONS) == 4
    # Halfway along the tail is the geometric mean.
    assert scale.value((corner + POSITIONS) // 2) == pytest.approx(math.sqrt(0.5 * 4), rel=1e-9)


def test_outside_is_clamped():
    scale = Scale.of(number(1, 2))
    assert scale.position(0) == 0
    assert scale.position(5) == POSITIONS
    assert scale.value(-3) == 1
    assert scale.value(5000) == 2


FIELDS = {
    f"{method.id}-{field.name}": field
    for method in methods().values()
    for field in describe(method.params)
    if field.kind in ("int", "float")
}


@pytest.mark.parametrize("field", FIELDS.values(), ids=FIELDS.keys())
def test_knobs_of_the_methods(field):
    """What a method declares can be reached with the slider, shown in the box, and stepped through."""
    scale = Scale.of(field)
    for value in (field.knob.low, field.knob.high, field.default):
        if value is not None and field.kind == "float":
            assert round(value, decimals(field)) == value
            assert scale.value(scale.position(value)) == pytest.approx(value, rel=0.02, abs=1e-3)
        elif value is not None:
            assert scale.value(scale.position(value)) == value
    if field.kind == "float":
        assert box_step(field) >= 10 ** -decimals(field)


@pytest.mark.parametrize(
    ("field", "places", "step"),
    [
        (number(0, 4, linear_to=0.5), 3, 0.005),
        (number(0, 1), 3, 0.01),
        (number(0, 100), 2, 1),
        (number(0, 3), 3, 0.02),
        (number(0.001, 1000, log=True), 4, 5),
        (number(0, 1, step=0.25), 2, 0.25),
        (number(0, 1, default=0.0125), 4, 0.01),
        (number(-2, 2), 3, 0.02),
        (number(None, None, default=0.0), 3, 0.01),
    ],
)
def test_decimals_and_steps_of_boxes(field, places, step):
    assert decimals(field) == places
    assert box_step(field) == pytest.approx(step)
