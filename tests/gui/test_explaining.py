"""Explanations of pixels: what Efros-Leung matched, what built a pixel of Heeger-Bergen."""

import numpy as np
import pytest
from dock_scenes import column_of, feed, shown
from PySide6.QtCore import Qt

from texlab.docks.explain import efros_leung, explainer_for, heeger_bergen
from texlab.docks.explain.dock import ExplainDock
from texlab.state.intentions import ShowMarks
from texlab.state.scene import Probe, Scene
from texlab.style.pictures import Mark, to_picture
from texlab.style.theme import DARK, LIGHT
from texlab_core.engine.inputs import ImageInput, hash_arrays
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.errors import Cancelled
from texlab_core.images.exemplar import as_exemplar
from texlab_core.methods.efros_leung.explain import explain


def texture(channels=3):
    rows, columns = np.mgrid[:20, :24]
    waves = 0.5 + 0.3 * np.sin(rows / 2) + 0.15 * np.cos(columns / 1.5)
    noise = np.random.default_rng(1).normal(0, 0.02, (20, 24, channels))
    return as_exemplar(np.clip(waves[..., None] + noise, 0, 1).astype(np.float32))


def result_of(method, size=(28, 30), exemplar=None, inputs=None, **values):
    given = {"exemplar": exemplar or texture(), **(inputs or {})}
    params = find_method(method).params.from_json(values)
    return run(Job(method=method, inputs=given, params=params, size=size, seed=3))


@pytest.fixture(scope="module")
def grown():
    return result_of("efros-leung", window=7, tau=6.0)


@pytest.fixture(scope="module")
def matched():
    return result_of("heeger-bergen", scales=2, orientations=4, iterations=1)


def scene(result, row, column, *, pinned=False):
    shown_column = column_of(result.image, title="Stub", method=result.job.method, params=result.job.params)
    made = type(shown_column)(**{**vars(shown_column), "result": result})
    return Scene(result.job.inputs["exemplar"], (made,), 1, Probe(1, row, column, pinned))


@pytest.fixture
def dock(qtbot):
    return shown(qtbot, ExplainDock(), 1000, 280)


def marks_of(dock, qtbot, act):
    """Do something and return the marks that the dock asks for at last."""
    asked = []

    dock.intention.connect(asked.append)
    act()
    last = asked[-1]
    assert isinstance(last, ShowMarks)
    return last.marks


# Efros-Leung.


def pixel_with_choice(result):
    """Return a pixel with several matches, all of them listed."""
    rows, columns = np.nonzero((result.maps["matches"].data > 2) & (result.maps["matches"].data < 9))
    middle = np.hypot(rows - 14, columns - 15).argmax()
    return int(rows[middle]), int(columns[middle])


def test_the_patches_are_the_window_and_its_best_matches(grown):
    row, column = pixel_with_choice(grown)
    found = explain(grown.details, row, column, best=efros_leung.BEST)
    explained = efros_leung.explain_pixel(grown, row, column)
    assert np.array_equal(explained.patches[0].picture, to_picture(found.window))
    assert explained.places[1:] == tuple(map(tuple, found.places.tolist()))
    exemplar = to_picture(grown.job.inputs["exemplar"].pixels)
    compared = found.weights > 0
    for patch, place, distance in zip(explained.patches[1:], explained.places[1:], found.distances, strict=True):
        for down, right in np.argwhere(compared):
            pixel = exemplar[place[0] + down - 3, place[1] + right - 3]
            assert np.array_equal(patch.picture[down, right], pixel)
        assert (patch.frame in ("match", "chosen")) == (distance <= found.limit)
        # The middle shows what would be copied.
        assert np.array_equal(patch.picture[3, 3], exemplar[place])
    chosen = [
        place for patch, place in zip(explained.patches, explained.places, strict=True) if patch.frame == "chosen"
    ]
    assert chosen == [tuple(grown.maps["source"].data[row, column])]
    assert sum(patch.frame in ("match", "chosen") for patch in explained.patches) == len(found.match_set)


