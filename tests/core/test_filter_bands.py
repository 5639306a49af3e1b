"""Filters that only look: each answers to what it is made for, and to nothing on a constant image."""

import numpy as np
import pytest

from texlab_core.stats import bands
from texlab_core.stats.filter_bands import most_derived
from texlab_core.transforms import gaussian, spots_bars
from texlab_core.transforms.steerable import BandKey

LOOKING = ("oriented", "gabor", "gabor magnitude", "filter bank")


def wave(frequency, degrees, shape=(96, 96)):
    y, x = np.mgrid[: shape[0], : shape[1]] + 0.5
    angle = np.deg2rad(degrees)
    # Even about the middle of the border between first and last pixel: its mirror image goes on smoothly.
    return np.cos(2 * np.pi * frequency * (x * np.cos(angle) + y * np.sin(angle))).astype(np.float32)


def rms(plane):
    return float(np.sqrt(np.square(plane, dtype=np.float64).mean()))


def strongest(found):
    return max((band for band in found if band.key.kind == "oriented"), key=lambda band: rms(band.plane))


@pytest.mark.parametrize("kind", LOOKING)
def test_a_constant_image_gives_nothing_but_its_residual(kind):
    found = bands.split(np.full((40, 56), 0.7, np.float32), kind, 2, 3)
    *answers, residual = found
    assert answers
    for band in answers:
        assert np.abs(band.plane).max() < 2e-6, band.title
    assert residual.plane == pytest.approx(np.full_like(residual.plane, 0.7), abs=2e-6)
    assert not residual.signed


@pytest.mark.parametrize("kind", LOOKING)
@pytest.mark.parametrize("size", [(1, 1), (2, 9), (37, 50)])
def test_keys_sizes_and_names(kind, size):
    plane = np.random.default_rng(1).random(size, np.float32)
    found = bands.split(plane, kind, 8, 3)
    levels = min(8, bands.most_levels(size, kind))
    assert tuple(band.key for band in found) == bands.band_keys(kind, levels, 3)
    for band in found:
        assert band.plane.shape == tuple(-(-side >> band.key.level) for side in size)
        assert band.plane.dtype == np.float32
    assert len({band.title for band in found}) == len({band.label for band in found}) == len(found)


@pytest.mark.parametrize("level", range(4))
@pytest.mark.parametrize("orientation", [0, 2])
def test_a_sinusoid_at_the_centre_of_a_gabor_channel_is_that_channel(level, orientation):
    plane = wave(2.0 ** -(level + 2), 45 * orientation)
    found = {band.key: band for band in bands.split(plane, "gabor", 1, 1)}
    key = BandKey("oriented", level, orientation)
    step = 1 << level
    assert found[key].plane == pytest.approx(plane[::step, ::step], abs=1e-5)
    assert strongest(found.values()).key == key
    # Half the peak is a third of the frequency away: an octave higher the wave is 3 / 2 of that away.
    if level:
        above = found[BandKey("oriented", level - 1, orientation)].plane
        assert rms(above) / rms(plane) == pytest.approx(2**-2.25, rel=1e-3)


@pytest.mark.parametrize(("level", "orientation"), [(0, 1), (1, 3), (2, 1)])
def test_diagonal_gabor_channels(level, orientation):
    plane = wave(2.0 ** -(level + 2), 45 * orientation, (192, 192))
    magnitudes = bands.split(plane, "gabor magnitude", 1, 1)
    best = strongest(magnitudes)
    assert best.key == BandKey("oriented", level, orientation)
    inside = best.plane.shape[0] // 4
    middle = best.plane[inside:-inside, inside:-inside]
    assert middle == pytest.approx(np.ones_like(middle), abs=0.01)
    assert best.span == "positive"
    assert best.title == f"1/{4 << level} cycles per pixel, waves along {45 * orientation}°"


def test_magnitudes_do_not_depend_on_the_phase():
    magnitudes = bands.split(wave(1 / 8, 0), "gabor magnitude", 1, 1)
    best = strongest(magnitudes)
    assert best.plane == pytest.approx(np.ones_like(best.plane), abs=0.01)


@pytest.mark.parametrize("orientations", [1, 4, 6])
def test_first_derivatives_of_a_slope(orientations):
    y, x = np.mgrid[:24, :30].astype(np.float32)
    found = bands.split(0.02 * x + 0.03 * y, "oriented", 1, orientations)
    for k in range(orientations):
        angle = np.pi * k / orientations
        expected = 0.02 * np.cos(angle) + 0.03 * np.sin(angle)
        assert found[k].plane[2:-2, 2:-2] == pytest.approx(np.full((20, 26), expected), abs=1e-5)
        assert found[orientations + k].plane[2:-2, 2:-2] == pytest.approx(np.zeros((20, 26)), abs=1e-5)


