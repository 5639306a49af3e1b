"""The Gabor dock: answers to waves are known in closed form; the sum is nearly the image; circles, zebra."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from dock_scenes import check_controls, column_of, feed, hover, noise, scene_of, shown
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication

from tests.gui.conftest import wait_idle
from texlab.docks.spectral.gabor import ZEBRA, GaborDock, strongest_filter
from texlab.docks.spectral.gabor_pictures import Pair, strongest
from texlab.style.theme import DARK, LIGHT
from texlab.widgets.plane_pane import Ring
from texlab_core.transforms.gabor import filter_bank, psnr
from texlab_core.transforms.gabor_bank import CENTRES_U, CENTRES_V

if TYPE_CHECKING:
    from texlab.app.explorer import Explorer

SIDE = 64


@pytest.fixture
def dock(qtbot: Any) -> GaborDock:
    return shown(qtbot, GaborDock(), 1000, 240)


def wave(u: float, v: float, amplitude: float = 0.2, phase: float = 0.0) -> Any:
    rows, columns = np.mgrid[:SIDE, :SIDE]
    plane = 0.5 + amplitude * np.cos(2 * np.pi * (u * columns + v * rows) + phase)
    return plane[:, :, None].astype(np.float32)


def choose(box: Any, value: Any) -> None:
    box.setCurrentIndex(box.findData(value))
    box.activated.emit(box.currentIndex())


def test_controls(dock: GaborDock) -> None:
    check_controls(dock)
    choose(dock.view, "local")
    check_controls(dock)


@pytest.mark.parametrize("channel", [4, 9, 14])
def test_a_wave_at_a_centre_comes_through_its_channel_unchanged(dock: GaborDock, channel: int) -> None:
    u, v = float(CENTRES_U[channel]), float(CENTRES_V[channel])
    # The wave must fit the period of the image for the closed form.
    u, v = round(u * SIDE) / SIDE, round(v * SIDE) / SIDE
    exemplar = wave(u, v)
    radius = math.hypot(CENTRES_U[channel], CENTRES_V[channel]) / 3
    gain = 2 ** -((math.hypot(u - CENTRES_U[channel], v - CENTRES_V[channel]) / radius) ** 2)
    choose(dock.channel, channel)
    (even,) = feed(dock, scene_of(exemplar=exemplar)).shown
    assert even.values == pytest.approx(gain * (exemplar[:, :, 0] - 0.5), abs=2e-3)
    choose(dock.part, "odd")
    (odd,) = feed(dock, scene_of(exemplar=exemplar)).shown
    shifted = wave(u, v, phase=-math.pi / 2)[:, :, 0] - 0.5
    assert odd.values == pytest.approx(gain * shifted, abs=2e-3)
    choose(dock.part, "magnitude")
    (magnitude,) = feed(dock, scene_of(exemplar=exemplar)).shown
    assert magnitude.values == pytest.approx(0.2 * gain, abs=2e-3)
    choose(dock.part, "phase")
    (phase,) = feed(dock, scene_of(exemplar=exemplar)).shown
    assert phase.unit == "°"
    # Zero on the middle of the bright stripe at the origin.
    assert phase.values[0, 0] == pytest.approx(0, abs=1)


def test_exemplar_and_result_have_one_scale(dock: GaborDock) -> None:
    choose(dock.part, "magnitude")
    answer = feed(dock, scene_of(column_of(wave(1 / 8, 0, 0.1)), exemplar=wave(1 / 8, 0)))
    first, second = answer.shown
    assert first.scale == second.scale
    assert second.values == pytest.approx(first.values / 2, abs=2e-3)
    assert [title.text() for title in dock.titles[:2]] == [
        "exemplar, 1/8, 0°, magnitude",
        "result, 1/8, 0°, magnitude",
    ]
    assert [part.isVisible() for part in dock._parts] == [True, True, False, False, False]


def test_the_sum_is_beside_the_original_with_its_error(dock: GaborDock) -> None:
    exemplar, result = noise(SIDE, 80, 1), wave(1 / 8, 0.0)
    choose(dock.view, "sum")
    answer = feed(dock, scene_of(column_of(result), exemplar=exemplar))
    original, total, _, smooth = answer.shown
    assert original.values == pytest.approx(exemplar[:, :, 0])
    error = psnr(total.values, original.values)
    assert dock.titles[1].text() == f"sum, {error:.1f} dB"
    # A wave at a centre gets its gain from its own channel and a little from the others.
    assert psnr(smooth.values, result[:, :, 0]) > 25
    assert not dock.channel.isVisible()


def test_residual_and_mean(dock: GaborDock) -> None:
    choose(dock.channel, -1)
    (residual,) = feed(dock, scene_of(exemplar=wave(1 / 4, 0.0))).shown
    assert residual.values == pytest.approx(0.5, abs=1e-3)
    assert not dock.part.isEnabled()


def test_local_frequency_takes_the_strongest_peak_until_one_is_chosen(dock: GaborDock, qtbot: Any) -> None:
    exemplar = wave(0.0, 8 / SIDE)
    assert strongest(exemplar) == Pair(8, 90)
    choose(dock.view, "local")
    answer = feed(dock, scene_of(exemplar=exemplar))
    assert (dock.period.value(), dock.orientation.value()) == (8, 90)
    names = [each.title for each in answer.shown]
    assert names == ["exemplar", "even", "odd", "magnitude", "phase"]
    inner = (slice(16, -16), slice(16, -16))
    assert answer.shown[3].values[inner] == pytest.approx(0.2, rel=0.02)
    assert answer.shown[1].values[inner] == pytest.approx(exemplar[:, :, 0][inner] - 0.5, abs=5e-3)
    dock.orientation.setFocus()
    dock.orientation.selectAll()
    qtbot.keyClicks(dock.orientation, "0")
    qtbot.keyClick(dock.orientation, Qt.Key.Key_Return)
    answer = feed(dock, scene_of(exemplar=exemplar))
    assert answer.request.pair == Pair(8, 0)
    assert np.abs(answer.shown[3].values[inner]).max() < 0.01
    rings = [mark for mark in dock.plane.marks.shown if isinstance(mark, Ring) and mark.tint == "chosen"]
    assert sorted(ring.x for ring in rings) == pytest.approx([-1 / 8, 1 / 8])
    qtbot.mouseClick(dock.strongest, Qt.MouseButton.LeftButton)
    feed(dock, scene_of(exemplar=exemplar))
    assert dock.orientation.value() == 90


def test_a_click_on_a_circle_chooses_its_channel(dock: GaborDock, qtbot: Any) -> None:
    feed(dock, scene_of(exemplar=noise(SIDE, SIDE, 1)))
    QApplication.processEvents()
    for channel, sign in ((13, 1), (10, -1)):
        u, v = sign * float(CENTRES_U[channel]), sign * float(CENTRES_V[channel])
        place = dock.plane.to_widget(u, v).toPoint()
        qtbot.mouseMove(dock.plane.viewport(), place)
        assert "gain 1.00" in dock.readout.text()
        qtbot.mouseClick(dock.plane.viewport(), Qt.MouseButton.LeftButton, pos=place)
        assert dock.channel.currentData() == channel
        rings = [mark for mark in dock.plane.marks.shown if mark.tint == "chosen"]
        assert {(ring.x, ring.y) for ring in rings} == {(u, v), (-u, -v)}
    qtbot.mouseClick(dock.plane.viewport(), Qt.MouseButton.LeftButton, pos=dock.plane.to_widget(0, 0).toPoint())
    assert dock.channel.currentData() == -1


def test_gains_told_are_those_of_the_bank() -> None:
    bank = filter_bank((64, 64))
    for row, column in ((32, 40), (20, 44), (32, 32), (50, 31), (3, 60)):
        u, v = (column - 32) / 64, (row - 32) / 64
        assert strongest_filter(u, v)[1] == pytest.approx(float(bank[row, column]), abs=1e-3)


def test_value_under_the_cursor(dock: GaborDock, qtbot: Any) -> None:
    (even,) = feed(dock, scene_of(exemplar=noise(SIDE, SIDE, 1))).shown
    QApplication.processEvents()
    hover(qtbot, dock.panes[0], 20, 31)
    assert dock.readout.text() == f"exemplar, 1/8, 0°, even, 31, 20: {float(even.values[20, 31]):.4g}"
    assert dock.bar.mark == pytest.approx(float(even.scale.place(even.values[20, 31])))


@pytest.mark.parametrize("shape", [(1, 1, 1), (2, 7, 3), (9, 1, 1)])
def test_tiny_images(dock: GaborDock, shape: tuple[int, int, int]) -> None:
    for view in ("channel", "sum", "local"):
        choose(dock.view, view)
        assert feed(dock, scene_of(column_of(noise(*shape)), exemplar=np.full(shape, 0.5, np.float32)))


def test_both_themes(dock: GaborDock) -> None:
    feed(dock, scene_of(exemplar=noise(SIDE, SIDE)))
    for theme in (DARK, LIGHT):
        dock.set_theme(theme)
        assert dock.panes[0].backgroundBrush().color().name() == theme.canvas


def test_the_zebra_is_one_click_away(qtbot: Any, explorer: Explorer) -> None:
    panel = explorer.window.docks["gabor"]
    panel.show()
    panel.raise_()
    dock = explorer.hosts["gabor"].dock
    assert isinstance(dock, GaborDock)
    qtbot.waitUntil(lambda: dock.answer is not None)
    qtbot.mouseClick(dock.zebra, Qt.MouseButton.LeftButton)
    wait_idle(qtbot, explorer)
    assert explorer.session.state.sample is not None
    assert explorer.session.state.sample.source.name == ZEBRA
    qtbot.waitUntil(lambda: dock.answer is not None and dock.answer.shown[0].values.shape == (256, 256))
    assert dock.answer.request.view == "local"
    # Its stripes stand nearly upright, about 28 pixels apart.
    assert 25 <= dock.period.value() <= 31
    assert dock.orientation.value() <= 20