def test_what_was_not_compared_is_dimmed_and_what_lies_outside_is_gray():
    exemplar = np.zeros((6, 6, 1), np.float32)
    weights = np.zeros((5, 5), np.float32)
    weights[2, 1] = 1
    inside = efros_leung.around(exemplar, (0, 3), weights, periodic=False)[..., 0]
    assert inside[2].tolist() == pytest.approx([0.4, 0, 0, 0.4, 0.4])
    assert inside[:2] == pytest.approx(np.full((2, 5), 0.5))
    wrapped = efros_leung.around(exemplar, (0, 3), weights, periodic=True)[..., 0]
    assert wrapped[0].tolist() == pytest.approx([0.4] * 5)


def test_words_about_a_growth(grown):
    row, column = pixel_with_choice(grown)
    found = explain(grown.details, row, column)
    words = efros_leung.summary(efros_leung.explain_pixel(grown, row, column))
    top, left = grown.maps["source"].data[row, column]
    assert f"copied from {left}, {top} of the exemplar" in words
    assert f"One of {len(found.match_set)} places up to the limit" in words
    assert f"Filled as pixel {int(grown.maps['order'].data[row, column]):,} of " in words
    assert "tau = 6" in words or "(1 + 0.1) · d_min" in words
    first = np.argwhere(grown.maps["order"].data == 0)[0]
    assert efros_leung.summary(efros_leung.explain_pixel(grown, *first)).startswith("Known from the start: ")


@pytest.mark.parametrize("criterion", ["sad", "ncc"])
@pytest.mark.parametrize("shape", ["square", "causal"])
def test_other_criteria_and_shapes_are_explained(criterion, shape):
    result = result_of("efros-leung", (10, 12), window=5, criterion=criterion, shape=shape, border="periodic")
    for row, column in ((0, 0), (5, 6), (9, 11)):
        explained = efros_leung.explain_pixel(result, row, column)
        assert len(explained.patches) == len(explained.places)
        assert efros_leung.summary(explained)


def test_given_pixels_that_are_not_from_the_exemplar():
    start = np.full((12, 12, 3), 0.5, np.float32)
    hole = np.zeros((12, 12, 1), np.float32)
    hole[4:8, 4:8] = 1
    inputs = {
        name: ImageInput(np.ascontiguousarray(pixels), name, hash_arrays({"pixels": pixels}))
        for name, pixels in (("start", start), ("mask", hole))
    }
    result = result_of("efros-leung", (12, 12), inputs=inputs, window=5)
    explained = efros_leung.explain_pixel(result, 0, 0)
    assert efros_leung.summary(explained) == "Known from the start: given, and not from the exemplar."
    assert efros_leung.marks(explained, 0) == ()
    assert "copied from" in efros_leung.summary(efros_leung.explain_pixel(result, 5, 5))


def test_the_dock_shows_matches_and_outlines_them(dock, grown, qtbot):
    row, column = pixel_with_choice(grown)
    found = explain(grown.details, row, column)
    marks = marks_of(dock, qtbot, lambda: feed(dock, scene(grown, row, column)))
    roles = [mark.role for mark in marks]
    assert roles == ["candidate"] * len(found.match_set) + ["window", "chosen"]
    top, left = (int(part) for part in found.chosen)
    assert marks[-1] == Mark(top, left, 1, 1, "chosen")
    assert marks[-2] == Mark(top - 3, left - 3, 7, 7, "window")
    view = dock.sides[0].view
    assert view.words.text() == efros_leung.summary(efros_leung.explain_pixel(grown, row, column))
    other = next(index for index, patch in enumerate(view.grid.patches) if patch.frame == "match")
    place = view._explained.places[other]

    def click():
        qtbot.mouseClick(view.grid, Qt.MouseButton.LeftButton, pos=view.grid.part_rect(other).center().toPoint())

    marks = marks_of(dock, qtbot, click)
    assert marks[-2] == Mark(place[0] - 3, place[1] - 3, 7, 7, "window")
    assert "could have been copied" in view.words.text()
    for theme in (DARK, LIGHT):
        dock.set_theme(theme)
        dock.grab()


# Heeger-Bergen.


