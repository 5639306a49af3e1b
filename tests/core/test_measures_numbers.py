"""Copying, patches, spectra, distributions, dependence and homogeneity against slow or closed forms."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from scipy.stats import wasserstein_distance

from tests.core.test_measures_looks import pebbles
from texlab_core.engine.steps import Map
from texlab_core.errors import Cancelled
from texlab_core.measures import homogeneity, patches
from texlab_core.measures.distributions import band_distances
from texlab_core.measures.registry import find_measure, measure_all
from texlab_core.measures.spectra import peak_shifts
from texlab_core.measures.subject import PreparedCache, Subject
from texlab_core.stats import bands, spectrum
from texlab_core.work.tasks import go_on

if TYPE_CHECKING:
    from texlab_core.engine.steps import MapKind


def value_of(name: str, *pair: np.ndarray) -> float:
    found = find_measure(name).of(Subject.of_images(*pair))
    assert found is not None
    return found


def mapped(data: np.ndarray, kind: MapKind) -> Subject:
    height, width = data.shape[:2]
    return Subject(image=np.zeros((height, width, 3), np.float32), maps={"a": Map(data, kind, "A")})


def test_copying_is_said_of_what_has_a_source() -> None:
    # Two pieces of 6 and 4 pixels, one pixel alone, one without source.
    source = np.array(
        [
            [[0, 0], [0, 1], [0, 2], [5, 5]],
            [[1, 0], [1, 1], [1, 2], [6, 5]],
            [[9, 0], [-1, -1], [8, 4], [7, 5]],
        ],
        np.int32,
    )
    # (2, 2) continues (2, 3) by its offset in columns only: 8 is not 7.
    subject = mapped(source, "source")
    found = measure_all(subject)
    pairs = 3 * 3 + 4 * 2 - 3
    assert found["copied-share"] == pytest.approx((7 + 2) / pairs)
    assert found["largest-copy"] == pytest.approx(6 / 11)
    assert found["mean-copy"] == pytest.approx(11 / 4)
    assert found["source-repetition"] == 1
    source[2, 2] = source[0, 0]
    assert measure_all(mapped(source, "source"))["source-repetition"] == pytest.approx(11 / 10)


def test_nothing_is_said_of_copying_where_nothing_has_a_source() -> None:
    found = measure_all(mapped(np.full((4, 5, 2), -1, np.int32), "source"))
    assert not {"copied-share", "largest-copy", "mean-copy", "source-repetition", "tile-share"} & set(found)


def test_candidates_are_the_median_of_the_counts() -> None:
    counts = np.array([[1, 2, 9], [4, 4, 7]])
    assert find_measure("median-candidates").of(mapped(counts, "count")) == 4
    assert find_measure("median-candidates").of(mapped(counts, "label")) is None


@pytest.mark.parametrize("channels", [1, 3])
def test_patches_are_found_where_they_are(channels: int) -> None:
    exemplar = pebbles(30, 28, channels)
    image = pebbles(26, 33, channels, seed=1)
    image[4:18, 6:20] = exemplar[10:24, 3:17]
    image[:, 24:] = 0.5
    known = np.rint(exemplar * 255)
    seen = np.rint(image * 255)
    slow = np.zeros((18, 25), bool)
    flat = np.zeros((18, 25), bool)
    own = {known[r : r + 9, c : c + 9].tobytes() for r in range(22) for c in range(20)}
    for row in range(18):
        for column in range(25):
            patch = seen[row : row + 9, column : column + 9]
            flat[row, column] = (patch == patch[0, 0]).all()
            slow[row, column] = patch.tobytes() in own and not flat[row, column]
    assert slow.sum() == 36
    assert flat.sum() == 18
    subject = Subject.of_images(exemplar, image)
    np.testing.assert_array_equal(patches.found_patches(subject), slow)
    assert patches.patches_copied(subject) == 36 / (18 * 25 - 18)


def test_a_copy_is_found_whole_and_a_flat_picture_says_nothing() -> None:
    exemplar = pebbles(20, 24)
    assert value_of("patches-copied", exemplar, exemplar[3:, 2:]) == 1
    assert value_of("patches-copied", exemplar, pebbles(20, 24, seed=8)) == 0
    assert patches.patches_copied(Subject.of_images(exemplar, np.ones((12, 12, 3), np.float32))) is None
    assert patches.patches_copied(Subject.of_images(exemplar, exemplar[:8])) is None


def test_a_flat_patch_is_told_from_one_that_repeats() -> None:
    stripes = np.zeros((9, 12, 1), np.float32)
    stripes[:, ::2] = 1
    _, flat = patches.patch_hashes(stripes, go_on)
    assert not flat.any()
    _, flat = patches.patch_hashes(np.full((9, 12, 3), 0.3, np.float32), go_on)
    assert flat.all()


def test_spectral_measures_are_those_of_the_spectra() -> None:
    exemplar, image = pebbles(48, 40), pebbles(64, 50, seed=1)
    pair = spectrum.power_spectrum(exemplar), spectrum.power_spectrum(image)
    assert value_of("spectral-distance", exemplar, image) == spectrum.log_spectral_distance(*pair)
    assert value_of("spectral-variation", exemplar, image) == spectrum.total_variation(*pair)
    # Half the contrast: 6 dB everywhere above the rounding, and no power moved.
    contrast = np.random.default_rng(0).random((64, 64, 1)).astype(np.float32)
    assert value_of("spectral-distance", contrast, contrast / 2) == pytest.approx(20 * math.log10(2), abs=0.01)
    assert value_of("spectral-variation", contrast, contrast / 2) == pytest.approx(0, abs=1e-4)


def wave(cycles_v: int, cycles_u: int, side: int = 128) -> np.ndarray:
    rows, columns = np.mgrid[:side, :side]
    noise = np.random.default_rng(5).standard_normal((side, side))
    plane = 0.5 + 0.3 * np.cos(2 * np.pi * (cycles_v * rows + cycles_u * columns) / side) + 0.01 * noise
    return plane.clip(0, 1)[..., None].astype(np.float32)


def test_a_wave_an_octave_off_and_turned_is_said_so() -> None:
    assert value_of("peak-shift-octaves", wave(0, 16), wave(0, 16)) == pytest.approx(0, abs=0.01)
    assert value_of("peak-shift-octaves", wave(0, 16), wave(0, 32)) == pytest.approx(1, abs=0.02)
    assert value_of("peak-shift-octaves", wave(0, 32), wave(0, 16)) == pytest.approx(1, abs=0.02)
    assert value_of("peak-shift-degrees", wave(0, 16), wave(16, 0)) == pytest.approx(90, abs=0.5)
    assert value_of("peak-shift-degrees", wave(16, 16), wave(0, 23)) == pytest.approx(45, abs=0.5)
    noise = np.random.default_rng(1).random((64, 64, 1), np.float32)
    assert peak_shifts(Subject.of_images(noise, wave(0, 16))) == ()
    assert find_measure("peak-shift-octaves").of(Subject.of_images(noise, wave(0, 16))) is None


def test_w1_of_pixels_is_the_mean_over_channels_in_standard_deviations() -> None:
    exemplar, image = pebbles(20, 16), pebbles(24, 31, seed=1)
    expected = np.mean(
        [
            wasserstein_distance(exemplar[..., c].ravel(), image[..., c].ravel())
            / exemplar[..., c].std(dtype=np.float64)
            for c in range(3)
        ]
    )
    assert value_of("w1-pixels", exemplar, image) == pytest.approx(expected, rel=1e-5)
    # A gray picture beside a coloured one is three equal channels.
    gray = pebbles(24, 31, 1)
    tripled = Subject(image=np.repeat(gray, 3, axis=2), exemplar=Subject.of_images(exemplar, gray).exemplar)
    assert value_of("w1-pixels", exemplar, gray) == pytest.approx(find_measure("w1-pixels").of(tripled))
    # A flat exemplar has no spread: the distance itself.
    flat = np.full((8, 8, 1), 0.25, np.float32)
    assert value_of("w1-pixels", flat, flat + np.float32(0.5)) == pytest.approx(0.5)
    assert value_of("w1-pixels", flat, flat) == 0


def test_w1_of_bands_is_the_mean_over_the_steerable_pyramid() -> None:
    exemplar, image = pebbles(40, 36, 1), pebbles(33, 48, 1, seed=1)
    levels = min(4, bands.most_levels((40, 36), "steerable"), bands.most_levels((33, 48), "steerable"))
    split = [bands.split(each[:, :, 0], "steerable", levels, 4) for each in (exemplar, image)]
    expected = [
        wasserstein_distance(one.plane.ravel(), other.plane.ravel()) / one.plane.std(dtype=np.float64)
        for one, other in zip(*split, strict=True)
    ]
    assert band_distances(Subject.of_images(exemplar, image)) == pytest.approx(expected, rel=1e-4)
    assert value_of("w1-bands", exemplar, image) == pytest.approx(np.mean(expected), rel=1e-4)
    assert value_of("w1-bands", exemplar, exemplar) == 0
    assert find_measure("w1-bands").of(Subject.of_images(exemplar[:7], image)) is None
    assert find_measure("w1-bands").of(Subject.of_images(np.ones_like(exemplar), image)) is None


def test_dependence_is_lost_when_bands_are_made_alone() -> None:
    rng = np.random.default_rng(3)
    # Bursts: fine noise where, and only where, the envelope is large, so that scales go together.
    from scipy import ndimage

    envelope = ndimage.gaussian_filter(rng.standard_normal((128, 128)), 6, mode="wrap")
    bursts = rng.standard_normal((128, 128)) * np.exp(12 * envelope / np.abs(envelope).max() - 6)
    bursts = (0.5 + 0.1 * bursts / bursts.std()).clip(0, 1)[..., None].astype(np.float32)
    even = (0.5 + 0.1 * rng.standard_normal((128, 128, 1))).clip(0, 1).astype(np.float32)
    assert value_of("dependence-difference", bursts, bursts) == 0
    other = np.roll(bursts[:, ::-1], 40, axis=0)
    assert value_of("dependence-difference", bursts, even) > 3 * value_of("dependence-difference", bursts, other)
    assert find_measure("dependence-difference").of(Subject.of_images(bursts[:39], even)) is None


def test_a_gradient_is_the_best_linear_function() -> None:
    image = pebbles(20, 17)
    rows, columns = np.mgrid[:20, :17]
    matrix = np.stack([np.ones(340), rows.ravel(), columns.ravel()], axis=1)
    flat = image.reshape(340, 3).astype(np.float64)
    fitted = matrix @ np.linalg.lstsq(matrix, flat, rcond=None)[0]
    expected = math.sqrt(fitted.var(axis=0).sum() / flat.var(axis=0).sum())
    assert value_of("exemplar-drift", image, image) == pytest.approx(expected)
    ramp = np.broadcast_to(np.linspace(0, 1, 17)[:, None], (20, 17, 1)).astype(np.float32)
    assert value_of("exemplar-drift", ramp, image) == pytest.approx(1)
    assert find_measure("exemplar-drift").of(Subject.of_images(np.ones_like(image), image)) is None


def test_energy_that_doubles_from_left_to_right_has_the_spread_of_its_blocks() -> None:
    noise = np.random.default_rng(2).standard_normal((256, 256))
    # Amplitudes 1, 1, 3, 3 by quarter: log10 energies 0 and 2 log10 3, a standard deviation of log10 3.
    amplitude = np.repeat([1.0, 1.0, 3.0, 3.0], 64)
    image = (0.5 + 0.04 * noise * amplitude)[..., None].astype(np.float32)
    assert homogeneity.local_spread(image, go_on) == pytest.approx(math.log10(3), abs=0.03)


def test_an_uneven_exemplar_stands_out_against_its_own_synthesis(monkeypatch: pytest.MonkeyPatch) -> None:
    runs: list[Any] = []
    real = homogeneity.run
    monkeypatch.setattr(
        homogeneity, "run", lambda job, *rest, **named: runs.append(job) or real(job, *rest, **named)
    )
    cache = PreparedCache()
    even = pebbles(64, 64)
    uneven = even.copy()
    uneven[:, 32:] = 0.5 + (uneven[:, 32:] - 0.5) / 10
    found = {}
    for name, each in {"even": even, "uneven": uneven}.items():
        subject = Subject.of_images(each, each, cache)
        found[name] = find_measure("exemplar-unevenness").of(subject)
        assert find_measure("exemplar-unevenness").of(subject) == found[name]
    assert found["even"] < 2 < found["uneven"]
    # Once for each exemplar; and not unless it is asked for.
    assert len(runs) == 2
    assert "exemplar-unevenness" not in measure_all(Subject.of_images(even, even, cache))
    assert find_measure("exemplar-unevenness").of(Subject.of_images(even[:47], even)) is None
    flat = np.full((48, 48, 3), 0.5, np.float32)
    assert find_measure("exemplar-unevenness").of(Subject.of_images(flat, even)) is None
    asked = 0

    def stop() -> bool:
        nonlocal asked
        asked += 1
        # Deep within the synthesis.
        return asked > 60

    other = Subject.of_images(pebbles(64, 64, seed=3), even, should_stop=stop)
    with pytest.raises(Cancelled):
        find_measure("exemplar-unevenness").of(other)
    assert len(runs) > 2
