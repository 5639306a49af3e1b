"""The spectrum dock: sinusoids are where they must be, peaks snap to MSG's centres, distances, linked zoom."""

import math

import numpy as np
import pytest
from dock_scenes import check_controls, column_of, feed, image_input, noise, scene_of, shown
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QApplication

from texlab.docks.spectral.spectrum import SpectrumDock
from texlab.style.theme import DARK, LIGHT
from texlab.widgets.plane_pane import Arrow, Ring, Spot
from texlab_core.engine.job import Job
from texlab_core.engine.run import run
from texlab_core.stats.spectrum import QUANTIZATION
from texlab_core.transforms.gabor_bank import CENTRES_U, CENTRES_V

SIDE = 128


@pytest.fixture
def dock(qtbot):
    return shown(qtbot, SpectrumDock(), 1200, 300)


def wave(u, v, *, amplitude=0.25, size=(SIDE, SIDE), sd=0.0):
    rows, columns = np.mgrid[: size[0], : size[1]]
    plane = 0.5 + amplitude * np.cos(2 * np.pi * (u * columns + v * rows))
    plane += np.random.default_rng(1).normal(0, sd, size) if sd else 0
    return plane[:, :, None].astype(np.float32)


def choose(box, value):
    box.setCurrentIndex(box.findData(value))
    box.activated.emit(box.currentIndex())


def marks(pane, kind, **fields):
    found = [mark for mark in pane.marks.shown if isinstance(mark, kind)]
    return [mark for mark in found if all(getattr(mark, name) == value for name, value in fields.items())]


def hover(qtbot, pane, x, y):
    # The layout settles before the place is looked up.
    QApplication.processEvents()
    qtbot.mouseMove(pane.viewport(), pane.to_widget(x, y).toPoint())


def msg_of(image, size=(256, 256)):
    return run(Job(method="msg", inputs={"exemplar": image_input(image)}, size=size, seed=1)).image


def test_controls(dock):
    check_controls(dock)
    assert dock.table.accessibleName()


def test_a_sinusoid_has_its_peak_at_its_frequency(dock):
    u, v = 16 / SIDE, -12 / SIDE
    feed(dock, scene_of(exemplar=wave(u, v, sd=0.01)))
    (row,) = dock.table.rows
    frequency = math.hypot(u, v)
    angle = math.degrees(math.atan2(v, u)) % 180
    assert row.peak.frequency == pytest.approx(frequency, abs=1e-3)
    texts = [dock.table.item(0, column).text() for column in range(6)]
    assert texts[0] == "1"
    assert float(texts[1]) == pytest.approx(frequency, abs=1e-3)
    assert texts[2] == f"{1 / frequency:.1f} px"
    assert float(texts[3].rstrip("°")) == pytest.approx(angle, abs=0.3)
    assert texts[5].startswith("1/8, 135°:")
    spots = marks(dock.panes[0], Spot, tint="exemplar")
    places = sorted((mark.x, mark.y) for mark in spots)
    assert np.array(places) == pytest.approx(np.array(sorted([(u, v), (-u, -v)])), abs=1e-3)


def test_the_value_under_the_cursor_is_the_power_there(dock, qtbot):
    u, v = 16 / SIDE, 8 / SIDE
    feed(dock, scene_of(exemplar=wave(u, v)))
    hover(qtbot, dock.panes[0], u, v)
    # A cosine of amplitude A has |T|^2 / N = A^2 N / 4 at both of its places.
    expected = 10 * math.log10(0.25**2 / 4 * SIDE**2 / QUANTIZATION)
    frequency = math.hypot(u, v)
    where = f"{frequency:.4f} c/px, period {1 / frequency:.1f} px, {math.degrees(math.atan2(v, u)):.1f}°"
    assert dock.readout.text() == f"{where}: exemplar {expected:.1f} dB"
    assert dock.bar.mark == pytest.approx(1, abs=0.01)
    hover(qtbot, dock.panes[0], 0.3, -0.2)
    assert "exemplar 0.0 dB" in dock.readout.text()


