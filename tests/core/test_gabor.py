"""The Gabor transform: closed-form answers to waves, channels that sum to the image, half-height circles."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.core.spectral_tools import analyzed, sinusoid, texture
from texlab_core.images.exemplar import as_exemplar
from texlab_core.transforms.gabor import (
    GaborTransform,
    circles,
    filter_bank,
    kernel,
    local_frequency,
    psnr,
)
from texlab_core.transforms.gabor_bank import CENTRES_U, CENTRES_V, CHANNELS, WIDTHS


def wave(size: tuple[int, int], u: float, v: float) -> np.ndarray:
    return (sinusoid(size, u, v, 51.0) / 255).astype(np.float32)


def test_a_wave_at_a_centre_has_constant_magnitude_and_running_phase() -> None:
    response = GaborTransform(wave((128, 128), 1 / 16, 0)).channel(4)
    np.testing.assert_allclose(response.magnitude, 0.2, atol=1e-4)
    x = np.arange(128)
    np.testing.assert_allclose(response.even[7], 0.2 * np.cos(2 * np.pi * x / 16 + 0.3), atol=1e-4)
    np.testing.assert_allclose(response.odd[7], 0.2 * np.sin(2 * np.pi * x / 16 + 0.3), atol=1e-4)
    np.testing.assert_allclose(np.exp(1j * response.phase[7]), np.exp(1j * (2 * np.pi * x / 16 + 0.3)), atol=1e-3)


def test_the_magnitude_falls_to_half_on_the_circle() -> None:
    # Channel 1/8 at 0 degrees; 1/8 + 1/24 = 1/6.
    response = GaborTransform(wave((96, 96), 1 / 6, 0)).channel(8)
    np.testing.assert_allclose(response.magnitude, 0.1, atol=1e-4)
    for circle in circles():
        if circle.channel >= 0:
            half = math.exp(-math.pi * (circle.radius / WIDTHS[circle.channel]) ** 2)
            assert half == pytest.approx(0.5, abs=1e-12)
    assert len(circles()) == 33


def test_neighbours_along_a_radius_meet_at_half_height() -> None:
    bank = filter_bank((384, 384))
    row = bank[192, 192:]
    for frequency in (1 / 48, 1 / 24, 1 / 12, 1 / 6):
        assert row[round(384 * frequency)] == pytest.approx(0.5, abs=1e-3)
    for frequency in (0, 1 / 32, 1 / 16, 1 / 8, 1 / 4):
        assert row[round(384 * frequency)] == pytest.approx(1, abs=1e-5)
    np.testing.assert_allclose(bank[1:, 1:], bank[:0:-1, :0:-1], atol=1e-7)


@pytest.mark.parametrize("size", [(64, 64), (49, 90)])
def test_channels_and_residual_sum_to_the_reconstruction(size: tuple[int, int]) -> None:
    transform = GaborTransform(texture(size) / 255)
    total = transform.residual().astype(np.float64)
    for response in transform.channels():
        total += response.even
    np.testing.assert_allclose(total, transform.reconstruction(), atol=2e-5)


def test_the_energies_of_the_even_channels_are_those_of_the_code() -> None:
    plane = texture((128, 128))
    transform = GaborTransform(plane - plane.mean())
    code = analyzed(plane)
    for channel, response in enumerate(transform.channels()):
        # Both lobes of a real filter; they hardly overlap.
        assert np.square(response.even, dtype=np.float64).mean() == pytest.approx(code.energies[channel], rel=2e-3)
    table = GaborTransform(plane / 255).rms_table()
    np.testing.assert_allclose(table, code.rms_table(), rtol=2e-3)


def test_gallery_textures_come_back_with_20_to_35_db() -> None:
    found = [
        GaborTransform(as_exemplar(f"gallery:{name}").pixels.mean(axis=2)).reconstruction_error()
        for name in (
            "stochastic-gravel",
            "structured-pebbles",
            "stochastic-bark",
            "structured-leaves",
            "oriented-fur",
        )
    ]
    assert min(found) > 20
    assert max(found) < 35
    constant = np.full((32, 32), 0.5, np.float32)
    assert psnr(constant, constant) == math.inf
    assert GaborTransform(constant).reconstruction_error() > 60


def test_local_frequency_answers_where_the_stripes_are() -> None:
    plane = np.full((96, 200), 0.5, np.float32)
    x = np.arange(200)
    plane[:, :100] += (0.2 * np.cos(2 * np.pi * x[:100] / 8)).astype(np.float32)
    plane[:, 100:] += (0.2 * np.cos(2 * np.pi * x[100:] / 20)).astype(np.float32)
    fine = local_frequency(plane, 1 / 8, 0).magnitude
    coarse = local_frequency(plane, 1 / 20, 0).magnitude
    across = local_frequency(plane, 1 / 8, 90).magnitude
    assert fine[:, 30:70].mean() == pytest.approx(0.2, abs=0.01)
    # The filter at 1/8 answers to 1/20 as its Gaussian says.
    weak = 0.2 * math.exp(-math.pi * ((1 / 8 - 1 / 20) / (math.sqrt(math.pi / math.log(2)) / 24)) ** 2)
    assert fine[:, 130:170].mean() == pytest.approx(weak, abs=2e-3)
    assert coarse[:, 140:160].mean() == pytest.approx(0.2, abs=0.02)
    assert across.max() < 0.02
    with pytest.raises(ValueError, match="must be above 0 and at most"):
        local_frequency(plane, 0.6, 0)
    with pytest.raises(ValueError, match="must be above 0 and at most"):
        local_frequency(plane, 0.0, 0)


@pytest.mark.parametrize("size", [(1, 1), (1, 9), (5, 3)])
def test_local_frequency_takes_images_smaller_than_the_kernel(size: tuple[int, int]) -> None:
    response = local_frequency(np.full(size, 0.4, np.float32), 1 / 16, 30)
    assert response.values.shape == size
    np.testing.assert_allclose(response.magnitude, 0, atol=1e-5)


def test_the_kernel_is_the_transform_of_the_filter() -> None:
    values = kernel(1 / 8, 45)
    side = values.shape[0]
    placed = np.zeros((128, 128), complex)
    placed[:side, :side] = values
    placed = np.roll(placed, (-(side // 2), -(side // 2)), axis=(0, 1))
    channel = 9
    f = np.fft.fftfreq(128)
    expected = np.exp(
        -np.pi * ((f - CENTRES_U[channel]) ** 2 + (f[:, None] - CENTRES_V[channel]) ** 2) / WIDTHS[channel] ** 2
    )
    assert channel < CHANNELS
    # The kernel is cut at a thousandth of its peak.
    np.testing.assert_allclose(np.fft.fft2(placed), expected, atol=5e-3)
