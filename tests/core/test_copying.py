from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import label as connected

from texlab_core.errors import InputError
from texlab_core.measures import copying


def identity(height: int, width: int) -> np.ndarray:
    return np.stack(np.mgrid[:height, :width], axis=-1).astype(np.int32)


def brute_share(source: np.ndarray) -> float:
    height, width = source.shape[:2]
    found = pairs = 0
    for row in range(height):
        for column in range(width):
            for step in ((0, 1), (1, 0)):
                if row + step[0] < height and column + step[1] < width:
                    here, there = source[row, column], source[row + step[0], column + step[1]]
                    pairs += here[0] >= 0 and there[0] >= 0
                    found += here[0] >= 0 and there[0] >= 0 and tuple(there - here) == step
    return found / pairs if pairs else float((source[..., 0] >= 0).any())


def brute_areas(source: np.ndarray) -> set[frozenset[int]]:
    offsets = source - identity(*source.shape[:2])
    areas = set()
    for offset in np.unique(offsets.reshape(-1, 2), axis=0):
        labels, count = connected((offsets == offset).all(-1) & (source[..., 0] >= 0))
        for each in range(1, count + 1):
            places = np.flatnonzero(labels == each)
            if places.size > 1:
                areas.add(frozenset(places.tolist()))
    return areas


def test_copy_is_one_area() -> None:
    source = identity(7, 5) + np.int32(3)
    labels, sizes = copying.copied_regions(source)
    assert copying.continuous_share(source) == 1.0
    assert (labels == 1).all()
    assert sizes.tolist() == [0, 35]
    assert copying.largest_copy(sizes) == 1.0


def test_two_tiles() -> None:
    source = np.tile(identity(4, 4), (1, 2, 1))
    labels, sizes = copying.copied_regions(source)
    assert sizes.tolist() == [0, 16, 16]
    assert (labels[:, :4] == 1).all()
    assert (labels[:, 4:] == 2).all()
    assert copying.continuous_share(source) == pytest.approx((4 * 7 + 8 * 3 - 4) / (4 * 7 + 8 * 3))


def test_pixels_without_source_belong_to_nothing() -> None:
    source = np.full((3, 4, 2), -1, np.int32)
    labels, sizes = copying.copied_regions(source)
    assert copying.continuous_share(source) == 0.0
    assert not labels.any()
    assert sizes.tolist() == [12]
    assert copying.largest_copy(sizes) == pytest.approx(1 / 12)


def test_single_pixel() -> None:
    assert copying.continuous_share(np.zeros((1, 1, 2), np.int32)) == 1.0


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 12), st.integers(1, 12), st.integers(0, 2**16), st.integers(1, 3))
def test_equals_brute_force(height: int, width: int, seed: int, spread: int) -> None:
    random = np.random.default_rng(seed)
    source = identity(height, width) + random.integers(0, spread, (height, width, 2)).astype(np.int32)
    source[random.random((height, width)) < 0.1] = -1
    labels, sizes = copying.copied_regions(source)
    found = {frozenset(np.flatnonzero(labels == each).tolist()) for each in range(1, sizes.size)}
    assert found == brute_areas(source)
    assert sizes.tolist() == np.bincount(labels.ravel(), minlength=sizes.size).tolist()
    assert (np.diff(sizes[1:]) <= 0).all()
    assert copying.continuous_share(source) == brute_share(source)


def test_blocks_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(1)
    source = identity(40, 30) + random.integers(0, 2, (40, 30, 2)).astype(np.int32)
    labels, sizes = copying.copied_regions(source)
    share = copying.continuous_share(source)
    monkeypatch.setattr(copying, "_PIXELS_AT_ONCE", 64)
    again, sizes_again = copying.copied_regions(source)
    np.testing.assert_array_equal(again, labels)
    np.testing.assert_array_equal(sizes_again, sizes)
    assert copying.continuous_share(source) == share


def test_wrong_shape_is_refused() -> None:
    with pytest.raises(InputError, match="source map"):
        copying.continuous_share(np.zeros((3, 3), np.int32))
