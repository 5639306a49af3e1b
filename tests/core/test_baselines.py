"""The baselines of De Bonet's figures 2, 3 and 4."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.transforms import laplacian

if TYPE_CHECKING:
    from texlab_core.engine.result import Result


def texture(height: int, width: int, channels: int = 3) -> np.ndarray:
    pixels = np.random.default_rng(1).random((height, width, channels)).astype(np.float32)
    return (pixels + np.roll(pixels, 1, 0) + np.roll(pixels, 1, 1)) / 3


def made(method: str, pixels: np.ndarray, size: tuple[int, int], seed: int = 0, **knobs: Any) -> Result:
    params = find_method(method).params(**knobs)
    inputs = {"exemplar": as_exemplar(pixels)}
    return run(Job(method=method, inputs=inputs, params=params, size=size, seed=seed))


def test_tiling() -> None:
    pixels = texture(20, 30)
    result = made("tiling", pixels, (50, 64))
    np.testing.assert_array_equal(result.image, np.tile(pixels, (3, 3, 1))[:50, :64])
    places = result.maps["source"].data
    np.testing.assert_array_equal(pixels[places[..., 0], places[..., 1]], result.image)
    np.testing.assert_array_equal(made("tiling", pixels, (20, 30)).image, pixels)


def test_mirrored_tiling_has_equal_neighbours_at_the_borders() -> None:
    pixels = texture(20, 30)
    image = made("tiling", pixels, (60, 90), mirror=True).image
    np.testing.assert_array_equal(image[19], image[20])
    np.testing.assert_array_equal(image[:, 59], image[:, 60])
    np.testing.assert_array_equal(image[20:40, 30:60], pixels[::-1, ::-1])


@pytest.mark.parametrize("channels", [1, 3])
def test_pixels_are_independent_and_uniform(channels: int) -> None:
    pixels = np.linspace(0, 1, 12 * channels, dtype=np.float32).reshape(3, 4, channels)
    result = made("pixels", pixels, (300, 400))
    places = result.maps["source"].data
    np.testing.assert_array_equal(pixels[places[..., 0], places[..., 1]], result.image)
    drawn = places[..., 0] * 4 + places[..., 1]
    counts = np.bincount(drawn.ravel(), minlength=12)
    expected = 300 * 400 / 12
    assert ((counts - expected) ** 2 / expected).sum() < 11 + 5 * 22**0.5
    # Neighbours are equal as often as chance has it.
    assert (drawn[:, 1:] == drawn[:, :-1]).mean() == pytest.approx(1 / 12, abs=0.005)


def test_pixels_do_not_depend_on_how_they_are_chunked() -> None:
    pixels = texture(8, 8)
    small, large = made("pixels", pixels, (8, 16)), made("pixels", pixels, (16, 16))
    np.testing.assert_array_equal(large.image.reshape(-1, 3)[:128], small.image.reshape(-1, 3))


def test_bands_keep_their_histograms_and_lose_their_relations() -> None:
    pixels = texture(64, 64, 1) + np.indices((64, 64)).sum(0)[..., None].astype(np.float32) % 16 / 32
    pixels = (pixels / pixels.max()).astype(np.float32)
    result = made("bands", pixels, (512, 512))
    assert result.image.shape == (512, 512, 1)
    assert result.image.mean() == pytest.approx(pixels.mean(), abs=0.03)

    def parent_child(image: np.ndarray) -> float:
        bands = laplacian.build(image[..., 0].astype(np.float64), 2)
        return abs(float(np.corrcoef(np.abs(bands[0][::2, ::2]).ravel(), np.abs(bands[1]).ravel())[0, 1]))

    assert parent_child(result.image) < max(0.15, 0.6 * parent_child(pixels))


def test_bands_down_to_one_pixel() -> None:
    result = made("bands", texture(32, 32), (64, 64), coarsest_side=1, border="periodic")
    assert result.model.depth == 5
    assert result.model.border == "periodic"