def test_second_derivatives_of_a_parabola():
    y, x = np.mgrid[:24, :30].astype(np.float32) / 32
    found = bands.split((x + y) ** 2, "oriented", 1, 4)
    for k in range(4):
        angle = np.pi * k / 4
        # In units of a pixel the parabola along (cos, sin) is ((cos + sin) t)^2 / 32^2.
        expected = 2 * (np.cos(angle) + np.sin(angle)) ** 2 / 1024
        assert found[4 + k].plane[2:-2, 2:-2] == pytest.approx(np.full((20, 26), expected), abs=1e-5)
    assert [band.label for band in found[:5]] == [
        "edge 0·0°",
        "edge 0·45°",
        "edge 0·90°",
        "edge 0·135°",
        "line 0·0°",
    ]
    assert found[6].title == "level 0, lines (second derivative), waves along 90°"


def test_a_level_of_derivatives_is_that_of_the_gaussian_pyramid():
    plane = np.random.default_rng(2).random((40, 40), np.float32)
    whole = bands.split(plane, "oriented", 2, 3)
    coarse = bands.split(gaussian.reduce(plane), "oriented", 1, 3)
    for band, other in zip(whole[6:12], coarse, strict=False):
        assert np.array_equal(band.plane, other.plane)


@pytest.mark.parametrize("size", [(4, 40), (5, 5), (40, 33), (64, 256)])
def test_derivatives_stop_where_the_filters_no_longer_fit(size):
    levels = most_derived(size)
    sides = [min(size)]
    for _ in range(levels):
        sides.append(-(-sides[-1] // 2))
    assert all(side >= 5 for side in sides[:-1])
    assert sides[-1] < 5


@pytest.mark.parametrize("kind", ["oriented", "filter bank"])
@pytest.mark.parametrize("degrees", [0, 30, 60, 90, 120, 150])
def test_waves_are_found_in_their_direction(kind, degrees):
    best = strongest(bands.split(wave(0.15, degrees), kind, 1, 6))
    assert f"waves along {degrees}°" in best.title


@pytest.mark.parametrize("level", [0, 1, 2])
def test_coarser_bars_are_found_on_coarser_levels(level):
    best = strongest(bands.split(wave(0.2 / 2**level, 90), "filter bank", 4, 1))
    assert best.title == f"level {level}, bars, waves along 90°"


@pytest.mark.parametrize("frequency", [0.05, 0.125, 0.25])
def test_responses_of_the_bank_are_those_of_its_gaussians(frequency):
    plane = wave(frequency, 0)
    spot, small, bar, *others = spots_bars.responses(plane)

    def gauss(sigma):
        # A sampled Gaussian's spectrum overlaps its own repetitions; its sum is 1.
        near, zero = (np.exp(-2 * (np.pi * sigma * (f + np.arange(-2, 3))) ** 2).sum() for f in (frequency, 0))
        return near / zero

    expected = {
        "spot": gauss(0.62) - 2 * gauss(1) + gauss(1.6),
        "small": gauss(0.71) - gauss(1.14),
        "bar": (2 - 2 * np.cos(2 * np.pi * frequency)) * gauss(1),
    }
    for name, found in (("spot", spot), ("small", small), ("bar", bar)):
        middle = (slice(None), slice(16, -16))
        assert found[middle] == pytest.approx(expected[name] * plane[middle], abs=1e-4), name
    # The horizontal bar sees waves along the rows as the difference of equal averages.
    assert np.abs(others[2][:, 16:-16]).max() < 1e-3


def test_a_spot_stands_out_in_spots_and_looks_the_same_from_all_sides():
    plane = np.zeros((31, 31), np.float32)
    plane[15, 15] = 1
    for kernel, found in zip(spots_bars.kernels(), spots_bars.responses(plane), strict=True):
        assert found[8:23, 8:23] == pytest.approx(kernel, abs=1e-6)
        assert found[15, 15] > 0
    for spot in spots_bars.kernels()[:2]:
        assert np.allclose(spot, spot.T)
        assert np.allclose(spot, spot[::-1])


@pytest.mark.parametrize("kind", ["gaussian", *LOOKING])
def test_what_does_not_add_up_is_not_collapsed(kind):
    with pytest.raises(ValueError, match=f"kind {kind} cannot be collapsed"):
        bands.amplify(np.zeros((8, 8, 1), np.float32), kind, 1, 1, {})
