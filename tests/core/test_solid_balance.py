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
from texlab_core.methods.heeger_bergen.analysis import Target, analyze
from texlab_core.methods.heeger_bergen.rounds import match
from texlab_core.methods.solid.balance import RISE
from texlab_core.methods.solid.classes import classes_of
from texlab_core.methods.solid.gains import Reach, find_gains
from texlab_core.methods.solid.rounds import AxisModel, Plan
from texlab_core.methods.solid.shapes import Shape, Strengths, distances_of, shape_of, sweep
from texlab_core.methods.solid.slices import CUTS, SlicePlan, Slices
from texlab_core.methods.solid.synthesis import Synthesis
from texlab_core.transforms import solid_laplacian, solid_spectrum
from texlab_core.transforms.luma import luma
from texlab_core.work.tasks import crew, finish

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from texlab_core.engine.inputs import ImageInput
    from texlab_core.engine.result import Result

METHOD = find_method("solid")


def make(exemplar: ImageInput, size: tuple[int, int, int], threads: int = 2, **values: Any) -> Result:
    params = METHOD.params.from_json(values)
    return run(Job(method="solid", inputs={"exemplar": exemplar}, params=params, size=size), threads=threads)


def half_gray(name: str) -> ImageInput:
    return as_exemplar(luma(as_exemplar(f"gallery:{name}", scale=0.5).pixels), name=name)


def brute_force(volume: NDArray[np.float32], model: AxisModel, plan: Plan) -> NDArray[np.float64]:
    """Return W1 / sd of all bands, by sorting."""
    return np.array([finish(match(*each, "exact", 0)) for each in all_bands(volume, model, plan)])


def all_bands(volume: NDArray[np.float32], model: AxisModel, plan: Plan) -> list[tuple[Any, Any]]:
    """Return all bands with their targets."""
    assert plan.slices is not None
    assert model.slices is not None
    own = finish(solid_laplacian.build(volume, plan.levels))
    bands = list(zip(own, (model.solid.bands[key] for key in plan.keys), strict=True))
    for axes in CUTS.values():
        slices = np.ascontiguousarray(volume.transpose(axes))
        whole = Slices.of(slices, plan.slices)
        spectrum = finish(whole.forward(slices))
        bands += [(finish(whole.band(spectrum, k)), model.slices.bands[k]) for k in plan.slices.keys(whole.size)]
    return bands


def bands_of(result: Result) -> np.ndarray:
    return np.array([curve.y for key, curve in result.curves.items() if key.startswith("band-")])


# Stochastic ones, those in which plain rounds move most bands away, and those hardest to balance: two values,
# lines along one side, letters on paper, dots in lines.
CASES = {
    "mixed": (
        "stochastic-granite",
        "quasiperiodic-knit",
        "oriented-canefence",
        "oriented-zebra",
        "inhomogeneous-litbrick",
        "letters-page",
        "letters-darwin",
        "structured-dotlines",
    ),
    "laplacian": ("quasiperiodic-knit", "manmade-ribs", "inhomogeneous-litbrick"),
}


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind, names in CASES.items() for name in names])
def test_every_band_comes_nearer(kind: str, name: str) -> None:
    result = make(half_gray(name), (24, 24, 24), kind=kind, scales=3, iterations=3)
    bands = bands_of(result)
    assert bands.shape == ((4 if kind == "laplacian" else 4 + 3 * 13), 4)
    assert (bands[:, -1] < bands[:, 0]).all()
    assert (np.diff(bands, axis=1) <= RISE * bands[:, :1]).all()
    # Not by standing still.
    assert bands[:, -1].mean() < 0.9 * bands[:, 0].mean()
    assert (np.diff(bands.mean(axis=0)) <= 0).all()
    assert result.notes == ()


def test_every_band_of_each_colour_axis_comes_nearer(monkeypatch: pytest.MonkeyPatch) -> None:
    """Measured by brute force, by sorting, of the very planes that are turned into colours."""
    made: list[Synthesis] = []
    first: dict[int, NDArray[np.float32]] = {}
    start = Synthesis.start

    def watched_start(self: Synthesis) -> Any:
        yield from start(self)
        made.append(self)
        first.update(enumerate(self.planes))

    monkeypatch.setattr(Synthesis, "start", watched_start)
    make(as_exemplar("gallery:structured-dotlines", scale=0.5), (24, 24, 24), kind="mixed", scales=3, iterations=2)
    (work,) = made
    assert len(work.models) == 3
    for axis, model in enumerate(work.models):
        before, after = (brute_force(each[axis], model, work.plan) for each in (first, work.planes))
        assert (after < before).all()


def test_plain_rounds_move_some_away() -> None:
    result = make(half_gray("manmade-ribs"), (24, 24, 24), kind="mixed", scales=3, balance=False)
    bands = [curve.y for key, curve in result.curves.items() if key.startswith("band-")]
    assert max(np.diff(each).max() for each in bands) > 0.1
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


