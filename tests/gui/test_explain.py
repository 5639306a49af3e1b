"""The explain dock: whose pixel, which candidates, what is said, and the marks in the exemplar."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from de_bonet_scenes import exemplar, finished, scene
from dock_scenes import check_controls, feed, image_input, shown
from PySide6.QtCore import QPoint, Qt

from tests.gui.conftest import hb, ids, wait_idle
from texlab.columns.workspace import pinned_pixel
from texlab.docks.explain import explainer_for
from texlab.docks.explain.de_bonet import (
    MOST_MARKS,
    explain_pixel,
    feature_words,
    level_pictures,
    spread,
    structure_of,
    summary,
)
from texlab.docks.explain.dock import INVITATION, ExplainDock
from texlab.docks.explain.unexplained import EXPLAINED
from texlab.docks.explain.words import Words
from texlab.state.intentions import Pin, ShowMarks
from texlab.state.scene import Probe
from texlab.style.theme import DARK, LIGHT
from texlab_core.engine.job import Job
from texlab_core.engine.registry import find_method
from texlab_core.engine.run import run
from texlab_core.methods.de_bonet.explain import explain
from texlab_core.methods.de_bonet.params import DeBonetParams

LEFT = Qt.MouseButton.LeftButton
LOOSE = {"alpha": 1.2, "siblings": "parity"}


@pytest.fixture
def column():
    return finished(**LOOSE)


def pixel_with_candidates(column, least=3):
    """Return a pixel with several candidates."""
    counts = column.result.maps["candidates"].data
    row, place = np.argwhere(counts >= least)[0]
    return int(row), int(place)


class Looker:
    """A dock, what it asked of the controller, and the pixel it is asked about."""

    def __init__(self, qtbot, column):
        self.qtbot, self.column = qtbot, column
        self.dock = shown(qtbot, ExplainDock(), 1000, 260)
        self.marks = None
        self.pins = []
        self.dock.intention.connect(self._take)

    def _take(self, intention):
        if isinstance(intention, ShowMarks):
            self.marks = intention.marks
        else:
            assert isinstance(intention, Pin)
            self.pins.append((intention.column_id, intention.row, intention.column))

    def look(self, row, place, *, pinned=False):
        return feed(self.dock, scene(self.column, probe=Probe(1, row, place, pinned)))

    @property
    def view(self):
        return self.dock.sides[0].view


@pytest.fixture
def looker(qtbot, column):
    return Looker(qtbot, column)


def test_controls(looker):
    looker.look(3, 4)
    check_controls(looker.dock)
    for widget in (looker.view.levels, looker.view.structure):
        assert widget.objectName().startswith("explain-")
        assert widget.toolTip()
        assert widget.accessibleName()


def test_without_a_pixel_it_invites(looker):
    assert feed(looker.dock, scene(looker.column)) is None
    assert looker.dock.message == INVITATION


def test_every_level_with_its_candidates(looker, column):
    row, place = pixel_with_candidates(column)
    looker.look(row, place)
    expected = explain(column.result.details.sampling, row, place)
    tiles = looker.view.levels._tiles
    assert len(tiles) == column.result.model.depth + 1
    for tile, level in zip(tiles, expected.levels, strict=True):
        assert np.array_equal(tile.places, level.candidates)
        assert tile.chosen == level.chosen
        assert tuple(tile.places[tile.chosen]) == level.source
    assert tiles[0].note == "copied"
    assert tiles[-1].note == f"{len(expected.at(0).candidates)} candidates"
    assert looker.view.levels.current == (len(tiles) - 1, expected.at(0).chosen)
    assert column.result.maps["candidates"].data[row, place] == len(expected.at(0).candidates)


def test_the_candidates_are_marked_in_the_exemplar(looker, column):
    row, place = pixel_with_candidates(column)
    looker.look(row, place)
    level = explain(column.result.details.sampling, row, place).at(0)
    model = column.result.model
    rows, columns = model.rows[level.candidates[:, 0]], model.columns[level.candidates[:, 1]]
    found = {(mark.top, mark.left) for mark in looker.marks}
    assert found == set(zip(rows.tolist(), columns.tolist(), strict=True))
    assert [mark.role for mark in looker.marks].count("chosen") == 1
    chosen = looker.marks[-1]
    assert chosen.role == "chosen"
    assert (chosen.top, chosen.left) == tuple(column.result.maps["source"].data[row, place])
    feed(looker.dock, scene(looker.column))
    assert looker.marks == ()


def test_marks_go_when_the_dock_is_out_of_sight_and_come_back_with_it(looker):
    looker.look(3, 4)
    marks = looker.marks
    assert marks
    looker.dock.set_seen(False)
    assert looker.marks == ()
    looker.dock.set_seen(True)
    assert looker.marks == marks


def test_what_is_said(column):
    row, place = pixel_with_candidates(column)
    explanation = explain(column.result.details.sampling, row, place)
    near, most = explanation.strictest(1), explanation.strictest()
    words = summary(explanation, 0)
    count = len(explanation.at(0).candidates)
    # Places are those of the map of sources: pixels of the exemplar.
    top, left = column.result.maps["source"].data[row, place]
    assert words.startswith(f"Level 0: {left}, {top}, drawn from {count}")
    top, left, side = explanation.exemplar_box(2, *explanation.at(2).source)
    assert summary(explanation, 2).startswith(f"Level 2: {left}, {top} (4 x 4 px), ")
    assert side == 4
    depth = column.result.model.depth
    for each in (near, most):
        feature = feature_words(explanation.features[each.feature])
        level = depth + 1 - each.k
        tested = explanation.at(level).tested
        assert f"evel {level} (k={each.k}), {feature} excludes {each.excluded} of {tested}" in words
    assert "laid out and not sampled" in summary(explanation, depth)


def test_exclusions_are_counted_right(column):
    """The constraint that excludes most, counted anew over all places that were tested."""
    row, place = pixel_with_candidates(column)
    sampling = column.result.details.sampling
    explanation = explain(sampling, row, place)
    model = column.result.model
    top = explanation.levels[0]
    features = model.levels[model.depth].features
    own = features[model.grid.location(model.depth, *top.source)]
    beyond = (features - own) ** 2 > sampling.thresholds[0]
    assert top.tested == len(features)
    assert explanation.strictest(model.depth).excluded == beyond.sum(axis=0).max()


def test_structures_are_those_of_the_core_and_within_the_limits(column):
    row, place = pixel_with_candidates(column)
    explained = explain_pixel(column.result, row, place)
    explanation = explained.explanation
    names = [each.name for each in explanation.features]
    for index in range(len(explanation.at(0).candidates)):
        structure = structure_of(explained, 0, index)
        order = [names.index(head.first.name) for head in structure.heads]
        assert np.array_equal(structure.pixel, explanation.parent_structure(0)[:, order])
        assert np.array_equal(structure.candidate, explanation.candidate_structure(0, index)[:, order])
        assert np.all((structure.candidate - structure.pixel) ** 2 <= structure.thresholds)
        assert np.all(structure.lowest <= structure.candidate)
        assert np.all(structure.candidate <= structure.highest)
        difference = explanation.differences(0, index)[0, order[2]]
        assert f"D = {difference:.3g}" in structure.describe(0, 2)


def test_all_structures_at_once(column):
    row, place = pixel_with_candidates(column)
    explanation = explain(column.result.details.sampling, row, place)
    for each in explanation.levels[1:]:
        chosen = np.arange(len(each.candidates))
        every = explanation.candidate_structures(each.level, chosen)
        assert np.array_equal(every, [explanation.candidate_structure(each.level, k) for k in chosen])


def test_pictures_are_the_levels_of_the_exemplar(column):
    pictures = level_pictures(column.result)
    model = column.result.model
    assert [picture.shape[:2] for picture in pictures] == [model.grid.shape(k) for k in range(model.depth, -1, -1)]
    shown = exemplar().pixels[np.ix_(model.rows, model.columns)]
    assert np.array_equal(pictures[-1], np.round(shown * 255).astype(np.uint8))


def test_keys_change_level_and_candidate(looker, column):
    row, place = pixel_with_candidates(column)
    looker.look(row, place)
    levels = looker.view.levels
    last = len(levels._tiles) - 1
    before = looker.view.structure.shown
    looker.qtbot.keyClick(levels, Qt.Key.Key_Down)
    assert levels.current[0] == last
    assert levels.current[1] != levels._tiles[last].chosen
    assert "not taken" in looker.view.caption.text()
    assert not np.array_equal(looker.view.structure.shown.candidate, before.candidate)
    assert np.array_equal(looker.view.structure.shown.pixel, before.pixel)
    looker.qtbot.keyClick(levels, Qt.Key.Key_Home)
    assert levels.current[1] == levels._tiles[last].chosen
    looker.qtbot.keyClick(levels, Qt.Key.Key_Left)
    assert levels.current[0] == last - 1
    assert looker.view.structure.shown.pixel.shape[0] == last - 1
    assert looker.marks[-1].height == 2
    looker.look(row, place + 1)
    assert levels.current[0] == last - 1
    for _ in range(last):
        looker.qtbot.keyClick(levels, Qt.Key.Key_Left)
    assert levels.current[0] == 0
    assert looker.view.structure.shown is None


def test_the_mouse_points_at_and_selects_candidates(looker, column):
    row, place = pixel_with_candidates(column)
    looker.look(row, place)
    levels = looker.view.levels
    tile = levels._tiles[-1]
    last, other = len(levels._tiles) - 1, (tile.chosen + 1) % len(tile.places)
    point = levels.place_rect(last, other).center().toPoint()
    looker.qtbot.mouseMove(levels, point)
    assert "not taken" in looker.view.caption.text()
    looker.qtbot.mouseMove(levels, QPoint(2, 2))
    assert "(taken)" in looker.view.caption.text()
    looker.qtbot.mouseClick(levels, LEFT, pos=point)
    assert levels.current == (last, other)
    looker.qtbot.mouseClick(levels, LEFT, pos=levels.tile_rect(1).center().toPoint())
    assert levels.current[0] == 1


def test_many_candidates_are_thinned_but_the_chosen_one_stays():
    marked = spread(50_000, 12_345)
    assert len(marked) <= MOST_MARKS
    assert 12_345 in marked
    assert marked == tuple(sorted(set(marked)))
    assert spread(5, 2) == (0, 1, 2, 3, 4)


def test_a_method_that_cannot_explain_says_so(looker):
    other = dataclasses.replace(looker.column.result, details=None)
    looker.column = dataclasses.replace(looker.column, result=other, method="msg", title="MSG")
    assert looker.look(3, 4) is None
    assert looker.dock.message.startswith("MSG cannot tell why a single pixel is there")
    assert explainer_for(None) is None


def test_a_method_that_explains_says_when_nothing_was_kept(looker):
    other = dataclasses.replace(looker.column.result, details=None)
    looker.column = dataclasses.replace(looker.column, result=other, method="efros-leung", title="Efros-Leung")
    assert looker.look(3, 4) is None
    assert "was not kept; run the column again" in looker.dock.message
    params = find_method("efros-leung").params(reach=32)
    mask = ("mask", image_input(np.zeros((4, 4, 1))))
    looker.column = dataclasses.replace(looker.column, params=params, inputs=(mask,))
    assert looker.look(4, 4) is None
    assert "filled this picture part by part" in looker.dock.message


@pytest.mark.parametrize(
    "name", ["bands", "de-bonet", "efros-leung", "heeger-bergen", "msg", "uncoded", "car", "ac-h"]
)
def test_what_explains_is_known_by_name(name):
    pixels = np.random.default_rng(1).random((32, 32, 1), np.float32)
    result = run(Job(method=name, inputs={"exemplar": image_input(pixels)}, size=(16, 16)))
    assert (explainer_for(result.details) is not None) == (name in EXPLAINED)


def test_while_a_column_runs_its_last_explanation_stays(looker):
    answer = looker.look(3, 4)
    asked = looker.dock.question(scene(looker.column, probe=Probe(1, 3, 4)))
    running = dataclasses.replace(looker.column, result=None, status="running")
    again = looker.dock.question(scene(running, probe=Probe(1, 3, 4)))
    assert again.key == asked.key
    assert looker.dock.answer is answer
    stopped = dataclasses.replace(running, status="cancelled")
    assert looker.dock.question(scene(stopped, probe=Probe(1, 3, 4))) is None


def test_one_pixel_is_explained_in_a_and_b(looker, column):
    """The same place in both, side by side, the levels together; B's marks are dotted."""
    other = finished(column_id=2, alpha=0.4, siblings="parity")
    row, place = pixel_with_candidates(column)
    both = dataclasses.replace(scene(column, other, probe=Probe(2, row, place, True)), compared=(1, 2))
    feed(looker.dock, both)
    looker.dock.repaint()
    one, two = looker.dock.sides
    assert [side.heading.text()[:2] for side in (one, two)] == ["A:", "B:"]
    assert (one.isVisible(), two.isVisible()) == (True, True)
    assert one.geometry().right() < two.geometry().left()
    for side, each in ((one, column), (two, other)):
        expected = explain(each.result.details.sampling, row, place).at(0)
        assert np.array_equal(side.view.levels._tiles[-1].places, expected.candidates)
        # The place of the exemplar that was taken.
        taken = [(mark.top, mark.left) for mark in side.marks if mark.role == "chosen"]
        assert taken == [tuple(each.result.maps["source"].data[row, place])]
        assert {mark.dotted for mark in side.marks} == {side is two}
    assert set(looker.marks) == {*one.marks, *two.marks}
    names = [each.accessibleName() for each in (one.view.levels, two.view.levels)]
    assert names[1] == f"{names[0]}, B"
    looker.qtbot.keyClick(two.view.levels, Qt.Key.Key_Left)
    last = len(one.view.levels._tiles) - 1
    assert [side.view.levels.current[0] for side in (one, two)] == [last - 1, last - 1]
    looker.qtbot.keyClick(one.view.levels, Qt.Key.Key_Left)
    assert [side.view.levels.current[0] for side in (one, two)] == [last - 2, last - 2]
    assert looker.dock.state.text() == "A and B, kept"
    assert [pinned_pixel(both, each)[0].top for each in (1, 2)] == [row, row]
    assert pinned_pixel(both, 3) == ()
    looker.look(row, place)
    assert not two.isVisible()
    assert not one.heading.isVisible()
    assert not any(mark.dotted for mark in looker.marks)


