"""The tab Dependence: histograms of exemplar and results, linked to pixels both ways."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from dock_scenes import check_controls, click, column_of, feed, hover, image_input, noise, scene_of, shown
from mouse import drag
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor

from texlab.docks.dependence.dock import DependenceDock
from texlab.docks.dependence.joint_view import shares
from texlab.docks.dependence.panels import MARKED
from texlab.docks.dependence.ready import FAILURES, choices
from texlab.docks.explain import heeger_bergen
from texlab.state.intentions import LightUp, OpenFailure, OpenLesson, OpenTab, Pin
from texlab.state.scene import Probe, Scene
from texlab.style.theme import DARK, LIGHT
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.errors import ParamError
from texlab_core.findings.failures import examples
from texlab_core.lessons.shelf import bundled
from texlab_core.measures.registry import find_measure
from texlab_core.measures.subject import Subject
from texlab_core.methods.heeger_bergen.method import HeegerBergenParams
from texlab_core.stats.dependence import Pair, dependence

LEFT = Qt.MouseButton.LeftButton
SHIFT = Qt.KeyboardModifier.ShiftModifier
EXEMPLAR, RESULT, OTHER = noise(60, 72, seed=1), noise(64, 56, seed=2), noise(64, 64, 1, seed=3)


class Hand:
    """The dock with a scene; what it asks is answered at once."""

    def __init__(self, qtbot: Any) -> None:
        self.qtbot = qtbot
        self.dock = shown(qtbot, DependenceDock(), 1200, 260)
        self.intended: list[Any] = []
        self.dock.intention.connect(self.intended.append)
        self.scene = scene_of(
            column_of(RESULT, title="First"),
            column_of(OTHER, column_id=2, title="Second", method="msg"),
            exemplar=EXEMPLAR,
        )
        self.dock.asks.connect(self.feed)
        self.feed()

    def feed(self) -> Any:
        return feed(self.dock, self.scene)

    def choose(self, box: Any, value: Any) -> None:
        index = box.findData(value)
        assert index >= 0
        box.setCurrentIndex(index)
        box.activated.emit(index)

    def joint(self, place: int) -> Any:
        return self.dock.views[place].joint

    def at(self, place: int, row: int, column: int) -> QPoint:
        return self.joint(place).cell_rect(row, column).center().toPoint()


@pytest.fixture
def hand(qtbot: Any) -> Hand:
    return Hand(qtbot)


def bright(picture: Any) -> Any:
    return (picture == MARKED).all(axis=2)


def test_controls(hand: Hand) -> None:
    check_controls(hand.dock)
    for view in hand.dock.views:
        assert view.joint.accessibleName()
        assert view.joint.toolTip()
        assert view.pane.accessibleName()


def test_the_numbers_are_those_of_the_measure(hand: Hand) -> None:
    titles = [view.title.text() for view in hand.dock.views]
    exemplar = dependence(EXEMPLAR, Pair())
    assert titles[0] == f"Exemplar: {exemplar.information:.3f} bits"
    for image, name, title in ((RESULT, "First", titles[1]), (OTHER, "Second", titles[2])):
        expected = find_measure("dependence-difference").of(Subject.of_images(EXEMPLAR, image))
        assert title.startswith(f"{name}: ")
        assert title.endswith(f"bits, dependence {expected:.3f}")
    hand.choose(hand.dock.orientation, 1)
    assert "dependence of this pair" in hand.dock.views[1].title.text()
    assert hand.dock.pair_name.text() == "Upwards: level 0, 45°. To the right: the parent at level 1."


def test_controls_say_which_pair_and_only_those_that_matter_are_seen(hand: Hand) -> None:
    dock = hand.dock
    assert dock.pair == Pair()
    assert not dock.turn.isVisible()
    hand.choose(dock.relation, "orientation")
    hand.choose(dock.turn, 3)
    assert dock.pair == Pair("orientation", turn=3)
    assert dock.turn.isVisible()
    hand.choose(dock.relation, "neighbour")
    dock.right.setValue(-2)
    dock.down.setValue(4)
    assert dock.pair == Pair("neighbour", offset=(4, -2))
    assert dock.right.isVisible()
    assert not dock.turn.isVisible()
    np.testing.assert_array_equal(
        hand.joint(1).found.joint, dependence(RESULT, dock.pair, "coefficients", hand.joint(0).found).joint
    )
    dock.right.setValue(0)
    dock.down.setValue(0)
    assert dock.message == "A place and itself are always the same: choose a neighbour, x or y other than 0."
    dock.down.setValue(1)
    assert dock.message is None


def test_dragging_over_cells_shows_their_pixels_everywhere(hand: Hand) -> None:
    drag(hand.qtbot, hand.joint(0), [hand.at(0, 14, 15), hand.at(0, 16, 17), hand.at(0, 18, 20)])
    rectangle = (14, 18, 15, 20)
    for view in hand.dock.views:
        assert view.joint.brush == rectangle
        np.testing.assert_array_equal(bright(view.pane.picture), view.panel.found.pixels(rectangle))
        assert bright(view.pane.picture).any()
    joint = hand.joint(1).found.joint
    assert f"First {joint[14:19, 15:21].sum():.2%}" in hand.dock.pair_name.text()
    # Backwards, and beyond the histogram, from another one.
    view = hand.joint(2)
    drag(hand.qtbot, view, [hand.at(2, 3, 4), QPoint(0, view.height())])
    assert hand.joint(0).brush == (0, 3, 0, 4)
    assert "Rows 1 to 4, columns 1 to 5 are chosen" in view.accessibleDescription()
    # One cell, and the same again.
    for brush in ((5, 5, 6, 6), None):
        hand.qtbot.mouseClick(view, LEFT, pos=hand.at(2, 5, 6))
        assert hand.joint(1).brush == brush
    np.testing.assert_array_equal(hand.dock.views[0].pane.picture, hand.dock.answer[0].picture)
    assert not bright(hand.dock.views[0].pane.picture).any()


def test_the_pixels_light_up_in_the_columns_while_the_tab_is_seen(hand: Hand) -> None:
    def lit() -> Any:
        return [each for each in hand.intended if isinstance(each, LightUp)][-1].places

    assert not [each for each in hand.intended if isinstance(each, LightUp)]
    drag(hand.qtbot, hand.joint(0), [hand.at(0, 14, 15), hand.at(0, 18, 20)])
    images = [hand.scene.exemplar.pixels, *(each.result.image for each in hand.scene.columns)]
    assert [each.column_id for each in lit()] == [0, *(each.id for each in hand.scene.columns)]
    for each, image, view in zip(lit(), images, hand.dock.views, strict=True):
        assert each.image is image
        pixels = view.panel.found.pixels((14, 18, 15, 20))
        assert pixels.any()
        np.testing.assert_array_equal((each.veil == (*MARKED, 255)).all(axis=2), pixels)
        # What is not chosen stays to be seen.
        assert 0 < each.veil[~pixels][:, 3].max() < 255
    hand.dock.set_seen(False)
    assert lit() == ()
    hand.dock.set_seen(True)
    assert len(lit()) == 3
    # A stage of a run is not what the column shows.
    scene = hand.scene
    stage = SimpleNamespace(name="s", picture=np.zeros((64, 56, 3), np.uint8), values=lambda _: RESULT)
    hand.scene = replace(scene, stage=stage)
    hand.feed()
    assert [each.column_id for each in lit()] == [0, scene.columns[1].id]
    hand.scene = scene
    hand.feed()
    assert len(lit()) == 3
    hand.joint(0).setFocus()
    hand.qtbot.keyClick(hand.joint(0), Qt.Key.Key_Escape)
    assert lit() == ()
    hand.qtbot.keyClick(hand.joint(0), Qt.Key.Key_Up)
    assert len(lit()) == 3
    hand.dock.present_nothing("There is no exemplar.")
    assert lit() == ()


def test_keys_choose_cells(hand: Hand) -> None:
    view = hand.joint(1)
    view.setFocus()
    hand.qtbot.keyClick(view, Qt.Key.Key_Up)
    assert view.brush == (16, 16, 16, 16)
    hand.qtbot.keyClick(view, Qt.Key.Key_Up)
    hand.qtbot.keyClick(view, Qt.Key.Key_Left)
    assert hand.joint(0).brush == (17, 17, 15, 15)
    for key in (Qt.Key.Key_Right, Qt.Key.Key_Right, Qt.Key.Key_Down):
        hand.qtbot.keyClick(view, key, SHIFT)
    assert hand.joint(2).brush == (16, 17, 15, 17)
    hand.qtbot.keyClick(view, Qt.Key.Key_Escape)
    assert hand.joint(0).brush is None
    assert view.accessibleDescription() == "No cells are chosen"
    # Other axes have other cells.
    hand.qtbot.keyClick(view, Qt.Key.Key_Down)
    hand.choose(hand.dock.values, "ranks")
    assert hand.joint(0).brush is None
    assert hand.joint(0).found.joint.shape == (8, 8)
    for _ in range(12):
        hand.qtbot.keyClick(view, Qt.Key.Key_Down)
    assert view.brush == (0, 0, 3, 3)


def test_a_pixel_marks_its_cells(hand: Hand, qtbot: Any) -> None:
    hand.choose(hand.dock.orientation, 2)
    pane, joint = hand.dock.views[1].pane, hand.joint(1)
    hover(qtbot, pane, 30, 25)
    assert joint.cells == joint.found.cells(30, 25)
    assert len(joint.cells) == 1
    hover(qtbot, pane, 2, 25)
    assert joint.cells == ()
    # The pixel that is pointed at in the window.
    scene = hand.scene
    probe = Probe(1, 33, 20, pinned=True)
    hand.scene = Scene(scene.exemplar, scene.columns, 1, probe)
    hand.feed()
    assert joint.cells == joint.found.cells(33, 20)
    assert hand.joint(0).cells == hand.joint(2).cells == ()
    click(qtbot, pane, 31, 22)
    click(qtbot, hand.dock.views[0].pane, 31, 22)
    assert hand.intended == [Pin(1, 31, 22)]


def test_the_pointer_on_a_cell_tells_what_it_holds(hand: Hand, qtbot: Any) -> None:
    qtbot.mouseMove(hand.joint(0), hand.at(0, 16, 16))
    found = hand.joint(0).found
    assert hand.dock.readout.text() == (
        "given -0.12 to 0.12, looked at -0.12 to 0.12 (in standard deviations): "
        f"{found.joint[16, 16]:.2%} of all, {found.conditional[16, 16]:.1%} of the column"
    )
    qtbot.mouseMove(hand.joint(0), QPoint(1, 1))
    assert hand.dock.readout.text() == ""


def test_which_column_stands_beside(hand: Hand) -> None:
    dock = hand.dock
    items = [dock.beside.itemText(k) for k in range(dock.beside.count())]
    assert items == ["beside: another method", "no other column", "beside: Second"]
    hand.choose(dock.beside, 0)
    assert [view.isVisible() for view in dock.views] == [True, True, False]
    hand.choose(dock.beside, 2)
    assert dock.views[2].panel.title == "Second"
    third = column_of(RESULT, column_id=3, title="De Bonet", method="de-bonet")
    hand.scene = Scene(hand.scene.exemplar, (*hand.scene.columns, third), 1)
    hand.choose(dock.beside, -1)
    assert dock.views[2].panel.title == "De Bonet"
    # Nothing yet, or too little of it, is left out.
    running = column_of(None, column_id=3, title="De Bonet", method="de-bonet", status="running")
    small = column_of(noise(20, 20), title="First")
    hand.scene = Scene(hand.scene.exemplar, (small, running), 1)
    hand.feed()
    assert [view.isVisible() for view in dock.views] == [True, False, False]
    hand.scene = scene_of(exemplar=None)
    assert hand.feed() is None
    assert dock.message == "There is nothing to show yet."


def test_an_exemplar_that_is_too_small_is_refused_in_one_sentence(hand: Hand) -> None:
    hand.choose(hand.dock.level, 1)
    assert hand.dock.message == "Level 1 needs an exemplar of at least 80 pixels a side; this one has 72 × 60."
    hand.choose(hand.dock.level, 0)
    assert hand.dock.message is None
    # A neighbour that lies beyond what is left of the picture is refused by the core.
    hand.dock.asks.disconnect(hand.feed)
    hand.choose(hand.dock.relation, "neighbour")
    hand.dock.down.setValue(32)
    hand.dock.right.setValue(32)
    with pytest.raises(ParamError, match="offset: must be small enough for the image"):
        hand.dock.question(hand.scene).compute(lambda: False)


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
def test_a_strong_cell_is_painted_strongly(hand: Hand, theme: Any) -> None:
    hand.dock.set_theme(theme)
    hand.dock.curves.setChecked(False)
    for shape in ("joint", "conditional"):
        hand.choose(hand.dock.shape, shape)
        view = hand.joint(0)
        picture = view.grab().toImage()
        strength = shares(view.found, conditional=shape == "conditional")
        places = [np.unravel_index(int(each), strength.shape) for each in (strength.argmin(), strength.argmax())]
        weak, strong = (picture.pixelColor(view.cell_rect(*map(int, each)).center().toPoint()) for each in places)
        background = QColor(theme.window).lightness()
        assert abs(strong.lightness() - background) > abs(weak.lightness() - background) + 60
    assert hand.dock.curves.isEnabled()
    before = hand.joint(0).grab().toImage()
    hand.dock.curves.setChecked(True)
    assert hand.joint(0).grab().toImage() != before


def test_examples_are_all_that_the_papers_show(hand: Hand) -> None:
    known = examples()
    wanted = {
        name
        for name, each in known.items()
        if "Bergen 1995, section 6" in each.why or any(f"De Bonet 1997, fig. {k})" in each.why for k in (2, 3, 4))
    }
    assert wanted == set(FAILURES)
    assert choices()[0][1] in bundled()
    hand.choose(hand.dock.ready, "coral")
    hand.choose(hand.dock.ready, "assignment-a")
    assert hand.intended == [OpenFailure("coral", "de-bonet"), OpenLesson("assignment-a")]
    assert hand.dock.ready.currentText() == "Examples ..."


def test_an_explained_subband_leads_here(hand: Hand, qtbot: Any) -> None:
    params = HeegerBergenParams(scales=2, orientations=6, iterations=1)
    inputs = {"exemplar": image_input(EXEMPLAR)}
    result = run(Job(method="heeger-bergen", inputs=inputs, params=params, size=(64, 64)))
    view = heeger_bergen.HeegerBergenView()
    qtbot.addWidget(view)
    told: list[Any] = []
    view.intention.connect(told.append)
    qtbot.mouseClick(view.dependence, LEFT)
    assert told == []
    view.show_explanation(heeger_bergen.explain_pixel(result, 10, 10))
    titles = [bar.title for bar in view.bars.bars]
    for title, pair in (
        (titles[0], Pair()),
        (next(each for each in titles if "level 1" in each and "90°" in each), Pair(level=1, orientation=2)),
        (titles[-1], Pair(level=2)),
    ):
        view.bars.select(titles.index(title))
        qtbot.mouseClick(view.dependence, LEFT)
        assert isinstance(told[-1], OpenTab)
        assert told[-1].tab == hand.dock.name
        hand.dock.asks.disconnect(hand.feed)
        assert hand.dock.take_settings(dict(told[-1].settings)) == ()
        assert hand.dock.pair == pair
        hand.dock.asks.connect(hand.feed)


def test_the_window_opens_the_tab_as_it_is_wanted(explorer: Any, qtbot: Any) -> None:
    told: list[str] = []
    explorer.controller.problem.connect(told.append)
    explorer.carrier.carry_out(OpenTab("dependence", (("level", 1), ("orientation", 3), ("turns", 1))))
    dock = explorer.hosts["dependence"].dock
    assert dock.pair == Pair(level=1, orientation=3)
    assert explorer.window.front_dock() == "dependence"
    assert told == ["Tab Dependence: turns cannot be set to 1."]
    qtbot.waitUntil(lambda: explorer.idle)
