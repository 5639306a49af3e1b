"""Subbands for looking at: names, sizes, reflection, and putting together with gains."""

import numpy as np
import pytest

from texlab_core.stats import bands
from texlab_core.transforms import laplacian, steerable
from texlab_core.transforms.steerable import BandKey


def noise(*shape):
    return np.random.default_rng(3).random(shape, np.float32)


def test_steerable_bands_are_those_of_the_reflected_pyramid():
    plane = noise(37, 50)
    found = bands.split(plane, "steerable", 2, 3)
    expected = list(steerable.build_reflected(plane, 2, 3).items())
    assert [band.key for band in found] == [key for key, _ in expected]
    for band, (_, values) in zip(found, expected, strict=True):
        assert np.array_equal(band.plane, values)
    assert [band.label for band in found] == [
        "high", "0·0°", "0·60°", "0·120°", "1·0°", "1·60°", "1·120°", "low",
    ]  # fmt: skip
    assert [band.signed for band in found] == [True] * 7 + [False]
    assert found[3].title == "level 0, waves along 120°"


def test_laplacian_and_gaussian():
    plane = noise(40, 41)
    found = bands.split(plane, "laplacian", 3, 9)
    assert [band.label for band in found] == ["0", "1", "2", "low"]
    assert np.array_equal(found[1].plane, laplacian.build(plane, 3)[1])
    levels = bands.split(plane, "gaussian", 3, 1)
    assert np.array_equal(levels[0].plane, plane)
    assert [band.plane.shape for band in levels] == [(40, 41), (20, 21), (10, 11), (5, 6)]
    assert not any(band.signed for band in levels)


@pytest.mark.parametrize("kind", ["steerable", "laplacian", "gaussian"])
@pytest.mark.parametrize("size", [(1, 1), (2, 9), (8, 8)])
def test_too_many_levels_become_as_many_as_fit(kind, size):
    found = bands.split(noise(*size), kind, 8, 2)
    assert found[-1].key.level == bands.most_levels(size, kind)


def test_projections():
    image = noise(9, 7, 3)
    assert np.array_equal(bands.projection(image, "green").plane(image), image[..., 1])
    luma = bands.projection(image, "luma").plane(image)
    assert luma == pytest.approx(image @ np.array(bands.LUMA, np.float32), abs=1e-6)
    planes = [bands.projection(image, f"axis {k}").plane(image) for k in (1, 2, 3)]
    flat = np.stack([plane.ravel() for plane in planes]).astype(np.float64)
    covariance = flat @ flat.T / flat.shape[1]
    assert covariance == pytest.approx(np.diag(np.diag(covariance)), abs=1e-6)
    assert np.all(np.diff(np.diag(covariance)) < 0)
    assert np.trace(covariance) == pytest.approx(image.reshape(-1, 3).var(0).sum(), rel=1e-4)


def test_gray_has_one_plane():
    image = noise(5, 6, 1)
    assert bands.channel_names(1) == ("luma",)
    assert bands.channel_names(3) == bands.CHANNELS
    assert np.array_equal(bands.projection(image, "luma").plane(image), image[..., 0])


def test_an_axis_that_gray_colours_lack_is_zero():
    image = np.repeat(noise(5, 6, 1), 3, axis=2)
    assert np.all(bands.projection(image, "axis 3").plane(image) == 0)
    assert np.allclose(bands.amplify(image, "laplacian", 1, 1, {BandKey("bandpass", 0): 0}, "axis 2"), image)


@pytest.mark.parametrize("kind", ["steerable", "laplacian"])
@pytest.mark.parametrize("channel", ["luma", "blue", "axis 1"])
def test_gains_of_one_return_the_image(kind, channel):
    image = noise(33, 48, 3)
    key = bands.split(image[..., 0], kind, 2, 4)[1].key
    changed = bands.amplify(image, kind, 2, 4, {key: 1.0000001}, channel)
    assert np.abs(changed - image).max() < 1e-5
    assert bands.amplify(image, kind, 2, 4, {key: 1.0}, channel) is image