def test_a_peak_between_centres_snaps_and_is_seen_to(dock):
    u = 13 / SIDE
    exemplar = wave(u, 0.0, sd=0.02)
    answer = feed(dock, scene_of(column_of(msg_of(exemplar)), exemplar=exemplar))
    assert dock.table.rows[0].moves.startswith("1/8, 0°: +0.30 oct, ")
    found = dock.table.rows[1]
    assert found.side == "result"
    # The narrow band is put around the centre of the filter that answers most, with about a sample's width.
    assert found.peak.frequency == pytest.approx(1 / 8, rel=0.05)
    assert answer.matches[0][1].octaves == pytest.approx(math.log2(16 / 13), abs=0.07)
    predicted = [arrow for arrow in marks(dock.panes[0], Arrow, dashed=True) if arrow.x > 0]
    assert (predicted[0].x, predicted[0].to_x) == pytest.approx((u, 1 / 8), abs=2e-3)
    happened = [arrow for arrow in marks(dock.panes[1], Arrow) if arrow.x > 0]
    assert happened[0].to_x == pytest.approx(found.peak.frequency * np.sign(happened[0].to_x), abs=1e-3)
    centres = {(round(m.x, 6), round(m.y, 6)) for m in marks(dock.panes[1], Spot, shape="dot")}
    assert centres == {
        (round(s * float(x), 6), round(s * float(y), 6))
        for x, y in zip(CENTRES_U, CENTRES_V, strict=True)
        for s in (1, -1)
    }


def test_a_chosen_line_marks_its_peak_and_the_centre(dock, qtbot):
    exemplar = wave(0.1, 0.0, sd=0.02)
    feed(dock, scene_of(column_of(msg_of(exemplar)), exemplar=exemplar))
    assert not marks(dock.panes[0], Ring, tint="chosen")
    where = dock.table.visualItemRect(dock.table.item(0, 1)).center()
    qtbot.mouseClick(dock.table.viewport(), Qt.MouseButton.LeftButton, pos=where)
    rings = marks(dock.panes[0], Ring, tint="chosen")
    assert {round(ring.x, 6) for ring in rings} == {0.125, -0.125}
    assert rings[0].radius == pytest.approx(1 / 24)
    assert marks(dock.panes[0], Spot, tint="chosen")


def test_switches_take_marks_away(dock, qtbot):
    exemplar = wave(0.1, 0.0, sd=0.02)
    feed(dock, scene_of(column_of(exemplar), exemplar=exemplar))
    for box in (dock.centres, dock.peaks):
        box.setFocus()
        qtbot.keyClick(box, Qt.Key.Key_Space)
    assert not dock.panes[0].marks.shown
    qtbot.keyClick(dock.centres, Qt.Key.Key_Space)
    assert len(marks(dock.panes[0], Ring)) == 33


def test_distances_of_a_gain_of_two_are_six_decibels(dock):
    plain = (noise(64, 64, 1) - np.float32(0.5)) * np.float32(0.4) + np.float32(0.5)
    loud = (plain - np.float32(0.5)) * np.float32(2) + np.float32(0.5)
    answer = feed(dock, scene_of(column_of(loud), exemplar=plain))
    assert answer.distance == pytest.approx(20 * math.log10(2), abs=0.02)
    assert answer.variation == pytest.approx(0, abs=1e-3)
    assert dock.numbers.text() == f"log-spectral distance {answer.distance:.2f} dB · total variation 0.0%"
    choose(dock.view, "difference")
    answer = feed(dock, scene_of(column_of(loud), exemplar=plain))
    assert not dock.panes[1].isVisible()
    values = answer.first.values
    assert np.sqrt(np.mean(values.astype(np.float64) ** 2)) == pytest.approx(answer.distance, rel=2e-3)
    assert answer.first.value(0.2, 0.1) == pytest.approx(6.02, abs=0.1)


def test_the_difference_of_nothing_is_the_power(dock):
    choose(dock.view, "difference")
    answer = feed(dock, scene_of(exemplar=noise(32, 40)))
    assert answer.view == "power"
    assert dock.numbers.text() == ""
    assert not dock.panes[1].isVisible()


