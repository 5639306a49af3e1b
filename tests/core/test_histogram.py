"""Histogram matching, distances and moments against brute force and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from texlab_core.kernels import ranks
from texlab_core.stats import histogram
from texlab_core.stats.distances import w1, w1_sorted
from texlab_core.stats.moments import moments
from texlab_core.work.tasks import finish


def sample(count, seed=1):
    return np.random.default_rng(seed).laplace(size=count).astype(np.float32)


def splitmix(key, index):
    mask = 2**64 - 1
    mixed = (key + (index + 1) * 0x9E3779B97F4A7C15) & mask
    mixed = ((mixed ^ (mixed >> 30)) * 0xBF58476D1CE4E5B9) & mask
    mixed = ((mixed ^ (mixed >> 27)) * 0x94D049BB133111EB) & mask
    return mixed ^ (mixed >> 31)


def rank_order(values, key):
    """Indices in the order of their values, equal ones shuffled from the inside out."""
    order = sorted(range(len(values)), key=lambda index: (values[index], index))
    run = 0
    for place in range(1, len(order)):
        if values[order[place]] != values[order[place - 1]]:
            run = place
            continue
        other = run + splitmix(key, order[place]) % (place - run + 1)
        order[place], order[other] = order[other], order[place]
    return order


@pytest.mark.parametrize("target_count", [1, 2, 300, 500, 777])
def test_rank_matching_is_brute_force_bit_for_bit(target_count):
    values = np.round(sample(500), 1)  # many ties
    values[:20] = -0.0
    values[20:40] = 0.0
    target = histogram.sorted_sample(sample(target_count, 2))
    expected = np.empty(500, np.float32)
    expected[rank_order(values.tolist(), 99)] = histogram.resample(target, 500)
    np.testing.assert_allclose(histogram.match_ranks(values, target, 99), expected, rtol=0, atol=1e-6)
    if target_count == 500:
        np.testing.assert_array_equal(histogram.match_ranks(values, target, 99), expected)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(st.floats(width=32, allow_nan=False, allow_infinity=False), min_size=1, max_size=40),
    st.integers(0, 2**64 - 1),
)
def test_any_floats_are_ranked_as_they_compare(values, key):
    values = np.array(values, np.float32)
    target = np.arange(values.size, dtype=np.float32)
    matched = histogram.match_ranks(values, target, key)
    assert sorted(matched.tolist()) == target.tolist()
    order = np.argsort(matched)
    assert np.all(np.diff(values[order]) >= 0)


def test_equal_size_gives_exactly_the_target_and_the_order_is_kept():
    values, target = sample((200, 300)), histogram.sorted_sample(sample(60000, 5))
    matched = histogram.match_ranks(values, target)
    np.testing.assert_array_equal(np.sort(matched, axis=None), target)
    order = np.lexsort((matched.ravel(), values.ravel()))
    assert np.all(np.diff(matched.ravel()[order]) >= 0)


def test_matching_a_sample_with_itself_changes_nothing():
    values = sample((64, 64))
    np.testing.assert_array_equal(histogram.match_ranks(values, histogram.sorted_sample(values), 3), values)


def test_a_constant_area_is_filled_at_random():
    # Forsyth and Ponce's binary image: half of a constant image becomes white, and no place is preferred.
    target = np.repeat(np.float32([0, 1]), 2048)
    halves = [histogram.match_ranks(np.zeros((64, 64)), target, key)[:32].mean() for key in range(50)]
    assert abs(np.mean(halves) - 0.5) < 0.01
    assert 0.001 < np.std(halves) < 0.03
    one = histogram.match_ranks(np.zeros(4096), target, 1)
    assert abs(np.corrcoef(one[:-1], one[1:])[0, 1]) < 0.06
    assert np.any(one != histogram.match_ranks(np.zeros(4096), target, 2))


@pytest.mark.parametrize("values", [sample(2 * ranks.CHUNK + 12345), np.round(sample(ranks.CHUNK + 1), 1)])
def test_pieces_give_the_bits_of_the_whole(values):
    target = histogram.sorted_sample(sample(50000, 4))
    whole, pieces = values.copy(), values.copy()
    change = ranks.match(whole, target, np.uint64(8)) / values.size
    steps = histogram.match_ranks_in_place(pieces, target, 8)
    for _ in range(7 * -(-values.size // ranks.CHUNK)):
        next(steps)
    with pytest.raises(StopIteration) as end:
        next(steps)
    np.testing.assert_array_equal(pieces, whole)
    assert end.value.value == pytest.approx(change, rel=1e-12)
    np.testing.assert_array_equal(histogram.match_ranks(values, target, 8), whole)


def test_warming_up_runs_every_kernel(monkeypatch):
    names = ["match", "count", "starts", "scatter_first", "scatter_next", "shuffle_ties", "assign"]
    called = set()
    for name in names:
        kernel = getattr(ranks, name)
        monkeypatch.setattr(
            ranks, name, lambda *given, name=name, kernel=kernel: (called.add(name), kernel(*given))[1]
        )
    histogram.warm_up()
    assert called == set(names)


@pytest.mark.parametrize("values", [np.zeros((4, 4)), np.zeros((4, 4), np.float32)[:, ::2]])
def test_in_place_needs_an_array_that_can_be_overwritten(values):
    with pytest.raises(ValueError, match="contiguous float32"):
        finish(histogram.match_ranks_in_place(values, np.zeros(3, np.float32), 0))


def test_the_change_is_the_distance():
    values, target = sample(5000), histogram.sorted_sample(sample(5000, 2) * 2)
    steps = histogram.match_ranks_in_place(values.copy(), target, 0)
    assert finish(steps) == pytest.approx(w1(values, target), rel=1e-6)


def test_resampling_a_target():
    target = np.float32([0, 1, 4])
    np.testing.assert_allclose(histogram.resample(target, 6), [0, 0.25, 0.75, 1.75, 3.25, 4])
    np.testing.assert_allclose(histogram.resample(target, 1), [1])
    assert histogram.resample(target, 3) is target


def test_tables_are_the_cdf_and_its_inverse():
    tables = histogram.tables(np.float32([0, 0, 1, 4]), bins=4)
    np.testing.assert_allclose(tables.cdf, [0, 0.5, 0.75, 0.75, 1])
    np.testing.assert_allclose(tables.inverse[[0, 1, 2, 4]], [0, 0.5, 1, 4])
    assert (tables.low, tables.high) == (0, 4)


def match_tables(values, target):
    matched = np.array(values, np.float32, order="C")
    finish(histogram.match_tables_in_place(matched, target))
    return matched


@pytest.mark.parametrize(("bins", "bound"), [(histogram.PAPER_BINS, 0.05), (histogram.PREVIEW_BINS, 1e-3)])
def test_tables_come_close_and_more_bins_come_closer(bins, bound):
    values, target = sample((256, 256)), np.random.default_rng(3).normal(size=(200, 300)).astype(np.float32)
    matched = match_tables(values, histogram.tables(histogram.sorted_sample(target), bins))
    assert matched.shape == values.shape
    assert matched.dtype == np.float32
    assert w1(matched, target) / target.std() < bound
    assert np.all(np.diff(matched.ravel()[np.argsort(values, axis=None)]) >= -1e-6)


def test_tables_keep_equal_values_equal():
    matched = match_tables(np.full(100, 0.5), histogram.tables(histogram.sorted_sample(sample(100))))
    assert np.ptp(matched) == 0
    constant = match_tables(sample(100), histogram.tables(np.full(7, 0.5)))
    np.testing.assert_allclose(constant, 0.5)


@pytest.mark.parametrize(("first", "second"), [(5, 5), (3, 7), (12, 18), (1, 100)])
def test_w1_is_the_area_between_the_quantile_functions(first, second):
    one, two = sample(first), sample(second, 2)
    # On the common refinement of both grids every quantile function is constant.
    expected = np.abs(np.sort(np.repeat(one, second)).astype(float) - np.sort(np.repeat(two, first))).mean()
    assert w1(one, two) == pytest.approx(expected, rel=1e-12)
    assert w1(two, one) == pytest.approx(expected, rel=1e-12)


def test_w1_of_a_shift_is_the_shift():
    values = sample((30, 20)).astype(np.float64)
    assert w1(values, values + 0.25) == pytest.approx(0.25)
    assert w1_sorted(np.zeros(3), np.ones(7)) == pytest.approx(1)


def test_moments_of_known_samples():
    found = moments(np.float32([[0, 0], [0, 1]]))
    assert found.mean == pytest.approx(0.25)
    assert found.sd == pytest.approx(np.sqrt(3) / 4)
    assert found.skewness == pytest.approx(2 / np.sqrt(3))
    assert found.kurtosis == pytest.approx(7 / 3)
    assert (found.low, found.high) == (0, 1)
    constant = moments(np.full(5, 0.3))
    assert (constant.sd, constant.skewness, constant.kurtosis) == (0, 0, 0)
    normal = moments(np.random.default_rng(0).normal(size=200000))
    assert normal.kurtosis == pytest.approx(3, abs=0.05)
