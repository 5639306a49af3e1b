"""Heeger-Bergen: what must hold of every result."""

from __future__ import annotations

import numpy as np
import pytest

from texlab_core.images import as_exemplar
from texlab_core.methods.heeger_bergen import HeegerBergenParams
from texlab_core.run import AnalysisCache, Job, run


def texture(shape=(48, 64), channels=1, seed=0):
    """Smoothed noise with some orientation, in 8-bit steps."""
    rng = np.random.default_rng(seed)
    noise = rng.random((*shape, channels))
    smooth = noise + np.roll(noise, 1, 0) + np.roll(noise, 1, 1) + np.roll(noise, (2, 1), (0, 1))
    mixed = smooth @ (rng.random((channels, channels)) + np.eye(channels))
    return np.round(255 * (mixed - mixed.min()) / np.ptp(mixed)).astype(np.uint8)


def make(image, size=None, seed=0, **params):
    exemplar = as_exemplar(image)
    return run(
        Job(
            method="heeger-bergen",
            inputs={"exemplar": exemplar},
            params=HeegerBergenParams(**params),
            size=size,
            seed=seed,
        )
    )


@pytest.mark.parametrize("params", [{}, {"pyramid": "laplacian"}, {"pyramid": "textbook"}, {"iterations": 0}])
@pytest.mark.parametrize("shape", [(48, 64), (37, 41), (5, 7)])
def test_a_gray_result_has_the_very_values_of_the_exemplar(params, shape):
    image = texture(shape)
    result = make(image, **params)
    expected = np.sort(as_exemplar(image).pixels, axis=None)
    np.testing.assert_array_equal(np.sort(result.image, axis=None), expected)
    assert result.measures["w1-pixels"] == 0
    assert np.any(result.image != as_exemplar(image).pixels)


@pytest.mark.parametrize("palette", ["off", "transport"])
def test_a_colour_result_has_the_channels_values(palette):
    image = texture((40, 48), 3)
    result = make(image, palette=palette)
    pixels = as_exemplar(image).pixels
    for channel in range(3):
        np.testing.assert_array_equal(
            np.sort(result.image[..., channel], axis=None), np.sort(pixels[..., channel], axis=None)
        )


@pytest.mark.parametrize("pyramid", ["steerable", "laplacian"])
def test_the_bands_come_closer_round_by_round(pyramid):
    curve = make(texture((64, 64)), pyramid=pyramid).curves["mean-distance"].y
    assert curve.size == 6
    assert np.all(np.diff(curve) < 0)
    assert curve[-1] < 0.4 * curve[0]


def test_equal_channels_give_equal_channels():
    gray = texture((32, 32))
    result = make(np.repeat(gray, 3, axis=2))
    assert np.all(result.image == result.image[..., :1])


@pytest.mark.parametrize("value", [77, (10, 200, 30)])
def test_a_constant_image_stays_what_it_is(value):
    image = np.full((9, 12, 3), value, np.uint8)
    result = make(image, (20, 15))
    np.testing.assert_array_equal(
        result.image, np.broadcast_to(as_exemplar(image).pixels[0, 0], result.image.shape)
    )
    assert result.notes == ("The exemplar is constant, and so is the result.",)


def test_the_analysis_is_used_again_when_only_the_synthesis_changes():
    exemplar, cache = as_exemplar(texture((32, 32), 3)), AnalysisCache()
    models = [
        run(Job(method="heeger-bergen", inputs={"exemplar": exemplar}, params=params), cache=cache).model
        for params in (
            HeegerBergenParams(),
            HeegerBergenParams(iterations=1, matching="bins", palette="transport"),
            HeegerBergenParams(scales=2),
        )
    ]
    assert models[0] is models[1]
    assert models[0] is not models[2]


def test_as_many_scales_as_fit_are_used_and_said():
    result = make(texture((64, 64)), (20, 17), scales=5)
    assert result.image.shape == (20, 17, 1)
    assert result.notes == ("3 of 5 scales fit an exemplar of 64 x 64 and a result of 17 x 20 pixels.",)
    assert make(texture((64, 64)), (64, 64), scales=5).notes == ()
