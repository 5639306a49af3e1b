"""Spectra: Parseval, symmetry, closed forms; peaks found where waves are, and moved by MSG where predicted."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.core.spectral_tools import sinusoid, texture, white
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.stats.peaks import Peak, find_peaks, match_peaks, predicted_snap, shift
from texlab_core.stats.spectrum import (
    QUANTIZATION,
    log_spectral_distance,
    power_spectrum,
    total_variation,
)
from texlab_core.transforms.luma import luma

SIZES = [(64, 64), (33, 50), (51, 33), (64, 31), (1, 8), (7, 1), (1, 1)]


def image(plane: np.ndarray) -> np.ndarray:
    return (plane / 255).astype(np.float32)[:, :, None]


@pytest.mark.parametrize("size", SIZES)
def test_the_whole_plane_is_that_of_the_complex_transform(size: tuple[int, int]) -> None:
    picture = image(texture((max(size[0], 2), max(size[1], 2)))[: size[0], : size[1]])
    spectrum = power_spectrum(picture)
    values = picture[:, :, 0].astype(np.float64)
    expected = np.abs(np.fft.fft2(values - values.mean())) ** 2 / values.size
    np.testing.assert_allclose(spectrum.full(), np.fft.fftshift(expected), atol=1e-5 * max(expected.max(), 1e-6))
    assert spectrum.variance == pytest.approx(values.var(), rel=1e-5, abs=1e-12)


def test_white_noise_is_flat_in_every_profile() -> None:
    spectrum = power_spectrum(image(white((128, 160), 20.0)))
    level = (20 / 255) ** 2
    np.testing.assert_allclose(spectrum.radial(40).power[2:], level, rtol=1e-3)
    np.testing.assert_allclose(spectrum.angular(30).power, level, rtol=1e-3)
    lags = spectrum.autocorrelation()
    assert lags[64, 80] == pytest.approx(1, abs=1e-6)
    lags[64, 80] = 0
    assert np.abs(lags).max() < 1e-3
    picture = spectrum.log_picture()
    assert np.median(picture) == pytest.approx(10 * math.log10(level / QUANTIZATION), abs=0.01)


def test_a_wave_stands_in_its_bin_of_the_profiles() -> None:
    spectrum = power_spectrum(image(sinusoid((128, 128), 24 / 128, -12 / 128)))
    radial, angular = spectrum.radial(64), spectrum.angular(60)
    assert abs(radial.x[np.argmax(radial.power)] - math.hypot(24, 12) / 128) <= 0.5 / 64
    turn = (angular.x[np.argmax(angular.power)] - math.degrees(math.atan2(-12, 24)) + 90) % 180 - 90
    assert abs(turn) <= 1.5
    assert angular.x[0] == 0


def test_autocorrelation_is_the_mean_of_shifted_products() -> None:
    plane = texture((40, 50))
    lags = power_spectrum(image(plane)).autocorrelation()
    values = plane.astype(np.float64) - plane.mean()
    for dy, dx in ((0, 0), (3, -4), (-7, 0)):
        expected = (values * np.roll(values, (dy, dx), axis=(0, 1))).mean() / values.var()
        assert lags[20 + dy, 25 + dx] == pytest.approx(expected, abs=1e-4)


def test_distances_are_zero_for_equals_symmetric_and_a_gain_is_its_decibels() -> None:
    one = power_spectrum(image(texture((128, 128), 1)))
    other = power_spectrum(image(texture((128, 160), 2)))
    assert log_spectral_distance(one, one) == 0
    assert total_variation(one, one) == 0
    assert log_spectral_distance(one, other) == pytest.approx(log_spectral_distance(other, one))
    assert total_variation(one, other) == pytest.approx(total_variation(other, one))
    loud = power_spectrum(image(128 + 2 * (texture((128, 128), 1) - 128)))
    assert log_spectral_distance(one, loud) == pytest.approx(20 * math.log10(2), abs=0.1)
    assert total_variation(one, loud) == pytest.approx(0, abs=1e-4)


def test_waves_at_different_places_move_all_the_power() -> None:
    one, other = (power_spectrum(image(sinusoid((128, 128), u, 0))) for u in (1 / 16, 1 / 4))
    assert total_variation(one, other) == pytest.approx(1, abs=1e-3)
    flat = power_spectrum(np.full((32, 32, 1), 0.5, np.float32))
    assert total_variation(one, flat) == 1
    assert total_variation(flat, flat) == 0
    assert log_spectral_distance(flat, flat) == 0


@pytest.mark.parametrize("size", [(64, 64), (100, 80), (300, 200)])
def test_sizes_may_differ(size: tuple[int, int]) -> None:
    one = power_spectrum(image(white((128, 128), 20.0)))
    other = power_spectrum(image(white(size, 20.0)))
    assert log_spectral_distance(one, other) < 0.02
    assert total_variation(one, other) < 0.01


@pytest.mark.parametrize("size", SIZES)
def test_small_and_odd_images_have_distances(size: tuple[int, int]) -> None:
    one = power_spectrum(image(texture((16, 16))[: size[0], : size[1]]))
    other = power_spectrum(image(texture((32, 40))))
    assert np.isfinite(log_spectral_distance(one, other))
    assert 0 <= total_variation(one, other) <= 1
    assert isinstance(find_peaks(one), tuple)


@pytest.mark.parametrize(
    ("u", "v"), [(16 / 128, 0.0), (0.0, 20 / 128), (12 / 128, -9 / 128), (20.5 / 128, 7 / 128)]
)
def test_a_wave_is_one_peak_with_its_period_and_orientation(u: float, v: float) -> None:
    noise = np.random.Generator(np.random.PCG64(1)).normal(0, 5, (128, 128))
    peaks = find_peaks(power_spectrum(image(sinusoid((128, 128), u, v) + noise)))
    assert len(peaks) == 1
    peak = peaks[0]
    assert math.hypot(peak.u - u, peak.v - v) < 0.3 / 128
    assert peak.period == pytest.approx(1 / math.hypot(u, v), rel=0.03)
    assert abs((peak.orientation - math.degrees(math.atan2(v, u)) + 90) % 180 - 90) < 2
    assert 0.8 < peak.share <= 1.05


@pytest.mark.parametrize("name", ["stochastic-gravel", "stochastic-grass", "stochastic-granite"])
def test_random_textures_have_no_peaks(name: str) -> None:
    assert find_peaks(power_spectrum(as_exemplar(f"gallery:{name}").pixels)) == ()


def test_the_predicted_centre_is_that_of_the_strongest_filter() -> None:
    def snap(u: float, v: float) -> tuple[int, float, float]:
        found = predicted_snap(Peak(u, v, 1.0, 10.0))
        assert found is not None
        return found.channel, round(found.shift.octaves, 3), round(found.shift.degrees, 3)

    assert snap(1 / 16, 0) == (4, 0, 0)
    assert snap(0, 14 / 256) == (6, round(math.log2(16 / 14), 3), 0)
    # 4/3 of a centre is as far from it as from its double.
    assert snap(0.99 * 4 / 3 / 16, 0)[0] == 4
    assert snap(1.01 * 4 / 3 / 16, 0)[0] == 8
    assert snap(0.1, -0.03)[0] == 8
    assert snap(0.1, -0.09)[0] == 11
    assert predicted_snap(Peak(1 / 100, 0, 1.0, 10.0)) is None


def test_shifts_are_octaves_and_turns_of_a_line() -> None:
    assert shift(0.1, 0, 0.2, 0).octaves == pytest.approx(1)
    assert shift(0.1, 0, 0, 0.1).degrees == pytest.approx(-90)
    assert shift(0.1, 0.001, 0.1, -0.001).degrees == pytest.approx(2 * -math.degrees(math.atan(0.01)))
    assert shift(0.1, 0.1, -0.1, -0.1).degrees == pytest.approx(0)
    assert match_peaks((), ()) == ()


@pytest.mark.parametrize(
    ("u", "v"), [(14 / 256, 0.0), (0.0, 14 / 256), (20 / 256, 8 / 256), (37 / 256, -11 / 256), (10 / 256, 0.0)]
)
def test_msg_moves_the_peak_of_stripes_by_the_predicted_amount(u: float, v: float) -> None:
    stripes = as_exemplar((sinusoid((256, 256), u, v) / 255).astype(np.float32))
    result = run(Job(method="msg", inputs={"exemplar": stripes}))
    peak = find_peaks(power_spectrum(stripes.pixels))[0]
    predicted = predicted_snap(peak)
    assert predicted is not None
    _, _, found = match_peaks((peak,), find_peaks(power_spectrum(result.image), 1))[0]
    assert found.octaves == pytest.approx(predicted.shift.octaves, abs=0.04)
    assert found.degrees == pytest.approx(predicted.shift.degrees, abs=2)


@pytest.mark.parametrize("name", ["quasiperiodic-canvas", "oriented-canefence", "quasiperiodic-oldbrick"])
def test_msg_moves_the_strongest_peak_of_gallery_textures_as_predicted(name: str) -> None:
    exemplar = as_exemplar(f"gallery:{name}")
    result = run(Job(method="msg", inputs={"exemplar": exemplar}))
    peaks = find_peaks(power_spectrum(exemplar.pixels), 1)
    predicted = predicted_snap(peaks[0])
    assert predicted is not None
    assert abs(predicted.shift.octaves) > 0.08
    _, _, found = match_peaks(peaks, find_peaks(power_spectrum(result.image)))[0]
    assert found.octaves == pytest.approx(predicted.shift.octaves, abs=0.05)
    assert found.degrees == pytest.approx(predicted.shift.degrees, abs=3)


def test_luminance_weighs_the_channels() -> None:
    pixels = np.zeros((2, 2, 3), np.float32)
    pixels[0, 0, 0] = pixels[0, 1, 1] = pixels[1, 0, 2] = 1
    np.testing.assert_allclose(luma(pixels), [[0.299, 0.587], [0.114, 0]], atol=1e-6)


def test_a_spectrum_can_be_stopped_between_its_parts():
    class Stop(Exception):
        pass

    image = np.random.default_rng(2).random((1500, 1500, 3), np.float32)
    moments = []
    whole = power_spectrum(image, lambda: moments.append(1))
    # Luminance, the mean, and blocks of at most 2^19 samples of rows, columns and powers.
    assert len(moments) > 8
    assert whole.variance == pytest.approx(float(luma(image).var(dtype=np.float64)), rel=1e-5)
    for count in (1, 2, len(moments)):
        seen = []

        def look(seen=seen, count=count):
            seen.append(1)
            if len(seen) == count:
                raise Stop

        with pytest.raises(Stop):
            power_spectrum(image, look)
        assert len(seen) == count
