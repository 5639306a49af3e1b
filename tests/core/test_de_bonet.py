"""De Bonet as a method: copies, tilings, the paper's figure 11 in numbers, steadiness, maps, explanations."""

from __future__ import annotations

import pickle
import subprocess
import sys
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab_core.engine.cache import AnalysisCache
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import InputError, ParamError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.measures.copying import continuous_share, copied_regions
from texlab_core.methods.de_bonet import sampling as sampling_module
from texlab_core.methods.de_bonet.distances import feature_distances, passing_share
from texlab_core.methods.de_bonet.explain import explain
from texlab_core.methods.de_bonet.maps import median_candidates
from texlab_core.methods.de_bonet.params import DeBonetParams
from texlab_core.methods.de_bonet.thresholds import ThresholdTable

if TYPE_CHECKING:
    from texlab_core.engine.result import Result


def noise(height: int, width: int, channels: int = 3, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).random((height, width, channels)).astype(np.float32)


def cartoon(side: int = 128, discs: int = 4, grain: float = 0.0) -> np.ndarray:
    """Return gray discs on white, (side, side, 1)."""
    random = np.random.default_rng(5)
    y, x = np.mgrid[:side, :side]
    image = np.ones((side, side), np.float32)
    for _ in range(discs):
        row, column = random.integers(0, side, 2)
        radius, gray = random.uniform(6, 14), random.uniform(0, 0.8)
        image = np.where((y - row) ** 2 + (x - column) ** 2 < radius**2, np.float32(gray), image)
    image += (grain * random.standard_normal(image.shape)).astype(np.float32)
    return np.clip(image, 0, 1)[..., None]


def made(pixels: np.ndarray, size: tuple[int, int] | None = None, seed: int = 0, **knobs: Any) -> Result:
    inputs = {"exemplar": as_exemplar(pixels)}
    return run(Job(method="de-bonet", inputs=inputs, params=DeBonetParams(**knobs), size=size, seed=seed))


@pytest.mark.parametrize("border", ["reflect", "periodic"])
@pytest.mark.parametrize("shape", [(64, 96, 3), (128, 128, 1), (48, 80, 3), (61, 83, 3), (130, 67, 1), (7, 90, 1)])
def test_alpha_0_returns_the_input_on_any_size(border: str, shape: tuple[int, int, int]) -> None:
    pixels = noise(*shape)
    result = made(pixels, alpha=0, border=border, seed=7)
    np.testing.assert_array_equal(result.image, pixels)
    assert result.measures == {"copied-share": 1, "median-candidates": 1, "largest-copy": 1}


@pytest.mark.parametrize("knobs", [{}, {"coarsest_side": 1, "fit_filters": False}])
def test_alpha_0_is_exact_tiling_at_twice_the_size(knobs: dict[str, Any]) -> None:
    pixels = noise(64, 64)
    result = made(pixels, (128, 128), alpha=0, border="periodic", coarsest="tile", **knobs)
    np.testing.assert_array_equal(result.image, np.tile(pixels, (2, 2, 1)))


def test_literal_siblings_are_shuffled_even_at_alpha_0() -> None:
    pixels = noise(64, 64)
    literal = made(pixels, alpha=0, siblings="literal")
    assert (literal.image != pixels).any()
    rows = literal.maps["source"].data // 2
    # Without matches beside itself a pixel's source stays among its siblings... level by level.
    assert literal.measures["median-candidates"] == 4
    assert rows.shape == (64, 64, 2)
    mixed = made(pixels, alpha=0, siblings="mixed", literal_levels=1)
    assert mixed.measures["median-candidates"] == 1
    assert continuous_share(mixed.maps["source"].data) > continuous_share(literal.maps["source"].data)
    every = made(pixels, alpha=0, siblings="mixed", literal_levels=24)
    np.testing.assert_array_equal(every.image, literal.image)


def test_everything_matches_at_infinite_thresholds() -> None:
    pixels = noise(32, 32, 1)
    table = {(k, name): 1e6 for k in (1, 2) for name in made(pixels).model.feature_names}
    result = made(pixels, (64, 64), thresholds=ThresholdTable().changed(table))
    assert result.model.depth == 2
    assert (result.maps["candidates"].data == 16 * 16).all()


def test_the_literal_sum_matches_nearly_everything() -> None:
    pixels = noise(64, 64, 1)
    literal = made(pixels, (64, 64), alpha=0.5, normalization="sum")
    assert literal.measures["median-candidates"] > 0.95 * 32 * 32
    assert made(pixels, (64, 64), alpha=0.5).measures["median-candidates"] == 1


