"""The laboratory's filters: the bank at scales, Gabor pairs, local frequency, frequency support, pyramid steps."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from texlab_core.errors import InputError, ParamError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.stats import bands, frequency_support
from texlab_core.stats.local_frequency import local_frequency
from texlab_core.transforms import gaussian, laplacian, pyramid_steps, spots_bars, steerable
from texlab_core.transforms.gabor_pair import GaborPair
from texlab_core.transforms.luma import luma

NOISE = np.random.default_rng(0).random((48, 61)).astype(np.float32)


def wave(wavelength: float, degrees: float, size: tuple[int, int] = (96, 112), phase: float = 0.0) -> np.ndarray:
    y, x = np.mgrid[: size[0], : size[1]]
    angle = np.radians(degrees)
    turned = 2 * np.pi / wavelength * (x * np.cos(angle) + y * np.sin(angle)) + phase
    return (0.5 + 0.4 * np.cos(turned)).astype(np.float32)


# The filter bank.


@pytest.mark.parametrize("scale", [1, 2, 4, 7.5])
def test_kernels_have_no_sum_and_equal_weight_at_every_scale(scale):
    bank = spots_bars.scaled_kernels(scale)
    assert bank.shape[0] == 8
    np.testing.assert_allclose(bank.sum(axis=(1, 2)), 0, atol=1e-12)
    np.testing.assert_allclose(np.abs(bank).sum(axis=(1, 2)), 2)


def test_scale_1_is_the_text_s_bank_up_to_its_weight():
    for ours, printed in zip(spots_bars.scaled_kernels(1.0), spots_bars.kernels(), strict=True):
        np.testing.assert_allclose(ours, 2 * printed / np.abs(printed).sum(), atol=2e-4)


@pytest.mark.parametrize("scale", [1.0, 2.0, 9.0])
def test_responses_are_convolutions_with_mirrored_borders(scale):
    found = spots_bars.scaled_responses(NOISE, scale)
    for kernel, response in zip(spots_bars.scaled_kernels(scale), found, strict=True):
        expected = cv2.filter2D(NOISE, cv2.CV_32F, kernel[::-1, ::-1], borderType=cv2.BORDER_REFLECT_101)
        np.testing.assert_allclose(response, expected, atol=3e-6)
    assert np.abs(found).max() <= 1


def test_a_coarser_bar_is_found_at_a_coarser_scale():
    stripes = wave(20, 30)
    strongest = [spots_bars.scaled_responses(stripes, scale)[:, 40:50, 40:50].std(axis=(1, 2)) for scale in (1, 4)]
    assert [int(each.argmax()) for each in strongest] == [3, 3]
    assert strongest[1].max() > 3 * strongest[0].max()
    assert spots_bars.filter_name(3) == "bar, waves along 30°"
    assert spots_bars.filter_name(0) == "spot of 3 Gaussians"
    magnitude, white = spots_bars.strength(spots_bars.scaled_responses(stripes, 4))
    assert magnitude.min() >= 0
    assert np.mean(magnitude > white) == pytest.approx(0.005, abs=0.001)


def test_a_footprint_is_the_gain_of_its_kernel():
    kernel = spots_bars.scaled_kernels(1.0)[4]
    gain = spots_bars.footprint(kernel, (64, 64))
    for column, row in ((8, 0), (5, 9), (0, 20)):
        y, x = np.mgrid[:64, :64]
        plane = np.cos(2 * np.pi * (column * x + row * y) / 64).astype(np.float32)
        filtered = cv2.filter2D(np.tile(plane, (3, 3)), cv2.CV_32F, kernel)[64:128, 64:128]
        assert filtered.std() / plane.std() == pytest.approx(gain[32 + row, 32 + column], abs=1e-5)


# Gabor pairs.


@pytest.mark.parametrize("wavelength", [4, 9, 24])
@pytest.mark.parametrize("orientation", [0, 37, 90])
def test_a_matching_wave_answers_with_its_amplitude(wavelength, orientation):
    plane = wave(wavelength, orientation, (128, 128), phase=0.7)
    response = GaborPair(wavelength, orientation).respond(plane)
    middle = (slice(48, 80), slice(48, 80))
    assert response.magnitude[middle] == pytest.approx(0.4, abs=2e-3)
    # Phase 0 is on the middle of a bright stripe.
    y, x = np.mgrid[48:80, 48:80]
    angle = np.radians(orientation)
    turned = 2 * np.pi / wavelength * (x * np.cos(angle) + y * np.sin(angle)) + 0.7
    assert np.abs(np.angle(np.exp(1j * (response.phase[middle] - turned)))).max() < 0.02


def test_kernels_have_no_mean_and_their_phase_turns_one_into_the_other():
    for phase in (0, 40, 90):
        kernel = GaborPair(12, 20, 5, phase).kernel()
        assert abs(kernel.sum()) < 1e-6
    even, odd = GaborPair(12, 20, 5).kernel(), GaborPair(12, 20, 5, 90).kernel()
    np.testing.assert_allclose(odd.imag, even.real, atol=0.02 * np.abs(even).max())
    np.testing.assert_allclose(odd.real, -even.imag, atol=0.02 * np.abs(even).max())
    assert GaborPair(10).width == 5
    np.testing.assert_allclose(GaborPair(10).kernel().imag, -GaborPair(10).kernel().imag[:, ::-1], atol=1e-6)


def test_responses_are_convolutions_with_the_kernels():
    pair = GaborPair(7, 25, 3)
    response = pair.respond(NOISE)
    for part, kernel in ((response.even, pair.kernel().real), (response.odd, pair.kernel().imag)):
        expected = cv2.filter2D(NOISE, cv2.CV_32F, kernel[::-1, ::-1], borderType=cv2.BORDER_REFLECT_101)
        np.testing.assert_allclose(part, expected, atol=1e-5)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"wavelength": 1}, "wavelength: must be"),
        ({"sigma": 0.1}, "sigma: must be"),
        ({"phase": float("nan")}, "phase: must be"),
        ({"orientation": float("inf")}, "orientation: must be"),
    ],
)
def test_pairs_that_cannot_be_used_are_refused(values, message):
    with pytest.raises(ParamError, match=message):
        GaborPair(**values)
    with pytest.raises(ParamError, match=r"scale: must be a number from 1 to 16, got 0\.5"):
        spots_bars.scaled_kernels(0.5)


# Local frequency.


def test_a_chirp_is_read_within_a_few_percent():
    x = np.arange(384)
    wavelength = 6 * 5 ** (x / 383)
    chirp = 0.5 + 0.4 * np.cos(np.cumsum(2 * np.pi / wavelength))
    found = local_frequency(np.ascontiguousarray(np.broadcast_to(chirp, (48, 384))).astype(np.float32))
    inside = slice(20, -20)
    error = np.abs(found.wavelength / wavelength - 1)[:, inside].mean()
    assert error <= 1.2 * 0.03
    assert found.coherence[:, inside].mean() > 0.9
    turned = (found.orientation[:, inside] + 90) % 180 - 90
    assert np.abs(turned).max() < 3


def test_a_gradient_of_size_is_read_quarter_by_quarter():
    found = local_frequency(luma(as_exemplar("gallery:failure-sizegradient").pixels))
    medians = [float(np.median(found.wavelength[:, 64 * k : 64 * (k + 1)])) for k in range(4)]
    assert medians == pytest.approx([8.5, 14.5, 20, 26], rel=0.05)


def test_noise_has_no_orientation_and_small_planes_are_refused():
    noise = np.random.default_rng(1).random((64, 64)).astype(np.float32)
    assert np.median(local_frequency(noise).coherence) < 0.7
    assert np.median(local_frequency(wave(10, 50, (64, 64))).coherence) > 0.9
    with pytest.raises(InputError, match="at least 16 x 16 pixels, got 61 x 8"):
        local_frequency(NOISE[:8])


# Frequency support.


@pytest.mark.parametrize("size", [(64, 64), (48, 61)])
@pytest.mark.parametrize("orientations", [1, 4, 6])
def test_the_wedges_of_a_steerable_pyramid_add_up_to_the_image(size, orientations):
    found = frequency_support.supports("steerable", size, 2, orientations)
    total = sum(each.gain.astype(np.float64) ** 2 for each in found)
    np.testing.assert_allclose(total, 1, atol=1e-6)
    assert len(found) == 2 * orientations + 2


@pytest.mark.parametrize("place", [(3, 0), (0, 7), (5, 9), (-6, 4)])
@pytest.mark.parametrize("kind", ["steerable", "laplacian", "gaussian", "filter bank", "oriented", "gabor"])
def test_supports_are_the_gains_of_waves(kind, place):
    """A wave of the image, against how much of itself it finds in each band."""
    size = 96
    y, x = np.mgrid[:size, :size]
    down, across = place
    turned = 2 * np.pi * (down * y + across * x) / size
    planes = periodic_bands(kind, np.cos(turned).astype(np.float32))
    for support, band in zip(frequency_support.supports(kind, (size, size), 2, 4), planes, strict=True):
        fine = slice(None, None, size // band.shape[0])
        found = np.abs((band * np.exp(-1j * turned)[fine, fine]).mean()) * 2
        gain = float(support.gain[size // 2 + down, size // 2 + across])
        assert found == pytest.approx(gain, abs=2e-3), (support.title, place)


def periodic_bands(kind: str, plane: np.ndarray) -> list[np.ndarray]:
    """Return the bands of a plane that goes on periodically: the middle ones of nine copies."""
    if kind == "steerable":
        return [band for _, band in steerable.build(plane, 2, 4).items()]
    if kind == "laplacian":
        return laplacian.build(plane, 2, "periodic")
    if kind == "gaussian":
        return gaussian.build(plane, 2, "periodic")
    planes = [each.plane for each in bands.split(np.tile(plane, (3, 3)), kind, 2, 4)]
    thirds = [slice(each.shape[0] // 3, 2 * each.shape[0] // 3) for each in planes]
    return [each[third, third] for each, third in zip(planes, thirds, strict=True)]


def test_outlines_are_where_a_band_keeps_half_of_its_best():
    support = frequency_support.supports("laplacian", (64, 64), 3)[1]
    assert support.relative.max() == 1
    outline = support.outline()
    # An annulus: neither the middle nor the corners.
    assert not outline[32, 32]
    assert not outline[0, 0]
    assert 0.05 < outline.mean() < 0.6


# Step by step.


@pytest.mark.parametrize("mode", ["interpolate", "replicate"])
@pytest.mark.parametrize("border", ["reflect", "periodic"])
def test_the_steps_are_those_of_the_pyramid_and_lead_back(mode, border):
    steps = pyramid_steps.analysis_steps(NOISE, 3, mode, border)
    for step, band in zip(steps, laplacian.build(NOISE, 3, border, mode), strict=False):
        np.testing.assert_array_equal(step.band, band)
        np.testing.assert_allclose(step.smooth[::2, ::2], step.reduced, atol=1e-6)
        np.testing.assert_allclose(step.image, step.expanded + step.band, atol=1e-6)
    back = pyramid_steps.synthesis_steps(steps, mode, border)
    np.testing.assert_allclose(back[-1].image, NOISE, atol=1e-6)
    assert [each.image.shape for each in back] == [step.image.shape for step in reversed(steps)]


def test_levels_that_a_plane_does_not_have_are_refused():
    with pytest.raises(ParamError, match="levels: must be a whole number from 1 to 6 for 61 x 48, got 7"):
        pyramid_steps.analysis_steps(NOISE, 7)
