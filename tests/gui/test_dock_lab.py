"""The laboratory's tab: every experiment shows what the core says, and follows mouse and keys."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import check_controls, column_of, feed, frames, hover, noise, scene_of, shown
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication

from tests.gui.conftest import wait_idle
from texlab.docks import dock_classes
from texlab.docks.lab.dock import PAGES, LabDock
from texlab.docks.lab.page import plane_of
from texlab.state.scene import Probe
from texlab.style.theme import DARK, LIGHT
from texlab.widgets.plain import Label
from texlab.widgets.plane_pane import Path, Spot
from texlab_core.api import synthesize
from texlab_core.errors import Cancelled
from texlab_core.methods.de_bonet import search
from texlab_core.shape.orientation import Orientation
from texlab_core.stats import equalization, representation
from texlab_core.transforms import spots_bars
from texlab_core.transforms.gabor_pair import GaborPair

if TYPE_CHECKING:
    from texlab.docks.lab.page import DragPlane

EXEMPLAR = noise(64, 80, 1)
PLANE = EXEMPLAR[..., 0]


@pytest.fixture
def dock(qtbot: Any) -> LabDock:
    return shown(qtbot, LabDock(), 1100, 300)


def open_page(dock: LabDock, name: str, scene: Any = None) -> Any:
    dock.choose(name)
    return feed(dock, scene_of(exemplar=EXEMPLAR) if scene is None else scene)


def choose(box: Any, value: Any) -> None:
    box.setCurrentIndex(box.findData(value))
    box.activated.emit(box.currentIndex())


def type_number(qtbot: Any, box: Any, text: str) -> None:
    box.setFocus()
    box.selectAll()
    qtbot.keyClicks(box, text)
    qtbot.keyClick(box, Qt.Key.Key_Return)


def drag(qtbot: Any, pane: DragPlane, start: tuple[float, float], end: tuple[float, float]) -> None:
    here, there = (pane.to_widget(*place).toPoint() for place in (start, end))
    qtbot.mousePress(pane.viewport(), Qt.MouseButton.LeftButton, pos=here)
    for share in (0.5, 1.0):
        qtbot.mouseMove(
            pane.viewport(),
            QPoint(*(round(a + share * (b - a)) for a, b in zip(here.toTuple(), there.toTuple(), strict=True))),
        )
    qtbot.mouseRelease(pane.viewport(), Qt.MouseButton.LeftButton, pos=there)


def test_it_is_one_tab_of_the_window_and_its_experiments_are_none() -> None:
    found = dock_classes()
    # Every window asks, and only the first one looks through the folders.
    assert dock_classes() is found
    assert LabDock in found
    assert not set(PAGES) & set(found)
    assert all(page.within == "lab" and page.help and page.title for page in PAGES)


def test_every_experiment_shows_something_in_every_theme(dock: LabDock) -> None:
    result = synthesize(noise(32, 32, 1), "de-bonet", size=(32, 32), alpha=0.5)
    scene = scene_of(replace(column_of(result.image), result=result), exemplar=EXEMPLAR)
    for page in PAGES:
        assert open_page(dock, page.name, scene) is not None
        assert dock.page.message is None
        check_controls(dock.page)
        for theme in (DARK, LIGHT):
            dock.set_theme(theme)


def test_without_an_exemplar_there_is_a_sentence_or_a_picture(dock: LabDock) -> None:
    for page in PAGES:
        answer = open_page(dock, page.name, scene_of())
        assert (answer is None) == (dock.page.message is not None), page.name
        if answer is None:
            assert dock.page.message.endswith("."), page.name


def test_arrow_keys_go_through_the_experiments(dock: LabDock, qtbot: Any) -> None:
    asked = []
    dock.asks.connect(lambda: asked.append(dock.page.name))
    dock.bar.setFocus()
    for _ in PAGES[1:]:
        qtbot.keyClick(dock.bar, Qt.Key.Key_Right)
    assert asked == [page.name for page in PAGES[1:]]


def test_an_answer_goes_to_the_experiment_that_asked(dock: LabDock) -> None:
    dock.choose("lab-filters")
    question = dock.question(scene_of(exemplar=EXEMPLAR))
    answer = question.compute(lambda: False)
    dock.choose("lab-steps")
    dock.present(answer)
    assert dock._pages["lab-filters"].answer is not None
    assert dock.page.answer is None


def test_filters_are_the_core_s_and_follow_scale_and_pointer(dock: LabDock, qtbot: Any) -> None:
    answer = open_page(dock, "lab-filters").answer
    np.testing.assert_array_equal(answer.responses, spots_bars.scaled_responses(PLANE, 1.0))
    page: Any = dock.page
    hover(qtbot, page.pictures.panes[5], 10, 20)
    assert page.readout.text().startswith("bar 90°, 20, 10: ")
    assert page.details.titles[0].text() == "bar 90°"
    type_number(qtbot, page.scale, "3,5")
    answer = feed(dock, scene_of(exemplar=EXEMPLAR)).answer
    np.testing.assert_array_equal(answer.responses, spots_bars.scaled_responses(PLANE, 3.5))


def test_representation_and_its_classes(dock: LabDock, qtbot: Any) -> None:
    pictures, words = open_page(dock, "lab-representation").answer
    expected = representation.represent(PLANE)
    np.testing.assert_array_equal(pictures[5].values, expected.classes)
    assert f"vertical {100 * expected.shares[2]:.0f} %" in words
    page: Any = dock.page
    type_number(qtbot, page.classes, "3")
    pictures, _ = feed(dock, scene_of(exemplar=EXEMPLAR)).answer
    assert pictures[6].title == "k-means, 3"
    assert set(np.unique(pictures[6].values)) == {0, 1, 2}
    assert page.pictures.panes[6].isVisible()


def test_a_gabor_pair_follows_its_numbers(dock: LabDock, qtbot: Any) -> None:
    open_page(dock, "lab-gabor")
    page: Any = dock.page
    type_number(qtbot, page.wavelength, "10")
    type_number(qtbot, page.orientation, "30")
    type_number(qtbot, page.phase, "45")
    pictures = feed(dock, scene_of(exemplar=EXEMPLAR)).answer
    expected = GaborPair(10, 30, 5, 45).respond(PLANE)
    np.testing.assert_allclose(pictures[5].values, expected.magnitude)
    choose(page.view, "local")
    assert not page.wavelength.isVisible()
    local = feed(dock, scene_of(exemplar=EXEMPLAR)).answer
    assert local[1].unit == " px"
    assert local[1].values.shape == PLANE.shape


def test_the_arrow_of_equalization_follows_the_pointer(dock: LabDock, qtbot: Any) -> None:
    answer = open_page(dock, "lab-equalize").answer
    np.testing.assert_allclose(answer.shown[2].values, equalization.cube_root_ramp(), atol=1e-6)
    page: Any = dock.page
    plot = page.plots[0]
    QApplication.processEvents()
    low, high = plot.view.viewRange()[0]
    viewport = plot.graph.viewport()
    place = plot.view.mapViewToScene(plot.view.viewRect().center())
    qtbot.mouseMove(viewport, plot.graph.mapFromScene(place))
    v, share, new = (float(each) for each in re.findall(r"[0-9.]+", page.readout.text()))
    assert low < v < high
    assert share == pytest.approx(100 * (np.floor(v * 255) + 1) / 256, abs=0.1)
    assert new == pytest.approx(np.cbrt(v), abs=0.01)
    assert [len(each._series) for each in page.plots] == [2, 2]
    # Over a pixel of image two the arrow follows its value.
    hover(qtbot, page.pictures.panes[0], 10, 64)
    assert page.readout.text().startswith("v 0.251 ")
    page.plots[0].left.emit()
    assert [len(each._series) for each in page.plots] == [1, 1]


@pytest.mark.parametrize("band", [-1, 2])
def test_any_two_images_are_equalized(dock: LabDock, tmp_path: Any, band: int) -> None:
    from PIL import Image

    path = tmp_path / "gray.png"
    Image.fromarray((PLANE * 255).astype(np.uint8)).save(path)
    column = replace(column_of(noise(40, 40, 1, seed=3)), frames=frames(2))
    scene = scene_of(column, exemplar=EXEMPLAR)
    open_page(dock, "lab-equalize", scene)
    page: Any = dock.page
    names = [page.two.itemText(place) for place in range(page.two.count())]
    assert names[:4] == ["exemplar", "result", "stage: iteration 0", "stage: iteration 1"]
    page.add_file(str(path))
    assert page.two.currentData() == str(path)
    choose(page.band, band)
    for one in ("exemplar", "result", "gallery:stochastic-lava"):
        choose(page.one, one)
        answer = feed(dock, scene).answer
        assert answer.distances[1] < 1e-3 + 0.05 * answer.distances[0]
    choose(page.two, "frame:1")
    choose(page.ties, "together")
    assert np.unique(feed(dock, scene).answer.shown[2].values).size <= 20


def test_a_click_on_the_frequency_plane_chooses_a_band(dock: LabDock, qtbot: Any) -> None:
    answer = open_page(dock, "lab-support").answer
    page: Any = dock.page
    height, width = answer.strongest.shape
    row, column = height // 2, width // 2 + width // 6
    wanted = int(answer.strongest[row, column])
    pane = page.pictures.panes[2]
    QApplication.processEvents()
    qtbot.mouseClick(
        pane.viewport(), Qt.MouseButton.LeftButton, pos=pane.to_widget(row + 0.5, column + 0.5).toPoint()
    )
    assert page.band.currentData() == wanted
    assert "waves along 0°" in page.band.currentText()
    choose(page.kind, "laplacian")
    shown_now = feed(dock, scene_of(exemplar=EXEMPLAR)).answer.shown
    assert page.band.currentText() in shown_now[3].tip


def test_steps_down_and_up(dock: LabDock) -> None:
    down = open_page(dock, "lab-steps").answer
    np.testing.assert_allclose(down[0].values, down[3].values + down[4].values, atol=1e-6)
    page: Any = dock.page
    choose(page.way, "up")
    up = feed(dock, scene_of(exemplar=EXEMPLAR)).answer
    np.testing.assert_allclose(up[2].values, PLANE, atol=1e-6)
    assert not page.pictures.panes[3].isVisible()


def test_counters_of_a_pixel_and_of_its_level(dock: LabDock) -> None:
    result = synthesize(noise(64, 64, 1), "de-bonet", size=(64, 64), alpha=0.5)
    column = replace(column_of(result.image), result=result)
    scene = replace(scene_of(column, exemplar=EXEMPLAR), probe=Probe(1, 13, 22))
    answer = open_page(dock, "lab-keys", scene).answer
    sampling = result.details.sampling
    expected = search.search(sampling, 6, 11, 1)
    assert (answer.here.blank, answer.here.keys, answer.here.hierarchy) == (
        expected.blank,
        expected.keys,
        expected.hierarchy,
    )
    table = dock.page.table
    assert table.item(0, 1).text() == "1024"
    assert table.item(2, 1).text() == str(expected.hierarchy.verified)
    assert answer.whole == search.survey(sampling, 1)
    assert "place 11, 6 has the key" in dock.page.words.text()
    # Without a pixel the level is counted alone.
    alone = feed(dock, scene_of(column, exemplar=EXEMPLAR)).answer
    assert alone.here is None
    assert table.item(0, 1).text() == ""


def test_the_disc_and_the_landscape_are_dragged(dock: LabDock, qtbot: Any) -> None:
    answer = open_page(dock, "lab-plane").answer
    page: Any = dock.page
    truth = Orientation(50, 30)
    assert answer.hypothesis.error(truth) < 5
    QApplication.processEvents()
    drag(qtbot, page.landscape, (0, 0), Orientation(40, 70).disc)
    answer = feed(dock, scene_of(exemplar=EXEMPLAR)).answer
    assert answer.hypothesis.error(Orientation(40, 70)) < 3
    radius = min(answer.view.image.shape) / 3
    x, y = (float(each) * radius for each in Orientation(60, 200).normal[:2])
    drag(qtbot, page.view, (5, 5), (x, y))
    answer = feed(dock, scene_of(exemplar=EXEMPLAR)).answer
    assert answer.hypothesis.slant == pytest.approx(60, abs=4)
    assert answer.hypothesis.tilt == pytest.approx(200, abs=4)
    outlines = [mark for mark in page.view.marks.shown if isinstance(mark, Path) and mark.tint == "chosen"]
    lengths = np.hypot(*np.array(outlines[0].places).T)
    assert lengths.min() / lengths.max() == pytest.approx(
        math.cos(math.radians(answer.hypothesis.slant)), abs=0.01
    )
    spots = [mark for mark in page.landscape.marks.shown if isinstance(mark, Spot)]
    assert len(spots) == 4
    qtbot.mouseClick(page.moments, Qt.MouseButton.LeftButton)
    answer = feed(dock, scene_of(exemplar=EXEMPLAR)).answer
    assert answer.hypothesis == answer.view.moments
    assert "moments (x): slant" in page.words.text()


def test_the_exemplar_is_a_view_or_a_texture(dock: LabDock) -> None:
    stripes = np.broadcast_to(0.5 + 0.4 * np.sin(np.arange(64) * 0.8), (64, 64))[..., None].astype(np.float32)
    open_page(dock, "lab-plane")
    page: Any = dock.page
    choose(page.source, "texture")
    feed(dock, scene_of(exemplar=stripes))
    assert "it is not isotropic" in page.words.text()
    choose(page.source, "view")
    answer = feed(dock, scene_of(exemplar=EXEMPLAR)).answer
    assert answer.view.truth is None
    assert not page.slant.isVisible()
    assert len(answer.shown) == 1
    assert feed(dock, scene_of(exemplar=noise(20, 20, 1))) is None
    assert "at least 32 x 32 pixels" in page.message


@pytest.mark.parametrize(
    ("kind", "pictures", "words"),
    [
        ("orthographic", 4, "one again"),
        ("border", 4, "artefact"),
        ("marks", 1, "mean shape"),
        ("perspective", 1, "no ambiguity"),
        ("counts", 2, "chi-square"),
    ],
)
def test_the_honest_panel(dock: LabDock, qtbot: Any, kind: str, pictures: int, words: str) -> None:
    open_page(dock, "lab-homogeneity")
    page: Any = dock.page
    choose(page.kind, kind)
    first = feed(dock, scene_of()).answer
    assert len(first.shown) == pictures
    assert words in page.words.text()
    qtbot.mouseClick(page.again, Qt.MouseButton.LeftButton)
    second = feed(dock, scene_of()).answer
    assert not np.array_equal(first.shown[0].picture, second.shown[0].picture)


def test_a_plane_whose_horizon_is_seen_is_refused_in_a_sentence(dock: LabDock) -> None:
    open_page(dock, "lab-homogeneity")
    page: Any = dock.page
    choose(page.kind, "perspective")
    page.slant.setValue(75)
    question = dock.question(scene_of())
    with pytest.raises(ValueError, match="horizon stays outside the picture"):
        question.compute(lambda: False)


def test_the_sphere_has_needles(dock: LabDock, qtbot: Any) -> None:
    first = open_page(dock, "lab-sphere").answer
    page: Any = dock.page
    type_number(qtbot, page.window_size, "48")
    wide = feed(dock, scene_of()).answer
    assert wide.words != first.words
    np.testing.assert_array_equal(wide.shown[0].picture, first.shown[0].picture)
    hover(qtbot, page.pictures.panes[1], 192, 192)
    assert "° slant" in page.readout.text()


def test_headings_and_tabs_are_whole_in_a_small_window(qtbot: Any) -> None:
    """A window of 1280 x 800 leaves the tabs below the pictures about 800 pixels."""
    dock = shown(qtbot, LabDock(), 800, 216)
    result = synthesize(noise(32, 32, 1), "de-bonet", size=(32, 32), alpha=0.5)
    scene = scene_of(replace(column_of(result.image), result=result), exemplar=EXEMPLAR)
    assert dock.bar.sizeHint().width() <= dock.bar.width()
    for page in PAGES:
        open_page(dock, page.name, scene)
        QApplication.processEvents()
        for label in dock.page.body.findChildren(Label):
            if label.isVisible() and label.text() and not label.wordWrap():
                assert label.fontMetrics().horizontalAdvance(label.text()) <= label.width(), label.text()


def test_in_the_window_it_asks_in_its_thread_and_follows_a_drag(
    qtbot: Any, open_window: Any, texture: Any
) -> None:
    explorer = open_window(str(texture))
    window = explorer.window
    window.docks["lab"].raise_()
    dock = explorer.hosts["lab"].dock
    for name in ("lab-filters", "lab-plane"):
        dock.choose(name)
        qtbot.waitUntil(lambda: dock.page.answer is not None)
    page: Any = dock.page
    before = page.answer
    qtbot.wait(20)
    drag(qtbot, page.landscape, (0, 0), Orientation(30, 120).disc)
    qtbot.waitUntil(lambda: page.answer.hypothesis.error(Orientation(30, 120)) < 6)
    assert page.answer.view is before.view
    dock.choose("lab-equalize")
    page = dock.page
    qtbot.waitUntil(lambda: page.answer is not None)
    page.add_file("/no/such/picture.png")
    qtbot.waitUntil(lambda: page.message is not None)
    assert "/no/such/picture.png" in page.message or "picture.png" in page.message
    wait_idle(qtbot, explorer)


def test_of_a_large_exemplar_the_middle_is_shown(dock: LabDock) -> None:
    large = np.random.default_rng(0).random((700, 900, 1)).astype(np.float32)
    for name in ("lab-filters", "lab-steps", "lab-support"):
        answer = open_page(dock, name, scene_of(exemplar=large)).answer
        shown_now = answer if isinstance(answer, tuple) else answer.shown
        assert max(max(each.picture.shape[:2]) for each in shown_now) <= 640
    np.testing.assert_array_equal(plane_of(large), large[30:670, 130:770, 0])


def test_long_figures_stop_when_asked(dock: LabDock) -> None:
    for name in ("lab-filters", "lab-homogeneity"):
        dock.choose(name)
        question = dock.question(scene_of(exemplar=noise(72, 72, 1, seed=9)))
        with pytest.raises(Cancelled):
            question.compute(lambda: True)