def test_all_bands_doubled_double_the_image():
    image = noise(32, 24, 1)
    for kind in ("steerable", "laplacian"):
        gains = {band.key: 2.0 for band in bands.split(image[..., 0], kind, 2, 4)}
        assert bands.amplify(image, kind, 2, 4, gains) == pytest.approx(2 * image, abs=2e-5)


def test_muting_the_laplacian_bands_leaves_the_expanded_residual():
    image = noise(32, 32, 3)
    muted = bands.amplify(image, "laplacian", 1, 1, {BandKey("bandpass", 0): 0.0})
    low = laplacian.build(image, 1)[-1]
    assert muted == pytest.approx(laplacian.collapse([np.zeros_like(image), low]), abs=1e-6)


def test_muting_the_residual_takes_the_mean_away():
    image = noise(32, 32, 1) + 3
    changed = bands.amplify(image, "steerable", 2, 4, {BandKey("lowpass", 2): 0.0})
    assert abs(changed.mean()) < 1e-4


def test_one_channel_leaves_the_others():
    image = noise(16, 16, 3)
    changed = bands.amplify(image, "steerable", 1, 2, {BandKey("highpass"): 4.0}, "red")
    assert np.array_equal(changed[..., 1:], image[..., 1:])
    assert np.abs(changed[..., 0] - image[..., 0]).max() > 0.1


def test_gaussian_cannot_be_collapsed():
    with pytest.raises(ValueError, match="cannot be collapsed"):
        bands.amplify(noise(8, 8, 1), "gaussian", 1, 1, {})


def test_looks_between_the_bands():
    class Stop(Exception):
        pass

    calls = []

    def look():
        calls.append(1)
        if len(calls) == 3:
            raise Stop

    with pytest.raises(Stop):
        bands.split(noise(16, 16), "steerable", 2, 4, look)
    calls.clear()
    with pytest.raises(Stop):
        bands.amplify(noise(16, 16, 1), "steerable", 2, 4, {BandKey("highpass"): 2.0}, "luma", look)


class Stop(Exception):
    """Nobody waits any more."""


def stops_at(count):
    """Return a function that stops at its ``count``-th call, and the list of its calls."""
    calls = []

    def look():
        calls.append(1)
        if len(calls) == count:
            raise Stop

    return look, calls


KINDS = ["steerable", "laplacian", "gaussian", "oriented", "gabor", "gabor magnitude", "filter bank"]


@pytest.mark.parametrize("kind", KINDS)
def test_splitting_can_be_stopped_at_every_look(kind):
    plane = noise(40, 48)
    # What is kept for the next time is made first: it looks too.
    bands.split(plane, kind, 2, 3)
    look, calls = stops_at(0)
    whole = bands.split(plane, kind, 2, 3, look)
    total = len(calls)
    assert total > len(whole)
    for count in sorted({1, 2, total // 3, total // 2, total}):
        look, calls = stops_at(count)
        with pytest.raises(Stop):
            bands.split(plane, kind, 2, 3, look)
        assert len(calls) == count


@pytest.mark.parametrize("kind", ["steerable", "gabor"])
def test_looks_come_within_the_transform_of_a_large_plane(kind):
    # Mirrored it is transformed in blocks of rows and of columns, between which there is a look.
    look, calls = stops_at(0)
    bands.split(noise(800, 801), kind, 1, 1, look)
    assert len(calls) > 60


@pytest.mark.parametrize("kind", bands.COLLAPSIBLE)
def test_amplifying_can_be_stopped_at_every_look(kind):
    image, gains = noise(30, 40, 3), {BandKey("lowpass", 2): 0.5}
    bands.amplify(image, kind, 2, 2, gains)
    look, calls = stops_at(0)
    bands.amplify(image, kind, 2, 2, gains, "luma", look)
    total = len(calls)
    # Two levels taken apart and put together, for each of three channels.
    assert total >= 3 * 4
    for count in (1, total // 2, total):
        look, calls = stops_at(count)
        with pytest.raises(Stop):
            bands.amplify(image, kind, 2, 2, gains, "luma", look)
        assert len(calls) == count
