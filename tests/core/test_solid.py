"""Solid textures: histograms of the volume and of its slices, streaks, tiling, limits."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from texlab_core.contract.cases import check_sentence, texture
from texlab_core.engine import estimate as estimates
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.errors import InputError
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.heeger_bergen.analysis import analyze, band_keys
from texlab_core.methods.solid.slices import CUTS, SlicePlan, match_slices
from texlab_core.methods.solid.synthesis import SETTLED
from texlab_core.stats.histogram import resample, sorted_sample
from texlab_core.stats.solids import streaks
from texlab_core.transforms import steerable
from texlab_core.transforms.steerable import BandKey
from texlab_core.work.tasks import crew, finish

if TYPE_CHECKING:
    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.result import Result

METHOD = find_method("solid")


def make(exemplar: ImageInput, size: tuple[int, int, int], seed: int = 0, **values: Any) -> Result:
    params = METHOD.params.from_json(values)
    return run(Job(method="solid", inputs={"exemplar": exemplar}, params=params, size=size, seed=seed))


@pytest.fixture(scope="module")
def mixed() -> dict[str, Result]:
    exemplar = as_exemplar(as_exemplar("gallery:structured-pebbles", scale=0.5).pixels.mean(axis=-1))
    kinds = {
        "pooled": {"kind": "mixed"},
        "plain": {"kind": "mixed", "balance": False},
        "per-slice": {"kind": "mixed", "histograms": "per-slice"},
        "laplacian": {"balance": False},
    }
    return {name: make(exemplar, (64, 64, 64), **values) for name, values in kinds.items()}


@pytest.mark.parametrize("kind", ["laplacian", "mixed"])
def test_voxels_have_the_exemplars_values(kind: str) -> None:
    exemplar = texture(24, 24, 1)
    result = make(exemplar, (9, 8, 8), kind=kind)
    assert result.volume is not None
    # As many voxels as pixels: the very same values.
    np.testing.assert_array_equal(sorted_sample(result.volume), sorted_sample(exemplar.pixels))
    assert result.measures["w1-voxels"] == 0


def test_another_number_of_voxels_takes_the_resampled_values() -> None:
    exemplar = texture(20, 31, 1)
    volume = make(exemplar, (7, 11, 5)).volume
    wanted = resample(sorted_sample(exemplar.pixels), 7 * 11 * 5).clip(0, 1)
    np.testing.assert_allclose(sorted_sample(volume), wanted, atol=1e-7)


@pytest.mark.parametrize(("kind", "count"), [("laplacian", 5), ("mixed", 5 + 3 * 17)])
def test_every_band_comes_nearer_in_plain_rounds_too(kind: str, count: int) -> None:
    exemplar = as_exemplar("gallery:structured-pebbles", scale=0.5)
    result = make(exemplar, (48, 48, 48), kind=kind, balance=False)
    bands = {key: curve.y for key, curve in result.curves.items() if key.startswith("band-")}
    # Four levels and the residual of the solid; in each of the cuts the high-pass and 4 x 4 oriented bands.
    assert len(bands) == count
    assert all(values[-1] < values[0] for values in bands.values())
    means = result.curves["mean-distance"].y
    assert (np.diff(means) < 0).all()


@pytest.mark.parametrize("name", ["stochastic-bark", "stochastic-granite", "structured-leaves"])
def test_bands_of_even_grain_come_nearer_or_settle_in_plain_rounds(name: str) -> None:
    exemplar = as_exemplar(as_exemplar(f"gallery:{name}", scale=0.5).pixels.mean(axis=-1))
    result = make(exemplar, (40, 40, 40), kind="mixed", balance=False)
    bands = {key: curve.y for key, curve in result.curves.items() if key.startswith("band-")}
    assert [key for key, values in bands.items() if values[-1] > max(values[0], SETTLED)] == []
    assert result.notes == ()
    means = result.curves["mean-distance"].y
    assert (np.diff(means) < 0).all()
    assert means[-1] < means[0] / 3


def half_gray(name: str) -> ImageInput:
    return as_exemplar(as_exemplar(f"gallery:{name}", scale=0.5).pixels.mean(axis=-1))


# Over the gallery the only bands that end farther away after five plain rounds than they began.
CLIMBING = {"quasiperiodic-knit": "l2", "manmade-ribs": "l3", "inhomogeneous-litbrick": "l3"}


@pytest.mark.parametrize(("name", "band"), CLIMBING.items())
def test_bands_that_climb_at_first_in_plain_rounds_fall_from_the_fourth_round_on(name: str, band: str) -> None:
    result = make(half_gray(name), (64, 64, 64), iterations=8, balance=False)
    values = result.curves[f"band-{band}"].y
    assert values[0] < values[4]
    assert (np.diff(values[4:]) < 0).all()
    others = [curve.y for key, curve in result.curves.items() if key not in (f"band-{band}", "mean-distance")]
    assert all(each[-1] < each[0] for each in others)
    # None of the other bands begins so near.
    assert values[0] < 0.75


@pytest.mark.parametrize(
    ("name", "level", "low", "high"),
    [
        ("quasiperiodic-knit", 2, 1.3, 2.0),
        ("inhomogeneous-litbrick", 3, 0.7, 1.1),
        ("structured-pebbles", 2, 0.1, 0.35),
        ("stochastic-granite", 3, 0.1, 0.35),
    ],
)
def test_what_neighbours_put_into_a_band(name: str, level: int, low: float, high: float) -> None:
    """Coefficients in random order, one band at a time: their power in a band, over what it should have."""
    from texlab_core.transforms import solid_laplacian

    with crew() as team:
        model = finish(analyze(half_gray(name).pixels, "laplacian", 4, 4, "reflect", team)).planes[0]
    targets = [model.bands[key].sample for key in band_keys("laplacian", 4, 0)]
    shapes = [each.shape for each in finish(solid_laplacian.build(np.zeros((48, 48, 48), np.float32), 4))]
    rng = np.random.Generator(np.random.PCG64(0))
    power = 0.0
    for place, target in enumerate(targets):
        if place == level:
            continue
        bands = [np.zeros(shape, np.float32) for shape in shapes]
        bands[place][:] = rng.choice(target, size=shapes[place])
        bands[place] -= bands[place].mean()
        volume = finish(solid_laplacian.collapse(bands))
        power += float(finish(solid_laplacian.build(volume, 4))[level].var())
    assert low < np.sqrt(power / targets[level].var()) < high


def test_an_exemplar_with_a_direction_says_that_no_solid_has_it() -> None:
    rows = as_exemplar(np.tile(np.random.Generator(np.random.PCG64(2)).random((64, 1)), (1, 64)))
    (note,) = make(rows, (32, 32, 32), kind="mixed", scales=2, balance=False).notes
    assert re.match(
        r"[1-9][0-9]* of 30 bands are farther from the exemplar's than those of the noise were: ", note
    )
    assert make(rows, (32, 32, 32), scales=2, balance=False).notes == ()


@pytest.mark.parametrize("coarse", [0.0, 1.5])
def test_the_finest_band_of_a_solid_has_more_power_than_that_of_its_slices(coarse: float) -> None:
    """Why bands of solid and slices cannot both be the exemplar's."""
    from texlab_core.transforms import laplacian, solid_laplacian

    noise = np.random.Generator(np.random.PCG64(5)).standard_normal((32, 32, 32)).astype(np.float32)
    volume = noise + coarse * np.roll(noise, 1, 0) + coarse * np.roll(noise, 1, 1) + coarse * np.roll(noise, 1, 2)
    own = float((finish(solid_laplacian.build(volume, 1))[0] ** 2).mean())
    for axes in CUTS.values():
        slices = np.ascontiguousarray(volume.transpose(axes))
        theirs = np.mean([(laplacian.build(each, 1, "periodic")[0] ** 2).mean() for each in slices])
        assert own > 1.02 * theirs


