"""Growth of Efros-Leung: stopped and gone on with, explained, drafted, refused."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from tests.core.test_efros_leung import image, oracle_for, texture
from texlab_core.engine.inputs import ArraysInput
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled, InputError
from texlab_core.measures.copying import continuous_share
from texlab_core.methods.efros_leung import growth as growth_module
from texlab_core.methods.efros_leung.draft import draft
from texlab_core.methods.efros_leung.explain import explain
from texlab_core.methods.efros_leung.params import EfrosLeungParams
from texlab_core.methods.efros_leung.windows import LARGEST_SUM, Matching, integer_weights, offsets

if TYPE_CHECKING:
    from texlab_core.engine.result import Result
    from texlab_core.engine.steps import Step


def job(
    size: tuple[int, int] = (24, 26), seed: int = 2, *, more: dict[str, Any] | None = None, **params: Any
) -> Job:
    inputs = {"exemplar": image(texture(20, 21, 3))} | (more or {})
    return Job(
        method="efros-leung",
        inputs=inputs,
        params=EfrosLeungParams(**({"window": 7} | params)),
        size=size,
        seed=seed,
    )


def assert_same(one: Result, other: Result) -> None:
    np.testing.assert_array_equal(one.image, other.image)
    for name in one.maps:
        np.testing.assert_array_equal(one.maps[name].data, other.maps[name].data)
    assert one.measures == other.measures


@pytest.fixture
def small_portions(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make every portion so small that single pixels are searched in several."""
    monkeypatch.setattr(growth_module, "PORTION_S", 1e-9)


def stopped(plan: Job, after: int) -> Step | None:
    """Run until the step of the synthesis with this number; return it, or None when the run ended before."""
    steps: list[Step] = []

    def watch(step: Step) -> None:
        if step.phase == "synthesis":
            steps.append(step)

    try:
        run(plan, watch, lambda: len(steps) > after)
    except Cancelled:
        return steps[-1]
    return None


@pytest.mark.parametrize(
    "params",
    [{}, {"shape": "causal"}, {"error_limit": 4.0}, {"criterion": "ncc"}, {"tiles": True, "border": "periodic"}],
    ids=str,
)
@pytest.mark.usefixtures("small_portions")
def test_stopped_anywhere_and_gone_on_is_the_same(params: dict[str, Any]) -> None:
    plan = job(**params)
    whole = run(plan)
    seen = 0
    for after in (3, 40, 77, 150, 400):
        step = stopped(plan, after)
        if step is None or step.state is None:
            continue
        seen += 1
        again = job(more={"state": ArraysInput(step.state(), "state")}, **params)
        assert_same(run(again), whole)
    assert seen >= 2


def test_portions_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = job()
    one = run(plan)
    monkeypatch.setattr(growth_module, "PORTION_S", 1e-9)
    assert_same(run(plan), one)


@pytest.mark.usefixtures("small_portions")
def test_filling_a_hole_goes_on_too() -> None:
    mask = np.zeros((20, 21), np.uint8)
    mask[4:12, 9:13] = 255
    plan = job((20, 21), more={"mask": image(mask)})
    whole = run(plan)
    step = stopped(plan, 6)
    assert step is not None
    assert step.state is not None
    state = ArraysInput(step.state(), "state")
    assert_same(run(job((20, 21), more={"mask": image(mask), "state": state})), whole)


def test_a_larger_image_goes_on_from_what_is_there() -> None:
    small = run(job((12, 14)))
    state = ArraysInput(small.details.state(), "state")
    large = run(job((21, 20), more={"state": state}, anchor="bottom-right", tau=0.0))
    np.testing.assert_array_equal(large.image[-12:, -14:], small.image)
    np.testing.assert_array_equal(large.maps["order"].data[-12:, -14:], small.maps["order"].data)
    assert large.maps["order"].data.max() == 21 * 20 - 9
    known = np.zeros((21, 20), bool)
    known[-12:, -14:] = True
    start = np.rint(large.image * 255).astype(int) * known[..., None]
    expected = oracle_for(large, known, start)
    np.testing.assert_array_equal(large.maps["source"].data[~known], expected.source[~known])
    filled = small.maps["order"].data > 0
    row, column = np.argwhere(filled)[3] + (9, 6)
    assert explain(large.details, int(row), int(column)).earlier
    assert not explain(large.details, 0, 0).earlier


def test_a_finished_state_is_finished() -> None:
    first = run(job((12, 14)))
    again = run(job((12, 14), more={"state": ArraysInput(first.details.state(), "state")}))
    assert_same(first, again)


