"""Gaussian and Laplacian pyramids against the definition, written out sample by sample."""

from __future__ import annotations

import numpy as np
import pytest

from texlab_core.transforms import gaussian, laplacian

SIZES = [(1, 1), (1, 2), (2, 1), (2, 3), (5, 4), (1, 9), (37, 41), (64, 32)]
BORDERS = ["reflect", "periodic"]


def extend(index, length, border):
    """Index of the sample that stands at ``index`` on an axis that goes on beyond its border."""
    if border == "periodic":
        return index % length
    if length == 1:
        return 0
    index = abs(index) % (2 * length - 2)
    return min(index, 2 * length - 2 - index)


def reduce_axis(image, axis, border):
    length = image.shape[axis]
    matrix = np.zeros((-(-length // 2), length))
    for row in range(matrix.shape[0]):
        for offset, weight in zip(range(-2, 3), gaussian.BINOMIAL, strict=True):
            matrix[row, extend(2 * row + offset, length, border)] += weight
    return np.moveaxis(np.tensordot(matrix, image, (1, axis)), 0, axis)


def expand_axis(image, axis, length, border):
    """Zeros in between, the border continued on the fine grid, twice the filter."""
    coarse = image.shape[axis]
    matrix = np.zeros((length, coarse))
    period = 2 * coarse if border == "periodic" else length
    for row in range(length):
        for offset, weight in zip(range(-2, 3), gaussian.BINOMIAL, strict=True):
            place = extend(row + offset, period, border)
            if place % 2 == 0:
                matrix[row, place // 2] += 2 * weight
    if border == "reflect" and length == 1:
        matrix[:] = 1
    return np.moveaxis(np.tensordot(matrix, image, (1, axis)), 0, axis)


def picture(shape, dtype=np.float64, channels=()):
    return np.random.default_rng(7).random((*shape, *channels)).astype(dtype)


@pytest.mark.parametrize("border", BORDERS)
@pytest.mark.parametrize("shape", SIZES)
@pytest.mark.parametrize(("dtype", "tolerance"), [(np.float32, 3e-7), (np.float64, 1e-15)])
@pytest.mark.parametrize("channels", [(), (1,), (3,), (9,)])
def test_reduce_is_the_binomial_filter_and_every_second_sample(border, shape, dtype, tolerance, channels):
    image = picture(shape, dtype, channels)
    expected = reduce_axis(reduce_axis(image.astype(np.float64), 0, border), 1, border)
    found = gaussian.reduce(image, border)
    assert found.dtype == dtype
    assert found.shape == expected.shape
    np.testing.assert_allclose(found, expected, atol=tolerance, rtol=0)


@pytest.mark.parametrize("border", BORDERS)
@pytest.mark.parametrize("shape", SIZES)
@pytest.mark.parametrize(("dtype", "tolerance"), [(np.float32, 3e-7), (np.float64, 1e-15)])
@pytest.mark.parametrize("channels", [(), (1,), (9,)])
def test_expand_is_zeros_in_between_and_twice_the_filter(border, shape, dtype, tolerance, channels):
    image = picture([-(-side // 2) for side in shape], dtype, channels)
    expected = expand_axis(expand_axis(image.astype(np.float64), 0, shape[0], border), 1, shape[1], border)
    found = gaussian.expand(image, shape, border)
    assert found.dtype == dtype
    assert found.shape == expected.shape
    np.testing.assert_allclose(found, expected, atol=tolerance, rtol=0)


@pytest.mark.parametrize("border", BORDERS)
@pytest.mark.parametrize("shape", SIZES)
def test_a_constant_stays_constant_at_the_borders_too(border, shape):
    image = np.full((*shape, 3), 0.3, np.float32)
    small = gaussian.reduce(image, border)
    np.testing.assert_allclose(small, 0.3, rtol=5e-7)
    np.testing.assert_allclose(gaussian.expand(small, shape, border), 0.3, rtol=1e-6)


def test_periodic_reduce_and_expand_commute_with_shifts_by_two():
    image = picture((32, 48))
    shifted = np.roll(image, (4, -6), axis=(0, 1))
    small = gaussian.reduce(image, "periodic")
    np.testing.assert_allclose(gaussian.reduce(shifted, "periodic"), np.roll(small, (2, -3), (0, 1)), atol=1e-15)
    large = gaussian.expand(small, image.shape, "periodic")
    moved = gaussian.expand(np.roll(small, (2, -3), (0, 1)), image.shape, "periodic")
    np.testing.assert_allclose(moved, np.roll(large, (4, -6), (0, 1)), atol=1e-15)


def test_replicating_expand_makes_blocks():
    image = np.arange(6.0).reshape(2, 3)
    expected = [[0, 0, 1, 1, 2], [0, 0, 1, 1, 2], [3, 3, 4, 4, 5]]
    np.testing.assert_array_equal(gaussian.expand(image, (3, 5), mode="replicate"), expected)


@pytest.mark.parametrize("border", BORDERS)
@pytest.mark.parametrize("mode", ["interpolate", "replicate"])
@pytest.mark.parametrize("shape", [*SIZES, (301, 167)])
@pytest.mark.parametrize(("dtype", "tolerance"), [(np.float32, 3e-7), (np.float64, 5e-16)])
@pytest.mark.parametrize("channels", [(), (3,)])
def test_the_laplacian_pyramid_collapses_to_the_image(border, mode, shape, dtype, tolerance, channels):
    image = picture(shape, dtype, channels)
    bands = laplacian.build(image, 5, border, mode)
    assert len(bands) == 6
    np.testing.assert_allclose(laplacian.collapse(bands, border, mode), image, atol=tolerance, rtol=0)


def test_bands_of_a_constant_are_zero_and_the_residual_is_the_constant():
    bands = laplacian.build(np.full((20, 13), 0.7), 3)
    for band in bands[:-1]:
        np.testing.assert_allclose(band, 0, atol=1e-15)
    np.testing.assert_allclose(bands[-1], 0.7)


def test_levels_until_the_shorter_side_is_one():
    assert [gaussian.max_levels((side, 99)) for side in (1, 2, 3, 4, 5, 64, 65)] == [0, 1, 2, 2, 3, 6, 7]
    pyramid = gaussian.build(picture((37, 99)), gaussian.max_levels((37, 99)))
    assert pyramid[-1].shape[0] == 1
    assert pyramid[-2].shape[0] == 2


def test_the_input_is_left_alone_and_may_be_a_view():
    image = picture((16, 20), np.float32, (3,))
    copy = image.copy()
    view = image[::2, 1:, 1]
    np.testing.assert_array_equal(gaussian.reduce(view), gaussian.reduce(np.ascontiguousarray(view)))
    gaussian.expand(view, (16, 38))
    np.testing.assert_array_equal(image, copy)


@pytest.mark.parametrize(
    "call",
    [
        lambda: gaussian.reduce(np.zeros((4, 4), np.uint8)),
        lambda: gaussian.reduce(np.zeros(4)),
        lambda: gaussian.reduce(np.zeros((0, 4))),
        lambda: gaussian.reduce(np.zeros((4, 4)), "zero"),
        lambda: gaussian.expand(np.zeros((4, 4)), (9, 8)),
        lambda: gaussian.expand(np.zeros((4, 4)), (8, 8), mode="nearest"),
    ],
)
def test_what_does_not_fit_is_refused(call):
    with pytest.raises(ValueError, match=r"\.$"):
        call()
