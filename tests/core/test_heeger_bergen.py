"""Heeger-Bergen: what must hold of every result."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.engine.streams import Streams
from texlab_core.images.exemplar import as_exemplar
from texlab_core.measures.registry import find_measure
from texlab_core.measures.subject import Subject
from texlab_core.methods.heeger_bergen import analysis
from texlab_core.methods.heeger_bergen.method import HeegerBergenParams
from texlab_core.transforms import fourier
from texlab_core.work.tasks import crew, finish


def texture(shape=(48, 64), channels=1, seed=0):
    """Smoothed noise with some orientation, in 8-bit steps."""
    rng = np.random.default_rng(seed)
    noise = rng.random((*shape, channels))
    smooth = noise + np.roll(noise, 1, 0) + np.roll(noise, 1, 1) + np.roll(noise, (2, 1), (0, 1))
    mixed = smooth @ (rng.random((channels, channels)) + np.eye(channels))
    return np.round(255 * (mixed - mixed.min()) / np.ptp(mixed)).astype(np.uint8)


def job(image, size=None, seed=0, **params):
    return Job(
        method="heeger-bergen",
        inputs={"exemplar": as_exemplar(image)},
        params=HeegerBergenParams(**params),
        size=size,
        seed=seed,
    )


def make(image, size=None, seed=0, *, threads=None, on_step=None, **params):
    return run(job(image, size, seed, **params), on_step, threads=threads)


def w1_of_pixels(result):
    return find_measure("w1-pixels").of(Subject.of_result(result))


@pytest.mark.parametrize("params", [{}, {"pyramid": "laplacian"}, {"pyramid": "textbook"}, {"iterations": 0}])
@pytest.mark.parametrize("shape", [(48, 64), (37, 41), (5, 7)])
def test_a_gray_result_has_the_very_values_of_the_exemplar(params, shape):
    image = texture(shape)
    result = make(image, **params)
    expected = np.sort(as_exemplar(image).pixels, axis=None)
    np.testing.assert_array_equal(np.sort(result.image, axis=None), expected)
    assert w1_of_pixels(result) == 0
    assert np.any(result.image != as_exemplar(image).pixels)


@pytest.mark.parametrize("palette", ["off", "transport"])
def test_a_colour_result_has_the_channels_values(palette):
    image = texture((40, 48), 3)
    result = make(image, palette=palette)
    pixels = as_exemplar(image).pixels
    for channel in range(3):
        np.testing.assert_array_equal(
            np.sort(result.image[..., channel], axis=None), np.sort(pixels[..., channel], axis=None)
        )


@pytest.mark.parametrize("pyramid", ["steerable", "laplacian"])
def test_the_bands_come_closer_round_by_round(pyramid):
    curve = make(texture((64, 64)), pyramid=pyramid).curves["mean-distance"].y
    assert curve.size == 6
    assert np.all(np.diff(curve) < 0)
    assert curve[-1] < 0.4 * curve[0]


def test_equal_channels_give_equal_channels():
    gray = texture((32, 32))
    result = make(np.repeat(gray, 3, axis=2))
    assert np.all(result.image == result.image[..., :1])


def test_matching_the_channels_is_a_choice():
    """Without it the result is what the colour axes make of their planes: the axes' values are the exemplar's."""
    image = texture((40, 48), 3)
    matched, left = make(image), make(image, rgb_matching=False)
    assert (matched.image != left.image).any()
    pixels = as_exemplar(image).pixels
    inside = ((left.image > 0) & (left.image < 1)).all(-1)
    assert inside.mean() > 0.9
    planes = finish(left.model.axes.to_axes_task(left.image))
    for plane, target in zip(planes, left.model.planes, strict=True):
        # Every pixel that was not clipped has a value of the exemplar on every axis.
        values = np.sort(target.pixels.sample)
        near = np.abs(values[np.searchsorted(values, plane[inside]).clip(1, values.size - 1)] - plane[inside])
        below = np.abs(values[np.searchsorted(values, plane[inside]).clip(1, values.size - 1) - 1] - plane[inside])
        assert np.minimum(near, below).max() < 1e-4
    assert not np.array_equal(np.sort(left.image[..., 0], axis=None), np.sort(pixels[..., 0], axis=None))
    gray = texture((40, 48))
    np.testing.assert_array_equal(make(gray).image, make(gray, rgb_matching=False).image)


def test_colours_on_a_line_stay_on_the_line():
    gray = texture((40, 40)).astype(np.float32) / 255
    direction = np.float32([0.8, 0.5, 0.2])
    image = as_exemplar(gray * direction)
    result = make(image)
    assert len(result.model.planes) == 1
    along = result.image[..., :1] / direction[0]
    np.testing.assert_allclose(result.image, along * direction, atol=0.01)


@pytest.mark.parametrize("value", [77, (10, 200, 30)])
def test_a_constant_image_stays_what_it_is(value):
    image = np.full((9, 12, 3), value, np.uint8)
    result = make(image, (20, 15))
    np.testing.assert_array_equal(
        result.image, np.broadcast_to(as_exemplar(image).pixels[0, 0], result.image.shape)
    )
    assert result.notes == ("The exemplar is constant, and so is the result.",)


def test_the_analysis_is_used_again_when_only_the_synthesis_changes():
    exemplar, cache = as_exemplar(texture((32, 32), 3)), AnalysisCache()
    models = [
        run(Job(method="heeger-bergen", inputs={"exemplar": exemplar}, params=params), cache=cache).model
        for params in (
            HeegerBergenParams(),
            HeegerBergenParams(iterations=1, matching="bins", palette="transport"),
            HeegerBergenParams(scales=2),
        )
    ]
    assert models[0] is models[1]
    assert models[0] is not models[2]


def test_as_many_scales_as_fit_are_used_and_said():
    result = make(texture((64, 64)), (20, 17), scales=5)
    assert result.image.shape == (20, 17, 1)
    assert result.notes == ("3 of 5 scales fit an exemplar of 64 x 64 and a result of 17 x 20 pixels.",)
    assert make(texture((64, 64)), (64, 64), scales=5).notes == ()


class Literal:
    """The paper's listings on the full grid, in float64: no crops, no half spectra, filters as defined."""

    def __init__(self, side, levels, orientations):
        row, column = np.meshgrid(np.fft.fftfreq(side), np.fft.fftfreq(side), indexing="ij")
        radius, theta = 2 * np.pi * np.hypot(row, column), np.arctan2(row, column)

        def low(cut):
            phase = np.pi / 2 * np.log2(np.maximum(2 * radius / cut, 1))
            return np.where(radius <= cut / 2, 1, np.where(radius < cut, np.cos(phase), 0))

        def high(cut):
            return np.sqrt(1 - low(cut) ** 2)

        power = orientations - 1
        factorial = np.cumprod([1, *range(1, 2 * power + 1)])
        alpha = 2**power * factorial[power] / np.sqrt(orientations * factorial[2 * power])
        self.filters = [(1, high(np.pi))]
        passed = low(np.pi)
        for level in range(levels):
            cut = np.pi / 2 ** (level + 1)
            for index in range(orientations):
                angular = (-1j) ** power * alpha * np.cos(theta - np.pi * index / orientations) ** power
                self.filters.append((2**level, passed * high(cut) * angular))
            passed = passed * low(cut)
        self.filters.append((2**levels, passed))

    def build(self, image):
        spectrum = np.fft.fft2(image)
        return [np.fft.ifft2(spectrum * mask).real[::step, ::step] for step, mask in self.filters]

    def collapse(self, bands):
        total = 0
        for (step, mask), band in zip(self.filters, bands, strict=True):
            wide = np.zeros(mask.shape)
            wide[::step, ::step] = band * step**2
            total = total + np.fft.fft2(wide) * np.conj(mask)
        return np.fft.ifft2(total).real


