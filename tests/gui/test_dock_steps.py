"""The scrubber: slider, keys, playing, and no timer left behind."""

from dataclasses import replace

import numpy as np
import pytest
from dock_scenes import check_controls, column_of, feed, frames, hover, noise, scene_of, shown
from PySide6.QtCore import Qt

from texlab.docks.steps import StepsDock
from texlab.state.intentions import ShowStage


@pytest.fixture
def dock(qtbot):
    return shown(qtbot, StepsDock())


def scene(count, column_id=1):
    kept = frames(6)[:count]
    column = column_of(noise(), column_id=column_id, frames=kept)
    return scene_of(column, selected=column_id)


def test_controls(dock):
    check_controls(dock)


def test_starts_at_the_last_stage_and_follows_a_run(dock):
    kept = frames(6)
    for count in (1, 2, 3):
        feed(dock, scene_of(column_of(frames=kept[:count])))
        assert dock.label.text() == f"iteration {count - 1}   {count} of {count}"
        assert np.array_equal(dock.pane.picture, kept[count - 1].picture)


def test_keys_scrub(dock, qtbot):
    feed(dock, scene(6))
    dock.setFocus()
    for key, expected in (
        (Qt.Key.Key_Home, 0),
        (Qt.Key.Key_Right, 1),
        (Qt.Key.Key_Right, 2),
        (Qt.Key.Key_Left, 1),
        (Qt.Key.Key_End, 5),
        (Qt.Key.Key_Right, 5),
    ):
        qtbot.keyClick(dock, key)
        assert dock.slider.value() == expected
        assert dock.pane.picture[0, 0, 0] == 10 * expected + 5


def test_the_slider_itself_takes_keys(dock, qtbot):
    feed(dock, scene(6))
    dock.slider.setFocus()
    qtbot.keyClick(dock.slider, Qt.Key.Key_Left)
    assert dock.label.text().startswith("iteration 4")


def test_a_scrubber_that_was_moved_stays(dock):
    kept = frames(6)
    feed(dock, scene_of(column_of(noise(), frames=kept[:4])))
    dock.slider.setValue(1)
    # The window hands the chosen stage to all tabs.
    feed(dock, replace(scene_of(column_of(noise(), frames=kept)), stage=kept[1]))
    assert dock.slider.value() == 1
    feed(dock, scene(3, column_id=2))
    assert dock.slider.value() == 2
    feed(dock, replace(scene_of(column_of(noise(), frames=kept)), stage=kept[1]))
    assert dock.slider.value() == 1
    # Another tab has gone back to the result.
    feed(dock, scene_of(column_of(noise(), frames=kept)))
    assert dock.slider.value() == 5
    assert np.array_equal(dock.pane.picture, kept[5].picture)


def test_a_stage_that_is_chosen_is_wanted_everywhere_and_the_last_is_the_result(dock):
    kept, wanted = frames(3), []
    dock.intention.connect(wanted.append)
    feed(dock, scene_of(column_of(noise(), frames=kept)))
    assert wanted == []
    for place in (0, 1, 2):
        dock.slider.setValue(place)
    assert wanted == [ShowStage(1, kept[0]), ShowStage(1, kept[1]), ShowStage(1, None)]


def test_play_loops_and_stops_when_hidden(dock, qtbot):
    feed(dock, scene(3))
    dock.speed.setCurrentIndex(dock.speed.findData(10))
    seen = []
    dock.slider.valueChanged.connect(seen.append)
    qtbot.mouseClick(dock.play, Qt.MouseButton.LeftButton)
    assert dock.play.text() == "Pause"
    qtbot.waitUntil(lambda: len(seen) >= 4, timeout=3000)
    assert seen[:4] == [0, 1, 2, 0]
    dock.hide()
    assert not dock.playing
    assert dock.play.text() == "Play"


def test_space_plays_and_pauses_and_a_key_pauses(dock, qtbot):
    feed(dock, scene(3))
    dock.setFocus()
    qtbot.keyClick(dock, Qt.Key.Key_Space)
    assert dock.playing
    qtbot.keyClick(dock, Qt.Key.Key_Space)
    assert not dock.playing
    qtbot.keyClick(dock, Qt.Key.Key_Space)
    qtbot.keyClick(dock, Qt.Key.Key_Left)
    assert not dock.playing


def test_nothing_to_play(dock, qtbot):
    feed(dock, scene(1))
    dock.toggle()
    assert not dock.playing
    assert feed(dock, scene_of(column_of(noise(), title="MSG"))) is None
    assert dock.message == "MSG keeps no stages."


def test_value_under_the_cursor(dock, qtbot):
    feed(dock, scene(3))
    hover(qtbot, dock.pane, 7, 20)
    assert dock.readout.text() == "20, 7   RGB 0.098 0.098 0.098"
