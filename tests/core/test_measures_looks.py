"""D and its groups: the formulas written out slowly, and what they must be for the exemplar itself."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from texlab_core.measures import discriminability as d
from texlab_core.measures.registry import find_measure
from texlab_core.measures.subject import PreparedCache, Subject
from texlab_core.transforms.fourier import periodic_component, periodic_spectrum
from texlab_core.transforms.octave_bands import band_size, oriented_bands
from texlab_core.work.tasks import finish, go_on


def pebbles(height: int, width: int, channels: int = 3, seed: int = 0) -> np.ndarray:
    """Return smooth noise, (height, width, channels) float32 in [0, 1]."""
    from scipy import ndimage

    noise = np.random.default_rng(seed).random((height, width, channels))
    soft = ndimage.gaussian_filter(noise, (1.2, 0.8, 0), mode="wrap")
    soft = (soft - soft.min()) / (soft.max() - soft.min())
    return soft.astype(np.float32)


@pytest.mark.parametrize("size", [(37, 52), (48, 33), (64, 64)])
def test_the_spectrum_of_the_periodic_part_is_that_of_the_periodic_part(size: tuple[int, int]) -> None:
    plane = np.random.default_rng(1).random(size).astype(np.float32)
    expected = np.fft.fft2(periodic_component(plane.astype(np.float64)))
    np.testing.assert_allclose(finish(periodic_spectrum(plane)), expected, atol=2e-3)


@pytest.mark.parametrize("octave", range(4))
@pytest.mark.parametrize("orientation", range(4))
def test_the_band_of_a_wave_of_its_own_frequency_has_the_waves_amplitude(octave: int, orientation: int) -> None:
    # At 45 degrees no wave of exactly this frequency fits a square: there only that the best band answers.
    cycles = 128 * 0.25 / 2**octave
    angle = orientation * math.pi / 4
    v, u = round(cycles * math.sin(angle)), round(cycles * math.cos(angle))
    rows, columns = np.mgrid[:128, :128]
    plane = (0.3 * np.cos(2 * np.pi * (v * rows + u * columns) / 128 + 0.7)).astype(np.float32)
    found = {(k, o): np.abs(band) for k, o, band in oriented_bands(plane, 4, go_on)}
    answer = found[octave, orientation]
    assert answer.shape == band_size((128, 128), octave)
    if orientation % 2 == 0:
        # The wave is not quite periodic across the jump that the smooth part explains.
        np.testing.assert_allclose(answer, 0.3, atol=0.05)
        assert abs(float(np.median(answer)) - 0.3) < 0.01
    assert max(found, key=lambda key: float(found[key].mean())) == (octave, orientation)


def slow_magnitudes(plane: np.ndarray) -> list[np.ndarray]:
    """Return the magnitudes of the finest octave by the definition, in double precision."""
    spectrum = np.fft.fft2(periodic_component(plane.astype(np.float64)))
    v, u = np.fft.fftfreq(plane.shape[0])[:, None], np.fft.fftfreq(plane.shape[1])[None]
    radius = np.hypot(v, u)
    with np.errstate(divide="ignore"):
        octaves = np.log2(radius / 0.25)
    radial = np.where(np.abs(octaves) < 1, np.cos(np.pi / 2 * np.clip(octaves, -1, 1)), 0)
    found = []
    for orientation in range(4):
        cosine = np.cos(np.arctan2(v, u) - orientation * np.pi / 4)
        found.append(np.abs(np.fft.ifft2(2 * spectrum * radial * np.where(cosine > 0, cosine, 0) ** 3)))
    return found


def slow_lags(magnitude: np.ndarray) -> np.ndarray:
    inner = magnitude[12:-12, 12:-12]
    inner = (inner - inner.mean()) / inner.std()
    found = np.empty((9, 9))
    for down in range(-4, 5):
        for across in range(-4, 5):
            found[down, across] = np.mean(inner * np.roll(inner, (down, across), axis=(0, 1)))
    return found


def test_m_is_the_rms_difference_of_the_magnitudes_autocorrelations() -> None:
    exemplar, image = pebbles(56, 64), pebbles(72, 61, seed=2)
    lags = [
        np.array([slow_lags(each) for each in slow_magnitudes(pixels @ np.array([0.299, 0.587, 0.114]))])
        for pixels in (exemplar, image)
    ]
    expected = math.sqrt(np.mean((lags[0] - lags[1]) ** 2))
    value = find_measure("magnitude-difference").of(Subject.of_images(exemplar, image))
    assert value == pytest.approx(expected, rel=1e-3)
    assert lags[0][:, 0, 0] == pytest.approx(1)


@pytest.mark.parametrize(("size", "samples"), [((64, 80), (64, 80)), ((64, 80), (32, 40)), ((50, 66), (26, 18))])
def test_block_means_are_means_over_the_blocks_of_what_the_samples_cover(
    size: tuple[int, int], samples: tuple[int, int]
) -> None:
    plane = np.random.default_rng(3).random(samples).astype(np.float32)
    starts = d.block_starts(size)
    # Each sample repeated over its cell, on a grid that holds both pixels and samples.
    fine = np.repeat(np.repeat(plane.astype(np.float64), size[0], axis=0), size[1], axis=1)
    expected = [
        [
            fine[r * samples[0] : (r + 32) * samples[0], c * samples[1] : (c + 32) * samples[1]].mean()
            for c in starts[1]
        ]
        for r in starts[0]
    ]
    np.testing.assert_allclose(d.block_means(plane, size, starts), expected, rtol=1e-6)


def test_large_images_have_no_more_than_4096_blocks() -> None:
    assert [len(each) for each in d.block_starts((256, 512))] == [29, 61]
    rows, columns = d.block_starts((1024, 1024))
    assert len(rows) * len(columns) <= 4096
    assert np.diff(rows).tolist() == [16] * (len(rows) - 1)


def test_b_is_the_mean_distance_to_the_nearest_block_under_the_exemplars_covariance() -> None:
    exemplar, image = pebbles(72, 64), pebbles(64, 80, seed=5)
    own, other = d.looks(exemplar, go_on), d.looks(image, go_on)
    assert own.blocks.shape == (6 * 5, 19)
    covariance = np.cov(own.blocks.T)
    steady = 0.9 * covariance + 0.1 * np.diag(np.diag(covariance)) + 0.01 * np.eye(19)
    distances = [
        min(math.sqrt((x - y) @ np.linalg.solve(steady, x - y)) for y in own.blocks) for x in other.blocks
    ]
    expected = 1.4 * np.mean(distances) / math.sqrt(19)
    value = find_measure("block-distance").of(Subject.of_images(exemplar, image))
    assert value == pytest.approx(expected, rel=1e-4)


def test_blocks_are_described_by_energies_and_colours() -> None:
    image = pebbles(64, 64)
    image[:, :, 1] = 0.25
    found = d.looks(image, go_on).blocks
    np.testing.assert_allclose(found[:, 17], 3 * 0.25, rtol=1e-6)
    np.testing.assert_allclose(found[0, 16], 3 * image[:32, :32, 0].mean(dtype=np.float64), rtol=1e-5)
    # Half the contrast is a quarter of the energy.
    soft = d.looks((image - 0.5) / 2 + 0.5, go_on).blocks
    np.testing.assert_allclose(found[:, :16] - soft[:, :16], math.log10(4), atol=1e-3)


def test_the_exemplar_itself_has_the_smallest_possible_d() -> None:
    exemplar = pebbles(64, 56)
    subject = Subject.of_images(exemplar, exemplar)
    assert d.discriminability(subject) == pytest.approx(math.log(0.001) + 2 * math.log(0.05), abs=1e-4)
    other = Subject.of_images(exemplar, pebbles(64, 56, seed=9))
    m, b = d.magnitude_difference(other), d.block_distance(other)
    assert m is not None
    assert b is not None
    assert d.discriminability(other) == math.log(m + 0.001) + 2 * math.log(b + 0.05)


def test_one_gray_channel_and_three_equal_ones_are_the_same_picture() -> None:
    exemplar, image = pebbles(64, 64, 1), pebbles(64, 64, 1, seed=4)
    gray = Subject(image=image, exemplar=Subject.of_images(exemplar, image).exemplar)
    tripled = Subject(image=np.repeat(image, 3, axis=2), exemplar=gray.exemplar)
    assert d.discriminability(gray) == pytest.approx(d.discriminability(tripled), abs=1e-4)


def test_what_is_too_small_to_hold_blocks_has_no_d() -> None:
    small, large = pebbles(39, 64), pebbles(64, 64)
    assert d.discriminability(Subject.of_images(small, large)) is None
    assert d.discriminability(Subject.of_images(large, small)) is None


def test_a_flat_exemplar_and_a_flat_image_have_finite_values() -> None:
    flat = np.full((64, 64, 3), 0.5, np.float32)
    for pair in ((flat, flat), (flat, pebbles(64, 64)), (pebbles(64, 64), flat)):
        value = d.discriminability(Subject.of_images(*pair))
        assert value is not None
        assert math.isfinite(value)


def test_the_exemplars_part_is_computed_once_for_each_exemplar() -> None:
    cache, calls = PreparedCache(), []
    exemplar = pebbles(64, 64)

    def make(pixels: np.ndarray, look: object) -> object:
        calls.append(pixels.shape)
        return SimpleNamespace()

    for seed in range(3):
        Subject.of_images(exemplar, pebbles(48, 48, seed=seed), cache).prepared("thing", make)
    assert calls == [(64, 64, 3)]
    Subject.of_images(pebbles(64, 48), exemplar, cache).prepared("thing", make)
    assert len(calls) == 2


def test_only_the_last_exemplars_are_kept_where_that_is_wanted() -> None:
    cache = PreparedCache(exemplars=2)
    for sha256 in "abc":
        for name in ("one", "two", "three"):
            cache.get((name, sha256), lambda: np.zeros(10))
    assert len(cache) == 6
    cache.get(("one", "b"), lambda: pytest.fail("still there"))
    cache.get(("one", "d"), lambda: np.zeros(10))
    assert len(cache) == 4, "b was used after c"
    cache.get(("two", "b"), lambda: pytest.fail("still there"))


def test_the_cache_lets_go_of_what_was_not_used_for_longest() -> None:
    cache = PreparedCache(max_bytes=3200)
    for name in "abc":
        cache.get((name, "hash"), lambda: np.zeros(100))
    cache.get(("a", "hash"), lambda: pytest.fail("still there"))
    cache.get(("d", "hash"), lambda: np.zeros(100))
    assert len(cache) == 3
    assert cache.nbytes <= 3200
    cache.get(("a", "hash"), lambda: pytest.fail("used last but one"))
    # One thing is kept however large it is.
    cache.get(("e", "hash"), lambda: np.zeros(10**5))
    assert len(cache) == 1
