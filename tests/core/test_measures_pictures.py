"""V, laid down, tiled and cuts against slow versions of their definitions."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from test_measures_looks import pebbles

from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.measures import cuts
from texlab_core.measures.registry import find_measure
from texlab_core.measures.subject import Subject
from texlab_core.measures.tile_share import tile_share
from texlab_core.measures.visual_difference import laid_down_share, visual_difference, windows
from texlab_core.work.tasks import go_on


def gray(pixels: np.ndarray) -> np.ndarray:
    return pixels[:, :, 0].astype(np.float64) if pixels.shape[2] == 1 else pixels @ np.array([0.299, 0.587, 0.114])


def slow_correlation(patch: np.ndarray, exemplar: np.ndarray) -> float:
    """Return the largest correlation with any place of the exemplar, continued periodically."""
    best = 0.0
    for row in range(exemplar.shape[0]):
        for column in range(exemplar.shape[1]):
            moved = np.roll(exemplar, (-row, -column), axis=(0, 1))[: patch.shape[0], : patch.shape[1]]
            best = max(best, float(np.corrcoef(patch.ravel(), moved.ravel())[0, 1]))
    return best


def test_windows_overlap_by_half_and_reach_the_borders() -> None:
    found = list(windows((20, 33), (8, 10)))
    rows = sorted({each[0].start for each in found})
    columns = sorted({each[1].start for each in found})
    assert (rows[0], rows[-1], columns[0], columns[-1]) == (0, 12, 0, 23)
    assert max(np.diff(rows)) <= 4
    assert max(np.diff(columns)) <= 5
    assert len(found) == len(rows) * len(columns)
    assert list(windows((8, 10), (8, 10))) == [(slice(0, 8), slice(0, 10))]


@pytest.mark.parametrize("channels", [1, 3])
def test_v_is_one_less_the_largest_correlations_of_windows(channels: int) -> None:
    exemplar, image = pebbles(20, 18, channels), pebbles(25, 23, channels, seed=1)
    found = [slow_correlation(gray(image)[place], gray(exemplar)) for place in windows((25, 23), (10, 9))]
    assert visual_difference(Subject.of_images(exemplar, image)) == pytest.approx(1 - np.mean(found), abs=1e-4)


def test_laid_down_is_the_largest_cyclic_correlation_of_blocks() -> None:
    exemplar, image = pebbles(12, 14), pebbles(27, 30, seed=1)
    blocks = [gray(image)[r : r + 12, c : c + 14] for r in (0, 12) for c in (0, 14)]
    expected = np.mean([slow_correlation(each, gray(exemplar)) for each in blocks])
    assert laid_down_share(Subject.of_images(exemplar, image)) == pytest.approx(expected, abs=1e-4)


def test_copies_and_tilings_do_not_differ() -> None:
    exemplar = pebbles(24, 32)
    moved = np.roll(exemplar, (5, 9), axis=(0, 1))
    for image in (exemplar, np.tile(exemplar, (2, 3, 1)), np.tile(moved, (2, 2, 1))):
        subject = Subject.of_images(exemplar, image)
        assert visual_difference(subject) == pytest.approx(0, abs=1e-5)
        assert laid_down_share(subject) == pytest.approx(1, abs=1e-5)


def test_unrelated_noise_differs_more_the_larger_the_windows() -> None:
    rng = np.random.default_rng(0)
    values = [
        visual_difference(Subject.of_images(*(rng.random((side, side, 1), np.float32) for _ in range(2))))
        for side in (32, 64, 128)
    ]
    assert values == sorted(values)
    assert values[-1] > 0.9


def test_flat_windows_match_flat_places_only() -> None:
    exemplar = pebbles(32, 32)
    white = exemplar.copy()
    white[:20, :20] = 1
    blank = np.ones((16, 16, 3), np.float32)
    assert visual_difference(Subject.of_images(white, blank)) == 0
    assert visual_difference(Subject.of_images(exemplar, blank)) == 1
    assert visual_difference(Subject.of_images(blank, exemplar)) is None
    assert laid_down_share(Subject.of_images(blank, exemplar)) is None
    # Smaller than a window can be, and smaller than the exemplar.
    assert visual_difference(Subject.of_images(pebbles(15, 40), exemplar)) is None
    assert laid_down_share(Subject.of_images(exemplar, pebbles(31, 40))) is None


def test_tile_share_counts_the_most_frequent_offset_of_each_block() -> None:
    rng = np.random.default_rng(2)
    source = rng.integers(0, 3, (11, 13, 2)).astype(np.int32)
    source[rng.random((11, 13)) < 0.1] = -1
    total = 0
    for top in range(0, 11, 3):
        for left in range(0, 13, 4):
            counts: Counter[tuple[int, int]] = Counter()
            for row in range(top, min(top + 3, 11)):
                for column in range(left, min(left + 4, 13)):
                    if source[row, column, 0] >= 0:
                        counts[(source[row, column, 0] - row) % 3, (source[row, column, 1] - column) % 4] += 1
            total += max(counts.values(), default=0)
    assert tile_share(source, (3, 4)) == total / (11 * 13)


def test_a_tiling_is_all_tiled_and_pixels_at_random_are_not() -> None:
    exemplar = as_exemplar(pebbles(40, 48))
    measure = find_measure("tile-share")
    shares = {}
    for method in ("tiling", "pixels", "heeger-bergen"):
        result = run(Job(method=method, inputs={"exemplar": exemplar}, size=(70, 90)))
        shares[method] = measure.of(Subject.of_result(result))
    assert shares["tiling"] == 1
    assert shares["pixels"] is not None
    assert shares["pixels"] < 0.02
    assert shares["heeger-bergen"] is None


def test_jumps_are_compared_with_those_beside_them() -> None:
    image = np.random.default_rng(3).random((9, 7, 3)).astype(np.float32)
    for place, part in enumerate((slice(None), slice(0, 3), slice(3, 7))):
        step = [float(np.mean(np.abs(image[r + 1, part] - image[r, part]))) for r in range(8)]
        expected = [step[r] - (step[max(r - 1, 1 - r)] + step[r + 1 if r < 7 else 6]) / 2 for r in range(8)]
        np.testing.assert_allclose(cuts.jumps(image, go_on)[place], expected, atol=1e-6)


@pytest.mark.parametrize("axis", ["row", "column"])
@pytest.mark.parametrize("part", ["whole", "first half", "second half"])
def test_the_cut_is_found_where_it_is(axis: str, part: str) -> None:
    exemplar = pebbles(64, 64)
    image = pebbles(96, 96, seed=7) * np.float32(0.8)
    along = {"whole": slice(None), "first half": slice(0, 48), "second half": slice(48, 96)}[part]
    # It fades out, so that the half has no other edge.
    image[31:, along] += (0.2 * np.exp(-np.arange(65) / 4)).astype(np.float32)[:, None, None]
    if axis == "column":
        image = image.transpose(1, 0, 2)
    subject = Subject.of_images(exemplar, image)
    found = cuts.largest_cut(subject)
    assert found is not None
    assert (found.axis, found.line) == (axis, 30)
    # Half of a whole cut may happen to stand out a little more.
    assert found.part == part or part == "whole"
    assert find_measure("cuts").of(subject) == found.value
    assert found.value > 2 * (cuts.own_cut(subject) or 0)


def test_cuts_are_in_robust_deviations_of_the_exemplars_lines() -> None:
    exemplar = pebbles(40, 48)
    values = cuts.jumps(exemplar, go_on)[0]
    middle = np.median(values)
    spread = 1.4826 * np.median(np.abs(values - middle))
    assert cuts.usual(exemplar, go_on)["row"] == (pytest.approx(middle), pytest.approx(spread))
    itself = Subject.of_images(exemplar, exemplar)
    assert find_measure("own-cuts").of(itself) == find_measure("cuts").of(itself)
    assert find_measure("cuts").of(Subject.of_images(exemplar, exemplar[:12])) is None
    assert find_measure("own-cuts").of(Subject.of_images(exemplar[:12], exemplar)) is None