def test_beside_an_explanation_stands_why_the_other_has_none(looker, column):
    waiting = dataclasses.replace(column, id=2, result=None, status="failed", title="Other")
    both = dataclasses.replace(scene(column, waiting, probe=Probe(1, 4, 5)), compared=(1, 2))
    feed(looker.dock, both)
    one, two = looker.dock.sides
    assert (one.reason, two.reason) == (None, "Other has no finished result to explain.")
    small = dataclasses.replace(column.result, image=column.result.image[:40, :30])
    smaller = dataclasses.replace(column, id=2, result=small)
    feed(looker.dock, dataclasses.replace(both, columns=(column, smaller), probe=Probe(1, 50, 5)))
    assert two.reason == "The pixel lies beyond this result, which has 30 x 40 pixels."


def test_a_pixel_beyond_a_draft_is_the_nearest_one(looker):
    explained = looker.look(5000, 4)[0].explained
    assert explained.explanation.pixel == (95, 4)


def test_numbers_choose_the_pixel(looker):
    looker.look(3, 4)
    assert (looker.dock.pixel_row.value(), looker.dock.pixel_column.value()) == (3, 4)
    looker.dock.pixel_row.setValue(10)
    assert looker.pins == [(1, 10, 4)]
    looker.look(10, 4, pinned=True)
    assert "kept" in looker.dock.state.text()
    looker.qtbot.mouseClick(looker.dock.release, LEFT)
    assert looker.pins[-1] == (1, 10, 4)


