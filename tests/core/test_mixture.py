"""Mixtures: their ends are the plain method's, their colours and histograms lie in between, as they should."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from scipy import linalg

from texlab_core.contract.cases import texture
from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.heeger_bergen.analysis import analyze
from texlab_core.methods.mixture.blending import Recipe, blend, covariance_mean, quantile_mean
from texlab_core.methods.mixture.common import Common
from texlab_core.methods.mixture.method import weights
from texlab_core.methods.mixture.params import MixtureParams, shares
from texlab_core.transforms.colour import axes_of_covariance, principal_axes
from texlab_core.work.tasks import crew, finish

if TYPE_CHECKING:
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.result import Result

KINDS = ("average", "palette", "start", "scales")
CACHE = AnalysisCache()


def mix(one: ImageInput, other: ImageInput, more: dict[str, ImageInput] | None = None, **values: Any) -> Result:
    params = MixtureParams(**values)
    inputs = {"exemplar": one, "second": other, **(more or {})}
    return run(Job(method="mixture", inputs=inputs, params=params, size=(40, 48), seed=3), cache=CACHE)


def plain(exemplar: ImageInput) -> Result:
    return run(Job(method="heeger-bergen", inputs={"exemplar": exemplar}, size=(40, 48), seed=3), cache=CACHE)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("first", "second"), [(1, 1), (1, 3), (3, 1), (3, 3)])
def test_the_ends_are_the_plain_textures_bit_for_bit(kind: Any, first: int, second: int) -> None:
    one, other = texture(32, 32, first), texture(40, 28, second)
    for weight, alone in ((0.0, one), (1.0, other)):
        image = mix(one, other, kind=kind, weight=weight).image
        wanted = plain(alone).image
        np.testing.assert_array_equal(image, np.broadcast_to(wanted, image.shape))
        assert image.shape[2] == max(first, second)


@pytest.mark.parametrize("kind", KINDS)
def test_near_the_ends_it_is_near_the_plain_textures(kind: Any) -> None:
    # Of as many scales each.
    one, other = texture(32, 36), texture(40, 44)
    for weight, alone in ((1e-7, one), (1 - 1e-7, other)):
        away = np.abs(mix(one, other, kind=kind, weight=weight).image - plain(alone).image)
        # Some values lie so near each other that they change places.
        assert away.mean() < 0.6 / 255
        assert np.quantile(away, 0.95) <= 2.1 / 255


def test_the_same_exemplar_twice_is_that_exemplar() -> None:
    one = texture(32, 36)
    away = np.abs(mix(one, one, weight=0.5).image - plain(one).image)
    assert away.mean() < 0.3 / 255


def test_what_a_weight_means() -> None:
    for kind in KINDS:
        assert shares(kind, 0) == (0, 0, 0, 0, 0)
        assert shares(kind, 1) == (1, 1, 1, 1, 0)
    assert shares("palette", 0.5) == (1, 1, 1, 0, 0)
    assert shares("scales", 0.5) == (1, 0, 0.5, 0.5, 0)
    assert shares("start", 0.5) == (0, 0, 0, 0, 1)
    assert shares("average", 0.3) == (0.3, 0.3, 0.3, 0.3, 0)
    recipe = weights(MixtureParams(weight=0.25, third=0.5, fourth=0.2), ("exemplar", "second", "third", "fourth"))
    assert recipe.colours == pytest.approx((0.5 * 0.8 * 0.75, 0.5 * 0.8 * 0.25, 0.5 * 0.8, 0.2))
    assert sum(recipe.fine) == pytest.approx(1)
    # A share counts only where there is such an input, and only in averages.
    assert weights(MixtureParams(third=0.5), ("exemplar", "second")).fine == (0.5, 0.5)
    assert weights(MixtureParams(third=0.5, kind="scales"), ("exemplar", "second", "third")).coarse == (1, 0, 0)


def test_the_palette_is_the_first_ones_and_the_pattern_the_second_ones() -> None:
    one, other = texture(48, 48), as_exemplar(texture(48, 40).pixels[..., ::-1] ** 2)
    result = mix(one, other, kind="palette", weight=0.5)
    for channel in range(3):
        wanted = np.quantile(one.pixels[..., channel], np.linspace(0.05, 0.95, 19))
        found = np.quantile(result.image[..., channel], np.linspace(0.05, 0.95, 19))
        np.testing.assert_allclose(found, wanted, atol=0.01)

    def common(image: ImageInput) -> Common:
        with crew() as team:
            return Common.of(finish(analyze(image.pixels, "steerable", 3, 4, "reflect", team)), 3)

    model = finish(blend([common(one), common(other)], Recipe((0, 1), (0, 1), (0, 1), (1, 0), 0)))
    for axis, plane in enumerate(common(other).planes):
        for key, target in plane.bands.items():
            if key in model.planes[axis].bands:
                np.testing.assert_array_equal(model.planes[axis].bands[key].sample, target.sample)
    assert model.axes is not None
    np.testing.assert_allclose(model.axes.spread, principal_axes(one.pixels).spread, rtol=1e-4)


def test_fine_scales_are_the_second_ones_and_coarse_ones_the_first_ones() -> None:
    recipe = weights(MixtureParams(kind="scales", cut=2, weight=0.5), ("exemplar", "second"))
    from texlab_core.transforms.steerable import band_keys

    found = {key.label: recipe.band(key) for key in band_keys(4, 1)}
    assert {label for label, share in found.items() if share == (0, 1)} == {"high", "l0-o0", "l1-o0"}
    assert {label for label, share in found.items() if share == (1, 0)} == {"l2-o0", "l3-o0", "low"}


def test_a_start_shows_through() -> None:
    one = texture(40, 48)
    rows, columns = np.indices((40, 48))
    other = as_exemplar(((rows // 8 + columns // 8) % 2).astype(np.float32) * 0.8 + 0.1)
    result = mix(one, other, kind="start", weight=0.5, iterations=1)
    noise = mix(one, other, kind="average", weight=0.0, iterations=1)

    def likeness(image: np.ndarray) -> float:
        return float(np.corrcoef(image.mean(axis=-1).ravel(), other.pixels.ravel())[0, 1])

    assert abs(likeness(result.image)) > 0.4
    assert abs(likeness(noise.image)) < 0.25


def test_a_smaller_start_is_mirrored() -> None:
    from texlab_core.methods.mixture.method import _mirrored

    np.testing.assert_array_equal(_mirrored(8, 3), [0, 1, 2, 2, 1, 0, 0, 1])
    np.testing.assert_array_equal(_mirrored(2, 3), [0, 1])


def test_three_and_four_exemplars() -> None:
    images = [texture(24 + 2 * place, 30) for place in range(4)]
    more = {"third": images[2], "fourth": images[3]}
    np.testing.assert_array_equal(mix(*images[:2], more, fourth=1.0).image, plain(images[3]).image)
    np.testing.assert_array_equal(mix(*images[:2], more, third=1.0).image, plain(images[2]).image)
    both = mix(*images[:2], more, third=0.3, fourth=0.3).image
    assert not np.array_equal(both, mix(*images[:2], weight=0.5).image)


def test_the_mean_of_quantile_functions() -> None:
    one, other = np.float32([0, 1, 2, 3]), np.float32([10, 14])
    np.testing.assert_allclose(quantile_mean([one, other], [0.75, 0.25]), 0.75 * one + [2.5, 2.75, 3.25, 3.5])
    np.testing.assert_array_equal(quantile_mean([one, other], [1, 0]), one)
    # Of Gaussians it is the Gaussian of the mean spread.
    normal = np.sort(np.random.Generator(np.random.PCG64(1)).standard_normal(5000)).astype(np.float32)
    assert quantile_mean([normal, 3 * normal], [0.5, 0.5]).std() == pytest.approx(2 * normal.std(), rel=1e-5)


def covariance(seed: int, rank: int = 3) -> np.ndarray:
    factor = np.random.Generator(np.random.PCG64(seed)).standard_normal((3, rank)) / 4
    return factor @ factor.T


@pytest.mark.parametrize("share", [0.0, 0.2, 0.5, 1.0])
def test_two_covariances_have_the_closed_form(share: float) -> None:
    one, other = covariance(1), covariance(2)
    root = linalg.sqrtm(one)
    transport = np.linalg.inv(root) @ linalg.sqrtm(root @ other @ root) @ np.linalg.inv(root)
    step = (1 - share) * np.eye(3) + share * transport
    np.testing.assert_allclose(covariance_mean([one, other], [1 - share, share]), step @ one @ step, atol=1e-8)


def test_more_covariances_solve_the_equation_of_the_barycentre() -> None:
    given, shares_ = [covariance(seed) for seed in (3, 4, 5)], [0.5, 0.3, 0.2]
    mean = covariance_mean(given, shares_)
    root = linalg.sqrtm(mean)
    total = sum(share * linalg.sqrtm(root @ each @ root) for share, each in zip(shares_, given, strict=True))
    np.testing.assert_allclose(total, mean, atol=1e-8)


def test_flat_clouds_of_colours_have_a_mean_too() -> None:
    gray = np.full((3, 3), 0.04)
    np.testing.assert_allclose(covariance_mean([gray, gray], [0.5, 0.5]), gray, atol=1e-6)
    between = covariance_mean([gray, covariance(6)], [0.5, 0.5])
    assert np.isfinite(between).all()
    assert np.linalg.eigvalsh(between).min() > -1e-12
    # Commuting covariances: standard deviations are averaged.
    np.testing.assert_allclose(
        covariance_mean([np.diag([1.0, 4.0]), np.diag([9.0, 0.0])], [0.5, 0.5]), np.diag([4.0, 1.0]), atol=1e-5
    )


def test_axes_of_a_covariance_are_those_of_the_image() -> None:
    image = texture(30, 30)
    axes = principal_axes(image.pixels)
    scaled = axes.directions * axes.spread[:, None]
    found = axes_of_covariance(axes.mean, scaled.T @ scaled, 3)
    np.testing.assert_allclose(found.directions, axes.directions, atol=1e-9)
    np.testing.assert_allclose(found.spread, axes.spread, rtol=1e-9)


def test_a_constant_takes_part() -> None:
    flat = as_exemplar(np.full((20, 20, 3), (0.2, 0.5, 0.8), np.float32))
    alone = mix(flat, flat).image
    np.testing.assert_allclose(alone, np.broadcast_to((0.2, 0.5, 0.8), alone.shape), atol=1e-6)
    half = mix(texture(24, 24), flat, weight=0.5).image
    whole = mix(texture(24, 24), flat, weight=0.0).image
    assert half.std() < whole.std()


def test_the_second_exemplar_is_needed() -> None:
    with pytest.raises(InputError, match="Mixture needs the input second"):
        Job(method="mixture", inputs={"exemplar": texture(8, 8)})
    assert [spec.required for spec in find_method("mixture").inputs] == [True, True, False, False]