def unmoved(volume: NDArray[np.float32], model: AxisModel, plan: Plan) -> list[Shape]:
    shapes, moved = finish(sweep(volume, model, plan, lambda place, shape: 0.0))
    assert moved is volume
    return shapes


def test_shapes_are_those_of_sorting(setting: tuple[AxisModel, Plan]) -> None:
    model, plan = setting
    volume = np.float32(0.1) * coloured(plan.size)
    shapes = unmoved(volume, model, plan)
    assert len(shapes) == len(plan.labels) == 4 + 3 * 10
    np.testing.assert_allclose(distances_of(shapes), brute_force(volume, model, plan), rtol=1e-3, atol=1e-3)
    for shape, (band, _) in zip(shapes, all_bands(volume, model, plan), strict=True):
        assert shape.variance == pytest.approx(band.var(), rel=1e-2)
        np.testing.assert_allclose(shape.quantiles[[64, 128]], np.quantile(band, [0.252, 0.502]), atol=2e-2)


def test_a_step_of_one_is_matching(setting: tuple[AxisModel, Plan]) -> None:
    model, plan = setting
    volume = np.float32(0.1) * coloured(plan.size)
    # A few samples lie half a rank apart.
    for band, target in [each for each in all_bands(volume, model, plan) if each[0].size > 1000]:
        shape, changes, matched = finish(shape_of(band, target)), band.copy(), band.copy()
        finish(shape.to_changes(changes, 1.0))
        finish(match(matched, target, "exact", 0))
        assert np.abs(band + changes - matched).mean() < 1e-2 * target.spread
        halves = band.copy()
        finish(shape.to_changes(halves, 0.5))
        np.testing.assert_allclose(halves, 0.5 * changes, atol=1e-6)


def test_a_band_of_one_value_is_measured_and_moved() -> None:
    target = Target(np.full(9, 0.25, np.float32), 0.0)
    band = np.full((4, 3, 2), 0.25, np.float32)
    shape = finish(shape_of(band, target))
    assert (shape.distance, shape.variance) == (0, 0)
    finish(shape.to_changes(band, 1.0))
    np.testing.assert_array_equal(band, 0)


def test_classes_foretell_what_a_filter_does_to_all_bands(setting: tuple[AxisModel, Plan]) -> None:
    model, plan = setting
    volume = coloured(plan.size)
    classes = finish(classes_of(plan.size, plan.levels, plan.slices))
    before = Strengths.of(unmoved(volume, model, plan)).variances
    spectrum = finish(solid_spectrum.forward(volume))
    power = finish(classes.power(spectrum))
    assert power.sum() == pytest.approx(volume.var(), rel=1e-4)
    np.testing.assert_allclose(classes.responses @ power, before, rtol=0.25)
    gains = np.random.Generator(np.random.PCG64(3)).uniform(-0.4, 0.4, len(before))
    finish(classes.apply(spectrum, gains))
    filtered = finish(solid_spectrum.inverse(spectrum, plan.size))
    after = Strengths.of(unmoved(filtered, model, plan)).variances
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
    before = distances_of(unmoved(volume, model, plan))
    for place in (1, 6, 20):
        _, moved = finish(sweep(volume, model, plan, lambda at, shape, place=place: float(at == place)))
        after = distances_of(unmoved(moved, model, plan))
        assert after[place] < 0.75 * before[place]
        assert np.median(np.abs(after - before)) < 0.5 * (before - after)[place]


@pytest.mark.parametrize("quarters", range(4))
@pytest.mark.parametrize("size", [(7, 6), (8, 9), (3, 1)])
def test_filtered_half_spectra_are_those_of_numpy(quarters: int, size: tuple[int, int]) -> None:
    from texlab_core.kernels import spectra

    rng = np.random.Generator(np.random.PCG64(6))
    whole = (rng.random((3, 8, 6)) + 1j * rng.random((3, 8, 6))).astype(np.complex64)
    rows, columns = size[0], size[1] // 2 + 1
    response = rng.random((rows, columns), dtype=np.float32)
    places = np.rint(np.fft.fftfreq(rows) * rows).astype(int) % 8
    if rows % 2 == 0:
        places[rows // 2] = 8 - rows // 2
    wanted = np.complex64(1j**quarters) * (whole[:, places, :columns] * response)
    found = np.empty((3, rows, columns), np.complex64)
    spectra.crop(whole, response, quarters, found)
    np.testing.assert_array_equal(found, wanted)
    total, expected = whole.copy(), whole.copy()
    spectra.add(found, response, quarters, total)
    expected[:, places, :columns] += np.complex64(1j**quarters) * (found * response)
    np.testing.assert_array_equal(total, expected)