def test_other_settings_go_on_from_what_is_there() -> None:
    step = stopped(job(), 3)
    assert step is not None
    assert step.state is not None
    arrays = step.state()
    known = arrays["status"] == 1
    result = run(job(more={"state": ArraysInput(arrays, "state")}, window=9, shape="disc"))
    np.testing.assert_array_equal(result.maps["source"].data[known][:, 0], (arrays["source"][known] - 1) // 21)


def test_the_order_depends_on_geometry_alone() -> None:
    one = run(Job(method="efros-leung", inputs={"exemplar": image(texture(20, 21, 3))}, size=(17, 19)))
    other = run(Job(method="efros-leung", inputs={"exemplar": image(texture(22, 18, 1, seed=8))}, size=(17, 19)))
    np.testing.assert_array_equal(one.maps["order"].data, other.maps["order"].data)


def test_layers_grow_outward() -> None:
    order = run(job((15, 17))).maps["order"].data
    rows, columns = np.indices(order.shape)
    layer = np.maximum(np.maximum(6 - rows, rows - 8), np.maximum(7 - columns, columns - 9)).clip(0)
    by_order = layer.ravel()[np.argsort(order.ravel(), kind="stable")]
    assert (np.diff(by_order) >= 0).all()


@pytest.mark.parametrize(
    "params", [{}, {"criterion": "sad", "tau": 30.0}, {"criterion": "ncc"}, {"tiles": True}], ids=str
)
def test_explanations_repeat_the_search(params: dict[str, Any]) -> None:
    result = run(job((12, 13), **params))
    order = result.maps["order"].data
    start = np.rint(result.image * 255).astype(int)
    for row, column in [(0, 0), (5, 8), (11, 12), (4, 9), (6, 2)]:
        told = explain(result.details, row, column, best=5)
        assert told.pixel == (row, column)
        assert not told.given
        oracle = oracle_for(result, np.ones_like(order, bool), start)
        oracle.known = order < order[row, column]
        match_set, smallest = oracle.search(row, column)
        np.testing.assert_array_equal(told.match_set, match_set)
        assert told.d_min == pytest.approx(smallest)
        assert told.chosen == tuple(result.maps["source"].data[row, column])
        assert told.d_min <= told.chosen_distance <= told.limit * (1 + 1e-12)
        assert list(told.distances) == sorted(told.distances)
        assert told.distances[0] == told.d_min
        assert told.weights.sum() == pytest.approx(1)
        assert told.window.shape == (7, 7, 3)
        assert (told.window[told.weights == 0] == 0.5).all() or params.get("tiles")
        if 3 <= row < 9 and 3 <= column < 10:
            known = oracle.known[row - 3 : row + 4, column - 3 : column + 4]
            around = result.image[row - 3 : row + 4, column - 3 : column + 4]
            np.testing.assert_allclose(told.window[known], around[known], atol=1e-6)


def test_a_given_pixel_is_explained_as_given() -> None:
    result = run(job((12, 13)))
    row, column = np.argwhere(result.maps["order"].data == 0)[0]
    told = explain(result.details, int(row), int(column))
    assert told.given
    assert len(told.match_set) == 0
    with pytest.raises(IndexError):
        explain(result.details, 12, 0)


def test_the_level_is_the_exemplar_searched_in_itself() -> None:
    exemplar = texture(11, 12)
    plan = Job(method="efros-leung", inputs={"exemplar": image(exemplar)}, params=EfrosLeungParams(window=5))
    values = exemplar.astype(int)[..., 0]
    places = offsets("square", 5)
    weights = integer_weights(places, 5, "ssd", 1)
    rows, columns = np.mgrid[2:9, 2:10]
    windows = values[rows.ravel()[:, None] + places[:, 0], columns.ravel()[:, None] + places[:, 1]]
    distances = ((windows[:, None] - windows[None]) ** 2 @ weights) / weights.sum()
    np.fill_diagonal(distances, np.inf)
    np.testing.assert_allclose(np.sort(run(plan).model.levels), np.sort(distances.min(axis=1)), rtol=1e-6)


def test_verbatim_copies_are_measured() -> None:
    exemplar = texture(24, 24)
    inputs = {"exemplar": image(exemplar)}
    result = run(
        Job(method="efros-leung", inputs=inputs, params=EfrosLeungParams(window=7, tau=0.0), size=(16, 16))
    )
    exact = result.maps["distance"].data == 0
    filled = result.maps["order"].data > 0
    assert result.measures["exact-share"] == (exact & filled).sum() / filled.sum()
    source = result.maps["source"].data
    assert result.measures["copied-share"] == continuous_share(source)
    assert (
        result.measures["garbage"] == result.measures["window-distance"] / result.measures["own-window-distance"]
    )
    labels = result.maps["copied"].data
    largest = result.maps["source"].data[labels == 1] - np.argwhere(labels == 1)
    assert (largest == largest[0]).all()
    # The seed was copied too.
    assert result.measures["largest-copy"] == (labels == 1).sum() / labels.size
    assert result.curves["distance"].x[-1] == filled.sum()


@pytest.mark.parametrize("channels", [1, 3])
def test_drafts_are_quick_and_made_of_the_exemplar(channels: int) -> None:
    exemplar = texture(30, 31, channels)
    inputs = {"exemplar": image(exemplar)}
    matching = Matching(window=9)
    one, other = (draft(inputs, matching, (40, 30), 3, seconds=60) for _ in range(2))
    np.testing.assert_array_equal(one, other)
    assert one.shape == (40, 30, channels)
    colours = {tuple(pixel) for pixel in exemplar.reshape(-1, channels)}
    assert {tuple(pixel) for pixel in np.rint(one * 255).astype(np.uint8).reshape(-1, channels)} <= colours
    large = draft(inputs, Matching(window=29), (2000, 1000), 3, seconds=60)
    height, width, _ = large.shape
    assert 1.8 < height / width < 2.2
    assert height < 400


def mask(height: int, width: int, *rows: slice) -> Any:
    marks = np.zeros((height, width), np.uint8)
    for each in rows:
        marks[each] = 255
    return image(marks)


@pytest.mark.parametrize(
    ("more", "size", "params", "sentence"),
    [
        (
            {"mask": mask(20, 20)},
            (20, 21),
            {},
            "mask: must have the size of the exemplar, 21 x 20 pixels, got 20 x 20.",
        ),
        ({"mask": mask(20, 21)}, (20, 21), {}, "mask: marks no pixel, so that there is nothing to fill."),
        ({"mask": mask(20, 21, slice(None))}, (20, 21), {}, "covers the whole image"),
        (
            {"mask": mask(20, 21, slice(8, 12))},
            (20, 21),
            {"window": 15},
            "no whole window of 15 x 15 pixels is left",
        ),
        ({"region": mask(20, 21)}, (9, 9), {}, "region: marks no pixel that may be copied."),
        (
            {"region": mask(19, 21)},
            (9, 9),
            {},
            "region: must have the size of the exemplar, 21 x 20 pixels, got 21 x 19.",
        ),
        ({"region": mask(20, 21, slice(0, 2))}, (9, 9), {}, "region: no whole window of 7 x 7 pixels is left"),
        ({"start": mask(9, 9, slice(3))}, (9, 9), {}, "nothing to fill"),
        (
            {"start": mask(9, 9, slice(3))},
            (8, 30),
            {},
            "size: must be at least that of the start image, 9 x 9 pixels",
        ),
        ({}, (9, 9), {"window": 21}, "window: must be at most 19 inside an exemplar of 21 x 20 pixels, got 21."),
        ({"state": ArraysInput({"a": np.zeros(3)}, "x")}, (9, 9), {}, "x is not the state of a growing image."),
    ],
)
def test_what_cannot_work_is_refused_in_one_sentence(
    more: dict[str, Any], size: tuple[int, int], params: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(InputError) as caught:
        job(size, more=more, **params)
    assert sentence in str(caught.value)
    assert str(caught.value).endswith(".")
    assert "\n" not in str(caught.value)


def test_states_of_other_exemplars_and_damaged_ones_are_refused() -> None:
    state = run(job((9, 10))).details.state()
    other = {"exemplar": image(texture(20, 21, 3, seed=9)), "state": ArraysInput(state, "kept")}
    with pytest.raises(InputError, match="belongs to another exemplar"):
        Job(method="efros-leung", inputs=other, size=(9, 10))
    with pytest.raises(InputError, match="at least that of the state, 10 x 9"):
        job((9, 9), more={"state": ArraysInput(state, "kept")})
    for name, broken in {
        "source": state["source"] + 10**6,
        "queue": np.array([10**7], np.int32),
        "values": state["values"][:1],
        "numbers": state["numbers"] + 10**6,
        "status": np.zeros_like(state["status"]),
        "levels": np.array([np.nan, 1.0]),
    }.items():
        with pytest.raises(InputError, match="is damaged"):
            job((9, 10), more={"state": ArraysInput({**state, name: broken}, "kept")})


@pytest.mark.parametrize("window", [3, 5, 15, 41])
def test_windows_are_what_their_names_say(window: int) -> None:
    reach = window // 2
    square = {tuple(offset) for offset in offsets("square", window)}
    assert square == set(itertools.product(range(-reach, reach + 1), repeat=2)) - {(0, 0)}
    causal = {tuple(offset) for offset in offsets("causal", window)}
    assert causal | {(-y, -x) for y, x in causal} == square
    assert not causal & {(-y, -x) for y, x in causal}
    assert len(offsets("cross", window)) == 4 * reach
    disc = offsets("disc", window)
    assert (np.hypot(*disc.T) <= window / 2).all()
    assert len(disc) == pytest.approx(np.pi * window**2 / 4, rel=0.25)


@pytest.mark.parametrize("window", [3, 15, 41])
@pytest.mark.parametrize("channels", [1, 3])
def test_weights_are_exact_and_gaussian(window: int, channels: int) -> None:
    places = offsets("square", window)
    weights = integer_weights(places, window, "ssd", channels)
    assert weights.min() >= 1
    assert int(weights.sum()) * channels * 255**2 < 2**31
    assert weights.sum() * channels > 0.95 * LARGEST_SUM
    gaussian = np.exp(-(places**2).sum(axis=1) / (2 * (window / 6.4) ** 2))
    scale = weights.max() / gaussian.max()
    assert np.abs(weights - np.maximum(scale * gaussian, 1)).max() <= 1
    assert (integer_weights(places, window, "flat-ssd", channels) == 1).all()
