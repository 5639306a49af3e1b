"""Measures by place and of exemplars: brute force, planted flaws, closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import ndimage
from test_measures_looks import pebbles

from texlab_core.errors import Cancelled
from texlab_core.measures import blocks, exemplar_kind, fine, palette, repeats
from texlab_core.measures.discriminability import described
from texlab_core.measures.registry import find_measure
from texlab_core.measures.subject import Subject
from texlab_core.transforms.luma import luma


def noise(height: int, width: int, seed: int = 0, channels: int = 3) -> np.ndarray:
    return np.random.default_rng(seed).random((height, width, channels), np.float32)


def none() -> None:
    """Look at nothing."""


def of(measure: str, exemplar: np.ndarray, image: np.ndarray) -> float:
    value = find_measure(measure).of(Subject.of_images(exemplar, image))
    assert value is not None
    return value


def test_the_odd_block_is_where_it_was_planted() -> None:
    exemplar = pebbles(96, 96)
    image = pebbles(96, 96, seed=1)
    image[48:80, 16:48] = [0.0, 1.0, 0.0]
    found = blocks.block_map(Subject.of_images(exemplar, image))
    assert found is not None
    row, column = np.unravel_index(found.distances.argmax(), found.distances.shape)
    assert (found.tops[row], found.lefts[column]) == (48, 16)
    assert of("odd-blocks", exemplar, image) == pytest.approx(np.percentile(found.distances, 99))
    assert of("odd-blocks", exemplar, image) > 3 * of("odd-blocks", exemplar, pebbles(96, 96, seed=1))


def test_distances_back_are_those_of_brute_force() -> None:
    subject = Subject.of_images(pebbles(64, 72), pebbles(80, 64, seed=2))
    both = described(subject)
    found = blocks.missing_distances(subject)
    assert both is not None
    assert found is not None
    points = both[0].blocks @ both[1].whitening
    brute = [min(np.linalg.norm(own - other) for other in points) for own in both[1].blocks]
    np.testing.assert_allclose(found, brute, atol=1e-9)
    assert of("block-distance-back", pebbles(64, 64), pebbles(64, 64)) == pytest.approx(0, abs=1e-6)


def test_energies_vary_as_much_as_those_of_the_exemplar() -> None:
    exemplar = pebbles(96, 96)
    assert of("energy-spread", exemplar, exemplar) == pytest.approx(1, abs=1e-6)
    uneven = exemplar.copy()
    uneven[:, :48] = 0.5 + 0.05 * (uneven[:, :48] - 0.5)
    assert of("energy-spread", exemplar, uneven) > 1.5


def test_new_colours_are_those_of_brute_force() -> None:
    exemplar, image = noise(12, 12), noise(20, 16, seed=1)
    subject = Subject.of_images(exemplar, image)
    own = np.rint(exemplar.reshape(-1, 3) * 255)
    sampled = np.rint(image[::3, ::3] * 255)
    brute = np.array([[np.linalg.norm(own - pixel, axis=1).min() for pixel in row] for row in sampled])
    np.testing.assert_allclose(palette.palette_map(subject), brute)
    assert palette.palette_distance(subject) == pytest.approx(brute.mean())
    assert of("palette-distance", exemplar, np.tile(exemplar, (2, 2, 1))) == 0
    large = np.tile(image, (32, 32, 1))
    assert palette.palette_map(Subject.of_images(exemplar, large)).size <= palette.MOST
    # A gray picture is one of three equal channels.
    assert of("palette-distance", exemplar[:, :, :1], exemplar[:, :, :1]) == 0


def test_specks_are_found_one_by_one() -> None:
    exemplar = np.full((40, 40, 1), 0.5, np.float32)
    image = exemplar.copy()
    image[[5, 20, 33], [7, 0, 39]] = 1.0
    subject = Subject.of_images(exemplar, image)
    assert sorted(map(tuple, np.argwhere(fine.speck_map(subject)))) == [(5, 7), (20, 0), (33, 39)]
    assert fine.specks(subject) == pytest.approx(3 / 1600)
    gray = luma(noise(30, 31))
    brute = np.abs(gray - ndimage.median_filter(gray, 3, mode="nearest"))
    np.testing.assert_allclose(fine.stands_out(noise(30, 31), none), brute, atol=1e-6)


def test_empty_places_are_those_that_were_wiped() -> None:
    exemplar = noise(64, 64, channels=1)
    image = noise(64, 80, seed=1, channels=1)
    image[16:32, 32:64] = 0.5
    subject = Subject.of_images(exemplar, image)
    # The border of a wiped place still has gradients, but fewer than a whole place.
    assert [tuple(each) for each in np.argwhere(fine.empty_map(subject))] == [(1, 2), (1, 3)]
    assert fine.empty_share(subject) == pytest.approx(2 / 20)


def test_contrast_is_a_ratio() -> None:
    exemplar = noise(64, 64, channels=1)
    assert of("local-contrast", exemplar, 0.5 + 0.3 * (exemplar - 0.5)) == pytest.approx(0.3, rel=1e-4)
    flat = np.full((64, 64, 1), 0.5, np.float32)
    assert find_measure("local-contrast").of(Subject.of_images(flat, exemplar)) is None


def test_repetition_at_the_exemplars_sides() -> None:
    exemplar = noise(32, 24)
    assert of("self-repetition", exemplar, np.tile(exemplar, (2, 2, 1))) == pytest.approx(1, abs=1e-5)
    assert of("self-repetition", exemplar, noise(96, 96, seed=3)) < 0.1
    assert repeats.lag_correlation(luma(exemplar), 0, 31) is None
    # One side alone repeats.
    half = np.concatenate([exemplar, noise(32, 24, 1)], axis=0)
    assert of("self-repetition", exemplar, np.tile(half, (1, 2, 1))) == pytest.approx(1, abs=1e-5)


def test_seams_are_jumps_around_the_border() -> None:
    rows = np.sin(2 * np.pi * np.arange(64) / 64)
    smooth = np.repeat((0.5 + 0.4 * rows)[:, None, None], 64, axis=1).astype(np.float32)
    exemplar = smooth + noise(64, 64, channels=1) * 0.02
    tiles = repeats.seams(Subject.of_images(exemplar, exemplar))
    cropped = repeats.seams(Subject.of_images(exemplar, exemplar[:40]))
    assert tiles is not None
    assert cropped is not None
    assert tiles["row"] < 5
    assert cropped["row"] > 20
    assert cropped["column"] < 5
    assert of("seam", exemplar, exemplar[:40]) == pytest.approx(cropped["row"])


@pytest.mark.parametrize(
    ("name", "turn"),
    [
        ("left and right", lambda half: np.concatenate([half, half[:, ::-1]], axis=1)),
        ("top and bottom", lambda half: np.concatenate([half, half[::-1]], axis=0)),
        ("a half turn", lambda half: np.concatenate([half, half[::-1, ::-1]], axis=1)),
    ],
)
def test_symmetry_is_found_wherever_its_axis_is(name: str, turn) -> None:  # type: ignore[no-untyped-def]
    whole = np.roll(turn(noise(48, 40)), (5, 9), axis=(0, 1))
    found = exemplar_kind.agreement(whole, none)
    assert found is not None
    assert found.turned[name] == pytest.approx(1, abs=1e-3)
    assert found.symmetries[name] == max(found.symmetries.values()) == pytest.approx(1, abs=1e-3)
    assert of("exemplar-symmetry", whole, whole) == pytest.approx(1, abs=1e-3)


def test_a_period_is_no_symmetry() -> None:
    period = np.tile(np.concatenate([noise(16, 16), noise(16, 16)[:, ::-1]], axis=1), (2, 2, 1))
    assert of("exemplar-symmetry", period, period) == pytest.approx(0, abs=1e-2)
    assert of("exemplar-symmetry", noise(64, 64), noise(64, 64)) < 0.2
    assert exemplar_kind.agreement(np.full((32, 32, 1), 0.5, np.float32), none) is None
    assert of("exemplar-period", period, period) == pytest.approx(1, abs=1e-3)
    assert of("exemplar-period", noise(64, 64), noise(64, 64)) < 0.2
    # A period of a quarter of the side, weakened by noise as strong as itself.
    mixed = np.tile(noise(16, 16, channels=1), (4, 4, 1)) + noise(64, 64, 5, channels=1)
    assert of("exemplar-period", mixed / 2, mixed / 2) == pytest.approx(0.5, abs=0.1)


def test_two_tones_are_those_of_otsu() -> None:
    image = np.full((40, 40, 1), 0.9, np.float32)
    image[:20, :20] = 0.1
    assert exemplar_kind.two_tones(image, none) == pytest.approx((1.0, 0.25))
    assert of("exemplar-symbols", image, image) == pytest.approx(1)
    assert of("exemplar-symbols", image[:, :24], image) == 0
    values = noise(30, 30, channels=1)
    found = exemplar_kind.two_tones(values, none)
    levels = np.rint(values.reshape(-1) * 255) / 255
    best = max(
        (levels < cut).mean()
        * (levels >= cut).mean()
        * (levels[levels < cut].mean() - levels[levels >= cut].mean()) ** 2
        for cut in np.unique(levels)[1:]
    )
    assert found is not None
    assert found[0] == pytest.approx(best / levels.var(), rel=1e-6)


def test_large_structure_is_that_of_few_periods() -> None:
    columns = np.arange(64)
    for periods, share in ((2, 1), (4, 1), (8, 0)):
        wave = np.repeat(0.5 + 0.4 * np.sin(2 * np.pi * periods * columns / 64)[None, :, None], 64, axis=0)
        assert exemplar_kind.large_share(wave.astype(np.float32), none) == pytest.approx(share, abs=0.08)
    ramp = np.repeat((columns / 63)[None, :, None], 64, axis=0).astype(np.float32)
    # A straight gradient is another measure's.
    assert exemplar_kind.large_share(ramp, none) is None


@pytest.mark.parametrize(
    "measure",
    ["block-distance-back", "palette-distance", "specks", "empty-share", "self-repetition", "exemplar-symmetry"],
)
def test_they_can_be_stopped(measure: str) -> None:
    subject = Subject.of_images(noise(64, 64), noise(64, 64, 1), should_stop=lambda: True)
    with pytest.raises(Cancelled):
        find_measure(measure).of(subject)


def test_what_is_too_small_says_nothing() -> None:
    small = noise(2, 2)
    for measure in ("block-distance-back", "odd-blocks", "energy-spread", "specks", "empty-share", "seam"):
        assert find_measure(measure).of(Subject.of_images(small, small)) is None
