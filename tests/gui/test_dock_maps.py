"""The maps dock: chooser, colours, legends, the value under the cursor."""

import numpy as np
import pytest
from dock_scenes import check_controls, column_of, feed, hover, noise, scene_of, shown
from PySide6.QtCore import Qt

from texlab.docks.maps import MapsDock
from texlab.style import colouring
from texlab.style.theme import DARK, LIGHT
from texlab_core.engine.steps import Map

ROWS, COLUMNS = np.mgrid[:48, :64]


def maps():
    labels = np.zeros((48, 64), np.int32)
    labels[:, :40] = 1
    labels[10:20, 50:60] = 2
    return {
        "source": Map(np.stack([ROWS % 32, COLUMNS % 32], -1).astype(np.int32), "source", "Source"),
        "count": Map((ROWS * 10).astype(np.int32), "count", "Candidates", "candidates"),
        "regions": Map(labels, "label", "Copied regions"),
        "error": Map((COLUMNS / 63).astype(np.float32), "scalar", "Error", "gray"),
    }


@pytest.fixture
def dock(qtbot):
    return shown(qtbot, MapsDock())


@pytest.fixture
def scene():
    return scene_of(column_of(noise(), maps=maps()), exemplar=noise(32, 32))


def choose(dock, scene, name):
    dock.chooser.setCurrentIndex(dock.chooser.findData(name))
    return feed(dock, scene)


def test_controls(dock):
    check_controls(dock)


def test_source_map_in_the_colours_of_its_key(dock, scene, qtbot):
    answer = feed(dock, scene)
    assert [dock.chooser.itemText(k) for k in range(4)] == ["Source", "Candidates", "Copied regions", "Error"]
    assert np.array_equal(answer.picture[5, 40], colouring.source_key(32, 32)[5, 8])
    assert np.array_equal(dock.pane._overlay.image, answer.picture)
    assert dock.key.isVisible()
    hover(qtbot, dock.pane, 5, 40)
    assert dock.readout.text() == "40, 5: from exemplar 8, 5"
    x, y = dock.mark.getData()
    assert (x[0], y[0]) == (8.5, 5.5)
    hover(qtbot, dock.key, 20, 3)
    assert dock.readout.text() == "exemplar 3, 20"


def test_counts_have_a_logarithmic_bar(dock, scene, qtbot):
    feed(dock, scene)
    choose(dock, scene, "count")
    assert dock.bar.isVisible()
    assert dock.unit.text() == "candidates"
    assert [text for _, text in dock.bar.ticks] == ["0", "1", "10", "100", "470"]
    assert dock.bar.ticks[2][0] == pytest.approx(np.log(11) / np.log(471), rel=1e-4)
    hover(qtbot, dock.pane, 47, 3)
    assert dock.readout.text() == "3, 47: 470 candidates"
    assert dock.bar.mark == pytest.approx(1)
    hover(qtbot, dock.pane, 0, 3)
    assert dock.bar.mark == pytest.approx(0)


def test_scalars(dock, scene, qtbot):
    feed(dock, scene)
    answer = choose(dock, scene, "error")
    assert tuple(answer.picture[0, 0]) == colouring.SEQUENTIAL[0]
    assert tuple(answer.picture[0, 63]) == colouring.SEQUENTIAL[-1]
    hover(qtbot, dock.pane, 10, 21)
    assert dock.readout.text() == "21, 10: 0.3333 gray"


def test_regions_are_listed_and_can_be_singled_out(dock, scene, qtbot):
    feed(dock, scene)
    answer = choose(dock, scene, "regions")
    assert [dock.regions.item(k).text() for k in range(2)] == ["1920 px, 62.5%", "100 px, 3.3%"]
    hover(qtbot, dock.pane, 15, 55)
    assert dock.readout.text() == "55, 15: region 2, 100 pixels"
    item = dock.regions.visualItemRect(dock.regions.item(1)).center()
    with qtbot.waitSignal(dock.asks):
        qtbot.mouseClick(dock.regions.viewport(), Qt.MouseButton.LeftButton, pos=item)
    single = feed(dock, scene)
    assert np.array_equal(single.picture[15, 55], answer.picture[15, 55])
    assert single.picture[5, 5].astype(int).sum() < answer.picture[5, 5].astype(int).sum() / 3


def test_opacity_shows_the_result_below(dock, scene, qtbot):
    feed(dock, scene)
    assert np.array_equal(dock.pane.picture, scene.columns[0].picture)
    dock.opacity.setFocus()
    qtbot.keyClick(dock.opacity, Qt.Key.Key_Home)
    assert dock.pane._overlay.opacity() == 0


def test_leaving_the_picture_clears_the_value(dock, scene, qtbot):
    feed(dock, scene)
    hover(qtbot, dock.pane, 5, 5)
    assert dock.readout.text()
    dock.pane.hovered.emit(-1, -1)
    assert dock.readout.text() == ""


def test_a_result_without_maps_says_so(dock):
    assert feed(dock, scene_of(column_of(noise(), title="Heeger-Bergen"), exemplar=noise())) is None
    assert dock.message == "Heeger-Bergen records no maps."
    assert feed(dock, scene_of(column_of(), exemplar=noise())) is None
    assert "records no maps" not in dock.message


def test_themes(dock, scene):
    feed(dock, scene)
    for theme in (DARK, LIGHT):
        dock.set_theme(theme)
        colour = dock.grab().toImage().pixelColor(dock.pane.mapTo(dock, dock.pane.rect().topLeft()) * 1)
        assert colour.name() == theme.canvas


def test_question_follows_result_and_choice(dock, scene):
    first = dock.question(scene).key
    dock.chooser.setCurrentIndex(2)
    assert dock.question(scene).key != first
