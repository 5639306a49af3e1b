"""CAR: known models are found again, the recursion equals the filter, poles are those of theory."""

from __future__ import annotations

import numpy as np
import pytest

from tests.core.spectral_tools import ANY, texture
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.engine.streams import Streams
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.spectral.car import (
    COEFFICIENTS,
    OFFSETS,
    Car,
    fit,
    largest_pole,
    recurse,
    shape_noise,
    transfer,
)
from texlab_core.methods.spectral.fourier import random_phase
from texlab_core.methods.spectral.method_car import CarParams
from texlab_core.work.tasks import finish


def model_of(weights: dict[tuple[int, int], float], noise: float = 3.0) -> Car:
    """Return a model with few coefficients, by rows above and columns to the left."""
    return Car(np.array([weights.get(offset, 0.0) for offset in OFFSETS]), 128.0, 30.0, noise)


KNOWN = {(0, 1): 0.45, (1, 0): 0.4, (1, 1): -0.15, (1, -2): 0.12, (4, 3): -0.08}


def phase(size: tuple[int, int], seed: int = 1) -> np.ndarray:
    return finish(random_phase(size, Streams(seed), ANY, "a"))


def test_there_are_60_predecessors_and_none_comes_later() -> None:
    assert COEFFICIENTS == 60
    assert len(set(OFFSETS)) == 60
    assert all(dy > 0 or (dy == 0 and dx > 0) for dy, dx in OFFSETS)
    assert all(abs(dx) <= 5 and 0 <= dy <= 5 for dy, dx in OFFSETS)


def test_the_recursion_equals_its_definition_pixel_by_pixel() -> None:
    size, model = (24, 30), model_of(KNOWN)
    plane, limited = finish(recurse(phase(size), model, size, ANY, "a"))
    values = plane.astype(np.float64) - 128
    half = phase(size).astype(complex)
    half[0, 0] = 0
    noise = np.fft.irfft2(half, size) * 3.0 * np.sqrt(size[0] * size[1])
    predicted = np.zeros(size)
    for (dy, dx), weight in KNOWN.items():
        predicted += weight * np.roll(values, (dy, dx), axis=(0, 1))
    # Periodic along the rows, and down the columns as far as the start is forgotten.
    np.testing.assert_allclose(values - predicted, noise, atol=2e-3)
    assert limited == 0


def test_the_recursion_is_the_filter_with_the_phase_of_its_transfer_function() -> None:
    size, model = (64, 80), model_of(KNOWN)
    plane, _ = finish(recurse(phase(size), model, size, ANY, "a"))
    half = phase(size).astype(complex)
    half[0, 0] = 0
    expected = np.fft.irfft2(half / transfer(model, size, slice(0, 64)), size) * 3.0 * np.sqrt(64 * 80)
    np.testing.assert_allclose(plane - 128, expected, atol=1e-3)


def test_the_spectrum_version_has_the_models_power_and_the_given_phase() -> None:
    size, model = (64, 80), model_of(KNOWN)
    half = phase(size)
    finish(shape_noise(half, model, size, ANY, "a"))
    power = np.abs(half) ** 2 / (64 * 80)
    expected = 9.0 / np.abs(transfer(model, size, slice(0, 64))) ** 2
    np.testing.assert_allclose(power.ravel()[1:], expected.ravel()[1:], rtol=1e-4)
    np.testing.assert_allclose(np.angle(half / phase(size)), 0, atol=1e-5)
    assert half[0, 0] == pytest.approx(128 * 64 * 80)


def test_the_transfer_function_is_the_transform_of_the_coefficients() -> None:
    size = (16, 20)
    kernel = np.zeros(size)
    kernel[0, 0] = 1
    for (dy, dx), weight in KNOWN.items():
        kernel[dy % 16, dx % 20] -= weight
    np.testing.assert_allclose(transfer(model_of(KNOWN), size, slice(0, 16)), np.fft.rfft2(kernel), atol=1e-12)


