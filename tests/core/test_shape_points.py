"""Shape from texture, points: what homogeneity does not tell, what marks and perspective do, exercises 2 and 3."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.stats import binom, kstest

from texlab_core.errors import InputError, ParamError
from texlab_core.shape import exercises, homogeneity, points
from texlab_core.shape.homogeneity import uniformity, uniformity_landscape
from texlab_core.shape.orientation import Orientation

FRONTAL = Orientation(0)


def true_error(found: Orientation, truth: Orientation) -> float:
    """Return the angle between normals, without forgiving a turned tilt: perspective tells them apart."""
    return math.degrees(math.acos(min(1.0, float(found.normal @ truth.normal))))


# 1. Poisson under orthography.


@pytest.mark.parametrize("slant", [0, 40, 60, 75])
def test_congruent_rectangles_hold_equally_many_points_along_and_across_the_tilt(slant):
    rng = np.random.default_rng(slant)
    along, across = np.sum(
        [homogeneity.count_ratio(points.poisson(5e4, Orientation(slant, 33), rng), 33) for _ in range(4)], axis=0
    )
    # Five standard deviations of a ratio of two independent Poisson counts.
    assert along / across == pytest.approx(1, abs=5 * math.sqrt(2 / along))


def test_the_control_looks_the_same_frontal_as_slanted():
    """The most even hypothesis is no more often the true one, and evenness is distributed the same either way."""
    rng = np.random.default_rng(1)
    hypotheses = [Orientation(50, tilt) for tilt in range(0, 180, 15)]
    trials, true = 120, 4
    hits = sum(
        homogeneity.most_uniform(points.poisson(400, hypotheses[true], rng), hypotheses) == true
        for _ in range(trials)
    )
    low, high = binom.ppf([0.001, 0.999], trials, 1 / len(hypotheses))
    assert low <= hits <= high
    for truth in (FRONTAL, hypotheses[true]):
        evenness = [uniformity(points.poisson(400, truth, rng), hypotheses[true]) for _ in range(300)]
        assert kstest(evenness, "uniform").pvalue > 1e-3, truth
    flat = [uniformity_landscape(points.poisson(400, truth, rng), 13)[0] for truth in (FRONTAL, hypotheses[true])]
    means = [float(np.nanmean(each)) for each in flat]
    assert all(0.2 < mean < 0.8 for mean in means)


# 2. The border.


def test_quadrats_at_the_border_make_any_plane_look_frontal():
    rng = np.random.default_rng(2)
    hypotheses = [FRONTAL] + [Orientation(slant, tilt) for slant in (20, 40, 60) for tilt in (0, 45, 90, 135)]
    chosen = [
        homogeneity.most_uniform(points.poisson(400, Orientation(50, 60), rng), hypotheses, at_border=True)
        for _ in range(40)
    ]
    assert np.mean(np.array(chosen) == 0) > 0.9
    found, axis = uniformity_landscape(points.poisson(400, Orientation(50, 60), rng), 13, at_border=True)
    assert axis[6] == 0
    assert found[6, 6] == np.nanmin(found)


# 3. and 4. What does work.


@pytest.mark.parametrize(("slant", "wanted"), [(30, 5.5), (50, 2.5), (70, 1.1)])
def test_marks_tell_the_orientation(slant, wanted):
    rng = np.random.default_rng(3)
    errors = []
    for tilt in range(0, 180, 2):
        truth = Orientation(slant, tilt)
        _, tensors = homogeneity.random_marks(100, truth, rng)
        errors.append(homogeneity.orientation_of_marks(tensors).error(truth))
    assert np.mean(errors) <= 1.2 * wanted


def test_marks_of_all_directions_tell_it_exactly():
    truth = Orientation(63, 40)
    angle = np.pi * np.arange(8) / 8
    along = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    shapes = 3 * along[:, :, None] * along[:, None, :] + np.eye(2)
    matrix = truth.foreshortening()
    assert homogeneity.orientation_of_marks(matrix @ shapes @ matrix).error(truth) < 1e-5


@pytest.mark.parametrize(("slant", "wanted"), [(0, 4.2), (20, 4.3), (40, 2.6)])
def test_perspective_tells_the_orientation(slant, wanted):
    rng = np.random.default_rng(4)
    errors = []
    for tilt in range(0, 360, 8):
        truth = Orientation(slant, tilt)
        fit = homogeneity.orientation_of_density(homogeneity.perspective_points(400, truth, rng))
        assert not fit.at_guard
        errors.append(true_error(fit.orientation, truth))
    assert np.mean(errors) <= 1.2 * wanted


def test_the_perspective_density_is_that_of_equal_areas_of_the_plane():
    truth = Orientation(45, 70)
    seen = homogeneity.perspective_points(60000, truth, np.random.default_rng(5))
    areas = exercises.back_projected_areas(4, 4, truth, "perspective")
    counts = points.count_in_sets(seen, 4)
    shares = points.Counts(counts.counts, (areas / areas.sum()).reshape(-1))
    assert shares.p_value > 1e-3
    assert counts.p_value < 1e-9


def test_the_horizon_is_guarded():
    with pytest.raises(ParamError, match="horizon stays outside"):
        homogeneity.perspective_points(10, Orientation(75, 45), np.random.default_rng())
    with pytest.raises(ParamError, match="horizon stays outside"):
        exercises.back_projected_areas(2, 2, Orientation(80, 45), "perspective")
    # Points in one corner alone are most likely beneath a horizon: the guard holds the estimate back.
    crowd = np.full((40, 2), 0.01) + np.random.default_rng(0).uniform(0, 0.02, (40, 2))
    assert homogeneity.orientation_of_density(crowd).at_guard


# Exercise 2.


@pytest.mark.parametrize("truth", [Orientation(0), Orientation(30, 20), Orientation(75, 155)])
def test_a_circle_is_an_ellipse_whose_minor_axis_is_the_tilt(truth):
    ellipse = exercises.ellipse_of_circle(truth, 2.0)
    assert ellipse.aspect == pytest.approx(math.cos(math.radians(truth.slant)))
    assert ellipse.major == pytest.approx(2)
    back = exercises.orientation_of_ellipse(ellipse.major, min(ellipse.minor, ellipse.major), ellipse.minor_axis)
    assert back.error(truth) < 1e-4
    outline = exercises.outline(truth, 2.0)
    lengths = np.hypot(outline[:, 0], outline[:, 1])
    assert lengths.max() == pytest.approx(2, rel=3e-3)
    assert lengths.min() == pytest.approx(2 * ellipse.aspect, rel=3e-3)


# Exercise 3.


def test_counts_of_a_poisson_process_are_multinomial():
    rng = np.random.default_rng(6)
    p_values = [
        points.count_in_sets(points.poisson(400, Orientation(slant, 50), rng), 6).p_value
        for slant in (0, 60)
        for _ in range(300)
    ]
    assert binom.ppf(0.0005, 600, 0.05) <= sum(p < 0.05 for p in p_values) <= binom.ppf(0.9995, 600, 0.05)
    assert points.count_in_sets(points.poisson(400, FRONTAL, rng), 2, 3).counts.size == 6


def test_regular_and_clustered_patterns_are_told_apart():
    rng = np.random.default_rng(7)
    regular = points.count_in_sets(points.regular(400, rng), 6)
    assert regular.p_value > 0.95
    assert regular.verdict == "more even than a Poisson process"
    crowded = points.inside(rng.normal(0.5, 0.15, (400, 2)))
    clustered = points.count_in_sets(crowded, 6)
    assert clustered.p_value < 0.05
    assert clustered.verdict == "more uneven than a homogeneous Poisson process"


def test_areas_on_the_plane_tell_nothing_but_the_slant_under_orthography():
    areas = exercises.back_projected_areas(3, 2, Orientation(60, 45), "orthographic")
    np.testing.assert_allclose(areas, 2 / 6)
    assert exercises.slant_of_count(200, 100) == pytest.approx(60)
    assert exercises.slant_of_count(50, 100) is None
    assert exercises.slant_of_count(0, 100) is None
    rng = np.random.default_rng(8)
    # A density of 2000 per area of the plane, seen at 60 degrees, is 4000 points in the picture.
    counted = len(points.poisson(4000, Orientation(60, 10), rng))
    assert exercises.slant_of_count(counted, 2000) == pytest.approx(60, abs=2)


def test_perspective_areas_are_those_of_the_plane():
    # Frontally a picture of side 1 at distance 1 shows an area of 1.
    assert exercises.back_projected_areas(2, 2, FRONTAL, "perspective").sum() == pytest.approx(1)
    # (n · p)^-3 n_z², integrated over small cells.
    truth = Orientation(35, 200)
    areas = exercises.back_projected_areas(64, 64, truth, "perspective")
    x = (np.arange(64) + 0.5) / 64 - 0.5
    depth = truth.normal[0] * x[None, :] + truth.normal[1] * x[:, None] + truth.normal[2]
    np.testing.assert_allclose(areas * 64**2, truth.normal[2] ** 2 / depth**3, rtol=2e-3)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: points.poisson(0, FRONTAL, np.random.default_rng()), "points: must be"),
        (lambda: points.regular(10**7, np.random.default_rng()), "points: must be"),
        (
            lambda: points.count_in_sets(np.zeros((1, 2)), 65),
            "columns: must be a whole number from 1 to 64, got 65",
        ),
        (lambda: points.count_in_sets(np.zeros((1, 2)), 1), "at least two sets"),
        (lambda: homogeneity.count_ratio(np.zeros((1, 2)), 0, length=1.2), "length: must be"),
        (lambda: homogeneity.random_marks(5, FRONTAL, np.random.default_rng(), aspect=0.5), "aspect: must be"),
        (lambda: homogeneity.orientation_of_marks(np.eye(2)[None]), "at least 2 marks, got 1"),
        (lambda: homogeneity.orientation_of_density(np.zeros((2, 2))), "at least 3 points, got 2"),
        (lambda: exercises.ellipse_of_circle(FRONTAL, 0), "radius: must be above 0, got 0"),
        (lambda: exercises.orientation_of_ellipse(1, 2, 0), "minor: must be"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_sentence(make, message):
    with pytest.raises((ParamError, InputError), match=message):
        make()
