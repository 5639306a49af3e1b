"""Joint and conditional histograms of bands against loops over pixels and closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from texlab_core.errors import ParamError
from texlab_core.measures.registry import find_measure
from texlab_core.measures.subject import Subject
from texlab_core.stats.dependence import (
    AXES,
    BORDER,
    Pair,
    dependence,
    difference,
    eighths,
    joint_ranks,
    mutual_information,
)
from texlab_core.transforms.luma import luma
from texlab_core.transforms.octave_bands import oriented_bands
from texlab_core.work.tasks import go_on

NOISE = np.random.default_rng(5).random((56, 61, 3), np.float32)
PAIRS = (
    Pair(orientation=1),
    Pair("orientation", orientation=3, turn=1),
    Pair("neighbour", orientation=0, offset=(-2, 3)),
    Pair("neighbour", orientation=2, offset=(1, -4)),
)


def both_bands(pair: Pair) -> tuple[dict[tuple[int, int], Any], tuple[int, int]]:
    """Return what is looked at and what is given for every pixel that counts, by the definition."""
    bands = {(k, o): band for k, o, band in oriented_bands(luma(NOISE), 2, go_on)}
    height, width = NOISE.shape[:2]
    found = {}
    for row in range(BORDER, height - BORDER):
        for column in range(BORDER, width - BORDER):
            if pair.relation == "parent":
                parent = bands[1, pair.orientation]
                other = parent[row * parent.shape[0] // height, column * parent.shape[1] // width]
            elif pair.relation == "orientation":
                other = bands[0, (pair.orientation + pair.turn) % 4][row, column]
            else:
                there = row + pair.offset[0], column + pair.offset[1]
                if not (BORDER <= there[0] < height - BORDER and BORDER <= there[1] < width - BORDER):
                    continue
                other = bands[0, pair.orientation][there]
            found[row, column] = bands[0, pair.orientation][row, column], other
    return found, (height, width)


@pytest.mark.parametrize("values", AXES)
@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: f"{pair.relation}-{pair.orientation}")
def test_histograms_places_and_moments_are_those_of_a_loop_over_pixels(pair: Pair, values: Any) -> None:
    samples, size = both_bands(pair)
    keys = list(samples)
    one, other = (np.array([samples[key][side] for key in keys]) for side in (0, 1))
    cells, low, high = AXES[values]
    if values == "ranks":
        axes = [(eighths(np.abs(each)) + 0.5) / 8 for each in (one, other)]
    elif values == "magnitudes":
        axes = [np.log2(np.abs(each) / math.sqrt(float(np.mean(np.abs(each) ** 2)))) for each in (one, other)]
    else:
        axes = [each.real / math.sqrt(float(np.mean(each.real**2))) for each in (one, other)]
    expected, where, columns = np.zeros((cells, cells)), {}, [[] for _ in range(cells)]
    for key, first, second in zip(keys, *axes, strict=True):
        place = [min(max(int((each - low) / (high - low) * cells), 0), cells - 1) for each in (first, second)]
        expected[tuple(place)] += 1 / len(keys)
        where[key] = tuple(place)
        columns[place[1]].append(first)
    found = dependence(NOISE, pair, values)
    # A value on the line between two cells may fall to either side.
    assert np.abs(found.joint - expected).sum() <= 4 / len(keys)
    assert found.joint.sum() == pytest.approx(1)
    for column, inside in enumerate(columns):
        if len(inside) > 30:
            assert found.means[column] == pytest.approx(np.mean(inside), abs=0.02)
            assert found.spreads[column] == pytest.approx(np.std(inside), abs=0.02)
    assert np.isnan(found.means[found.joint.sum(axis=0) == 0]).all()
    sums = found.conditional.sum(axis=0)
    np.testing.assert_allclose(sums, found.joint.sum(axis=0) > 0, atol=1e-12)
    # Every pixel leads to its cell, and every rectangle of cells to its pixels.
    told = {(row, column): found.cells(row, column) for row in range(size[0]) for column in range(size[1])}
    assert {key for key, each in told.items() if each} == set(keys)
    assert sum(told[key] == (where[key],) for key in keys) >= len(keys) - 4
    middle = cells // 2
    rectangle = (middle - 1, middle + 1, middle, cells - 1)
    inside = {key for key, each in told.items() if each and abs(each[0][0] - middle) <= 1 and each[0][1] >= middle}
    assert set(map(tuple, np.argwhere(found.pixels(rectangle)).tolist())) == inside
    assert found.cells(-1, 0) == found.cells(size[0], 0) == ()


def test_coarser_levels_have_larger_pixels_and_all_orientations_stand_together() -> None:
    rng = np.random.default_rng(2)
    image = rng.random((170, 200, 1), np.float32)
    for level, relation in ((1, "parent"), (2, "orientation"), (1, "neighbour")):
        each = [dependence(image, Pair(relation, level, orientation)) for orientation in range(4)]
        every = dependence(image, Pair(relation, level))
        np.testing.assert_allclose(every.joint, np.mean([one.joint for one in each], axis=0), atol=1e-12)
        np.testing.assert_array_equal(every.ranks, np.concatenate([one.ranks for one in each]))
        assert every.information == pytest.approx(np.mean([one.information for one in each]))
        whole = every.pixels((0, 32, 0, 32))
        rows, columns = np.flatnonzero(whole.any(axis=1)), np.flatnonzero(whole.any(axis=0))
        # A sample of the border that lies partly within it does not count.
        reach = (BORDER << level) + (1 << level)
        assert abs(rows[0] - (BORDER << level)) <= 1 << level
        assert 200 - reach - (1 << level) - (relation == "neighbour") * 2 <= columns[-1] < 200 - (BORDER << level)
        assert whole[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1].all()


def test_joint_ranks_know_dependence_and_nothing_else() -> None:
    rng = np.random.default_rng(0)
    values = rng.random(64 * 8)
    own = joint_ranks(values, values**3)
    np.testing.assert_allclose(own, np.eye(8) / 8, atol=2 / 512)
    np.testing.assert_allclose(joint_ranks(values, -values), np.eye(8)[::-1] / 8, atol=2 / 512)
    grid = np.mgrid[:80, :80].astype(np.float64)
    np.testing.assert_allclose(joint_ranks(grid[0], grid[1]), 1 / 64, atol=1e-12)


def test_mutual_information_has_closed_forms() -> None:
    values = np.random.default_rng(0).random(4096)
    assert mutual_information(joint_ranks(values, values)) == pytest.approx(3)
    assert mutual_information(joint_ranks(values, -values)) == pytest.approx(3)
    grid = np.mgrid[:64, :64].astype(np.float64)
    assert mutual_information(joint_ranks(grid[0], grid[1])) == pytest.approx(0, abs=1e-12)
    # A binary symmetric channel that errs one time in ten: 1 - H(0.1).
    channel = np.array([[0.45, 0.05], [0.05, 0.45]])
    entropy = -0.1 * math.log2(0.1) - 0.9 * math.log2(0.9)
    assert mutual_information(channel) == pytest.approx(1 - entropy)
    assert difference(channel[None], np.full((1, 2, 2), 0.25)) == pytest.approx(0.4)


def test_noise_knows_nothing_of_far_neighbours_and_a_repeated_row_all() -> None:
    rng = np.random.default_rng(1)
    noise = rng.random((256, 256, 1), np.float32)
    far = dependence(noise, Pair("neighbour", offset=(0, 20)))
    assert far.information < 0.01
    repeated = np.tile(noise[:, :16], (1, 16, 1))
    same = dependence(repeated, Pair("neighbour", offset=(0, 16)))
    assert same.information > 2.9
    np.testing.assert_allclose(same.joint[~np.eye(33, dtype=bool)].sum(), 0, atol=0.02)
    # What is twice as far is not twice as much: the axes of the exemplar are kept.
    half = dependence(0.5 * repeated, Pair("neighbour", offset=(0, 16)), like=same)
    assert np.nanmax(np.abs(half.means)) == pytest.approx(np.nanmax(np.abs(same.means)) / 2, rel=0.1)


def test_the_number_is_that_of_the_measure() -> None:
    other = np.random.default_rng(8).random((70, 64, 3), np.float32)
    pair = Pair()
    assert pair.is_measure
    first, second = dependence(NOISE, pair, "ranks"), dependence(other, pair)
    expected = find_measure("dependence-difference").of(Subject.of_images(NOISE, other))
    assert difference(first.ranks, second.ranks) == expected
    np.testing.assert_allclose(first.joint, first.ranks.mean(axis=0), atol=1e-12)


def test_a_flat_picture_has_nothing_to_say() -> None:
    flat = dependence(np.full((48, 48, 1), 0.5, np.float32), Pair(), "magnitudes")
    assert flat.information == 0
    assert flat.joint.max() == pytest.approx(1)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: Pair("child"), "relation: must be parent, orientation or neighbour, got 'child'"),
        (lambda: Pair(level=4), "level: must be a whole number from 0 to 3, got 4"),
        (lambda: Pair(orientation=4), "orientation: must be a whole number from 0 to 3, got 4"),
        (lambda: Pair(turn=0), "turn: must be a whole number from 1 to 3, got 0"),
        (lambda: Pair("neighbour", offset=(0, 0)), "offset: must be at most 32 each way, and not 0,0"),
        (lambda: dependence(NOISE, Pair(level=1)), "at least 80 pixels high and wide for level 1, got '61 x 56'"),
        (lambda: dependence(NOISE, Pair("neighbour", offset=(32, 0))), "offset: must be small enough"),
        (lambda: dependence(NOISE, Pair(), "phases"), "values: must be one of coefficients, magnitudes, ranks"),
    ],
)
def test_bad_input_is_one_sentence(make: Any, sentence: str) -> None:
    with pytest.raises(ParamError) as raised:
        make()
    assert sentence in str(raised.value)
