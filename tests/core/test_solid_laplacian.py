"""The Laplacian pyramid of volumes: against brute force, against the one of images, and back."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from texlab_core.transforms import laplacian, solid_laplacian
from texlab_core.work.tasks import finish

SHAPES = [(1, 1, 1), (2, 3, 5), (8, 8, 8), (7, 9, 16), (37, 41, 20), (1, 16, 16), (16, 2, 9)]
WEIGHTS = np.array([1, 4, 6, 4, 1]) / 16


def volume(shape: tuple[int, ...], dtype: type = np.float32) -> np.ndarray:
    return np.random.Generator(np.random.PCG64(sum(shape))).random(shape).astype(dtype)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("dtype", "error"), [(np.float32, 1e-6), (np.float64, 1e-14)])
def test_a_volume_comes_back(shape: tuple[int, ...], dtype: type, error: float) -> None:
    given = volume(shape, dtype)
    kept = given.copy()
    for levels in range(solid_laplacian.max_levels(shape) + 1):
        bands = finish(solid_laplacian.build(given, levels))
        assert [band.dtype for band in bands] == [dtype] * (levels + 1)
        assert not any(np.shares_memory(band, given) for band in bands)
        for finer, coarser in itertools.pairwise(bands):
            assert coarser.shape == solid_laplacian.reduced_shape(finer.shape)
        assert np.abs(finish(solid_laplacian.collapse(bands)) - given).max() <= error
    np.testing.assert_array_equal(given, kept)


def test_reducing_is_the_periodic_filter_of_five_weights_on_each_axis() -> None:
    given = volume((6, 10, 8), np.float64)
    smooth = given
    for axis in range(3):
        smooth = sum(WEIGHTS[shift + 2] * np.roll(smooth, -shift, axis) for shift in range(-2, 3))
    np.testing.assert_allclose(finish(solid_laplacian.reduce(given)), smooth[::2, ::2, ::2], atol=1e-14)


def test_expanding_is_zeros_in_between_and_eight_times_the_filter() -> None:
    coarse = volume((3, 5, 4), np.float64)
    fine = np.zeros((6, 10, 8))
    fine[::2, ::2, ::2] = 8 * coarse
    for axis in range(3):
        fine = sum(WEIGHTS[shift + 2] * np.roll(fine, -shift, axis) for shift in range(-2, 3))
    for sign in (1, -1):
        found = np.zeros((6, 10, 8))
        finish(solid_laplacian.add_expanded(found, coarse, sign))
        np.testing.assert_allclose(found, sign * fine, atol=1e-14)


def test_the_bands_of_an_image_repeated_in_depth_are_those_of_the_image() -> None:
    image = volume((24, 40), np.float64)
    bands = finish(solid_laplacian.build(np.repeat(image[None], 8, axis=0), 3))
    for band, flat in zip(bands, laplacian.build(image, 3, "periodic"), strict=True):
        np.testing.assert_allclose(band, np.broadcast_to(flat, band.shape), atol=1e-14)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_constant_has_no_bands_at_odd_sides_either(shape: tuple[int, ...]) -> None:
    bands = finish(solid_laplacian.build(np.full(shape, 0.3), solid_laplacian.max_levels(shape)))
    assert all(np.abs(band).max() < 1e-14 for band in bands[:-1])
    np.testing.assert_allclose(bands[-1], 0.3, atol=1e-14)


def test_the_axes_are_alike() -> None:
    given = volume((8, 16, 12), np.float64)
    bands = finish(solid_laplacian.build(given, 2))
    for axes in itertools.permutations(range(3)):
        turned = finish(solid_laplacian.build(np.ascontiguousarray(given.transpose(axes)), 2))
        for band, other in zip(bands, turned, strict=True):
            np.testing.assert_allclose(other, band.transpose(axes), atol=1e-14)


def test_what_cannot_be_used_is_refused() -> None:
    with pytest.raises(ValueError, match="must be \\(D, H, W\\)"):
        finish(solid_laplacian.build(np.zeros((4, 4), np.float32), 1))
    with pytest.raises(ValueError, match="from 0 to 2"):
        finish(solid_laplacian.build(np.zeros((4, 4, 4), np.float32), 3))
    with pytest.raises(ValueError, match="no level below"):
        finish(solid_laplacian.add_expanded(np.zeros((4, 4, 4)), np.zeros((2, 2, 3)), 1))
