"""Algorithm 11.5 over the steerable pyramid: copies, bands copied together, features, what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from texlab_core.engine.inputs import exemplar_of
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.de_bonet import search
from texlab_core.methods.de_bonet.explain import explain
from texlab_core.methods.de_bonet.params import DeBonetParams
from texlab_core.methods.de_bonet.steerable import SteerableAnalysis
from texlab_core.methods.de_bonet.thresholds import ThresholdTable
from texlab_core.transforms import steerable


def noise(height: int, width: int, channels: int = 3, seed: int = 0) -> np.ndarray:
    pixels = np.random.default_rng(seed).random((height, width, channels)).astype(np.float32)
    return (pixels + np.roll(pixels, 1, 0) + np.roll(pixels, 1, 1)) / 3


def made(pixels: np.ndarray, size: tuple[int, int] | None = None, seed: int = 0, **knobs: Any) -> Any:
    inputs = {"exemplar": as_exemplar(pixels)}
    params = DeBonetParams(**{"pyramid": "steerable", "border": "periodic", **knobs})
    return run(Job(method="de-bonet", inputs=inputs, params=params, size=size, seed=seed))


@pytest.mark.parametrize("bands", [1, 3, 4, 8])
@pytest.mark.parametrize("shape", [(64, 96, 3), (128, 128, 1)])
def test_alpha_0_returns_the_input(shape, bands):
    pixels = noise(*shape)
    result = made(pixels, alpha=0, bands=bands)
    np.testing.assert_allclose(result.image, pixels, atol=5e-6)
    assert result.measures["copied-share"] == 1


def test_the_bands_of_a_level_are_copied_together_from_one_place():
    """The output's pyramid put together by hand, band by band, from the sources that were chosen."""
    pixels = noise(64, 64, 3)
    result = made(pixels, (96, 160), alpha=0.8, bands=3, seed=5)
    sampling = result.details.sampling
    analysis, grid = sampling.analysis, sampling.grid
    assert isinstance(analysis, SteerableAnalysis)
    assert analysis.channels == 3
    depth = grid.depth
    whole = np.empty((*grid.shape(0), 3), np.float32)
    for channel in range(3):
        built = steerable.build(np.ascontiguousarray(pixels[..., channel]), depth, 3)
        found = {}
        for key, band in built.items():
            rows, columns = (analysis.levels[key.level].coordinates[sampling.sources[key.level]]).T
            places = grid.coordinates(key.level)
            found[key] = np.empty(grid.shape(key.level), np.float32)
            found[key][places[:, 0], places[:, 1]] = band[rows, columns]
        keys = steerable.band_keys(depth, 3)
        pyramid = steerable.SteerablePyramid(
            found[keys[0]],
            tuple(tuple(found[keys[1 + 3 * level + k]] for k in range(3)) for level in range(depth)),
            found[keys[-1]],
        )
        whole[..., channel] = steerable.collapse(pyramid)
    np.testing.assert_allclose(result.image, np.clip(whole[:96, :160], 0, 1), atol=1e-5)


def test_features_are_the_bands_divided_by_their_deviation():
    pixels = noise(64, 64, 1)
    analysis = made(pixels, bands=4).details.sampling.analysis
    depth = analysis.depth
    built = steerable.build(pixels[..., 0], depth + 1, 4)
    assert analysis.feature_names == (
        "luminance/residual",
        "luminance/oriented-0",
        "luminance/oriented-135",
        "luminance/oriented-90",
        "luminance/oriented-45",
    )
    for level in range(1, depth + 1):
        rows, columns = analysis.levels[level].coordinates.T
        for k in range(4):
            band = built.bands[level][k]
            expected = (band / band.std())[rows, columns]
            np.testing.assert_allclose(analysis.levels[level].features[:, 1 + k], expected, atol=2e-4)
        residual = analysis.levels[level].features[:, 0]
        assert (residual.std() > 0.9) == (level == depth)


@pytest.mark.parametrize("channels", ["luminance", "principal"])
@pytest.mark.parametrize("border", ["reflect", "periodic", "smooth"])
def test_every_way_of_seeing_colours_and_borders_works(channels, border):
    result = made(noise(64, 64), (80, 70), alpha=0.5, channels=channels, border=border, seed=2)
    assert result.image.shape == (80, 70, 3)
    assert np.isfinite(result.image).all()
    again = made(noise(64, 64), (80, 70), alpha=0.5, channels=channels, border=border, seed=2)
    np.testing.assert_array_equal(result.image, again.image)


def test_matches_are_within_the_thresholds_and_can_be_explained():
    result = made(noise(64, 64), alpha=0.6, bands=4, seed=1)
    sampling = result.details.sampling
    for row, column in ((0, 0), (5, 9), (31, 30)):
        found = search.search(sampling, row, column, 1)
        assert found.matches.size >= 1
    explanation = explain(sampling, 12, 40)
    assert explanation.levels[-1].chosen >= 0
    assert explanation.parent_structure(0).shape == (sampling.grid.depth, 15)


def test_more_orientations_constrain_more():
    medians = [
        made(noise(64, 64, 1), alpha=1.0, bands=bands, seed=3).measures["median-candidates"]
        for bands in (1, 4, 12)
    ]
    assert medians[0] > medians[-1]
    assert sorted(medians, reverse=True) == medians


def test_cells_of_the_table_can_name_its_features():
    table = ThresholdTable((((1, "luminance/oriented-45"), 4.0), ((1, "luminance/residual"), 4.0)))
    pixels = noise(64, 64, 1)
    loose, strict = (made(pixels, alpha=0.1, thresholds=each, seed=3) for each in (table, ThresholdTable()))
    row = loose.details.sampling.thresholds[0]
    assert row.tolist() == pytest.approx([4, 0.1, 0.1, 0.1, 4])
    assert strict.details.sampling.thresholds[0].tolist() == pytest.approx([0.1] * 5)


def test_outputs_with_too_few_cells_are_refused():
    with pytest.raises(InputError, match="at least 16 pixels a side, got 64 x 8"):
        made(noise(64, 64), (8, 64))
    assert exemplar_of(made(noise(32, 32), (16, 32), coarsest_side=8).job.inputs).size == (32, 32)


def test_old_documents_mean_the_laplacian_pyramid():
    data = {name: value for name, value in DeBonetParams().to_json().items() if name not in ("pyramid", "bands")}
    assert DeBonetParams.from_json(data).pyramid == "laplacian"
