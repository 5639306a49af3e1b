"""A stage that is chosen under Steps is what every tab looks at."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from dock_scenes import column_of, feed, noise, scene_of, shown
from PySide6.QtCore import Qt

from tests.gui.conftest import ids, wait_idle
from texlab.docks.bands.histograms import HistogramsDock
from texlab.docks.bands.pyramid import PyramidDock
from texlab.docks.spectral.gabor import GaborDock
from texlab.docks.spectral.spectrum import SpectrumDock
from texlab.state.intentions import ShowStage
from texlab.state.scene import Frame
from texlab.style.pictures import to_picture

TABS = (PyramidDock, HistogramsDock, SpectrumDock, GaborDock)


@pytest.mark.parametrize("channels", [1, 3])
def test_a_stage_as_values_is_its_picture_and_always_the_same_array(channels):
    frame = Frame("iteration 1", to_picture(noise(8, 9, channels)))
    values = frame.values(channels)
    assert values.dtype == np.float32
    assert values.shape == (8, 9, channels)
    assert values is frame.values(channels)
    assert np.array_equal(to_picture(values), frame.picture)


def numbers(answer):
    """Everything in an answer that has numbers, flat."""
    if isinstance(answer, np.ndarray):
        return [answer.astype(np.float64).ravel()] if answer.dtype.kind in "fiu" else []
    if dataclasses.is_dataclass(answer):
        return numbers([getattr(answer, each.name) for each in dataclasses.fields(answer)])
    if isinstance(answer, dict):
        return numbers(list(answer.values()))
    return [part for each in answer for part in numbers(each)] if isinstance(answer, (list, tuple)) else []


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize("kind", TABS, ids=lambda kind: kind.name)
def test_a_tab_shows_a_stage_as_it_shows_a_result_with_these_pixels(qtbot, kind, channels):
    exemplar, result = noise(32, 32, channels), noise(32, 32, channels, seed=2)
    stage = Frame("iteration 1", to_picture(noise(32, 32, channels, seed=3)))
    column = column_of(result, frames=(stage, Frame("iteration 2", to_picture(result))))
    scene = scene_of(column, exemplar=exemplar)
    dock, wanted = shown(qtbot, kind()), []
    dock.intention.connect(wanted.append)
    of_result = numbers(feed(dock, scene))
    assert dock.stage_button.isHidden()
    of_stage = numbers(feed(dock, dataclasses.replace(scene, stage=stage)))
    assert dock.stage_button.isVisible()
    assert dock.stage_button.text() == "Stage: iteration 1 ✕"
    alone = scene_of(column_of(stage.values(channels)), exemplar=exemplar)
    expected = numbers(feed(shown(qtbot, kind()), alone))
    assert len(of_stage) == len(expected) > 0
    assert all(np.array_equal(one, two, equal_nan=True) for one, two in zip(of_stage, expected, strict=True))
    assert any(not np.array_equal(one, two) for one, two in zip(of_stage, of_result, strict=True))
    dock.stage_button.click()
    assert wanted == [ShowStage(1, None)]


def test_the_scrubber_drives_the_tabs_of_the_window(explorer, qtbot):
    first, second = ids(explorer)
    window, controller = explorer.window, explorer.controller
    explorer.session.select(first)
    window.raise_dock("steps")
    wait_idle(qtbot, explorer)
    steps = explorer.hosts["steps"].dock
    qtbot.keyClick(steps, Qt.Key.Key_Home)
    frames = controller.column_scene(first).frames
    assert len(frames) > 1
    assert controller.scene().stage is frames[0]
    for name, host in explorer.hosts.items():
        if issubclass(host.kind, TABS):
            window.raise_dock(name)
            dock = host.dock
            qtbot.waitUntil(dock.stage_button.isVisible)
            wait_idle(qtbot, explorer)
    # It belongs to its column, and to a run that still exists.
    explorer.session.select(second)
    assert controller.scene().stage is None
    explorer.session.select(first)
    assert controller.scene().stage is frames[0]
    explorer.session.set_seed(77)
    wait_idle(qtbot, explorer)
    assert controller.scene().stage is None
