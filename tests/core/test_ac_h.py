"""AC-H: the measured samples, the spectrum they stand for, and what of it is negative."""

from __future__ import annotations

import numpy as np
import pytest

from tests.core.spectral_tools import ANY, sinusoid, texture, white
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.engine.streams import Streams
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.spectral.acf import PARAMETERS, Acf, measure, shape_noise, spectrum
from texlab_core.methods.spectral.fourier import random_phase
from texlab_core.work.tasks import finish


def test_there_are_60_samples_and_the_variance() -> None:
    assert PARAMETERS == 61


@pytest.mark.parametrize("size", [(64, 64), (33, 50), (300, 1100)])
def test_the_samples_are_means_of_shifted_products(size: tuple[int, int]) -> None:
    plane = texture(size)
    found = finish(measure(plane, ANY, "a", "b"))
    values = plane.astype(np.float64) - plane.mean(dtype=np.float64)
    for dy, dx in ((0, 0), (0, 1), (3, -2), (-5, 5), (5, 0)):
        shifted = np.roll(values, (dy, dx), axis=(0, 1))
        assert found.values[dy + 5, dx + 5] == pytest.approx((values * shifted).mean(), rel=1e-4, abs=1e-2)
    np.testing.assert_allclose(found.values, found.values[::-1, ::-1], rtol=1e-6, atol=1e-6)


def test_the_spectrum_of_all_lags_of_a_small_image_is_its_own() -> None:
    # 11 x 11 pixels have no other lags.
    plane = texture((11, 11))
    found = finish(measure(plane, ANY, "a", "b"))
    transform = np.fft.rfft2(plane.astype(np.float64) - plane.mean(dtype=np.float64))
    expected = np.abs(transform) ** 2 / 121
    np.testing.assert_allclose(spectrum(found, (11, 11), slice(0, 11)), expected, atol=1e-3 * expected.max())


def test_white_noise_keeps_its_flat_spectrum() -> None:
    found = finish(measure(white((64, 64), 20.0), ANY, "a", "b"))
    half = finish(random_phase((96, 80), Streams(0), ANY, "a"))
    clipped = finish(shape_noise(half, found, (96, 80), ANY, "a"))
    assert clipped == pytest.approx(0, abs=1e-6)
    power = np.abs(half) ** 2 / (96 * 80)
    np.testing.assert_allclose(power.ravel()[1:], 400, rtol=0.05)


def test_what_is_negative_is_clipped_and_reported() -> None:
    values = np.zeros((11, 11))
    values[5, 5], values[5, 4], values[5, 6] = 1.0, 0.9, 0.9
    half = finish(random_phase((64, 64), Streams(0), ANY, "a"))
    clipped = finish(shape_noise(half, Acf(values, 0.0), (64, 64), ANY, "a"))
    spectral = 1 + 1.8 * np.cos(2 * np.pi * np.arange(64) / 64)
    assert clipped == pytest.approx(-spectral[spectral < 0].sum() / np.abs(spectral).sum(), rel=1e-6)
    np.testing.assert_allclose(np.abs(half[5]), np.sqrt(np.maximum(spectral[:33], 0) * 64 * 64), atol=1e-2)


def test_a_wave_longer_than_the_samples_is_clipped_by_much() -> None:
    found = finish(measure(sinusoid((128, 128), 1 / 32, 0), ANY, "a", "b"))
    half = finish(random_phase((128, 128), Streams(0), ANY, "a"))
    assert 0.1 < finish(shape_noise(half, found, (128, 128), ANY, "a")) < 0.5


@pytest.mark.parametrize("name", ["stochastic-gravel", "oriented-zebra", "quasiperiodic-canvas"])
def test_gallery_textures_clip_between_a_fiftieth_and_a_half(name: str) -> None:
    result = run(Job(method="ac-h", inputs={"exemplar": as_exemplar(f"gallery:{name}")}))
    assert 0.01 < result.measures["negative-power"] < 0.5
    assert "negative" in result.notes[0]
    assert result.measures["parameters"] == 61 + (16 if result.image.shape[2] == 1 else 60)
