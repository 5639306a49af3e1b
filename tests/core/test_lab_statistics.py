"""The laboratory's statistics: the representation and its classes, and equalization of two images."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from texlab_core.errors import InputError, ParamError
from texlab_core.stats import equalization, representation
from texlab_core.stats.representation import BOTH, HORIZONTAL, NEITHER, VERTICAL

SIDE = 128


def composite() -> tuple[np.ndarray, np.ndarray]:
    """Return four quadrants of equal size (vertical, horizontal, both, neither) and their classes."""
    rng = np.random.default_rng(4)
    y, x = np.mgrid[: 2 * SIDE, : 2 * SIDE]
    vertical, horizontal = 0.5 + 0.3 * np.sin(x * 0.9), 0.5 + 0.3 * np.sin(y * 0.9)
    both = 0.5 + 0.3 * np.sin(x * 0.9) * np.sin(y * 0.9) * 2**0.5
    plane = np.full(x.shape, 0.5)
    truth = np.full(x.shape, NEITHER)
    for (top, left), texture, label in (
        ((0, 0), vertical, VERTICAL),
        ((0, 1), horizontal, HORIZONTAL),
        ((1, 0), both, BOTH),
    ):
        here = (slice(top * SIDE, (top + 1) * SIDE), slice(left * SIDE, (left + 1) * SIDE))
        plane[here], truth[here] = texture[here], label
    return (plane + 0.02 * rng.standard_normal(plane.shape)).astype(np.float32), truth


def test_the_quadrants_are_read_as_the_figure_says():
    plane, truth = composite()
    right = {
        smoothing: np.mean(representation.represent(plane, smoothing).classes == truth) for smoothing in (4, 8)
    }
    assert right[8] >= 0.84 * 0.8
    found = representation.represent(plane)
    middles = {VERTICAL: (64, 64), HORIZONTAL: (64, 192), BOTH: (192, 64), NEITHER: (192, 192)}
    for label, place in middles.items():
        assert found.classes[place] == label, representation.CLASS_NAMES[label]
    assert sum(found.shares) == pytest.approx(1)


def test_the_stages_belong_together():
    plane, _ = composite()
    found = representation.represent(plane, 8, 0.5)
    # Half the mean of both maps, which smoothing keeps (but for what is mirrored at the border).
    assert found.threshold == pytest.approx((found.vertical.mean() + found.horizontal.mean()) / 4, rel=0.05)
    np.testing.assert_array_equal(found.classes & VERTICAL > 0, found.smooth_vertical > found.threshold)
    np.testing.assert_array_equal(found.classes & HORIZONTAL > 0, found.smooth_horizontal > found.threshold)
    # Black beside white stripes count as white beside black ones.
    turned = representation.represent(1 - plane, 8, 0.5)
    np.testing.assert_array_equal(turned.classes, found.classes)


def mosaic(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return four textures of equal mean and contrast in quadrants, and which is where."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[:SIDE, :SIDE]
    noise = rng.standard_normal((SIDE, SIDE))
    v, u = np.fft.fftfreq(SIDE)[:, None], np.fft.fftfreq(SIDE)
    low = np.fft.ifft2(np.fft.fft2(noise) * np.exp(-((np.hypot(u, v) * 12) ** 2))).real
    parts = [np.sin(x * 0.7 + 0.5 * y), np.sin(y * 1.2), noise, low]
    tiles = [0.5 + 0.12 * (part - part.mean()) / part.std() for part in parts]
    plane = np.block([[tiles[0], tiles[1]], [tiles[2], tiles[3]]]).astype(np.float32)
    return plane, np.kron(np.arange(4).reshape(2, 2), np.ones((SIDE, SIDE), int))


@pytest.mark.parametrize("seed", [0, 1])
def test_k_means_tells_four_textures_of_equal_contrast_apart(seed):
    plane, truth = mosaic(seed)
    features = representation.energy_features(plane)
    assert features.shape == (24, 2 * SIDE, 2 * SIDE)
    np.testing.assert_allclose(features.mean(axis=(1, 2)), 0, atol=1e-3)
    np.testing.assert_allclose(features.std(axis=(1, 2)), 1, atol=1e-3)
    labels = representation.gather(features, 4, np.random.default_rng(seed))
    right = max(np.mean(np.array(order)[labels] == truth) for order in itertools.permutations(range(4)))
    assert right > 0.87
    counts = np.bincount(labels.ravel())
    assert counts[0] == counts.max()
    again = representation.gather(features, 4, np.random.default_rng(seed))
    np.testing.assert_array_equal(labels, again)


def test_one_colour_is_one_class():
    flat = np.full((32, 32), 0.5, np.float32)
    assert set(
        np.unique(representation.gather(representation.energy_features(flat), 2, np.random.default_rng(0)))
    ) == {0}
    assert (representation.represent(flat).classes == NEITHER).all()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: representation.represent(np.zeros((32, 32), np.float32), 0), "smoothing: must be"),
        (lambda: representation.represent(np.zeros((32, 32), np.float32), 8, 0), "threshold: must be"),
        (
            lambda: representation.gather(np.zeros((2, 8, 8), np.float32), 9, np.random.default_rng()),
            "classes: must",
        ),
        (lambda: equalization.equalization(np.zeros((0, 2)), np.ones((2, 2))), "Image two must have values"),
        (
            lambda: equalization.equalization(np.ones((2, 2)), np.full((2, 2), np.nan)),
            "Image one must have values",
        ),
    ],
)
def test_what_cannot_be_used_is_refused(make, message):
    with pytest.raises((ParamError, InputError), match=message):
        make()


# Equalization.


def test_the_book_s_ramps_become_each_other():
    found = equalization.equalization(equalization.ramp(), equalization.cube_root_ramp())
    np.testing.assert_array_equal(found.remapped("together"), equalization.cube_root_ramp())
    for value in (0.0, 0.2, 0.7, 1.0):
        arrow = found.arrow(float(np.float32(round(value * 255) / 255)))
        assert arrow.new_value == pytest.approx(np.cbrt(arrow.value), abs=1e-6)
        assert arrow.share == pytest.approx((round(value * 255) + 1) / 256)
    assert found.distance(found.plane) > 0.2
    assert found.distance(found.remapped()) == pytest.approx(0, abs=1e-7)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_every_value_goes_where_the_algorithm_sends_it(seed):
    """Algorithm 11.3 value by value, on images of few values and other sizes, by its own words."""
    rng = np.random.default_rng(seed)
    one = rng.integers(0, 7, (9, 11)).astype(np.float32)
    two = rng.integers(0, 5, (8, 6)).astype(np.float32)
    found = equalization.equalization(two, one)
    together = found.remapped("together")
    for value in np.unique(two):
        share = np.mean(two <= value)
        wanted = min(each for each in np.unique(one) if np.mean(one <= each) >= share - 1e-12)
        assert np.unique(together[two == value]) == [wanted]
        assert found.arrow(float(value)).new_value == wanted


def test_ties_are_dealt_out_at_random():
    """The text's binary images: every pixel but one is black, and half the pixels are white."""
    one = np.zeros((16, 16), np.float32)
    one[3, 3] = 1
    two = np.zeros((16, 16), np.float32)
    two[:, 8:] = 1
    found = equalization.equalization(two, one)
    places = set()
    for key in range(40):
        matched = found.remapped("random", key)
        assert matched.sum() == 1
        row, column = (int(each[0]) for each in np.nonzero(matched))
        assert column >= 8
        places.add((row, column))
    assert len(places) > 25
    np.testing.assert_array_equal(found.remapped("random", 5), found.remapped("random", 5))
    # Word for word, all white pixels stay together.
    assert found.remapped("together").sum() in (0, 128)
    with pytest.raises(ParamError, match="ties: must be one of random, together"):
        found.remapped("never")


def test_curves_are_cumulative_histograms():
    rng = np.random.default_rng(0)
    plane = rng.random((64, 64)).astype(np.float32)
    found = equalization.equalization(plane, np.round(plane * 4) / 4)
    for (values, shares), source in zip(found.curves(), (np.round(plane * 4) / 4, plane), strict=True):
        assert shares[0] == 0
        assert shares[-1] == 1
        assert (np.diff(values) >= 0).all()
        assert (np.diff(shares) >= 0).all()
        assert shares[1::2] == pytest.approx([np.mean(source <= value) for value in values[1::2]], abs=1e-6)
        assert values.size <= 1024