@pytest.mark.slow
def test_figure_11_in_numbers() -> None:
    """Continuous neighbours on gravel, 128 -> 256, as the method page has them."""
    pixels = as_exemplar("gallery:stochastic-gravel").pixels[:128, :128]
    found = []
    for alpha in (0.05, 0.10, 0.15, 0.20, 0.25, 0.30):
        shares = [made(pixels, (256, 256), seed, alpha=alpha).measures["copied-share"] for seed in range(3)]
        found.append(float(np.mean(shares)))
    np.testing.assert_allclose(found, [0.97, 0.94, 0.90, 0.86, 0.83, 0.79], atol=0.03)
    assert found == sorted(found, reverse=True)


@pytest.mark.parametrize("grain", [0.0, 0.01])
@pytest.mark.parametrize("deferred", [False, True])
def test_choices_stay_when_alpha_moves_a_little(
    grain: float, deferred: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if deferred:
        monkeypatch.setattr(sampling_module, "_defer_from", lambda sampling: 64)
    pixels = cartoon(grain=grain)
    # Of the layout nothing changes; under whole repetitions most of the flat ground is sampled by proposals.
    one, other = (made(pixels, (256, 256), alpha=alpha, coarsest="shift") for alpha in (0.15, 0.155))
    if deferred:
        assert (one.details.sampling.matches[1] < 0).mean() > 0.2
    changed = (one.maps["source"].data != other.maps["source"].data).any(-1)
    assert changed.mean() <= 0.05


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("coarsest", ["patches", "shift"])
def test_neither_rejection_nor_its_threshold_changes_bits(
    coarsest: str, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    for siblings in ("parity", "literal"):
        knobs = {"alpha": 0.3, "siblings": siblings, "coarsest": coarsest}
        deferred = made(cartoon(grain=0.01), (128, 160), seed, **knobs)
        assert (deferred.details.sampling.matches[1] < 0).mean() > 0.05
        monkeypatch.setattr(sampling_module, "_defer_from", lambda sampling: 10**9)
        listed = made(cartoon(grain=0.01), (128, 160), seed, **knobs)
        monkeypatch.undo()
        assert (listed.details.sampling.matches[1] >= 0).all()
        np.testing.assert_array_equal(deferred.image, listed.image)
        np.testing.assert_array_equal(deferred.maps["candidates"].data, listed.maps["candidates"].data)
        exact = float(np.median(listed.details.sampling.matches[1])) * (4 if siblings == "literal" else 1)
        assert median_candidates(listed.details.sampling, 0) == exact
        assert deferred.measures["median-candidates"] == pytest.approx(exact, rel=0.35)


def test_more_alpha_more_candidates() -> None:
    pixels = noise(64, 64, 1)
    pixels = (pixels + np.roll(pixels, 1, 0) + np.roll(pixels, 1, 1)) / 3
    counts = [made(pixels, alpha=alpha).maps["candidates"].data.mean() for alpha in (0, 0.1, 0.3, 1, 4)]
    assert counts == sorted(counts)


def test_coarsest_layouts() -> None:
    pixels = noise(64, 64)
    sources = {}
    for coarsest in ("shift", "fit", "tile", "iid"):
        sampling = made(pixels, (192, 128), coarsest=coarsest).details.sampling
        sources[coarsest] = sampling.sources[-1].reshape(24, 16)
    own = np.arange(64).reshape(8, 8)
    np.testing.assert_array_equal(sources["tile"], np.tile(own, (3, 2)))
    for name in ("shift", "fit"):
        shifts = set()
        for row in range(3):
            for column in range(2):
                block = sources[name][8 * row : 8 * row + 8, 8 * column : 8 * column + 8]
                # A cyclic shift by whole cells of the coarsest level.
                dy, dx = divmod(int(block[0, 0]), 8)
                np.testing.assert_array_equal(block, np.roll(own, (-dy, -dx), (0, 1)))
                shifts.add((dy, dx))
        assert len(shifts) > 1
    assert len(np.unique(sources["iid"])) > 32


def test_presets_of_the_paper() -> None:
    pixels = noise(64, 64, 1)
    paper = made(pixels, (128, 128), coarsest="tile", coarsest_side=1, fit_filters=False)
    assert paper.model.depth == 6
    assert paper.details.sampling.sources[-1].size == 4
    assert np.isinf(paper.model.levels[6].scale).sum() == 9
    assert made(pixels, coarsest_side=4, fit_filters=False).model.depth == 4
    assert made(pixels, coarsest_side=4).model.depth == 3
    assert made(pixels, coarsest_side=4, filters="laplacian").model.depth == 4


def test_tileable_output_has_no_seam() -> None:
    smooth = np.cumsum(np.cumsum(noise(64, 64, 1) - 0.5, 0), 1)
    smooth = ((smooth - smooth.min()) / np.ptp(smooth)).astype(np.float32)

    def seam(image: np.ndarray) -> float:
        return float(np.abs(image[:, 0] - image[:, -1]).mean() + np.abs(image[0] - image[-1]).mean())

    # Uniform sources at every level: what is left at the border is the border rule of the collapse alone.
    knobs = {"thresholds": ThresholdTable().changed({(1, "luminance/laplacian"): 1e6}), "coarsest": "iid"}
    open_, tiles = (made(smooth, (128, 128), tileable=tileable, **knobs).image for tileable in (False, True))
    assert seam(tiles) < 0.8 * seam(open_)
    assert not made(smooth, (128, 128), tileable=True).notes
    fewer = made(smooth, (100, 128), tileable=True)
    assert fewer.details.sampling.grid.depth == 2
    assert "has 2 halvings and not 3" in fewer.notes[0]
    assert "does not tile" in made(smooth, (100, 128), tileable=True, uneven="crop").notes[0]


def test_smooth_border() -> None:
    y, x = np.mgrid[:64, :64]
    pixels = noise(64, 64) * 0.3 + (x / 128)[..., None].astype(np.float32)
    result = made(pixels, (128, 128), border="smooth", alpha=0, coarsest="tile")
    np.testing.assert_allclose(result.image[:64, :64], result.image[64:, 64:], atol=1e-6)
    assert "smooth component" in result.notes[0]
    assert y.shape == (64, 64)


def test_analysis_is_shared_by_everything_that_only_samples() -> None:
    cache = AnalysisCache()
    inputs = {"exemplar": as_exemplar(noise(32, 32))}
    table = ThresholdTable().changed({(1, "red/laplacian"): 1.0})
    first = run(Job(method="de-bonet", inputs=inputs), cache=cache)
    for knobs in (
        {"alpha": 0.4}, {"beta": 1.0}, {"thresholds": table}, {"siblings": "literal"}, {"coarsest": "iid"},
        {"tileable": True},
    ):  # fmt: skip
        again = run(Job(method="de-bonet", inputs=inputs, params=DeBonetParams(**knobs), seed=3), cache=cache)
        assert again.model is first.model


def test_maps_and_curves() -> None:
    pixels = noise(37, 66)
    result = made(pixels, (70, 90), alpha=0.4, siblings="mixed", coarsest="tile")
    sampling = result.details.sampling
    source = result.maps["source"].data
    assert list(result.maps) == ["source", "candidates", "copied"]
    copies = pickle.loads(pickle.dumps(result.maps))
    assert all((copies[name].data == result.maps[name].data).all() for name in result.maps)
    assert source.dtype == np.int32
    # In the exemplar's own coordinates, wherever the corner of a crop lies and whatever was padded.
    assert source.reshape(-1, 2).min(0).tolist() == [0, 0]
    assert source.reshape(-1, 2).max(0).tolist() == [36, 65]
    cropped = made(pixels, (70, 90), fitting="crop", coarsest="tile").maps["source"].data.reshape(-1, 2)
    assert cropped.min(0).tolist() == [0, 1]
    assert cropped.max(0).tolist() == [35, 64]
    labels, sizes = copied_regions(source)
    np.testing.assert_array_equal(result.maps["copied"].data, labels)
    np.testing.assert_array_equal(result.details.region_sizes, sizes)
    assert result.measures["largest-copy"] == sizes[1] / source[..., 0].size
    assert result.measures["copied-share"] == continuous_share(source)
    assert result.maps["candidates"].data.shape == (70, 90)
    depth = sampling.grid.depth
    for name in ("median-candidates", "continuity"):
        assert result.curves[name].x.tolist() == list(range(depth, -1, -1))
        assert (
            result.curves[name].y[-1]
            == result.measures[{"median-candidates": "median-candidates", "continuity": "copied-share"}[name]]
        )


def test_frames_grow_level_by_level() -> None:
    inputs = {"exemplar": as_exemplar(noise(64, 64))}
    frames: list[tuple[str, np.ndarray]] = []

    def watch(step: Any) -> None:
        if step.frame is not None:
            frames.append((step.frame, step.preview()))

    result = run(Job(method="de-bonet", inputs=inputs, size=(100, 70)), watch)
    assert [name for name, _ in frames] == ["level 3", "level 2", "level 1", "level 0"]
    np.testing.assert_array_equal(frames[-1][1], result.image)
    errors = [float(((picture - result.image) ** 2).mean()) for _, picture in frames]
    assert errors == sorted(errors, reverse=True)


@pytest.mark.parametrize("siblings", ["parity", "literal"])
def test_explanations(siblings: str) -> None:
    pixels = noise(40, 66, 3)
    pixels = (pixels + np.roll(pixels, 1, 0) + np.roll(pixels, 1, 1)) / 3
    result = made(pixels, (70, 90), alpha=0.6, siblings=siblings)
    sampling, source = result.details.sampling, result.maps["source"].data
    counts = result.maps["candidates"].data
    depth = sampling.grid.depth
    for row, column in ((0, 0), (69, 89), (31, 57), (12, 80)):
        why = explain(sampling, row, column)
        assert [each.level for each in why.levels] == list(range(depth, -1, -1))
        own = why.at(0)
        assert why.exemplar_box(0, *own.source)[:2] == tuple(source[row, column])
        assert len(own.candidates) == counts[row, column]
        for each in why.levels:
            assert each.location == (row >> each.level, column >> each.level)
            assert tuple(each.candidates[each.chosen]) == each.source
            assert why.at(each.level) is each
            if each.level == depth:
                continue
            thresholds = why.thresholds[: depth - each.level]
            for candidate in range(len(each.candidates)):
                differences = why.differences(each.level, candidate)
                assert differences.shape == thresholds.shape == (depth - each.level, len(why.features))
                assert (differences <= thresholds).all()
            above = why.at(each.level + 1)
            assert each.tested == (4 * len(above.matches) if each.level else 0)
        for each in why.levels[:-1]:
            tested_out = each.tested - len(each.matches)
            assert (each.alone <= each.violated).all()
            assert each.violated.max() <= tested_out <= each.violated.sum()
        strictest = why.strictest()
        assert strictest is not None
        assert strictest.excluded == max(int(each.violated.max()) for each in why.levels[:-1])
        assert why.at(depth + 1 - strictest.k).violated[strictest.feature] == strictest.excluded
        assert why.strictest(0) is None
    with pytest.raises(ParamError, match="row"):
        explain(sampling, 10_000, 0)


def test_a_violated_constraint_is_named() -> None:
    """One feature alone has a threshold that excludes anything."""
    pixels = noise(32, 32, 1)
    names = made(pixels).model.feature_names
    table = ThresholdTable().changed({(k, name): 1e6 for k in (1, 2) for name in names})
    result = made(pixels, thresholds=table.changed({(2, "luminance/second-45"): 0.01}))
    why = explain(result.details.sampling, 9, 20)
    strictest = why.strictest()
    assert strictest is not None
    assert (strictest.k, names[strictest.feature]) == (2, "luminance/second-45")
    each = why.at(1)
    assert each.tested == 256
    assert strictest.excluded == 256 - len(each.matches) == each.alone[strictest.feature]


def test_feature_distances() -> None:
    model = made(noise(32, 32, 1)).model
    values = model.levels[2].features[:, 3]
    every = np.sort(((values[:, None] - values[None, :]) ** 2)[~np.eye(values.size, dtype=bool)])
    found = feature_distances(model, 1, 3)
    np.testing.assert_allclose(found, every, rtol=1e-6)
    assert passing_share(found, 0.5) == pytest.approx((every <= 0.5).mean())
    assert passing_share(found, 1e6) == 1
    many = feature_distances(made(noise(256, 256, 1)).model, 5, 0)
    assert many.size < 2**18
    # Normalized by their variance, independent pairs differ by twice that.
    assert many.mean() == pytest.approx(2, rel=0.1)


def test_thin_outputs_are_refused_before_work_starts() -> None:
    inputs = {"exemplar": as_exemplar(noise(256, 256, 1))}
    params = DeBonetParams(coarsest_side=1, fit_filters=False)
    with pytest.raises(InputError, match="thin"):
        Job(method="de-bonet", inputs=inputs, params=params, size=(1, 2**25))


def test_importing_the_methods_is_light() -> None:
    code = (
        "import sys; import texlab_core.methods.de_bonet.method, texlab_core.methods.tiling, "
        "texlab_core.methods.pixels, texlab_core.methods.de_bonet.method_independent_bands; "
        "heavy = {'numba', 'scipy', 'cv2', 'PIL'} & set(sys.modules); "
        "print(', '.join(sorted(heavy)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "\n", "")
