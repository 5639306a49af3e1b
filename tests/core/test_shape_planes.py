"""Shape from texture, planes: rendering and turning back, both estimators by isotropy, and their figures."""

from __future__ import annotations

import math

import numpy as np
import pytest

from texlab_core.errors import InputError, ParamError
from texlab_core.shape.exercises import ellipse_of_circle
from texlab_core.shape.isotropy import DOUBTFUL, isotropy_spectrum, landscape
from texlab_core.shape.orientation import Orientation, normal_errors
from texlab_core.shape.rendering import rectified, slanted_plane
from texlab_core.shape.textures import disc_texture, noise_texture

# Mean errors of the normals in degrees that the estimators must not exceed by more than a fifth.
SLANTS = (10, 30, 50, 70)
WANTED = {
    ("noise", "search"): (13, 6, 3, 3),
    ("noise", "moments"): (10, 3, 2, 2),
    ("discs", "search"): (14, 6, 3, 3),
    ("discs", "moments"): (10, 4, 3, 4),
}
TRIALS = 14


@pytest.fixture(scope="module")
def textures() -> dict[str, list[np.ndarray]]:
    rng = np.random.default_rng(20)
    return {
        "noise": [noise_texture(800, rng) for _ in range(2)],
        "discs": [disc_texture(800, rng) for _ in range(2)],
    }


@pytest.mark.parametrize("kind", ["noise", "discs"])
def test_both_estimators_reach_their_figures(textures, kind):
    rng = np.random.default_rng(21)
    errors = {(how, slant): [] for how in ("search", "moments") for slant in SLANTS}
    for slant in SLANTS:
        for trial in range(TRIALS):
            truth = Orientation(slant, float(rng.uniform(0, 180)))
            texture = np.roll(textures[kind][trial % 2], tuple(rng.integers(0, 800, 2)), axis=(0, 1))
            spectrum = isotropy_spectrum(slanted_plane(texture, truth, (256, 256)))
            errors["search", slant].append(spectrum.by_search().error(truth))
            errors["moments", slant].append(spectrum.by_moments().error(truth))
    for how in ("search", "moments"):
        means = [float(np.mean(errors[how, slant])) for slant in SLANTS]
        assert all(np.array(means) <= 1.2 * np.array(WANTED[kind, how])), (how, means)


def test_a_frontal_patch_reads_as_slanted_but_not_as_doubtful(textures):
    # The cosine is flat near 0: a patch of finite size always reads as somewhat slanted.
    read = [
        isotropy_spectrum(textures["noise"][0][:256, part : part + 256]).by_moments().slant for part in (0, 256)
    ]
    assert 3 < np.mean(read) < 20 < DOUBTFUL


def test_stripes_are_told_from_isotropic_textures():
    x = np.arange(128)
    stripes = np.broadcast_to(0.5 + 0.4 * np.sin(x / 2), (128, 128)).astype(np.float32)
    assert isotropy_spectrum(stripes).by_moments().slant > DOUBTFUL


def test_moments_are_exact_for_a_spectrum_that_is_a_squeezed_ring():
    # Eight waves of one plane frequency, evenly spread: their moments are isotropic, and so A⁻² after the view.
    truth = Orientation(55, 35)
    y, x = np.mgrid[:256, :256] - 128.0
    to_image = np.linalg.inv(truth.foreshortening())
    image = np.zeros((256, 256))
    for k in range(8):
        angle = math.pi * k / 8
        u, v = to_image @ (0.06 * np.array([math.cos(angle), math.sin(angle)]))
        image += np.cos(2 * np.pi * (u * x + v * y) + 2.0 * k * k)
    # The estimator takes out what a pixel averages away; this picture was sampled, not averaged.
    spectrum = np.fft.fft2(image)
    f = np.fft.fftfreq(256)
    averaged = np.fft.ifft2(spectrum * np.outer(np.sinc(f), np.sinc(f))).real.astype(np.float32)
    found = isotropy_spectrum(averaged)
    assert found.by_moments().error(truth) < 0.5
    assert found.by_search().error(truth) < 2