@pytest.mark.parametrize("size", [(560, 170), (1000, 240), (1900, 420)])
def test_fits_many_sizes_in_both_themes(looker, column, size):
    row, place = pixel_with_candidates(column)
    looker.dock.resize(*size)
    looker.look(row, place)
    pictures = []
    for theme in (LIGHT, DARK):
        looker.dock.set_theme(theme)
        pictures.append(looker.dock.grab().toImage())
    levels = looker.view.levels
    for tile in range(len(levels._tiles)):
        assert levels.rect().adjusted(-1, -1, 1, 1).contains(levels.tile_rect(tile).toRect())
    structure = looker.view.structure
    centre = structure.cell_rect(0, 0).center().toPoint()
    place = structure.mapTo(looker.dock, centre)
    assert pictures[0].pixelColor(2, 2) != pictures[1].pixelColor(2, 2) or pictures[0] != pictures[1]
    assert looker.dock.rect().contains(place)


# In the window.


@pytest.fixture
def explorer(open_window, texture, qtbot):
    made = open_window(str(texture), [("de-bonet", DeBonetParams(alpha=0.8)), hb()])
    made.window.raise_dock("explain")
    wait_idle(qtbot, made)
    return made


def dock_of(explorer):
    return explorer.hosts["explain"].dock