def give_histogram(values, target):
    matched = np.empty(values.size)
    matched[np.argsort(values, axis=None)] = np.sort(target, axis=None)
    return matched.reshape(values.shape)


@pytest.mark.parametrize("orientations", [1, 3, 4])
def test_the_whole_method_is_the_papers_listing(orientations):
    walk = np.random.default_rng(4).normal(size=(32, 32)).cumsum(0).cumsum(1)
    exemplar = as_exemplar(((walk - walk.min()) / np.ptp(walk)).astype(np.float32))
    texture_pixels = exemplar.pixels[..., 0].astype(np.float64)
    literal = Literal(32, 2, orientations)
    targets = literal.build(texture_pixels)
    noise = Streams(7)("noise", 0).random((32, 32), dtype=np.float32)
    image = give_histogram(noise, texture_pixels)
    for _ in range(3):
        bands = [give_histogram(*pair) for pair in zip(literal.build(image), targets, strict=True)]
        image = give_histogram(literal.collapse(bands), texture_pixels)
    result = make(exemplar, seed=7, iterations=3, scales=2, orientations=orientations, border="wrap").image[..., 0]
    # Rounding may exchange neighbours in rank, so not every pixel is the same.
    difference = np.abs(result - image)
    assert np.mean(difference > 1e-5) < 0.02
    assert difference.mean() < 1e-4