def test_slices_along_all_axes_are_alike(mixed: dict[str, Result]) -> None:
    for result in mixed.values():
        shares = [result.measures[f"w1-slices-{cut}"] for cut in ("xy", "xz", "yz")]
        assert max(shares) < 1.5 * min(shares)


def test_matching_slice_by_slice_leaves_streaks_and_pooling_does_not(mixed: dict[str, Result]) -> None:
    found = {name: streaks(result.volume.mean(-1)) for name, result in mixed.items()}  # type: ignore[union-attr]
    assert found["per-slice"] > 1.8
    assert found["pooled"] < 1.1
    assert found["plain"] < 1.1
    assert abs(found["laplacian"] - 1) < 0.25


def test_streaks_are_what_they_are_called() -> None:
    noise = np.random.Generator(np.random.PCG64(3)).standard_normal((32, 24, 40))
    assert abs(streaks(noise) - 1) < 0.25
    # Coarse within a slice, another one in every slice: streaks across the first axis.
    rows, columns = np.meshgrid(np.arange(24) / 24, np.arange(40) / 40, indexing="ij")
    coarse = np.cos(2 * np.pi * (rows + columns))
    random = np.random.Generator(np.random.PCG64(4)).standard_normal((32, 1, 1))
    assert streaks(noise + random * coarse) > 10
    assert streaks(np.full((8, 8, 8), 0.4)) == 0
    assert streaks(np.ones((1, 1, 1))) == 0


