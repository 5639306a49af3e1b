"""Random phase noise: the exemplar's own spectrum at its size, its variance at any size."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.fft

from tests.core.spectral_tools import ANY, texture
from texlab_core.engine.job import Job
from texlab_core.engine.progress import Progress
from texlab_core.engine.run import run
from texlab_core.engine.streams import Streams
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.spectral.fourier import draw_phase, make_hermitian, mean_square, random_phase
from texlab_core.methods.spectral.method_uncoded import UncodedParams
from texlab_core.methods.spectral.uncoded import give_phase, make_spot, parameter_count, spectra, subtract_smooth
from texlab_core.transforms.fourier import periodic_component
from texlab_core.work.tasks import finish

CHANNELS = Progress({f"s {channel}": 1.0 for channel in (1, 2, 3)})


def colour(size: tuple[int, int]) -> np.ndarray:
    planes = [texture(size, seed) for seed in (1, 2, 3)]
    return np.clip(np.stack([planes[0], 0.5 * (planes[0] + planes[1]), planes[2]], axis=2) / 255, 0, 1)


@pytest.mark.parametrize("size", [(8, 8), (7, 9), (8, 9), (9, 8), (1, 6), (6, 1), (2, 2), (1, 1)])
def test_the_phase_is_that_of_a_real_image_of_unit_modulus(size: tuple[int, int]) -> None:
    phase = finish(random_phase(size, Streams(3), ANY, "a"))
    np.testing.assert_allclose(np.abs(phase), 1, rtol=1e-6)
    image = np.fft.irfft2(phase, size)
    np.testing.assert_allclose(np.fft.rfft2(image), phase, atol=1e-6)
    assert phase[0, 0] == 1


def test_the_phase_does_not_depend_on_blocks() -> None:
    phase = finish(random_phase((1100, 2100), Streams(1), ANY, "a"))
    angle = Streams(1)("phase").random((1100, 1051), dtype=np.float32) * np.float32(2 * np.pi)
    expected = (np.cos(angle) + 1j * np.sin(angle)).astype(np.complex64)
    make_hermitian(expected, 2100)
    np.testing.assert_array_equal(phase, expected)
    shares = list(draw_phase((1100, 2100), Streams(1)("phase")))
    assert len(shares) > 1
    assert shares[-1] == 1


def test_the_phase_is_uniform() -> None:
    phase = finish(random_phase((256, 256), Streams(0), ANY, "a"))
    inner = phase[:, 1:-1]
    for power in (1, 2, 3):
        assert abs(np.mean(inner.astype(complex) ** power)) < 0.02


def test_the_spectrum_at_the_exemplars_size_is_its_own() -> None:
    pixels = colour((96, 120)).astype(np.float32)
    spot = finish(make_spot(pixels, False, CHANNELS, "s"))
    halves = finish(spectra(spot, (96, 120), CHANNELS, "s"))
    for channel, half in enumerate(halves):
        plane = pixels[:, :, channel].astype(np.float64)
        expected = np.fft.rfft2(plane - plane.mean())
        np.testing.assert_allclose(half, expected, atol=2e-3)
    before = [np.abs(half) for half in halves]
    cross = halves[0] * np.conj(halves[2])
    phase = finish(random_phase((96, 120), Streams(5), ANY, "a"))
    finish(give_phase(halves, phase, ANY, "a"))
    for half, modulus in zip(halves, before, strict=True):
        np.testing.assert_allclose(np.abs(half), modulus, rtol=1e-4, atol=1e-4)
    # The channels keep their phase differences, and their sum has the given phase.
    np.testing.assert_allclose(halves[0] * np.conj(halves[2]), cross, atol=1e-3 * np.abs(cross).max())
    total = sum(halves)
    strong = np.abs(total) > 1
    np.testing.assert_allclose((total / np.abs(total))[strong], phase[strong], atol=1e-4)


@pytest.mark.parametrize("size", [(96, 120), (200, 300), (50, 40), (96, 300), (40, 120)])
def test_the_variance_is_kept_at_any_size(size: tuple[int, int]) -> None:
    pixels = colour((96, 120)).astype(np.float32)
    spot = finish(make_spot(pixels, False, CHANNELS, "s"))
    halves = finish(spectra(spot, size, CHANNELS, "s"))
    total = sum(mean_square(half, size[1]) for half in halves)
    assert total == pytest.approx(float(pixels.var(axis=(0, 1), dtype=np.float64).sum()), rel=1e-4)


def test_folding_is_sampling_the_spectrum_less_finely() -> None:
    plane = texture((64, 96)) / 255
    spot = finish(make_spot(plane[:, :, None], False, CHANNELS, "s"))
    half = finish(spectra(spot, (32, 48), CHANNELS, "s"))[0]
    whole = np.fft.rfft2(spot.planes[0].astype(np.float64))[::2, ::2]
    whole[0, 0] = half[0, 0]
    ratio = np.abs(half[1:, 1:]) / np.abs(whole[1:, 1:])
    np.testing.assert_allclose(ratio, np.median(ratio), rtol=1e-3)


@pytest.mark.parametrize("size", [(64, 64), (37, 50), (5, 4), (1, 7)])
def test_the_smooth_component_is_taken_away_in_the_fourier_plane(size: tuple[int, int]) -> None:
    plane = np.add.outer(np.arange(size[0]) ** 1.5, 3.0 * np.arange(size[1])) + np.arange(size[1]) % 3
    half = scipy.fft.rfft2(plane)
    finish(subtract_smooth(half, plane, ANY, "a"))
    np.testing.assert_allclose(scipy.fft.irfft2(half, plane.shape), periodic_component(plane), atol=1e-8)


def test_the_result_has_the_exemplars_histograms_and_nearly_its_spectrum() -> None:
    exemplar = as_exemplar("gallery:stochastic-stucco")
    image = run(Job(method="uncoded", inputs={"exemplar": exemplar}, seed=2)).image
    for channel in range(exemplar.channels):
        np.testing.assert_array_equal(
            np.sort(image[:, :, channel], axis=None), np.sort(exemplar.pixels[:, :, channel], axis=None)
        )
    one, other = (np.abs(np.fft.rfft2(each.mean(axis=2) - each.mean())) for each in (image, exemplar.pixels))
    assert np.linalg.norm(one - other) / np.linalg.norm(other) < 0.15


def test_the_periodic_option_takes_away_the_cross() -> None:
    ramp = np.linspace(0.2, 0.7, 128)[:, None] + 0.2 * texture((128, 128)) / 255
    exemplar = as_exemplar(ramp.astype(np.float32))
    jumps = []
    for border in ("as-is", "periodic"):
        model = run(
            Job(method="uncoded", inputs={"exemplar": exemplar}, params=UncodedParams(border=border))
        ).model
        jumps.append(np.abs(model.planes[0, 0] - model.planes[0, -1]).mean())
    assert jumps[1] < 0.2 * jumps[0]


def test_the_parameters_are_half_the_pixels_and_the_histogram() -> None:
    assert parameter_count((256, 256), 1) == 256 * 256 // 2 + 2 + 256
    assert parameter_count((5, 5), 1) == 13 + 256
    assert parameter_count((256, 256), 3) == 5 * (256 * 256 // 2 + 2) + 3 * 256