def test_a_wrapped_exemplar_may_be_shifted_and_a_reflected_one_may_not():
    image = texture((32, 32))
    shifted = np.roll(image, (8, 16), (0, 1))
    wrapped = [make(each, border="wrap", scales=3, iterations=2).image for each in (image, shifted)]
    reflected = [make(each, border="reflect", scales=3, iterations=2).image for each in (image, shifted)]
    assert np.mean(wrapped[0] != wrapped[1]) < 0.02
    assert np.mean(reflected[0] != reflected[1]) > 0.2


def test_borders_of_a_ramp_look_like_texture_only_when_it_wraps():
    ramp = np.linspace(0, 255, 64).astype(np.uint8)[None, :].repeat(64, axis=0)
    spread = {}
    for border in ("wrap", "reflect", "periodic"):
        bands = make(ramp, border=border, iterations=0).model.planes[0].bands
        spread[border] = next(each.sample.std() for key, each in bands.items() if key.label == "l0-o0")
    assert spread["reflect"] < 0.1 * spread["wrap"]
    assert spread["periodic"] < 0.1 * spread["wrap"]


@pytest.mark.parametrize("params", [{}, {"pyramid": "laplacian"}])
def test_the_result_tiles(params):
    smooth = np.random.default_rng(2).normal(size=(70, 70))
    for _ in range(3):
        smooth = smooth[:-2] + 2 * smooth[1:-1] + smooth[2:]
        smooth = smooth[:, :-2] + 2 * smooth[:, 1:-1] + smooth[:, 2:]
    image = make(smooth.astype(np.float32), (48, 64), **params).image[..., 0]
    for axis in (0, 1):
        steps = np.abs(np.diff(image, axis=axis))
        seam = np.abs(np.take(image, 0, axis) - np.take(image, -1, axis))
        assert seam.mean() < 1.5 * steps.mean()
        assert steps.mean() < 0.5 * np.abs(image - np.random.default_rng(0).permuted(image)).mean()


def test_no_round_leaves_noise():
    image = make(texture((64, 64)), iterations=0).image[..., 0]
    assert abs(np.corrcoef(image[1:].ravel(), image[:-1].ravel())[0, 1]) < 0.05


def test_bins_come_close_to_the_histogram():
    result = make(texture((64, 64)), matching="bins")
    assert 0 < w1_of_pixels(result) < 0.03