def answered(qtbot, explorer):
    """Wait for the scene, and then for what the docks ask about it."""
    wait_idle(qtbot, explorer)
    wait_idle(qtbot, explorer)


def point_at(qtbot, explorer, column_id, row, column):
    pane = explorer.workspace.columns[column_id].pane
    pane.hovered.emit(row, column)
    answered(qtbot, explorer)
    return pane


def test_pointing_explains_and_marks_and_leaving_clears(explorer, qtbot):
    first, _ = ids(explorer)
    pane = explorer.workspace.columns[first].pane
    where = pane.to_widget(20.5, 30.5).toPoint()
    qtbot.mouseMove(pane.viewport(), where)
    answered(qtbot, explorer)
    dock = dock_of(explorer)
    assert dock.answer is not None
    row, column = dock.answer[0].explained.explanation.pixel
    assert abs(row - 20) <= 1
    assert abs(column - 30) <= 1
    source = explorer.controller.column_scene(first).result.maps["source"].data[row, column]
    marks = explorer.workspace.exemplar.pane._marks
    assert any((place.top(), place.left()) == tuple(source) for place in marks._lines["chosen", False])
    point_at(qtbot, explorer, first, -1, -1)
    assert dock.message == INVITATION
    assert not any(marks._lines.values())


def test_marks_belong_to_the_tab_in_front(explorer, qtbot):
    first, _ = ids(explorer)
    pane = explorer.workspace.columns[first].pane
    qtbot.mouseClick(pane.viewport(), LEFT, pos=pane.to_widget(10.5, 12.5).toPoint())
    answered(qtbot, explorer)
    marks = explorer.workspace.exemplar.pane._marks
    qtbot.waitUntil(lambda: any(marks._lines.values()))
    explorer.window.docks["histograms"].raise_()
    qtbot.waitUntil(lambda: not any(marks._lines.values()))
    explorer.window.docks["explain"].raise_()
    qtbot.waitUntil(lambda: any(marks._lines.values()))
    explorer.window.docks["explain"].close()
    qtbot.waitUntil(lambda: not any(marks._lines.values()))


