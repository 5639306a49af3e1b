"""The sphere: its true orientation, and local estimates by slant."""

from __future__ import annotations

import math

import numpy as np
import pytest

from texlab_core.errors import ParamError
from texlab_core.shape.orientation import Orientation
from texlab_core.shape.rendering import slanted_plane
from texlab_core.shape.sphere import errors_by_slant, local_shape, render_sphere
from texlab_core.shape.textures import disc_texture

WANTED = (23, 14, 7, 6)


def test_local_estimates_reach_their_figures_on_discs():
    spheres = [render_sphere(512, np.random.default_rng(seed)) for seed in (30, 31)]
    means = np.mean([errors_by_slant(each, local_shape(each.image, 24)) for each in spheres], axis=0)
    assert all(means <= 1.2 * np.array(WANTED)), means


def test_a_wider_window_reads_low_slants_better():
    sphere = render_sphere(256, np.random.default_rng(1), "noise")
    narrow, wide = (errors_by_slant(sphere, local_shape(sphere.image, window))[0] for window in (16, 48))
    assert wide < narrow


def test_the_truth_is_that_of_a_sphere():
    sphere = render_sphere(128, np.random.default_rng(0))
    radius = 0.45 * 128
    # A pixel's middle is half a pixel off the sphere's: row 64, column 64 + x.
    assert sphere.slant[64, 64 + 28] == pytest.approx(math.degrees(math.asin(math.hypot(28.5, 0.5) / radius)))
    assert sphere.tilt[64 + 28, 64] == pytest.approx(math.degrees(math.atan2(28.5, 0.5)))
    assert np.isnan(sphere.slant[0, 0])
    assert sphere.image[0, 0] == 0.5
    assert np.array_equal(sphere.image, render_sphere(128, np.random.default_rng(0)).image)


def test_a_slanted_plane_reads_alike_everywhere():
    truth = Orientation(60, 30)
    seen = slanted_plane(disc_texture(512, np.random.default_rng(2), softness=4), truth, (256, 256))
    found = local_shape(seen, 64)
    middle = (slice(64, 192, 16), slice(64, 192, 16))
    assert np.median(found.slant[middle]) == pytest.approx(60, abs=4)
    assert np.median(found.tilt[middle]) == pytest.approx(30, abs=4)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: render_sphere(20, np.random.default_rng()), "side: must be"),
        (lambda: render_sphere(128, np.random.default_rng(), "cloth"), "texture: must be one of discs, noise"),
        (lambda: local_shape(np.zeros((64, 64), np.float32), 4), "window: must be"),
    ],
)
def test_what_cannot_be_used_is_refused(make, message):
    with pytest.raises(ParamError, match=message):
        make()
