from __future__ import annotations

import json
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from texlab_core.engine.params import ParamValue
from texlab_core.errors import ParamError
from texlab_core.methods.de_bonet.features import Feature, channel_names, feature_list
from texlab_core.methods.de_bonet.params import DeBonetParams
from texlab_core.methods.de_bonet.thresholds import MAX_CELLS, ThresholdTable, threshold_law

NAMES = [feature.name for feature in feature_list(channel_names(3), "both", 7)]
cells = st.dictionaries(
    st.tuples(st.integers(1, 24), st.sampled_from(NAMES)), st.floats(0, 1e6, allow_nan=False), max_size=30
)


def test_law() -> None:
    np.testing.assert_allclose(threshold_law(0.3, 1, 3), [0.3, 0.15, 0.1], rtol=1e-6)
    np.testing.assert_allclose(threshold_law(0.3, 2, 3), [0.3, 0.075, 0.3 / 9], rtol=1e-6)
    assert (threshold_law(0.3, 0, 5) == np.float32(0.3)).all()
    assert threshold_law(0.3, 0, 0).shape == (0,)


def test_cells_replace_the_law() -> None:
    names = ["luminance/laplacian", "luminance/first-0"]
    table = ThresholdTable().changed({(2, "luminance/first-0"): 0.7, (9, "luminance/first-0"): 1.0})
    matrix = table.matrix(0.2, 1, 3, [*names, "red/laplacian"])
    expected = threshold_law(0.2, 1, 3)[:, None].repeat(3, 1)
    expected[1, 1] = 0.7
    np.testing.assert_array_equal(matrix, expected)
    assert matrix.dtype == np.float32


def test_it_is_a_value() -> None:
    one = ThresholdTable().changed({(1, "red/laplacian"): 0.5, (2, "red/first-45"): 0.25})
    other = ThresholdTable().changed({(2, "red/first-45"): 0.25}).changed({(1, "red/laplacian"): 0.5})
    assert one == other
    assert hash(one) == hash(other)
    assert isinstance(one, ParamValue)
    assert one.get(1, "red/laplacian") == 0.5
    assert one.get(1, "red/first-45") is None
    assert one.reset([(1, "red/laplacian"), (5, "blue/laplacian")]).cells == (((2, "red/first-45"), 0.25),)
    assert one.reset() == ThresholdTable()
    assert len({DeBonetParams(thresholds=one), DeBonetParams(thresholds=other)}) == 1


@given(cells)
def test_round_trip(values: dict[tuple[int, str], float]) -> None:
    table = ThresholdTable().changed(values)
    text = json.dumps(table.to_json(), allow_nan=False)
    assert ThresholdTable.from_json(json.loads(text)) == table
    params = DeBonetParams(thresholds=table)
    assert DeBonetParams.parse({"thresholds": text}) == params
    assert DeBonetParams.from_json(json.loads(json.dumps(params.to_json()))) == params


deep: list[object] = []
for _ in range(100_000):
    deep = [deep]

HOSTILE = {
    "a number": 3,
    "a mapping": {"1": 2},
    "a text": "abc",
    "none": None,
    "deep": deep,
    "too many": [[1, "red/laplacian", 0.1]] * (MAX_CELLS + 1),
    "short cell": [[1, "red/laplacian"]],
    "long cell": [[1, "red/laplacian", 0.1, 0]],
    "twice": [[1, "red/laplacian", 0.1], [1, "red/laplacian", 0.2]],
    "k 0": [[0, "red/laplacian", 0.1]],
    "k 25": [[25, "red/laplacian", 0.1]],
    "k float": [[1.0, "red/laplacian", 0.1]],
    "k true": [[True, "red/laplacian", 0.1]],
    "k huge": [[10**10000, "red/laplacian", 0.1]],
    "name number": [[1, 1, 0.1]],
    "name unknown": [[1, "green/third-0", 0.1]],
    "name long": [[1, "red/laplacian" * 10**6, 0.1]],
    "name with a line": [[1, "red/laplacian\n", 0.1]],
    "other digits": [[1, "red/first-٤٥", 0.1]],
    "negative": [[1, "red/laplacian", -0.1]],
    "nan": [[1, "red/laplacian", math.nan]],
    "infinite": [[1, "red/laplacian", math.inf]],
    "too large": [[1, "red/laplacian", 1e7]],
    "huge whole number": [[1, "red/laplacian", 10**10000]],
    "true": [[1, "red/laplacian", True]],
    "text": [[1, "red/laplacian", "0.1"]],
    "no number": [[1, "red/laplacian", None]],
    "deep cell": [[1, "red/laplacian", deep]],
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_data_is_refused_in_one_sentence(name: str) -> None:
    with pytest.raises(ValueError) as caught:
        ThresholdTable.from_json(HOSTILE[name])
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 200
    with pytest.raises(ParamError) as refused:
        DeBonetParams.from_json({"thresholds": HOSTILE[name]})
    assert refused.value.field == "thresholds"
    assert len(str(refused.value)) < 400


def test_numbers_of_other_types() -> None:
    table = ThresholdTable.from_json([[np.int64(2), "red/laplacian", Fraction(1, 4)], [1, "red/first-0", -0.0]])
    assert table.to_json() == [[1, "red/first-0", 0.0], [2, "red/laplacian", 0.25]]
    assert "-" not in repr(table.get(1, "red/first-0"))


@pytest.mark.parametrize("orientations", range(2, 9))
@pytest.mark.parametrize("channels", [1, 3])
def test_every_feature_has_a_name_of_its_own_that_tables_accept(orientations: int, channels: int) -> None:
    features = feature_list(channel_names(channels), "both", orientations)
    names = [feature.name for feature in features]
    assert len(set(names)) == len(features) == channels * (1 + 2 * orientations)
    table = ThresholdTable().changed({(1, name): 0.5 for name in names})
    assert (table.matrix(0.1, 0, 1, names) == 0.5).all()
    mirrored = {feature.mirrored().name for feature in features}
    assert mirrored == set(names)


def test_names_survive_other_orientations() -> None:
    assert Feature("red", "first", 45.0).name == "red/first-45"
    four = {feature.name for feature in feature_list(channel_names(3), "both", 4)}
    eight = {feature.name for feature in feature_list(channel_names(3), "both", 8)}
    assert four < eight
    assert Feature("red", "second", 22.5).mirrored() == Feature("red", "second", 157.5)
    assert Feature("red", "second", 0).mirrored() == Feature("red", "second", 0)