@pytest.mark.parametrize("params", [{}, {"matching": "bins"}, {"pyramid": "textbook"}, {"palette": "transport"}])
def test_bits_do_not_depend_on_threads_nor_on_pieces(monkeypatch, params):
    image = texture((200, 180), 3)
    one = make(image, (190, 220), threads=1, iterations=1, **params)
    two = make(image, (190, 220), threads=2, iterations=1, **params)
    np.testing.assert_array_equal(one.image, two.image)
    np.testing.assert_array_equal(one.details.distances, two.details.distances)
    monkeypatch.setattr(fourier, "LARGE", 0)
    pieces = [make(image, (190, 220), threads=count, iterations=1, **params).image for count in (1, 2)]
    np.testing.assert_array_equal(pieces[0], pieces[1])


def test_frames_previews_and_distances_tell_the_story():
    frames, metrics = {}, []

    def watch(step):
        if step.frame is not None:
            frames[step.frame] = step.preview()
        if "mean-distance" in step.metrics:
            metrics.append(step.metrics["mean-distance"])

    result = make(texture((40, 40), 3), on_step=watch, iterations=3)
    assert list(frames) == ["noise", "iteration 1", "iteration 2", "iteration 3"]
    curve = result.curves["mean-distance"].y
    np.testing.assert_allclose(metrics, curve)
    bands = [curve for name, curve in result.curves.items() if name.startswith("band-")]
    np.testing.assert_allclose(np.mean([each.y for each in bands], axis=0), curve)
    assert result.details.distances.shape == (4, 3, len(bands))
    assert [key.label for key in result.details.keys][:3] == ["high", "l0-o0", "l0-o1"]
    # The last frame is the result before the channels were matched.
    assert np.abs(frames["iteration 3"] - result.image).mean() < 0.03


@pytest.mark.parametrize("pyramid", ["steerable", "laplacian", "textbook"])
def test_the_coarsest_residual_keeps_two_samples_a_side(pyramid):
    for side in range(1, 70):
        levels = analysis.max_levels((side, 99), pyramid)
        assert -(-side // 2**levels) >= min(side, 2)
        # One level more would leave a single sample, or less than two in the steerable pyramid's spectrum.
        assert side < 2 ** (levels + 2) if pyramid == "steerable" else -(-side // 2 ** (levels + 1)) <= 1


def test_every_piece_of_a_large_sort_is_a_step():
    # 725 x 725 is two pieces of a sort: in each of them seven passes on each of three axes; a step every 2^18
    # samples made two or three of them.
    rng = np.random.default_rng(7)
    exemplar = as_exemplar(rng.random((40, 40, 3), np.float32))
    params = HeegerBergenParams(scales=1, orientations=1, iterations=0)
    stages = []
    run(
        Job(method="heeger-bergen", inputs={"exemplar": exemplar}, params=params, size=(725, 725)),
        lambda step: stages.append(step.stage),
        threads=1,
    )
    assert stages.count("noise") >= 3 * 2 * 7


def test_the_analysis_begins_in_pieces_of_one_channel():
    # Sorting the channels and finding the axes of a large photograph took most of a second before the first step.
    image = np.random.default_rng(3).random((600, 500, 3), np.float32)
    with crew() as team:
        work = analysis.analyze(image, "steerable", 1, 1, "wrap", team)
        pieces = list(itertools.islice(work, 12))
        work.close()
    assert pieces[:3] == [300_000] * 3
    # Then the axes: blocks of at most 2^19 values, or one product of two channels.
    assert max(pieces[4:]) <= 2**19


def test_no_curve_is_called_like_a_measure() -> None:
    """A curve is about the method's own bands on the way, a measure about the result: two numbers, two names."""
    from texlab_core.api import synthesize
    from texlab_core.measures.registry import measures

    exemplar = np.random.default_rng(1).random((32, 32, 1)).astype(np.float32)
    for method in ("heeger-bergen", "msg", "efros-leung", "de-bonet"):
        curves = synthesize(exemplar, method, size=(32, 32), seed=0).curves
        assert not {each.title for each in curves.values()} & {each.title for each in measures().values()}