def test_the_cost_is_that_of_filters_one_by_one():
    """The closed form from three harmonics, against energies of cos⁶ filters at 180 orientations."""
    rng = np.random.default_rng(3)
    spectrum = isotropy_spectrum(noise_texture(64, rng))
    slant, tilt = 40.0, 25.0
    # Only one band, so that the sum over scales has one term.
    power = np.zeros_like(spectrum.polar)
    power[:, 20] = spectrum.polar[:, 20:30].sum(axis=1)
    single = type(spectrum)(spectrum.moments, power)
    angle = (np.arange(120) + 0.5) * np.pi / 120 - math.radians(tilt)
    along, across = math.cos(math.radians(slant)) * np.cos(angle), np.sin(angle)
    moved = np.arctan2(across, along) + math.radians(tilt)
    shift = np.log2(np.hypot(along, across))
    centre = 20.5 / 6 - 9
    spread, mean = 0.0, 0.0
    for octave in range(-9, 0):
        gain = np.cos(np.clip((centre + shift - octave) * np.pi / 2, -np.pi / 2, np.pi / 2)) ** 2
        energies = [
            float((power[:, 20] * gain * np.cos(moved - phi) ** 6).sum()) for phi in np.pi * np.arange(180) / 180
        ]
        spread += np.std(energies)
        mean += np.mean(energies)
    assert single.cost(np.array([slant]), np.array([tilt]))[0] == pytest.approx(spread / mean, rel=0.02)


def test_the_landscape_has_one_value_for_tilts_that_look_alike(textures):
    spectrum = isotropy_spectrum(textures["noise"][0][:128, :128])
    found = landscape(spectrum, 21)
    assert found.cost.shape == (21, 21)
    outside = np.hypot(found.axis[:, None], found.axis) > 80 + 1e-9
    np.testing.assert_array_equal(np.isnan(found.cost), outside)
    one, other = spectrum.cost(np.array([30.0, 30.0]), np.array([20.0, 200.0]))
    assert one == pytest.approx(other)
    assert Orientation.from_disc(*Orientation(30, 20).disc).error(Orientation(30, 200)) == pytest.approx(
        0, abs=1e-5
    )


def test_a_patch_that_is_slanted_and_turned_back_is_the_patch(textures):
    texture = noise_texture(256, np.random.default_rng(1), wavelength=32)
    for truth in (Orientation(0), Orientation(45, 20), Orientation(60, 90)):
        back = rectified(slanted_plane(texture, truth, (256, 256)), truth)
        middle = (slice(96, 160), slice(96, 160))
        assert np.abs(back - texture)[middle].max() < 0.03


def test_a_slanted_plane_is_averaged_over_its_pixels_and_does_not_alias():
    # A period of stripes along the tilt is as wide as one pixel of the picture: only its mean is left.
    x = np.arange(512)
    stripes = np.broadcast_to((x % 4 < 2).astype(np.float32), (512, 512))
    seen = slanted_plane(np.ascontiguousarray(stripes), Orientation(75.5, 0), (64, 64))
    assert seen == pytest.approx(0.5, abs=0.1)
    assert slanted_plane(stripes.copy(), Orientation(0), (64, 64)).std() == pytest.approx(0.5, abs=0.01)


def test_errors_of_normals_are_angles_and_forgive_the_turned_tilt():
    assert Orientation(30, 10).error(Orientation(30, 190)) == pytest.approx(0, abs=1e-5)
    assert Orientation(40, 0).error(Orientation(10, 0)) == pytest.approx(30)
    assert normal_errors(np.zeros(3), np.zeros(3), np.array([0, 20, 60]), np.zeros(3)) == pytest.approx(
        [0, 20, 60]
    )


def test_the_foreshortening_squeezes_along_the_tilt_alone():
    matrix = Orientation(60, 90).foreshortening()
    np.testing.assert_allclose(matrix, [[1, 0], [0, 0.5]], atol=1e-12)
    assert ellipse_of_circle(Orientation(60, 90)).minor_axis == pytest.approx(90)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Orientation(90), "slant: must be a number of degrees from 0 to below 90, got 90"),
        (lambda: Orientation(10, math.nan), "tilt: must be a number"),
        (
            lambda: slanted_plane(np.zeros((8, 8), np.float32), Orientation(85), (8, 8)),
            "slant: must be at most 80",
        ),
        (lambda: isotropy_spectrum(np.zeros((16, 64), np.float32)), "at least 32 x 32 pixels, got 64 x 16"),
        (lambda: isotropy_spectrum(np.ones((64, 64), np.float32)), "more than one gray level"),
        (lambda: noise_texture(4, np.random.default_rng()), "side: must be"),
        (lambda: noise_texture(64, np.random.default_rng(), wavelength=1), "wavelength: must be"),
        (lambda: disc_texture(64, np.random.default_rng(), radius=0), "radius: must be"),
        (lambda: disc_texture(64, np.random.default_rng(), softness=99), "softness: must be"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_sentence(make, message):
    with pytest.raises((ParamError, InputError), match=message):
        make()