def test_autocorrelation_comes_back_after_one_period(dock, qtbot):
    choose(dock.view, "autocorrelation")
    answer = feed(dock, scene_of(exemplar=wave(1 / 16, 0.0)))
    assert answer.first.value(0.2, 0.2) == pytest.approx(1)
    assert answer.first.value(16.2, 0.2) == pytest.approx(1, abs=1e-4)
    assert answer.first.value(8.2, 5.2) == pytest.approx(-1, abs=1e-4)
    hover(qtbot, dock.panes[0], 16.0, 0.0)
    assert dock.readout.text() == "shift 16, 0 px: exemplar +1.000"
    places = sorted(mark.x for mark in marks(dock.panes[0], Spot))
    assert places == pytest.approx([-16, 16], abs=0.1)


def test_zoom_is_linked_and_comes_back(dock, qtbot):
    # Different sizes share their coordinates.
    feed(dock, scene_of(column_of(noise(64, 96, 1)), exemplar=noise(48, 48, 1, seed=2)))
    first, second = dock.panes
    whole = first.view_rect()
    assert whole.contains(first.area)
    at = QPointF(first.to_widget(0.1, 0.1))
    event = QWheelEvent(
        at,
        QPointF(first.viewport().mapToGlobal(at.toPoint())),
        QPoint(),
        QPoint(0, 240),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(first.viewport(), event)
    assert first.view_rect().width() < 0.9 * whole.width()
    assert second.view_rect().center().x() == pytest.approx(first.view_rect().center().x(), abs=1e-6)
    assert second.view_rect().width() == pytest.approx(first.view_rect().width(), rel=0.2)
    qtbot.mouseClick(dock.fit_button, Qt.MouseButton.LeftButton)
    assert first.view_rect().width() == pytest.approx(whole.width())


def test_profiles_have_their_peak_at_the_wave(dock, qtbot):
    feed(dock, scene_of(column_of(wave(0, 20 / SIDE)), exemplar=wave(16 / SIDE, 0, sd=0.001)))
    curves = {series.role: series.item.getData() for series in dock.radial._series if series.role != "muted"}
    x, y = curves["exemplar"]
    assert x[np.argmax(y)] == pytest.approx(16 / SIDE, abs=0.5 / 64)
    x, y = curves["result"]
    assert x[np.argmax(y)] == pytest.approx(20 / SIDE, abs=0.5 / 64)
    curves = {series.role: series.item.getData() for series in dock.angular._series if series.role != "muted"}
    x, y = curves["exemplar"]
    assert x[np.argmax(y)] == pytest.approx(0, abs=1.5)
    x, y = curves["result"]
    assert x[np.argmax(y)] == pytest.approx(90, abs=1.5)
    graph = dock.radial.graph

    def told():
        where = dock.radial.view.mapViewToScene(dock.radial.view.viewRect().center())
        qtbot.mouseMove(graph.viewport(), graph.mapFromScene(where) + QPoint(1, 0))
        qtbot.mouseMove(graph.viewport(), graph.mapFromScene(where))
        assert "c/px, period" in dock.readout.text()

    # The plot gets its place from the layout a moment later.
    qtbot.waitUntil(told)
    assert "result" in dock.readout.text()


def test_narrow_docks_show_profiles_or_peaks(dock, qtbot):
    feed(dock, scene_of(exemplar=noise(32, 32)))
    assert dock.plots.isVisible()
    assert dock.table.isVisible()
    assert not dock.beside.isVisible()
    dock.resize(700, 260)
    assert dock.beside.isVisible()
    assert dock.plots.isVisible()
    assert not dock.table.isVisible()
    dock.beside.setFocus()
    qtbot.keyClick(dock.beside, Qt.Key.Key_Down)
    assert dock.table.isVisible()
    assert not dock.plots.isVisible()


@pytest.mark.parametrize("shape", [(2, 2, 1), (1, 7, 3), (9, 5, 1)])
def test_tiny_and_constant_images(dock, shape):
    feed(dock, scene_of(column_of(noise(*shape)), exemplar=np.full(shape, 0.5, np.float32)))
    for view in ("difference", "autocorrelation"):
        choose(dock.view, view)
        assert feed(dock, scene_of(column_of(noise(*shape)), exemplar=np.full(shape, 0.5, np.float32)))


def test_nothing_yet_and_both_themes(dock):
    assert feed(dock, scene_of()) is None
    assert dock.message
    feed(dock, scene_of(column_of(noise(32, 32)), exemplar=noise(32, 32)))
    for theme in (DARK, LIGHT):
        dock.set_theme(theme)
        assert dock.panes[0].backgroundBrush().color().name() == theme.canvas