def test_least_squares_finds_a_known_model_again() -> None:
    size = (300, 300)
    plane, _ = finish(recurse(phase(size), model_of(KNOWN), size, ANY, "a"))
    found = finish(fit(plane, ANY, "a"))
    np.testing.assert_allclose(found.coefficients, model_of(KNOWN).coefficients, atol=0.015)
    assert found.noise == pytest.approx(3.0, rel=0.01)


def test_least_squares_equals_the_full_design_matrix() -> None:
    plane = texture((40, 45))
    values = plane.astype(np.float64) - plane.mean(dtype=np.float64)
    rows, target = [], []
    for y in range(5, 40):
        for x in range(5, 40):
            rows.append([values[y - dy, x - dx] for dy, dx in OFFSETS])
            target.append(values[y, x])
    expected = np.linalg.lstsq(np.array(rows), np.array(target), rcond=None)[0]
    np.testing.assert_allclose(finish(fit(plane, ANY, "a")).coefficients, expected, atol=1e-4)


@pytest.mark.parametrize(
    ("weights", "pole"),
    [
        ({(0, 1): 0.9}, 0.9),
        ({(1, 0): 0.8}, 0.8),
        # x^2 = 1.2 x - 0.72: a pair of modulus sqrt 0.72.
        ({(0, 1): 1.2, (0, 2): -0.72}, np.sqrt(0.72)),
        ({(2, 0): 0.49}, 0.7),
        ({(0, 1): 1.1}, 1.1),
        # A separable product of 0.5 along the row and 0.6 down.
        ({(0, 1): 0.5, (1, 0): 0.6, (1, 1): -0.3}, 0.6),
        # z = 0.5 + 0.4 e^(iw) at its largest.
        ({(1, 0): 0.5, (1, 1): 0.4}, 0.9),
        ({}, 0.0),
    ],
)
def test_the_largest_pole_of_known_models(weights: dict[tuple[int, int], float], pole: float) -> None:
    assert finish(largest_pole(model_of(weights), ANY, "a")) == pytest.approx(pole, abs=1e-6)


def test_an_unstable_recursion_grows_is_limited_and_says_so() -> None:
    size = (64, 64)
    plane, limited = finish(recurse(phase(size), model_of({(1, 0): 1.2}), size, ANY, "a"))
    assert np.isfinite(plane).all()
    assert limited > 0.2
    assert np.abs(plane - 128).max() <= 16 * 30 + 1e-3


def test_a_sawtooth_reaches_the_unit_circle() -> None:
    x = np.arange(128)
    saw = np.broadcast_to(x % 16 / 15, (128, 128)).astype(np.float32)
    result = run(Job(method="car", inputs={"exemplar": as_exemplar(saw)}))
    assert result.measures["largest-pole"] == pytest.approx(1.0, abs=5e-3)


@pytest.mark.parametrize("name", ["stochastic-gravel", "stochastic-stucco", "structured-leaves"])
def test_random_textures_are_stable_and_predicted_better_than_by_their_mean(name: str) -> None:
    result = run(Job(method="car", inputs={"exemplar": as_exemplar(f"gallery:{name}")}))
    assert result.measures["largest-pole"] < 0.999
    assert result.details.noise < 0.8 * result.details.deviation
    assert result.measures["parameters"] == 76 if name == "stochastic-gravel" else 60 + 60


def test_both_versions_look_alike_in_their_spectra() -> None:
    exemplar = as_exemplar("gallery:stochastic-gravel")
    images = [
        run(Job(method="car", inputs={"exemplar": exemplar}, params=CarParams(synthesis=version))).image
        for version in ("spectrum", "recursion")
    ]
    powers = [np.abs(np.fft.rfft2(image[:, :, 0] - image.mean())) ** 2 for image in images]
    assert np.corrcoef(np.log(powers[0].ravel() + 1), np.log(powers[1].ravel() + 1))[0, 1] > 0.7
