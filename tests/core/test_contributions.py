"""Which subbands built a pixel: contributions add up, and a wave is built by the band it lies in."""

import numpy as np
import pytest

from texlab_core.methods.heeger_bergen.contributions import contributions
from texlab_core.transforms import steerable
from texlab_core.transforms.steerable import BandKey

PYRAMIDS = ("steerable", "laplacian", "textbook")


@pytest.mark.parametrize("pyramid", PYRAMIDS)
@pytest.mark.parametrize("size", [(1, 1), (5, 9), (40, 33), (64, 64)])
def test_contributions_add_up_to_the_picture(pyramid, size):
    plane = np.random.default_rng(1).random(size, np.float32)
    found = contributions(plane, pyramid, 4, 3)
    planes = np.stack([found.plane(index) for index in range(len(found.keys))])
    assert planes.shape == (len(found.keys), *size)
    assert planes.sum(axis=0) == pytest.approx(plane, abs=1e-5)
    assert found.spreads == pytest.approx(planes.std(axis=(1, 2)), abs=1e-5)
    for row, column in ((0, 0), (size[0] // 2, size[1] - 1), (size[0] - 1, size[1] // 3)):
        assert found.at(row, column) == pytest.approx(planes[:, row, column], abs=2e-6)


@pytest.mark.parametrize("pyramid", PYRAMIDS)
def test_a_constant_is_all_residual(pyramid):
    found = contributions(np.full((32, 32), 0.25, np.float32), pyramid, 3, 4)
    assert found.at(7, 9) == pytest.approx([0] * (len(found.keys) - 1) + [0.25], abs=1e-6)
    assert found.spreads == pytest.approx(np.zeros(len(found.keys)), abs=1e-6)


@pytest.mark.parametrize(("level", "period"), [(0, 3), (1, 6), (2, 12)])
def test_a_wave_is_built_by_its_own_level_and_orientation(level, period):
    rows = np.arange(48)[:, None]
    plane = (np.cos(2 * np.pi * rows / period) * np.ones(48)).astype(np.float32)
    found = contributions(plane, "steerable", 4, 4)
    best = found.keys[int(np.argmax(found.spreads))]
    # Horizontal stripes: waves along 90 degrees, the third of four orientations.
    assert best == BandKey("oriented", level, 2)


def test_a_contribution_is_the_collapse_of_that_band_alone():
    plane = np.random.default_rng(2).random((32, 40), np.float32)
    found = contributions(plane, "steerable", 2, 3)
    whole = steerable.build(plane, 2, 3)
    rows = tuple(
        tuple(band if (level, number) == (1, 2) else np.zeros_like(band) for number, band in enumerate(row))
        for level, row in enumerate(whole.bands)
    )
    lone = steerable.SteerablePyramid(np.zeros_like(whole.highpass), rows, np.zeros_like(whole.lowpass))
    index = found.keys.index(BandKey("oriented", 1, 2))
    assert found.plane(index) == pytest.approx(steerable.collapse(lone), abs=1e-6)


def test_looks_between_the_subbands():
    class Stop(Exception):
        pass

    seen = []

    def look():
        seen.append(1)
        if len(seen) == 3:
            raise Stop

    with pytest.raises(Stop):
        contributions(np.zeros((32, 32), np.float32), "steerable", 3, 4, look)
    assert len(seen) == 3


def test_many_bands_take_less_room_than_their_planes():
    plane = np.random.default_rng(3).random((128, 128), np.float32)
    found = contributions(plane, "steerable", 4, 4)
    assert found.nbytes < plane.nbytes * len(found.keys) / 2.5
