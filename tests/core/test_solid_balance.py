"""Balanced rounds of solids: no band moves away; and what they are made of, against brute force."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from scipy import fft

from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.heeger_bergen.analysis import analyze
from texlab_core.methods.heeger_bergen.rounds import match
from texlab_core.methods.solid.balance import SLACK
from texlab_core.methods.solid.classes import classes_of
from texlab_core.methods.solid.gains import Reach, find_gains
from texlab_core.methods.solid.rounds import AxisModel, Plan
from texlab_core.methods.solid.shapes import measure_shapes, move
from texlab_core.methods.solid.slices import CUTS, SlicePlan, Slices
from texlab_core.transforms import solid_laplacian, solid_spectrum
from texlab_core.transforms.luma import luma
from texlab_core.work.tasks import crew, finish

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.result import Result

METHOD = find_method("solid")


def make(exemplar: ImageInput, size: tuple[int, int, int], threads: int = 2, **values: Any) -> Result:
    params = METHOD.params.from_json({"balance": True, **values})
    return run(Job(method="solid", inputs={"exemplar": exemplar}, params=params, size=size), threads=threads)


def half_gray(name: str) -> ImageInput:
    return as_exemplar(luma(as_exemplar(f"gallery:{name}", scale=0.5).pixels), name=name)


def bands_of(result: Result) -> np.ndarray:
    return np.array([curve.y for key, curve in result.curves.items() if key.startswith("band-")])


# Stochastic ones, and those in which plain rounds move most bands away.
CASES = {
    "mixed": ("stochastic-granite", "structured-pebbles", "quasiperiodic-knit", "oriented-canefence"),
    "laplacian": ("quasiperiodic-knit", "manmade-ribs", "inhomogeneous-litbrick"),
}


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind, names in CASES.items() for name in names])
def test_no_band_moves_away(kind: str, name: str) -> None:
    result = make(half_gray(name), (24, 24, 24), kind=kind, scales=3, iterations=3)
    bands = bands_of(result)
    assert bands.shape == ((4 if kind == "laplacian" else 4 + 3 * 13), 4)
    assert (bands[:, -1] < bands[:, 0]).all()
    assert np.diff(bands, axis=1).max() <= SLACK
    # Not by standing still.
    assert bands[:, -1].mean() < 0.8 * bands[:, 0].mean()
    assert result.notes == ()


def test_plain_rounds_move_some_away() -> None:
    result = make(half_gray("manmade-ribs"), (24, 24, 24), kind="mixed", scales=3, balance=False)
    bands = [curve.y for key, curve in result.curves.items() if key.startswith("band-")]
    assert max(np.diff(each).max() for each in bands) > 100 * SLACK
    assert sum(each[-1] > each[0] for each in bands) > 4
    (note,) = result.notes
    assert "farther from the exemplar's than those of the noise" in note


def test_recipes_that_do_not_know_of_it_are_plain() -> None:
    written = METHOD.params().to_json()
    del written["balance"]
    assert METHOD.params.from_json(written).to_json()["balance"] is False


def test_the_number_of_threads_changes_no_bit() -> None:
    exemplar = as_exemplar("gallery:structured-pebbles", scale=0.25)
    one, two = (make(exemplar, (12, 10, 9), threads, scales=1, iterations=1).volume for threads in (1, 2))
    np.testing.assert_array_equal(one, two)


@pytest.mark.parametrize("shape", [(1, 1, 1), (6, 5, 4), (16, 9, 20)])
def test_spectra_are_those_of_scipy_and_come_back(shape: tuple[int, int, int]) -> None:
    volume = np.random.Generator(np.random.PCG64(1)).random(shape, dtype=np.float32)
    spectrum = finish(solid_spectrum.forward(volume))
    np.testing.assert_allclose(spectrum, fft.rfftn(volume, norm="forward"), atol=1e-6)
    np.testing.assert_allclose(finish(solid_spectrum.inverse(spectrum, shape)), volume, atol=1e-6)


@pytest.fixture(scope="module")
def setting() -> tuple[AxisModel, Plan]:
    pixels = half_gray("stochastic-granite").pixels
    with crew() as team:
        own, slices = (finish(analyze(pixels, kind, 3, 3, "reflect", team)) for kind in ("laplacian", "steerable"))
    plan = Plan((24, 20, 32), 3, SlicePlan(3, 3, pooled=True))
    return AxisModel(own.planes[0], slices.planes[0]), plan


def coloured(size: tuple[int, int, int]) -> NDArray[np.float32]:
    """Return noise that is stronger along one axis and at low frequencies."""
    volume = np.random.Generator(np.random.PCG64(2)).standard_normal(size).astype(np.float32)
    volume += 0.8 * np.roll(volume, 1, 2) + 0.5 * np.roll(volume, 1, 1)
    return volume


def test_shapes_are_those_of_matching(setting: tuple[AxisModel, Plan]) -> None:
    model, plan = setting
    volume = np.float32(0.1) * coloured(plan.size)
    shapes = finish(measure_shapes(volume, model, plan))
    assert shapes.distances.shape == (len(plan.labels),) == (4 + 3 * 10,)
    assert plan.slices is not None
    assert model.slices is not None
    own = finish(solid_laplacian.build(volume, 3))
    bands = list(zip(own, (model.solid.bands[key] for key in plan.keys), strict=True))
    for axes in CUTS.values():
        slices = np.ascontiguousarray(volume.transpose(axes))
        whole = Slices.of(slices, plan.slices)
        spectrum = finish(whole.forward(slices))
        bands += [(finish(whole.band(spectrum, k)), model.slices.bands[k]) for k in plan.slices.keys(whole.size)]
    for place, (band, target) in enumerate(bands):
        assert shapes.variances[place] == pytest.approx(band.var(), rel=1e-4)
        np.testing.assert_allclose(
            shapes.quantiles[place][[64, 128]], np.quantile(band, [0.252, 0.502]), atol=2e-2
        )
        assert shapes.distances[place] == pytest.approx(
            finish(match(band, target, "exact", 0)), rel=1e-3, abs=2e-3
        )


def test_classes_foretell_what_a_filter_does_to_all_bands(setting: tuple[AxisModel, Plan]) -> None:
    model, plan = setting
    volume = coloured(plan.size)
    classes = finish(classes_of(plan.size, plan.levels, plan.slices))
    before = finish(measure_shapes(volume, model, plan)).variances
    spectrum = finish(solid_spectrum.forward(volume))
    power = finish(classes.power(spectrum))
    assert power.sum() == pytest.approx(volume.var(), rel=1e-4)
    np.testing.assert_allclose(classes.responses @ power, before, rtol=0.25)
    gains = np.random.Generator(np.random.PCG64(3)).uniform(-0.4, 0.4, len(before))
    finish(classes.apply(spectrum, gains))
    after = finish(measure_shapes(finish(solid_spectrum.inverse(spectrum, plan.size)), model, plan)).variances
    foretold = classes.responses @ (power * np.exp(gains @ classes.responses)) / (classes.responses @ power)
    np.testing.assert_allclose(after / before, foretold, rtol=0.06)


def test_gains_keep_bands_within_their_limits() -> None:
    rng = np.random.Generator(np.random.PCG64(4))
    responses, power = rng.random((6, 200)), rng.random(200)
    held = responses @ power
    low, high = held * np.linspace(0.7, 1.1, 6), held * np.linspace(0.8, 1.3, 6)
    gains = find_gains(responses, power, low, high, (low + high) / 2, held)
    found = responses @ (power * np.exp(gains @ responses))
    # A limit gives way by a hundredth of the band's unit for a gain of 1.
    give = 0.011 * np.abs(gains) * held + 1e-3 * held
    assert (found >= low - give).all()
    assert (found <= high + give).all()
    np.testing.assert_array_equal(find_gains(responses, power, held, held, held, held), 0)


def test_reach_knows_how_strong_a_band_may_be() -> None:
    quantiles = np.linspace(-1, 1, 64)[None]
    reach = Reach.of(quantiles, 2 * quantiles, np.ones(1))
    # At a factor f the distance is |2 - f| / 2.
    assert reach.least == pytest.approx(0, abs=0.02)
    low, high = reach.within(np.array([0.25]))
    assert np.sqrt(low) == pytest.approx(1.5, abs=0.03)
    assert np.sqrt(high) == pytest.approx(2.5, abs=0.03)
    low, high = reach.within(np.array([-1.0]))
    assert low == high


def test_a_band_is_moved_and_the_others_stay(setting: tuple[AxisModel, Plan]) -> None:
    model, plan = setting
    volume = np.float32(0.1) * coloured(plan.size)
    np.testing.assert_allclose(
        finish(move(volume, model, plan, np.zeros(len(plan.labels)), lambda *at: sum(at))), volume, atol=1e-6
    )
    before = finish(measure_shapes(volume, model, plan)).distances
    for place in (1, 6, 20):
        steps = np.zeros(len(plan.labels))
        steps[place] = 1.0
        after = finish(
            measure_shapes(finish(move(volume, model, plan, steps, lambda *at: sum(at))), model, plan)
        ).distances
        assert after[place] < 0.75 * before[place]
        assert np.median(np.abs(after - before)) < 0.5 * (before - after)[place]