def test_bars_add_up_to_the_pixel(matched):
    plane = heeger_bergen.luma(matched.image)
    for row, column in ((0, 0), (13, 29), (27, 4)):
        explained = heeger_bergen.explain_pixel(matched, row, column)
        assert explained.value == pytest.approx(plane[row, column], abs=1e-5)
        assert sum(bar.value for bar in explained.bars) == pytest.approx(
            plane[row, column] - plane.mean(), abs=1e-5
        )
    assert [bar.group for bar in explained.bars] == ["high", *["level 0"] * 4, *["level 1"] * 4, "low"]
    assert [bar.label for bar in explained.bars[1:5]] == ["0°", "45°", "90°", "135°"]
    assert f"Luma {explained.value:.3f}" in heeger_bergen.summary(explained)


@pytest.mark.parametrize("pyramid", ["laplacian", "textbook"])
def test_laplacian_bands_have_one_bar_per_level(pyramid):
    result = result_of("heeger-bergen", exemplar=texture(1), scales=2, iterations=1, pyramid=pyramid)
    explained = heeger_bergen.explain_pixel(result, 5, 7)
    assert [bar.group for bar in explained.bars] == ["level 0", "level 1", "low"]
    assert explained.value == pytest.approx(result.image[5, 7, 0], abs=1e-5)


def test_a_picture_is_taken_apart_once(matched):
    first, second = (heeger_bergen.explain_pixel(matched, row, 3) for row in (2, 9))
    assert first.built is second.built
    assert [picture.shape for picture in first.built.pictures] == [(28, 30, 3)] * len(first.bars)


def test_large_pictures_are_sampled(matched, monkeypatch):
    monkeypatch.setattr(heeger_bergen, "MOST_PIXELS", 200)
    built = heeger_bergen.take_apart(matched)
    assert built.step == 3
    assert built.pictures[0].shape == (10, 10, 3)
    whole = heeger_bergen.explain_pixel(matched, 0, 0).built
    assert np.array_equal(built.pictures[0], whole.pictures[0][::3, ::3])


def test_the_dock_shows_bars_and_the_picture_of_the_chosen_one(dock, matched, qtbot):
    answer = feed(dock, scene(matched, 4, 6))
    explained = answer[0].explained
    view = dock.sides[0].view
    strongest = max(range(len(explained.bars)), key=lambda index: abs(explained.bars[index].value))
    assert view.bars.selected == strongest
    assert np.array_equal(view.pane.picture, explained.built.pictures[strongest])
    qtbot.mouseClick(view.bars, Qt.MouseButton.LeftButton, pos=view.bars.bar_rect(2).center().toPoint())
    assert view.title.text() == "Level 0, waves along 45°"
    assert np.array_equal(view.pane.picture, explained.built.pictures[2])
    # The subband that was looked at stays from pixel to pixel.
    feed(dock, scene(matched, 9, 9))
    assert view.bars.selected == 2
    points = view.spot.data
    assert (points["x"][0], points["y"][0]) == (9.5, 9.5)
    for theme in (DARK, LIGHT):
        dock.set_theme(theme)
        dock.grab()


def test_every_kind_finds_its_explainer(grown, matched):
    assert explainer_for(grown.details) is efros_leung.EXPLAINER
    assert explainer_for(matched.details) is heeger_bergen.EXPLAINER


def test_nobody_waits_for_a_picture_to_be_taken_apart():
    result = result_of("heeger-bergen", exemplar=texture(1), scales=2, iterations=1)
    asked = []

    def total(stop_at):
        asked.clear()

        def should_stop():
            asked.append(1)
            return len(asked) == stop_at

        return should_stop

    heeger_bergen.take_apart(result, total(0))
    many = len(asked)
    # Every subband is asked for at least twice: when it is found, and when it is painted.
    assert many > 2 * 10
    for count in (1, many // 2, many):
        with pytest.raises(Cancelled):
            heeger_bergen.EXPLAINER.explain(result, 3, 4, total(count))
        assert len(asked) == count
    # What was stopped is not kept: the next one is answered in full.
    explained = heeger_bergen.EXPLAINER.explain(result, 3, 4, total(0))
    assert explained.value == pytest.approx(result.image[3, 4, 0], abs=1e-5)
