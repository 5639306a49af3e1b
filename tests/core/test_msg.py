"""MSG: closed forms, the full-plane oracle, and energies that come back exactly."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.fft

from tests.core.spectral_tools import (
    ANY,
    FLAT,
    analyzed,
    full_plane_features,
    sinusoid,
    synthesized,
    texture,
    white,
)
from texlab_core.api import synthesize
from texlab_core.engine.inputs import DataInput
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import InputError, ParamError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.spectral.analysis import channel_marginals, equivalent_bandwidths, residual_zones
from texlab_core.methods.spectral.code import MsgCode, Residual, quantize
from texlab_core.methods.spectral.codefile import code_input
from texlab_core.methods.spectral.method_msg import MsgParams
from texlab_core.methods.spectral.synthesis import Lobes, closed_form_overlap, design, synthesis_bandwidths
from texlab_core.transforms.gabor_bank import (
    CENTRES_U,
    CENTRES_V,
    CHANNELS,
    WHITE_BANDWIDTHS,
    WIDTHS,
    residual_reach,
)
from texlab_core.work.tasks import finish

SIZES = [(256, 256), (128, 128), (480, 640), (129, 200), (77, 301)]


def code_of(energies: Any, bandwidths: Any = None, residual: Residual | None = None) -> MsgCode:
    bands = tuple(WHITE_BANDWIDTHS if bandwidths is None else bandwidths)
    return MsgCode(tuple(energies), bands, bands, "participation", residual or Residual(128, 0, 0, 0, 0), FLAT)


@pytest.mark.parametrize("size", [(256, 256), (240, 320)])
@pytest.mark.parametrize("measure", ["participation", "paper"])
def test_white_noise_has_the_closed_form_energies_and_bandwidths(size: tuple[int, int], measure: str) -> None:
    code = analyzed(white(size, 20.0), measure)
    # A variance s^2 passes a filter of width a with s^2 a^2; the marginals are Gaussians of width a / sqrt 2.
    np.testing.assert_allclose(code.energies, 20.0**2 * WIDTHS**2, rtol=2e-5)
    for found, centres, count in (
        (code.bandwidths_u, CENTRES_U, size[1]),
        (code.bandwidths_v, CENTRES_V, size[0]),
    ):
        # The maximum of a Gaussian may lie between two samples of the spectrum.
        off = centres * count - np.round(centres * count)
        peak = np.exp(-2 * np.pi * (off / count / WIDTHS) ** 2) if measure == "paper" else 1.0
        np.testing.assert_allclose(found, WIDTHS / np.sqrt(2) / peak, rtol=1e-4)
    zones = code.residual
    np.testing.assert_allclose([zones.u_axis, zones.v_axis, zones.falling, zones.rising], 20.0, rtol=1e-4)
    assert zones.mean == pytest.approx(128, abs=1e-4)


def test_random_white_noise_has_them_on_average_and_the_paper_is_biased_low() -> None:
    rng = np.random.Generator(np.random.PCG64(3))
    codes = [analyzed(rng.normal(128, 20, (256, 256)), "paper") for _ in range(12)]
    energies = np.mean([code.energies for code in codes], axis=0)
    np.testing.assert_allclose(energies, 400 * WIDTHS**2, rtol=0.2)
    ratio = np.mean([code.bandwidths_u for code in codes], axis=0) / WIDTHS
    assert (ratio > 0.45).all()
    assert (ratio < 0.68).all()


@pytest.mark.parametrize("measure", ["participation", "paper"])
@pytest.mark.parametrize("channel", range(0, CHANNELS, 2))
def test_a_sinusoid_at_a_centre_is_all_in_its_channel(channel: int, measure: str) -> None:
    # Only channels on the axes have centres on the grid of a power of two.
    code = analyzed(sinusoid((256, 256), CENTRES_U[channel], CENTRES_V[channel]), measure)
    assert code.energies[channel] == pytest.approx(40.0**2 / 2, rel=1e-6)
    expected = 1 / 256 if measure == "paper" else 1 / (np.sqrt(2) * 256)
    assert code.bandwidths_u[channel] == pytest.approx(expected, rel=1e-5)
    assert code.bandwidths_v[channel] == pytest.approx(expected, rel=1e-5)
    assert np.argmax(code.energies) == channel


def test_a_sinusoid_between_centres_falls_off_as_the_filters_do() -> None:
    u, v = 25 / 256, 6 / 256
    code = analyzed(sinusoid((256, 256), u, v))
    expected = np.zeros(CHANNELS)
    for sign in (1, -1):
        distance = (sign * u - CENTRES_U) ** 2 + (sign * v - CENTRES_V) ** 2
        expected += 40.0**2 / 2 * np.exp(-2 * np.pi * distance / WIDTHS**2)
    np.testing.assert_allclose(code.energies, expected, rtol=1e-4, atol=1e-6)


def test_a_constant_image_has_no_energy_and_comes_back_constant() -> None:
    exemplar = as_exemplar(np.full((64, 80), 0.3, np.float32))
    result = run(Job(method="msg", inputs={"exemplar": exemplar}, size=(50, 70)))
    assert not np.any(result.model.code.energies)
    np.testing.assert_allclose(result.model.code.bandwidths_u, WHITE_BANDWIDTHS, rtol=1e-6)
    np.testing.assert_allclose(result.image, 0.3, atol=1e-6)


@pytest.mark.parametrize("measure", ["participation", "paper"])
@pytest.mark.parametrize("size", SIZES)
def test_half_plane_float32_equals_full_plane_float64(size: tuple[int, int], measure: str) -> None:
    plane = texture(size)
    code = analyzed(plane, measure)
    energies, bands_u, bands_v = full_plane_features(plane, measure)
    np.testing.assert_allclose(code.energies, energies, rtol=1e-6)
    np.testing.assert_allclose(code.bandwidths_u, bands_u, rtol=1e-6)
    np.testing.assert_allclose(code.bandwidths_v, bands_v, rtol=1e-6)


def test_marginals_over_blocks_equal_those_at_once() -> None:
    plane = texture((700, 900)) - 128
    half = scipy.fft.rfft2(plane)
    found = finish(channel_marginals(half, 900, ANY, "a"))
    np.testing.assert_allclose(found.u.sum(axis=1), found.v.sum(axis=1), rtol=1e-6)
    energies, _, _ = full_plane_features(plane, "paper")
    np.testing.assert_allclose(found.energies(), energies, rtol=1e-6)


@pytest.mark.parametrize(("count", "reach"), [(256, 3), (512, 7), (128, 1), (64, 0), (20, 0), (640, 9), (1, 0)])
def test_the_residual_is_7_by_7_at_256_and_15_by_15_at_512(count: int, reach: int) -> None:
    assert residual_reach(count) == reach
    assert all(k < count / 64 for k in range(reach + 1))
    assert reach + 1 >= count / 64


def test_residual_zones_are_mean_moduli() -> None:
    plane = texture((200, 300))
    transform = np.fft.fft2(plane.astype(np.float64) - 128) / np.sqrt(plane.size)
    zones = residual_zones(scipy.fft.rfft2(plane - np.float32(128)), 300, 128.0)
    falling = [abs(transform[v, u]) for v in (1, 2, 3) for u in (1, 2, 3, 4)]
    rising = [abs(transform[-v, u]) for v in (1, 2, 3) for u in (1, 2, 3, 4)]
    assert zones.u_axis == pytest.approx(np.mean([abs(transform[0, u]) for u in (1, 2, 3, 4)]), rel=1e-5)
    assert zones.v_axis == pytest.approx(np.mean([abs(transform[v, 0]) for v in (1, 2, 3)]), rel=1e-5)
    assert zones.falling == pytest.approx(np.mean(falling), rel=1e-5)
    assert zones.rising == pytest.approx(np.mean(rising), rel=1e-5)


def test_participation_equals_the_paper_for_a_gaussian() -> None:
    axis = np.fft.fftfreq(512)
    marginals = np.exp(-np.pi * (axis / np.linspace(0.02, 0.1, CHANNELS)[:, None]) ** 2)
    paper = equivalent_bandwidths(marginals, "paper")
    np.testing.assert_allclose(paper, np.linspace(0.02, 0.1, CHANNELS), rtol=1e-9)
    np.testing.assert_allclose(equivalent_bandwidths(marginals, "participation"), paper, rtol=1e-9)


def test_filtering_a_channel_of_bandwidth_b_measures_a() -> None:
    measured = WIDTHS * np.linspace(0.05, 0.65, CHANNELS)
    made, imaginary = synthesis_bandwidths(measured)
    inside = made < 2 * WIDTHS
    assert not imaginary.any()
    # |G|^2 |S|^2 is a Gaussian whose equivalent width is A: 1/b^2 + 1/a^2 = 1 / (2 A^2).
    np.testing.assert_allclose((1 / made**2 + 1 / WIDTHS**2)[inside], (1 / (2 * measured**2))[inside])
    np.testing.assert_allclose(synthesis_bandwidths(WHITE_BANDWIDTHS)[0], 2 * WIDTHS)
    np.testing.assert_allclose(synthesis_bandwidths(WIDTHS)[0], 2 * WIDTHS)


def test_the_closed_form_overlap_equals_the_sums_at_2048() -> None:
    rng = np.random.Generator(np.random.PCG64(5))
    size = (2048, 2048)
    wide_u, wide_v = WIDTHS * rng.uniform(0.3, 1, (2, CHANNELS))
    lobes = Lobes(wide_u, wide_v, size)
    # The sums leave out the low-pass residual, which the continuum does not know.
    height, width = size
    v, u = np.fft.fftfreq(height), np.fft.fftfreq(width)
    total = np.zeros((CHANNELS, CHANNELS))
    for sign in (1, -1):
        for axis, centres, bands, factor in ((u, CENTRES_U, wide_u, "u"), (v, CENTRES_V, wide_v, "v")):
            gain = np.exp(-2 * np.pi * ((axis - centres[:, None] + 0.5) % 1 - 0.5) ** 2 / WIDTHS[:, None] ** 2)
            lobe = np.exp(
                -2 * np.pi * ((axis - sign * centres[:, None] + 0.5) % 1 - 0.5) ** 2 / bands[:, None] ** 2
            )
            if factor == "u":
                product = gain @ lobe.T
            else:
                total += product * (gain @ lobe.T)
    sums = 2 * total / (height * width) ** 2 / lobes.energies()
    np.testing.assert_allclose(closed_form_overlap(wide_u, wide_v), sums, rtol=0, atol=1e-6)


@pytest.mark.parametrize("measure", ["participation", "paper"])
@pytest.mark.parametrize("size", SIZES)
def test_energies_come_back_at_any_size_before_the_histogram_step(size: tuple[int, int], measure: str) -> None:
    code = analyzed(texture((256, 256)), measure)
    plan, plane = synthesized(code, size)
    found = np.array(analyzed(plane, measure).energies)
    wanted = np.array(code.energies)
    assert not plan.clipped
    assert np.abs(found - wanted).sum() / wanted.sum() < 2e-6
    np.testing.assert_allclose(found, plan.achieved, rtol=1e-5)


@pytest.mark.parametrize("name", ["stochastic-gravel", "letters-darwin", "quasiperiodic-canvas", "oriented-zebra"])
def test_energies_of_gallery_textures_come_back(name: str) -> None:
    exemplar = as_exemplar(f"gallery:{name}")
    code = run(Job(method="msg", inputs={"exemplar": exemplar})).model.code
    for size in ((256, 256), (480, 640), (128, 128)):
        plan, plane = synthesized(code, size)
        found, wanted = np.array(analyzed(plane).energies), np.array(code.energies)
        error = np.abs(found - wanted).sum() / wanted.sum()
        # Where the exact solution is negative, what the nearest one misses is reported.
        assert error == pytest.approx(plan.error, abs=5e-6)
        assert plan.clipped or error < 5e-6
        assert plan.error < 0.08


def test_a_design_with_negative_energies_is_the_nearest_non_negative_one() -> None:
    energies = np.full(CHANNELS, 1.0)
    energies[5] = 1000.0
    plan = design(code_of(energies), (256, 256))
    assert plan.clipped
    assert plan.error > 0
    assert (plan.energies >= 0).all()
    _, plane = synthesized(code_of(energies), (256, 256))
    np.testing.assert_allclose(analyzed(plane).energies, plan.achieved, rtol=1e-4)


def test_sixteen_noises_have_the_energies_on_average() -> None:
    code = analyzed(texture((256, 256)))
    found = [analyzed(synthesized(code, (256, 256), seed=seed, phase="sixteen")[1]).energies for seed in range(8)]
    np.testing.assert_allclose(np.mean(found, axis=0), code.energies, rtol=0.25)


def test_the_low_pass_residual_has_the_coded_moduli_and_the_phase_of_the_sum() -> None:
    code = analyzed(texture((256, 256)))
    bare = replace(code, residual=Residual(100.0, 5.0, 6.0, 7.0, 8.0))
    _, plane = synthesized(bare, (320, 320))
    transform = np.fft.fft2(plane.astype(np.float64)) / 320
    assert plane.mean() == pytest.approx(100, abs=1e-3)
    assert abs(transform[0, 3]) == pytest.approx(5, rel=1e-3)
    assert abs(transform[4, 0]) == pytest.approx(6, rel=1e-3)
    assert abs(transform[2, 1]) == pytest.approx(7, rel=1e-3)
    assert abs(transform[-2, 1]) == pytest.approx(8, rel=1e-3)
    _, other = synthesized(code, (320, 320))
    np.testing.assert_allclose(
        np.angle(transform[2, 1]), np.angle(np.fft.fft2(other.astype(np.float64))[2, 1]), atol=1e-3
    )


def test_the_result_tiles() -> None:
    image = synthesize("gallery:stochastic-gravel", "msg", size=(96, 160), seed=4).image[:, :, 0]
    inner = np.abs(np.diff(image, axis=1)).mean()
    assert np.abs(image[:, 0] - image[:, -1]).mean() < 1.25 * inner


def test_the_printed_equations_are_imaginary_nearly_always_and_miss_the_energies() -> None:
    code = analyzed(texture((256, 256)), "paper")
    plan = design(code, (256, 256), "printed")
    assert plan.imaginary > 24
    assert plan.error > 0.1


def test_quantized_bandwidths_take_few_values() -> None:
    code = analyzed(texture((256, 256)))
    for levels in (2, 5, 16):
        ratios = {round(float(r), 9) for r in np.array(code.quantized(levels).bandwidths_u) / WIDTHS}
        assert 1 <= len(ratios) <= levels
    ratios = np.geomspace(1 / 64, 1 / np.sqrt(2), 16)
    np.testing.assert_allclose(quantize(WIDTHS * ratios, 16), WIDTHS * ratios)
    with pytest.raises(ParamError, match="bandwidth_levels"):
        MsgParams(bandwidth_levels=1)


def test_the_number_of_parameters_is_counted() -> None:
    def count(name: str, **params: Any) -> float:
        return synthesize(f"gallery:{name}", "msg", size=(32, 32), **params).measures["parameters"]

    assert count("stochastic-gravel") == 69
    assert count("stochastic-gravel", histogram="full") == 69 - 16 + 256
    assert count("stochastic-bark") == 69 + 32 + 12


def test_a_code_alone_makes_the_same_bits_as_its_exemplar() -> None:
    for name in ("stochastic-gravel", "stochastic-bark"):
        one = synthesize(f"gallery:{name}", "msg", size=(70, 90), seed=2)
        job = Job(method="msg", inputs={"code": code_input(one.model.code)}, size=(70, 90), seed=2)
        np.testing.assert_array_equal(run(job).image, one.image)


def test_a_code_wins_over_the_exemplar_and_the_full_histogram_needs_one() -> None:
    exemplar = as_exemplar("gallery:stochastic-gravel")
    code = code_input(analyzed(sinusoid((256, 256), 1 / 16, 0)))
    both = run(Job(method="msg", inputs={"exemplar": exemplar, "code": code}, size=(64, 64)))
    alone = run(Job(method="msg", inputs={"code": code}, size=(64, 64)))
    np.testing.assert_array_equal(both.image, alone.image)
    with pytest.raises(InputError, match="no exemplar"):
        Job(method="msg", inputs={"code": code}, params=MsgParams(histogram="full"))
    with pytest.raises(InputError, match="neither"):
        Job(method="msg", inputs={})
    with pytest.raises(InputError, match="it is no MSG code"):
        Job(method="msg", inputs={"code": DataInput({"format": "no"}, "x.msg.json")})


def test_the_full_histogram_is_reached() -> None:
    exemplar = as_exemplar("gallery:structured-coins")
    image = run(Job(method="msg", inputs={"exemplar": exemplar}, params=MsgParams(histogram="full"), seed=3)).image
    difference = np.sort(image, axis=None) - np.sort(exemplar.pixels, axis=None)
    assert np.abs(difference).mean() * 255 < 0.5


@pytest.mark.parametrize("method", ["uncoded", "car", "ac-h"])
def test_one_seed_gives_all_spectral_methods_the_same_phase(method: str) -> None:
    """Before the histogram step the phases are equal; the correlation of the pictures shows it after it, too."""
    size = (128, 128)
    one, other = (
        synthesize("gallery:stochastic-grass", name, size=size, seed=9).image[:, :, 0] for name in ("msg", method)
    )
    stranger = synthesize("gallery:stochastic-grass", method, size=size, seed=10).image[:, :, 0]
    assert np.corrcoef(one.ravel(), other.ravel())[0, 1] > 0.6
    assert abs(np.corrcoef(one.ravel(), stranger.ravel())[0, 1]) < 0.15


def test_colours_stay_within_the_palette_and_follow_brightness() -> None:
    exemplar = as_exemplar("gallery:structured-leaves")
    image = run(Job(method="msg", inputs={"exemplar": exemplar}, seed=1)).image
    np.testing.assert_allclose(image.mean(axis=(0, 1)), exemplar.pixels.mean(axis=(0, 1)), atol=0.03)
    gray, other = exemplar.pixels.mean(axis=2), image.mean(axis=2)
    assert np.abs(np.quantile(gray, [0.1, 0.5, 0.9]) - np.quantile(other, [0.1, 0.5, 0.9])).max() < 0.04


def test_a_colour_texture_can_be_kept_to_the_numbers_of_a_gray_one() -> None:
    from texlab_core.transforms.luma import luma

    colour = as_exemplar(np.random.default_rng(5).random((64, 64, 3), np.float32))
    gray = as_exemplar(luma(colour.pixels)[..., None])
    made = {
        choice: run(Job(method="msg", inputs={"exemplar": colour}, params=MsgParams(colours=choice), seed=2))
        for choice in ("keep", "gray")
    }
    plain = run(Job(method="msg", inputs={"exemplar": gray}, seed=2))
    assert [made[choice].measures["parameters"] for choice in ("keep", "gray")] == [113, 69]
    assert made["gray"].image.shape == (64, 64, 3)
    assert np.array_equal(made["gray"].image[..., :1], plain.image)
    assert "mean colour 3, axes of the colours 9, two curves of 16" in made["keep"].notes[-1]
    assert not any("colours" in note for note in made["gray"].notes)
