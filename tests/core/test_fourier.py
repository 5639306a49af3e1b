"""Fourier transforms in pieces, and the periodic part of an image."""

from __future__ import annotations

import numpy as np
import pytest

from texlab_core.transforms import fourier, steerable
from texlab_core.work.tasks import finish
from texlab_core.work.threads import use_workers


def picture(shape, dtype=np.float64):
    return np.random.default_rng(1).random(shape).astype(dtype)


def neighbours(image, *, periodic):
    """Sum of the differences to the four neighbours; beyond the border are none, or the other side's."""
    total = np.zeros_like(image)
    for axis in (0, 1):
        for shift, edge in ((1, 0), (-1, -1)):
            difference = np.roll(image, shift, axis) - image
            if not periodic:
                np.moveaxis(difference, axis, 0)[edge] = 0
            total += difference
    return total


@pytest.mark.parametrize("shape", [(64, 64), (37, 40), (40, 37), (1, 9)])
@pytest.mark.parametrize(("dtype", "tolerance"), [(np.float32, 1e-6), (np.float64, 1e-14)])
def test_pieces_are_the_transform(monkeypatch, shape, dtype, tolerance):
    image = picture(shape, dtype)
    expected = np.fft.rfft2(image.astype(np.float64), norm="forward")
    for large in (fourier.LARGE, 0):
        monkeypatch.setattr(fourier, "LARGE", large)
        spectrum = finish(fourier.rfft2(image))
        assert spectrum.dtype == np.result_type(dtype, np.complex64)
        np.testing.assert_allclose(spectrum, expected, atol=tolerance)
        back = finish(fourier.irfft2(spectrum, shape))
        assert back.dtype == dtype
        np.testing.assert_allclose(back, image, atol=tolerance)


@pytest.mark.parametrize("shape", [(64, 64), (45, 38)])
def test_a_pyramid_of_a_large_plane_is_that_of_a_small_one(monkeypatch, shape):
    image = picture(shape)
    expected = steerable.build(image, 3, 4)
    monkeypatch.setattr(fourier, "LARGE", 0)
    found = steerable.build(image, 3, 4)
    for (_, one), (_, other) in zip(found.items(), expected.items(), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-14)
    np.testing.assert_allclose(steerable.collapse(found), image, atol=1e-13)


@pytest.mark.slow
def test_a_really_large_plane_does_not_depend_on_threads():
    image = picture((1449, 1450), np.float32)
    assert image.size > fourier.LARGE
    with use_workers(1):
        one = finish(fourier.rfft2(image))
        back = finish(fourier.irfft2(one.copy(), image.shape))
    with use_workers(2):
        two = finish(fourier.rfft2(image))
        np.testing.assert_array_equal(one, two)
        np.testing.assert_array_equal(finish(fourier.irfft2(two, image.shape)), back)
    np.testing.assert_allclose(back, image, atol=2e-6)


@pytest.mark.parametrize("shape", [(24, 33), (32, 32), (1, 7), (5, 2)])
def test_the_periodic_part_has_the_image_inside_and_no_border(shape):
    # Moisan's definition: its periodic Laplacian is the image's Laplacian that knows of no other side.
    image = picture(shape)
    periodic = fourier.periodic_component(image)
    np.testing.assert_allclose(neighbours(periodic, periodic=True), neighbours(image, periodic=False), atol=1e-13)
    assert periodic.mean() == pytest.approx(image.mean())


def test_a_ramp_loses_its_jump_and_a_periodic_image_nothing():
    ramp = np.linspace(0, 1, 50)[None, :].repeat(40, axis=0)
    periodic = fourier.periodic_component(ramp.astype(np.float32))
    assert periodic.dtype == np.float32
    assert np.abs(periodic[:, 0] - periodic[:, -1]).max() < 0.03
    # A jump is a difference between opposite borders: an image that has none keeps every value.
    closed = picture((20, 20))
    closed[-1], closed[:, -1] = closed[0], closed[:, 0]
    closed[-1, -1] = closed[0, 0]
    np.testing.assert_allclose(fourier.periodic_component(closed), closed, atol=1e-14)


@pytest.mark.parametrize("shape", [(64, 64), (37, 40), (1, 9)])
@pytest.mark.parametrize("kind", [np.float32, np.complex64])
def test_whole_spectra_in_pieces_are_the_transform(monkeypatch, shape, kind):
    image = picture(shape).astype(kind) * (1 if kind == np.float32 else 1 + 2j)
    for large in (fourier.LARGE, 0):
        monkeypatch.setattr(fourier, "LARGE", large)
        spectrum = finish(fourier.fft2(image))
        assert spectrum.dtype == np.complex64
        np.testing.assert_allclose(spectrum, np.fft.fft2(image), atol=1e-3)
        np.testing.assert_allclose(finish(fourier.ifft2(spectrum)), image, atol=1e-5)


def test_the_periodic_part_is_found_in_pieces(monkeypatch):
    image = picture((700, 701))
    expected = fourier.periodic_component(image)
    monkeypatch.setattr(fourier, "LARGE", 0)
    assert len(list(fourier.periodic_component_task(image))) >= 4
    np.testing.assert_allclose(fourier.periodic_component(image), expected, atol=1e-13)


def test_channels_lose_their_jumps_one_by_one():
    image = picture((9, 12, 3))
    periodic = fourier.periodic_component(image)
    for channel in range(3):
        np.testing.assert_array_equal(periodic[..., channel], fourier.periodic_component(image[..., channel]))
