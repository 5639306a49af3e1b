"""Principal axes of colours and transport of palettes."""

from __future__ import annotations

import numpy as np
import pytest

from texlab_core.engine.streams import Streams
from texlab_core.methods.heeger_bergen.palette import transport_palette
from texlab_core.transforms.colour import combine, interleave, principal_axes, principal_axes_task
from texlab_core.work.tasks import finish


def colours(shape=(40, 50), seed=0):
    """Colours along known directions with standard deviations 0.1, 0.05 and 0.02."""
    rng = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    planes = rng.normal(size=(*shape, 3)) * [0.1, 0.05, 0.02]
    return (0.5 + planes @ turn.T).astype(np.float32), turn


def test_planes_have_mean_zero_variance_one_and_no_correlation():
    image, _ = colours()
    planes = principal_axes(image).to_axes(image)
    assert planes.shape == (3, 40, 50)
    assert planes.dtype == np.float32
    np.testing.assert_allclose(planes.mean(axis=(1, 2)), 0, atol=1e-5)
    np.testing.assert_allclose(np.cov(planes.reshape(3, -1), bias=True), np.eye(3), atol=1e-4)


def test_axes_are_those_the_colours_were_made_with():
    image, turn = colours((300, 300))
    axes = principal_axes(image)
    np.testing.assert_allclose(axes.spread, [0.1, 0.05, 0.02], rtol=0.02)
    np.testing.assert_allclose(np.abs(axes.directions @ turn), np.eye(3), atol=0.03)
    largest = np.argmax(np.abs(axes.directions), axis=1)
    assert np.all(axes.directions[np.arange(3), largest] > 0)


def test_going_to_the_axes_and_back_gives_the_image():
    image, _ = colours()
    axes = principal_axes(image)
    np.testing.assert_allclose(finish(axes.from_axes(axes.to_axes(image))), image, atol=1e-6)


def test_axes_without_spread_are_dropped():
    image, _ = colours()
    line = 0.5 + (image[..., :1] - 0.5) * np.float32([1, 0.5, 0.2])
    assert principal_axes(line).directions.shape == (1, 3)
    np.testing.assert_allclose(
        finish(principal_axes(line).from_axes(principal_axes(line).to_axes(line))), line, atol=1e-6
    )
    flat = np.broadcast_to(np.float32([0.1, 0.5, 0.9]), (6, 7, 3))
    assert principal_axes(flat).directions.shape == (0, 3)
    # One faint axis is all that there is, and it is kept.
    faint = np.float32(0.5) + (line - np.float32(0.5)) * np.float32(1e-3)
    assert principal_axes(faint).directions.shape == (1, 3)


def test_combinations_are_matrix_products():
    rng = np.random.default_rng(0)
    planes, matrix, offset = (
        rng.normal(size=(3, 8, 9)).astype(np.float32),
        rng.normal(size=(2, 3)),
        np.array([1.0, -2.0]),
    )
    expected = np.tensordot(matrix, planes, 1) + offset[:, None, None]
    np.testing.assert_allclose(finish(combine(planes, matrix, offset)), expected, atol=1e-5)
    np.testing.assert_array_equal(finish(interleave(planes)), np.moveaxis(planes, 0, -1))


def nearest(image, palette):
    """Mean distance of an image's colours to the nearest of a palette."""
    from scipy.spatial import cKDTree

    return cKDTree(palette.reshape(-1, 3)).query(image.reshape(-1, 3))[0].mean()


@pytest.mark.parametrize("shape", [(40, 40), (30, 50)])
def test_transport_brings_the_colours_to_the_palette(shape):
    # Two clouds of colours, and an image with the same channels' histograms but all mixtures of them.
    rng = np.random.default_rng(3)
    red = rng.random((40, 40, 1)) < 0.5
    palette = np.where(red, [0.8, 0.2, 0.3], [0.2, 0.7, 0.6]) + rng.normal(0, 0.02, (40, 40, 3))
    palette = palette.astype(np.float32)
    mixed = np.stack(
        [rng.permutation(palette[..., c].ravel())[: np.prod(shape)].reshape(shape) for c in range(3)], -1
    )
    before = nearest(mixed, palette)
    after = nearest(finish(transport_palette(mixed, palette, 16, Streams(0))), palette)
    assert before > 0.1
    assert after < 0.25 * before


def test_transport_ends_with_the_channels_own_histograms_and_follows_its_seed():
    image, _ = colours()
    other, _ = colours(seed=5)
    moved = finish(transport_palette(other, image, 3, Streams(1)))
    for channel in range(3):
        np.testing.assert_array_equal(
            np.sort(moved[..., channel], axis=None), np.sort(image[..., channel], axis=None)
        )
    np.testing.assert_array_equal(moved, finish(transport_palette(other, image, 3, Streams(1))))
    assert np.any(moved != finish(transport_palette(other, image, 3, Streams(2))))
    np.testing.assert_array_equal(other, colours(seed=5)[0])


def test_transport_of_the_palette_itself_changes_nothing_but_rounding():
    image, _ = colours()
    np.testing.assert_allclose(finish(transport_palette(image, image, 4, Streams(0))), image, atol=1e-5)


def test_axes_in_pieces_have_the_bits_of_the_whole():
    # More than two blocks of rows; a strong offset shows any other order of summation.
    image, _ = colours((500, 701))
    image = image * np.float32(3.7) + np.float32(100)
    flat = image.reshape(-1, 3)
    mean = flat.mean(axis=0, dtype=np.float64)
    centred = (flat - mean).T.copy()
    covariance = np.array([[np.mean(one * other) for other in centred] for one in centred])
    pieces = principal_axes_task(image)
    most = 0
    while True:
        try:
            most = max(most, next(pieces))
        except StopIteration as end:
            axes = end.value
            break
    assert most <= 2**19
    np.testing.assert_array_equal(axes.mean, mean)
    np.testing.assert_array_equal(axes.spread, np.sqrt(np.linalg.eigh(covariance)[0][::-1]))