def test_a_click_keeps_the_pixel_while_the_thresholds_change(explorer, qtbot):
    first, _ = ids(explorer)
    pane = explorer.workspace.columns[first].pane
    qtbot.mouseClick(pane.viewport(), LEFT, pos=pane.to_widget(10.5, 12.5).toPoint())
    point_at(qtbot, explorer, first, 40, 40)
    dock = dock_of(explorer)
    pixel = dock.answer[0].explained.explanation.pixel
    assert abs(pixel[0] - 10) <= 1
    assert pane._marks._lines["chosen", False]
    before = dock.answer
    explorer.window.parameters.form.knobs["alpha"].box.setValue(0.3)
    answered(qtbot, explorer)
    assert dock.answer is not before
    assert dock.answer[0].explained.explanation.pixel == pixel
    assert dock.answer[0].explained.explanation.thresholds == pytest.approx(0.3)
    qtbot.mouseClick(dock.release, LEFT)
    answered(qtbot, explorer)
    assert dock.message == INVITATION
    assert not pane._marks._lines["chosen", False]


def test_words_end_with_an_ellipsis_where_they_have_no_room(qtbot):
    """What is painted is whole lines: nothing of a line that has no room is seen."""
    words = Words("w", "Words", 2)
    qtbot.addWidget(words)
    words.set_theme(LIGHT)
    pictures = []
    for text in ("one two three " * 40, "one two three"):
        words.show_parts((text, "text"))
        words.resize(200, words.sizeHint().height())
        pictures.append(words.grab().toImage())
    long, short = pictures
    spacing = words.fontMetrics().lineSpacing()
    background = short.pixel(0, short.height() - 1)

    def inked(image, top, bottom):
        return any(image.pixel(x, y) != background for x in range(image.width()) for y in range(top, bottom))

    assert inked(long, spacing, 2 * spacing)
    assert not inked(short, spacing, 2 * spacing)
    assert not inked(long, 2 * spacing, long.height())
    # The whole of it is told.
    words.show_parts(("one two three " * 40, "text"))
    assert words.accessibleDescription() == "one two three " * 40
