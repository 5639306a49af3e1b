"""Steerable pyramid against its closed forms: reconstruction, energy, sinusoids, shifts."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import pytest

from texlab_core.transforms import filters, steerable
from texlab_core.work.kept import ARRAYS, ArrayCache
from texlab_core.work.tasks import finish
from texlab_core.work.threads import use_workers

SIZES = [(37, 41), (17, 64), (301, 167), (512, 512)]
ORIENTATIONS = [1, 2, 4, 6, 18]


def picture(shape, dtype=np.float64, seed=3):
    return np.random.default_rng(seed).random(shape).astype(dtype)


def planes(pyramid):
    return [plane for _, plane in pyramid.items()]


@pytest.mark.parametrize("orientations", ORIENTATIONS)
@pytest.mark.parametrize("shape", [*SIZES, (1, 1), (2, 3), (5, 4), (1, 64)])
@pytest.mark.parametrize(("dtype", "tolerance"), [(np.float32, 5e-6), (np.float64, 1e-13)])
def test_collapse_gives_the_image_back(orientations, shape, dtype, tolerance):
    image = picture(shape, dtype)
    pyramid = steerable.build(image, min(4, steerable.max_levels(shape)), orientations)
    assert all(plane.dtype == dtype for plane in planes(pyramid))
    found = steerable.collapse(pyramid)
    assert found.dtype == dtype
    np.testing.assert_allclose(found, image, atol=tolerance, rtol=0)


@pytest.mark.parametrize("orientations", range(1, 19))
def test_every_number_of_orientations_keeps_the_energy(orientations):
    # A tight frame: the mean squares of the subbands add up to the image's.
    image = picture((45, 64))
    pyramid = steerable.build(image, 3, orientations)
    energy = sum(np.mean(plane**2) for plane in planes(pyramid))
    assert energy == pytest.approx(np.mean(image**2), rel=1e-13)


@pytest.mark.parametrize("orientations", [1, 2, 3, 4, 5, 6])
@pytest.mark.parametrize("level", [0, 1, 2])
def test_a_wave_gives_the_closed_form(orientations, level):
    # Wave numbers that lie inside the band, at no special angle.
    height, width, row, column = 128, 96, 22 >> level, 11 >> level
    down, right = np.mgrid[:height, :width]
    phase = 2 * np.pi * (row * down / height + column * right / width) + 0.3
    pyramid = steerable.build(np.cos(phase), 3, orientations)
    rise, run = 2 * np.pi * row / height, 2 * np.pi * column / width
    radius, theta = math.hypot(rise, run), math.atan2(rise, run)
    cut = np.pi / 2**level
    fall = math.cos(math.pi / 2 * min(max(1 + math.log2(radius / cut), 0), 1)) if radius < cut else 0
    growth = math.sin(math.pi / 2 * min(max(1 + math.log2(2 * radius / cut), 0), 1))
    power = orientations - 1
    alpha = 2**power * math.factorial(power) / math.sqrt(orientations * math.factorial(2 * power))
    step = 2**level
    for index, band in enumerate(pyramid.bands[level]):
        gain = alpha * fall * growth * math.cos(theta - math.pi * index / orientations) ** power
        # (-i)^(K-1) delays the wave by a quarter turn for every unit of K - 1.
        expected = gain * np.cos(phase - power * np.pi / 2)[::step, ::step]
        np.testing.assert_allclose(band, expected, atol=1e-13)


@pytest.mark.parametrize("orientations", [1, 2, 4, 5])
def test_a_shift_by_two_to_the_levels_shifts_every_band(orientations):
    image = picture((64, 96))
    first = steerable.build(image, 3, orientations)
    second = steerable.build(np.roll(image, (16, -24), (0, 1)), 3, orientations)
    for (key, one), (_, other) in zip(first.items(), second.items(), strict=True):
        step = 2**key.level
        np.testing.assert_allclose(other, np.roll(one, (16 // step, -24 // step), (0, 1)), atol=1e-14)


def test_sizes_of_the_levels_and_mean_of_the_residual():
    image = picture((37, 41))
    pyramid = steerable.build(image, 4, 3)
    assert [row[0].shape for row in pyramid.bands] == [(37, 41), (19, 21), (10, 11), (5, 6)]
    assert pyramid.lowpass.shape == (3, 3)
    assert pyramid.lowpass.mean() == pytest.approx(image.mean(), abs=1e-14)
    assert (pyramid.levels, pyramid.orientations) == (4, 3)


def test_a_constant_is_in_the_low_residual_alone():
    pyramid = steerable.build(np.full((20, 33), 0.7), 2, 4)
    for plane in planes(pyramid)[:-1]:
        np.testing.assert_allclose(plane, 0, atol=1e-15)
    np.testing.assert_allclose(pyramid.lowpass, 0.7)


def test_places_have_names_and_go_from_fine_to_coarse():
    keys = steerable.band_keys(2, 2)
    assert [key.label for key in keys] == ["high", "l0-o0", "l0-o1", "l1-o0", "l1-o1", "low"]
    assert tuple(key for key, _ in steerable.build(picture((16, 16)), 2, 2).items()) == keys
    assert steerable.build(picture((3, 3)), 0, 4).orientations == 1


def test_orientation_zero_sees_vertical_stripes():
    stripes = np.cos(2 * np.pi * np.arange(64) * 20 / 64)[None, :].repeat(64, axis=0)
    energies = [np.mean(band**2) for band in steerable.build(stripes, 1, 4).bands[0]]
    assert np.argmax(energies) == 0
    assert energies[2] == pytest.approx(0, abs=1e-20)


@pytest.mark.parametrize("shape", [(24, 33), (64, 64)])
def test_mirrored_bands_are_the_first_quadrant_of_the_mirrored_image(shape):
    image = picture(shape)
    mirrored = np.block([[image, image[:, ::-1]], [image[::-1], image[::-1, ::-1]]])
    whole = steerable.build(mirrored, 3, 4)
    part = steerable.build_reflected(image, 3, 4)
    plain = steerable.build(image, 3, 4)
    for (key, found), (_, big), (_, same) in zip(part.items(), whole.items(), plain.items(), strict=True):
        assert found.shape == same.shape, key
        np.testing.assert_array_equal(found, big[: found.shape[0], : found.shape[1]])


def test_mirroring_removes_the_response_to_the_border_of_a_ramp():
    ramp = np.linspace(0, 1, 64)[None, :].repeat(64, axis=0)
    wrapped = steerable.build(ramp, 2, 4).bands[0][0]
    reflected = steerable.build_reflected(ramp, 2, 4).bands[0][0]
    assert np.abs(reflected).max() < 0.05 * np.abs(wrapped).max()


def test_levels_leave_a_residual_of_at_least_two_samples():
    assert [steerable.max_levels((side, 200)) for side in (1, 2, 3, 4, 7, 8, 17, 64, 127)] == [
        0,
        0,
        0,
        1,
        1,
        2,
        3,
        5,
        5,
    ]


def test_bits_do_not_depend_on_the_number_of_threads():
    # Above and below the size from which transforms use threads.
    for shape in [(301, 167), (513, 517), (512, 512), (641, 422)]:
        image = picture(shape, np.float32)
        with use_workers(1):
            one = steerable.build(image, 4, 4)
            back = steerable.collapse(one)
        for count in (2, 3):
            with use_workers(count):
                two = steerable.build(image, 4, 4)
                np.testing.assert_array_equal(steerable.collapse(two), back)
            for first, second in zip(planes(one), planes(two), strict=True):
                np.testing.assert_array_equal(first, second)


def test_the_image_is_left_alone():
    image = picture((33, 20), np.float32)
    copy = image.copy()
    steerable.collapse(steerable.build(image, 2, 4))
    np.testing.assert_array_equal(image, copy)


@pytest.mark.parametrize(
    ("shape", "dtype", "levels", "orientations"),
    [
        ((8, 8, 3), np.float32, 1, 4),
        ((0, 8), np.float32, 0, 4),
        ((8, 8), np.int32, 1, 4),
        ((8, 8), np.float32, 3, 4),
        ((8, 8), np.float32, -1, 4),
        ((8, 8), np.float32, 1, 0),
        ((8, 8), np.float32, 1, 19),
    ],
)
def test_what_does_not_fit_is_refused(shape, dtype, levels, orientations):
    with pytest.raises(ValueError, match=r"got .*\."):
        steerable.build(np.zeros(shape, dtype), levels, orientations)


def made_of(count, value):
    yield count
    return np.full(count, float(value))


def test_filters_are_read_only_and_the_cache_is_bounded():
    mask = finish(filters.highpass((16, 16), np.dtype(np.float32)))
    assert mask is finish(filters.highpass((16, 16), np.dtype(np.float32)))
    assert not mask.flags.writeable
    cache = ArrayCache(1000)
    made = [finish(cache.get((number,), partial(made_of, 50, 0))) for number in range(5)]
    assert cache.nbytes == 800
    assert finish(cache.get((4,), partial(made_of, 50, 1))) is made[4]
    assert finish(cache.get((0,), partial(made_of, 50, 1)))[0] == 1
    finish(cache.get(("huge",), partial(made_of, 500, 0)))
    assert cache.nbytes == 4000
    cache.clear()
    assert cache.nbytes == 0


def test_forgotten_filters_are_made_again():
    mask = finish(filters.highpass((16, 16), np.dtype(np.float32)))
    ARRAYS.clear()
    again = finish(filters.highpass((16, 16), np.dtype(np.float32)))
    assert again is not mask
    np.testing.assert_array_equal(again, mask)