@pytest.mark.parametrize("values", [{}, {"kind": "mixed"}], ids=str)
def test_the_solid_tiles_in_space(values: dict[str, Any]) -> None:
    volume = make(texture(32, 32, 1), (24, 24, 24), **values).volume
    assert volume is not None
    for axis in range(3):
        inside = np.abs(np.diff(volume, axis=axis)).mean()
        across = np.abs(np.take(volume, 0, axis) - np.take(volume, -1, axis)).mean()
        assert across < 1.3 * inside


def test_pooled_slices_match_the_bands_of_all_slices_and_keep_the_coarsest() -> None:
    exemplar = texture(40, 40, 1).pixels
    with crew() as team:
        model = finish(analyze(exemplar, "steerable", 2, 3, "reflect", team)).planes[0]
    slices = np.random.Generator(np.random.PCG64(1)).random((6, 16, 20), dtype=np.float32)
    kept = slices.copy()
    plan = SlicePlan(2, 3, pooled=True)
    matched, distances = finish(match_slices(slices, model, plan, lambda band, each: band))
    np.testing.assert_array_equal(slices, kept)
    pyramids = [steerable.build(each, 2, 3) for each in slices]
    # Brute force: every band of all slices, matched at once, and the pyramids collapsed.
    from texlab_core.stats.histogram import match_ranks

    replaced: dict[BandKey, np.ndarray] = {}
    for index, key in enumerate(plan.keys((16, 20))):
        pooled = np.stack([dict(pyramid.items())[key] for pyramid in pyramids])
        replaced[key] = match_ranks(pooled, model.bands[key].sample, index)
        moved = np.abs(replaced[key] - pooled).mean() / model.bands[key].spread
        assert distances[index] == pytest.approx(moved, rel=1e-3, abs=1e-5)
    for number, pyramid in enumerate(pyramids):
        rows = tuple(
            tuple(replaced[BandKey("oriented", level, index)][number] for index in range(3)) for level in range(2)
        )
        together = steerable.SteerablePyramid(replaced[BandKey("highpass")][number], rows, pyramid.lowpass)
        np.testing.assert_allclose(matched[number], steerable.collapse(together), atol=2e-3)


def test_a_constant_exemplar_makes_a_constant_solid() -> None:
    result = make(as_exemplar(np.full((8, 8, 3), (0.1, 0.5, 0.7), np.float32)), (5, 6, 7))
    np.testing.assert_array_equal(result.volume, np.broadcast_to(np.float32([0.1, 0.5, 0.7]), (5, 6, 7, 3)))
    assert result.notes == ("The exemplar is constant, and so is the result.",)


def test_fewer_scales_are_said() -> None:
    (note,) = make(texture(16, 16), (4, 32, 32), scales=4).notes
    assert "1 of 4 scales" in note
    assert "32 x 32 x 4" in note


def test_sides_and_memory_are_limited_before_the_start(monkeypatch: pytest.MonkeyPatch) -> None:
    exemplar = texture(16, 16)
    with pytest.raises(InputError, match="at most 256 voxels a side, got '257 x 9 x 8'") as caught:
        make(exemplar, (8, 9, 257))
    check_sentence(str(caught.value), "the refusal")
    monkeypatch.setattr(estimates, "machine_bytes", lambda: 10**8)
    with pytest.raises(InputError, match=r"of 128 x 128 x 128 needs about 0\.\d GB .* has 0\.1 GB") as caught:
        make(exemplar, (128, 128, 128))
    check_sentence(str(caught.value), "the refusal")
    monkeypatch.setattr(estimates, "machine_bytes", lambda: None)
    assert Job(method="solid", inputs={"exemplar": exemplar}, size=(128, 128, 128)).size == (128, 128, 128)


def test_the_estimate_grows_with_what_there_is_to_do() -> None:
    assert METHOD.estimate is not None
    inputs, gray = {"exemplar": texture(8, 8)}, {"exemplar": texture(8, 8, 1)}
    small = METHOD.estimate(inputs, METHOD.params(), (32, 32, 32))
    large = METHOD.estimate(inputs, METHOD.params(), (64, 64, 64))
    assert large.seconds == pytest.approx(8 * small.seconds)
    assert large.nbytes == 8 * small.nbytes
    mixed = METHOD.estimate(inputs, METHOD.params(kind="mixed"), (32, 32, 32))
    assert mixed.seconds > small.seconds
    assert mixed.nbytes > small.nbytes
    assert METHOD.estimate(gray, METHOD.params(), (32, 32, 32)).nbytes < small.nbytes
