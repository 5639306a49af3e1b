"""Exercise 1: hash keys and the hierarchy find what blank search finds, with honest counters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab_core.api import synthesize
from texlab_core.errors import ParamError
from texlab_core.methods.de_bonet import search

if TYPE_CHECKING:
    from texlab_core.methods.de_bonet.sampling import Sampling


def sampled(side: int = 64, **knobs: Any) -> Sampling:
    pixels = np.random.default_rng(0).random((side, side, 3)).astype(np.float32)
    pixels = (pixels + np.roll(pixels, 1, 0) + np.roll(pixels, 1, 1)) / 3
    return synthesize(pixels, "de-bonet", size=(side, side), seed=2, **knobs).details.sampling


@pytest.mark.parametrize(
    "knobs",
    [{}, {"alpha": 0.6, "beta": 0.5}, {"alpha": 2.0}, {"alpha": 0.0}, {"alpha": 0.5, "siblings": "literal"}],
    ids=str,
)
def test_all_three_find_the_same_structures(knobs):
    """Against a comparison of every structure, one after the other, component by component."""
    sampling = sampled(**knobs)
    rng = np.random.default_rng(1)
    for level in range(1, sampling.grid.depth + 1):
        index = search.KeyIndex(sampling, level)
        height, width = sampling.grid.shape(level)
        for _ in range(6):
            row, column = int(rng.integers(height)), int(rng.integers(width))
            found = search.search(sampling, row, column, level, index=index)
            assert found.matches.tolist() == brute(sampling, row, column, level)
            assert found.blank.found == found.keys.found == found.hierarchy.found == found.matches.size
            assert found.blank.verified == index.structures == sampling.analysis.grid.count(level)
            assert found.matches.size <= found.keys.verified <= found.blank.verified
            assert len(found.key) == len(found.components)


def brute(sampling: Sampling, row: int, column: int, level: int) -> list[int]:
    place = sampling.grid.location(level, row, column)
    matches = []
    for structure in range(sampling.analysis.grid.count(level)):
        for each in range(level, sampling.grid.depth + 1):
            features = sampling.analysis.levels[each].features
            shift = 2 * (each - level)
            one, other = features[structure >> shift], features[sampling.sources[each][place >> shift]]
            if ((one - other) ** 2 > sampling.row(each)).any():
                break
        else:
            matches.append(structure)
    return matches


@pytest.mark.parametrize("alpha", [0.1, 0.8])
def test_a_survey_is_the_sum_over_all_locations(alpha):
    sampling = sampled(32, alpha=alpha, coarsest_side=4, fit_filters=False)
    for level in range(1, sampling.grid.depth + 1):
        found = search.survey(sampling, level)
        index = search.KeyIndex(sampling, level)
        height, width = sampling.grid.shape(level)
        each = [
            search.search(sampling, row, column, level, index=index)
            for row in range(height)
            for column in range(width)
        ]
        assert found.locations == height * width
        assert (found.structures, found.distinct) == (index.structures, index.distinct)
        for way in ("blank", "keys", "hierarchy"):
            tallies = [getattr(one, way) for one in each]
            total = search.Tally(
                *(sum(getattr(one, name) for one in tallies) for name in ("keys", "verified", "found"))
            )
            assert getattr(found, way) == total, way


def test_strict_thresholds_need_one_key_and_find_the_copy():
    sampling = sampled(alpha=0.0)
    index = search.KeyIndex(sampling, 1)
    assert index.around == 1
    found = search.search(sampling, 3, 5, 1, index=index)
    assert found.keys == search.Tally(1, 1, 1)
    # Each ancestor has one match: its four children are tested, and the coarsest level once.
    depth = sampling.grid.depth
    assert found.hierarchy.verified == sampling.analysis.grid.count(depth) + 4 * (depth - 1)


def test_more_components_leave_fewer_structures():
    sampling = sampled(alpha=0.4)
    left = [search.survey(sampling, 1, components).keys for components in (1, 2, 4)]
    assert [each.keys // search.survey(sampling, 1, 1).locations for each in left] == [3, 9, 81]
    assert left[0].verified > left[1].verified > left[2].verified


def test_one_colour_is_one_key():
    sampling = synthesize(np.full((32, 32, 1), 0.5, np.float32), "de-bonet").details.sampling
    index = search.KeyIndex(sampling, 1)
    assert index.distinct == 1
    assert search.search(sampling, 0, 0, 1).matches.size == index.structures


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0, 0, 0), "level: must be a whole number from 1 to"),
        ((0, 99, 1), "column: must be a whole number from 0 to 31, got 99"),
        ((0, 0, 1, 7), "components: must be a whole number from 1 to 6, got 7"),
    ],
)
def test_what_cannot_be_searched_is_refused(arguments, message):
    with pytest.raises(ParamError, match=message):
        search.search(sampled(), *arguments)
